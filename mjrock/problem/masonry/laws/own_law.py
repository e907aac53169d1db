"""Laws of joints that are classes in a user's own file: what such a class says, what a joint has of it, and its checks.

A law is asked for a line of a joint, by its closing [m], which is negative where the line is open. Its methods take
their numbers from `self`, a row with the fields of the class, its `memory`, and `k_n` and `friction` of the joint. So
the same text runs as plain Python and compiled, in explicit steps and in the search for the pose of rest.
"""

from __future__ import annotations

import hashlib
import inspect
import itertools
import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from typing import Any, ClassVar, NamedTuple, TypeVar, dataclass_transform

import numpy as np
from scipy.integrate import IntegrationWarning, quad

from ....quantities import Array, Flags, Integers, keep, keep_declared, require_real

Kind = TypeVar("Kind")

ANSWERS = ("stress_", "energy_", "damping_", "lost_", "taken_")
"""What a law has answered at the last pose, in this order in its row: [Pa], [J/m2], [Pa], [-], and by how much its
energy fell as its memory changed there [J/m2]."""
OF_STRESS, OF_ENERGY, OF_DAMPING, OF_LOST, OF_TAKEN = range(len(ANSWERS))
OF_JOINT = ("k_n", "friction")
"""Numbers of the joint that a law finds in its row."""
OF_K_N = len(ANSWERS)
"""Where k_n is in a row."""
ROOM = 24
"""Numbers of a row."""
ARGUMENTS = {"stress": 1, "energy": 1, "damping": 2, "remember": 1, "lost": 0}
"""Methods of a law, and how many numbers each takes."""
PRESSURES, PROBED = (1e2, 1e5), (0.01, 0.1, 1.0, 10.0)
"""Pressures that lie within what a law is checked for [Pa], and the closings of the checks over that of the larger."""
LEAST_CLOSING, MOST_CLOSING = 1e-12, 1e-2
"""Closings between which that of a pressure is looked for [m]."""
INTEGRAL = 1e-3
"""Difference of the energy from the integral of the stress that is put down to quadrature, over the energy [-]."""
DECADES = 6
"""Decades of the closing that the quadrature looks at apart: a law may turn within a small part of the closing."""
RATES = (0.01, 0.1, 1.0)
"""Rates of closing for which a dashpot is checked [m/s]."""
CLOSING_PASSES = 60
"""Halvings of the closing of a pressure, in its logarithm."""
LITTLE = 1e-3
"""Pressure up to which a stiffness is that of the pressure, over that of the weight of all on all such joints [-]."""


class OwnLaw:
    """What a law of a joint has where its class does not say otherwise, see `joint_law`."""

    memory: ClassVar[tuple[str, ...]] = ()
    formula: ClassVar[str] = ""
    """A hash of the text of its methods: runs that are stored know a law whose formula has been changed."""

    def __post_init__(self) -> None:
        keep_declared(self)
        keep(
            self,
            **{name: require_real(f"{name} of {type(self).__name__}", getattr(self, name)) for name in self.numbers},
        )

    @property
    def numbers(self) -> tuple[str, ...]:
        """Names of the fields."""
        return tuple(field.name for field in fields(self))  # type: ignore[arg-type]

    def damping(self, u: float, rate: float) -> float:
        """Pressure of a dashpot of its own [Pa]; without one the joint has that of its xi."""
        return 0.0

    def remember(self, u: float) -> None:
        """Change the memory of a line."""

    def lost(self) -> float:
        """Share of its hold in tension that a line has lost for good [-]."""
        return 0.0


