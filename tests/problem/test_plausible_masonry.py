"""What is odd about masonry warns as it does for a wall, with both numbers, and plausible masonry does not."""

import warnings
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from everyday import slow
from masonry_blocks import GROUND, box, columns

import mjrock as mr
from mjrock.scene.time_step import warn_if_tiny

STACK = columns(3)
BLOCK = mr.Masonry.box((0.6, 0.4, 3.0), k_n=1e9)
RECORD = mr.GroundMotion.synthetic(peak=4.0, duration=12.0, seed=2)


def case(masonry=STACK, **options):
    return mr.MasonryCase(masonry, **({"duration": 15.0} | options))


def tied(**options):
    return case(effects=mr.Tie(4.0, **({"stiffness": 12e6, "block": 3} | options)))


MISUSE = {
    "record in g": (
        lambda: case(motion=RECORD.scaled(peak=0.35)),
        r"the record peaks at 0\.0357 g; this masonry starts to rock at 0\.14\d g: is the record in g\?",
    ),
    "record in g, in space": (lambda: case(BLOCK, motion=RECORD.scaled(peak=0.35)), r"starts to rock at 0\.2 g"),
    "a run shorter than its record": (
        lambda: case(duration=3.0, motion=RECORD),
        r"the run of 3 s ends before the record of 12 s, and leaves out \d+% of its Arias intensity",
    ),
    "thrust in kN": (
        lambda: case(effects=mr.Thrust(4.0, 3.0, block=3)),
        r"Thrust: force = 3 N, and the masonry weighs 4\.\d+e\+04 N: is it in kN",
    ),
    "load in kN": (lambda: case(BLOCK, effects=mr.Load(1.0, at=(0, 0, 3), block=1)), "Load: force = 1 N, .* in kN"),
    "mass in t": (lambda: case(effects=mr.AddedMass(0.1, 4.0, block=3)), r"mass = 0.1 kg, that of the masonry .* in t"),
    "E as stiffness": (lambda: tied(stiffness=2e11), r"2e\+11 N/m is above 1e\+10 N/m"),
    "strength in kN": (lambda: tied(strength=2.0), "Tie: strength = 2 N"),
    "stiffness in kN/m": (
        lambda: tied(stiffness=12e3, strength=80e3),
        r"yields at an elongation of 6.67 m, and its block is 1\.5\d* m thick",
    ),
    "slack in mm": (lambda: tied(slack=5.0), r"slack = 5 m, and where it is held the masonry opens by 0.6 m"),
    "ultimate in mm": (lambda: tied(strength=8e3, ultimate=8.0), r"ultimate = 8 m, .* the masonry opens by 0.6 m"),
    "slip force in kN": (
        lambda: case(effects=mr.FrictionDamper(4.0, 1e7, 2.0, block=3)),
        r"FrictionDamper: slip_force = 2 N, .* is it in kN\?",
    ),
    "damper in kN s/m": (lambda: case(effects=mr.Damper(4.0, 0.5, block=3)), r"Damper: c = 0.5 N s/m .* in kN s/m\?"),
    "jack in mm": (
        lambda: case(effects=mr.Actuator(3, (-0.3, 4.0), 1, ([0.0, 1.0], [0.0, 5.0]), 1e7)),
        r"actuator_0: displacement reaches 5 m, and the masonry is 0.6 m long there: is it in mm\?",
    ),
    "jack in kN/mm": (
        lambda: case(effects=mr.Actuator(3, (-0.3, 4.0), 1, ([0.0, 1.0], [0.0, 5e-3]), 10.0)),
        r"actuator_0: stiffness = 10 N/m pushes with at most 0.05 N, .* is it in N/m\?",
    ),
    "strength of mortar in MPa": (lambda: mr.Bond(0.2, 0.3, 18.0, 125.0), r"tension = 0.2 Pa, .* is it in MPa\?"),
    "cohesion in MPa": (lambda: mr.Bond(2e5, 0.3, 18.0, 125.0), r"cohesion = 0.3 Pa, .* is it in MPa\?"),
    "energy in N/mm": (lambda: mr.Bond(2e5, 3e5, 0.018, 0.125), r"opening_energy = 0.018 J/m2, .* is it in N/mm\?"),
    "xi in percent": (lambda: columns(1, 1e9, xi=5.0), r"xi = 5 is 500% of critical; damping ratios are fractions"),
    "slack in mm, in space": (
        lambda: case(BLOCK, effects=mr.Tie(stiffness=1e7, slack=5.0, at=(-0.3, 0, 3), block=1)),
        r"slack = 5 m, .* opens by 0.6 m",
    ),
    "frequency of another masonry": (
        lambda: columns(1, 1e9, frequency=0.01),
        r"frequency = 0\.01 rad/s, and the lowest one of this masonry is 42\.6 rad/s: with xi = 0\.05 that one "
        r"is damped to 213 times critical, c/k = 10 s",
    ),
    "frequency far above": (lambda: columns(1, 1e9, frequency=1e8), r"damped to \d\.\d\de-0\d times critical"),
    "timestep in ns": (
        lambda: mr.solve_explicit(case(columns(1), duration=1e-5), timestep=1e-9),
        r"timestep = 1e-09 s, and 0\.00\d+ s is short enough",
    ),
    "timestep in ns in MuJoCo": (
        lambda: mr.simulate(case(columns(1), duration=1e-5), timestep=1e-9),
        r"timestep = 1e-09 s, and 0\.00\d+ s is short enough",
    ),
}


