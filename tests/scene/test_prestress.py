"""Ties and tendons that are prestressed, of any direction, against statics by hand and in all solvers."""

import math

import numpy as np
import pytest

import mjrock as mr

WALL = mr.Block.from_size(0.6, 4.2, 1.0, 2000.0)
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, k_base=3e9, k_side=3e9)
FORCE = 5e3


def tendon(force, top=4.2, at=0.3):
    """A vertical one through the block and its base."""
    return mr.Tie(stiffness=1e6, at=(at, top), anchor=(at, 0.0), prestress=force, block="pillar")


def left_of(force, weight, below):
    """What is left of a prestress as the joint gives way by u = (W + N) / (k + k_t), `below` its stiffness [N/m]."""
    return force - 1e6 * (weight + force) / (below + 1e6)


def pillar(friction=0.7):
    ground = mr.Polygon([(-5.0, -1.0), (5.0, -1.0), (5.0, 0.0), (-5.0, 0.0)], fixed=True, name="ground")
    block = mr.Polygon([(0.0, 0.0), (0.6, 0.0), (0.6, 4.2), (0.0, 4.2)], name="pillar")
    return mr.Masonry([ground, block], 3e9, friction=friction)


def test_the_wall_begins_to_rock_where_its_weight_and_the_tie_hold_no_longer():
    """lambda = (W b + N z) / (W h) at the first point of its curve, and in the linear check."""
    tie = mr.Tie(4.0, 2e6, prestress=FORCE, strength=60e3, ultimate=0.05)
    case = mr.Case(WALL, 0.0, 1.0, effects=(tie,))
    by_hand = (WALL.weight * 0.3 + FORCE * 4.0) / (WALL.weight * 2.1)
    assert mr.pushover(case).multiplier[0] == pytest.approx(by_hand, rel=1e-12)
    assert mr.mechanism_check(case, lambda T, xi: 0.02).alpha_0 == pytest.approx(by_hand, rel=1e-12)


@pytest.mark.parametrize("share", [0.98, 1.02])
@pytest.mark.parametrize(
    "solve",
    [
        lambda case: mr.solve_analytical(case, E),
        lambda case: mr.simulate(case, CONTACTS),
        lambda case: mr.solve_explicit(case, CONTACTS),
        lambda case: mr.solve_compliant(case, CONTACTS),
    ],
)
def test_a_wall_lifts_off_its_stop_at_that_acceleration(share, solve):
    """The ground is pulled away inwards, slowly, up to a share of the acceleration by hand."""
    by_hand = (WALL.weight * 0.3 + FORCE * 4.0) / (WALL.weight * 2.1) * mr.GRAVITY
    grown = -share * by_hand * np.minimum(np.linspace(0.0, 1.25, 101), 1.0)
    tie = mr.Tie(4.0, 1e4, prestress=FORCE)
    run = solve(mr.Case(WALL, 0.0, 1.0, motion=mr.GroundMotion(grown, 0.01), effects=(tie,)))
    assert run.ties["tie_0"].force[0] == pytest.approx(FORCE, rel=1e-3)
    assert (run.peak_over_alpha > 0.002) == (share > 1)


@pytest.mark.parametrize("solve", [mr.solve_explicit, mr.simulate])
def test_a_tendon_presses_the_block_on_its_ground(solve):
    masonry = pillar()
    run = solve(mr.MasonryCase(masonry, 0.05, effects=tendon(FORCE)), forces=True)
    weight = masonry.blocks[1].mass * mr.GRAVITY
    left = left_of(FORCE, weight, 3e9 * 0.6)
    assert run.reactions["ground"][-1][1] == pytest.approx(weight + left, rel=1e-6)
    assert run.ties["tie_0"].force == pytest.approx(left, rel=1e-6)
    assert np.abs(run.velocity).max() < 1e-6


def test_a_pillar_on_a_tendon_is_pushed_as_statics_says(monkeypatch):
    """At a rotation of 0.02 the tendon pulls with its prestress and k times its elongation, from where its ends are."""
    monkeypatch.setattr("mjrock.study.loading.push.PIECES", 40)
    masonry, force, theta = pillar(10.0), 20e3, 0.02
    curve = mr.push(masonry, 1, 0.045, effects=tendon(force))
    weight, b, h = masonry.blocks[1].mass * mr.GRAVITY, 0.3, 2.1
    toe = np.array([0.6, 0.0])
    turn = np.array([[math.cos(theta), math.sin(theta)], [-math.sin(theta), math.cos(theta)]])
    middle, top = (toe + turn @ (np.array(point) - toe) for point in ((0.3, 2.1), (0.3, 4.2)))
    length = math.dist(top, (0.3, 0.0))
    pull = (force + 1e6 * (length - 4.2)) * (np.array([0.3, 0.0]) - top) / length
    arm = top - toe
    held = weight * (toe[0] - middle[0]) + pull[0] * -arm[1] + pull[1] * arm[0]
    by_hand = held / (weight * middle[1])
    found = np.interp(middle[0] - 0.3, curve.displacement, curve.force)
    assert found == pytest.approx(by_hand, rel=0.01)
    assert by_hand > 1.3 * b / h


def test_turned_in_space_it_is_the_same():
    """A tendon of a box through its middle."""
    box = mr.Masonry.box((0.6, 1.0, 4.2), k_n=3e9, friction=0.7)
    tie = mr.Tie(stiffness=1e6, at=(0.0, 0.0, 4.2), anchor=(0.0, 0.0, 0.0), prestress=FORCE, block="block")
    run = mr.solve_explicit(mr.MasonryCase(box, 0.05, effects=tie), forces=True)
    weight = box.blocks[1].mass * mr.GRAVITY
    assert run.reactions["ground"][-1][2] == pytest.approx(weight + left_of(FORCE, weight, 3e9 * 0.6), rel=1e-6)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: mr.Tie(4.0, 2e6, prestress=-1.0), "prestress of the tie = -1 N is outside"),
        (lambda: mr.Tie(4.0, 2e6, slack=0.01, prestress=1e3), "does not go with its slack = 0.01 m"),
        (lambda: mr.Tie(4.0, 2e6, strength=1e3, prestress=1e3), "does not go with its strength = 1000 N"),
        (lambda: mr.Tie(4.0, 2e6, anchor=(0.0, 1.0)), "goes with at"),
        (lambda: mr.MasonryCase(pillar(), 1.0, effects=mr.Tie(stiffness=1e6, at=(0.3, 0.0, 4.0), block=1)), "takes"),
        (lambda: mr.MasonryCase(pillar(), 1.0, effects=tendon(1e3, top=4.5)), "outside the block"),
        (lambda: mr.Case(WALL, 0.0, 1.0, effects=(mr.Tie(stiffness=1e6, at=(0.0, 4.0)),)), "is for masonry"),
    ],
)
def test_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
