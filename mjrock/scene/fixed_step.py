"""The longest fixed step of MuJoCo that is sound, of a wall and of any highest frequency of closed contacts."""

from __future__ import annotations

import math

from ..problem.damping.contacts import Contacts
from ..problem.wall.block import Block
from ..quantities import require_flag, require_kind

ENERGY_GAIN = 1e-3
"""Most energy that may appear from nowhere, over the energy there was [-]."""


def automatic_timestep(wall: Block, contacts: Contacts, *, side_stop: bool) -> float:
    """The step [s] at which a touch misplaces no more than ENERGY_GAIN of the energy that it meets.

    A point that touches inside a step of length h is met up to h/2 too early or too late, and its spring then stores up
    to k (v h/2)^2 / 2 that the motion has not paid. Against the kinetic energy m v^2 / 2 behind the point that is
    (omega h / 2)^2, with omega the frequency of the contact. So omega h = 2 sqrt(ENERGY_GAIN), omega the highest
    frequency of the wall with every contact closed: about a hundred steps in the shortest contact period.
    """
    require_kind("wall", wall, Block)
    require_kind("contacts", contacts, Contacts)
    require_flag("side_stop", side_stop)
    contacts.require_fit(wall, side_stop=side_stop)
    return sound_timestep(contacts.highest_frequency(wall, side_stop=side_stop))


def sound_timestep(frequency: float) -> float:
    """`automatic_timestep` for the highest frequency of the closed contacts [rad/s]."""
    return 2 * math.sqrt(ENERGY_GAIN) / frequency
