"""The collapse load of rigid masonry by limit analysis, at rest and in the poses of its mechanism."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, vstack

from ...geometry.frames import PLANE, SPACE
from ...geometry.poses import at_rest, moved
from ...linear import rates_of
from ...problem.masonry.case import MasonryCase
from ...problem.masonry.effects import applied, inertia_of_added_masses, pulls_of
from ...problem.masonry.limit.collapse import Collapse, LimitLoads, UnbalancedError, limit_of, pushed
from ...problem.masonry.limit.pose import Moves, moved_lines, posed, spans_in
from ...problem.masonry.limit.statics import MOVING_VELOCITY, Pulls, falling
from ...problem.masonry.lines import free_numbers, mean_slip_rates
from ...problem.masonry.masonry import Masonry
from ...problem.wall.case import Case
from ...problem.wall.effect import Effect
from ...problem.wall.effects import Load, Thrust, link_effects, required_effects
from ...problem.wall.restoring_moment import moment_at_strength, of_force
from ...quantities import (
    Array,
    Flags,
    Implausible,
    Integers,
    Within,
    named,
    require_array,
    require_flag,
    require_kind,
    require_real,
    require_reals,
    require_within,
    shown,
    warn_of,
    within_ranges,
)
from ...scene.masonry import wedged
from .pushover import falls_to_zero

WEAKER = 1e-6
"""How much less is borne the other way for a warning, more than limit analysis rounds [-]."""
ZERO_MULTIPLIER, BORNE_MULTIPLIER = 1e-6, 1e-3
"""Multiplier that counts as none, and that of associated friction from which something is borne [-]."""
CLOSED_RATE = 1e-6
"""Rate below which a line neither opens nor slides, over the largest of the mechanism [-]."""
PROJECTION_TOLERANCE, MOST_PROJECTIONS = 1e-12, 20
"""Tolerated gap or slip of lines that stay closed, over the size of the masonry [-], and most iterations of the
projection that closes it."""
UNPRESSED = 1e-6
"""Normal force of a joint that counts as none, over the largest [-]."""
CLOSING_OVERLAP = 0.1
"""How far a line that closes may lie behind its face, over the tolerance of the masonry [-]."""
TANGENT_STEP, STEPS_ALLOWED = 1e-4, 10
"""Displacement over which the initial slope of a curve is taken, over the size of the masonry [-], and most steps of a
curve until nothing is borne any more, over those that are expected [-]."""
InPlan = Annotated[float | None, Within(-2 * math.pi, 2 * math.pi, "rad", "angle")]
"""Angle of a direction in plan, from x towards y."""
Loads = Mapping[str, ArrayLike] | Sequence[Thrust | Load] | Thrust | Load
"""Loads that grow, see `collapse_multiplier`."""
GROWING: tuple[type[Thrust | Load], ...] = (Thrust, Load)
"""Effects that may grow."""
MOVED = "moved by"
"""How the reason begins why a curve ends at the displacement to which it was to go."""
BISECTIONS = 40
"""Bisections of a step in the search for where a line closes."""


@within_ranges
def collapse_multiplier(
    masonry: Masonry | Case,
    direction: float | ArrayLike | None = 1,
    *,
    angle: InPlan = None,
    associated: bool = True,
    loads: Loads | None = None,
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

    Of the wall of a `Case` it is the factor of safety against overturning about the outer edge, or without a side stop
    about the one that gives way first: the moments of weight, effects and ties at their strength over those of the
    forces that grow, at rest. Sliding is not looked at.

    Bonds of mortared joints hold their tension and cohesion everywhere at once, which moves the apex of the cones. As
    they soften, this is an upper bound.

    Args:
        masonry: the masonry, or the `Case` of a wall, which has its own effects.
        direction: of the force, which is opposite to the acceleration of the ground: 1 along x, -1 against it, or in
            space a vector in plan, shape (2,), of any length. None for `loads` alone.
        angle: of the force in plan, from x towards y [rad], -2 pi to 2 pi, in space; it takes the place of `direction`.
        associated: whether sliding opens joints. False for friction without dilatancy, which takes some seconds for a
            hundred blocks in the plane, and half a minute for thirty in space.
        loads: further forces that grow with the multiplier, `Thrust` and `Load`, such as wind, water, earth and the
            axle on a `Fill`, which name their block as `effects` do. Of masonry they may also be forces by the name of
            their block: at its centroid along x and z [N], or with the moment about it, positive where it turns the top
            to the right [N m], shape (2,) or (3,); in space forces along x, y and z, or with three moments, shape (3,)
            or (6,).
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
        Implausible: for blocks that stand only by wedging, where no torsion is borne without dilatancy, and for the
            wall of a case without a side stop that the same forces overturn at a lower factor when they push the other
            way.

    Examples:
        >>> arch = mr.Masonry.arch(radius=5.0, thickness=0.9)
        >>> round(float(mr.collapse_multiplier(arch).multiplier), 2)
        0.23
    """
    require_kind("masonry", masonry, Masonry, Case)
    if isinstance(masonry, Case):
        _require_absent(angle=angle, associated=None if associated else False, effects=effects or None, pose=pose)
        return overturned(masonry, direction, loads)
    dilates = require_flag("associated", associated)
    if not dilates:
        masonry.require_dry("collapse_multiplier without dilatancy")
    constant_effects, growing = _required_effects(masonry, effects), _required_loads(masonry, loads)
    laws = [link.law for link in link_effects(constant_effects).values()]
    if pose is not None:
        masonry.require_dry("collapse_multiplier in a pose")
        if not dilates:
            raise ValueError("associated = False goes with masonry at rest; a pose takes associated friction")
        at_rest_masonry, (masonry, constant_effects) = masonry, posed(masonry, pose, constant_effects)
        growing = posed(at_rest_masonry, pose, growing)[1] if isinstance(growing, tuple) else growing
    without_push = direction is None and angle is None
    push = np.zeros(3 if masonry.in_space else 2) if without_push else horizontal(masonry, direction, angle)
    grown = _forces(masonry, growing) + pushed(masonry, push)
    grown += inertia_of_added_masses(masonry, constant_effects, push)
    if not grown.any():
        raise ValueError("direction = None needs loads that grow with the multiplier, and there are none")
    links = tuple(link_effects(constant_effects).values())
    spans, constant = [link.span for link in links], applied(masonry, constant_effects)
    strength = np.array([law.pulls_at(span) for law, span in zip(laws, spans, strict=True)])
    ties = Pulls.from_forces(masonry, pulls_of(masonry, links), strength)
    loads_at_limit = LimitLoads(push, grown, constant)
    if pose is not None:
        return limit_of(masonry, loads_at_limit, ties=ties, least=-math.inf)
    if falls := falling(masonry, constant, ties):
        under = "the weight and the effects" if constant_effects else "the weight"
        raise ValueError(f"the masonry cannot stand: {named(falls)} would fall under {under}")
    collapse = limit_of(masonry, loads_at_limit, associated=dilates, ties=ties)
    collapse = replace(collapse, wedged=wedged(masonry, constant_effects), loads=growing, effects=constant_effects)
    if collapse.wedged:
        warn_of(
            f"{named(collapse.wedged)} would stand only by wedging, and slide down from joints that nothing presses "
            "together; the multiplier is that of blocks that are wedged",
            Implausible,
        )
    if not dilates and (twisting := _twisting_joints(collapse, loads_at_limit, ties)):
        warn_of(
            f"multiplier = {abs(collapse.multiplier):.1g}: {named(twisting)} turn about their normals without "
            "friction, since rigid faces let normal forces gather in a point; give points = 2, or associated=True for "
            "an upper bound",
            Implausible,
        )
    return collapse


