"""Laws of joints that are classes in a user's own file: what a joint has of such a class, and its checks.

A law is called for a line of a joint, with its closing [m], which is negative where the line is open. It is given `k_n`
and `friction` of the joint, see `user_law`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, NamedTuple, dataclass_transform

import numpy as np

from ....quantities import Array, Flags, Integers
from ...wall.own_link import AppliedLink
from ...wall.user_law import ANSWERS, RATES, AppliedLaw, OfUser, UserLaw, law_class, require_integral

OF_JOINT = ("k_n", "friction")
"""Numbers of the joint that a law finds in its row."""
OF_K_N = len(ANSWERS)
"""Where k_n is in a row."""
PRESSURES, PROBED = (1e2, 1e5), (0.01, 0.1, 1.0, 10.0)
"""Pressures that lie within what a law is checked for [Pa], and the closings of the checks over that of the larger."""
LEAST_CLOSING, MOST_CLOSING = 1e-12, 1e-2
"""Closings between which that of a pressure is looked for [m]."""
CLOSING_PASSES = 60
"""Halvings of the closing of a pressure, in its logarithm."""
LOW_PRESSURE = 1e-3
"""Pressure up to which a stiffness is that of the pressure, over that of the weight of all on all such joints [-]."""


class OwnLaw(UserLaw):
    """What a law of a joint has where its class does not say otherwise, see `joint_law`."""

    methods: ClassVar[dict[str, int]] = {"stress": 1, "energy": 1, "damping": 2, "remember": 1, "lost": 0}
    given: ClassVar[tuple[str, ...]] = OF_JOINT

    def damping(self, u: float, rate: float) -> float:
        """Pressure of a dashpot of its own [Pa]; without one the joint has that of its xi."""
        return 0.0

    def lost(self) -> float:
        """Share of its hold in tension that a line has lost for good [-]."""
        return 0.0

    @classmethod
    def answering(cls, compile_method: Callable[[Any], Any] = lambda text: text) -> Callable[[Any, float, float], None]:
        """Its dashpot answers by itself."""
        stress, energy, damping, remember, lost = (compile_method(getattr(cls, name)) for name in cls.methods)
        remembers = bool(cls.memory)

        def answer(row: Any, closing: float, rate: float) -> None:
            before = energy(row, closing) if remembers else 0.0
            remember(row, closing)
            row.stress_ = stress(row, closing)
            row.energy_ = energy(row, closing)
            row.dissipated_ = before - row.energy_ if remembers else 0.0
            row.damping_ = damping(row, closing, rate)
            row.lost_ = lost(row)

        return answer


@dataclass_transform(frozen_default=True)
def joint_law(kind: type[OfUser]) -> type[OfUser]:
    """A class that is a law of joints, for `Dry(law=...)` and explicit steps: a frozen dataclass of its numbers.

    A line of the joint closes by u [m]; where it is open u is below zero. The class has `stress(self, u)` [Pa], zero at
    u = 0, above zero where it presses and below zero where it pulls, and `energy(self, u)` [J/m2], its integral. It may
    have `damping(self, u, rate)` [Pa] against a rate of closing [m/s] in the place of the dashpot of xi; a tuple
    `memory` of names of numbers of each line, zero at the start, which `remember(self, u)` changes before the others
    are called; and `lost(self)`, the share of its hold in tension that a line has lost for good [-]. `self` has the
    numbers of the class, its memory, and `k_n` and `friction` of the joint. See docs/own_law.md.

    Raises:
        TypeError: for a class without stress or energy, with a method of another name or of other arguments, or with a
            memory that nothing changes.

    Examples:
        >>> @mr.joint_law
        ... class Stiffening:
        ...     a: float
        ...     def stress(self, u):
        ...         return self.k_n * u * (1 + u / self.a) if u > 0 else 0.0
        ...     def energy(self, u):
        ...         return self.k_n * u * u * (0.5 + u / (3 * self.a)) if u > 0 else 0.0
        >>> mr.Dry(k_n=1e9, law=Stiffening(a=2e-5)).law
        Stiffening(a=2e-05)
    """
    return law_class(kind, OwnLaw, "a law of a joint")


@dataclass(frozen=True)
class Own(AppliedLaw):
    """An own law on a joint, in the place of its bond.

    Args:
        law: the law.
        k_n: of the joint [N/m3].
        friction: of the joint [-].
    """

    law: OwnLaw
    k_n: float
    friction: float

    tension: ClassVar[float] = 0.0
    cohesion: ClassVar[float] = 0.0
    elastic_limit: ClassVar[float] = math.inf
    residual_friction: ClassVar[None] = None

    @property
    def given(self) -> tuple[float, ...]:
        """`OF_JOINT`."""
        return self.k_n, self.friction

    @property
    def pulls(self) -> bool:
        """Whether it pulls where it is open."""
        return _pulls(self)

    @property
    def damps(self) -> bool:
        """Whether it has a dashpot of its own."""
        return self.kind.damping is not OwnLaw.damping

    def closing_at(self, pressure: float) -> float:
        """The closing at which it has a pressure [m], the widest where it has less there."""
        low, high = math.log(LEAST_CLOSING), math.log(MOST_CLOSING)
        for _ in range(CLOSING_PASSES):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.answer(math.exp(middle)).stress >= pressure else (middle, high)
        return math.exp(high)

    def stiffest(self, deepest: float) -> tuple[float, float]:
        """The largest stiffness [N/m3] and damping coefficient [N s/m3] up to a closing or opening [m]."""
        closings = np.linspace(0.0, deepest, 17)[1:].tolist()
        k = max(self.slope(sign * closing) for closing in closings for sign in ((1.0, -1.0) if self.pulls else (1.0,)))
        c = max(abs(self.answer(closing, rate).damping) / rate for closing in closings for rate in RATES)
        return max(k, 1e-9 * self.k_n), c

    def require_fit(self, joint: str, k_n: float, k_s: float, friction: float, points: int) -> None:
        """Raise a ValueError that names the joint, if the law is none, or if it pulls on a joint without k_s."""
        require_lawful(self)
        if self.pulls and not math.isfinite(k_s):
            raise ValueError(f"law of {joint}: {self.name} pulls, and k_s = None; give k_s in N/m3")


@lru_cache(maxsize=256)
def _pulls(law: Own) -> bool:
    return any(law.answer(-share * law.closing_at(PRESSURES[-1])).stress < 0 for share in PROBED)


@lru_cache(maxsize=256)
def require_lawful(law: Own) -> None:
    """Raise an error for a law that pushes where it is open, pulls where it is closed, drives what it should damp, or
    whose energy is not the integral of its stress."""
    scale, name = law.closing_at(PRESSURES[-1]), law.name
    at_rest = law.answer(0.0)
    for answer, value in (("stress", at_rest.stress), ("energy", at_rest.energy)):
        if value != 0:
            raise ValueError(f"{name}.{answer} is {value:g} where a joint is neither closed nor open; 0 is needed")
    for share in PROBED:
        for sign, verb in ((1.0, "pulls where it is closed"), (-1.0, "presses where it is open")):
            closing = sign * share * scale
            if sign * (stress := law.answer(closing).stress) < 0:
                raise ValueError(f"{name}.stress is {stress:g} Pa at a closing of {closing:g} m: the law {verb}")
            for rate in (*RATES, *(-rate for rate in RATES)):
                if (damping := law.answer(closing, rate).damping) * rate < 0:
                    raise ValueError(
                        f"{name}.damping is {damping:g} Pa at a closing of {closing:g} m and a rate of {rate:g} m/s: "
                        "a dashpot acts against the rate of closing, with its sign"
                    )
        for closing in (share * scale, -share * scale):
            require_integral(law, closing, "J/m2", "stress")


class OwnSprings(NamedTuple):
    """The contacts and links of a scene that have own laws, for the search for the pose of rest.

    Args:
        springs: their numbers among contacts and ties, shape (n,).
        laws: the law of each.
        area: of each contact [m2], 1 of a link, shape (n,).
        floor: closing below which each contact has at least its stiffness there, so that a search can begin [m], zero
            of a link, shape (n,).
    """

    springs: Integers
    laws: tuple[Own | AppliedLink, ...]
    area: Array
    floor: Array

    @classmethod
    def from_joints(cls, bonds: tuple[Any, ...], joint: Integers, area: Array, weight: float) -> OwnSprings:
        """Those of contacts with these joints and areas, under a weight [N]."""
        owned = np.array([isinstance(bonds[i], Own) for i in joint.tolist()]) if bonds else np.zeros(0, dtype=bool)
        contacts = np.flatnonzero(owned)
        laws = tuple(bonds[i] for i in joint[contacts].tolist())
        pressure = LOW_PRESSURE * weight / max(float(area[contacts].sum()), 1e-300)
        floors = {law: law.closing_at(pressure) for law in set(laws)}
        return cls(contacts, laws, area[contacts], np.array([floors[law] for law in laws]))

    def and_links(self, ties: Integers, links: tuple[AppliedLink, ...]) -> OwnSprings | None:
        """These and links, which have these numbers; None where there are none."""
        springs = np.append(self.springs, ties)
        area, floor = np.append(self.area, np.ones(len(links))), np.append(self.floor, np.zeros(len(links)))
        return OwnSprings(springs, (*self.laws, *links), area, floor) if len(springs) else None

    @property
    def pulls(self) -> Flags:
        """Which pull as they push, shape (n,)."""
        return np.array([law.pulls for law in self.laws])

    def answers(self, gap: Array) -> tuple[Array, Array]:
        """Force [N] and energy [J] of each at the gaps of all contacts and ties [m], shape (n,) each."""
        gaps = gap[self.springs].tolist()
        answers = [law.answer(-gap) for law, gap in zip(self.laws, gaps, strict=True)]
        return self.area * [answer.stress for answer in answers], self.area * [answer.energy for answer in answers]

    def slopes(self, gap: Array) -> Array:
        """Stiffness of each at the gaps of all contacts and ties [N/m], shape (n,)."""
        gaps = gap[self.springs]
        closings = np.where(self.pulls & (gaps > 0), -gaps, np.maximum(-gaps, self.floor))
        return self.area * [law.slope(closing) for law, closing in zip(self.laws, closings.tolist(), strict=True)]
