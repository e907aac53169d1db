"""The same case gives the same bits, whatever the process ran before, and beside other threads."""

import sys
import threading

import numpy as np
import pytest
from everyday import among
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.setup import masonry_at_rest
from mjrock.engine import model
from mjrock.scene.masonry import masonry_scene

SINE = mr.GroundMotion.sine(3.0, 0.3, 2)
WALL = mr.Block.from_size(0.5, 2.0)
SIDED = mr.Case(WALL, 0.2 * WALL.alpha, 0.4)
OFF_CENTRE = [
    mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True),
    mr.Polyhedron.box((0.6, 0.5, 0.8), (0, 0, 0.4)),
    mr.Polyhedron.box((0.5, 0.5, 0.7), (0.03, 0.02, 1.15)),
]
BOXES = mr.Masonry(OFF_CENTRE, k_n=3e8, friction=0.7)
STACK = mr.Masonry.stack([mr.Block.from_size(0.5, 1.0)] * 2, 1e9, friction=0.4)
FLAT = [box(x, x + 0.4, 0.5 * j, 0.5 * j + 0.5) for j in range(4) for x in 0.1 * (j % 2) + np.array([-0.9, -0.45, 0])]
PILE = mr.Masonry([GROUND, *FLAT], k_n=2e7, friction=0.3, xi=0.1)
TIE = mr.Tie(1.5, 1e6, strength=2e3, block=2, length=1.0)


def on(k_n, **options):
    """The wall beside a stop on joints of another stiffness, which have the same text but for their rows."""
    return mr.simulate(
        SIDED, mr.Contacts.from_damping(WALL, k_base=k_n, xi_base=0.02, k_side=1e8, xi_side=0.1), **options
    )


def shaken(masonry, duration, solve=mr.simulate, amplitude=3.0, **options):
    return solve(mr.MasonryCase(masonry, duration, motion=mr.GroundMotion.sine(amplitude, 0.3, 3)), **options)


def thrown(seed, settled=True):
    """A pile whose blocks leave their joints and meet others."""
    velocity = np.random.default_rng(seed).normal(0.0, 1.5, (len(PILE.free), 3))
    return mr.solve_explicit(mr.MasonryCase(PILE, 0.06, velocity=velocity, settled=settled), output_step=5e-3)


RUNS = {
    "boxes": (
        lambda: mr.simulate(mr.MasonryCase(BOXES, 0.15, tilt=([0.0, 0.2], [0.0, -0.3]))),
        lambda: shaken(BOXES, 0.1),
        lambda: shaken(BOXES, 0.1, timestep=1e-4, coulomb=True),
        lambda: shaken(BOXES, 0.1, mr.solve_explicit),
    ),
    "stack": (
        lambda: mr.simulate(mr.MasonryCase(STACK, 0.3, velocity=[(0.2, 0, 0), (1.0, 0, 0)])),
        lambda: mr.simulate(mr.MasonryCase(STACK, 0.3, motion=SINE, effects=TIE)),
        lambda: shaken(STACK, 0.2),
    ),
    "wall": (lambda: on(1e8), lambda: on(1e9), lambda: on(1e8, timestep=1e-3), lambda: on(1e9, timestep=5e-4)),
    "pile": (
        lambda: thrown(1),
        lambda: thrown(2),
        lambda: mr.solve_explicit(mr.MasonryCase(PILE, 0.05, settled=False)),
    ),
}
"""Runs that share what the package keeps, of one masonry or of one model text."""


def forget():
    """Empty what the package keeps from one run to the next."""
    model._idle.clear()
    for name, module in list(sys.modules.items()):
        if name.startswith("mjrock."):
            for kept in vars(module).values():
                if hasattr(kept, "cache_parameters"):
                    kept.cache_clear()


def bits(run):
    """All numbers of a response."""
    return b"".join(np.ascontiguousarray(part).tobytes() for part in (run.t, run.pose, run.velocity, run.energy))


def in_all_pairs(count):
    """Numbers in an order in which each follows each of all, itself too, once."""
    return [each for i in range(count) for each in (i, *(k for j in range(i + 1, count) for k in (i, j)))] + [0]


def alone(kind):
    """What each run of a kind gives in a process that has kept nothing."""
    answers = []
    for run in RUNS[kind]:
        forget()
        answers.append(bits(run()))
    return answers


@pytest.mark.filterwarnings("ignore:with a fixed step", "ignore:a step of", "ignore:.* lie inside each other")
@pytest.mark.parametrize("kind", among(list(RUNS), "boxes"))
def test_one_case_after_another(kind):
    """Each pair in both orders, and each after itself."""
    wanted = alone(kind)
    before = "nothing"
    for number in in_all_pairs(len(wanted)):
        assert bits(RUNS[kind][number]()) == wanted[number], f"run {number} after {before}"
        before = f"run {number}"


@pytest.mark.filterwarnings("ignore:.* lie inside each other")
@pytest.mark.parametrize("kind", among(["boxes", "pile"], "boxes"))
def test_cases_of_one_masonry_side_by_side(kind):
    """Compiled loops run in threads at the same time."""
    wanted, runs, found = alone(kind), RUNS[kind], {}

    def run(number):
        found[number] = bits(runs[number % len(runs)]()) == wanted[number % len(runs)]

    threads = [threading.Thread(target=run, args=(number,)) for number in range(len(runs) + 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == dict.fromkeys(range(len(runs) + 1), True)


def arrays_in(thing, path=""):
    """The bits of all arrays that can be reached from something, by how they are reached."""
    if isinstance(thing, np.ndarray):
        return {path: thing.tobytes()}
    if isinstance(thing, tuple | list):
        parts = dict(enumerate(thing))
    else:
        parts = thing if isinstance(thing, dict) else getattr(thing, "__dict__", {})
    return {at: bits for name, part in parts.items() for at, bits in arrays_in(part, f"{path}.{name}").items()}


@pytest.mark.parametrize("settled", [True, False])
def test_a_run_writes_into_nothing_that_others_share(settled):
    kept = masonry_at_rest(masonry_scene(mr.MasonryCase(PILE, 1.0, settled=settled)))
    before = arrays_in(kept)
    thrown(1, settled)
    after = arrays_in(kept)
    assert len(before) > 50
    assert [at for at in before if after[at] != before[at]] == []
