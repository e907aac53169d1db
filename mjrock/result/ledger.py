"""The energy ledger of a run: energy that is stored, dissipated and put in, and the error of their balance."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..quantities import Array, require_reals, shown, warn_of
from ..scene.time_step import ENERGY_GAIN


class StepError(RuntimeError):
    """Steps have become unstable at the time `t` [s]; energy has grown by `share` of the energy before [-]."""

    def __init__(self, message: str, t: float, share: float = 0.0) -> None:
        super().__init__(message)
        self.t, self.share = t, share


def require_no_gain(t: Array, balance: Array, scale: float) -> None:
    """Raise if energy grows by more than ENERGY_GAIN of the scale without work being done.

    Args:
        t: times at which energy is judged [s], shape (n,). Each solver takes those at which it knows its energy best.
        balance: energy that is there and was taken by then, less the energy that was put in [J], shape (n,). It may
            only fall.
        scale: the energy with which the gain is compared [J].

    Raises:
        StepError: if energy has appeared from nowhere.
    """
    gains = balance - np.minimum.accumulate(balance)
    worst = int(gains.argmax())
    if gains[worst] > ENERGY_GAIN * scale:
        share = float(gains[worst] / scale)
        message = f"{gains[worst]:.3g} J, {share:.2%} of the energy there was, appeared from nowhere"
        raise StepError(message, float(t[worst]), share)


def warn_if_open(unpaid: float, scale: float, largest: float, of: str, advice: Callable[[float], str]) -> None:
    """Warn of a ledger that does not close, with advice. The warning points at the call of a solver.

    Args:
        unpaid: energy without an account [J].
        scale, of: what its share is taken of [J], and the same in words.
        largest: share that is tolerated [-].
        advice: what to do against that share, in words.
    """
    if unpaid > largest * scale:
        share = unpaid / scale
        message = f"the ledger does not close: {unpaid:.3g} J, {share:.1%} of {of}, have no account; {advice(share)}"
        warn_of(message)


@dataclass(frozen=True, eq=False, repr=False)
class Ledger:
    """Energies [J] over time, each of shape (n,).

    Args:
        t: times [s].
        kinetic: kinetic energy of all bodies.
        potential: of their weight, above the undeformed contacts.
        elastic: in the springs of the contacts.
        dashpots: work that the dashpots have taken since the release, by group of contacts: "base" and "side" of a
            wall.
        friction: work that friction has taken since the release. It gives none back beyond the error of the steps.
        ground: work that the ground motion has put in, as seen from the base, and with it that of supports that are
            moved.
        actuators: work that each actuator has put in since the release, by its name: its force times the way of its
            history. What its spring holds is in `elastic`, and what its dashpot has taken in `dashpots` by its name.
        ties: work that yielding ties have taken since the release, by tie.
        broken: elastic energy that ties have lost by breaking since the release, by tie; only those that may break.
        ends: energy that contacts of masonry have lost at the ends of faces since the release, those of "joints" and
            of "encounters". A contact that passes the end of its face leaves what its spring held, and its force
            turns from the normal of one face to that of the other. Contacts that are found anew may hold more along
            their faces than those before them. Negative where energy was gained.
        bonds: what bonds of mortared joints have taken since the release, in "tension", "slip" and "crushing"; in slip
            no more than the force along the joint has done.
    """

    t: Array
    kinetic: Array
    potential: Array
    elastic: Array
    dashpots: Mapping[str, Array]
    friction: Array
    ground: Array
    actuators: Mapping[str, Array] = field(default_factory=dict)
    ties: Mapping[str, Array] = field(default_factory=dict)
    broken: Mapping[str, Array] = field(default_factory=dict)
    ends: Mapping[str, Array] = field(default_factory=dict)
    bonds: Mapping[str, Array] = field(default_factory=dict)

    @property
    def held(self) -> Array:
        """Kinetic, potential and elastic energy [J], shape (n,)."""
        return self.kinetic + self.potential + self.elastic

    @property
    def residual(self) -> Array:
        """Energy that is there or was taken, less that at the release and what was put in [J], shape (n,).

        It is zero for an exact integration. A positive residual is energy that nothing has put in.
        """
        total: Array = sum(self.taken.values(), self.held) - sum(self.put_in.values())
        return np.asarray(total - total[0])

    @property
    def taken(self) -> dict[str, Array]:
        """All accounts of what was taken, by what took it [J], shape (n,) each."""
        return (
            {f"{group} dashpots": account for group, account in self.dashpots.items()}
            | dict(self.ties)
            | {f"breaking of {tie}": account for tie, account in self.broken.items()}
            | {f"ends of faces of {kind}": account for kind, account in self.ends.items()}
            | {f"{kind} of bonds": account for kind, account in self.bonds.items()}
            | {"friction": self.friction}
        )

    @property
    def put_in(self) -> dict[str, Array]:
        """All accounts of what was put in, by what did it [J], shape (n,) each."""
        return {"the ground": self.ground, **self.actuators}

    @property
    def largest(self) -> float:
        """The largest part at any time [J]: of the energies, of what was put in and of what was taken."""
        fallen = self.potential - self.potential[0]
        parts = (self.kinetic, fallen, self.elastic, *self.taken.values(), *self.put_in.values())
        return max(float(np.abs(part).max()) for part in parts)

    def columns(self) -> dict[str, Array]:
        """All accounts as columns of a table, with their unit, shape (n,) each."""
        held = {f"{name} energy [J]": getattr(self, name) for name in ("kinetic", "potential", "elastic")}
        taken = {f"taken by {name} [J]": account for name, account in self.taken.items()}
        return held | taken | {f"put in by {name} [J]": account for name, account in self.put_in.items()}

    def at(self, t: ArrayLike) -> Ledger:
        """The ledger at other times [s], of any shape, interpolated.

        Raises:
            TypeError, ValueError: unless the times are finite real numbers.
        """
        times = require_reals("t", t, "times in s")
        if not np.isfinite(times).all():
            raise ValueError(f"t = {shown(t)} holds a value that is not finite; it takes times in s")

        def then(part: Array | Mapping[str, Array]) -> Any:
            if isinstance(part, Mapping):
                return {name: then(account) for name, account in part.items()}
            return np.interp(times, self.t, part)

        return Ledger(**{name: then(part) for name, part in vars(self).items()} | {"t": times})

    def __repr__(self) -> str:
        taken, put_in = (
            ", ".join(f"{name} {account[-1]:.4g}" for name, account in accounts.items())
            for accounts in (self.taken, self.put_in)
        )
        return (
            f"<Ledger over {self.t[-1]:.4g} s [J]: at the end held {self.held[-1]:.4g}, taken by {taken}, "
            f"put in by {put_in}, largest residual {np.abs(self.residual).max():.3g}>"
        )
