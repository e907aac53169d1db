import math
import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

import mjrock as mr
from scripts.shared.paper import FIGURE_3

RECORDS = Path(__file__).parents[1] / "records"


def power_of(motion, count):
    """Frequencies [Hz], and the squares of the Fourier transform of a motion of so many samples, or with zeros after
    it."""
    return np.fft.rfftfreq(count, motion.dt), np.abs(np.fft.rfft(motion.accel, count)) ** 2


@pytest.fixture
def uneven() -> mr.GroundMotion:
    """Nothing about it is special: random accelerations, and a jump at either end."""
    return mr.GroundMotion(np.random.default_rng(1).normal(size=200), 0.02)


def test_linear_between_samples_and_quiet_outside():
    motion = mr.GroundMotion([1.0, 3.0, -1.0], 0.5)
    np.testing.assert_allclose(motion(np.array([-0.1, 0.0, 0.25, 0.5, 0.9, 1.0, 1.1])), [0, 1, 2, 3, -0.2, -1, 0])
    assert motion.duration == 1.0
    assert motion.peak == 3.0


def test_scaled_and_reversed():
    motion = mr.GroundMotion.sine(2.0, 0.8)
    np.testing.assert_array_equal(motion.reversed().accel, -motion.accel)
    assert motion.scaled(1.5).peak == pytest.approx(3.0)
    assert motion.scaled(peak=0.5) == motion.scaled(0.5 / motion.peak)
    assert motion.scaled(peak=0.5).name.endswith(" to 0.5 m/s2")
    with pytest.raises(ValueError, match=r"factor = 2, peak = 3: give either a factor or a peak \[m/s2\]"):
        motion.scaled(2, peak=3)
    with pytest.raises(ValueError, match="either a factor or a peak"):
        motion.scaled()
    with pytest.raises(ValueError, match="peak = -1 m/s2 is outside"):
        motion.scaled(peak=-1)
    with pytest.raises(ValueError, match="still is at rest: no factor gives it peak = 1 m/s2"):
        mr.GroundMotion([0.0, 0.0], 0.1, "still").scaled(peak=1)
    assert motion.reversed().reversed() == motion
    assert hash(motion.reversed().reversed()) == hash(motion)
    assert motion != motion.scaled(2)
    assert motion.polarities == (motion, motion.reversed())


def test_what_is_equal_hashes_alike():
    one, other = mr.GroundMotion([0.0, 1.0], 0.1), mr.GroundMotion([-0.0, 1.0], 0.1)
    assert one == other
    assert hash(one) == hash(other)


def test_a_pickle_carries_the_record_and_nothing_else(uneven):
    fresh = pickle.dumps(uneven)
    uneven(0.1), uneven.velocity(0.1), uneven.peak_velocity
    assert pickle.dumps(uneven) == fresh
    copy = pickle.loads(fresh)
    assert copy == uneven
    assert hash(copy) == hash(uneven)
    assert copy.name == uneven.name
    assert copy.velocity(1.0) == uneven.velocity(1.0)
    assert not copy.accel.flags.writeable


