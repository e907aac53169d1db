"""Slow pushes against closed forms: what a panel bears as it slides or turns, with its softening branch."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from driven import WEIGHT, B, H, panel
from everyday import slow
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.distinct.explicit import solve_explicit
from mjrock.distinct.response import EnergyGainError
from mjrock.study.loading.push import BLOWS_TO_END, PIECES, ForceRun, Piece, warn_if_fast

JACK = mr.Actuator("panel", (-B, 2 * H), 1, None, 1e8)


FEW = 40
"""Pieces of a push, fewer than those of a user. Their points lie on the same curve."""


def pushed_in(pieces, *arguments, **options):
    """A push in a number of pieces."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mjrock.study.loading.push.PIECES", pieces)
        return mr.push(*arguments, **options)


@pytest.fixture(autouse=True)
def few_pieces(monkeypatch):
    """Pushes of tests are made in few pieces."""
    monkeypatch.setattr("mjrock.study.loading.push.PIECES", FEW)


@pytest.fixture(scope="module", params=[FEW, slow(PIECES)])
def turned(request):
    """A panel that an actuator turns to 0.4 of overturning, in few pieces and in those of a user."""
    return pushed_in(request.param, panel(0.9, k_n=1e10), JACK, 0.2)


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
    assert turned.ended == "reached 200 mm"
    assert turned.displacement[-1] == pytest.approx(0.2, rel=0.01)


def test_a_push_is_drawn(turned):
    ax = Figure().subplots()
    plotting.push(ax, {"panel": turned}, {"rigid": ([0.1], [rigid(0.1) * WEIGHT])})
    line = ax.lines[0]
    np.testing.assert_allclose(line.get_xdata(), 1e3 * turned.displacement)
    np.testing.assert_allclose(line.get_ydata(), 1e-3 * turned.force)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("displacement [mm]", "force [kN]")


def test_local_damping_does_not_shift_it(turned):
    damped = mr.push(panel(0.9, k_n=1e10, k_s=1e10), JACK, 0.08, local_damping=0.7)
    at = np.linspace(0.01, 0.075, 10)
    found = [np.interp(at, each.displacement, each.force) for each in (damped, turned)]
    np.testing.assert_allclose(*found, atol=0.002 * turned.peak)


def test_a_blow_is_no_strength(turned):
    """Points with more than 5 % of inertia do not count, whatever the masonry bears there."""
    inertia = np.array([0.01, 0.02, 0.02, 0.5])
    struck = replace(turned, displacement=np.arange(4.0), force=np.array([0.4, -1.0, 0.9, 2.0]), inertia=inertia)
    assert struck.peak == 1.0
    assert struck.inertia_share == pytest.approx(np.sqrt((0.01**2 + 2 * 0.02**2 + 0.5**2) / 4))


def test_what_blows_bear_is_nothing_to_compare_inertia_with():
    """Five pieces in a row that are blows end a push; their own forces do not hide that they are."""
    case, still = mr.MasonryCase(panel(0.9), 1.0), np.zeros(4)
    load = ForceRun(case, None, 0.0, 0.0, mr.Actuator(None, None, 1, None, 1e6), 0.1)
    blow = Piece(still + 0.01, still + 2.0, still + 1.0, still, SimpleNamespace(t=[1.0], end=None), 0.0, 0.0, 0.0)
    load.accept(blow._replace(force=still + 0.3, inertia=still))
    for _ in range(BLOWS_TO_END):
        assert not load.ending(blow)
        load.accept(blow)
    assert load.ending(blow) == "ends in blows at 10 mm"
    assert load.largest_force == 0.3


@pytest.mark.parametrize(("unit", "peak"), [("N", 2.0), ("-", 1.0)])
def test_a_multiplier_that_holds_masonry_back_is_no_strength(turned, unit, peak):
    """A jack pushes to and fro; a direction is one way."""
    force, still = np.array([0.1, 1.0, -2.0]), np.zeros(3)
    assert replace(turned, displacement=np.arange(3.0), force=force, inertia=still, unit=unit).peak == peak


