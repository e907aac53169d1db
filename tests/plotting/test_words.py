"""No word of a public picture lies on another one, under a line or beyond the edge, whatever is drawn."""

import functools
import inspect
import warnings

import numpy as np
import pytest
from matplotlib.axes import Axes

import mjrock as mr
from mjrock import plotting
from tests.plotting.words import covered

INPUTS = 30
"""Random inputs of each picture."""
NAMES = ("a", "as it is", "tied at the eaves", "with two ties of 24 mm and a stop", "MuJoCo", "k_n = 1e9")


class Random:
    """Random things that pictures draw, by a seed."""

    def __init__(self, seed):
        self.seed, self.rng = seed, np.random.default_rng(seed)

    def names(self, count):
        """Up to six names, some of them long."""
        return [NAMES[i] for i in self.rng.permutation(len(NAMES))[:count]]

    def within(self, low, high):
        return float(self.rng.uniform(low, high))

    def round(self, low, high):
        """A number with two digits, as an engineer gives it."""
        return float(f"{self.within(low, high):.2g}")

    def wall(self):
        """A wall with openings, sometimes many, and with a gable."""
        height, length = self.round(2, 14), self.round(1, 15)
        some = [
            mr.Opening(self.round(0.1, 0.25) * length, self.round(0.1, 0.3) * height, sill)
            for sill in (0.0, round(0.5 * height, 2))[: self.rng.integers(0, 3)]
        ]
        gable = mr.Gable(round(0.2 * height, 2)) if self.rng.random() < 0.3 else None
        return mr.Block.from_size(self.round(0.05, 0.13) * height, height, length, openings=some, gable=gable)

    def effects(self, wall, *kinds):
        """Some of each kind, at heights that may be the same."""
        height, found = 2 * wall.h, []
        for kind in self.rng.permutation(len(kinds)):
            for _ in range(self.rng.integers(0, 3)):
                at, size = round(self.within(0.5, 1.0) * height, 2), self.round(0.01, 0.1) * wall.weight
                found.append(kinds[kind](self, at, size))
        return tuple(found)

    def tie(self, at, size):
        ultimate = self.round(0.02, 0.2) if self.rng.random() < 0.5 else None
        return mr.Tie(
            at, self.round(1, 50) * 1e6, slack=1e-3, strength=size, ultimate=ultimate, length=self.round(1, 9)
        )

    def thrust(self, at, size):
        return mr.Thrust(at, 0.1 * size)

    def load(self, at, size):
        return mr.Load(size, at, offset=self.round(-0.05, 0.05))

    def mass(self, at, size):
        return mr.AddedMass(float(f"{size / 9.81:.3g}"), at)

    def case(self, *kinds):
        """A wall that is shaken as strongly as overturns it, more or less."""
        wall = self.wall()
        peak = self.within(0.8, 4.0) * wall.alpha * 9.81
        motion = mr.GroundMotion.synthetic(peak, self.round(2, 6), seed=int(self.rng.integers(100)))
        stop = (
            mr.SideStop(self.round(0.4, 0.9) * 2 * wall.h) if self.rng.random() < 0.5 else bool(self.rng.random() < 0.5)
        )
        up = motion.scaled(0.5) if self.rng.random() < 0.3 else None
        effects = self.effects(wall, *kinds)
        return mr.Case(wall, 0.0, motion.duration + 2, side_stop=stop, motion=motion, vertical=up, effects=effects)

    def answer(self, case):
        return mr.solve_analytical(case, mr.Restitution.from_geometry(case.block), output_step=0.01)

    def both(self, *kinds):
        """A case under both polarities, with names."""
        case = self.case(*kinds)
        turned = mr.Case(case.block, 0.0, case.duration, side_stop=case.side_stop, effects=case.effects,
                         motion=case.motion.reversed(), vertical=case.vertical)  # fmt: skip
        return [self.answer(case), self.answer(turned)]

    def bond(self):
        unit = self.round(0.2, 0.6), self.round(0.1, 0.3)
        long, high = self.rng.integers(2, 9), self.rng.integers(2, 9)
        return mr.Masonry.running_bond(long * unit[0], high * unit[1], unit, k_n=1e9)

    @staticmethod
    @functools.cache
    def thrown(seed):
        """A stack of which some blocks fall: one of a seed, which all pictures of such stacks draw."""
        some = Random(seed)
        blocks = [
            mr.Block.from_size(some.round(0.2, 0.3), some.round(0.3, 0.6)) for _ in range(some.rng.integers(2, 5))
        ]
        masonry = mr.Masonry.stack(blocks, k_n=1e7)
        velocity = [(some.within(0, 3), 0.0, some.within(0, 2)) for _ in blocks]
        return mr.solve_explicit(mr.MasonryCase(masonry, some.within(0.3, 1.0), velocity=velocity), forces=True)

    def curves(self):
        ways = (Random.tie, Random.load, Random.thrust)
        found = {}
        for name in self.names(self.rng.integers(1, 4)):
            case = self.case(*ways)
            found[name] = mr.pushover(mr.Case(case.block, 0.0, 1.0, effects=case.effects))
        return found

    def fit(self):
        levels = np.repeat(self.within(0.1, 0.5) * np.arange(1, 7), 10)
        return mr.fit_fragility(levels, self.rng.random(60) < levels / levels.max())

    def islands(self):
        """Ranges of some records that nobody has run."""
        names, scales = self.names(self.rng.integers(1, 7)), np.linspace(0.0, self.within(1, 20), 21)
        shares = np.round(2 * self.rng.random((len(names), 21))) / 2
        own = tuple(
            tuple(mr.Island(s, s, s, np.nan, (s, s), (s, s), 1.0) for s in scales[row == 1][-1:]) for row in shares
        )
        return mr.Thresholds(tuple(names), scales, shares, own, (0.0, 1e-6), 99)

    def map(self):
        """Endings of some pulses that nobody has run."""
        periods, amplitudes = np.sort(self.rng.uniform(0.1, 3.0, 7)), self.within(1, 20) * np.arange(1, 10)
        endings = self.rng.integers(0, 4, (7, 9))
        return mr.OverturningMap(periods, amplitudes, endings, 1.0 * (endings > 0))

    def study(self):
        """A study of sensitivity that nobody has run."""
        settings = ("k_n", "points", "thickness", "restitution")[: self.rng.integers(1, 5)]
        base = dict(zip(settings, (1e9, 2, 0.6, 0.9), strict=False))
        rows, changed = [base], [()]
        for name in settings:
            for factor in self.within(0.1, 0.9), self.within(1.1, 30):
                rows.append(base | {name: base[name] * factor})
                changed.append((name,))
        values = self.within(0.1, 1.0) * (1 + self.within(0.001, 1.0) * self.rng.random(len(rows)))
        if self.rng.random() < 0.3:
            values[-1] = np.inf
        return mr.Sensitivity("peak_over_alpha", settings, base, tuple(rows), values, tuple(changed))