@pytest.mark.parametrize("misuse", MISUSE)
def test_misuse_is_doubted_once(misuse):
    make, doubt = MISUSE[misuse]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        make()
    complaint = [one for one in caught if issubclass(one.category, mr.Implausible)]
    assert len(complaint) == 1
    assert Path(mr.__file__).parent not in Path(complaint[0].filename).parents  # it points at the call
    with pytest.warns(mr.Implausible, match=doubt):
        make()


def test_a_force_by_an_actuator_on_a_soft_spring_is_not_doubted():
    """A force of the weight at a displacement of 10 m, of masonry that is 0.6 m long."""
    force = sum(block.mass for block in columns(1).blocks if not block.fixed) * mr.GRAVITY
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        case(effects=mr.Actuator(3, (-0.3, 4.0), 1, ([0.0, 1.0], [0.0, 10.0]), force / 10))


def test_a_thousandth_of_the_step_that_is_needed_is_doubted():
    with pytest.warns(mr.Implausible, match=r"timestep = 9\.9e-07 s, and 0\.001 s is short enough"):
        warn_if_tiny(9.9e-7, 1e-3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_if_tiny(1.01e-6, 1e-3)


def plausible(rng):
    """Masonry as an engineer has it, with its effects, under a record."""
    k_n, xi = 10 ** rng.uniform(8, 11), rng.choice([0.01, 0.05, 0.3])
    thickness = rng.uniform(0.3, 1.0)
    height = thickness * rng.uniform(4, 10)
    if rng.random() < 0.3:
        return mr.MasonryCase(mr.Masonry.arch(rng.uniform(2, 6), 0.6, voussoirs=9, k_n=k_n, xi=xi), 4.0)
    parts = np.linspace(0, height, int(rng.integers(2, 6)))
    blocks = [box(-thickness / 2, thickness / 2, *ends) for ends in pairwise(parts)]
    masonry = mr.Masonry([GROUND, *blocks], k_n=k_n, xi=xi)
    if rng.random() < 0.5:
        own = 2 * xi / masonry.retardation.max()
        masonry = mr.Masonry([GROUND, *blocks], k_n=k_n, xi=xi, frequency=own * rng.uniform(0.1, 3))
    top, effects, weight = len(blocks), [], sum(block.mass for block in blocks) * mr.GRAVITY
    if rng.random() < 0.6:
        section, length = np.pi / 4 * rng.uniform(0.012, 0.036) ** 2, rng.uniform(1, 12)
        strength, slack = rng.choice([np.inf, 235e6 * section]), rng.choice([0.0, 0.02])
        tie = mr.Tie(height, 210e9 * section / length, slack=slack, strength=strength, length=length, block=top)
        effects.append(tie)
    if rng.random() < 0.4:
        effects.append(mr.Load(rng.uniform(0.01, 0.5) * weight, height, block=top))
        effects.append(mr.AddedMass(rng.uniform(0.005, 0.2) * weight / mr.GRAVITY, height, block=top))
    motion = mr.GroundMotion.synthetic(9.81 * rng.uniform(0.1, 0.8), 10.0, seed=int(rng.integers(99)), dt=0.02)
    return mr.MasonryCase(masonry, rng.uniform(9.5, 14), motion, effects=tuple(effects))


def plausible_blocks(rng):
    """A wall in running bond, or a facade in space whose openings cut units, with a tie on it."""
    joints = {"k_n": 10 ** rng.uniform(8, 11), "xi": rng.choice([0.01, 0.05]), "friction": rng.uniform(0.4, 0.8)}
    long, density = rng.uniform(0.2, 1.2), rng.uniform(1300, 2600)
    unit = long, long * rng.uniform(0.25, 0.5)
    height, thickness = unit[1] * rng.integers(3, 9), long * rng.uniform(0.4, 1.0)
    motion = mr.GroundMotion.synthetic(9.81 * rng.uniform(0.1, 0.8), 10.0, seed=int(rng.integers(99)), dt=0.02)
    if rng.random() < 0.5:
        wall = mr.Masonry.running_bond(long * rng.uniform(2, 6), height, unit, thickness, density=density, **joints)
        return mr.MasonryCase(wall, 11.0, motion)
    length, depth = long * rng.uniform(4, 7), thickness + long * rng.uniform(0.6, 3)
    door = mr.Opening(rng.uniform(0.8, 1.2) * long, unit[1] * rng.choice([1.0, 1.3]))
    shape = {"thickness": thickness, "openings": [(0.0, door)] if rng.random() < 0.5 else [], "density": density}
    facade = mr.Masonry.facade(length, height, depth, unit, **shape, **joints, gable=int(rng.integers(0, 3)))
    section, reach = np.pi / 4 * rng.uniform(0.012, 0.036) ** 2, rng.uniform(1, 12)
    block = next(i for i, name in enumerate(facade.names) if name.startswith(f"facade_{round(height / unit[1]) - 1}_"))
    at = facade.blocks[block].corners.mean(axis=0) - [0.5 * thickness, 0.0, 0.0]
    held = {"at": tuple(at), "anchor": tuple(at - [reach, 0.0, 0.0]), "block": block}
    tie = mr.Tie(stiffness=210e9 * section / reach, strength=235e6 * section, ultimate=0.05, **held)
    return mr.MasonryCase(facade, 11.0, motion, effects=tie)


@pytest.mark.parametrize(("make", "count"), [(plausible, 40), slow((plausible, 400)), slow((plausible_blocks, 210))])
def test_plausible_masonry_raises_hardly_an_alarm(make, count):
    """Less than 0.5 % warn; an opening whose edge leaves too small a piece is refused and drawn again."""
    rng, made, alarms = np.random.default_rng(0), 0, []
    while made < count:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                make(rng)
            except ValueError:
                continue
        made += 1
        alarms += [str(one.message) for one in caught]
    assert len(alarms) < 0.005 * made, alarms[:5]


@pytest.mark.parametrize(("name", "values"), [("friction", 0.5), ("k_n", 1e9), ("xi", 0.05), ("k_s", 1e9)])
def test_a_function_of_the_joint_is_asked_once(name, values):
    """One with a state would otherwise be checked at one value and used at another."""
    requested = []

    def of_joint(joint):
        requested.append(joint.name)
        return values if len(requested) <= 3 else -1.0

    masonry = mr.Masonry(STACK.blocks, **{name: of_joint})
    mr.solve_explicit(mr.MasonryCase(masonry, 1e-3))
    assert requested == [joint.name for joint in masonry.joints]
    assert getattr(masonry.table, name).tolist() == 3 * [values]


@pytest.mark.parametrize("frequency", [1e-2, 1.0, 1e6])
def test_a_retardation_at_any_frequency_is_no_doubt(frequency):
    """xi = c/k x frequency / 2 gives the joints that c/k."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        masonry = columns(1, 1e9, xi=0.5 * 1e-4 * frequency, frequency=frequency)
    assert masonry.retardation == pytest.approx(1e-4)