def work_of(push, weight=1.0):
    """Work under the curve from no force on [J]."""
    force, place = (np.append(0.0, part) for part in (push.force, push.displacement))
    return weight * np.trapezoid(force, place)


def test_the_area_under_the_curve_of_an_actuator_is_the_energy_gained(turned):
    lifted = turned.answer.pose[-1, 0, 1] * WEIGHT
    assert turned.energy[-1] == pytest.approx(lifted, rel=0.005)
    assert work_of(turned) == pytest.approx(turned.energy[-1], rel=0.005)


@pytest.fixture(scope="module", params=[(FEW, 0.4), slow(((PIECES, 0.2),))])
def toppled(request):
    """A panel that is pushed by a direction to 0.6 of overturning, and in the pieces of a user to 0.8."""
    return toppled_by(1, *request.param)


def toppled_by(way, pieces, left):
    to = np.hypot(B, H) * (np.sin(ALPHA) - np.sin(left * ALPHA))
    return pushed_in(pieces, panel(2.0, k_n=1e10), way, to)


ALPHA = np.arctan(B / H)


def rotation(moved):
    """Rotation of the rigid panel whose centroid has moved so far [m]."""
    return ALPHA - np.arcsin(np.sin(ALPHA) - moved / np.hypot(B, H))


def test_a_direction_finds_the_whole_curve_of_a_rigid_block(toppled):
    """tan(alpha - theta), what the balance of moments about the toe gives, and the potential energy gained."""
    push = toppled
    turns = push.displacement > 1e-3
    closed = np.tan(ALPHA - rotation(push.displacement))
    np.testing.assert_allclose(push.force[turns], closed[turns], rtol=0.015)
    assert push.peak == pytest.approx(B / H, rel=0.005)
    lifted = push.answer.pose[-1, 0, 1] * WEIGHT
    assert push.energy[-1] == pytest.approx(lifted, rel=0.005)
    assert work_of(push, WEIGHT) == pytest.approx(lifted, rel=0.005)
    assert push.inertia_share < 0.01


