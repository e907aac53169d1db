"""The law along the normal is asked wherever it is used: a spring that stiffens, k u^3/2, closes the accounts too."""

import math
import sys

import numpy as np
import pytest
from by_hand import alone, system
from everyday import crossed

from mjrock.distinct import loop
from mjrock.distinct.contacts import touches
from mjrock.distinct.loop import Clock
from mjrock.distinct.rows import kinds
from mjrock.distinct.search import handover
from mjrock.distinct.search.handover import Lines
from mjrock.distinct.step_length import Impacts
from mjrock.distinct.supports import moving
from mjrock.distinct.system import Books, Samples
from mjrock.problem.masonry.laws import joint_law
from mjrock.rows import rows

BOTH = pytest.mark.parametrize("d", [2, 3])
K, DEEPEST = 4e5, 0.02
STIFFENING = {
    "secant_stiffness": lambda row, depth: row.k * math.sqrt(depth),
    "equivalent_stiffness": lambda row, depth: 0.8 * row.k * math.sqrt(depth),
    "tangent_stiffness": lambda row, depth: 1.5 * row.k * np.sqrt(depth),
    "largest_stiffness": lambda row: 1.5 * row.k * math.sqrt(DEEPEST),
    "depth_of_force": lambda row, factor, depth: factor ** (2 / 3) * depth,
    "depth_of_energy": lambda row, factor, depth: factor**0.4 * depth,
}


@pytest.fixture
def stiffening(monkeypatch):
    """The law of a spring k u^3/2, in all modules that ask the law."""
    for name, text in STIFFENING.items():
        law = getattr(joint_law, name)
        for module in [module for key, module in sys.modules.items() if key.startswith("mjrock.")]:
            if vars(module).get(name) is law:
                monkeypatch.setattr(module, name, text)


def test_the_law_is_that_of_the_spring(stiffening):
    row = rows(kinds(2).line, 1, k=K)[0]
    assert joint_law.normal_force(row, -0.01, 0.0) == pytest.approx(K * 0.01**1.5)
    assert joint_law.stored(row, -0.01) == pytest.approx(0.4 * K * 0.01**2.5)
    slope = (joint_law.normal_force(row, -0.011, 0.0) - joint_law.normal_force(row, -0.009, 0.0)) / 0.002
    assert joint_law.tangent_stiffness(row, 0.01) == pytest.approx(slope, rel=1e-3)


def test_no_function_of_the_spring_is_forgotten():
    """They stand from the first to the last in one row of the module."""
    of_module = joint_law.__name__
    functions = [name for name, value in vars(joint_law).items() if getattr(value, "__module__", "") == of_module]
    first, last = functions.index("secant_stiffness"), functions.index("depth_of_energy")
    assert functions[first : last + 1] == list(STIFFENING)


def landing(d, h, c=0.0, fall=-0.5, k_s=math.inf):
    """A block that does not turn falls on the ground and springs back: samples, and its velocity at the end."""
    whole = system(d, 2, still=True)
    whole = whole._replace(supports=moving((), d))
    whole.bodies["inverse_inertia"] = whole.bodies["spin"] = whole.bodies["velocity"] = 0.0
    if d == 3:
        whole.bodies["inverse_in_world"] = whole.bodies["momentum"] = 0.0
    whole.bodies["velocity"][0, -1], whole.bodies["velocity"][0, 0] = fall, 0.3
    whole.bodies["place"][1, -1] = 1e3  # far away
    for i, line in enumerate(whole.lines):
        line.normal, line.between, line.at[0], line.k, line.c = np.eye(d)[-1], 0.0113 * np.eye(d)[-1], 0.1 * i, K, c
        line.friction, line.k_s, line.body = 0.3, k_s, 0
    account, last = Books.empty(whole, 1), round(0.06 / h)
    samples = Samples.room(last + 1, whole, account, ledger=True)
    clock = Clock(h=h, steps_per_sample=1, stop=last + 1, last=last, ground_acceleration_before=(0.0,) * d)
    assert loop.advance.py_func(whole, account, samples, clock, alone(whole)) == (last + 1, last + 1, False)
    assert whole.lines["depth"].max() == 0.0
    return samples.chosen(slice(-1)), whole.bodies["velocity"][0]


