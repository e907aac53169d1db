"""Numbers of few bits, fractions and decimals: the answer of the float of the same value, or a refusal by name.

NumPy computes with its small numbers in their own bits: np.uint8(100) * 4 is 144. Each argument of each public entry is
given as such a number, and what comes back has to be bitwise what the float gives.
"""

import dataclasses
import re
import warnings
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from arguments import BALL, OF_NUMBERS
from offenders import not_refused

import mjrock as mr
from mjrock.plotting import bodies
from mjrock.quantities import shown
from mjrock.study.intensity.ida import IncrementalAnalysis

WALL = mr.Block(0.5, 2.0)
E = mr.Restitution(0.75, -0.5)
SOFT = 2.0**29
CONTACTS = mr.Contacts.from_damping(WALL, k_base=SOFT, xi_base=0.0625, k_side=SOFT, xi_side=0.0625)
CASE = mr.Case(WALL, 0.125, 1.0)
MOTION = mr.GroundMotion([0.0, 1.0, 0.5], 0.25)
COLUMN = mr.Masonry.stack([WALL], SOFT)
SHORT, SHAKEN = mr.Case(WALL, 0.125, 0.0625), mr.MasonryCase(COLUMN, 0.0625)
TIMES = np.linspace(0.0, 1.0, 3)


def standing(scale):
    """An analysis that overturns from a scale of 4 on."""
    return dataclasses.replace(mr.Analysis(CASE, "analytical", E), case=mr.Case(WALL, 0.0, 2.0, motion=push(scale)))


def push(scale):
    return mr.GroundMotion([-2.0 * scale, -2.0 * scale], 1.0)


