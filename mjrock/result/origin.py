"""Where a response comes from: what its solver was given beside the case, and the programs that computed it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .._version import __version__
from ..machine import description
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import AnyRestitution
from ..problem.masonry.case import AnyCase


@dataclass(frozen=True)
class Origin:
    """What a solver was given beside the case, and the programs that computed the response.

    Args:
        contacts: interfaces of a wall; None for masonry and for rocking theory.
        e: coefficients of restitution of rocking theory, with the seed of those that are drawn; else None.
        options: the other arguments of the solver, by name. A `start` is without the memory of explicit steps.
        version: of mjrock.
        machine: the processor, Python, and the versions and kernels of what computes, in a line.
    """

    contacts: Contacts | None = None
    e: AnyRestitution | None = None
    options: Mapping[str, object] = field(default_factory=dict)
    version: str = __version__
    machine: str = field(default_factory=description)


def sources(case: AnyCase) -> dict[str, str]:
    """Names of the ground motions of a case, with the fields of the headers of their files; artificial ones have their
    seed there."""
    names = {}
    for component, motion in case.grounds.items():
        header = ", ".join(f"{field}: {value}" for field, value in motion.header.items())
        names[component] = f"{motion.name} ({header})" if header else motion.name
    return names
