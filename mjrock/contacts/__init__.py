"""Contacts of any MuJoCo model with a stiffness in N/m and a coefficient of restitution.

`contact_for` makes a contact of two geoms, `contacts_for` those of many, and `inspect_contacts` gives the contacts of a
model in these units. It needs MuJoCo and NumPy alone. A name is imported when it is first used.
"""

import importlib
from typing import TYPE_CHECKING

from .names import homes

if TYPE_CHECKING:
    from .contact import PairContact, PairContacts
    from .coulomb import CoulombFriction
    from .inspect import FlexContact, InspectedContact, inspect_contacts, inspect_flexes
    from .make import contact_for, contacts_for, stiffest_contacts
    from .measurement import Measurement, measure
    from .notes import ContactWarning
    from .rebound import rebound_damping, rebound_restitution
    from .solref import ContactParameters, ManyContactParameters, contact_parameters, contact_stiffness

__all__ = [
    "ContactParameters", "ContactWarning", "CoulombFriction", "FlexContact", "InspectedContact",
    "ManyContactParameters", "Measurement", "PairContact", "PairContacts", "contact_for", "contact_parameters",
    "contact_stiffness", "contacts_for", "inspect_contacts", "inspect_flexes", "measure", "rebound_damping",
    "rebound_restitution", "stiffest_contacts",
]  # fmt: skip

HOME = homes(__file__)
"""The module of each public name."""


def __getattr__(name: str) -> object:
    """A public name, imported when it is first used."""
    if name not in HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value = getattr(importlib.import_module(f".{HOME[name]}", __name__), name)
    return value


def __dir__() -> list[str]:
    """The public names."""
    return __all__
