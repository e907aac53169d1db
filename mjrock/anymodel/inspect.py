"""What the contacts of anyone's MuJoCo model are in N/m and N s/m: `inspect_contacts`.

MuJoCo's two formats of solref become the spring K and dashpot B of a row. With the impedance d at zero penetration and
W of the two bodies,

    k = K d^2 / ((1 - d) W),    c = B d / ((1 - d) W),    m_i = d / ((1 - d) W).

In the direct format K = stiffness / dw^2 and B = damping / dw, else K = 1 / (dw timeconst dampratio)^2 and
B = 2 / (dw timeconst), where dw is the impedance at the full width. With friction and the pyramidal cone all three
change by the factor of `Mixed.pyramid`. An Euler step of length h uses up h c / 2 of the inertia m_i (see `contact`).
What is left moves with the mass in a contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from ..engine.contact import IMPEDANCE_RANGE
from ..problem.damping.rebound import rebound_restitution
from ..quantities import require_flag, require_whole
from .geoms import GeomPair, at_rest, compiled
from .mixing import Mixed
from .notes import UNSOUND, duplicates, model_spoilers, resolving_step, rounded_down


@dataclass(frozen=True)
class InspectedContact:
    """A contact of a model in physical units, at zero penetration.

    Args:
        geom1, geom2: names of the geoms, or their numbers in brackets.
        explicit: whether an explicit `<pair>` says so, or MuJoCo mixes it from the two geoms.
        k, c: spring [N/m] and dashpot [N s/m] of each contact point.
        inertia: inertia that the row adds in a contact, beyond what the Euler step takes [kg].
        mass: effective mass of an approach of the centres of mass along the normal at `qpos0` [kg]; infinity if there
            is none.
        impedance: d at zero penetration [-].
        points: contact points that share the mass; frequency, xi and restitution are those of so many.
        notes: what else is to be known of it, one sentence each.
    """

    geom1: str
    geom2: str
    explicit: bool
    k: float
    c: float
    inertia: float
    mass: float
    impedance: float
    points: int
    notes: tuple[str, ...]

    @property
    def frequency(self) -> float:
        """Circular frequency omega in a contact of these points [rad/s]."""
        return math.sqrt(self.k / self._moved)

    @property
    def xi(self) -> float:
        """Damping ratio xi of a contact of these points, with the inertia of the row [-]; NaN without a mass."""
        if not self.mass < math.inf:
            return math.nan
        if self.k == 0:
            return math.inf if self.c > 0 else 0.0
        return self.c / (2 * math.sqrt(self.k * self._moved))

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of an approach along the normal that meets these points [-].

        It is that of a spring and dashpot that never pull, exp(-2 xi acos(xi) / sqrt(1 - xi^2)), beyond xi = 1 with
        acosh(xi) and sqrt(xi^2 - 1). It leaves out the time step; a note says where the step is too long for it.
        """
        return math.nan if math.isnan(self.xi) else rebound_restitution(self.xi)

    @property
    def _moved(self) -> float:
        """What moves with each contact point [kg]."""
        return self.mass / self.points + self.inertia


def inspect_contacts(
    model: mujoco.MjModel | mujoco.MjSpec, *, candidates: bool = True, contacts: int = 1
) -> tuple[InspectedContact, ...]:
    """Every contact that a model can make, in physical units.

    Args:
        model: a compiled model or a specification; it is not changed.
        candidates: whether geoms without an explicit pair are listed too, where MuJoCo lets them collide: contype and
            conaffinity match, and their bodies are neither one, nor parent and child, nor excluded.
        contacts: contact points that share the mass, 1 to 50, of geoms that can meet in several points: 4 for a box
            that lands flat on a plane. 1 is a single point that bears the whole mass.

    Returns:
        Explicit pairs first, then candidates. Pairs of which neither body can move are left out.

    Raises:
        TypeError: unless it is a model, and `contacts` a whole number.
        ValueError: if the specification does not compile, or `contacts` is outside its range.
    """
    require_flag("candidates", candidates)
    points = require_whole("contacts", contacts, 1, mujoco.mjMAXCONPAIR)
    whole = compiled(model)
    data = at_rest(whole)
    ends = zip(whole.pair_geom1, whole.pair_geom2, strict=True)
    pairs = [GeomPair(whole, (int(a), int(b)), chosen) for chosen, (a, b) in enumerate(ends)]
    listed = {frozenset(pair.geoms) for pair in pairs}
    if candidates:
        pairs += [pair for pair in _candidates(whole) if frozenset(pair.geoms) not in listed]
    return tuple(_inspected(pair, data, points) for pair in pairs if pair.inverse_weight > 0)


