"""The equations of motion of a wall on compliant contacts, written for SciPy with kinematics of their own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple

import numpy as np
from scipy.optimize import brentq, fsolve

from ..problem.damping.contacts import Contacts
from ..problem.wall.case import Case
from ..problem.wall.effect import Anchored, LinkLaw, resistance
from ..problem.wall.effects import constant_forces_of
from ..quantities import GRAVITY, Array, Real

SLIP_ROUNDING = 1e-9
"""Share of the slip force that is put down to rounding [-]."""


class PointForce(NamedTuple):
    """A force on the wall: its point from the centroid, in the axes of the wall [m], and its components [N]."""

    px: float
    pz: float
    fx: float
    fz: float


class Pull(NamedTuple, Generic[Real]):
    """Elongation of a tie beyond its slack [m], and its direction from the anchor to the wall."""

    elongation: Real
    across: Real
    up: Real


class Wall:
    """The equations of motion of a wall on its contacts.

    The state is (x, z, theta, and their rates): the displacement of the centroid from the upright wall on an undeformed
    base [m], x away from the side stop and z upwards, and the rotation [rad], positive towards +x.

    Friction dampers have a state beside it: the places of their sliders, see `Slider`.

    Raises:
        ValueError: for a tie that yields.
    """

    def __init__(self, case: Case, contacts: Contacts) -> None:
        case.require_for("solve_compliant")
        for name, link in case.links.items():
            if link.law.yields and link.law.push == 0:
                raise ValueError(
                    f"solve_compliant has no ties that yield, and {name} has strength = {link.law.strength:g} N; give "
                    "it none, or take simulate or solve_analytical"
                )
        wall, self.case = case.wall, case
        self.grounds = [motion for motion in (case.motion, case.vertical) if motion is not None]
        self.arc = -math.inf, math.inf  # from one jump of the ground to the next [s]
        self.mass, self.inertia, self.weight = wall.mass, wall.inertia, wall.weight
        self.base, self.up, offset = contacts.base, wall.centroid_height, wall.centroid_offset
        self.edges = wall.half_base - offset, -wall.half_base - offset
        self.at = self.base.positions - offset
        self.side = None if case.stop_top is None else contacts.side_up_to(case.stop_top)
        if self.side is not None:
            self.heights = self.side.positions + 0.5 * float(case.stop_top or 0.0) - self.up
            self.face = np.array([self._face(height) for height in self.heights])
        self.forces = [
            PointForce(effect.offset - offset, effect.height - self.up, fx=force[0], fz=force[2])
            for effect, force in constant_forces_of(case.effects).values()
        ]
        self.ties = [(tie.height - self.up, tie) for tie in case.springs.values() if tie.law.push == 0]
        self.sliders: dict[str, Slider] = {}  # of friction dampers, which bear nothing at rest
        self.slipping: list[tuple[float, Anchored]] = []
        self.dampers = [link for link in case.links.values() if link.law.damps]
        self.rest = self._pose_of_rest()
        self.slipping = [(link.height - self.up, link) for link in case.springs.values() if link.law.push > 0]
        names = (name for name, link in case.springs.items() if link.law.push > 0)
        placed = zip(names, self.slipping, self.elongations(np.append(self.rest, np.zeros(3))), strict=True)
        for name, (_, link), (elongation, _) in placed:
            self.sliders[name] = Slider(link.law, float(elongation), start=float(elongation))

    def _face(self, height: float) -> float:
        """How far the inner face lies behind the centroid, at a height above it [m]."""
        return self.case.wall.centroid_offset - self.case.wall.inner_face(height + self.up)

    def elongations(self, y: Array) -> list[tuple[Array, Array]]:
        """Elongations of the friction dampers from the length drawn [m], and their rates [m/s]."""
        x, z, theta, vx, vz, omega = y
        elongations = []
        for height, link in self.slipping:
            pull = self._pull(height, link, x, z, theta)
            px = height * np.cos(theta) + self._face(height) * np.sin(theta)
            pz = self._face(height) * np.cos(theta) - height * np.sin(theta)
            elongations.append((pull.elongation, pull.across * (vx + omega * px) + pull.up * (vz + omega * pz)))
        return elongations

    def begin_arc(self, t: float) -> float:
        """Begin an arc at a time, with the jumps of the ground on either side; the end of the arc [s]."""
        jumps = [time for motion in self.grounds for time in motion.jumps.tolist()]
        before, after = [time for time in jumps if time <= t], [time for time in jumps if time > t]
        self.arc = max(before, default=-math.inf), min(after, default=math.inf)
        return min(self.arc[1], self.case.duration)

    def within_arc(self, t: float) -> float:
        """The time at which the ground is taken: just within the arc at its ends, where the ground jumps [s]."""
        return min(max(t, math.nextafter(self.arc[0], math.inf)), math.nextafter(self.arc[1], 0.0))

    def settle(self, y: Array, fired: Sequence[bool]) -> None:
        """Let the sliders of friction dampers stick or slip from here on; `fired` says whose event has ended an arc."""
        for slider, ended, (elongation, rate) in zip(self.sliders.values(), fired, self.elongations(y), strict=True):
            slider.settle(float(elongation), float(rate), ended)

    def with_places(self, states: Array) -> Array:
        """States of an arc of shape (6, n), and behind them the places of the sliders, shape (6 + sliders, n)."""
        pairs = zip(self.sliders.values(), self.elongations(states), strict=True)
        return np.vstack([states, *(slider.places(elongation) for slider, (elongation, _) in pairs)])

    def base_gap(self, z: Real, theta: Real) -> Array:
        """Height of each contact line of the base above the base [m]."""
        return np.asarray(z + self.up * (1 - np.cos(theta)) - self.at * np.sin(theta))

    def side_gap(self, x: Real, theta: Real) -> Array:
        """Distance of each contact line of the inner face from the side stop [m]."""
        return np.asarray(x + self.face * (1 - np.cos(theta)) + self.heights * np.sin(theta))

    def released(self) -> Array:
        """The state at release: tilted about the toe, the base compressed until its springs carry the weight.

        A wall that is not tilted and does not move is released from its equilibrium.
        """
        case = self.case
        if case.theta0 == case.omega0 == 0:
            return np.append(self.rest, np.zeros(3))
        toe, theta = self.edges[0 if case.direction > 0 else 1], case.theta0
        sine, cosine = math.sin(theta), math.cos(theta)
        rates = case.omega0 * np.array([self.up * cosine + toe * sine, toe * cosine - self.up * sine, 1.0])
        return np.concatenate([[toe - toe * cosine + self.up * sine, self._height_on_springs(theta), theta], rates])

    def _height_on_springs(self, theta: float) -> float:
        """How far the wall tilted by `theta` is raised when its springs carry weight and loads [m]."""
        lowest, carried = self.base_gap(0.0, theta), self.weight - sum(force.fz for force in self.forces)

        def excess(z: float) -> float:
            return float(self.base.stiffness @ np.maximum(-(lowest + z), 0)) - carried

        crushed = -float(lowest.max()) - 2 * carried / float(self.base.stiffness.sum())
        return float(brentq(excess, crushed, -float(lowest.min()), xtol=1e-18, rtol=1e-15))

    def _pose_of_rest(self) -> Array:
        """Displacement and rotation in equilibrium, the base held by friction, shape (3,)."""
        if not (self.forces or self.ties or self.case.wall.centroid_offset):
            return np.array([0.0, self._height_on_springs(0.0), 0.0])

        def pose(unknowns: Array) -> Array:
            z, theta = unknowns * (self._height_on_springs(0.0), 1e-3)
            return np.array([self.up * math.sin(theta), z, theta])

        def unbalanced(unknowns: Array) -> Array:
            rates = self.sticking(0.0, np.append(pose(unknowns), np.zeros(3)), shaken=False)
            return rates[4:] * (1 / GRAVITY, self.inertia / (self.weight * self.up))

        best, _, success, message = fsolve(unbalanced, (1.0, 1e3 * self._lean_angle()), xtol=1e-13, full_output=True)
        if success != 1 and np.abs(unbalanced(best)).max() > 1e-9:
            raise ValueError(f"the wall does not stand on its contacts: {message}")
        return pose(best)

    def _lean_angle(self) -> float:
        """About where a wall that its thrusts would overturn leans on its ties [rad]; zero for any other."""
        if self.case.restoring.outer.P > 0:
            return 0.0
        phi = np.linspace(0.0, 0.2, 4001)
        moment = self.case.restoring.outer.at(phi) + sum(pull.moment(phi) for pull in self.case.pulls)
        return float(phi[np.argmax(moment > 0)])

    def energy(self, history: Array) -> Array:
        """Kinetic, potential and elastic energy of many states above the wall at rest [J], shape (n,)."""
        rest = np.concatenate([self.rest, np.zeros(3), [slider.start for slider in self.sliders.values()]])[None]
        return self._absolute_energy(history) - self._absolute_energy(rest)

    def _absolute_energy(self, history: Array) -> Array:
        x, z, theta, vx, vz, omega = history.T[:6]
        doubled = self.mass * (vx**2 + vz**2) + self.inertia * omega**2 + 2 * self.weight * z
        doubled += np.minimum(self.base_gap(z[:, None], theta[:, None]), 0) ** 2 @ self.base.stiffness
        if self.side is not None:
            doubled += np.minimum(self.side_gap(x[:, None], theta[:, None]), 0) ** 2 @ self.side.stiffness
        for px, pz, fx, fz in self.forces:
            versine, sine = 1 - np.cos(theta), np.sin(theta)
            doubled -= 2 * (fx * (x + pz * sine - px * versine) + fz * (z - px * sine - pz * versine))
        for height, tie in self.ties:
            doubled += tie.law.k * np.maximum(self._pull(height, tie, x, z, theta).elongation, 0) ** 2
        for (height, link), place in zip(self.slipping, history.T[6:], strict=True):
            doubled += link.law.k * (self._pull(height, link, x, z, theta).elongation - place) ** 2
        return np.asarray(doubled / 2)

    def _pull(self, height: float, tie: Anchored, x: Real, z: Real, theta: Real) -> Pull[Real]:
        """How a tie at a height above the centroid [m] pulls in a pose."""
        face = self._face(height)
        across = tie.length + x + face * (1 - np.cos(theta)) + height * np.sin(theta)
        up = z + face * np.sin(theta) - height * (1 - np.cos(theta)) - tie.rise
        length = np.hypot(across, up)
        return Pull(length - tie.law.reach, across / length, up / length)

    def _damper_force(self, damper: Anchored, y: Array) -> PointForce:
        """The force of a damper on the wall."""
        x, z, theta, vx, vz, omega = y
        px, pz = -self._face(damper.height - self.up), damper.height - self.up
        sine, cosine = math.sin(theta), math.cos(theta)
        across = damper.length + x + px * (cosine - 1) + pz * sine
        above = z - px * sine + pz * (cosine - 1)
        length = math.hypot(across, above)
        rate_across, rate_above = vx + omega * (pz * cosine - px * sine), vz - omega * (px * cosine + pz * sine)
        force = -resistance(damper.law, (across * rate_across + above * rate_above) / length)
        return PointForce(px, pz, force * across / length, force * above / length)

    def _force_towards_anchor(self, height: float, pull: Pull[float], force: float) -> PointForce:
        """The force of a link [N] at a height above the centroid [m] on the wall."""
        return PointForce(-self._face(height), height, -pull.across * force, -pull.up * force)

    def base_forces(self, y: Array) -> tuple[Array, Array]:
        """Signed forces of the base points before clipping [N], and their levers about the centroid [m]."""
        _, z, theta, _, vz, omega = y.tolist()
        gap = self.base_gap(z, theta)
        lever = self.at * math.cos(theta) - self.up * math.sin(theta)
        return -(self.base.stiffness * gap + (gap < 0) * self.base.damping * (vz - omega * lever)), lever

    def edge_load(self, t: float, y: Array) -> float:
        """Positive while an edge of the base is loaded, so that friction holds it [N]."""
        force, _ = self.base_forces(y)
        return max(float(force[0]), float(force[-1]))

    def friction_height(self, y: Array) -> tuple[float, float]:
        """Height above the centroid of the point where friction acts [m], and its rate [m/s].

        It is at the lower edge, halfway between the two faces that overlap there.
        """
        _, z, theta, _, vz, omega = y.tolist()
        toe = self.edges[0] if math.copysign(1.0, theta) > 0 else self.edges[1]
        sine, cosine = math.sin(theta), math.cos(theta)
        edge, rate = -toe * sine - self.up * cosine, -(toe * cosine - self.up * sine) * omega
        return 0.5 * (edge - z - self.up), 0.5 * (rate - vz)

    def free(self, t: float, y: Array, shaken: bool = True) -> Array:
        """Rates of the state of a wall whose base may slide."""
        x, z, theta, vx, vz, omega = y.tolist()
        force, lever = self.base_forces(y)
        force = np.maximum(force, 0)
        Fx, Fz, moment = 0.0, float(force.sum()), -float(force @ lever)
        if self.side is not None and (gap := self.side_gap(x, theta)).min() < 0:
            height = self.face * math.sin(theta) + self.heights * math.cos(theta)
            push = -(self.side.stiffness * gap + self.side.damping * (vx + omega * height))
            push = np.where(gap < 0, np.maximum(push, 0), 0)
            Fx, moment = float(push.sum()), moment + float(push @ height)
        applied = list(self.forces)
        for link_height, tie in self.ties:
            pull = self._pull(link_height, tie, x, z, theta)
            if (force_of_tie := tie.law.k * max(pull.elongation, 0.0)) > 0:
                applied.append(self._force_towards_anchor(link_height, pull, force_of_tie))
        applied += [self._damper_force(damper, y) for damper in self.dampers]
        for slider, (link_height, link) in zip(self.sliders.values(), self.slipping, strict=True):
            pull = self._pull(link_height, link, x, z, theta)
            applied.append(self._force_towards_anchor(link_height, pull, slider.pull(pull.elongation)))
        sine, cosine = math.sin(theta), math.cos(theta)
        for px, pz, fx, fz in applied:
            Fx, Fz = Fx + fx, Fz + fz
            moment += fx * (pz * cosine - px * sine) - fz * (px * cosine + pz * sine)
        if shaken and self.case.motion is not None:
            Fx -= self.mass * float(self.case.motion(self.within_arc(t)))
        if shaken and self.case.vertical is not None:
            Fz -= self.mass * float(self.case.vertical(self.within_arc(t)))
        return np.array([vx, vz, omega, Fx / self.mass, Fz / self.mass - GRAVITY, moment / self.inertia])

    def sticking(self, t: float, y: Array, shaken: bool = True) -> Array:
        """Rates of the state of a wall whose lower edge does not slip."""
        rates = self.free(t, y, shaken)
        above, rate = self.friction_height(y)
        slipping = float(rates[3] + rates[5] * above + y[5] * rate)
        friction = -slipping / (1 / self.mass + above**2 / self.inertia)
        rates[3] += friction / self.mass
        rates[5] += friction * above / self.inertia
        return rates

    def caught(self, y: Array) -> Array:
        """The state after friction has stopped the sliding of an edge."""
        above, _ = self.friction_height(y)
        impulse = -(y[3] + y[5] * above) / (1 / self.mass + above**2 / self.inertia)
        kick: Array = impulse * np.array([0, 0, 0, 1 / self.mass, 0, above / self.inertia])
        return y + kick


@dataclass
class Slider:
    """The slider of a friction damper, in an arc in which it sticks or slips one way.

    Args:
        law: of the link.
        place: where it is while it sticks: the elongation at which the spring bears nothing [m].
        sense: 1 where it slips as the link gets longer, -1 as it gets shorter, 0 where it sticks.
        start: its place at rest [m].
        path: how far it has slipped, either way [m].
    """

    law: LinkLaw
    place: float = 0.0
    sense: int = 0
    start: float = 0.0
    path: float = 0.0

    def pull(self, elongation: float) -> float:
        """The force of the link [N], negative where it pushes."""
        return self.sense * self.law.strength if self.sense else self.law.k * (elongation - self.place)

    def change(self, elongation: float, rate: float) -> float:
        """A number that falls through zero where it begins to slip, or to stick."""
        if self.sense:
            return self.sense * rate
        return self.law.strength - abs(self.law.k * (elongation - self.place))

    def places(self, elongation: Array) -> Array:
        """Where it is at elongations of the arc [m], shape (n,)."""
        if not self.sense:
            return np.full(len(elongation), self.place)
        return np.asarray(elongation - self.sense * self.law.strength / self.law.k)

    def settle(self, elongation: float, rate: float, fired: bool) -> None:
        """Let it stick or slip in the next arc.

        Args:
            elongation, rate: of the link now [m, m/s].
            fired: whether the last arc ended because `change` fell through zero.
        """
        sense_before, stretch = self.sense, self.law.strength / self.law.k
        place = min(max(self.place, elongation - stretch), elongation + stretch)
        self.path += abs(place - self.place)
        self.place = place
        pull = self.law.k * (elongation - self.place)
        if sense_before:
            slips = not fired and sense_before * rate >= 0
        else:
            slips = abs(pull) >= self.law.strength * (1 - SLIP_ROUNDING) and (fired or pull * rate > 0)
        self.sense = int(math.copysign(1.0, pull)) if slips else 0
