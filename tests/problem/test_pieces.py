"""Ground motions by pieces and their sums: exact where they jump."""

import math
import pickle
import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mjrock as mr
from mjrock.study.campaign.task import fingerprint

PIECES = [(0.3, 2.0), (0.55, -1.1), (0.2, 0.0), (0.4, 0.3)]
MOTION = mr.GroundMotion.pieces(PIECES)
RECORD = mr.GroundMotion.synthetic(2.0, 3.0, seed=5)
T = np.linspace(-0.2, 4.0, 1483)


def by_hand(t: float) -> float:
    """The acceleration of PIECES."""
    for duration, accel in PIECES:
        if 0 <= t < duration:
            return accel
        t -= duration
    return 0.0


def test_acceleration_velocity_and_displacement_are_exact():
    """The integrals of each piece in closed form."""
    np.testing.assert_array_equal(MOTION(T), [by_hand(t) for t in T])
    v = x = start = 0.0
    for duration, accel in PIECES:
        tau = np.linspace(0, duration, 7)
        np.testing.assert_allclose(MOTION.velocity(start + tau), v + accel * tau, atol=1e-15)
        np.testing.assert_allclose(MOTION.displacement(start + tau), x + v * tau + accel * tau**2 / 2, atol=1e-15)
        x, v, start = x + v * duration + accel * duration**2 / 2, v + accel * duration, start + duration
    assert MOTION.duration == pytest.approx(start)
    assert MOTION.residual_velocity == pytest.approx(v, abs=1e-15)
    assert MOTION.residual_displacement == pytest.approx(x)
    assert float(MOTION.displacement(start + 2.0)) == pytest.approx(x + 2 * v)
    squares = sum(duration * accel**2 for duration, accel in PIECES)
    assert MOTION.arias_intensity == pytest.approx(math.pi / (2 * mr.GRAVITY) * squares)
    assert MOTION.peak_velocity == pytest.approx(0.6)
    np.testing.assert_allclose(MOTION.jumps, [0.0, 0.3, 0.85, 1.05, 1.45])


def test_even_pieces_are_a_record():
    """The special case: a motion of even samples, with the digits that it had."""
    assert mr.GroundMotion.pieces([(0.5, 1.0), (0.5, 1.0)]) == mr.GroundMotion([1.0, 1.0, 1.0], 0.5)
    assert mr.GroundMotion.rectangular(1.3, 0.7) == mr.GroundMotion([1.3, 1.3], 0.7)
    assert RECORD.instants is None
    assert RECORD + RECORD.reversed() == RECORD.scaled(0.0)
    assert RECORD.scaled(2.0) == RECORD + RECORD
    padded = mr.GroundMotion(np.concatenate((np.zeros(25), RECORD.accel)), 0.01)
    assert RECORD.delayed(0.25) == padded
    assert RECORD.delayed(0.0) == RECORD


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (MOTION, RECORD),
        (RECORD, mr.GroundMotion.sine(1.0, 0.7, samples=90)),
        (RECORD, mr.GroundMotion.rectangular(1.0, 1.0).delayed(0.123)),
        (MOTION, MOTION.delayed(0.3)),
        (mr.GroundMotion.rectangular(2.0, 0.3), mr.GroundMotion.rectangular(-1.0, 0.6).delayed(0.1 + 0.2)),
    ],
)
def test_sums(one, other):
    """The sum of two motions is the sum at any time and of its integrals, and does not depend on the order."""
    total = one + other
    np.testing.assert_allclose(total(T), one(T) + other(T), atol=1e-12)
    np.testing.assert_allclose(total.velocity(T), one.velocity(T) + other.velocity(T), atol=1e-13)
    np.testing.assert_allclose(total.displacement(T), one.displacement(T) + other.displacement(T), atol=1e-12)
    backwards = other + one
    np.testing.assert_array_equal(total.accel, backwards.accel)
    np.testing.assert_array_equal(total.times, backwards.times)
    assert (total.dt, total.duration) == (min(one.dt, other.dt), max(one.duration, other.duration))
    assert np.diff(total.times).min() == 0 or total.instants is None or not len(total.jumps)
    assert sum([one, other]) == total


