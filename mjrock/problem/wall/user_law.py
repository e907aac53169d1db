"""Laws that are classes in a user's own file: what such a class says, its numbers as a row, and what it answers.

A law has methods of an elongation or closing [m]. They take their numbers from `self`, a row with the fields of the
class, its `memory`, and what the law is given by what it is a law of. So the same text runs as plain Python and
compiled, in explicit steps and in the search for the pose of rest.
"""

from __future__ import annotations

import hashlib
import inspect
import itertools
import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cache
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np

from ...quantities import Array, keep, keep_declared, require_real
from ...rows import Row, numbers, row_type

OfUser = TypeVar("OfUser")

ANSWERS = ("stress_", "energy_", "damping_", "lost_", "dissipated_")
"""What a law has answered at the last pose, in this order in its row: its push or pull, energy, what its dashpot adds
to that, the share that it has lost [-], and by how much its energy fell as its memory changed there. A joint has [Pa]
and [J/m2], a link [N] and [J]."""
OF_STRESS, OF_ENERGY, OF_DAMPING, OF_LOST, OF_DISSIPATED = range(len(ANSWERS))
ROOM = 24
"""Numbers of a row."""
INTEGRAL = 1e-3
"""Difference of the energy from the integral of the force that is put down to quadrature, over that of its size [-]."""
DECADES = 6
"""Decades of the length that the quadrature looks at apart: a law may turn within a small part of the length."""
RATES = (0.01, 0.1, 1.0)
"""Rates for which a dashpot is checked [m/s]."""


class UserLaw:
    """What a law has where its class does not say otherwise.

    Attributes:
        methods: its methods, and how many numbers each takes.
        given: numbers that a row has beside its fields and its memory.
    """

    methods: ClassVar[dict[str, int]]
    given: ClassVar[tuple[str, ...]] = ()
    memory: ClassVar[tuple[str, ...]] = ()
    formula: ClassVar[str] = ""
    """A hash of its memory and the text of its methods, by which runs that are stored know a law that has changed."""

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

    def remember(self, u: float) -> None:
        """Change the memory."""

    @classmethod
    def answering(cls, compile_method: Callable[[Any], Any] = lambda text: text) -> Callable[[Any, float, float], None]:
        """The function that lets a law answer: it writes `ANSWERS` and the memory of a row, for a closing or elongation
        [m] and its rate [m/s].

        Args:
            compile_method: gives what runs in place of a method, such as a compiled one.
        """
        raise NotImplementedError


def law_class(kind: type[OfUser], base: type[UserLaw], called: str) -> type[OfUser]:
    """A class of a user as a law: a frozen dataclass of its numbers.

    Raises:
        TypeError: for no class, one without a method that is needed, with a method of another name or of other
            arguments, or with a memory that nothing changes.
    """
    if not inspect.isclass(kind):
        raise TypeError(f"{called} is a class, and {kind!r} is none")
    name, needed = kind.__name__, [method for method in base.methods if not hasattr(base, method)]
    for method, count in base.methods.items():
        expected = ", ".join(["self", "u", "rate"][: 1 + count])
        text = getattr(kind, method, getattr(base, method, None))
        if text is None:
            raise TypeError(f"{name} has no {method}({expected}); {called} has {' and '.join(needed)}")
        parameters = list(inspect.signature(text).parameters) if callable(text) else None
        if parameters is None or len(parameters) != 1 + count:
            raise TypeError(f"{name}.{method}({', '.join(parameters or ())}) is needed as {method}({expected})")
    _require_methods(kind, base, called)
    _require_names(name, getattr(kind, "memory", ()))
    body = {attribute: getattr(kind, attribute) for attribute in ("__module__", "__qualname__", "__doc__")}
    texts = [getattr(kind, "memory", ()), *(_bytecode(getattr(kind, method, None)) for method in base.methods)]
    body["formula"] = hashlib.sha256(repr(texts).encode()).hexdigest()
    law: type[Any] = dataclass(frozen=True)(type(name, (dataclass(frozen=True)(kind), base), body))
    names = (*(field.name for field in fields(law)), *law.memory)
    if (largest := ROOM - len(ANSWERS) - len(base.given)) < len(names):
        raise TypeError(f"{name} has {len(names)} numbers with its memory; the valid range is up to {largest}")
    for repeated in {number for number in names if number in base.given or names.count(number) > 1}:
        remark = f": {' and '.join(base.given)} are those of the joint" if base.given else ""
        raise TypeError(f"{name} has a number {repeated} more than once{remark}")
    return law


def _require_methods(kind: type, base: type[UserLaw], called: str) -> None:
    """Raise a TypeError for a method that is never called, such as a misspelt one, and for a memory without one that
    changes it."""
    names = [name for parent in kind.__mro__[:-1] for name, item in vars(parent).items() if inspect.isfunction(item)]
    if others := [name for name in names if name not in base.methods and not name.startswith("__")]:
        raise TypeError(f"{kind.__name__}.{others[0]} is never called; {called} has {', '.join(base.methods)}")
    if getattr(kind, "memory", ()) and "remember" not in names:
        raise TypeError(f"{kind.__name__} has a memory and no remember(self, u), which changes it")