def _candidates(model: mujoco.MjModel) -> Iterator[GeomPair]:
    """Geoms that MuJoCo lets collide without an explicit pair."""
    excluded = {(int(sign) >> 16, int(sign) & 0xFFFF) for sign in model.exclude_signature}
    filters_parents = not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)
    static = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))
    for first in range(model.ngeom):
        for second in range(first + 1, model.ngeom):
            pair = GeomPair(model, (first, second))
            a, b = pair.bodies
            weld_a, weld_b = int(model.body_weldid[a]), int(model.body_weldid[b])
            parents = (int(model.body_weldid[model.body_parentid[weld]]) for weld in (weld_a, weld_b))
            related = filters_parents and weld_a and weld_b and bool({weld_a, weld_b} & {*parents})
            met = (model.geom_contype[first] & model.geom_conaffinity[second]) | (
                model.geom_contype[second] & model.geom_conaffinity[first]
            )
            both_static = all(model.geom_type[geom] in static for geom in (first, second))
            if met and weld_a != weld_b and not related and not both_static and (min(a, b), max(a, b)) not in excluded:
                yield pair


def _inspected(pair: GeomPair, data: mujoco.MjData, contacts: int) -> InspectedContact:
    mixed, option = Mixed.of(pair), pair.model.opt
    if option.enableflags & int(mujoco.mjtEnableBit.mjENBL_OVERRIDE):
        solref, solimp = option.o_solref, option.o_solimp
    else:
        solref, solimp = mixed.solref, mixed.solimp
    h = float(option.timestep)
    d, full = (float(np.clip(value, *IMPEDANCE_RANGE)) for value in solimp[:2])
    constant = d == full or solimp[2] <= mujoco.mjMINVAL
    if constant:
        d = 0.5 * (d + full)
    spring, dashpot = _reference(float(solref[0]), float(solref[1]), full, h, _is_safe(pair.model))
    scale = d / ((1 - d) * pair.inverse_weight)
    if mixed.condim > 1 and option.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:
        scale *= mixed.pyramid(float(option.impratio))
    k, c = scale * d * spring, scale * dashpot
    staged = option.integrator == mujoco.mjtIntegrator.mjINT_RK4
    first, second = (name or f"[{geom}]" for name, geom in zip(pair.names, pair.geoms, strict=True))
    contact = InspectedContact(
        first,
        second,
        explicit=pair.explicit >= 0,
        k=k,
        c=c,
        inertia=scale if staged else max(0.0, scale - 0.5 * h * c),
        mass=pair.mass(data),
        impedance=d,
        points=contacts if pair.makes_several_points else 1,
        notes=(),
    )
    notes = (*_notes(pair, mixed, constant), *_step_notes(contact, h), *model_spoilers(pair.model))
    return replace(contact, notes=(*notes, *_points_notes(pair, contact.points)))


def _notes(pair: GeomPair, mixed: Mixed, constant: bool) -> Iterator[str]:
    option = pair.model.opt
    yield from duplicates(pair)
    if not constant:
        yield "the impedance grows with penetration, and stiffness and damping with it"
    if mixed.condim > 1 and option.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:
        yield "the cone is pyramidal: k and c hold for a head-on approach"
    elif mixed.condim > 1 and max(mixed.friction[:2]) ** 2 > 0.02 * option.impratio:
        yield f"impratio = {option.impratio:g} is small: sliding changes the normal force"
    if mixed.margin != 0:
        yield f"it begins at a distance of {mixed.margin:g} m"
    if mixed.adhesion != 0:
        yield f"it pulls with up to {mixed.adhesion:g} N"


def _points_notes(pair: GeomPair, points: int) -> Iterator[str]:
    if pair.makes_several_points:
        shared = f"{points} that share the mass" if points > 1 else "a single one that bears the whole mass"
        yield f"it can have several points: xi and e are those of {shared}; contacts says how many do, 4 for a flat box"


def _step_notes(contact: InspectedContact, h: float) -> Iterator[str]:
    """Where the step is too long for the formula of e.

    No row of `contact_for` has an omega h above 1, because its inertia is h^2 k where the step resolves nothing.
    """
    if not contact.mass < math.inf:
        return
    moved = contact.mass / contact.points + contact.inertia
    longest = resolving_step(contact.k, contact.c, moved)
    if contact.c * h > 2 * moved:  # a dashpot centred in the step leaves (1 - c h / 2 m) / (1 + c h / 2 m) of the speed
        longest = min(longest, moved / contact.c)
    if h <= longest:
        return
    gain = ", and it can gain energy" if contact.frequency * h > UNSOUND else ""
    yield (
        f"timestep = {h:g} s is long for it, omega h = {contact.frequency * h:.2g}: e leaves out the step, and the "
        f"rebound can be another{gain}; {rounded_down(longest)} s resolves it"
    )


def _reference(first: float, second: float, full: float, h: float, safe: bool) -> tuple[float, float]:
    """K [1/s2] and B [1/s] of a row, with the impedance `full` at the full width."""
    if (first > 0) != (second > 0):
        first, second = 0.02, 1.0  # MuJoCo takes its default in place of a mixture of the two formats
    if first <= 0:
        return -first / full**2, -second / full
    timeconst = max(first, 2 * h) if safe else first
    return 1 / max(mujoco.mjMINVAL, (full * timeconst * second) ** 2), 2 / max(mujoco.mjMINVAL, full * timeconst)


def _is_safe(model: mujoco.MjModel) -> bool:
    """Whether MuJoCo keeps time constants above two steps."""
    return not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
