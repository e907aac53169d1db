"""The contact law itself, integrated by SciPy: unilateral Kelvin-Voigt points.

This solver knows no restitution and no MuJoCo, and it shares no kinematics with the engine that it checks. Each contact
point carries f = max(0, -(k r + c dr/dt)) while its gap r is negative, so never a tension. The base does not slip.
While an edge of it is loaded, friction without a bound holds the lower edge, halfway between the two faces that overlap
there. An edge that lands with a sliding velocity loses it at once, in the impulse of that friction.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tqdm import tqdm

from ..problem.case import Case
from ..problem.interface import Contacts
from ..problem.quantities import GRAVITY, ON_ITS_FACE, Array, require_kind, require_size, require_within
from ..result.history import rocking_history
from ..result.response import Response, ending

CAUGHT = 1e-3
"""Load of an edge at which friction catches it again, as a share of the weight [-]. Friction releases it at no load.
With a gap between the two, a hardly loaded edge is caught and released at a finite rate. The ideal law would do both at
once."""
SWITCHES = 100_000
"""Most changes between a held and a free base in one run, which ends an endless loop."""


class _Wall:
    """The equations of motion of a wall on its contacts.

    The state is (x, z, theta, and their rates): the displacement of the centroid from the upright wall on an undeformed
    base [m], x away from the side stop and z upwards, and the rotation [rad], positive towards +x.
    """

    def __init__(self, case: Case, contacts: Contacts) -> None:
        self.wall = wall = case.block
        self.b, self.h, self.mass, self.inertia = wall.b, wall.h, wall.mass, wall.inertia
        self.toe = wall.half_base
        self.base, self.side = contacts.base, contacts.side if case.side_stop else None
        self.motion = case.motion

    def base_gap(self, z: Any, theta: Any) -> Any:
        """Height of each contact line of the base above the base [m]."""
        return z + self.h * (1 - np.cos(theta)) - self.base.positions * np.sin(theta)

    def side_gap(self, x: Any, theta: Any) -> Any:
        """Distance of each contact line of the inner face from the side stop [m]."""
        assert self.side is not None
        return x + self.b * (1 - np.cos(theta)) + self.side.positions * np.sin(theta)

    def released(self, case: Case) -> Array:
        """The state at release: tilted about the toe, the base compressed until its springs carry the weight."""
        toe, theta = case.direction * self.toe, case.theta0
        sine, cosine = math.sin(theta), math.cos(theta)
        lowest = self.base_gap(0.0, theta)

        def excess(z: float) -> float:
            return float(self.base.stiffness @ np.maximum(-(lowest + z), 0)) - self.wall.weight

        crushed = -float(lowest.max()) - 2 * self.wall.weight / float(self.base.stiffness.sum())
        z = brentq(excess, crushed, -float(lowest.min()), xtol=1e-18, rtol=1e-15)
        rates = case.omega0 * np.array([self.h * cosine + toe * sine, toe * cosine - self.h * sine, 1.0])
        return np.concatenate([[toe - toe * cosine + self.h * sine, z, theta], rates])

    def energy(self, history: Array) -> Array:
        """Kinetic, potential and elastic energy of many states above the wall at rest [J], shape (n,)."""
        x, z, theta, vx, vz, omega = history.T
        doubled = self.mass * (vx**2 + vz**2) + self.inertia * omega**2 + 2 * self.wall.weight * z
        doubled += np.minimum(self.base_gap(z[:, None], theta[:, None]), 0) ** 2 @ self.base.stiffness
        if self.side is not None:
            doubled += np.minimum(self.side_gap(x[:, None], theta[:, None]), 0) ** 2 @ self.side.stiffness
        at_rest = -(self.wall.weight**2) / (2 * self.base.stiffness.sum())
        energy: Array = doubled / 2 - at_rest
        return energy

    def base_forces(self, y: Array) -> tuple[Array, Array]:
        """Signed forces of the base points before clipping [N], and their levers about the centroid [m]."""
        _, z, theta, _, vz, omega = y
        gap = self.base_gap(z, theta)
        lever = self.base.positions * math.cos(theta) - self.h * math.sin(theta)
        force = -(self.base.stiffness * gap + self.base.damping * (vz - omega * lever))
        return np.where(gap < 0, force, -self.base.stiffness * gap), lever

    def edge_load(self, t: float, y: Array) -> float:
        """Positive while an edge of the base is loaded, so that friction holds it [N]."""
        force, _ = self.base_forces(y)
        return float(max(force[0], force[-1]))

    def grip(self, y: Array) -> tuple[float, float]:
        """Height above the centroid of the point where friction acts [m], and its rate [m/s].

        It is at the lower edge, halfway between the two faces that overlap there.
        """
        _, z, theta, _, vz, omega = y
        s = math.copysign(self.toe, theta)
        sine, cosine = math.sin(theta), math.cos(theta)
        edge, rate = -s * sine - self.h * cosine, -(s * cosine - self.h * sine) * omega
        return 0.5 * (edge - z - self.h), 0.5 * (rate - vz)

    def free(self, t: float, y: Array) -> Array:
        """Rates of the state of a wall whose base may slide."""
        force, lever = self.base_forces(y)
        force = np.maximum(force, 0)
        Fx, Fz, moment = 0.0, float(force.sum()), -float(force @ lever)
        if self.side is not None:
            x, _, theta, vx, _, omega = y
            gap = self.side_gap(x, theta)
            height = self.b * math.sin(theta) + self.side.positions * math.cos(theta)
            push = -(self.side.stiffness * gap + self.side.damping * (vx + omega * height))
            push = np.where(gap < 0, np.maximum(push, 0), 0)
            Fx, moment = float(push.sum()), moment + float(push @ height)
        if self.motion is not None:
            Fx -= self.mass * float(self.motion(t))
        return np.array([y[3], y[4], y[5], Fx / self.mass, Fz / self.mass - GRAVITY, moment / self.inertia])

    def held(self, t: float, y: Array) -> Array:
        """Rates of the state of a wall whose lower edge does not slip."""
        rates = self.free(t, y)
        above, rate = self.grip(y)
        slipping = rates[3] + rates[5] * above + y[5] * rate
        friction = -slipping / (1 / self.mass + above**2 / self.inertia)
        rates[3] += friction / self.mass
        rates[5] += friction * above / self.inertia
        return rates

    def caught(self, y: Array) -> Array:
        """The state after friction has stopped the sliding of an edge."""
        above, _ = self.grip(y)
        impulse = -(y[3] + y[5] * above) / (1 / self.mass + above**2 / self.inertia)
        kick: Array = impulse * np.array([0, 0, 0, 1 / self.mass, 0, above / self.inertia])
        return y + kick


def solve_compliant(
    case: Case, contacts: Contacts, *, rtol: float = 1e-8, atol: float = 1e-10, output_step: float = 5e-4
) -> Response:
    """Rocking of a wall on compliant contacts: what `simulate` has to reproduce.

    Args:
        case: the wall, its release, its sides.
        contacts: the interfaces.
        rtol, atol: tolerances of the integration (scipy, DOP853) [m, rad, m/s, rad/s].
        output_step: spacing of the returned samples [s].

    Raises:
        ValueError: if the contacts do not fit the case, or for a tolerance or step out of range.
        RuntimeError: if the integration fails.
    """
    require_kind("case", case, Case)
    require_kind("contacts", contacts, Contacts)
    require_within("rtol", rtol, 1e-14, 0.1)
    require_within("atol", atol, 1e-16, 0.1)
    require_within("output_step", output_step, 1e-7, 10.0, "s")
    wall = case.block
    contacts.require_fit(wall, side_stop=case.side_stop)
    started = time.perf_counter()
    system = _Wall(case, contacts)
    period = 2 * math.pi / contacts.highest_frequency(wall, side_stop=case.side_stop)
    fine = min(output_step, 1e-3 / wall.p)  # peaks and impacts are read off the samples
    require_size("the samples of this answer", case.duration / fine, "follow it for less")
    sampled, history, evaluations, switches = _integrated(system, case, fine, period, rtol, atol)
    theta, omega = history[:, 2], history[:, 5]
    energy = system.energy(history)
    uplift = contacts.uplift_rotation(wall), contacts.uplift_energy(wall)
    _, peaks, impacts = rocking_history(case, sampled, theta, omega, energy, uplift)
    stride = max(1, round(output_step / fine))
    outcome, message = ending(case, sampled, theta, energy, uplift[1])
    return Response(
        case=case,
        solver="compliant",
        t=sampled[::stride],
        theta=theta[::stride],
        omega=omega[::stride],
        compliant=(energy[::stride], history[::stride, None, :3]),
        impacts=impacts,
        peaks=peaks,
        outcome=outcome,
        message=message,
        stats={
            "wall_time": time.perf_counter() - started,
            "evaluations": evaluations,
            "switches": switches,
            "rtol": rtol,
            "atol": atol,
        },
    )


def _integrated(
    system: _Wall, case: Case, fine: float, period: float, rtol: float, atol: float
) -> tuple[Array, Array, int, int]:
    """Times [s] and states at most `fine` apart, shape (n, 6), and how many evaluations and switches they took.

    The integration is split where friction catches or releases the base.
    """

    def switch(t: float, y: Array) -> float:
        return system.edge_load(t, y) - (0.0 if held else CAUGHT * system.wall.weight)

    def overturning(t: float, y: Array) -> float:
        return abs(float(y[2])) - ON_ITS_FACE

    switch.terminal = overturning.terminal = True  # type: ignore[attr-defined]
    t, y = 0.0, system.released(case)
    held = system.edge_load(t, y) > 0
    output = np.linspace(0.0, case.duration, max(2, math.ceil(case.duration / fine) + 1))
    states, times = [y[:, None]], [np.zeros(1)]
    evaluations = switches = 0
    with tqdm(total=case.duration, desc="compliant", unit="s", delay=3, disable=None, leave=False) as bar:
        while switches < SWITCHES:
            if held:
                y = system.caught(y)
            switch.direction = -1 if held else 1  # type: ignore[attr-defined]
            arc = solve_ivp(
                system.held if held else system.free,
                (t, case.duration),
                y,
                method="DOP853",
                t_eval=output[output > t],
                events=(switch, overturning),
                rtol=rtol,
                atol=atol,
                max_step=min(10 * period, case.motion.dt if case.motion else math.inf),
            )
            if arc.status < 0:
                raise RuntimeError(f"no solution beyond t = {arc.t[-1]:g} s: {arc.message}; relax rtol or atol")
            evaluations += arc.nfev
            times.append(arc.t)
            states.append(np.reshape(arc.y, (6, -1)))
            if arc.status == 0 or arc.t_events[1].size:
                return np.concatenate(times), np.concatenate(states, axis=1).T, evaluations, switches
            bar.update(float(arc.t_events[0][0]) - t)
            t, y = float(arc.t_events[0][0]), arc.y_events[0][0]
            held = not held
            switches += 1
    raise RuntimeError(f"the base was caught and released {SWITCHES} times by t = {t:g} s; relax rtol or atol")