@dataclass_transform(frozen_default=True)
def joint_law(kind: type[Kind]) -> type[Kind]:
    """A class that is a law of joints, for `Dry(law=...)` and explicit steps: a frozen dataclass of its numbers.

    A line of the joint closes by u [m]; where it is open u is below zero. The class has `stress(self, u)` [Pa], zero at
    u = 0, above zero where it presses and below zero where it pulls, and `energy(self, u)` [J/m2], its integral. It may
    have `damping(self, u, rate)` [Pa] against a rate of closing [m/s] in the place of the dashpot of xi; a tuple
    `memory` of names of numbers of each line, zero at the start, which `remember(self, u)` changes before the others
    are asked; and `lost(self)`, the share of its hold in tension that a line has lost for good [-]. `self` has the
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
    if not inspect.isclass(kind):
        raise TypeError(f"joint_law is for a class, and {kind!r} is none")
    name = kind.__name__
    for method, count in ARGUMENTS.items():
        text = getattr(kind, method, getattr(OwnLaw, method, None))
        if text is None:
            raise TypeError(f"{name} has no {method}(self, u); a law of a joint has stress and energy")
        takes = list(inspect.signature(text).parameters) if callable(text) else None
        if takes is None or len(takes) != 1 + count:
            needed = ", ".join(["self", "u", "rate"][: 1 + count])
            raise TypeError(f"{name}.{method}({', '.join(takes or ())}) is needed as {method}({needed})")
    _require_methods(kind)
    body = {each: getattr(kind, each) for each in ("__module__", "__qualname__", "__doc__")}
    body["formula"] = hashlib.sha256(
        repr([_text(getattr(kind, each, None)) for each in ARGUMENTS]).encode()
    ).hexdigest()
    made: type[Any] = dataclass(frozen=True)(type(name, (dataclass(frozen=True)(kind), OwnLaw), body))
    names = (*(field.name for field in fields(made)), *made.memory)
    if (most := ROOM - len(ANSWERS) - len(OF_JOINT)) < len(names):
        raise TypeError(f"{name} has {len(names)} numbers with its memory; the valid range is up to {most}")
    for twice in {each for each in names if each in OF_JOINT or names.count(each) > 1}:
        raise TypeError(f"{name} has a number {twice} more than once: k_n and friction are those of the joint")
    return made


def _require_methods(kind: type) -> None:
    """Raise a TypeError for a method that is never called, such as a misspelt one, and for a memory without one that
    changes it."""
    own = [name for base in kind.__mro__[:-1] for name, one in vars(base).items() if inspect.isfunction(one)]
    if others := [name for name in own if name not in ARGUMENTS and not name.startswith("__")]:
        raise TypeError(f"{kind.__name__}.{others[0]} is never called; a law of a joint has {', '.join(ARGUMENTS)}")
    if getattr(kind, "memory", ()) and "remember" not in own:
        raise TypeError(f"{kind.__name__} has a memory and no remember(self, u), which changes it")


def _text(method: Any) -> object:
    """What a method does, as its bytecode and constants."""
    code = getattr(method, "__code__", method)
    if not inspect.iscode(code):
        return repr(code)
    return code.co_code, code.co_names, [_text(one) for one in code.co_consts]


@cache
def layout(kind: Any) -> np.dtype[np.void]:
    """The row of a law, which its methods take for `self`."""
    names = (*ANSWERS, *OF_JOINT, *(field.name for field in fields(kind)), *kind.memory)
    return np.dtype([(name, float) for name in names])


def answering(kind: Any, made: Callable[[Any], Any] = lambda text: text) -> Callable[[Any, float, float], None]:
    """The function that lets a law answer: it writes `ANSWERS` and the memory of a row, for a closing [m] and its rate.

    Args:
        kind: the law.
        made: what is made of its methods, such as a compiled one.
    """
    stress, energy, damping, remember, lost = (made(getattr(kind, name)) for name in ARGUMENTS)

    remembers = bool(kind.memory)

    def answer(row: Any, closing: float, rate: float) -> None:
        held = energy(row, closing) if remembers else 0.0
        remember(row, closing)
        row.stress_ = stress(row, closing)
        row.energy_ = energy(row, closing)
        row.taken_ = held - row.energy_ if remembers else 0.0
        row.damping_ = damping(row, closing, rate)
        row.lost_ = lost(row)

    return answer


class Answer(NamedTuple):
    """What a law answers at a closing: stress [Pa], energy [J/m2], pressure of its dashpot [Pa]."""

    stress: float
    energy: float
    damping: float


@dataclass(frozen=True)
class Own:
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
    def name(self) -> str:
        """Of its class."""
        return str(self.kind.__name__)

    @property
    def kind(self) -> Any:
        """Its class."""
        return type(self.law)

    @property
    def values(self) -> Array:
        """A new row of its numbers, whose memory is empty, shape (ROOM,)."""
        values = np.zeros(ROOM)
        given = (self.k_n, self.friction, *(getattr(self.law, name) for name in self.law.numbers))
        values[len(ANSWERS) : len(ANSWERS) + len(given)] = given
        return values

    def row(self, values: Array) -> Any:
        """The row of a law from its numbers."""
        kind = layout(self.kind)
        return values[: kind.itemsize // 8].view(kind).view(np.recarray)[0]

    def answer(self, closing: float, rate: float = 0.0, values: Array | None = None) -> Answer:
        """What it answers at a closing [m] and its rate [m/s], as plain Python, and what it then remembers in a row.

        Raises:
            TypeError, ValueError: where a method fails, or gives no finite number.
        """
        row = self.row(self.values if values is None else values)
        try:
            with np.errstate(all="ignore"):  # what is not finite is said below
                answering(self.kind)(row, closing, rate)
        except AttributeError as error:
            has = ", ".join((layout(self.kind).names or ())[len(ANSWERS) :])
            raise TypeError(f"{self.name}: {error}; the law and its lines have {has}") from None
        except Exception as error:
            raise ValueError(f"{self.name} fails at a closing of {closing:g} m: {error!r}") from None
        found = Answer(float(row.stress_), float(row.energy_), float(row.damping_))
        for name, value in found._asdict().items():
            if not math.isfinite(value):
                raise ValueError(
                    f"{self.name}.{name} is {value} at a closing of {closing:g} m; a finite number is needed"
                )
        return found

    @property
    def pulls(self) -> bool:
        """Whether it pulls where it is open."""
        return _pulls(self)

    @property
    def damps(self) -> bool:
        """Whether it has a dashpot of its own."""
        return self.kind.damping is not OwnLaw.damping

    def slope(self, closing: float) -> float:
        """Stiffness at a closing [N/m3]."""
        off = 1e-4 * max(abs(closing), LEAST_CLOSING)
        return (self.answer(closing + off).stress - self.answer(closing - off).stress) / (2 * off)

    def closing_at(self, pressure: float) -> float:
        """The closing at which it has a pressure [m], the widest where it has less there."""
        low, high = math.log(LEAST_CLOSING), math.log(MOST_CLOSING)
        for _ in range(CLOSING_PASSES):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.answer(math.exp(middle)).stress >= pressure else (middle, high)
        return math.exp(high)

    def stiffest(self, deepest: float) -> tuple[float, float]:
        """The largest stiffness [N/m3] and damping coefficient [N s/m3] up to a closing either way [m]."""
        ways = np.linspace(0.0, deepest, 17)[1:].tolist()
        k = max(self.slope(sign * way) for way in ways for sign in ((1.0, -1.0) if self.pulls else (1.0,)))
        c = max(abs(self.answer(way, rate).damping) / rate for way in ways for rate in RATES)
        return max(k, 1e-9 * self.k_n), c

    def require_fit(self, joint: str, k_n: float, k_s: float, friction: float, points: int) -> None:
        """Raise a ValueError that names the joint, if the law is none, or if it pulls on a joint without k_s."""
        require_lawful(self)
        if self.pulls and not math.isfinite(k_s):
            raise ValueError(f"law of {joint}: {self.name} pulls, and k_s = None; give k_s in N/m3")


@lru_cache(maxsize=256)
def _pulls(own: Own) -> bool:
    return any(own.answer(-share * own.closing_at(PRESSURES[-1])).stress < 0 for share in PROBED)


@lru_cache(maxsize=256)
def require_lawful(own: Own) -> None:
    """Raise an error for a law that pushes where it is open, pulls where it is closed, drives what it should damp, or
    whose energy is not the integral of its stress."""
    scale, name = own.closing_at(PRESSURES[-1]), own.name
    rest = own.answer(0.0)
    for what, value in (("stress", rest.stress), ("energy", rest.energy)):
        if value != 0:
            raise ValueError(f"{name}.{what} is {value:g} where a joint is neither closed nor open; 0 is needed")
    for share in PROBED:
        for sign, verb in ((1.0, "pulls where it is closed"), (-1.0, "presses where it is open")):
            closing = sign * share * scale
            if sign * (stress := own.answer(closing).stress) < 0:
                raise ValueError(f"{name}.stress is {stress:g} Pa at a closing of {closing:g} m: the law {verb}")
            for rate in (*RATES, *(-rate for rate in RATES)):
                if (damping := own.answer(closing, rate).damping) * rate < 0:
                    raise ValueError(
                        f"{name}.damping is {damping:g} Pa at a closing of {closing:g} m and a rate of {rate:g} m/s: "
                        "a dashpot acts against the rate of closing, with its sign"
                    )
        for closing in (share * scale, -share * scale):
            _require_integral(own, closing)


def _require_integral(own: Own, closing: float) -> None:
    """Raise an error unless the energy up to a closing is the integral of the stress, where the memory stays as it is.

    The memory is that of a line which has been there.
    """
    values = own.values
    own.answer(closing, 0.0, values)
    ends = closing * np.append(0.0, np.logspace(-DECADES, 0, DECADES + 1))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IntegrationWarning)  # the difference is looked at
        total = sum(
            quad(lambda u: own.answer(u, 0.0, values.copy()).stress, *two, epsrel=0.1 * INTEGRAL, limit=100)[0]
            for two in itertools.pairwise(ends.tolist())
        )
    energy = own.answer(closing, 0.0, values.copy()).energy
    if abs(energy - total) > INTEGRAL * max(abs(energy), abs(total)):
        raise ValueError(
            f"{own.name}.energy is {energy:g} J/m2 at a closing of {closing:g} m, and the integral of stress from 0 is "
            f"{total:g} J/m2"
        )


class OwnSprings(NamedTuple):
    """The contacts of a scene whose joints have own laws, for the search for the pose of rest.

    Args:
        contacts: their numbers, shape (n,).
        laws: the law of each.
        area: of each [m2], shape (n,).
        floor: closing below which each has at least its stiffness there, so that a search can begin [m], shape (n,).
    """

    contacts: Integers
    laws: tuple[Own, ...]
    area: Array
    floor: Array

    @classmethod
    def of(cls, bonds: tuple[Any, ...], joint: Integers, area: Array, weight: float) -> OwnSprings | None:
        """Those of contacts with these joints and areas, under a weight [N], or None where no joint has an own law."""
        some = np.array([isinstance(bonds[i], Own) for i in joint.tolist()]) if bonds else np.zeros(0, dtype=bool)
        if not some.any():
            return None
        contacts = np.flatnonzero(some)
        laws = tuple(bonds[i] for i in joint[contacts].tolist())
        little = LITTLE * weight / float(area[contacts].sum())
        floors = {law: law.closing_at(little) for law in set(laws)}
        return cls(contacts, laws, area[contacts], np.array([floors[law] for law in laws]))

    @property
    def pulls(self) -> Flags:
        """Which pull as they push, shape (n,)."""
        return np.array([law.pulls for law in self.laws])

    def answers(self, gap: Array) -> tuple[Array, Array]:
        """Force [N] and energy [J] of each at the gaps of all contacts [m], shape (n,) each."""
        gaps = gap[self.contacts].tolist()
        found = [law.answer(-gap) for law, gap in zip(self.laws, gaps, strict=True)]
        return self.area * [each.stress for each in found], self.area * [each.energy for each in found]

    def slopes(self, gap: Array) -> Array:
        """Stiffness of each at the gaps of all contacts [N/m], shape (n,)."""
        closings = np.where(
            self.pulls & (gap[self.contacts] > 0), -gap[self.contacts], np.maximum(-gap[self.contacts], self.floor)
        )
        return self.area * [law.slope(closing) for law, closing in zip(self.laws, closings.tolist(), strict=True)]
