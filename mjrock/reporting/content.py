"""What a report says of walls and masonry alike: inputs with their units, effects, contacts, motions and versions."""

from __future__ import annotations

import dataclasses
import math
import platform
from collections.abc import Sequence
from typing import Any, NamedTuple

import matplotlib
import mujoco
import numpy
import scipy

from .._version import __version__
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.masonry.case import AnyCase
from ..problem.wall.effect import Told
from ..quantities import GRAVITY, declared
from ..result.response import Response
from ..study.intensity.fragility import Fragility
from .markup import Markup, element, table
from .texts import FOUND, GIVEN, Words, texts
from .verdicts import REVERSED, told_name

ASKED = {"accuracy": ("", GIVEN), "timestep": ("s", GIVEN), "rtol": ("", GIVEN), "atol": ("", GIVEN), "steps": ("", 9)}
"""What is said of a run of a solver, its unit and its digits."""


class Input(NamedTuple):
    """An input of the report.

    Args:
        key: its name in the program, by which `basis` names it.
        name: in words.
        value: with its unit.
        computed: whether it follows from others, and rests on nothing of its own.
    """

    key: str
    name: str
    value: str
    computed: bool = False


def of_effects(case: AnyCase, words: Words) -> list[Input]:
    """The effects."""
    told = [(name, effect.told, told_name(name, effect, words)) for name, effect in case.named.items()]
    return [Input(name, said, described(effect, words)) for name, effect, said in told if effect is not None]


def described(effect: Told, words: Words) -> str:
    """An effect in words: each of its numbers, and what it is called; as it says itself where these are not known."""
    if not words.or_else(f"effect_{effect.label}", ""):
        return effect.said.replace("\n", " ")
    kind: Any = type(effect)  # mypy takes a class for a thing without a hash
    units = {name: "" if within.whole else within.unit for name, (within, _) in declared(kind).items()}
    units["strength"] = "N"
    said = []
    for field in dataclasses.fields(kind):
        value, own = getattr(effect, field.name), f"field_{effect.label}_{field.name}"
        key = own if own in texts() else f"field_{field.name}"
        if value is None or value == math.inf or key not in texts():
            continue
        if isinstance(value, str):
            said.append(words(key, value=words(f"governed_{value}")))
        elif isinstance(value, tuple):
            said.append(words(key, value="; ".join(words.number(x) for x in value)))
        else:
            unit = "m" if field.name in ("height", "anchor_height") else units.get(field.name, "")
            said.append(words(key, value=words.quantity(value, unit)))
    return ", ".join(said)


def of_contacts(e: Restitution | None, contacts: Contacts | None, words: Words) -> list[Input]:
    """Restitution, stiffness and damping."""
    rows = []
    if e is not None:
        for name in ("base", "side", "lumped"):
            rows.append(Input(f"e_{name}", words(f"in_e_{name}"), words.number(getattr(e, name), FOUND)))
    if contacts is not None:
        law = words.or_else(f"law_{contacts.law.lower()}", contacts.law)
        rows.append(Input("law", words("in_law"), law))
        for name, face in (("base", contacts.base), ("side", contacts.side)):
            if face is not None:
                friction = words("sticks") if face.friction is None else words.number(face.friction)
                values = {"k": words.quantity(face.k_n, "N/m3"), "xi": words.share(face.xi), "points": face.points}
                rows.append(Input(f"k_{name}", words(f"in_k_{name}"), words("face", friction=friction, **values)))
    return rows


def of_motions(responses: Sequence[Response], words: Words) -> list[tuple[str, ...]]:
    """The ground motions of the responses, each once, in one polarity."""
    rows: dict[tuple[str, str], tuple[str, ...]] = {}
    for response in responses:
        for direction, motion in response.case.grounds.items():
            peak = float(abs(motion.accel).max())
            sizes = words.quantity(peak, "m/s2", FOUND), words.quantity(peak / GRAVITY, "g", FOUND)
            name = motion.name.removesuffix(REVERSED)
            times = words.quantity(motion.duration, "s"), words.quantity(motion.dt, "s")
            rows.setdefault((direction, name), (name, words(f"ground_{direction}"), *sizes, *times))
    return list(rows.values())


def solved_with(responses: Sequence[Response], words: Words) -> list[str]:
    """How the responses were solved, a sentence for each solver."""
    said = []
    for solver in dict.fromkeys(response.solver for response in responses):
        own = [response.stats for response in responses if response.solver == solver]
        asked = []
        for name, shown in ASKED.items():
            if values := [stats[name] for stats in own if stats.get(name)]:
                low, high = (words.quantity(value, *shown) for value in (min(values), max(values)))
                asked.append(words(f"solved_{name}", value=low if low == high else words("range", low=low, high=high)))
        solved = words.or_else(f"solver_{solver}", solver)
        said.append(words("solved", solver=solved, count=len(own), how=", ".join(asked)))
    return said


def of_fragility(fits: dict[str, Fragility], words: Words) -> Markup:
    """Fragility curves as a table."""
    rows = []
    for name, fit in fits.items():
        spans = (fit.median, *fit.median_interval(0.9)), (fit.dispersion, *fit.dispersion_interval(0.9))
        numbers = [[words.number(value, FOUND) for value in span] for span in spans]
        cells = [words("interval", value=value, low=low, high=high) for value, low, high in numbers]
        groups = words("independent") if fit.groups is None else str(fit.groups)
        rows.append((name, *cells, str(fit.count), groups))
    heads = [words(f"fragility_{key}") for key in ("name", "median", "dispersion", "runs", "groups")]
    return element("div", table(heads, rows, right=(3, 4)), element("p", words("fragility_note")))


def versions(words: Words) -> list[tuple[str, ...]]:
    """Versions of what has computed this, and what was drawn by chance."""
    made = {
        "mjrock": __version__,
        "MuJoCo": mujoco.__version__,
        "NumPy": numpy.__version__,
        "SciPy": scipy.__version__,
        "matplotlib": matplotlib.__version__,
        "Python": platform.python_version(),
    }
    return [
        (words("versions"), ", ".join(f"{name} {version}" for name, version in made.items())),
        (words("seed"), words("seed_said")),
    ]


def code_chapter(solvers: Sequence[str], kinematic: bool, words: Words) -> list[tuple[str, ...]]:
    """The chapter of NTC 2018, 10.2: what the clause asks to be said, and the answer."""
    used = [words("kinematic_analysis")] * kinematic + [words.or_else(f"solver_{solver}", solver) for solver in solvers]
    keys = "origin", "basis", "field", "validation", "results"
    said = [(words(f"ntc_{key}"), words(f"ntc_{key}_said", version=__version__)) for key in keys]
    return [(words("ntc_kind"), "; ".join(used)), *said]