def _require_absent(**arguments: object) -> None:
    """Raise a ValueError for arguments that the wall of a case has no place for."""
    if names := [name for name, value in arguments.items() if value is not None]:
        raise ValueError(
            f"{named(names)} cannot be given for a Case, which has its own effects and rocks in its plane; "
            "masonry of blocks takes it"
        )


def overturned(case: Case, direction: object, loads: object) -> Collapse:
    """The factor on the forces that grow at which a wall at rest overturns, see `collapse_multiplier`."""
    sense = 0.0 if direction is None else require_real("direction", direction)
    if sense not in (-1.0, 0.0, 1.0) or sense == direction == 0:
        raise ValueError(f"direction = {sense:g} is not a direction; the valid ones are 1, -1 and None")
    grown = required_effects("loads", () if loads is None else loads, GROWING, "Thrust, Load or a sequence of them")
    wall, top = case.wall, 2 * case.wall.h * (1 + 1e-12)
    forces = [WallForce(0.0, wall.centroid_height, sense * wall.weight, 0.0)]
    for i, load in enumerate(grown):
        require_within(f"loads[{i}], height", load.height, 0.0, top, "m")
        outwards, _, up = load.force_vector
        forces.append(WallForce(load.offset, load.height, outwards, -up))
    mode = _overturning(case, forces)
    if mode is None:
        raise ValueError("direction = None needs loads that grow with the multiplier, and there are none")
    if not case.one_sided:
        _warn_of_other_direction(case, forces, mode.factor)
    acting: dict[str, Any] = {"loads": grown, "effects": case.effects, "case": case}
    if mode.factor == math.inf:
        return Collapse(math.inf, np.array([sense, 0.0]), (), np.zeros((1, 3)), **acting)
    motion = mode.side * wall.weight / mode.moment * wall.turning(0.0, mode.side)
    return Collapse(mode.factor, np.array([sense, 0.0]), ("wall",), np.atleast_2d(motion), **acting)