@pytest.mark.slow
def test_a_push_against_x_is_the_mirror_of_one_along_x():
    toppled, other = (toppled_by(way, FEW, 0.4) for way in (1, -1))
    for name in ("displacement", "force"):
        np.testing.assert_allclose(getattr(toppled, name), getattr(other, name), rtol=1e-4, atol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("mass_damping", [5.0, 20.0])
def test_damping_in_proportion_to_mass_does_not_shift_it(mass_damping):
    push = mr.push(panel(2.0, k_n=1e10), 1, 0.1, mass_damping=mass_damping)
    turns = push.displacement > 1e-3
    closed = np.tan(ALPHA - rotation(push.displacement))
    np.testing.assert_allclose(push.force[turns], closed[turns], rtol=2e-3)


@pytest.mark.parametrize(("vertical", "mass"), [slow((5000.0, 0.0)), (0.0, 500.0)])
def test_a_load_that_stays_and_a_mass_have_their_part(vertical, mass):
    """V = W (h cos + b sin) + P (2h cos + b sin) about the toe, over x = h sin + b (1 - cos); a mass weighs, too."""
    effect = mr.AddedMass(mass, 2 * H, block=1) if mass else mr.Load(vertical, 2 * H, block="panel")
    push = mr.push(panel(2.0, k_n=1e10), 1, 0.03, effects=effect)
    theta = np.linspace(0.0, 0.2, 2001)
    top, other = H * np.sin(theta) * 2 + B * (1 - np.cos(theta)), H * np.sin(theta) + B * (1 - np.cos(theta))
    share = mass / (mass + WEIGHT / mr.GRAVITY)
    moved, load = share * top + (1 - share) * other, mass * mr.GRAVITY + vertical
    gained = WEIGHT * (H * np.cos(theta) + B * np.sin(theta)) + load * (2 * H * np.cos(theta) + B * np.sin(theta))
    closed = np.gradient(gained, moved) / (WEIGHT + mass * mr.GRAVITY)
    turns = push.displacement > 2e-3
    expected = np.interp(push.displacement, moved, closed)
    np.testing.assert_allclose(push.force[turns], expected[turns], rtol=0.015)


def test_it_ends_where_nothing_is_borne_any_more(toppled):
    """A panel that a direction has turned goes on from there to overturning, where its centroid is above its toe."""
    push = mr.push(panel(2.0, k_n=1e10), 1, 0.4, start=toppled.answer.end)
    assert push.ended.startswith("goes on by itself from 25")
    assert push.displacement[0] == pytest.approx(toppled.displacement[-1], abs=2e-3)
    assert push.displacement[-1] == pytest.approx(B, rel=0.02)
    np.testing.assert_allclose(push.force, np.tan(ALPHA - rotation(push.displacement)), atol=0.01 * B / H)


@pytest.mark.slow
def test_blocks_that_are_wedged_end_it():
    cheeks = [[(-1, -1), (2, -1), (2, 0), (-1, 0)], [(0.5, 0), (1, 0), (1, 1), (0.5, 1)]]
    blocks = [*(mr.Polygon(cheek, fixed=True) for cheek in cheeks), mr.Polygon([(0, 0), (0.5, 0), (0.5, 1), (0, 1)])]
    push = mr.push(mr.Masonry(blocks, k_n=3e8, friction=0.5), 1, 0.05)
    assert push.ended == "nothing gives way to 2.5"
    assert push.displacement[-1] < 1e-4
    assert work_of(push, blocks[-1].mass * mr.GRAVITY) == pytest.approx(push.energy[-1], rel=0.01)


@pytest.mark.slow
def test_an_arch_bears_what_its_four_hinges_bear():
    """The area is the potential energy that it has gained, and the peak that of limit analysis."""
    arch = mr.Masonry.arch(2.0, 0.4, voussoirs=9, k_n=1e11, friction=2.0, xi=0.1)
    weights = mr.GRAVITY * np.array([arch.blocks[i].mass for i in arch.free])
    there, back = (mr.push(arch, way, 0.05) for way in (1, -1))
    assert there.peak == pytest.approx(mr.collapse_multiplier(arch).multiplier, rel=0.005)
    gained = float(there.answer.pose[-1, :, 1] @ weights)
    assert there.energy[-1] == pytest.approx(gained, rel=0.005)
    assert work_of(there, weights.sum()) == pytest.approx(gained, rel=0.01)
    at = np.linspace(1e-3, 0.049, 20)
    np.testing.assert_allclose(*(np.interp(at, each.displacement, each.force) for each in (there, back)), rtol=1e-3)


def strip_curve(thick, high, seat):
    """Multiplier of two rigid blocks between floors over the mean displacement of their centroids [m], by virtual work.

    The lower block turns about its right toe, the upper one about their common left edge, and its right face slides
    on the edge of a roof that reaches down by `seat`.
    """
    half, turns = high / 2, np.linspace(1e-4, 0.25, 2000)
    centroids = []
    for lower in turns:
        cosine, sine = np.cos(lower), np.sin(lower)
        hinge = np.array([thick / 2 - thick * cosine + half * sine, thick * sine + half * cosine])
        x, z = np.array([thick / 2, high - seat]) - hinge  # the roof, on the right face of the upper block
        upper = np.arctan2(z, x) - np.arccos(thick / np.hypot(x, z))
        axes = np.array([np.cos(upper), np.sin(upper)]), np.array([-np.sin(upper), np.cos(upper)])
        first = thick / 2 * (1 - cosine) + half / 2 * sine, thick / 2 * sine + half / 2 * cosine
        centroids.append((first + hinge + thick / 2 * axes[0] + half / 2 * axes[1]) / 2)
    x, z = np.array(centroids).T
    return x - x[0] + turns[0] * half / 2, np.gradient(z, x)


@pytest.mark.slow
def test_a_strip_between_floors_follows_its_rigid_curve_down_to_nothing():
    thick, high, seat = 0.25, 3.0, 0.01
    half, left, right = high / 2, -thick / 2, thick / 2
    blocks = [
        mr.Polygon([(-5, -1), (5, -1), (5, 0), (-5, 0)], fixed=True, name="floor"),
        mr.Polygon([(left, 0), (right, 0), (right, half), (left, half)], 1800.0, name="lower"),
        mr.Polygon([(left, half), (right, half), (right, high), (left, high)], 1800.0, name="upper"),
        mr.Polygon([(right, high - seat), (1, high - seat), (1, 4), (right, 4)], fixed=True, name="roof"),
    ]
    friction = lambda joint: 0.0 if "roof" in joint.name else 5.0  # noqa: E731
    push = mr.push(mr.Masonry(blocks, k_n=1e10, friction=friction, xi=0.3, frequency=100.0), 1, 0.16)
    at = np.array([0.005, 0.02, 0.05, 0.08, 0.1])
    closed = np.interp(at, *strip_curve(thick, high, seat))
    np.testing.assert_allclose(closed[[1, 4]], [0.2829, 0.0603], rtol=0.01)
    np.testing.assert_allclose(np.interp(at, push.displacement, push.force), closed, atol=0.003)
    assert push.ended.startswith("goes on by itself from 12")


@pytest.fixture(scope="module")
def in_the_plane():
    """The panel that is pushed by 0.1 m, in as many pieces as in space."""
    return pushed_in(FEW, panel(2.0, k_n=1e10), 1, 0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("driver", "angle"), [(1, None), ((-2.0, 0.0), None), (1, 0.0)])
def test_masonry_in_space_bears_what_it_bears_in_the_plane(in_the_plane, driver, angle):
    push = mr.push(panel(2.0, k_n=1e10, in_space=True), driver, 0.1, angle=angle)
    at = np.linspace(0.002, 0.1, 30)
    found = [np.interp(at, each.displacement, each.force) for each in (push, in_the_plane)]
    np.testing.assert_allclose(*found, rtol=0.01)


@pytest.mark.slow
def test_a_block_in_space_is_pushed_along_an_angle():
    """It turns over the edge of its long side: tan(alpha) over the share of the force across that edge."""
    masonry = panel(2.0, k_n=1e10, in_space=True)
    push = mr.push(masonry, 1, 0.02, angle=0.5)
    assert push.peak == pytest.approx(B / H / np.cos(0.5), rel=0.01)
    assert push.peak == pytest.approx(mr.collapse_multiplier(masonry, angle=0.5).multiplier, rel=0.01)
    assert work_of(push, masonry.blocks[1].mass * mr.GRAVITY) == pytest.approx(push.energy[-1], rel=0.01)


@pytest.mark.slow
def test_a_bond_that_breaks_leaves_the_curve_of_the_dry_block():
    """The work under the curve has what the bond took as it cracked."""
    bond = mr.Bond(1e5, 2e5, 8.0, 60.0)
    push = mr.push(panel(0.9, k_s=1e9, bond=bond, points=9), 1, 0.05)
    closed = np.tan(ALPHA - rotation(push.displacement))
    cracked = push.displacement > 0.02
    np.testing.assert_allclose(push.force[cracked], closed[cracked], atol=0.03 * B / H)  # k_n gives at the toe
    assert push.peak > 1.2 * B / H
    assert work_of(push, WEIGHT) == pytest.approx(push.energy[-1], rel=0.01)


def test_a_push_that_was_not_slow_is_warned_of(turned):
    """Blows in the last tenth, 0.2 of the peak: 0.2 sqrt(0.1) in the root mean square of the whole curve."""
    blows = np.where(np.arange(len(turned.force)) < 0.9 * len(turned.force), 0.0, 0.2 * turned.peak)
    struck = replace(turned, inertia=turned.inertia + blows)
    with pytest.warns(UserWarning, match=r"the push was not slow: forces of inertia are 6\.\d% of the peak"):
        warn_if_fast(struck, 1.0)
    with pytest.warns(UserWarning, match=r"work under the curve is up to 2\.9% beside the energy gained"):
        warn_if_fast(replace(turned, energy=1.03 * turned.energy), 1.0)
    warn_if_fast(turned, 1.0)


@pytest.mark.slow
def test_a_panel_of_blocks_bears_no_more_than_limit_analysis_and_its_hinges():
    """Rounding of the widths of units does not decide it."""
    joints = {"friction": 0.6, "k_n": 1e10, "k_s": 1e10}
    walls = [mr.Masonry.running_bond(2.0, 1.5, (0.5, 0.25), 0.25 + shift, **joints) for shift in (0.0, 1e-9)]
    bound = mr.collapse_multiplier(walls[0]).multiplier
    peaks = [mr.push(wall, 1, 0.005).peak for wall in walls]
    assert 0.98 * bound < peaks[0] < 1.005 * bound
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)