def spectra(some):
    target = mr.code_spectrum("EC8 type 1", ag=some.within(0.5, 4), soil="B")
    motions = [mr.GroundMotion.synthetic(some.within(0.5, 4), 3.0, seed=i) for i in range(some.rng.integers(1, 5))]
    return plotting.spectra(motions, np.geomspace(0.1, some.within(0.5, 3), 20), target)


def incremental(some):
    levels = np.sort(some.rng.random(8)) * some.within(0.2, 2)
    peaks = some.rng.random((some.rng.integers(1, 12), 8)) * levels / levels[-1]
    return plotting.incremental(levels, np.where(peaks > some.within(0.2, 1.0), np.inf, peaks), "MuJoCo")


def fragility(some):
    ax = None
    for name in some.names(some.rng.integers(1, 4)):
        given = () if ax is None else (ax,)
        ax = plotting.fragility(*given, some.fit(), solver=name)
    return ax


def pushed(some):
    along = np.linspace(0.0, some.within(0.01, 2.0), 9)
    force = some.within(1, 1e5) * along * (2 * along[-1] - along)
    one = mr.Push(along, force, 0 * along, "", some.thrown(some.seed), energy=along)
    return plotting.push(dict.fromkeys(some.names(some.rng.integers(1, 4)), one))