class WallForce(NamedTuple):
    """A force on a wall at rest: the place at which it acts, x from the middle of the base [m] and z [m], and its
    components [N]."""

    x: float
    z: float
    outwards: float
    downwards: float


class OverturningMode(NamedTuple):
    """How forces that grow overturn a wall.

    Args:
        factor: on the forces [-], infinite where they overturn it about no edge.
        side: of the edge, 1 outwards and -1 inwards.
        moment: of the forces about the edge [N m].
    """

    factor: float
    side: float = 1.0
    moment: float = 1.0


def _overturning(case: Case, forces: Sequence[WallForce]) -> OverturningMode | None:
    """How forces overturn the wall of a case at the lowest factor; None where they have no moment about its edges."""
    restoring = {1.0: case.restoring.outer.P + moment_at_strength(case.pulls)}
    if not case.one_sided:
        restoring[-1.0] = case.restoring.inner.P
    half_base = case.wall.half_base
    driving = {side: -sum(of_force(*force, half_base).towards(side).P for force in forces) for side in restoring}
    if not any(driving.values()):
        return None
    modes = [OverturningMode(restoring[side] / moment, side, moment) for side, moment in driving.items() if moment > 0]
    return min(modes, default=OverturningMode(math.inf))


def _warn_of_other_direction(case: Case, forces: Sequence[WallForce], factor: float) -> None:
    """Warn where horizontal forces overturn a wall that is free both ways at a lower factor when they push the other
    way."""
    opposite = _overturning(case, [force._replace(outwards=-force.outwards) for force in forces])
    if opposite is not None and opposite.factor < (1 - WEAKER) * factor:
        warn_of(
            f"the wall has side_stop=False, and {factor:.4g} times the forces that grow overturn it; where they push "
            f"the other way {opposite.factor:.4g} times do: check that way too, with direction and forces of the other "
            "sign",
            Implausible,
        )


def _required_effects(masonry: Masonry, effects: Sequence[Effect] | Effect) -> tuple[Effect, ...]:
    """Effects as a case of the masonry takes them. An error names one whose force the motion alone decides."""
    constant_effects = MasonryCase(masonry, 1.0, effects=effects, settled=False).effects  # type: ignore[arg-type]
    for i, effect in enumerate(constant_effects):
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
    return constant_effects


def _twisting_joints(collapse: Collapse, loads: LimitLoads, ties: Pulls) -> tuple[str, ...]:
    """Names of joints whose twist alone makes the multiplier zero: they press, and turn about their normals.

    With associated friction, where corners of the faces press, something is borne then.
    """
    masonry, forces = collapse.masonry, collapse.forces
    if masonry is None or not masonry.in_space or forces is None or abs(collapse.multiplier) > ZERO_MULTIPLIER:
        return ()
    if limit_of(masonry, loads, ties=ties).multiplier < BORNE_MULTIPLIER:
        return ()
    count, lines = len(masonry.joints), masonry.lines
    rates = np.abs(mean_slip_rates(masonry.blocks, lines, count) @ collapse.motion.ravel()).reshape(3, count)
    widths = np.array([joint.width for joint in masonry.joints])
    twists = (forces.normal > 0) & (masonry.joint_friction > 0) & (rates[2] * widths > MOVING_VELOCITY * rates.max())
    return tuple(joint.name for joint, twisted in zip(masonry.joints, twists, strict=True) if twisted)