@pytest.mark.parametrize(
    ("accel", "dt", "complaint"),
    [
        ([0.0, math.nan, 1.0], 0.01, r"accel\[1\] = nan m/s2 is not finite"),
        ([[0.0, 1.0]], 0.01, r"shape \(1, 2\)"),
        ([1.0], 0.01, r"at least 2"),
        ([0.0, 1.0], 0.0, r"dt = 0 s"),
        ([0.0, 1.0], 20.0, r"dt = 20 s"),  # milliseconds
    ],
)
def test_bad_records(accel, dt, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.GroundMotion(accel, dt)


def test_another_unit_is_noticed():
    with pytest.warns(UserWarning, match="peaks at 300 m/s2 = 30.6 g"):
        mr.GroundMotion([0.0, 300.0], 0.01)


@pytest.mark.parametrize("amplitude", [-3.0, pytest.param(3.0, marks=pytest.mark.slow)])
def test_mujoco_follows_the_contact_law_under_a_pulse(contacts, amplitude):
    """Outward first and inward first: two different motions of a one-sided wall, both as the contact law has them."""
    case = mr.Case(FIGURE_3, 0.0, 2.0, motion=mr.GroundMotion.sine(amplitude, 0.8))
    law = mr.solve_compliant(case, contacts)
    for options in ({}, {"timestep": 1e-4}):
        run = mr.simulate(case, contacts, **options)
        assert np.abs(run.theta).max() == pytest.approx(np.abs(law.theta).max(), rel=0.02)


def test_polarity_matters_to_a_one_sided_wall(contacts):
    """A negative acceleration opens the wall at once; the reversed one presses it against its stop first."""
    motion = mr.GroundMotion.sine(-2.0, 0.8)
    early = [
        mr.simulate(mr.Case(FIGURE_3, 0.0, 0.3, motion=m), contacts).theta.max() / FIGURE_3.alpha
        for m in (motion, motion.reversed())
    ]
    assert early[0] > 0.02
    assert early[1] < 0.01


def test_below_uplift_nothing_rocks(wall, contacts):
    least = mr.GRAVITY * math.tan(wall.alpha)
    for share, rocks in ((0.7, False), (1.4, True)):
        motion = mr.GroundMotion.sine(-share * least, 1.5, cycles=0.5)
        run = mr.simulate(mr.Case(wall, 0.0, 1.0, motion=motion), contacts)
        assert bool(run.theta.max() > 3 * contacts.uplift_rotation(wall)) is rocks


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_the_ledger_closes_on_a_shaken_wall(contacts, accuracy):
    case = mr.Case(FIGURE_3, 0.0, 4.0, motion=mr.GroundMotion.sine(-3.0, 1.2))
    book = mr.simulate(case, contacts, accuracy=accuracy, ledger=True).ledger
    assert np.abs(book.ground).max() > 1e3
    assert np.abs(book.residual).max() < 3 * accuracy * np.abs(book.ground).max()


def test_the_record_of_an_earthquake(contacts):
    motion = mr.GroundMotion.from_sac(RECORDS / "near_a.sac", "cm/s2").scaled(0.3)
    case = mr.Case(FIGURE_3, 0.0, 8.0, motion=motion)
    coarse, fine = (mr.simulate(case, contacts, accuracy=a, ledger=True) for a in (1e-3, 1e-4))
    assert fine.theta.max() > 0.05 * FIGURE_3.alpha
    assert coarse.theta.max() == pytest.approx(fine.theta.max(), rel=0.05)
    assert np.abs(fine.energy_residual).max() < 1e-3 * np.abs(fine.ledger.ground).max()


@pytest.mark.parametrize("duration", [0.05, 0.7, 1.0, 3.3])
def test_a_rectangle_is_exact(duration):
    motion = mr.GroundMotion.rectangular(-2.0, duration)
    assert motion.duration == pytest.approx(duration, rel=1e-15)
    inside = np.linspace(0, motion.duration, 11)
    np.testing.assert_array_equal(motion(inside), -2.0)
    np.testing.assert_array_equal(motion(np.array([-1e-9, duration + 1e-9])), 0.0)
    np.testing.assert_allclose(motion.velocity(inside), -2.0 * inside, rtol=1e-14)
    assert motion.arias_intensity == pytest.approx(math.pi / (2 * mr.GRAVITY) * 4 * duration)


def test_half_a_sine():
    motion = mr.GroundMotion.half_sine(3.0, 0.6)
    t = np.linspace(0, 0.6, 97)
    np.testing.assert_allclose(motion(t), 3 * np.sin(np.pi * t / 0.6), atol=3e-5)
    assert motion.peak == 3.0
    assert motion.duration == pytest.approx(0.6)
    assert motion.residual_velocity == pytest.approx(2 / np.pi * 3 * 0.6, rel=1e-4)


@pytest.mark.parametrize(("antisymmetric", "half"), [(False, 1.35), (True, 1.75)])
@pytest.mark.parametrize("period", [0.4, 2.0])
def test_ricker(antisymmetric, half, period):
    A, T = 2.5, period
    motion = mr.GroundMotion.ricker(A, T, antisymmetric)
    t = np.linspace(-half * T, half * T, 501)
    expected = (
        A / 1.3801 * (4 * np.pi**2 * t**2 / (3 * T**2) - 3) * 2 * np.pi * t / (math.sqrt(3) * T)
        * np.exp(-2 * np.pi**2 * t**2 / (3 * T**2))
        if antisymmetric
        else A * (1 - 2 * np.pi**2 * t**2 / T**2) * np.exp(-(np.pi**2) * t**2 / T**2)
    )  # fmt: skip
    assert motion.duration == pytest.approx(2 * half * T)
    np.testing.assert_allclose(motion(t + motion.duration / 2), expected, atol=2e-4 * A)
    assert motion.peak == A
    large = np.flatnonzero(np.abs(motion.accel) > 0.999 * A)
    assert motion.accel[large[0]] > 0
    assert np.abs(motion.accel[[0, -1]]).max() < 1e-6 * A
    assert abs(motion.residual_velocity) < 1e-6 * motion.peak_velocity
    frequency, power = power_of(motion, 1 << 18)
    assert frequency[power.argmax()] == pytest.approx(1 / T, rel=0.005)


@pytest.mark.parametrize(
    ("pulse", "arguments", "complaint"),
    [
        ("rectangular", (1.0, 0.0), "duration = 0 s"),
        ("half_sine", (1.0, 200.0), "duration = 200 s"),
        ("half_sine", (1.0, 1.0, 1), "samples = 1"),
        ("ricker", (1.0, 0.001), "period = 0.001 s"),
        ("ricker", (math.nan, 1.0), "amplitude = nan m/s2"),
        ("ricker", (1.0, 100.0, False, 50), "samples = 50 is outside the valid range 100 to 1e"),
        ("sine", (1.0, 0.01, 1.0, 5000), "samples = 5000 is outside the valid range 2 to 999"),
        ("half_sine", (1.0, 1.0, 2.5), "samples = 2.5 is not a whole number"),
    ],
)
def test_pulses_that_cannot_be(pulse, arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        getattr(mr.GroundMotion, pulse)(*arguments)


def test_velocity_is_the_integral(uneven):
    t = np.linspace(0, uneven.duration, 10 * (len(uneven.accel) - 1) + 1)  # holds every sample: the rule is exact
    expected = cumulative_trapezoid(uneven(t), t, initial=0)
    np.testing.assert_allclose(uneven.velocity(t), expected, atol=1e-13)
    for i in (0, 1, 777, 1234, len(t) - 1):
        one = uneven.velocity(float(t[i]))
        assert one == pytest.approx(expected[i], abs=1e-13)
    assert uneven.velocity(-1.0) == 0.0
    assert uneven.velocity(uneven.duration + 5) == uneven.residual_velocity
    np.testing.assert_array_equal(uneven.velocity(np.array([-1.0, 99.0])), [0.0, uneven.residual_velocity])


def test_measures_between_the_samples():
    """a = 1 - 2 t: the velocity t - t^2 is zero at both samples and largest between them."""
    motion = mr.GroundMotion([1.0, -1.0], 1.0)
    assert motion.residual_velocity == 0.0
    assert motion.peak_velocity == pytest.approx(0.25)
    assert motion.residual_displacement == pytest.approx(1 / 6)
    assert motion.arias_intensity == pytest.approx(math.pi / (2 * mr.GRAVITY) / 3)


def test_residual_displacement(uneven):
    t = np.linspace(0, uneven.duration, 100 * (len(uneven.accel) - 1) + 1)
    assert uneven.residual_displacement == pytest.approx(np.trapezoid(uneven.velocity(t), t), rel=1e-4)


def test_arias_intensity_of_a_sine():
    motion = mr.GroundMotion.sine(2.0, 0.5, cycles=3)
    assert motion.arias_intensity == pytest.approx(math.pi / (2 * mr.GRAVITY) * 2.0**2 / 2 * 1.5, rel=1e-4)


def test_the_same_seed_gives_the_same_bytes():
    first, again, other = (mr.GroundMotion.synthetic(3.0, 12.0, seed=s) for s in (7, 7, 8))
    assert first.accel.tobytes() == again.accel.tobytes()
    assert np.corrcoef(first.accel, other.accel)[0, 1] < 0.5
    assert first.peak == pytest.approx(3.0, rel=1e-15)
    assert (first.duration, first.dt) == (pytest.approx(12.0), 0.01)
    assert abs(first.residual_velocity) < 1e-12
    assert first.peak_velocity > 0.1
    assert first.accel[0] == first.accel[-1] == 0


@pytest.mark.parametrize(("ground", "damping"), [(2.5, 0.6), (1.0, 0.3), (5.0, 0.2)])
def test_the_spectrum_of_a_synthetic_record(ground, damping):
    power = 0.0
    for seed in range(30):
        motion = mr.GroundMotion.synthetic(
            1.0, 40.0, seed=seed, ground_frequency=ground, ground_damping=damping, filter_frequency=0.3
        )
        f, one = power_of(motion, len(motion.accel))
        power += one / one.sum()
    w, wg, wf = 2 * np.pi * f, 2 * np.pi * ground, 2 * np.pi * 0.3
    stated = (wg**4 + 4 * damping**2 * wg**2 * w**2) / ((wg**2 - w**2) ** 2 + 4 * damping**2 * wg**2 * w**2)
    stated *= w**4 / ((wf**2 - w**2) ** 2 + 4 * 0.6**2 * wf**2 * w**2)
    bands = [(0.1, 0.3), (0.3, 0.6), (0.8 * ground, 1.2 * ground), (2 * ground, 3 * ground), (20, 30)]
    found, expected = (np.array([s[(f > a) & (f < b)].mean() for a, b in bands]) for s in (power, stated))
    np.testing.assert_allclose(found / found[2], expected / expected[2], rtol=0.2)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"peak": 0.0}, "peak = 0 m/s2"),
        ({"duration": 0.5}, "duration = 0.5 s"),
        ({"dt": 0.2}, "dt = 0.2 s is outside the valid range 1e-05 to 0.1 s"),
        ({"filter_frequency": 3.0}, "filter_frequency = 3 Hz is outside the valid range 0.01 to 2.5 Hz"),
        ({"rise": 0.7, "fall": 0.6}, "fall = 0.6 is outside"),
    ],
)
def test_synthetic_records_that_cannot_be(options, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.GroundMotion.synthetic(**({"peak": 3.0, "duration": 10.0, "seed": 0} | options))


@pytest.mark.parametrize("parts", [1, 2, 3, 7])
def test_a_finer_step_is_the_same_motion(uneven, parts):
    finer = uneven.resampled(0.02 / parts)
    assert len(finer.accel) == parts * (len(uneven.accel) - 1) + 1
    t = np.linspace(0, uneven.duration - 1e-9, 999)
    np.testing.assert_allclose(finer(t), uneven(t), atol=1e-12)
    np.testing.assert_allclose(finer.velocity(t), uneven.velocity(t), atol=1e-12)


@pytest.mark.parametrize("dt", [0.003, 0.025, 0.05, 0.3])
def test_the_duration_survives_another_step(uneven, dt):
    other = uneven.resampled(dt)
    assert other.dt == dt
    assert abs(other.duration - uneven.duration) <= dt / 2


def test_a_coarser_step_keeps_what_it_can_carry():
    """1 Hz passes through a step of 0.05 s with its phase; 11 Hz, beyond its Nyquist frequency, folds into nothing."""
    t = 0.005 * np.arange(2001)
    slow, fast = np.sin(2 * np.pi * t), np.sin(2 * np.pi * 11 * t)
    coarse = mr.GroundMotion(slow + fast, 0.005).resampled(0.05)
    np.testing.assert_allclose(coarse.accel[20:-20], slow[::10][20:-20], atol=0.01)
    back = mr.GroundMotion(slow, 0.005).resampled(0.05).resampled(0.005)
    np.testing.assert_allclose(back.accel, slow, atol=0.02)


def test_a_short_pulse_takes_a_coarser_step():
    motion = mr.GroundMotion.rectangular(1.5, 1.2)
    np.testing.assert_allclose(motion.resampled(1.0).accel, 1.5)
    with pytest.raises(ValueError, match=r"dt = 0\.8 s is outside the valid range 1e-05 to 0\.5 s"):
        mr.GroundMotion.rectangular(1.5, 0.5).resampled(0.8)


def test_it_prints_short():
    assert repr(mr.GroundMotion([0.0, 2.0], 0.5, "x")) == "<GroundMotion 'x': 2 samples, dt = 0.5 s, peak 2 m/s2>"


LONG = ("1" * 200_000 + "x", "1" * 200_000 + "." + "1" * 200_000 + "x", "1." * 100_000, " " * 200_000 + "x")


@pytest.mark.parametrize("word", LONG, ids=["digits", "decimals", "points", "blanks"])
def test_a_word_of_any_length_is_refused_at_once(word, tmp_path):
    """The time that it takes goes with the length of a line, and not with its square."""
    path = tmp_path / "bomb"
    head = "\n\nACCELERATION TIME SERIES IN UNITS OF G\n"
    for read, text in (
        (mr.GroundMotion.from_at2, f"{head}NPTS= 2, DT= .01 SEC\n0.1 {word}\n"),
        (mr.GroundMotion.from_at2, f"{head}NPTS= 2, DT= .01{word}\n0.1 0.2\n"),
        (mr.GroundMotion.from_at2, f"\n\nACCELERATION TIME SERIES IN UNITS OF G{word}\n\n0.1 0.2\n"),
        (lambda path: mr.GroundMotion.from_sac(path, "g"), f"title\n2 {word}\n0.1 0.2\n"),
        (lambda path: mr.GroundMotion.from_csv(path, "g", dt=0.01), f"time step {word}\n0.1\nx\n"),
        (
            mr.GroundMotion.from_file,
            f"Corrected accelerogram\n 2 points of accel data at .01 sec, cm/s2 ({word}\n1 {word}",
        ),
        (mr.GroundMotion.from_file, f"Sampling Freq(Hz) {word}Hz\nMemo.\n1 2\n"),
        (lambda path: mr.GroundMotion.from_csv(path, "g"), f"0,1\n.01,{word}\n"),
    ):
        path.write_text(text)
        with pytest.raises(ValueError, match=r"line|samples"):
            read(path)


def test_a_search_warns_of_motions_beyond_3_g_once():
    """One line makes a hundred of them, in between with filters of its own; another line warns again."""
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        for peak in range(40, 140):
            mr.GroundMotion([0.0, float(peak), 0.0], 0.01)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
        assert [str(one.message).split(" m/s2")[0] for one in seen] == ["ground motion peaks at 40"]
        mr.GroundMotion([0.0, 50.0, 0.0], 0.01)
    assert len(seen) == 2
