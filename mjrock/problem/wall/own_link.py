"""Links whose law is a class in a user's own file: dampers, springs and stops between two points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Annotated, Any, ClassVar, dataclass_transform

import numpy as np

from ...quantities import Array, Within, shown
from .effect import OF_MASONRY, Anchored, Height, LinkLaw, OfBlock, PointOf
from .user_law import RATES, AppliedLaw, OfUser, UserLaw, law_class, require_integral

STROKES = np.geomspace(1e-4, 1.0, 17)
"""Elongations at which a law is checked, over the stroke [-]."""


class OwnLinkLaw(UserLaw):
    """What a law of a link has where its class does not say otherwise, see `link_law`."""

    methods: ClassVar[dict[str, int]] = {"force": 2, "energy": 1, "remember": 1}

    @classmethod
    def answering(cls, compile_method: Callable[[Any], Any] = lambda text: text) -> Callable[[Any, float, float], None]:
        """Its dashpot has what a rate adds to the force."""
        force, energy, remember = (compile_method(getattr(cls, name)) for name in cls.methods)
        remembers = bool(cls.memory)

        def answer(row: Any, u: float, rate: float) -> None:
            before = energy(row, u) if remembers else 0.0
            remember(row, u)
            row.stress_ = force(row, u, 0.0)
            row.energy_ = energy(row, u)
            row.dissipated_ = before - row.energy_ if remembers else 0.0
            row.damping_ = force(row, u, rate) - row.stress_

        return answer


@dataclass_transform(frozen_default=True)
def link_law(kind: type[OfUser]) -> type[OfUser]:
    """A class that is a law of links, for `Link(own=...)` and explicit steps: a frozen dataclass of its numbers.

    A link is longer than as drawn by u [m]; where it is shorter, u is below zero. The class has `force(self, u, rate)`
    [N], above zero where it pulls and below zero where it pushes, for u and its rate [m/s], and `energy(self, u)` [J],
    the integral of the force at no rate. It may have a tuple `memory` of names of numbers of each link, zero at the
    start, which `remember(self, u)` changes before the others are called. `self` has the numbers of the class and its
    memory. See docs/own_effect.md.

    Raises:
        TypeError: for a class without force or energy, or with a method of other arguments.

    Examples:
        >>> @mr.link_law
        ... class Buffer:
        ...     k: float
        ...     gap: float
        ...     def force(self, u, rate):
        ...         return self.k * min(u + self.gap, 0.0)
        ...     def energy(self, u):
        ...         return 0.5 * self.k * min(u + self.gap, 0.0) ** 2
        >>> mr.Link(height=2.0, own=Buffer(k=1e6, gap=0.02)).own
        Buffer(k=1000000.0, gap=0.02)
    """
    return law_class(kind, OwnLinkLaw, "a law of a link")


@dataclass(frozen=True)
class AppliedLink(AppliedLaw):
    """An own law of a link.

    Args:
        law: the law.
        stroke: largest elongation or shortening for which it is checked, and for which steps are stable [m].
    """

    law: OwnLinkLaw
    stroke: float

    at: ClassVar[str] = "an elongation"
    whose: ClassVar[str] = "the law has"
    answers: ClassVar[tuple[str, str, str]] = ("force", "energy", "force")
    shortest: ClassVar[float] = 1e-4
    pulls: ClassVar[bool] = True

    @property
    def remembers(self) -> bool:
        """Whether it has a memory."""
        return bool(self.kind.memory)

    @cached_property
    def histories(self) -> tuple[Array, ...]:
        """Rows of a new link, and of one that has been as long and as short as it may be."""
        rows = [self.values for _ in range(3)]
        for values, u in zip(rows[1:], (self.stroke, -self.stroke), strict=True):
            self.answer(u, 0.0, values)
        return tuple(rows)

    @cached_property
    def elongations(self) -> tuple[float, ...]:
        """Elongations at which it is checked [m]."""
        return (*(-self.stroke * STROKES[::-1]).tolist(), 0.0, *(self.stroke * STROKES).tolist())

    @cached_property
    def stiffest(self) -> tuple[float, float]:
        """The largest stiffness [N/m] and damping coefficient [N s/m] within the stroke."""
        states = [(u, values) for values in self.histories for u in self.elongations]
        k = max(self.slope(u, values) for u, values in states)
        c = max(abs(self.answer(u, rate, values.copy()).damping) / rate for u, values in states for rate in RATES)
        return max(k, 0.0), c


@lru_cache(maxsize=256)
def require_lawful_link(law: AppliedLink) -> None:
    """Raise an error for a law that fails within the stroke, whose rate drives what it should damp, or whose energy is
    not the integral of its force."""
    for u in law.elongations:
        for rate in (*RATES, *(-rate for rate in RATES)):
            if (damping := law.answer(u, rate).damping) * rate < 0:
                raise ValueError(
                    f"{law.name}.force changes by {damping:g} N with a rate of {rate:g} m/s at {law.at} of {u:g} "
                    "m: a dashpot acts against the rate of the length, and adds to the force with its sign"
                )
    for u in (-law.stroke, -0.1 * law.stroke, 0.1 * law.stroke, law.stroke):
        require_integral(law, u, "J", "force")


@dataclass(frozen=True, repr=False)
class Link(Anchored):
    """A link from the inner face to an anchor behind the wall whose law is a class of your own, for `solve_explicit`.

    Args:
        height: where it holds the wall [m], 0 to 200.
        own: its law, see `link_law`: the force by how much longer it is than as drawn, and the rate of that.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        stroke: largest elongation or shortening that is foreseen [m], 1e-6 to 100. The law is checked and the default
            step is stable up to there.
        block: the block that it holds.
        at: of masonry, the point that it holds, x, z or x, y, z at rest [m]; it takes the place of the height.
        anchor: of masonry, its other end at rest [m]. None is `length` behind the point.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.

    Raises:
        TypeError, ValueError: for a value outside its range, or a law that fails, that drives what it should damp, or
            whose energy is not the integral of its force.
    """

    label: ClassVar[str] = "link"
    arguments: ClassVar[str] = "height, own, length"
    only: ClassVar[str] = "solve_explicit"
    colour: ClassVar[str] = "#b5651d"
    height: Height = None  # type: ignore[assignment]
    own: Any = None
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    stroke: Annotated[float, Within(1e-6, 100, "m")] = 0.1
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: OfBlock | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.own, OwnLinkLaw):
            raise TypeError(f"own of the link = {shown(self.own)} is no object of a class under mr.link_law; give one")
        require_lawful_link(self.user_law)

    @property
    def user_law(self) -> AppliedLink:
        """Its law with the stroke."""
        return AppliedLink(self.own, self.stroke)

    @property
    def law(self) -> LinkLaw:
        """Nothing beside its own law."""
        return LinkLaw()

    @property
    def description(self) -> str:
        """For sketches and reports."""
        return f"z = {self.height:g} m, {self.own!r}"
