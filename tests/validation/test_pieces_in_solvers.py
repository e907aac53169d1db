"""Ground motions that jump, in every solver, against closed forms and conservation laws of a rigid block."""

import math
from functools import partial

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import mjrock as mr

G = mr.GRAVITY
WALL = mr.Block.from_size(thickness=0.6, height=4.2)
ALPHA, P2, E = WALL.alpha, WALL.p**2, mr.Restitution.from_geometry(WALL)
BY_THEORY = partial(mr.solve_analytical, e=E, rtol=1e-12)


def shaken(motion, duration=4.0, **options):
    return mr.Case(WALL, 0.0, duration, motion=motion, **options)


def taken(theta, a):
    """Square of the velocity over 2 p^2 at a rotation from rest, of a block that a constant acceleration opens [-]."""
    return 2 * math.sin(theta / 2) * (a / G * math.cos(ALPHA - theta / 2) - math.sin(ALPHA - theta / 2))


def until(theta, a):
    """The time from rest to that rotation [s], by quadrature over the root of the rotation."""
    return quad(lambda r: 2 * r / math.sqrt(2 * P2 * taken(r * r, a)), 0.0, math.sqrt(theta), epsrel=1e-11)[0]


def least_duration(a):
    """How long an acceleration has to last to overturn the block: it then has done the work up to the top (Housner
    1963; for a slender block cosh p t = 1 + 1 / (2 A (A - 1)), A = a / (g tan alpha))."""
    return until(ALPHA - math.asin(math.sin(ALPHA) - (1 - math.cos(ALPHA)) * G / a), a)


@pytest.mark.parametrize("share", [1.05, 2.0, 5.0])
def test_least_rectangle(share):
    """The exact block in its closed form by energy, and the slender one in that of Housner."""
    a = share * G * math.tan(ALPHA)
    least = least_duration(a)
    A = share
    assert least == pytest.approx(math.acosh(1 + 1 / (2 * A * (A - 1))) / WALL.p, rel=2e-2)
    for factor, overturns in ((1 - 1e-8, False), (1 + 1e-8, True)):
        case = shaken(mr.GroundMotion.rectangular(-a, factor * least), least + 25 / WALL.p, side_stop=False)
        assert (BY_THEORY(case, rtol=1e-13).peak_over_alpha == math.inf) is overturns


def after_two(a, b, first, second):
    """Rotation and velocity after two pieces of opening accelerations, in the first swing, by energy and quadrature."""
    theta = brentq(lambda x: until(x, a) - first, 1e-6, 0.9 * ALPHA, xtol=1e-14)
    start = taken(theta, a) - taken(theta, b)

    def on(x):
        return quad(lambda y: 1 / math.sqrt(2 * P2 * (start + taken(y, b))), theta, x, epsrel=1e-12)[0]

    top = brentq(lambda x: start + taken(x, b), theta, 0.9 * ALPHA)
    end = brentq(lambda x: on(x) - second, theta, top - 1e-6, xtol=1e-14)
    return end, math.sqrt(2 * P2 * (start + taken(end, b)))


PIECES = (0.11, 3.0), (0.0731, -0.7)
"""Durations and opening accelerations; the jumps meet no step of any solver."""


def test_theory_by_pieces_to_rounding():
    """The rotation at the end of the second piece, and the energy after it, which nothing changes."""
    (first, a), (second, b) = PIECES
    theta, omega = after_two(a, b, first, second)
    motion = mr.GroundMotion.pieces([(first, -a), (second, -b)])
    found = mr.solve_analytical(shaken(motion, first + second), E, rtol=1e-13)
    assert found.theta[-1] == pytest.approx(theta, rel=1e-9)
    assert found.omega[-1] == pytest.approx(omega, rel=1e-9)
    top = 0.5 * omega**2 + P2 * math.cos(ALPHA - theta)
    peak = ALPHA - math.acos(top / P2)
    on = mr.solve_analytical(shaken(motion, 3.0), E, rtol=1e-13)
    assert on.peaks[0] == pytest.approx(peak, rel=1e-9)