def _required_loads(masonry: Masonry, loads: object) -> Mapping[str, tuple[float, ...]] | tuple[Effect, ...]:
    """Loads that grow, checked: effects with the numbers of their blocks, or forces by the name of a free block."""
    if loads is None:
        return ()
    if not isinstance(loads, Mapping):
        takes = "Thrust, Load, a sequence of them, or a mapping of blocks to forces [N]"
        effects = required_effects("loads", loads, GROWING, takes)
        try:
            return MasonryCase(masonry, 1.0, effects=effects, settled=False).effects
        except (TypeError, ValueError) as error:
            raise type(error)(str(error).replace("effects[", "loads[", 1)) from None
    forces, full = (3, 6) if masonry.in_space else (2, 3)
    free, rows = [masonry.names[i] for i in masonry.free], dict[str, tuple[float, ...]]()
    for name, load in loads.items():
        if name not in free:
            raise ValueError(f"loads: {name!r} is not the name of a free block; those are {named(free)}")
        takes = f"an array of the shape ({forces},) or ({full},); a Thrust or Load has a block of its own"
        values = require_reals(f"loads of {name}", load, takes)
        shape = values.shape if values.shape == (forces,) else (full,)
        rows[name] = tuple(require_array(f"loads of {name}", values, shape).tolist())
    return rows


def _forces(masonry: Masonry, growing: Mapping[str, tuple[float, ...]] | tuple[Effect, ...]) -> Array:
    """Loads that grow as forces and moments of the free blocks, shape (free, 3), in space (free, 6)."""
    if isinstance(growing, tuple):
        return applied(masonry, growing)
    total = np.zeros((len(masonry.free), masonry.freedom.nv))
    for name, load in growing.items():
        total[masonry.free.index(masonry.names.index(name)), : len(load)] = load
    return total


def horizontal(masonry: Masonry, direction: float | ArrayLike | None, angle: InPlan, name: str = "direction") -> Array:
    """The unit vector of a horizontal force, shape (2,), in space (3,), from what `collapse_multiplier` takes.

    Raises:
        TypeError, ValueError: for what is no direction, with its name.
    """
    vector = require_reals(name, 1.0 if direction is None else direction, "1, -1 or a vector in plan of the shape (2,)")
    if vector.shape == () and abs(float(vector)) == 1:
        vector = np.array([float(vector), 0.0])
    elif vector.shape != (2,) or not masonry.in_space:
        valid = "1 or -1" + (", or a vector in plan of the shape (2,)" if masonry.in_space else "")
        raise ValueError(f"{name} = {shown(direction)} is not a direction; the valid ones are {valid}")
    length = float(np.hypot(*vector))
    if not 1e-9 < length < math.inf:
        raise ValueError(
            f"{name} = {shown(direction)} has a length of {length:g}; the length has to be finite and above 1e-9"
        )
    if angle is not None:
        if not masonry.in_space:
            raise ValueError(f"angle = {shown(angle)} is for masonry in space; in the plane give {name} = 1 or -1")
        return np.array([math.cos(angle), math.sin(angle), 0.0])
    return np.append(vector / length, 0.0) if masonry.in_space else vector


