"""A tilting table: what slides and what turns on it, by explicit steps and in MuJoCo."""

import numpy as np
import pytest
from driven import B, H, panel
from everyday import among

import mjrock as mr
from mjrock.problem.masonry.histories import motions_of_tilt

RATE = 0.02
"""Rate at which the table turns [rad/s]."""


def tilted(masonry, to, solve=mr.solve_explicit, rate=RATE, **options):
    """The answer of masonry on a table that turns at a rate [rad/s] up to an angle [rad]."""
    case = mr.MasonryCase(masonry, to / rate, tilt=([0.0, to / rate], [0.0, to]))
    return solve(case, ledger=True, output_step=0.02, **options)


@pytest.mark.parametrize("in_space", among([False, True], True))
def test_a_panel_slides_at_the_angle_of_friction(in_space):
    answer = tilted(panel(0.2, in_space=in_space, k_n=1e10), 0.25)
    x, theta = answer.pose[:, 0, 0], answer.pose[:, 0, 4] * 2 if in_space else answer.theta[:, 0]
    speed = np.gradient(x - H * theta, answer.t)
    # from the angle of friction on the panel gains g cos(a) (tan(a) - mu) a second
    slides = speed > 0.02
    gained = np.gradient(speed, answer.t)[slides]
    expected = mr.GRAVITY * (np.sin(RATE * answer.t) - 0.2 * np.cos(RATE * answer.t))[slides]
    np.testing.assert_allclose(gained[1:-2], expected[1:-2], atol=0.01 * 0.2 * mr.GRAVITY)
    assert np.abs(answer.energy_residual).max() < 1e-3 * answer.ledger.largest


def test_a_panel_turns_at_the_angle_of_its_diagonal():
    answer = tilted(panel(0.9, k_n=1e10), 0.26)
    turned, angle = answer.theta[:, 0], RATE * answer.t
    turns = turned > 2 * turned[len(turned) // 2]  # until then it leans on its springs
    assert np.tan(angle[turns][0]) == pytest.approx(B / H, rel=0.01)


def test_the_same_table_in_mujoco():
    masonry = panel(0.9, k_n=1e8)
    both = [tilted(masonry, 0.33, solve, rate=5 * RATE).theta[:, 0] for solve in (mr.solve_explicit, mr.simulate)]
    np.testing.assert_allclose(*both, atol=0.02 * both[0].max())


def test_a_table_turns_as_its_history_says():
    """At any time gravity along the table is g sin(a), to within 1e-6 g between the samples of the motion."""
    motion, vertical = motions_of_tilt(((0.0, 1.0), (0.0, 0.4)), 2.0)
    for t in (0.25, 0.7499, 1.0, 1.7):
        angle = 0.4 * min(t, 1.0)
        assert float(motion(t)) == pytest.approx(-mr.GRAVITY * np.sin(angle), abs=1e-6 * mr.GRAVITY)
        assert float(vertical(t)) == pytest.approx(-mr.GRAVITY * (1 - np.cos(angle)), abs=1e-6 * mr.GRAVITY)


@pytest.mark.parametrize(
    ("tilt", "message"),
    [
        (([0.0, 1.0], [0.0, 15.0]), "= 15 rad is outside"),
        (([1.0, 2.0], [0.0, 0.1]), "t begins at 1 s"),
        (([0.0, 1.0], [0.0, np.inf]), "not finite"),
        (0.2, "is not \\(t, values\\)"),
    ],
)
def test_what_is_wrong_with_a_table_is_named(tilt, message):
    with pytest.raises((ValueError, TypeError), match=message):
        mr.MasonryCase(panel(0.3), 1.0, tilt=tilt)
    with pytest.raises(ValueError, match="tilt does not go with motion"):
        mr.MasonryCase(panel(0.3), 1.0, tilt=([0.0], [0.1]), motion=mr.GroundMotion([0.0, 1.0], 0.01))
