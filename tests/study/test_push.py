"""Slow pushes against closed forms: what a panel bears as it slides or turns, with its softening branch."""

from dataclasses import replace

import numpy as np
import pytest
from driven import WEIGHT, B, H, panel
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.distinct.explicit import solve_explicit

JACK = mr.Actuator("panel", (-B, 2 * H), 1, None, 1e8)


@pytest.fixture(scope="module")
def turned():
    """A panel that an actuator turns to 0.8 of overturning."""
    return mr.push(panel(0.9, k_n=1e10), JACK, 0.4)


def rigid(moved):
    """Force at the left top corner of the rigid panel over its weight, from how far the corner has moved [m]."""
    theta = np.linspace(0.0, np.arctan(B / H), 2000)
    sine, cosine = np.sin(theta), np.cos(theta)
    force = (B * cosine - H * sine) / (2 * H * cosine + 2 * B * sine)
    return np.interp(moved, 2 * B * (1 - cosine) + 2 * H * sine, force)


def test_an_actuator_finds_the_softening_branch_of_a_panel(turned):
    rocks = turned.displacement > 0.01
    error = np.abs(turned.force / WEIGHT - rigid(turned.displacement))[rocks]
    assert error.max() < 0.01 * B / (2 * H)
    assert turned.peak == pytest.approx(WEIGHT * B / (2 * H), rel=0.01)
    assert turned.inertia_share < 0.015  # 0.01 was asked for, and the first piece is made five times at most
    assert turned.ended == "reached 400 mm"
    assert turned.displacement[-1] == pytest.approx(0.4, rel=0.01)


def test_a_push_is_drawn(turned):
    ax = Figure().subplots()
    plotting.push(ax, {"panel": turned}, {"rigid": ([0.1], [rigid(0.1) * WEIGHT])})
    line = ax.lines[0]
    np.testing.assert_allclose(line.get_xdata(), 1e3 * turned.displacement)
    np.testing.assert_allclose(line.get_ydata(), 1e-3 * turned.force)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("displacement [mm]", "force [kN]")


def test_local_damping_does_not_shift_it(turned):
    damped = mr.push(panel(0.9, k_n=1e10, k_s=1e10), JACK, 0.4, local_damping=0.7)
    at = np.linspace(0.02, 0.38, 10)
    found = [np.interp(at, each.displacement, each.force) for each in (damped, turned)]
    np.testing.assert_allclose(*found, atol=0.002 * turned.peak)


def test_a_blow_is_no_strength(turned):
    """Points with more than 5 % of inertia do not count, whatever the masonry bears there."""
    inertia = np.array([0.01, 0.02, 0.02, 0.5])
    struck = replace(turned, displacement=np.arange(4.0), force=np.array([0.4, -1.0, 0.9, 2.0]), inertia=inertia)
    assert struck.peak == 1.0
    assert struck.inertia_share == pytest.approx(np.sqrt((0.01**2 + 0.02**2) / 2))


@pytest.mark.parametrize(("unit", "peak"), [("N", 1.2), ("-", 1.0)])
def test_under_a_force_that_grows_nothing_counts_after_a_blow(turned, unit, peak):
    force, inertia = np.array([0.1, 1.0, 2.0, 1.2]), np.array([0.05, 0.01, 0.5, 0.0])
    assert replace(turned, displacement=np.arange(4.0), force=force, inertia=inertia, unit=unit).peak == peak


@pytest.mark.slow
def test_a_panel_of_blocks_bears_no_more_than_limit_analysis_and_its_hinges():
    """Units that have given way strike each other, with a fifth more than they bore; how they do, rounding decides."""
    joints = {"friction": 0.6, "k_n": 1e10, "k_s": 1e10}
    walls = [mr.Masonry.running_bond(2.0, 1.5, (0.5, 0.25), 0.25 + shift, **joints) for shift in (0.0, 1e-9)]
    bound = mr.collapse_multiplier(walls[0]).multiplier
    peaks = [mr.push(wall, 1, 0.01).peak for wall in walls]
    assert 0.98 * bound < peaks[0] < 1.04 * bound
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)


def test_it_stops_where_the_force_has_fallen():
    push = mr.push(panel(0.9, k_n=1e10), JACK, 0.4, falls_to=0.7)
    assert push.ended == "fell to 70% of its peak"
    assert push.force[-1] == pytest.approx(0.7 * push.peak, rel=0.05)


@pytest.mark.parametrize(("friction", "multiplier"), [(0.2, 0.2), (0.9, B / H)])
def test_a_force_that_grows_finds_the_multiplier_of_collapse(friction, multiplier):
    masonry = panel(friction, k_n=1e10)
    push = mr.push(masonry, -1, 0.02)
    assert push.peak == pytest.approx(multiplier, rel=0.01)
    assert push.peak == pytest.approx(mr.collapse_multiplier(masonry, -1).multiplier, rel=0.01)
    assert push.ended == "moved by 20 mm"
    assert (np.diff(push.displacement) > -1e-6).all()


def test_blocks_that_give_way_do_not_run_on():
    """A quiet push takes long pieces, in which blocks that nothing holds would move by metres."""
    push = mr.push(panel(0.2, k_n=1e10), -1, 0.02, inertia=0.0025)
    assert push.peak == pytest.approx(0.2, rel=0.005)
    assert 0.02 < push.displacement.max() < 0.022
    assert np.diff(push.displacement).max() < 0.002


def test_a_push_to_and_fro_loses_friction_each_way():
    push = mr.push(panel(0.3, k_n=1e10), mr.Actuator("panel", (-B, 0.1), 1, None, 1e8), [0.02, -0.02, 0.01])
    work = float((0.5 * (push.force[1:] + push.force[:-1]) * np.diff(push.displacement)).sum())
    assert work == pytest.approx(0.3 * WEIGHT * 0.09, rel=0.01)
    assert push.force.min() == pytest.approx(-0.3 * WEIGHT, rel=0.01)


@pytest.mark.parametrize("damping", [{"mass_damping": 20.0}, {"local_damping": 0.5}])
def test_what_damps_the_motion_is_booked(damping):
    masonry = panel(0.9, k_s=2e9)
    case = mr.MasonryCase(masonry, 0.1, velocity=[(0.3, 0.0, 0.3)])
    answer = solve_explicit(case, ledger=True, **damping)
    taken = answer.ledger.dashpots["motion"]
    assert (np.diff(taken) > -1e-9).all()
    assert taken[-1] > 0.05 * answer.ledger.largest
    assert np.abs(answer.energy_residual).max() < 0.01 * answer.ledger.largest


def test_local_damping_needs_springs_along_the_faces():
    with pytest.raises(ValueError, match=r"needs joints with a shear stiffness.*or take mass_damping"):
        mr.push(panel(0.9), JACK, 0.1, local_damping=0.5)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((0, 0.1), "driver = 0"),
        ((1, [0.1, 0.2]), "with one displacement"),
        ((JACK, 40.0), "outside"),
        ((JACK, np.nan), "not finite"),
    ],
)
def test_what_is_wrong_is_named(given, said):
    with pytest.raises(ValueError, match=said):
        mr.push(panel(0.9), *given)
