"""What a report says of walls and masonry alike: inputs with their units, forces, ties and messages."""

from __future__ import annotations

import platform
from collections.abc import Sequence

import matplotlib
import mujoco
import numpy
import scipy

from .._version import __version__
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.masonry.case import AnyCase
from ..quantities import GRAVITY, named
from ..result.response import Response
from ..result.ties import Plastic

TableRows = list[tuple[str, ...]]
"""Rows of a table."""


def of_effects(case: AnyCase) -> TableRows:
    """The effects: name and values with units."""
    own = [(name, effect) for name, effect in case.named.items() if not effect.mass_added]
    masses = [("added mass", mass) for mass in case.effects if mass.mass_added]
    return [(name, effect.said.replace("\n", " ")) for name, effect in (*own, *masses)]


def of_contacts(e: Restitution | None, contacts: Contacts | None) -> TableRows:
    """Restitution, stiffness and damping."""
    rows: TableRows = []
    if e is not None:
        rows += [("e, base", f"{e.base:.4f}"), ("e, side", f"{e.side:.4f}"), ("e, lumped", f"{e.lumped:.4f}")]
    if contacts is not None:
        rows.append(("law of the damping", contacts.law))
        for name, face in (("base", contacts.base), ("side", contacts.side)):
            if face is None:
                continue
            friction = "holds" if face.friction is None else f"{face.friction:g}"
            said = f"{face.k_n:.4g} N/m³, damping ratio {face.xi:.3%}, friction {friction}, {face.points} lines"
            rows.append((f"k_{name}", said))
    return rows


def of_motions(responses: Sequence[Response]) -> TableRows:
    """The ground motions of the responses, each once."""
    rows: TableRows = []
    for grounds in (response.case.grounds for response in responses):
        for direction, name in (("horizontal", "motion"), ("transverse", "transverse"), ("vertical", "vertical")):
            if (motion := grounds.get(name)) is not None:
                peak = float(abs(motion.accel).max())
                said = f"{peak:.4g} m/s² = {peak / GRAVITY:.3g} g, {motion.duration:.4g} s, step {motion.dt:.4g} s"
                rows.append((direction, motion.name, said))
    return list(dict.fromkeys(rows))


def settings(responses: Sequence[Response]) -> tuple[str, list[str]]:
    """How the responses were solved: what all of them share, and what else each of them has."""
    own = [_settings(response) for response in responses]
    shared = [part for part in own[0] if all(part in parts for parts in own)]
    return ", ".join(shared), [", ".join(part for part in parts if part not in shared) for parts in own]


def _settings(response: Response) -> list[str]:
    """How a response was solved, in parts."""
    known = ("accuracy", "timestep", "newmark_beta", "rtol", "atol", "steps")
    values = ((name, response.stats.get(name)) for name in known)
    said = [f"{name} {value:.3g}" if name != "steps" else f"{value} steps" for name, value in values if value]
    return [response.solver, *said]


def of_ties(responses: Sequence[Response], names: Sequence[str]) -> TableRows:
    """What each tie did in each response."""
    rows: TableRows = []
    for response, name in zip(responses, names, strict=True):
        for tie, motion in response.ties.items():
            drawn = response.plastic.get(tie, Plastic(0.0, 0.0))
            taken = f"{1e3 * drawn.elongation:.3g} mm", f"{drawn.energy + drawn.lost:.4g} J"
            broke = "-" if motion.broken == float("inf") else f"{motion.broken:.3f} s"
            rows.append((name, tie, f"{motion.largest_force / 1e3:.4g} kN", *taken, broke))
    return rows


def of_forces(responses: Sequence[Response], names: Sequence[str]) -> TableRows:
    """The largest reaction and the largest normal force of a joint, of each response that has kept its forces."""
    rows: TableRows = []
    for response, name in zip(responses, names, strict=True):
        if response.kept_forces is not None:
            forces, normal = response.forces, response.forces.normal.max(axis=0)
            joint = int(normal.argmax())
            reaction, pressed = (f"{force / 1e3:.4g} kN" for force in (forces.largest_reaction, normal[joint]))
            rows.append((name, reaction, pressed, forces.joints[joint]))
    return rows


def of_messages(responses: Sequence[Response], names: Sequence[str]) -> list[str]:
    """The messages, each once with the responses that it is said of: by name up to three of them, else by number."""
    said: dict[str, list[str]] = {}
    for response, name in zip(responses, names, strict=True):
        said.setdefault(response.message, []).append(name)
    return [
        f"{', '.join(of) if len(of) <= 3 else f'{len(of)} of {len(names)} responses'}: {message}"
        for message, of in said.items()
    ]


def broken_ties(responses: Sequence[Response], names: Sequence[str]) -> list[str]:
    """Which ties broke, in a sentence for all that broke in the same runs."""
    broke: dict[str, dict[str, float]] = {}
    for response, name in zip(responses, names, strict=True):
        for tie, drawn in response.plastic.items():
            if drawn.broken < float("inf"):
                broke.setdefault(tie, {})[name] = drawn.broken
    alike: dict[tuple[str, ...], list[str]] = {}
    for tie, when in broke.items():
        alike.setdefault(tuple(when), []).append(tie)
    said = []
    for runs, ties in alike.items():
        first = min(broke[tie][name] for tie in ties for name in runs)
        held = sum(ties[0] in response.ties for response in responses)
        count = f"all {held}" if len(runs) == held else f"{len(runs)} of {held}"
        one = f"{runs[0]}: {named(ties)} broke"
        many = f"{named(ties)} broke in {count} runs with {'it' if len(ties) == 1 else 'them'}"
        said.append(f"{one if len(runs) == 1 else many}, first at {first:.3f} s.")
    return said


def versions() -> TableRows:
    """Versions of what has computed this."""
    return [
        ("mjrock", __version__),
        ("MuJoCo", mujoco.__version__),
        ("NumPy", numpy.__version__),
        ("SciPy", scipy.__version__),
        ("matplotlib", matplotlib.__version__),
        ("Python", platform.python_version()),
    ]