def test_samples_of_pieces_err_where_pieces_do_not():
    """A ramp of a step instead of a jump: the error depends on where in a step the jump lies, and is up to percents."""
    (first, a), (second, b) = PIECES
    exact = after_two(a, b, first, second)[0]
    motion = mr.GroundMotion.pieces([(first, -a), (second, -b)])
    errors = []
    for dt in (0.005, 0.004, 0.002):
        t = dt * np.arange(math.ceil(motion.duration / dt) + 1)
        ramped = mr.GroundMotion(motion(t), dt)
        case = shaken(ramped, motion.duration)
        errors.append(abs(mr.solve_analytical(case, E, rtol=1e-13).theta[-1] / exact - 1))
    assert min(errors) > 1e-5
    assert 5e-3 < max(errors) < 0.1


@pytest.mark.parametrize(("solve", "rubbing"), [(mr.solve_explicit, 1e-9), (mr.simulate, 1e-5)])
@pytest.mark.parametrize("step", [1e-3, 7.3e-4])
def test_a_block_that_slides_freely_has_the_impulse_of_the_ground(solve, rubbing, step):
    """Without friction a block stays where it is, and the ground goes away below it. Its velocity is that of the ground
    to rounding, wherever in a step the jumps are and whether or not a piece is shorter than a step, and but for the
    least friction that a solver has."""
    blocks = [
        mr.Polygon([(-1, -0.2), (1, -0.2), (1, 0), (-1, 0)], 2000.0, fixed=True),
        mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 0.2), (-0.2, 0.2)], 2000.0),
    ]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=1e-9, xi=0.1)
    motion = mr.GroundMotion.pieces([(0.0314, 2.0), (2.3e-4, -50.0), (0.0417, -1.0), (0.03, 0.4)])
    found = solve(mr.MasonryCase(masonry, 0.15, motion=motion), timestep=step, output_step=step)
    rubbed = rubbing * G * 0.15
    late = 0.5 * step * 50.0 * 2.3e-4 + 0.15 * rubbed  # the velocity changes within a step
    np.testing.assert_allclose(found.pose[:, 0, 0], -motion.displacement(found.t), atol=late)
    moved = (found.pose[-1, 0, 0] - found.pose[-2, 0, 0]) / (found.t[-1] - found.t[-2])
    assert moved == pytest.approx(-motion.residual_velocity, abs=rubbed + 1e-9)


CONTACTS = mr.Contacts.from_law(WALL, E, k_base=1e9, k_side=1e9)
OPENING = mr.GroundMotion.pieces([(0.2137, -4.0), (0.1281, 0.71), (0.1, 0.0), (0.0913, -1.2)])


@pytest.fixture(scope="module")
def on_springs():
    """Rotation by SciPy, which ends an arc at every jump [rad]."""
    return mr.solve_compliant(shaken(OPENING, 0.6), CONTACTS, rtol=1e-11, atol=1e-13, output_step=0.6).theta[-1]


SOLVERS = {
    "SciPy": (partial(mr.solve_compliant, rtol=1e-8, atol=1e-11), 1e-8),
    "MuJoCo, fitted steps": (mr.simulate, 1e-5),
    "MuJoCo, one step": (partial(mr.simulate, timestep=2e-4), 1e-5),
    "explicit": (partial(mr.solve_explicit, timestep=2e-4), 5e-6),
}


@pytest.mark.parametrize("name", SOLVERS)
def test_solvers_agree_on_a_wall_on_springs(on_springs, name):
    """Rotation of half of alpha after three jumps; samples every 5 ms are out by some percent."""
    solve, tolerance = SOLVERS[name]
    found = solve(shaken(OPENING, 0.6), CONTACTS, output_step=0.6).theta[-1]
    assert found == pytest.approx(on_springs, rel=tolerance)
    t = 0.005 * np.arange(110)
    ramped = solve(shaken(mr.GroundMotion(OPENING(t), 0.005), 0.6), CONTACTS, output_step=0.6).theta[-1]
    assert abs(ramped / on_springs - 1) > 1e-2