def test_a_table_of_times_that_jumps_is_refused_with_the_way_to_make_it(tmp_path):
    path = tmp_path / "pulse.csv"
    pulse = mr.GroundMotion.pieces([(0.3, 2.0), (0.6, -1.0)])
    path.write_text("\n".join(f"{t},{a}" for t, a in zip(pulse.times.tolist(), pulse.accel.tolist(), strict=True)))
    with pytest.raises(ValueError, match=r"line 3: the time 0.3 s stands twice; .* GroundMotion.pieces"):
        mr.GroundMotion.from_csv(path, "m/s2")


def test_jumps_that_cancel_go():
    """A rectangle that goes on where the other ends; 0.1 + 0.2 s is not 0.3 s to the last bit."""
    joined = mr.GroundMotion.rectangular(2.0, 0.3) + mr.GroundMotion.rectangular(2.0, 0.6).delayed(0.1 + 0.2)
    np.testing.assert_array_equal(joined.jumps[1:-1], [])
    assert len(joined.accel) == 3


def test_scaled_reversed_delayed_and_kept():
    np.testing.assert_array_equal(MOTION.scaled(-2.0)(T), -2 * MOTION(T))
    assert MOTION.scaled(peak=1.0).peak == 1.0
    assert MOTION.polarities[1].reversed() == MOTION
    np.testing.assert_allclose(MOTION.delayed(0.37).velocity(T + 0.37), MOTION.velocity(T), atol=1e-15)
    assert MOTION.delayed(0.37).dt == MOTION.dt
    kept = pickle.loads(pickle.dumps(MOTION))
    assert (kept, hash(kept)) == (MOTION, hash(MOTION))
    other = mr.GroundMotion.pieces([(0.3, 2.0), (0.6, -1.1), (0.2, 0.0), (0.4, 0.3)])
    assert other != MOTION
    assert fingerprint(other) != fingerprint(MOTION)
    along = MOTION.along(MOTION.scaled(0.5), 0.4)
    np.testing.assert_allclose(along(T), (math.cos(0.4) + 0.5 * math.sin(0.4)) * MOTION(T))


def oscillator(period: float, damping: float) -> tuple[float, float]:
    """The largest displacement of an oscillator on PIECES, by SciPy for each piece, and its acceleration at 1.2 s."""
    omega, y, t, largest, at = 2 * math.pi / period, [0.0, 0.0], 0.0, 0.0, math.nan
    for duration, accel in [*PIECES, (period, 0.0)]:

        def rates(_, y, accel=accel):
            return [y[1], -accel - 2 * damping * omega * y[1] - omega**2 * y[0]]

        arc = solve_ivp(rates, (t, t + duration), y, method="DOP853", rtol=1e-11, atol=1e-14, dense_output=True)
        largest = max(largest, np.abs(arc.sol(np.linspace(t, t + duration, 2000))[0]).max())
        if t <= 1.2 < t + duration:
            u, v = arc.sol(1.2)
            at = -(omega**2) * u - 2 * damping * omega * v
        y, t = arc.y[:, -1], t + duration
    return largest, at


@pytest.mark.parametrize("period", [0.1, 0.4, 3.0])
def test_spectrum_of_pieces(period):
    found = mr.response_spectrum(MOTION, [period], 0.03).Sd[0]
    assert found == pytest.approx(oscillator(period, 0.03)[0], rel=2e-4)


def test_a_floor_jumps_with_the_ground_that_its_modes_leave():
    """The mode is solved exactly between the samples of the floor; what it leaves moves with the ground, and jumps."""
    floor = MOTION.through_building(0.5, 0.04, participation=0.8)
    resolved = 0.8 * oscillator(0.5, 0.04)[1] + 0.2 * 0.3
    t = floor.times[np.abs(floor.times - 1.2).argmin()]
    assert t == pytest.approx(1.2)
    assert float(floor(t)) == pytest.approx(resolved, rel=1e-6)
    before, after = floor.vertices.sides(np.array([0.3]))[0]
    assert after - before == pytest.approx(-0.2 * 3.1)
    assert floor.header["FLOOR"].startswith("T_k = 0.5 s")


def test_a_floor_of_pieces_is_that_of_the_record_which_they_make():
    """Pieces that are even samples, once as they are and once with a sum that makes them uneven."""
    sine = mr.GroundMotion.sine(2.0, 0.8, samples=40)
    still = mr.GroundMotion.pieces([(0.313, 0.0), (0.4, 0.0)])
    uneven = sine + still
    assert uneven.instants is not None
    even, other = sine.through_building(0.3), uneven.through_building(0.3)
    np.testing.assert_allclose(other(even.times), even.accel, atol=1e-9)
    finer, coarser = (mr.response_spectrum(motion, [0.2, 0.5, 1.0]).Sd for motion in (uneven, sine))
    ratio = finer / coarser  # twenty steps to a period miss a peak by up to 1.2 %
    assert 1 - 1e-4 < ratio.min() <= ratio.max() < 1.012


