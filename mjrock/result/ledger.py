"""The energy ledger of a run: where its energy is, what took energy from it, and what does not add up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..quantities import Array

ENERGY_GAIN = 1e-3
"""Most energy that may appear from nowhere, over the energy there was [-]."""


def from_nowhere(balance: Array, scale: float) -> tuple[int, float, str] | None:
    """Where most energy has appeared from nowhere, its share of the energy there was, and the same in words; None where
    the share is at most ENERGY_GAIN.

    The two `require_no_gain`, in `engine.run` and `distinct.reading`, say of which samples.

    Args:
        balance: energy that is there and was taken, less what was put in [J], shape (n,). It may only fall.
        scale: the energy there was [J].
    """
    gains = balance - np.minimum.accumulate(balance)
    worst = int(gains.argmax())
    if gains[worst] <= ENERGY_GAIN * scale:
        return None
    share = gains[worst] / scale
    return worst, float(share), f"{gains[worst]:.3g} J, {share:.2%} of the energy there was, appeared from nowhere"


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
        friction: work that friction has taken since the release.
        ground: work that the ground motion has put in, as seen from the base.
        ties: work that yielding ties have taken since the release, by tie.
        broken: elastic energy that ties have lost by breaking since the release, by tie; only those that may break.
        ends: energy that contacts of masonry have lost at the ends of faces since the release, those of "joints" and
            of "encounters". A contact that passes the end of its face leaves what its spring held, and its force
            turns from the normal of one face to that of the other. Negative where energy was gained.
        bonds: what bonds of mortared joints have taken since the release, in "tension", "slip" and "crushing".
    """

    t: Array
    kinetic: Array
    potential: Array
    elastic: Array
    dashpots: Mapping[str, Array]
    friction: Array
    ground: Array
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
        """Energy that is there or was taken, less the energy at the release and the work of the ground [J], shape (n,).

        It is zero for an exact integration. A positive residual is energy that nothing has put in.
        """
        taken = (*self.dashpots.values(), *self.ties.values(), *self.broken.values(), *self.ends.values())
        taken += tuple(self.bonds.values())
        gone = sum(taken, self.friction) - self.ground
        total: Array = self.held + gone
        return np.asarray(total - total[0])

    @property
    def largest(self) -> float:
        """The largest part at any time [J]: of the energies, of what was put in and of what was taken."""
        groups = (self.dashpots, self.ties, self.broken, self.ends, self.bonds)
        accounts = [account for group in groups for account in group.values()]
        fallen = self.potential - self.potential[0]
        parts = (self.kinetic, fallen, self.elastic, self.friction, self.ground, *accounts)
        return max(float(np.abs(part).max()) for part in parts)

    def at(self, t: Array) -> Ledger:
        """The ledger at other times, interpolated."""

        def then(part: Any) -> Any:
            if isinstance(part, Mapping):
                return {name: then(account) for name, account in part.items()}
            return np.interp(t, self.t, part)

        return Ledger(**{name: then(part) for name, part in vars(self).items()} | {"t": t})

    def __repr__(self) -> str:
        taken = ", ".join(
            [f"{group} dashpots {account[-1]:.4g}" for group, account in self.dashpots.items()]
            + [f"{tie} {account[-1]:.4g}" for tie, account in self.ties.items()]
            + [f"breaking of {tie} {account[-1]:.4g}" for tie, account in self.broken.items()]
            + [f"ends of faces of {kind} {account[-1]:.4g}" for kind, account in self.ends.items()]
            + [f"{kind} of bonds {account[-1]:.4g}" for kind, account in self.bonds.items()]
        )
        return (
            f"<Ledger over {self.t[-1]:.4g} s [J]: at the end held {self.held[-1]:.4g}, taken by {taken}, "
            f"friction {self.friction[-1]:.4g}, put in by the ground {self.ground[-1]:.4g}, "
            f"largest residual {np.abs(self.residual).max():.3g}>"
        )
