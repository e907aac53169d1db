"""The contact law itself, integrated by SciPy: unilateral Kelvin-Voigt points. Knows no restitution and no MuJoCo.

Each contact point carries f = max(0, -(k r + c dr/dt)) while its gap r is negative, so never a tension. The base does
not slip: while an edge of it is loaded, friction without a bound holds the lower edge, halfway between the two faces
that overlap there. An edge that lands with a sliding velocity loses it at once, in the impulse of that friction.
"""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from tqdm import tqdm

from .block import GRAVITY, require_within
from .case import ON_ITS_FACE, Case
from .interface import Contacts
from .pose import mechanical_energy, release_pose
from .response import Response, ending, rocking_history

Array = NDArray[np.float64]
CAUGHT = 1e-3
"""Load of an edge at which friction catches it again, as a share of the weight [-]. It is released at none: between the
two, a hardly loaded edge is caught and released at a finite rate where the ideal law would do both at once."""
SWITCHES = 100_000
"""Most changes between a held and a free base in one run, against an endless loop."""


class _Wall:
    """Right-hand side of the equations of motion; y = (x, z, theta, and their rates), as in `pose`."""

    def __init__(self, case: Case, contacts: Contacts) -> None:
        wall = case.block
        self.b, self.h, self.mass, self.inertia = wall.b, wall.h, wall.mass, wall.inertia
        self.base, self.side = contacts.base, contacts.side if case.side_stop else None
        self.motion = case.motion

    def base_forces(self, y: Array) -> tuple[Array, Array]:
        """Signed forces of the base points before clipping [N], and their levers about the centroid [m]."""
        _, z, theta, _, vz, omega = y
        sine, cosine = math.sin(theta), math.cos(theta)
        gap = z + self.h * (1 - cosine) - self.base.positions * sine
        lever = self.base.positions * cosine - self.h * sine
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
        s = math.copysign(self.b, theta)
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
            sine, cosine = math.sin(theta), math.cos(theta)
            gap = x + self.b * (1 - cosine) + self.side.positions * sine
            height = self.b * sine + self.side.positions * cosine
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
    require_within("rtol", rtol, 1e-14, 0.1)
    require_within("atol", atol, 1e-16, 0.1)
    require_within("output_step", output_step, 1e-7, 10.0, "s")
    wall = case.block
    contacts.require_fit(wall, side_stop=case.side_stop)
    started = time.perf_counter()
    system = _Wall(case, contacts)

    def switch(t: float, y: Array) -> float:
        return system.edge_load(t, y) - (0.0 if held else CAUGHT * wall.weight)

    def overturning(t: float, y: Array) -> float:
        return abs(float(y[2])) - ON_ITS_FACE

    switch.terminal = overturning.terminal = True  # type: ignore[attr-defined]
    period = 2 * math.pi / contacts.highest_frequency(wall, side_stop=case.side_stop)

    t, y = 0.0, np.concatenate(release_pose(case, contacts))
    held = system.edge_load(t, y) > 0
    fine = min(output_step, 1e-3 / wall.p)  # peaks and impacts are read off the samples
    output = np.linspace(0.0, case.duration, max(2, math.ceil(case.duration / fine) + 1))
    states = [y[:, None]]
    times = [np.zeros(1)]
    evaluations = switches = 0
    with tqdm(total=case.duration, desc="compliant", unit="s", delay=3, disable=None, leave=False) as bar:
        for _ in range(SWITCHES):
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
                break
            bar.update(float(arc.t_events[0][0]) - t)
            t, y = float(arc.t_events[0][0]), arc.y_events[0][0]
            held = not held
            switches += 1
        else:
            raise RuntimeError(f"the base was caught and released {SWITCHES} times by t = {t:g} s; relax rtol or atol")
    history = np.concatenate(states, axis=1).T
    sampled = np.concatenate(times)
    theta, omega = history[:, 2], history[:, 5]
    energy = mechanical_energy(case, contacts, history[:, :3], history[:, 3:])
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
        energy=energy[::stride],
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