def test_it_stops_where_the_force_has_fallen():
    push = mr.push(panel(0.9, k_n=1e10), JACK, 0.4, falls_to=0.7)
    assert push.ended == "fell to 70% of its peak"
    assert push.force[-1] == pytest.approx(0.7 * push.peak, rel=0.05)


@pytest.mark.parametrize(("friction", "multiplier"), [(0.2, 0.2), slow((0.9, B / H))])
def test_a_force_that_grows_finds_the_multiplier_of_collapse(friction, multiplier):
    masonry = panel(friction)
    push = mr.push(masonry, -1, 0.01)
    assert push.peak == pytest.approx(multiplier, rel=0.01)
    assert push.peak == pytest.approx(mr.collapse_multiplier(masonry, -1).multiplier, rel=0.01)
    assert push.ended == "moved by 10 mm"
    assert push.displacement.max() < 0.011  # what gives way does not run on
    assert (np.diff(push.displacement) > -1e-6).all()


@pytest.mark.slow
def test_blocks_that_give_way_do_not_run_on():
    """A quiet push takes long pieces, in which blocks that nothing holds would move by metres."""
    push = mr.push(panel(0.2, k_n=1e10), -1, 0.01, inertia=0.0025)
    assert push.peak == pytest.approx(0.2, rel=0.005)
    assert 0.01 < push.displacement.max() < 0.011
    assert np.diff(push.displacement).max() < 0.001