CALLS = OF_NUMBERS | {
    "Block": (mr.Block, {"b": 1, "h": 100, "length": 8, "density": 100, "inset": 0.5}),
    "Dry": (
        mr.Dry, {"k_n": 16384, "friction": 1, "xi": 1, "k_s": 16384, "frequency": 100, "points": 100},
    ),
    "Bond": (
        mr.Bond,
        {
            "tension": 100, "cohesion": 100, "opening_energy": 8, "slip_energy": 8, "crushing": 16384,
            "crushing_energy": 100,
        },
    ),
    "profile": (lambda z, t: mr.Block(1.0, 50.0, profile=[(0.0, 2.0), (z, t)]).inertia, {"z": 100, "t": 1}),
    "Restitution, stop": (lambda top: mr.Restitution.from_geometry(WALL, top), {"top": 3}),
    "Case": (lambda **given: mr.Case(WALL, **given), {"theta0": 0.125, "duration": 100, "omega0": 1}),
    "MasonryCase": (lambda duration: mr.MasonryCase(COLUMN, duration), {"duration": 100}),
    "Contacts.from_damping": (
        lambda **given: mr.Contacts.from_damping(mr.Block(5.0, 8.0), **given),
        {
            "k_base": 2**20, "xi_base": 1, "k_side": 16384, "xi_side": 1, "points": 100, "friction": 1,
            "side_friction": 1,
        },
    ),
    "Contacts.from_law": (
        lambda **given: mr.Contacts.from_law(WALL, E, **given),
        {"k_base": 2**29, "k_side": 2**29, "points": 100, "amplitude": 0.5, "friction": 1, "side_friction": 1},
    ),
    "law": (lambda **given: mr.CALIBRATED(WALL, E, **given), {"k_n": 2**29, "k_side": 2**29, "amplitude": 0.5}),
    "law.reach": (lambda **given: mr.CALIBRATED.reach(WALL, **given), {"k_n": 2**29, "amplitude": 0.5}),
    "law.covers": (
        lambda **given: mr.CALIBRATED.covers(WALL, E, **given), {"k_n": 2**29, "k_side": 2**29, "amplitude": 0.5},
    ),
    "PowerLaw": (
        lambda slenderness, k_n, e, **given: mr.PowerLaw(**given)(slenderness, k_n, e),
        {
            "coefficient": 0.5, "slenderness_exponent": 2, "stiffness_exponent": 2, "r_squared": 1, "slenderness": 100,
            "k_n": 100, "e": 0.5,
        },
    ),
    "DampingLaw": (
        lambda **given: dataclasses.replace(
            mr.CALIBRATED, **{name: (1, value) for name, value in given.items() if name != "scale"},
            side=dataclasses.replace(mr.CALIBRATED.side, scale=given["scale"]),
        ),
        {"R_range": 100, "slenderness_range": 100, "k_n_range": 100, "side_range": 1, "scale": 1},
    ),
    "reference_frequency": (lambda **given: mr.reference_frequency(WALL, **given), {"k_n": 16384, "points": 100}),
    "wall_stiffness": (lambda E: mr.wall_stiffness(E, WALL), {"E": 2**20}),
    "measured_stiffness": (lambda **given: mr.measured_stiffness(WALL, **given), {"frequency": 100, "points": 100}),
    "layered_stiffness": (lambda one, two: mr.layered_stiffness(one, two), {"one": 32768, "two": 32768}),
    "contact_stiffness": (
        lambda k, c, d, inverse_weight: mr.contact_stiffness((k, c), (d, d), inverse_weight=inverse_weight),
        {"k": -100, "c": -100, "d": 0.5, "inverse_weight": 100},
    ),
    "contact_for": (
        lambda **given: mr.contact_for(BALL, "ball", "floor", **given),
        {
            "k": 2**20, "restitution": 0.5, "friction": 1, "mass": 1, "contacts": 4, "timestep": 2.0**-14,
            "newmark_beta": 1,
        },
    ),
    "rebound": (lambda restitution: mr.contact_for(BALL, "ball", "floor", k=1e6, xi=restitution), {"restitution": 1}),
    "simulate": (
        lambda **given: mr.simulate(SHORT, CONTACTS, **given),
        {"timestep": 2.0**-10, "accuracy": 2.0**-10, "newmark_beta": 1, "output_step": 2.0**-7},
    ),
    "simulate, fitted": (
        lambda **given: mr.simulate(SHORT, CONTACTS, **given), {"accuracy": 2.0**-10, "output_step": 2.0**-7},
    ),
    "simulate, masonry": (
        lambda **given: mr.simulate(SHAKEN, **given),
        {"timestep": 2.0**-10, "accuracy": 2.0**-10, "newmark_beta": 1, "output_step": 2.0**-7},
    ),
    "simulate, masonry, fitted": (
        lambda **given: mr.simulate(SHAKEN, **given), {"accuracy": 2.0**-10, "output_step": 2.0**-7},
    ),
    "solve_analytical": (
        lambda **given: mr.solve_analytical(CASE, E, **given),
        {"rtol": 2.0**-20, "output_step": 0.125, "rest": 2.0**-20},
    ),
    "solve_compliant": (
        lambda **given: mr.solve_compliant(SHORT, CONTACTS, **given),
        {"rtol": 2.0**-20, "atol": 2.0**-20, "output_step": 2.0**-7},
    ),
    "wall_mjcf": (
        lambda **given: mr.wall_mjcf(CASE, CONTACTS, **given), {"timestep": 2.0**-10, "newmark_beta": 1},
    ),
    "masonry_mjcf": (
        lambda **given: mr.masonry_mjcf(SHAKEN, **given), {"timestep": 2.0**-10, "newmark_beta": 1},
    ),
    "pushover": (lambda points: mr.pushover(CASE, points=points), {"points": 100}),
    "pushover with effects": (
        lambda **given: mr.pushover(
            mr.Case(
                WALL, 0.0, 1.0,
                effects=(mr.Load(given["load"], 4.0), mr.Tie(given["height"], given["stiffness"], 0.0, 100.0)),
            )
        ),
        {"load": 100, "height": 4, "stiffness": 100},
    ),
    "ida percentiles": (
        lambda share: IncrementalAnalysis(
            ("a", "b"), np.array([1.0]), np.array([[1.0], [2.0]]), ((), ())
        ).percentiles([share]),
        {"share": 100},
    ),
    "overturning_intensity": (
        lambda **given: mr.overturning_intensity(standing, **given), {"low": 0.5, "high": 8, "tolerance": 0.5},
    ),
    "matched_contacts": (
        lambda **given: mr.matched_contacts(WALL, mr.Restitution(0.875, -0.5), **given),
        {"k_base": 2**29, "points": 2, "amplitude": 0.5, "friction": 1, "accuracy": 0.0625},
    ),
    "as_theory": (
        lambda **given: mr.as_theory(WALL, mr.Restitution.from_geometry(WALL), side_stop=False, **given),
        {"rebounds": 2, "amplitude": 0.5},
    ),
    "matched_masonry": (lambda **given: mr.matched_masonry(COLUMN, **given), {"amplitude": 0.5, "accuracy": 0.0625}),
    "Plan": (
        lambda loss, low, high, **given: mr.Plan(losses=(loss,), k_n=(low, high), **given),
        {"base_count": 100, "side_count": 100, "seed": 100, "loss": 1, "low": 16384, "high": 32767},
    ),
    "Polygon": (
        lambda **given: mr.Polygon([(0, 0), (1, 0), (0, 1)], **given), {"density": 100, "length": 100},
    ),
    "Masonry": (
        lambda **given: mr.Masonry(COLUMN.blocks, **given),
        {"k_n": 16384, "friction": 1, "xi": 1, "frequency": 100, "points": 100, "tolerance": 2.0**-10},
    ),
    "Masonry.stack": (
        lambda **given: mr.Masonry.stack([WALL], side_stop=True, **given),
        {"k_n": 16384, "k_side": 16384, "side_friction": 1, "xi": 1},
    ),
    "Masonry.arch": (
        lambda **given: mr.Masonry.arch(k_n=1e9, **given),
        {"radius": 100, "thickness": 10, "span_angle": 1, "voussoirs": 20, "density": 100, "length": 100},
    ),
    "Masonry.running_bond": (
        lambda long, high, **given: mr.Masonry.running_bond(unit=(long, high), **given),
        {"length": 100, "height": 10, "thickness": 100, "density": 100, "long": 20, "high": 1},
    ),
    "GroundMotion": (lambda dt: mr.GroundMotion([0.0, 1.0], dt), {"dt": 0.5}),
    "scaled": (MOTION.scaled, {"factor": 1}),
    "scaled to a peak": (lambda peak: MOTION.scaled(peak=peak), {"peak": 1}),
    "resampled": (MOTION.resampled, {"dt": 0.5}),
    "sine": (mr.GroundMotion.sine, {"amplitude": 1, "period": 1, "cycles": 2, "samples": 100}),
    "half_sine": (mr.GroundMotion.half_sine, {"amplitude": 1, "duration": 1, "samples": 100}),
    "rectangular": (mr.GroundMotion.rectangular, {"amplitude": 1, "duration": 100}),
    "ricker": (mr.GroundMotion.ricker, {"amplitude": 1, "period": 1, "samples": 100}),
    "synthetic": (
        mr.GroundMotion.synthetic,
        {
            "peak": 1, "duration": 100, "seed": 100, "dt": 0.125, "ground_frequency": 1, "ground_damping": 1,
            "filter_frequency": 0.25, "filter_damping": 1, "rise": 0.25, "fall": 0.25,
        },
    ),
    "Bodies": (
        lambda magnify: bodies.Bodies.loose(
            TIMES, (np.eye(3, 2),), np.zeros((1, 2)), np.ones((3, 1, 3)), magnify
        ).extent(),
        {"magnify": 100},
    ),
}  # fmt: skip
"""Arguments by entry. Each number is one that the narrow types hold, as far as it is a whole one and small."""
NARROW = (np.int8, np.uint8, np.int16, np.float16, np.float32, Fraction, Decimal)
HUGE, TRUTHS = (Fraction(10**500, 3), -Fraction(10**500, 3), 10**500), (True, np.True_)
PAIRED = {("contact_stiffness", argument) for argument in "kcd"} | {
    *(("DampingLaw", argument) for argument in CALLS["DampingLaw"][1] if argument != "scale"),
    ("Plan", "low"),
    ("Plan", "high"),
}
"""Arguments that are given in pairs, of which NumPy makes an array: a fraction is refused there."""
CALLED = {
    "b": "half thickness", "h": "half height", "R": "half diagonal", "z": "profile", "t": "profile", "top": "top of",
    "k_n": "k_n", "k_base": "base stiffness", "k_side": "side stiffness", "xi_base": "damping ratio",
    "xi_side": "damping ratio", "xi": "xi", "theta0": "release rotation", "omega0": "release velocity",
    "wall": "alpha", "base": "base restitution", "side": "side restitution", "lumped": "lumped restitution",
    "one": "stiffnesses[0]", "two": "stiffnesses[1]", "k": "stiffness k|solref", "c": "damping c|solref",
    "d": "solimp", "mass": "mass", "anchor_height": "height of the anchor", "load": "force of the load",
    "scale": "side.scale", "share": "shares", "loss": "losses", "low": "low|k_n", "high": "high|k_n|unit height",
    "long": "unit length", "restitution": "restitution|damping ratio xi",
}  # fmt: skip
"""What messages call an argument, where that is not its name."""


