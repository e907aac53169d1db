"""What a report says: inputs with their units, results, and what to be careful of."""

from __future__ import annotations

import platform
from collections.abc import Sequence

import matplotlib
import mujoco
import numpy
import numpy as np
import scipy

from .._version import __version__
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import GRAVITY, named
from ..result.ending import Outcome
from ..result.response import Response
from ..result.ties import Plastic, overdrawn

TableRows = list[tuple[str, ...]]
"""Rows of a table."""


def of_wall(case: Case) -> TableRows:
    """The wall: quantity, value with unit."""
    block, wall = case.block, case.wall
    rows: TableRows = [
        ("thickness", f"{2 * block.b:.4g} m"),
        ("height", f"{2 * block.h:.4g} m"),
        ("length", f"{block.length:.4g} m"),
        ("density", f"{block.density:.4g} kg/m³"),
        ("inset", f"{block.inset:.4g} m"),
        ("mass, with added masses", f"{wall.mass:.5g} kg"),
        ("centroid_height", f"{wall.centroid_height:.4g} m"),
        ("alpha, rotation at which it falls alone", f"{wall.alpha:.4g} rad"),
        ("overturning_rotation, with effects", f"{case.overturning_rotation:.4g} rad"),
        ("p, frequency parameter", f"{wall.p:.4g} rad/s"),
    ]
    if block.gable is not None:
        rows.append(("gable", f"{block.gable.height:.4g} m high, {block.gable.top:.4g} m long at its top"))
    for opening in block.openings:
        rows.append(
            (
                "round opening" if opening.round else "opening",
                f"{opening.width:.4g} x {opening.height:.4g} m, sill {opening.sill:.4g} m",
            )
        )
    stop = "none: the wall rocks to both sides" if case.stop_top is None else f"up to {case.stop_top:.4g} m"
    return [*rows, ("side_stop", stop)]


def of_masonry(case: MasonryCase) -> TableRows:
    """Masonry: quantity, value with unit."""
    masonry = case.masonry
    mass = float(sum(masonry.blocks[i].mass for i in masonry.free))
    rows: TableRows = [
        ("blocks", f"{len(masonry.free)} free, {len(masonry.blocks) - len(masonry.free)} fixed"),
        ("joints", f"{len(masonry.joints)}, points = {masonry.points}"),
        ("mass of the free blocks", f"{mass:.5g} kg"),
    ]
    values = {"k_n": masonry.joint_stiffness, "k_s": masonry.joint_shear, "friction": masonry.joint_friction}
    for name, unit in (("k_n", " N/m³"), ("k_s", " N/m³"), ("friction", "")):
        low, high = values[name].min(), values[name].max()
        said = f"{low:.4g}{unit}" if low == high else f"{low:.4g} to {high:.4g}{unit}"
        rows.append((name, "sticks rigidly" if np.isinf(low) else said))
    retardation = masonry.retardation
    rows.append(("damping, c/k", f"{retardation.min():.3g} to {retardation.max():.3g} s"))
    return rows


def of_effects(case: Case | MasonryCase) -> TableRows:
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


def of_results(responses: Sequence[Response], names: Sequence[str]) -> TableRows:
    """Outcome, peak and impacts of each response."""
    rows: TableRows = []
    for response, name in zip(responses, names, strict=True):
        over, case = response.peak_over_alpha, response.of_wall[0]
        top = "-" if over == float("inf") else f"{1e3 * over * case.wall.alpha * 2 * case.block.h:.0f} mm"
        peak = "overturned" if over == float("inf") else f"{over:.3f}"
        share = "-" if over == float("inf") else f"{response.peak_over_overturning:.3f}"
        rows.append((name, response.outcome.value, peak, share, top, str(len(response.impacts))))
    return rows


def of_masonry_results(responses: Sequence[Response], names: Sequence[str]) -> TableRows:
    """Outcome, fallen blocks and largest motions of each response of masonry."""
    rows: TableRows = []
    for response, name in zip(responses, names, strict=True):
        fell = [f"{block} at {t:.3g} s" for block, t in response.fallen.items()]
        said = named(fell) if fell else "none"
        moved = f"{response.peak.max():.3g} rad", f"{1e3 * response.opening.max():.3g} mm"
        slid = f"{1e3 * response.sliding.max():.3g} mm"
        rows.append((name, response.outcome.value, said, *moved, slid))
    return rows


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


def masonry_cautions(responses: Sequence[Response], names: Sequence[str]) -> list[str]:
    """What to be careful of in the results of masonry."""
    said = []
    if len({bool(response.fallen) for response in responses}) > 1:
        said.append("The responses do not agree on whether blocks fall.")
    motions = [response.case.motion for response in responses if response.case.motion is not None]
    if motions and all(motion in (motions[0], motions[0].reversed()) for motion in motions):
        said.append("There is one ground motion: rocking is sensitive, and one record proves little.")
    if not any(response.solver == "explicit" for response in responses):
        said.append("In MuJoCo faces have no end, and blocks that fall meet no others. Explicit steps have both.")
    said.append("A margin depends on k_n and the points of the joints: repeat it with others.")
    return said + broken_ties(responses, names)


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


def cautions(case: Case, responses: Sequence[Response], names: Sequence[str]) -> list[str]:
    """What to be careful of in these results."""
    said = []
    outcomes = {response.outcome for response in responses}
    if Outcome.OVERTURNED in outcomes and len(outcomes) > 1:
        said.append("The responses do not agree on whether the wall overturns.")
    motions = [response.case.motion for response in responses if response.case.motion is not None]
    if case.one_sided and motions and all(motion.reversed() not in motions for motion in motions):
        said.append(
            "The wall opens to one side, and no motion is here in both polarities: run the reversed motion too."
        )
    if motions and all(motion in (motions[0], motions[0].reversed()) for motion in motions):
        said.append("There is one ground motion: rocking is sensitive, and one record proves little.")
    if not any(response.solver == "MuJoCo" for response in responses):
        said.append("Rocking theory has no stiffness of the base, and is most often the upper bound of the capacity.")
    if case.motion is None and not motions:
        said.append("There is no ground motion: this is the motion after a release.")
    for response, name in zip(responses, names, strict=True):
        if response.outcome is Outcome.TIME_ENDED:
            share = abs(float(response.theta[-1])) / float(case.wall.alpha)
            said.append(f"{name}: the wall still moves at the end of the run, at {share:.3g} alpha.")
        for tie, drawn in response.plastic.items():
            effect = response.case.links[tie]
            if overdrawn(effect, drawn):
                said.append(
                    f"{name}: {tie}, which never breaks here, was drawn out by {1e3 * drawn.elongation:.3g} mm, "
                    f"{drawn.elongation / effect.span:.1%} of its length."
                )
    return said + broken_ties(responses, names)


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