@pytest.mark.parametrize(("pieces", "turns"), [(70, (0.01, -0.01)), slow((PIECES, (0.01, -0.01, 0.005)))])
def test_a_push_to_and_fro_loses_friction_each_way(pieces, turns):
    """Each turn loses a point."""
    push = pushed_in(pieces, panel(0.3), mr.Actuator("panel", (-B, 0.1), 1, None, 1e8), turns)
    work = float((0.5 * (push.force[1:] + push.force[:-1]) * np.diff(push.displacement)).sum())
    assert work == pytest.approx(0.3 * WEIGHT * np.abs(np.diff((0.0, *turns))).sum(), rel=0.01)
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
    with pytest.raises(ValueError, match=r"needs joints with a shear stiffness.*take mass_damping, or masonry"):
        mr.push(panel(0.9), JACK, 0.1, local_damping=0.5)


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        ((0, 0.1), "driver = 0"),
        ((0.5, 0.1), "driver = 0.5"),
        (((1.0, 0.0), 0.1), "driver = .* is not a direction"),
        ((1, [0.1, 0.2]), "a direction goes with one displacement above 0"),
        ((1, -0.1), "a direction goes with one displacement above 0"),
        ((JACK, 40.0), "outside"),
        ((JACK, np.nan), "not finite"),
    ],
)
def test_what_is_wrong_is_named(given, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.push(panel(0.9), *given)


@pytest.mark.parametrize(
    ("error", "swings"),
    [
        (EnergyGainError("0.4 J, 0.40% of the energy, appeared from nowhere by t = 2 s; take timestep = 1 s"), True),
        (RuntimeError("the motion breaks down at t = 2 s; take a shorter timestep"), False),
    ],
)
def test_steps_that_break_down_are_named_with_what_a_push_takes(monkeypatch, error, swings):
    """A push has no argument timestep. Only steps that gain energy are those of masonry that swings."""

    def breaks(case, **options):
        raise error

    monkeypatch.setattr("mjrock.study.loading.push.solve_explicit", breaks)
    with pytest.raises(type(error), match=r"t = 2 s, in a piece of the push of .* mm: ") as raised:
        mr.push(panel(0.9), 1, 0.1)
    assert "timestep" not in str(raised.value)
    assert ("swings; damp its motion by local_damping = 0.1" in str(raised.value)) is swings


def test_an_angle_is_for_a_direction_in_space():
    with pytest.raises(ValueError, match=r"angle = 0\.5.* is for a direction; an Actuator has one of its own"):
        mr.push(panel(0.9), JACK, 0.1, angle=0.5)
    with pytest.raises(ValueError, match=r"angle = 0\.5.* is for masonry in space; in the plane give driver = 1 or -1"):
        mr.push(panel(0.9), 1, 0.1, angle=0.5)


def test_a_displacement_of_nothing_is_refused():
    with pytest.raises(ValueError, match=r"to = 1e-300 m is outside the valid range 1e-06 to 10 m"):
        mr.push(mr.Masonry.column(width=0.5, height=2.0, drums=2), 1, to=1e-300)


STRENGTH = 3e3
TIE = mr.Tie(stiffness=2e7, strength=STRENGTH, at=(-B, 1.6 * H), anchor=(-B - 20.0, 1.6 * H), block="panel")


def with_tie(theta):
    """Force at the left top corner [N], and multiplier, of the rigid panel that a tie of its strength holds back."""
    sine, cosine = np.sin(theta), np.cos(theta)
    bears = WEIGHT * (B * cosine - H * sine) + STRENGTH * (1.6 * H * cosine + 2 * B * sine)
    return bears / (2 * H * cosine + 2 * B * sine), bears / WEIGHT / (H * cosine + B * sine)


@pytest.mark.slow
def test_an_actuator_pushes_against_a_tie_that_yields():
    """Every piece goes on from what the tie has yielded before."""
    push = mr.push(panel(0.9, k_n=1e10), JACK, 0.08, effects=TIE)
    turns = np.linspace(0.0, ALPHA, 2000)
    theta = np.interp(push.displacement, 2 * B * (1 - np.cos(turns)) + 2 * H * np.sin(turns), turns)
    yields = push.displacement > 5e-3
    np.testing.assert_allclose(push.force[yields], with_tie(theta)[0][yields], rtol=0.02)
    drawn = 1.6 * H * np.sin(theta[-1]) + 2 * B * (1 - np.cos(theta[-1])) - STRENGTH / 2e7
    assert push.answer.plastic["tie_0"].elongation == pytest.approx(drawn, rel=0.02)
    assert push.answer.ties["tie_0"].plastic[-1] == pytest.approx(push.answer.plastic["tie_0"].elongation, rel=1e-3)
    assert push.answer.ties["tie_0"].force[-1] == pytest.approx(STRENGTH, rel=1e-6)
    work = work_of(push)
    assert work == pytest.approx(push.energy[-1] - push.energy[0], rel=0.02)


@pytest.mark.slow
def test_a_direction_pushes_against_a_tie_that_breaks():
    """Beyond its ultimate the panel bears what it bears alone."""
    push = mr.push(panel(0.9, k_n=1e10), 1, 0.05, effects=replace(TIE, ultimate=0.03))
    theta = rotation(push.displacement)
    lengthened = 1.6 * H * np.sin(theta) + 2 * B * (1 - np.cos(theta)) - STRENGTH / 2e7
    held, free = (lengthened > 2e-3) & (lengthened < 0.029), lengthened > 0.033
    assert held.sum() > 5 < free.sum()
    np.testing.assert_allclose(push.force[held], with_tie(theta)[1][held], rtol=0.02)
    np.testing.assert_allclose(push.force[free], np.tan(ALPHA - theta)[free], rtol=0.02)
    assert "tie_0 broke before" in push.answer.message


@pytest.mark.slow
def test_a_push_to_and_fro_against_a_friction_damper():
    """It slips both ways, as in one run along the same path."""
    damper = mr.FrictionDamper(1.6 * H, 2e7, STRENGTH, block="panel")
    turns = [0.01, -0.01, 0.005]
    push = mr.push(panel(0.9, k_n=1e10), JACK, turns, effects=damper)
    path = np.concatenate([[0.0], turns])
    times = np.append(0.0, np.cumsum(np.abs(np.diff(path)))) / 0.02
    driven = replace(JACK, displacement=(times, path), damping=2.5e5)
    case = mr.MasonryCase(panel(0.9, k_n=1e10), times[-1], effects=(damper, driven))
    run = mr.solve_explicit(case, output_step=5e-3)
    assert push.answer.plastic["friction_damper_0"].elongation == pytest.approx(
        run.plastic["friction_damper_0"].elongation, rel=0.02
    )
    for name in ("elongation", "plastic", "force"):
        ends = [getattr(answer.ties["friction_damper_0"], name)[-1] for answer in (push.answer, run)]
        assert ends[0] == pytest.approx(ends[1], rel=0.02, abs=1e-4)
    assert np.abs(push.force).max() == pytest.approx(with_tie(0.0)[0], rel=0.02)


def test_ties_that_have_yielded_carry_on():
    """A run in two parts has the motion, the forces and the ties of one run; the end alone knows what they yielded."""
    sine = mr.GroundMotion.sine(4.0, 0.5)
    effects = (TIE, mr.FrictionDamper(1.2 * H, 5e6, 500.0, block="panel"))
    case = mr.MasonryCase(panel(0.9, k_n=1e9), 0.8, motion=sine, effects=effects)
    whole = mr.solve_explicit(case, timestep=5e-5, forces=True)
    first = mr.solve_explicit(replace(case, duration=0.4), timestep=5e-5)
    assert first.plastic["tie_0"].elongation > 1e-4
    later = mr.GroundMotion(np.asarray(sine.accel)[round(0.4 / sine.dt) :], sine.dt)
    second = mr.solve_explicit(replace(case, duration=0.4, motion=later), timestep=5e-5, forces=True, start=first.end)
    np.testing.assert_allclose(second.pose, whole.pose[400:], atol=1e-8 * np.abs(whole.pose).max())
    for name in ("tie_0", "friction_damper_0"):
        assert second.plastic[name].elongation == pytest.approx(whole.plastic[name].elongation, rel=1e-6)
        np.testing.assert_allclose(second.forces.links[name], whole.forces.links[name][400:], atol=1e-2)
        np.testing.assert_allclose(second.ties[name].force, whole.ties[name].force[400:], atol=1e-2)
    known = r"do not say how far tie_0 has yielded, whose strength is 3000 N; give solve_explicit the end"
    for solver, start in ((mr.simulate, first.end), (mr.solve_explicit, tuple(first.end))):
        with pytest.raises(ValueError, match=known):
            solver(replace(case, duration=0.4), start=start)
    other = replace(case, masonry=panel(0.9, k_n=2e9), duration=0.4)
    with pytest.raises(ValueError, match=known):
        mr.solve_explicit(other, start=first.end)