def as_narrow(value, kind):
    """The value as a number of a kind, or None where that kind does not hold it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            made = kind(value)
        except OverflowError:
            return None
    return made if float(made) == value else None


def pieces(answer):
    """Everything in an answer but what depends on the clock: bytes, types and values."""
    if isinstance(answer, np.ndarray):
        return answer.dtype.str, answer.shape, answer.tobytes()
    if isinstance(answer, mr.Response | mr.MasonryResponse):
        stats = {name: value for name, value in answer.stats.items() if "time" not in name or name == "timestep"}
        return pieces([answer.case, answer.t, answer.pose, answer.energy, stats])
    if dataclasses.is_dataclass(answer):
        parts = [getattr(answer, one.name) for one in dataclasses.fields(answer)]
        seen = [getattr(answer, name) for name in ("mass", "inertia", "stiffness", "lines") if hasattr(answer, name)]
        return type(answer).__name__, [pieces(one) for one in parts + seen]
    if isinstance(answer, dict):
        return {name: pieces(value) for name, value in answer.items()}
    if isinstance(answer, tuple | list):
        return [pieces(one) for one in answer]
    if isinstance(answer, float):
        return "float", answer.hex()
    return type(answer).__name__, answer


def called(function, arguments):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return function(**arguments)


def refused(name, floats, argument, values):
    """The calls of an entry that are to be refused by the name of an argument, see `not_refused`."""
    words = [word for word in (argument, *CALLED.get(argument, "").split("|")) if word]
    complaint = "|".join(map(re.escape, words))
    for value in values:
        given = floats | {argument: value}
        yield f"{argument} = {shown(value)}", lambda given=given: called(CALLS[name][0], given), complaint


@pytest.mark.parametrize("name", CALLS)
def test_a_narrow_number_counts_as_the_float_of_its_value(name):
    function, arguments = CALLS[name]
    floats, offenders = {key: float(value) for key, value in arguments.items()}, []
    answer = pieces(called(function, floats))
    for argument, number in arguments.items():
        values = [value for kind in NARROW if (value := as_narrow(number, kind)) is not None]
        assert len(values) >= 3, argument
        no_float = (Decimal, Fraction) if (name, argument) in PAIRED else Decimal
        offenders += not_refused(refused(name, floats, argument, [one for one in values if isinstance(one, no_float)]))
        with np.errstate(over="raise", invalid="raise"):
            for value in values:
                same = isinstance(value, no_float) or pieces(called(function, floats | {argument: value})) == answer
                offenders += [] if same else [f"{argument} = {value!r} gives another answer"]
    assert offenders == []


@pytest.mark.parametrize("name", CALLS)
def test_what_no_float_holds_is_refused_by_name(name):
    floats, offenders = {key: float(value) for key, value in CALLS[name][1].items()}, []
    for argument in floats:
        values = HUGE if (name, argument) in PAIRED else HUGE + TRUTHS
        offenders += not_refused(refused(name, floats, argument, values))
    assert offenders == []


def test_the_small_numbers_of_numpy_made_a_wall_lighter():
    assert mr.Block(np.uint8(1), np.uint8(100)).mass == 800_000.0
    assert mr.Block.from_size(np.float16(0.5), np.float16(4), density=np.float16(2000)).inertia == pytest.approx(
        mr.Block.from_size(0.5, 4.0).inertia, rel=1e-15
    )
    with pytest.raises(ValueError, match="height of the tie is a number too large"):
        mr.Tie(Fraction(10**500, 3), 1e5)