VERTICAL = mr.GroundMotion.pieces([(0.1, 2.0), (0.15, -3.0), (0.1, 0.0), (0.1, 4.0)])
SAME = {
    "cut into shorter pieces": (
        mr.GroundMotion.pieces([(0.2, -4.0), (0.0137, -4.0), (0.1281, 0.71), (0.1, 0.0), (0.0013, -1.2), (0.09, -1.2)]),
        VERTICAL,
    ),
    "a sum of motions": (
        mr.GroundMotion.pieces([(0.2137, -4.0), (0.1281, 0.71)])
        + mr.GroundMotion.pieces([(0.0913, -1.2)]).delayed(0.2137 + 0.1281 + 0.1),
        VERTICAL.scaled(0.5) + VERTICAL.scaled(0.5),
    ),
}


@pytest.mark.parametrize("how", SAME)
@pytest.mark.parametrize(
    ("name", "tolerance"),
    [("theory", 1e-8), ("MuJoCo, fitted steps", 1e-5), ("MuJoCo, one step", 1e-9), ("explicit", 1e-9)],
)
def test_the_same_ground_is_the_same_answer(name, tolerance, how):
    """However its pieces are cut or added, horizontally and vertically; steps that fit a shorter piece are others."""

    def last(motion, vertical):
        case = mr.Case(WALL, 0.0, 0.6, motion=motion, vertical=vertical)
        response = mr.solve_analytical(case, E) if name == "theory" else SOLVERS[name][0](case, CONTACTS)
        return response.theta[-1]

    assert last(*SAME[how]) == pytest.approx(last(OPENING, VERTICAL), rel=tolerance)


def test_scipy_and_steps_agree_on_a_vertical_ground_that_jumps():
    case = mr.Case(WALL, 0.0, 0.6, motion=OPENING, vertical=VERTICAL)
    exact = mr.solve_compliant(case, CONTACTS, rtol=1e-9, atol=1e-12, output_step=0.6).theta[-1]
    for name in ("MuJoCo, fitted steps", "explicit"):
        assert SOLVERS[name][0](case, CONTACTS, output_step=0.6).theta[-1] == pytest.approx(exact, rel=1e-5)


def test_a_run_on_pieces_is_kept_and_read(tmp_path):
    pytest.importorskip("h5py")
    answer = mr.solve_analytical(shaken(OPENING, 0.6), E)
    answer.save(tmp_path / "run.h5")
    assert mr.load(tmp_path / "run.h5").case.motion == OPENING


@pytest.mark.parametrize(("length", "error"), [(1e-3, 5e-3), (1e-4, 1e-3), (2e-5, 5e-4)])
def test_double_impulse(length, error):
    """Nabeshima, Taniguchi, Kojima and Takewaki (Frontiers in Built Environment 2, 2016): an impulse V, and -V when the
    block has come back through its first impact. By angular momentum and energy it overturns if
    1/2 I (w1 (1 + e))^2 > m g R (1 - cos alpha), w1 = V m h / I."""
    e = 1 - 1.5 * math.sin(ALPHA) ** 2
    first = math.sqrt(2 * P2 * (1 - math.cos(ALPHA))) / (1 + e)
    V = first * G * WALL.R / (P2 * WALL.centroid_height)  # I = m g R / p^2

    def back(velocity):
        """When a block that leaves rest at an angular velocity meets its base again [s]."""
        top = ALPHA - math.acos(velocity**2 / (2 * P2) + math.cos(ALPHA))
        fallen = lambda r: math.cos(ALPHA - top) - math.cos(ALPHA - top + r * r)  # noqa: E731
        return 2 * quad(lambda r: 2 * r / math.sqrt(2 * P2 * fallen(r)), 0.0, math.sqrt(top), epsrel=1e-10)[0]

    def falls(share):
        pieces = [(length, -share * V / length), (back(share * first) + 1e-4, 0.0), (length, share * V / length)]
        case = shaken(mr.GroundMotion.pieces(pieces), 8.0, side_stop=False)
        return BY_THEORY(case).peak_over_alpha == math.inf

    low, high = 0.9, 1.1
    while high - low > 1e-5:
        low, high = (low, 0.5 * (low + high)) if falls(0.5 * (low + high)) else (0.5 * (low + high), high)
    assert high == pytest.approx(1.0, abs=error)  # of the length, and of 1e-4 s that the block has left its impact
