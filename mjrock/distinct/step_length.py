"""The length of the steps of masonry. It counts everything that is stiff or damps.

Longest stable step:

* the lines of the joints, with the springs and dashpots that laws of joints may give them (`JointLaw.springs`);
* links: ties, dampers, actuators and others, each kind by its `springs` and `rates`;
* blocks without a joint, and blocks whose pairs are given stronger dashpots than their joints have, as they may meet
  later (`pair_law.LongestSteps`).

Shorter steps for exact results:

* flat impacts at the joints, and of pairs that are given (`limit.Impacts`);
* the decay of a velocity by dampers (`STOPPED`);
* blocks that stiff ties throw back (`THROWN_BACK`). A tie that goes taut within a step acts for the time that it is
  taut, see `kinds.ties`.

The dashpots of actuators are part of the stable step alone: an actuator follows its history.
"""

from __future__ import annotations

from typing import NamedTuple

from ..scene.explicit_step import STEP_TAKEN
from .limit import Impacts, longest_step, rates_of_links
from .search.contact_search import ContactSearch
from .system import System

SPLINTERS = 0.1
"""Least share of the longest stable step of the joints to which the springs of blocks that may meet later shorten it
[-]. Lighter ones have softer contacts."""
STOPPED = 0.15
"""Step over the time m / C in which dampers stop what they act on, up to which that time is exact to 1 % [-]. Looking
ahead by half a step is wrong by 5/12 of its square."""

THROWN_BACK, SHORTER_FOR_TIES = 0.02, 0.5
"""Step times the circular frequency of blocks on ties alone, up to which ties need no shorter step, and by how much
they shorten it at most [-]. A block that a stiff tie throws back strikes its joints more often, and the errors of the
blows add up."""


class StepLength(NamedTuple):
    """The length of a step.

    Args:
        limit: the longest stable one [s].
        step: the one that is taken [s].
        impacts: flat impacts at the joints, and of pairs that are given.
    """

    limit: float
    step: float
    impacts: Impacts

    @classmethod
    def of(cls, system: System, unguided: float, search: ContactSearch) -> StepLength:
        """That of a system.

        Args:
            system: with its laws, links and guides.
            unguided: its longest stable step without actuators and their guides [s].
            search: the blocks as they may meet later.
        """
        limit = longest_step(system) if len(system.guided) else unguided
        least = SPLINTERS * min(limit, unguided)
        impacts = Impacts.at_joints(system)
        step = impacts.step(STEP_TAKEN * min(limit, search.longest.step(least)))
        step = max(search.impacts.step(step), min(step, STEP_TAKEN * search.longest.damped * least))
        frequency, decay = rates_of_links(system)
        step = min(
            step, max(THROWN_BACK / max(frequency, 1e-300), SHORTER_FOR_TIES * step), STOPPED / max(decay, 1e-300)
        )
        return cls(limit, step, impacts.beside(search.impacts))