def test_sampled_pieces_are_ramps():
    """A sample at a jump takes the mean of both sides: the impulse is exact where the jumps are samples, but the ramp
    is there. Where they are not, the impulse errs by up to half a step of the jump."""
    sampled = MOTION.resampled(0.05)
    assert sampled.instants is None
    assert sampled.velocity(1.45) == pytest.approx(MOTION.velocity(1.45), abs=1e-14)
    assert float(MOTION.velocity(0.3) - sampled.velocity(0.3)) == pytest.approx(3.1 * 0.05 / 4)
    beside = MOTION.resampled(0.09)
    error = abs(float(beside.velocity(0.6) - MOTION.velocity(0.6)))
    assert 0.1 * 3.1 * 0.09 < error <= 0.5 * 3.1 * 0.09


def test_impulses():
    """A short piece changes the velocity of the ground at once."""
    motion = mr.GroundMotion.pieces([(1e-4, 0.5e4), (0.8, 0.0), (1e-4, -0.5e4)])
    np.testing.assert_allclose(motion.velocity(np.array([1e-4, 0.4, 0.8001, 1.0])), [0.5, 0.5, 0.5, 0.0], atol=1e-12)
    assert motion.residual_displacement == pytest.approx(0.4, rel=2e-4)


REFUSED = [
    (None, TypeError, r"pieces = None is not pairs of a duration \[s\] and an acceleration \[m/s2\], at least one"),
    ([], ValueError, r"pieces is empty; it takes pairs of a duration \[s\]"),
    ([0.3, 2.0], TypeError, r"pieces\[0\] = 0.3 of type float is no pair; pieces takes pairs"),
    ([(0.3, 2.0, 1.0)], TypeError, r"pieces\[0\] = \(0.3, 2.0, 1.0\) of type tuple is no pair"),
    ([(0.3, 2.0), (0.0, 1.0)], ValueError, r"duration of pieces\[1\] = 0 s is outside the valid range 1e-05 to 1000 s"),
    ([(0.3, math.nan)], ValueError, r"acceleration of pieces\[0\] = nan m/s2 is outside the valid range"),
    ([("0.3", 2.0)], TypeError, r"duration of pieces\[0\] = '0.3' of type str is not a real number"),
]


@pytest.mark.parametrize(("pieces", "error", "message"), REFUSED)
def test_what_is_refused(pieces, error, message):
    with pytest.raises(error, match=message):
        mr.GroundMotion.pieces(pieces)


def test_what_takes_even_samples(tmp_path):
    remedy = r"is by pieces; take \.resampled\(0\.001\), in s, first"
    for call in (lambda: MOTION.corrected("linear"), lambda: MOTION.to_esm(tmp_path / "a.ASC")):
        with pytest.raises(ValueError, match=remedy):
            call()
    MOTION.resampled(0.001).corrected("linear")
    with pytest.raises(ValueError, match=r"time step dt = 0\.3 s is outside the valid range 1e-05 to 0\.2 s"):
        MOTION.resampled(0.3)
    with pytest.raises(ValueError, match="time = -1 s is outside the valid range 0 to 10000 s"):
        MOTION.delayed(-1.0)
    with pytest.raises(TypeError, match="unsupported operand"):
        MOTION + 1.0  # type: ignore[operator]


def test_a_line_warns_of_3_g_once_whatever_it_makes():
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        for share in np.linspace(1.0, 2.0, 30):
            mr.GroundMotion.pieces([(0.1, 40.0 * share), (0.2, -20.0 * share)]).scaled(1.1).delayed(0.1)
    assert len(seen) == 1


def test_what_is_drawn():
    """The displacement of four samples is drawn as the parabolas that it is, and the jumps upright."""
    figure = mr.plotting.record(MOTION)
    accel, _, moved = (ax.lines[0].get_data() for ax in figure.axes)
    np.testing.assert_array_equal(accel[0], MOTION.times)
    assert len(moved[0]) > 400
    np.testing.assert_array_equal(moved[1], MOTION.displacement(moved[0]))
