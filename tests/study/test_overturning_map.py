"""Maps of overturning, against a rule that is known and against closed forms."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mjrock as mr
from mjrock import plotting

WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)
SLENDER = mr.Block(b=0.06, h=3.0)
"""h/b 50, for which the linear equations of slender blocks hold."""
LOSSY = mr.Restitution(0.93, -0.93)
"""Of impacts that lose more than geometry says: islands are wider then."""
PERIODS, AMPLITUDES = [0.2, 0.5, 0.9], np.arange(1.0, 9.0)


@dataclass(frozen=True, repr=False)
class Known(mr.Analysis):
    """A wall that falls where a rule of the peak and the duration of its motion says so, after so many impacts."""

    rule: object = field(default=None, compare=False)
    number: int = 0

    def __call__(self, history=None):
        impacts = self.rule(self.case.motion.peak, self.case.motion.duration)
        return {self.PEAK: 0.5 if impacts is None else math.inf, "impacts": impacts or 0}


def of(rule, number=0):
    def build(amplitude, period):
        motion = mr.GroundMotion([0.0, -amplitude, 0.0], 0.5 * period)
        return Known(mr.Case(WALL, 0.01, 1.0, motion=motion), "analytical", e=E, rule=rule, number=number)

    return build


def ruled(amplitude, period):
    """Falls after an impact from 3 to 4, and without one from 7 on, the first under periods above 0.3 s alone."""
    return 0 if amplitude > 6.5 else 1 if period > 0.3 and 2.5 < amplitude < 4.5 else None


def mapped(build, tmp_path, amplitudes=AMPLITUDES, periods=PERIODS, **options):
    return mr.overturning_map(build, amplitudes, periods, tmp_path / "m.sqlite", **({"workers": 1} | options))


def test_every_pulse_is_run_and_islands_are_kept(tmp_path):
    found = mapped(of(ruled), tmp_path, executor=ThreadPoolExecutor(1))
    short, long = [0] * 6 + [2] * 2, [0, 0, 1, 1, 0, 0, 2, 2]
    np.testing.assert_array_equal(found.endings, [short, long, long])
    np.testing.assert_array_equal(found.lowest, [7.0, 3.0, 3.0])
    np.testing.assert_array_equal(found.lowest_without_impact, 7.0)
    np.testing.assert_array_equal(np.argwhere(found.islands), [[1, 4], [1, 5], [2, 4], [2, 5]])
    assert found.table().splitlines()[2].split() == ["0.5", "3", "7", "5", "to", "6"]
    assert "50% overturn, 4 stand above" not in repr(found)
    assert "42% overturn, 4 stand above" in repr(found)
    assert "<table>" in found._repr_html_()


def test_the_same_call_carries_on_and_a_finer_grid_runs_what_is_new(tmp_path):
    ran = []

    def counted(amplitude, period):
        ran.append((amplitude, period))
        return ruled(amplitude, period)

    first = mapped(of(counted), tmp_path)
    again = mapped(of(counted), tmp_path)
    assert len(ran) == first.endings.size
    np.testing.assert_array_equal(first.endings, again.endings)
    finer = mapped(of(counted), tmp_path, np.arange(1.0, 8.1, 0.5))
    assert len(ran) == finer.endings.size
    np.testing.assert_array_equal(finer.endings[:, ::2], first.endings)


def test_what_is_left_to_chance_or_to_the_record(tmp_path):
    builds = {"one": of(ruled), "other": of(lambda a, T: 0 if a > 4.999 else None, 1)}
    found = mapped(builds, tmp_path, nudges=(1e-3, -1e-3))
    np.testing.assert_allclose(found.shares[0], [0, 0, 0, 0, 1 / 3, 0.5, 1, 1])  # 5 (1 - 0.001) stands
    np.testing.assert_array_equal(found.endings, mapped(of(ruled), tmp_path).endings)


def test_masonry_falls(tmp_path):
    """A cube on the ground slides away from no pulse; two slender blocks fall under the longer one."""

    def build(amplitude, period):
        blocks = [mr.Block.from_size(0.3, 1.0, 0.5)] * 2
        masonry = mr.Masonry.stack(blocks, k_n=1e9, xi=0.05, friction=0.7)
        motion = mr.GroundMotion.half_sine(amplitude, 0.5 * period)
        return mr.MasonryAnalysis(mr.MasonryCase(masonry, 1.5, motion=motion), solver="explicit")

    mapped(of(ruled), tmp_path, [1.0], [0.1])  # its rows in the same store have impacts, those of masonry None
    found = mapped(build, tmp_path, [1.0, 5.0], [0.1, 1.0])
    np.testing.assert_array_equal(found.endings, [[0, 0], [0, 3]])
    assert np.isnan(found.lowest_without_impact).all()


REFUSED = [
    ({"build": 1}, TypeError, "build of record = 1 .* is not a function of an amplitude and a period"),
    ({"build": lambda scale: None}, TypeError, "is not a function of an amplitude and a period"),
    ({"build": lambda a, T: None}, TypeError, r"build of record\(1\) = None is not an Analysis"),
    ({"build": {}}, ValueError, "build holds no records"),
    ({"amplitudes": [2.0, 1.0]}, ValueError, "amplitudes"),
    ({"amplitudes": [-1.0, 1.0]}, ValueError, r"amplitudes.* 0 to 1e4 m/s2"),
    ({"periods": []}, ValueError, "periods"),
    ({"periods": [1.0, 200.0]}, ValueError, r"periods.* 0 to 100 s"),
    ({"nudges": [0.1]}, ValueError, r"nudges\[0\] = 0.1 is outside the valid range -0.01 to 0.01"),
]


@pytest.mark.parametrize(("changed", "error", "message"), REFUSED)
def test_what_is_refused(changed, error, message, tmp_path):
    given = {"build": of(ruled), "amplitudes": [1.0], "periods": [1.0]} | changed
    with pytest.raises(error, match=message):
        mr.overturning_map(**given, store=tmp_path / "m.sqlite")
    assert not list(tmp_path.iterdir())


def overturns_without_impact(share, frequency):
    """Whether one cycle of a sine of `share` g alpha and `frequency` p overturns a slender block before any impact, in
    closed form (Zhang and Makris 2001: J. Eng. Mech. 127, 473-483).

    In time of 1 / p and rotations of alpha x'' = x - 1 + A sin(w t + psi) from the uplift, A sin(psi) = 1. What grows,
    u = x' + x - 1, is e^t (-1 + A int sin(w t + psi) e^-t dt). The block overturns if u > 0 at the end of the cycle and
    x > 0 until then.
    """
    A, w = share, frequency
    psi = math.asin(1 / A)
    end = (2 * math.pi - psi) / w
    t = np.linspace(0, end, 2001)
    grows = -1 + A * (
        w * math.cos(psi) + math.sin(psi) - np.exp(-t) * (w * np.cos(w * t + psi) + np.sin(w * t + psi))
    ) / (1 + w**2)
    fades = 1 + A * (
        w * math.cos(psi) - math.sin(psi) - np.exp(t) * (w * np.cos(w * t + psi) - np.sin(w * t + psi))
    ) / (1 + w**2)
    x = 1 + 0.5 * (np.exp(t) * grows - np.exp(-t) * fades)
    return bool(grows[-1] > 0 and x[1:].min() > 0)


def outcome_by_integration(share, frequency, e):
    """What the slender block does, from impact to impact by SciPy: 0 stands, 1 overturns after impacts, 2 without."""
    w, psi = frequency, math.asin(1 / share)
    end = (2 * math.pi - psi) / w
    t, x, v, side, impacts = 0.0, 0.0, 0.0, 1, 0

    def meets(t, y):
        return side * y[0] + (1e-12 if t < 1e-3 else 0.0)

    def falls(t, y):
        return abs(y[0]) - 3

    meets.terminal = falls.terminal = True
    meets.direction = -1
    for _ in range(30):
        for until in (end, 40.0):
            if t < until:
                pushed = share if until == end else 0.0
                rates = lambda t, y, side=side, pushed=pushed: [y[1], y[0] - side + pushed * math.sin(w * t + psi)]  # noqa: E731
                arc = solve_ivp(rates, (t, until), [x, v], events=(meets, falls), rtol=1e-9, atol=1e-11, max_step=0.1)
                t, (x, v) = float(arc.t[-1]), arc.y[:, -1]
                if arc.t_events[1].size:
                    return 1 if impacts else 2
                if arc.t_events[0].size:
                    break
        else:
            return 0
        x, v, side, impacts = 0.0, e * v, int(math.copysign(1, v)), impacts + 1
    return 0


def slender(amplitude, period):
    motion = mr.GroundMotion.sine(amplitude, period)
    case = mr.Case(SLENDER, 0.0, period + 12 / SLENDER.p, side_stop=False, motion=motion)
    return mr.Analysis(case, "analytical", e=LOSSY)


def test_overturning_without_impact_of_the_published_map(tmp_path):
    """Zhang and Makris (2001): every pulse of the map beside the closed form."""
    frequencies, shares = np.array([7.0, 5.5, 4.0, 2.5, 1.0]), np.linspace(1.3, 13.0, 14)
    lifts = mr.GRAVITY * math.tan(SLENDER.alpha)
    found = mapped(slender, tmp_path, shares * lifts, 2 * math.pi / (frequencies * SLENDER.p))
    expected = [[overturns_without_impact(share, frequency) for share in shares] for frequency in frequencies]
    np.testing.assert_array_equal(found.endings == 2, expected)
    assert 20 < np.sum(expected) < 60


@pytest.mark.slow
def test_both_modes_of_the_published_map(tmp_path):
    """The modes with and without impacts, and the islands that stand between them, by an own integration."""
    frequencies, shares = np.array([7.6, 6.9, 6.3, 4.4, 3.0]), np.linspace(1.3, 13.3, 17)
    lifts = mr.GRAVITY * math.tan(SLENDER.alpha)
    found = mapped(slender, tmp_path, shares * lifts, 2 * math.pi / (frequencies * SLENDER.p))
    expected = [[outcome_by_integration(share, w, LOSSY.base) for share in shares] for w in frequencies]
    np.testing.assert_array_equal(found.endings, expected)
    assert found.islands.any()


def test_the_picture_has_every_pulse_in_its_cell(tmp_path):
    """Over frequencies the periods run backwards, and the units stand on the opposite axes."""
    found = mapped(of(ruled), tmp_path)
    plain, scaled = plotting.overturning_map(found), plotting.overturning_map(found, WALL)
    cells = [ax.collections[0].get_array().reshape(len(AMPLITUDES), -1) for ax in (plain, scaled)]
    np.testing.assert_array_equal(cells[0], cells[1][:, ::-1])
    names = list(plotting.studies.ENDING_COLOURS)
    assert names[int(cells[0][4, 1])] == "stands above a fall"
    assert names[int(cells[0][2, 0])] == "stands"
    low, high = scaled.get_ylim()
    beside = scaled.child_axes[1]
    scaled.figure.draw_without_rendering()
    lifts = mr.GRAVITY * math.tan(WALL.alpha)
    np.testing.assert_allclose(beside.get_ylim(), [low * lifts, high * lifts])
    assert beside.get_ylabel() == "amplitude [m/s²]"
