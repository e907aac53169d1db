"""Unusual values of a case: they are possible, but most often in another unit. One sentence each."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...quantities import GRAVITY, Implausible, percent_text, warn_of
from ..ground.motion import GroundMotion
from .effect import Anchored, Effect, resistance
from .effects import AddedMass, Load, Thrust
from .restoring_moment import TiePull, moment_at_strength, pulled
from .tie import Tie

NEGLIGIBLE_SHARE = 1e-4
"""Share of the weight, or of the mass, below which a force or a mass is taken for one in kN or t [-]."""
LEAST_OF_WALL = 1e-3
"""The same of one wall: a force that is given in kN for one in N is this share of the weight, if it should be that."""
EXCESSIVE = 1000.0
"""Force of a tie, damper, load or thrust over the weight above which it is taken for one in another unit [-]: a jack
presses a panel with up to some 200 times its weight, and a bar of 30 mm holds 100 times a small model."""
STIFFEST = 1e10
"""Stiffness above which that of a tie is taken for a modulus [N/m]; a steel bar of 100 mm and 1 m has 1.6e9."""
CUT_OFF = 0.2
"""Share of the Arias intensity of a record that a run may leave out [-]."""
LARGEST_PEAK_IN_G = 1.0
"""Peak up to which a record may be one in g that was read as m/s2 [m/s2]."""
FAINT_RECORD = 0.6
"""Peak of a record over the acceleration at which the wall starts to rock, up to which it is odd to run it [-]."""
RELEASE_BEYOND = 1.1
"""Rotation of release over that which overturns the wall, up to which it may be a study of the limit [-]."""
RELEASE_SPEED_BEYOND = 3.0
"""The same of the velocity of release [-]."""

LOW_TIE = 0.6
"""Height of the highest tie over that of the wall below which the part above is looked at [-]."""
LOW_STOP = 0.9
"""Height of a side stop over `rebound_height` below which a base that holds decides what the wall does [-]: on one of
friction 0.6 peaks differ by 21 % in the median there, against higher stops by 3 % (`scripts/checks/low_stop.py`)."""


def rebound_height(case: Any) -> float:
    """Height at which a side stop stops a wall and leaves the inner edge of its base at rest [m].

    A higher stop presses that edge against the ground behind it and throws the wall back, e_side < 0. A lower one
    pushes the base outwards.
    """
    wall = case.wall
    face = wall.centroid_offset - wall.inner_face(case.stop_top or 0.0)
    edge = wall.half_base + wall.centroid_offset
    return float(wall.centroid_height + (wall.inertia / wall.mass + edge * face) / wall.centroid_height)


def warn_of_low_stop(case: Any) -> None:
    """Warn of a base that holds under a wall whose side stop is so low that the base decides what the wall does."""
    top = case.stop_top
    if top is not None and top < LOW_STOP * (height := rebound_height(case)):
        warn_of(
            f"the side stop reaches {top:.4g} m, and one below {LOW_STOP * height:.4g} m pushes the base "
            "outwards; here the base cannot slide. On a base of friction 0.6 peaks differ by more than 10 %, "
            "against still lower stops rebounds too: give the contacts the friction that the base has",
            Implausible,
        )


def warn_if_still(is_still: bool, *, forces: bool = False) -> None:
    """Warn of a run of a wall that nothing moves, unless the forces at rest are required."""
    if is_still and not forces:
        warn_of(
            "theta0 = 0, omega0 = 0, motion = None and vertical = None: nothing moves the wall, and the run is "
            "one of rest; give the case a release or a motion",
            Implausible,
        )


def doubts(case: Any) -> list[str]:
    """What is odd about a `mjrock.Case`, in words; empty for a plausible one."""
    return [*_release_doubts(case), *_motion_doubts(case), *_wall_effect_doubts(case), *_free_part_doubts(case)]


def _release_doubts(case: Any) -> list[str]:
    limit = case.overturning_rotation
    if abs(case.theta0) > RELEASE_BEYOND * limit > 0 and (case.theta0 > 0 or not case.lopsided):
        return [
            f"theta0 = {case.theta0:g} rad is {abs(case.theta0) / case.wall.alpha:.3g} alpha: the wall overturns from "
            f"{limit / case.wall.alpha:.3g} alpha; rotations are radians"
        ]
    moment = case.restoring.towards(case.direction)
    if case.released_outwards and not case.pulls and moment.alpha > 0:
        energy_to_overturn = float(moment.energy(moment.alpha))
        if case.release_energy > RELEASE_SPEED_BEYOND**2 * energy_to_overturn:
            speed = abs(case.omega0) / math.sqrt(case.release_energy / energy_to_overturn)
            return [
                f"omega0 = {case.omega0:g} rad/s: {speed:.3g} rad/s overturn the wall already; velocities are in rad/s"
            ]
    return []


def _motion_doubts(case: Any) -> list[str]:
    start = max(case.restoring.outer.P, 0.0) / (case.wall.weight * case.wall.centroid_height)
    at_rest = not case.omega0 and not case.theta0 and case.vertical is None
    return record_doubts(case.motion, case.duration, "wall", start if at_rest else math.inf)


def record_doubts(motion: GroundMotion | None, duration: float, label: str, start: float) -> list[str]:
    """What is odd about the record of a run of a duration [s].

    Args:
        motion, duration: the record and the duration.
        label: what is shaken.
        start: acceleration over g at which it starts to move from rest [-], infinite where that is not known.
    """
    if motion is None:
        return []
    messages, peak = [], motion.peak / GRAVITY
    if 0 < peak < FAINT_RECORD * start and start <= motion.peak <= LARGEST_PEAK_IN_G:
        messages.append(
            f"the record peaks at {peak:.3g} g; this {label} starts to rock at {start:.3g} g: is the record in g? "
            "Accelerations are in m/s2"
        )
    if duration < motion.duration:
        total, within_run = motion.arias_intensity, float(np.interp(duration, motion.times, motion.arias_intensities))
        if within_run < (1 - CUT_OFF) * total:
            messages.append(
                f"the run of {duration:g} s ends before the record of {motion.duration:g} s, and leaves out "
                f"{percent_text(1 - within_run / total)} of its Arias intensity"
            )
    return messages


def _wall_effect_doubts(case: Any) -> list[str]:
    def size_of(link: Anchored) -> HeldSize:
        b, opening = case.block.b, max(case.restoring.outer.alpha, case.wall.alpha)
        pull = TiePull.from_tie(link, case.block)._replace(reach=link.span)
        return HeldSize(2 * b, float(pulled(pull, opening, 1.0)[0]))

    return effect_doubts(case.effects, Subject("wall", "the wall", case.block.mass, LEAST_OF_WALL), size_of)


class Subject(NamedTuple):
    """What effects act on.

    Args:
        label: its name in messages.
        part: what of it a tie is anchored to, in messages.
        mass: its mass without what is added [kg].
        least: share of its weight or mass below which a force or a mass is taken for one in kN or t [-].
    """

    label: str
    part: str
    mass: float
    least: float = NEGLIGIBLE_SHARE


class HeldSize(NamedTuple):
    """How thick the wall or block is that a link holds, and how far it opens there until it overturns [m]."""

    thickness: float
    opening: float


HeldSizeOf = Callable[[Anchored], HeldSize]
"""The size of what a link holds."""


def effect_doubts(effects: Sequence[Effect], subject: Subject, size_of: HeldSizeOf) -> list[str]:
    """What is odd about effects."""
    messages = []
    weight = subject.mass * GRAVITY
    for i, effect in enumerate(effects):
        name = f"effects[{i}], {type(effect).__name__}"
        if isinstance(effect, Thrust | Load):
            if 0 < abs(effect.force) < subject.least * weight:
                messages.append(_weight_doubt(name, "force", effect.force, subject, "kN"))
            elif abs(effect.force) > EXCESSIVE * weight:
                messages.append(_weight_doubt(name, "force", effect.force, subject, "N"))
        elif isinstance(effect, AddedMass) and 0 < effect.mass < subject.least * subject.mass:
            messages.append(
                f"{name}: mass = {effect.mass:g} kg, that of the {subject.label} {subject.mass:.3g} kg: is it in t?"
            )
        elif isinstance(effect, Anchored):
            messages += filter(
                None, (doubt(name, effect, subject, size_of) for doubt in (_dashpot_doubt, _spring_doubt))
            )
    return messages


def _free_part_doubts(case: Any) -> list[str]:
    """Whether the part above the highest tie would rock before the tied wall does."""
    wall, highest = case.wall, max((tie.height for tie in case.each(Tie)), default=math.inf)
    if highest >= LOW_TIE * 2 * wall.h:
        return []
    levels, thicknesses = zip(*(wall.profile or ((0.0, 2 * wall.b),)), strict=True)
    thickness, free = float(np.interp(highest, levels, thicknesses)), 2 * wall.h - highest
    moment = case.restoring.outer.P + moment_at_strength(case.pulls)
    part, whole = thickness / free, moment / (wall.weight * wall.centroid_height)
    if part >= whole:
        return []
    starts = f"at {whole:.3g} g, its ties at their strength" if whole < math.inf else "never, as its ties do not yield"
    return [
        f"the highest tie holds at {highest:g} m of {2 * wall.h:g} m: the part above it, {thickness:.3g} m thick, "
        f"starts to rock on its own weight at {part:.3g} g, and the wall {starts}. One rigid block does not have that "
        "mechanism: take the part above as a wall of its own, or both as Masonry.stack"
    ]


def _spring_doubt(name: str, link: Anchored, subject: Subject, size_of: HeldSizeOf) -> str:
    """At most one doubt about the spring of a link and its limits, empty where there is none."""
    law, limit, weight = link.law, link.limit, subject.mass * GRAVITY
    if not law.k > 0:
        return ""
    if law.strength < subject.least * weight:
        return _weight_doubt(name, limit, law.strength, subject, "kN")
    if law.k > STIFFEST:
        return f"{name}: stiffness = {law.k:g} N/m is above {STIFFEST:g} N/m: is it a modulus E in Pa?"
    thickness, opening = size_of(link)
    if math.isfinite(law.strength) and law.strength / law.k > thickness:
        return (
            f"{name} yields at an elongation of {law.strength / law.k:.3g} m, and {subject.part} is {thickness:g} m "
            "thick: is its stiffness in N/m?"
        )
    if math.isfinite(law.strength) and law.strength > EXCESSIVE * weight:
        return _weight_doubt(name, limit, law.strength, subject, "N, and no stress in Pa")
    for argument, length in (("slack", law.reach - link.span), ("ultimate", law.ultimate)):
        if math.inf > length > opening > 0:
            return (
                f"{name}: {argument} = {length:g} m, and where it is held the {subject.label} opens by {opening:.3g} m "
                f"until it overturns: is the {argument} in m?"
            )
    return ""


def _dashpot_doubt(name: str, link: Anchored, subject: Subject, size_of: HeldSizeOf) -> str:
    """A doubt about the dashpot of a link, by its force at the speed sqrt(g t) of a wall of thickness t that falls."""
    speed, weight = math.sqrt(GRAVITY * size_of(link).thickness), subject.mass * GRAVITY
    force = resistance(link.law, speed)
    if not force > 0 or NEGLIGIBLE_SHARE * weight <= force <= EXCESSIVE * weight:
        return ""
    dashpot, unit = f"c = {link.law.c:g} N s/m", "kN s/m" if force < weight else "N s/m"
    if not link.law.c > 0:
        dashpot, unit = "its dashpot", "N and m/s"
    return (
        f"{name}: {dashpot} bears {force:.3g} N at {speed:.2g} m/s, at which the {subject.label} falls, "
        f"and it weighs {weight:.3g} N: is it in {unit}?"
    )


def _weight_doubt(name: str, field: str, value: float, subject: Subject, unit: str) -> str:
    weight = f"{subject.mass * GRAVITY:.3g} N"
    return f"{name}: {field} = {value:g} N, and the {subject.label} weighs {weight}: is it in {unit}?"