@dataclass(frozen=True, eq=False)
class LimitCurve:
    """What rigid masonry bears as its mechanism goes on.

    Args:
        displacement: of the centroid of all free blocks along the direction [m], shape (n,), or see `limit_curve`.
        multiplier: of the forces that grow, of a horizontal one over the weight [-], shape (n,), below zero where the
            masonry is held back.
        pose: of the free blocks, as in a `Response`, shape (n, free, 3), in space (n, free, 7).
        ended: why it stopped, in words.
        start: the mechanism with which it begins.
        effects: those of the masonry, with the numbers of their blocks.
    """

    displacement: Array
    multiplier: Array
    pose: Array
    ended: str
    start: Collapse = field(repr=False)
    effects: tuple[Effect, ...] = field(default=(), repr=False)

    def __repr__(self) -> str:
        unit = "times the forces that grow" if self.start.loads else "of the weight"
        return (
            f"<LimitCurve: {len(self.multiplier)} poses to {self.displacement[-1]:.3g} m, from "
            f"{self.multiplier[0]:.4g} to {self.multiplier[-1]:.4g} {unit}, {self.ended}>"
        )

    @property
    def d_0(self) -> float:
        """Displacement at which nothing is borne any more [m]; NaN where the curve ends before it."""
        return falls_to_zero(self.displacement, self.multiplier)

    @property
    def ties(self) -> tuple[dict[str, float], dict[str, float]]:
        """Displacements [m] at which ties yield, and at which they break, by name, of those that do along the curve.

        A tie bears its strength from the start of the curve, and yields where its stiffness would have brought it up.
        """
        yielding, breaking = dict[str, float](), dict[str, float]()
        for name, link in link_effects(self.effects).items():
            if link.law.holds and self.start.masonry is not None:
                spans, law = spans_in(self.start.masonry, link, self.pose), link.law
                limit = law.reach + law.strength / law.k
                for displacements, length in ((yielding, limit), (breaking, limit + law.ultimate)):
                    if (spans > length).any():
                        displacements[name] = falls_to_zero(self.displacement, length - spans)
        return yielding, breaking


@within_ranges
def limit_curve(
    masonry: Masonry,
    direction: float | ArrayLike | None = 1,
    *,
    to: Annotated[float | None, Within(1e-6, 100, "m")] = None,
    angle: InPlan = None,
    loads: Loads | None = None,
    effects: Sequence[Effect] | Effect = (),
    poses: Annotated[int, Within(2, 10_000, whole=True)] = 100,
) -> LimitCurve:
    """The horizontal force that rigid masonry bears as it goes on, proportional to the weight, in turned poses.

    From each pose the mechanism of `collapse_multiplier` goes on by a step. Lines that neither open nor slide in it
    then stay where they are, and a step ends where a further line closes, from which another mechanism may go on. No
    steps in time are made, and joints have no stiffness. The curve ends where joints slide, since those of associated
    friction open as they do, and where a further joint would open as well and several hinges would move at once: `push`
    follows both. Where several mechanisms have the same multiplier it goes on with one of them, and where lines close
    again and again, more often than there are lines, it ends.

    Args:
        masonry: the masonry, with dry joints.
        direction, angle, loads, effects: as of `collapse_multiplier`. `Thrust` and `Load` keep their direction and act
            at their point of the block. The displacement is that of the centroid of all free blocks along the
            direction. Of loads alone it is the work that they do on displacements of the centroids and rotations, as
            forces and moments at rest, over the sum of the forces.
        to: displacement at which to stop [m], 1e-6 to 100; None goes on until nothing is borne any more.
        poses: how many steps go to it, 2 to 10000, or about as many to where nothing is borne any more.

    Returns:
        The `LimitCurve`: `displacement` [m], `multiplier` [-], `pose` and `d_0`.

    Raises:
        TypeError, ValueError: as `collapse_multiplier` does.

    Examples:
        >>> column = mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 3)
        >>> round(mr.limit_curve(column, 1).d_0, 3)
        0.3
    """
    require_kind("masonry", masonry, Masonry)
    masonry.require_dry("limit_curve")
    constant_effects = _required_effects(masonry, effects)
    push = partial(collapse_multiplier, masonry, direction, angle=angle, loads=loads, effects=constant_effects)
    start = collapse = push()
    path = MechanismPath.from_collapse(masonry, start)
    if to is None:
        step = path.expected_length(start, push) / poses
        to, allowed = math.inf, STEPS_ALLOWED * poses
    else:
        step, allowed = to / poses, poses
    curve = [(0.0, collapse.multiplier, path.rest)]
    while True:
        d, multiplier, pose = curve[-1]
        if ended := _ended(d, multiplier, to, collapse):
            break
        closed = path.closed_lines(pose, collapse)
        if slides := path.sliding(collapse, closed):
            ended = f"{named(slides)} slide"
            break
        pose = path.advanced(pose, collapse, closed, min(step, to - d))
        if path.travel(pose) - d < PROJECTION_TOLERANCE * path.size:
            ended = "locks"
            break
        if len(curve) > allowed + len(path.pair):
            ended = "lines close again and again"
            break
        try:
            collapse = push(pose=pose)
        except UnbalancedError:
            ended = "another joint begins to open"
            break
        except ValueError as error:
            ended = str(error)
            break
        curve.append((path.travel(pose), collapse.multiplier, pose))
    displacement, multipliers, followed = zip(*curve, strict=True)
    return LimitCurve(np.array(displacement), np.array(multipliers), np.array(followed), ended, start, constant_effects)


