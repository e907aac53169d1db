"""The push that rigid masonry bears, by limit analysis: what grows, what is constant, and what stands by wedging."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ...problem.masonry.case import MasonryCase
from ...problem.masonry.effects import applied, dragged, pulls_of
from ...problem.masonry.limit.collapse import Collapse, limit_of, pushed
from ...problem.masonry.limit.pose import posed
from ...problem.masonry.limit.statics import MOVES, Pulls, falling
from ...problem.masonry.lines import mean_slip_rates
from ...problem.masonry.masonry import Masonry
from ...problem.wall.effect import Effect
from ...problem.wall.effects import link_effects
from ...quantities import (
    Array,
    Implausible,
    named,
    require_array,
    require_flag,
    require_kind,
    require_reals,
    require_within,
    shown,
)
from ...scene.masonry import wedged

NOTHING, BORNE = 1e-6, 1e-3
"""Multiplier that counts as none, and that of associated friction from which something is borne [-]."""


def collapse_multiplier(
    masonry: Masonry,
    direction: float | ArrayLike | None = 1,
    *,
    angle: float | None = None,
    associated: bool = True,
    loads: Mapping[str, ArrayLike] | None = None,
    effects: Sequence[Effect] | Effect = (),
    pose: ArrayLike | None = None,
) -> Collapse:
    """The largest horizontal acceleration over g that masonry of rigid blocks stands, and the mechanism beyond it.

    A horizontal force on every block, proportional to its weight, grows for as long as forces at the contact lines
    balance it, pressing and within the cones of friction. The joints are those of the masonry, with its `points`. In
    space a cone is a pyramid of eight edges within it, of which one lies along the resultant of all forces that grow.

    Limit analysis has two answers. With associated friction what slides also opens its joint, as if the cone were its
    plastic potential. A linear programme then has one answer, and where blocks slide it is an upper bound of that of
    Coulomb friction. Without dilatancy what slides stays closed. There are many states then in which forces within the
    cones do not stop a mechanism, as the joints may be more or less wedged. The answer is the least multiplier that a
    descent finds from some starts, and `Collapse.others` has the rest. A state below it may exist.

    Faces are rigid and have no law of pressure, so that normal forces may gather anywhere in a joint. What a face in
    space bears in torsion follows from where they do: with associated friction at its corners, 0.71 mu N a for a square
    of side a where even pressure has 0.38 (Orduna and Lourenco, International Journal of Solids and Structures 42,
    2005), and without dilatancy at its middle where it has a point there, which bears none.

    Self-stress may hold what no load brings about, as a block between two upright faces. `Collapse.wedged` names such
    blocks: rest is looked for on joints without load, as the solvers do.

    Bonds of mortared joints hold their tension and cohesion everywhere at once, which moves the apex of the cones. As
    they soften, this is an upper bound.

    Args:
        masonry: the masonry.
        direction: of the force, which is opposite to the acceleration of the ground: 1 along x, -1 against it, or in
            space a vector in plan, shape (2,), of any length. None for `loads` alone.
        angle: of the force in plan, from x towards y [rad], -2 pi to 2 pi, in space; it takes the place of `direction`.
        associated: whether sliding opens joints. False for friction without dilatancy, which takes some seconds for a
            hundred blocks in the plane, and half a minute for thirty in space.
        loads: further forces that grow with the multiplier, by the name of their block: at its centroid along x and z
            [N], or with the moment about it, positive where it turns the top to the right [N m], shape (2,) or (3,); in
            space forces along x, y and z, or with three moments, shape (3,) or (6,).
        effects: what is constant beside the weight, `Load` and `Thrust`, `AddedMass`, whose inertia grows with that of
            the blocks, and `Tie`, which pulls with up to its strength, and is not slack at rest. In a pose it pulls
            where it is longer than at rest and has not been drawn out beyond its `ultimate` elongation. Each names its
            block as in a `MasonryCase`.
        pose: where the blocks have moved, as a `Response` has them: displacement of the centroids [m] and rotation
            [rad], positive where tops turn to the right, shape (free, 3), in space displacement and unit quaternion,
            (free, 7); or of all blocks, with supports that have moved, as `response.at(t)` gives them. Joints are those
            at rest. Lines press that have no gap beyond the `tolerance` of the masonry, and effects move with their
            blocks. The multiplier is then the largest force that goes with equilibrium there, below zero where the
            masonry is held back. Friction is associated, and joints are dry.

    Returns:
        The `Collapse`: `multiplier` [-], and the mechanism and the forces of the joints at it.

    Raises:
        TypeError, ValueError: for masonry that falls under its weight and what is constant, with the names of the
            blocks, a direction or a load out of range, an effect of another kind or a slack tie, or if no state
            without dilatancy is found.

    Warns:
        Implausible: for blocks that stand only by wedging, and where no torsion is borne without dilatancy.

    Examples:
        >>> arch = mr.Masonry.arch(radius=5.0, thickness=0.9)
        >>> round(float(mr.collapse_multiplier(arch).multiplier), 2)
        0.23
    """
    require_kind("masonry", masonry, Masonry)
    dilates = require_flag("associated", associated)
    if not dilates:
        masonry.require_dry("collapse_multiplier without dilatancy")
    given = _required(masonry, effects)
    laws = [link.law for link in link_effects(given).values()]
    if pose is not None:
        masonry.require_dry("collapse_multiplier in a pose")
        if not dilates:
            raise ValueError("associated = False goes with masonry at rest; a pose takes associated friction")
        masonry, given = posed(masonry, pose, given)
    none = direction is None and angle is None
    push = np.zeros(3 if masonry.in_space else 2) if none else horizontal(masonry, direction, angle)
    grown = _loads(masonry, {} if loads is None else loads) + pushed(masonry, push) + dragged(masonry, given, push)
    if not grown.any():
        raise ValueError("direction = None needs loads that grow with the multiplier, and there are none")
    links = tuple(link_effects(given).values())
    spans, constant = [link.span for link in links], applied(masonry, given)
    strength = np.array([law.pulls_at(span) for law, span in zip(laws, spans, strict=True)])
    ties = Pulls.of(masonry, pulls_of(masonry, links), strength)
    if pose is not None:
        return limit_of(masonry, push, grown, constant, ties=ties, least=-math.inf)
    falls = falling(masonry, constant, ties)
    if falls:
        under = "the weight and the effects" if given else "the weight"
        raise ValueError(f"the masonry cannot stand: {named(falls)} would fall under {under}")
    found = limit_of(masonry, push, grown, constant, associated=dilates, ties=ties)
    found = replace(found, wedged=wedged(masonry, given))
    if found.wedged:
        warnings.warn(
            f"{named(found.wedged)} would stand only by wedging, and slide down from joints that nothing presses "
            "together; the multiplier is that of blocks that are wedged",
            Implausible,
            stacklevel=2,
        )
    if not dilates and (turning := _turning(found, grown, constant, ties)):
        warnings.warn(
            f"multiplier = {abs(found.multiplier):.1g}: {named(turning)} turn about their normals without friction, "
            "since rigid faces let normal forces gather in a point; give points = 2, or associated=True for an upper "
            "bound",
            Implausible,
            stacklevel=2,
        )
    return found


def _required(masonry: Masonry, effects: Sequence[Effect] | Effect) -> tuple[Effect, ...]:
    """Effects as a case of the masonry takes them. An error names one whose force the motion alone decides."""
    given = MasonryCase(masonry, 1.0, effects=effects, settled=False).effects  # type: ignore[arg-type]
    for i, effect in enumerate(given):
        links = link_effects([effect]).values()
        if effect.force_vector is None and not effect.mass_added and not any(link.law.holds for link in links):
            raise TypeError(
                f"effects[{i}] is a {type(effect).__name__}, whose force depends on the motion; limit analysis takes "
                "Load, Thrust, AddedMass and Tie"
            )
        for link in links:
            if link.law.pulls_at(link.span) == 0:
                slack = link.law.reach - link.span
                raise ValueError(
                    f"effects[{i}], slack = {slack:g} m: the tie holds nothing as the masonry begins to move; the "
                    "valid value is 0"
                )
    return given


def _turning(found: Collapse, grown: Array, constant: Array, ties: Pulls) -> tuple[str, ...]:
    """Names of joints that press and turn about their normals in a mechanism of no multiplier, where only that is why:
    associated friction, which has corners of the faces press, bears something."""
    masonry = found.masonry
    if masonry is None or not masonry.in_space or found.forces is None or abs(found.multiplier) > NOTHING:
        return ()
    if limit_of(masonry, found.direction, grown, constant, ties=ties).multiplier < BORNE:
        return ()
    count, lines = len(masonry.joints), masonry.lines
    rates = np.abs(mean_slip_rates(masonry.blocks, lines, count) @ found.motion.ravel()).reshape(3, count)
    widths = np.array([joint.width for joint in masonry.joints])
    twists = (found.forces.normal > 0) & (masonry.joint_friction > 0) & (rates[2] * widths > MOVES * rates.max())
    return tuple(joint.name for joint, twisted in zip(masonry.joints, twists, strict=True) if twisted)


def _loads(masonry: Masonry, loads: Mapping[str, ArrayLike]) -> Array:
    """Loads by the name of their block as forces and moments of free blocks, shape (free, 3), in space (free, 6)."""
    require_kind("loads", loads, Mapping)
    forces, full = (3, 6) if masonry.in_space else (2, 3)
    total = np.zeros((len(masonry.free), full))
    rows = {masonry.names[i]: row for row, i in enumerate(masonry.free)}
    for name, load in loads.items():
        if name not in rows:
            raise ValueError(f"loads: {name!r} is not the name of a free block; those are {named(tuple(rows))}")
        given = require_reals(f"loads of {name}", load, f"an array of the shape ({forces},) or ({full},)")
        count = forces if given.shape == (forces,) else full
        total[rows[name], :count] += require_array(f"loads of {name}", given, (count,))
    return total


def horizontal(
    masonry: Masonry, direction: float | ArrayLike | None, angle: float | None, name: str = "direction"
) -> Array:
    """The unit vector of a horizontal force, shape (2,), in space (3,), from what `collapse_multiplier` takes.

    Raises:
        TypeError, ValueError: for what is no direction, with its name.
    """
    given = require_reals(name, 1.0 if direction is None else direction, "1, -1 or a vector in plan of the shape (2,)")
    if given.shape == () and abs(float(given)) == 1:
        given = np.array([float(given), 0.0])
    elif given.shape != (2,) or not masonry.in_space:
        valid = "1 or -1" + (", or a vector in plan of the shape (2,)" if masonry.in_space else "")
        raise ValueError(f"{name} = {shown(direction)} is not a direction; the valid ones are {valid}")
    length = float(np.hypot(*given))
    if not 1e-9 < length < math.inf:
        raise ValueError(f"{name} = {shown(direction)} has a length of {length:g}; it is above 1e-9 and finite")
    if angle is not None:
        if not masonry.in_space:
            raise ValueError(f"angle = {shown(angle)} is for masonry in space; in the plane give {name} = 1 or -1")
        angle = require_within("angle", angle, -2 * math.pi, 2 * math.pi, "rad")
        return np.array([math.cos(angle), math.sin(angle), 0.0])
    return np.append(given / length, 0.0) if masonry.in_space else given