def designed(some):
    site = mr.code_spectrum("NTC 2018", ag=some.within(0.5, 4), F0=2.45, Tc=0.33, soil="C")
    height, values = some.round(3, 9), np.round(np.sort(some.rng.random(some.rng.integers(2, 6))) + 0.3, 2)
    return plotting.design(mr.design(lambda t: mr.Case(mr.Block.from_size(t, height), 0.0, 1.0), values.tolist(), site))


def mechanism(some):
    return plotting.mechanism(mr.collapse_multiplier(some.bond()))


def tied(some):
    while not (answer := some.answer(some.case(Random.tie))).ties:
        pass
    return answer


PICTURES = {
    "acceleration": lambda some: plotting.acceleration(some.case(), 3.0),
    "blocks": lambda some: plotting.blocks(some.bond() if some.rng.random() < 0.5 else some.thrown(some.seed)),
    "comparison": lambda some: plotting.comparison([some.answer(some.case())], some.names(1)[0]),
    "design": designed,
    "displacement": lambda some: plotting.displacement([some.thrown(some.seed)]),
    "energy": lambda some: plotting.energy([some.answer(some.case())]),
    "fragility": fragility,
    "grid": lambda some: plotting.grid([(name, some.both(Random.load)) for name in some.names(3)]),
    "history": lambda some: plotting.history(some.both(Random.tie, Random.load), labels=some.names(2)),
    "incremental": incremental,
    "mechanism": mechanism,
    "moment_rotation": lambda some: plotting.moment_rotation(some.curves()),
    "overturning_map": lambda some: plotting.overturning_map(some.map(), some.case().block),
    "panels": lambda some: plotting.panels(
        [(name, lambda ax: plotting.rotation(ax, some.both())) for name in some.names(2)]
    ),
    "push": pushed,
    "pushover": lambda some: plotting.pushover(some.curves()),
    "record": lambda some: plotting.record([some.case().motion, some.case().motion]),
    "rotation": lambda some: plotting.rotation(some.both(Random.load, Random.thrust), some.names(2)),
    "single": lambda some: plotting.single(lambda ax: plotting.blocks(ax, some.thrown(some.seed))),
    "sketch": lambda some: plotting.sketch(
        some.case(Random.tie, Random.thrust, Random.load, Random.mass), some.names(1)[0]
    ),
    "spectra": spectra,
    "thresholds": lambda some: plotting.thresholds(some.islands(), "m/s²"),
    "thrust": lambda some: plotting.thrust(some.thrown(some.seed)),
    "ties": lambda some: plotting.ties([tied(some)]),
    "tornado": lambda some: plotting.tornado(some.study()),
}


def label_of(name, seed):
    """What is wrong with the words of a picture of random things."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what is drawn may be odd
        drawn = PICTURES[name](Random(seed))
    figure = drawn.get_figure(root=True) if isinstance(drawn, Axes) else drawn
    figure.draw_without_rendering()
    return list(covered(figure))


def test_every_public_picture_is_tried():
    pictures = {name for name in plotting.__all__ if inspect.isfunction(getattr(plotting, name))}
    assert pictures - {"animate", "save", "view"} == set(PICTURES)


@pytest.mark.slow
@pytest.mark.parametrize("name", PICTURES)
def test_words_of_every_picture_are_free(name):
    """Every day `test_baselines` draws one picture of each kind."""
    found = {seed: message for seed in range(INPUTS) if (message := label_of(name, seed))}
    assert found == {}