def _ended(d: float, multiplier: float, to: float, collapse: Collapse) -> str:
    """Why a curve ends at a pose, or nothing."""
    if not collapse.moving:
        return "nothing gives way"
    if multiplier <= 0:
        return "goes on by itself"
    return f"{MOVED} {1e3 * to:.4g} mm" if d >= to * (1 - 1e-9) else ""


class ClosedLines(NamedTuple):
    """The closed lines of a pose in a mechanism, shape (m,) each: those that do not open, those of them that do not
    slide either, and all that slide."""

    still: Flags
    stuck: Flags
    slides: Flags


class MechanismPath(NamedTuple):
    """The path of a mechanism from the pose at rest, along the forces that grow.

    Args:
        masonry: the masonry.
        share: of the forces that grow on the free blocks, over the sum of their sizes, shape (free, nv).
        pair: numbers of the bodies of each line, -1 for a fixed one, shape (m, 2).
        size: extent of the free blocks [m].
    """

    masonry: Masonry
    share: Array
    pair: Integers
    size: float

    @classmethod
    def from_collapse(cls, masonry: Masonry, start: Collapse) -> MechanismPath:
        """That of masonry pushed along a direction, or by the loads alone with which it begins to move."""
        share = pushed(masonry, start.direction) if start.direction.any() else _forces(masonry, start.loads)
        total = float(np.linalg.norm(share[:, : len(start.direction)], axis=1).sum())
        if total == 0:
            raise ValueError("loads are moments alone, along which nothing is displaced; give forces")
        corners = np.concatenate([masonry.blocks[i].corners for i in masonry.free])
        pair = free_numbers(masonry.blocks)[np.column_stack([masonry.lines.body, masonry.lines.face])]
        return cls(masonry, share / total, pair, float(np.ptp(corners, axis=0).max()))

    @property
    def rest(self) -> Array:
        """The pose at rest, shape (free, nq)."""
        freedom = SPACE if self.masonry.in_space else PLANE
        return at_rest(len(self.share), freedom).reshape(len(self.share), -1)

    def travel(self, pose: Array) -> float:
        """Displacement along the forces that grow, by their work [m]; in space a rotation phi is 2 sin(phi / 2)."""
        turned = 2 * pose[:, 4:] if self.masonry.in_space else pose[:, 2:]
        d = 3 if self.masonry.in_space else 2
        return float((self.share * np.concatenate([pose[:, :d], turned], axis=1)).sum())

    def expected_length(self, collapse: Collapse, push: Callable[..., Collapse]) -> float:
        """About how far it goes until nothing is borne any more [m]: along the tangent of the curve at rest, or the
        size of the masonry where it does not fall."""
        if not collapse.moving:
            return self.size
        pose = self.advanced(self.rest, collapse, self.closed_lines(self.rest, collapse), TANGENT_STEP * self.size)
        try:
            after = push(pose=pose).multiplier
        except ValueError:
            return self.size
        fall = (collapse.multiplier - after) / self.travel(pose)
        return min(collapse.multiplier / fall, self.size) if fall > 0 else self.size

    def rates(self, moves: Moves, directions: Array) -> csr_array:
        """Rates at which lines move apart in directions of their faces at rest, for unit velocities, (m, unknowns)."""
        lines, at = self.masonry.lines, moves.at(self.masonry.lines.body, self.masonry.lines.at)
        arms = at - moves.place[lines.body], at - moves.place[lines.face]
        return rates_of(self.pair, arms, moves.turned(lines.face, directions), len(self.share))

    def closed_lines(self, pose: Array, collapse: Collapse) -> ClosedLines:
        """What the closed lines of a pose do in a mechanism."""
        moves, lines, velocity = Moves.from_pose(self.masonry, pose), self.masonry.lines, collapse.motion.ravel()
        closed = moved_lines(lines, moves).gap <= self.masonry.tolerance
        normal = self.rates(moves, lines.normal) @ velocity
        along = np.hypot.reduce([self.rates(moves, tangent) @ velocity for tangent in lines.tangents])
        threshold = CLOSED_RATE * max(float(np.abs(normal[closed]).max(initial=0.0)), float(np.abs(velocity).max()))
        stays = closed & (np.abs(normal) <= threshold)
        return ClosedLines(stays, stays & (along <= threshold), closed & (along > CLOSED_RATE * np.abs(velocity).max()))

    def sliding(self, collapse: Collapse, closed: ClosedLines) -> list[str]:
        """Names of the joints that press, rub and slide at each line that does not open, or at all that do."""
        if collapse.forces is None:
            return []
        joints, normal = range(len(self.masonry.joints)), collapse.forces.normal
        rub = (normal > UNPRESSED * normal.max()) & (self.masonry.joint_friction > 0)
        slide, stick = (np.isin(joints, self.masonry.lines.joint[flags]) for flags in (closed.slides, closed.stuck))
        return [self.masonry.joints[number].name for number in np.flatnonzero(rub & slide & ~stick)]

    def advanced(self, pose: Array, collapse: Collapse, closed: ClosedLines, step: float) -> Array:
        """The pose a step further [m], or up to where a line closes."""
        speed = float((self.share * collapse.motion).sum())
        low, high = 0.0, step / max(speed, PROJECTION_TOLERANCE)
        after = self.projected(pose, collapse.motion * high, closed)
        if not self.closes(pose, after, closed):
            return after
        best = pose
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            after = self.projected(pose, collapse.motion * middle, closed)
            if self.closes(pose, after, closed):
                high = middle
            else:
                low, best = middle, after
        return best

    def closes(self, before: Array, after: Array, closed: ClosedLines) -> bool:
        """Whether a line other than those that stay closed has gone behind its face, farther than it was."""
        gap, was = (
            moved_lines(self.masonry.lines, Moves.from_pose(self.masonry, pose)).gap for pose in (after, before)
        )
        return bool((gap < np.minimum(was, 0.0) - CLOSING_OVERLAP * self.masonry.tolerance)[~closed.still].any())

    def projected(self, pose: Array, motion: Array, closed: ClosedLines) -> Array:
        """The pose after a motion, with the lines that stay where they were on their faces."""
        lines, goal = self.masonry.lines, self.relative(pose)
        after = self.turned(pose, motion)
        for _ in range(MOST_PROJECTIONS):
            moves = Moves.from_pose(self.masonry, after)
            off = self.relative(after) - goal
            rows = [self.rates(moves, lines.normal)[closed.still]]
            rows += [self.rates(moves, tangent)[closed.stuck] for tangent in lines.tangents]
            left = [(off * lines.normal).sum(axis=1)[closed.still]]
            left += [(off * tangent).sum(axis=1)[closed.stuck] for tangent in lines.tangents]
            missing = np.concatenate(left)
            if np.abs(missing).max(initial=0.0) < PROJECTION_TOLERANCE * self.size:
                break
            change = -np.linalg.lstsq(vstack(rows).toarray(), missing, rcond=1e-9)[0]
            after = self.turned(after, change.reshape(motion.shape))
        return after

    def relative(self, pose: Array) -> Array:
        """Where points of lines are from those of their faces, in the axes of the faces at rest [m], shape (m, d)."""
        moves, lines = Moves.from_pose(self.masonry, pose), self.masonry.lines
        apart = moves.at(lines.body, lines.at) - moves.at(lines.face, lines.at)
        return np.asarray((np.swapaxes(moves.turn[lines.face], 1, 2) @ apart[..., None])[..., 0])

    def turned(self, pose: Array, motion: Array) -> Array:
        """A pose after a motion, whose rotations are about the axes of the world in space."""
        if not self.masonry.in_space:
            return pose + motion
        turn = Moves.from_pose(self.masonry, pose).turn[list(self.masonry.free)]
        block_motion = np.concatenate([motion[:, :3], (np.swapaxes(turn, 1, 2) @ motion[:, 3:, None])[..., 0]], axis=1)
        return moved(pose.ravel(), block_motion.ravel(), SPACE).reshape(pose.shape)
