"""Coulomb's law for contacts that slide, in steps of any program: `CoulombFriction`.

MuJoCo's cone presses a contact that slides apart, by the friction that its row would need to stop it; see
`engine/sliding.py`. Here a contact that slides through the next step has no friction row. Mu times the force of its law
acts on its two bodies as an applied force, against the slip in the middle of the step, and the engine finds the
force of the law with the friction in place. A contact whose slip friction stops within the step keeps its row.
"""

from __future__ import annotations

import mujoco
import numpy as np

from .checks import Array, Integers, named, require_kind, require_within, warn_of
from .geoms import geom_label
from .notes import ContactWarning
from .versions import field

FRICTION_ITERATIONS = 10
"""Most iterations for the friction in a step."""
CONVERGED = 1e-6
"""Change of the friction in an iteration at which it has converged, as a share of it [-]."""
SLIDES_FROM = 0.99
"""Friction over mu times the normal force from which on a contact is taken to slide [-]."""
WITHOUT_SLIP = np.zeros(2)
VELOCITY = int(mujoco.mjtStage.mjSTAGE_VEL)


class CoulombFriction:
    """Friction of sliding contacts as an applied force, called before each `mj_step`.

    ::

        friction = mr.CoulombFriction(model)
        while data.time < 2.0:
            friction(data)
            mujoco.mj_step(model, data)

    It is for explicit pairs with friction, as `contact_for` makes them, with the elliptic cone. A pair of which one
    point sticks while others slide keeps its rows, and so does a pair with torsional or rolling friction, condim 4 or
    6, which is warned of. Surfaces that move, `surfacevel`, carry along what lies on them. It changes `pair_dim` of the
    model from step to step, and `release` gives it back. So a model is stepped with one `MjData` at a time: each of
    several, and each thread, has a copy of the model and a `CoulombFriction` of its own. Forces of the user in
    `qfrc_applied` remain, and may be set anew before each call.

    Args:
        model: the model that is stepped, which is changed.
        kinetic: friction of what slides over that of what sticks, which the pairs have, within [0, 1] [-].

    Raises:
        TypeError: unless it is a compiled model, and a number.
        ValueError: if it has no explicit pair with friction, the pyramidal cone, or the integrator RK4, or the share is
            outside its range.

    Warns:
        ContactWarning: of pairs with condim 4 or 6.
    """

    def __init__(self, model: mujoco.MjModel, kinetic: float = 1.0) -> None:
        require_kind("model", model, mujoco.MjModel)
        if not np.any(model.pair_dim > 1):
            raise ValueError("model has no explicit <pair> with friction; contact_for gives it one")
        if model.opt.cone != mujoco.mjtCone.mjCONE_ELLIPTIC:
            raise ValueError("model has the pyramidal cone; set cone to elliptic, as PairContact.apply does")
        if model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4:
            raise ValueError("model has the integrator RK4, in whose stages the friction of a step is not known")
        self.kinetic = require_within("kinetic", kinetic, 0.0, 1.0)
        if spun := np.flatnonzero(model.pair_dim > 3).tolist():
            ends = zip(model.pair_geom1[spun], model.pair_geom2[spun], strict=True)
            names = [" on ".join(geom_label(model, int(geom)) for geom in geoms) for geoms in ends]
            warn_of(
                f"pairs {named(names)} have condim 4 or 6, torsional or rolling friction, and keep their rows, which "
                "press apart what slides; condim 3 has Coulomb's friction",
                ContactWarning,
            )
        self.model = model
        self.dimensions = np.array(model.pair_dim)
        self._pairs = {
            frozenset((int(a), int(b))): i
            for i, (a, b) in enumerate(zip(model.pair_geom1, model.pair_geom2, strict=True))
        }
        self._now = self.dimensions
        self._data: mujoco.MjData | None = None
        self._moving: dict[int, Array] = {}
        self._applied = np.zeros(model.nv)
        self._remaining = np.zeros(model.nv)
        self.sliding: tuple[int, ...] = ()

    def __repr__(self) -> str:
        return f"<CoulombFriction of {len(self._pairs)} pairs, kinetic = {self.kinetic:g}>"

    def __call__(self, data: mujoco.MjData) -> tuple[int, ...]:
        """Write the friction of what slides into `qfrc_applied`.

        Args:
            data: the state before a step; its accelerations and contacts are those of the step afterwards.

        Returns:
            The numbers of the explicit pairs that slide in the step, also as `.sliding`.

        Raises:
            TypeError: for what is no `MjData`.
            ValueError: for another `MjData` than that of the calls since `release`, or if something else has changed
                `pair_dim` of the model since.
        """
        require_kind("data", data, mujoco.MjData)
        if self._data is not None and data is not self._data:
            raise ValueError(
                "data is another MjData than that of the calls before, and the model holds what slides in that one; "
                "give it a copy of the model, copy.copy(model), and a CoulombFriction of its own, or call release()"
            )
        if not np.array_equal(self.model.pair_dim, self._now):
            raise ValueError(
                f"model has pair_dim {self.model.pair_dim.tolist()}, and this one left {self._now.tolist()}: "
                "only one CoulombFriction works on a model, and it is made anew where pair_dim changes"
            )
        self.release(data)
        self._data = data
        mujoco.mj_forward(self.model, data)
        self._moving, pairs = self._surface(data), self._sliding_pairs(data)
        while pairs and (stopped := self._find_friction(data, pairs)):
            pairs -= stopped
            self.model.pair_dim[:] = self.dimensions
            data.qfrc_applied[:] = self._remaining[:] = self._applied
        self.sliding, self._now = tuple(sorted(pairs)), np.array(self.model.pair_dim)
        return self.sliding

    def release(self, data: mujoco.MjData | None = None) -> None:
        """Give every contact its friction row back, and clear the friction of the last step from `qfrc_applied` of
        its `MjData`, if that is given. The next call may then have another.

        Raises:
            TypeError: for what is no `MjData`.
        """
        require_kind("data", data, mujoco.MjData, type(None))
        self.model.pair_dim[:] = self.dimensions
        self.sliding, self._data, self._now = (), None, self.dimensions
        if data is not None:
            if np.array_equal(data.qfrc_applied, self._remaining):
                data.qfrc_applied[:] = self._applied
            self._applied[:] = data.qfrc_applied
            self._remaining[:] = data.qfrc_applied

    def _pressing(self, data: mujoco.MjData, least: float = 0.0) -> tuple[Integers, Integers, Integers]:
        """The contacts that press with more than the least force [N]: their numbers, those of their pairs, and those of
        their normal rows."""
        pressing, forces = [], data.efc_force
        addresses, geoms = data.contact.efc_address.tolist(), data.contact.geom.tolist()
        for i, (address, pair_geoms) in enumerate(zip(addresses, geoms, strict=True)):
            pair = self._pairs.get(frozenset(pair_geoms), -1)
            if pair >= 0 and self.dimensions[pair] == 3 and address >= 0 and forces[address] > least:
                pressing.append((i, pair, address))
        number, pairs, rows = np.reshape(np.array(pressing, dtype=np.int64), (-1, 3)).T
        return number, pairs, rows

    def _sliding_pairs(self, data: mujoco.MjData) -> set[int]:
        """The pairs of which every contact that presses slides through the step."""
        _, pairs, rows = self._pressing(data)
        if not len(rows):
            return set()
        later, tangents = np.zeros(data.nefc), rows[:, None] + np.array((1, 2))
        mujoco.mj_mulJacVec(self.model, data, later, data.qacc)
        slip, forces = data.efc_vel[tangents], data.efc_force
        shares = forces[tangents] / np.maximum(self.model.pair_friction[pairs, :2], mujoco.mjMINMU)
        saturated = (shares**2).sum(axis=1) >= (SLIDES_FROM * forces[rows]) ** 2
        onward = (slip * (slip + self.model.opt.timestep * later[tangents])).sum(axis=1) > 0
        sticks = {int(pair) for pair in pairs[~(saturated & onward)]}
        return {int(pair) for pair in pairs} - sticks

    def _find_friction(self, data: mujoco.MjData, pairs: set[int]) -> set[int]:
        """Find the friction of the pairs that slide, and return those that it stops within the step."""
        model, h = self.model, float(self.model.opt.timestep)
        model.pair_dim[:] = self.dimensions
        model.pair_dim[list(pairs)] = 1
        data.qfrc_applied[:] = self._applied
        mujoco.mj_forward(model, data)
        number, owners, rows = self._pressing(data)
        chosen = np.isin(owners, list(pairs))
        number, owners, rows = number[chosen], owners[chosen], rows[chosen]
        tangents = self._tangents(data, number, owners)
        mu = self.kinetic * model.pair_friction[owners, :2]
        slip = tangents @ data.qvel + np.reshape([self._moving.get(i, WITHOUT_SLIP) for i in number.tolist()], (-1, 2))
        before = np.zeros(model.nv)
        stops = np.zeros(len(rows), dtype=bool)
        for _ in range(FRICTION_ITERATIONS):
            change = h * (tangents @ data.qacc)
            stops = (slip * (slip + change)).sum(axis=1) <= 0
            middle = slip + 0.5 * change
            pull = mu * mu * middle  # the ellipse of friction, of which mu is the axis in each direction
            size = np.sqrt((pull * middle).sum(axis=1))
            pull *= (data.efc_force[rows] / np.maximum(size, 1e-300))[:, None]
            force = -np.einsum("ij,ijk->k", pull, tangents)
            data.qfrc_applied[:] = self._applied + force
            if stops.any() or np.abs(force - before).max(initial=0) <= CONVERGED * np.abs(force).max(initial=0):
                break
            before = force
            mujoco.mj_forwardSkip(model, data, VELOCITY, 1)
        else:
            stops[:] = True  # beyond some coefficient friction raises the force by more than that gives
        self._remaining[:] = data.qfrc_applied
        return {int(pair) for pair in owners[stops]}

    def _surface(self, data: mujoco.MjData) -> dict[int, Array]:
        """Velocity of the slip of each contact that its bodies do not have [m/s], that of its surfaces."""
        if not field(self.model, "geom_surfacevel", self.model.ngeom).any():
            return {}
        number, owners, rows = self._pressing(data, -np.inf)
        moving = data.efc_vel[rows[:, None] + np.array((1, 2))] - self._tangents(data, number, owners) @ data.qvel
        return dict(zip(number.tolist(), moving, strict=True))

    def _tangents(self, data: mujoco.MjData, number: Integers, owners: Integers) -> Array:
        """Jacobians of the slip of contacts along their two tangents, shape (n, 2, nv)."""
        model = self.model
        places, frames = data.contact.pos[number], data.contact.frame[number].reshape(-1, 3, 3)
        apart, side = np.zeros((len(number), 3, model.nv)), np.zeros((3, model.nv))
        for geoms, sign in ((model.pair_geom1, -1.0), (model.pair_geom2, 1.0)):
            for i, body in enumerate(model.geom_bodyid[geoms[owners]].tolist()):
                if body:
                    mujoco.mj_jac(model, data, side, None, places[i], body)
                    apart[i] += sign * side
        return np.array(frames[:, 1:] @ apart)