def _require_names(name: str, memory: object) -> None:
    """Raise a TypeError for a memory that is no tuple of names."""
    if not isinstance(memory, tuple | list) or not all(isinstance(key, str) and key.isidentifier() for key in memory):
        shape = f'("{memory}",)' if isinstance(memory, str) else '("deepest",)'
        raise TypeError(f"{name}.memory = {memory!r} is no tuple of names; give memory = {shape}")


def _bytecode(method: object) -> object:
    """What a method does, as its bytecode and constants."""
    code = getattr(method, "__code__", method)
    if not inspect.iscode(code):
        return repr(code)
    return code.co_code, code.co_names, [_bytecode(constant) for constant in code.co_consts]


@cache
def layout(kind: Any) -> np.dtype[np.void]:
    """The row of a law, which its methods take for `self`."""
    names = (*ANSWERS, *kind.given, *(field.name for field in fields(kind)), *kind.memory)
    return row_type(numbers(*names))


def row_of(kind: Any, values: Array) -> Row:
    """The numbers of a law, shape (ROOM,), as its row. What is written into one is in the other."""
    row = layout(kind)
    return values[: row.itemsize // 8].view(row)[0]


class Answer(NamedTuple):
    """What a law answers at a closing or elongation: its push or pull, its energy, and what its dashpot adds."""

    stress: float
    energy: float
    damping: float


class AppliedLaw:
    """A law with what it is given.

    Attributes:
        law: the law.
        at: what its length is, in messages.
        whose: what has its numbers, in messages.
        answers: names of the numbers that it returns, in messages.
        shortest: length from which on a slope is taken over a part of it [m].
    """

    law: UserLaw
    at: ClassVar[str] = "a closing"
    whose: ClassVar[str] = "the law and its lines have"
    answers: ClassVar[tuple[str, str, str]] = ("stress", "energy", "damping")
    shortest: ClassVar[float] = 1e-12

    @property
    def given(self) -> tuple[float, ...]:
        """The numbers that it is given."""
        return ()

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
        known = (*self.given, *(getattr(self.law, name) for name in self.law.numbers))
        values[len(ANSWERS) : len(ANSWERS) + len(known)] = known
        return values

    def answer(self, u: float, rate: float = 0.0, values: Array | None = None, *, remembers: bool = True) -> Answer:
        """What it answers at a closing or elongation [m] and its rate [m/s], as plain Python, and what it then
        remembers in a row, if anything.

        Raises:
            TypeError, ValueError: where a method fails, or gives no finite number.
        """
        row = row_of(self.kind, self.values if values is None else values)
        try:
            with np.errstate(all="ignore"):  # what is not finite is refused below
                _plain_answering(self.kind, remembers)(row, u, rate)
        except AttributeError as error:
            has = ", ".join((layout(self.kind).names or ())[len(ANSWERS) :])
            raise TypeError(f"{self.name}: {error}; {self.whose} {has}") from None
        except Exception as error:
            raise ValueError(f"{self.name} fails at {self.at} of {u:g} m: {error!r}") from None
        answer = Answer(float(row.stress_), float(row.energy_), float(row.damping_))
        for name, value in zip(self.answers, answer, strict=True):
            if not math.isfinite(value):
                raise ValueError(f"{self.name}.{name} is {value} at {self.at} of {u:g} m; a finite number is needed")
        return answer

    def slope(self, u: float, values: Array | None = None) -> float:
        """Stiffness at a closing or elongation, of a row whose memory stays as it is."""
        step = 1e-4 * max(abs(u), self.shortest)
        ends = [self.answer(u + sign, 0.0, None if values is None else values.copy()).stress for sign in (step, -step)]
        return (ends[0] - ends[1]) / (2 * step)


@cache
def _plain_answering(kind: Any, remembers: bool) -> Callable[[Any, float, float], None]:
    """What lets a law answer as plain Python, with its memory or with one that stays as it is."""
    remember = kind.remember

    def chosen_method(method: object) -> Any:
        return UserLaw.remember if method is remember and not remembers else method

    answering: Callable[[Any, float, float], None] = kind.answering(chosen_method)
    return answering


def require_integral(law: AppliedLaw, u: float, unit: str, force: str) -> None:
    """Raise an error unless the energy up to a length [m] is the integral of the force, with the memory of one that has
    been there."""
    from scipy.integrate import IntegrationWarning, quad

    values = law.values
    law.answer(u, 0.0, values)

    def force_at(length: float) -> float:
        return law.answer(length, 0.0, values, remembers=False).stress

    ends = (u * np.append(0.0, np.logspace(-DECADES, 0, DECADES + 1))).tolist()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IntegrationWarning)  # the difference is looked at
        parts = [quad(force_at, *bounds, epsrel=0.1 * INTEGRAL, limit=100)[0] for bounds in itertools.pairwise(ends)]
    total, size = sum(parts), sum(map(abs, parts))
    first, last = (law.answer(end, 0.0, values, remembers=False).energy for end in (0.0, u))
    if abs(last - first - total) > INTEGRAL * max(abs(last - first), size):
        raise ValueError(
            f"{law.name}.energy is {last - first:g} {unit} at {law.at} of {u:g} m, and the integral of {force} "
            f"from 0 is {total:g} {unit}"
        )