def unpaid(samples):
    """Largest energy without an account, over that of the fall [-]."""
    energy = samples.energy
    whole = energy["kinetic"] + energy["potential"] + energy["elastic"] + energy["friction"]
    whole = whole + samples.dashpots.sum(axis=1) - energy["ground"]
    return np.abs(whole - whole[0]).max() / np.ptp(energy["kinetic"])


@pytest.mark.parametrize(("d", "damping"), crossed([2, 3], [(0.0, math.inf), (60.0, 2e4), (60.0, math.inf)]))
def test_the_ledger_of_a_block_that_lands_closes(stiffening, d, damping):
    """The mean of two forces does the work of a curved spring but for the square of the step, at touches too."""
    c, k_s = damping
    shares = [unpaid(landing(d, h, c, k_s=k_s)[0]) for h in (2e-3, 1e-3, 5e-4)]
    assert shares[-1] < 1e-3
    assert shares[0] > 2.5 * shares[1] > 6 * shares[2]


@BOTH
def test_a_block_springs_back_as_fast_as_it_lands(stiffening, d):
    """Without dashpots and friction it has the energy of its fall again, and sinks in as far as that takes."""
    samples, _ = landing(d, 2.5e-4)
    heights, energy = samples.pose[:, 0, d - 1] + 0.0113, samples.energy
    deepest = -heights.min()
    mass, gravity = 2.0, 9.81
    rate = math.sqrt(0.25 + 2 * gravity * 0.0113)
    assert 2 * 0.4 * K * deepest**2.5 == pytest.approx(0.5 * mass * rate**2 + mass * gravity * deepest, rel=2e-3)
    assert energy["elastic"].max() == pytest.approx(2 * 0.4 * K * deepest**2.5, rel=2e-3)
    up = samples.velocity[:, 0, d - 1]
    level = np.interp(0.0, heights[len(heights) // 2 :], up[len(heights) // 2 :])
    assert level == pytest.approx(rate, rel=1e-3)


def test_a_linear_formula_at_a_touch_would_not_close(stiffening, monkeypatch):
    """A twin: touches that have k for the stiffness of the spring leave energy without an account."""
    for name in ("secant_stiffness", "equivalent_stiffness"):
        monkeypatch.setattr(touches, name, lambda row, depth: row.k)
    assert unpaid(landing(2, 5e-4)[0]) > 5e-3


def test_a_find_keeps_force_and_energy_of_such_springs(stiffening):
    """Three lines give way to two places: the places press as much at most, and hold no more."""
    old = rows(kinds(2).line, 3, k=[1e4, 2e4, 3e4])
    new = rows(kinds(2).line, 2, k=[4e4, 5e4])
    gone, places = Lines.unwritten(old, np.zeros(3)), Lines.unwritten(new, np.zeros(2))
    gone.depth[:], places.depth[:] = [0.004, 0.003, 0.005], [0.009, 0.008]

    class Found:
        gap = np.array([-0.01, -0.01])

    handover.press(places, (0, 2), Found, gone, (0, 3))
    both = (old, gone.depth), (new, places.depth)
    force, held = (
        [sum(row.k * depth**power for row, depth in zip(*of, strict=True)) for of in both] for power in (1.5, 2.5)
    )
    assert force[1] <= force[0] * (1 + 1e-12)
    assert held[1] <= held[0] * (1 + 1e-12)
    assert max(force[1] / force[0], held[1] / held[0]) == pytest.approx(1.0)


def test_impacts_have_the_stiffness_of_the_law(stiffening):
    whole = system(2, 2, still=True)
    whole.lines["normal"], whole.lines["k"] = [0.0, 1.0], K
    stiffness = 2 * 1.5 * K * math.sqrt(DEEPEST)
    assert Impacts.at_joints(whole).frequency == pytest.approx(math.sqrt(stiffness / 2.0))
