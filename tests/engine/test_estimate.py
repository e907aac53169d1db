"""What a run of masonry of many blocks would take, said before it is made."""

import warnings

import numpy as np
import pytest

import mjrock as mr
from mjrock.engine.run_warnings import (
    explicit_seconds,
    fitted_seconds,
    plain_seconds,
    warn_if_plain_is_slow,
    warn_if_slow,
)
from mjrock.scene.time_step import RIGID_IN_SPACE, RIGID_LINE, SPRUNG_IN_SPACE, SPRUNG_LINE, STEP_TAKEN
from scripts.measure.masonry_precision import PULSE, column

ARCH = mr.Masonry.arch(5.0, 0.75, voussoirs=12)


def test_many_blocks_are_sent_to_explicit_steps_once_and_the_call_works():
    case = mr.MasonryCase(ARCH, 0.02)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mr.simulate(case)
    (complaint,) = caught
    assert complaint.category is UserWarning
    assert complaint.filename == __file__
    explicit, (least, most) = explicit_seconds(mr.masonry_scene(case)), fitted_seconds(mr.masonry_scene(case))
    for number in (explicit, least, most):
        assert f"{number:.2g}" in str(complaint.message)
    assert "take mr.solve_explicit(case)" in str(complaint.message)
    assert mr.solve_explicit(case).outcome is not mr.Outcome.OVERTURNED


@pytest.mark.parametrize(("masonry", "options"), [(column(8), {}), (ARCH, {"timestep": 1e-4})])
def test_few_blocks_and_fixed_steps_are_not(masonry, options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.filterwarnings("error", "explicit steps would take")
        mr.simulate(mr.MasonryCase(masonry, 0.002, PULSE), **options)


def test_a_slender_column_is_not_whose_dashpots_cost_explicit_steps_as_much():
    masonry = column(64)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_if_slow(mr.masonry_scene(mr.MasonryCase(masonry, 0.1)))


@pytest.mark.parametrize("k_s", [None, 4e9])
@pytest.mark.parametrize("kind", ["arch", "wall"])
def test_the_estimate_knows_the_explicit_step(kind, k_s):
    joints = {"k_n": 1e10, "k_s": k_s}
    arch, wall = mr.Masonry.arch(5.0, 0.75, **joints), mr.Masonry.running_bond(1.6, 0.8, (0.4, 0.2), **joints)
    masonry = arch if kind == "arch" else wall
    case = mr.MasonryCase(masonry, 0.001)
    scene, run = mr.masonry_scene(case), mr.solve_explicit(case)
    each = explicit_seconds(scene) / len(scene.contacts.k) * STEP_TAKEN * run.stats["stable_timestep"]
    assert each == pytest.approx(RIGID_LINE if k_s is None else SPRUNG_LINE, rel=0.25)


def test_the_estimate_grows_with_dashpots():
    weak, strong = (mr.Masonry.arch(5.0, 0.75, voussoirs=12, xi=xi) for xi in (0.01, 0.2))
    times = [explicit_seconds(mr.masonry_scene(mr.MasonryCase(one, 0.1))) for one in (weak, strong)]
    assert times[1] > 2 * times[0]
    assert np.isfinite(times).all()


@pytest.mark.parametrize("k_s", [None, 4e8])
def test_a_facade_in_space_is_sent_to_explicit_steps_and_a_column_is_not(k_s):
    facade = mr.Masonry.facade(1.5, 0.75, 0.5, (0.5, 0.25), k_n=1e9, k_s=k_s, frequency=100.0)
    case = mr.MasonryCase(facade, 0.001)
    scene, run = mr.masonry_scene(case), mr.solve_explicit(case)
    with pytest.warns(UserWarning, match="explicit steps would take"):
        warn_if_slow(scene)
    each = explicit_seconds(scene) / len(scene.contacts.k) * STEP_TAKEN * run.stats["stable_timestep"]
    assert each == pytest.approx(RIGID_IN_SPACE if k_s is None else SPRUNG_IN_SPACE, rel=0.3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        short = mr.Masonry.column(0.6, 3.0, 3, k_n=1e9)
        warn_if_slow(mr.masonry_scene(mr.MasonryCase(short, 0.001)))


def test_a_plain_model_that_would_take_minutes_says_so_with_its_step():
    scene = mr.masonry_scene(mr.MasonryCase(ARCH, 120.0))
    h = 1 / scene.highest_frequency
    minutes = plain_seconds(scene, 120.0 / h) / 60
    assert minutes > 1
    with pytest.warns(UserWarning, match=rf"some {minutes:.2g} minutes, .* steps of {h:.2g} s.*omega h = 1\)"):
        warn_if_plain_is_slow(scene, 120.0, h)


def test_a_plain_model_that_takes_seconds_says_nothing():
    scene = mr.masonry_scene(mr.MasonryCase(ARCH, 1.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_if_plain_is_slow(scene, 1.0, 1 / scene.highest_frequency)


def test_the_estimate_of_a_plain_model_knows_how_many_places_may_meet():
    few, many = (mr.masonry_scene(mr.MasonryCase(mr.Masonry.arch(5.0, 0.75, voussoirs=n), 0.1)) for n in (8, 32))
    assert 1.2 < plain_seconds(many, 1e4) / plain_seconds(few, 1e4) < 4
