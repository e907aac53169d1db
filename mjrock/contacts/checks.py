"""Types of arrays, checks of arguments, and values as messages show them."""

from __future__ import annotations

import inspect
import math
import sys
import warnings
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import fields
from functools import cache, wraps
from itertools import islice
from numbers import Real as RealNumber
from types import UnionType
from typing import (
    Annotated,
    Any,
    NamedTuple,
    ParamSpec,
    TypeGuard,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]
P = ParamSpec("P")
Element = TypeVar("Element")
Result = TypeVar("Result")

PACKAGE = __name__.partition(".")[0]
"""The package that this one is a part of."""
WARNED = f"__{PACKAGE}_warned__"
"""Name under which the module of a user keeps which of its lines were warned of what."""
PASSED_OVER = (PACKAGE, "functools", "contextlib")
"""Packages whose lines a warning does not point to."""
MOST_SAMPLES = 50_000_000
"""Most samples or fixed steps of one answer: some gigabytes."""
MOST_LISTED = 1_000_000
"""Most values of an argument that is a list."""


class Message(str):
    """A text for the user that carries the template and the values that it is made of, from which another language can
    be written: `Message("{name} = {value:g} m is too long", name="length", value=3.0)`.

    Args:
        template: the English text, with the values in braces.
        values: by their names. One may be a message too.
    """

    template: str
    values: dict[str, object]

    def __new__(cls, template: str, /, **values: object) -> Message:
        """Write the template with the values."""
        message = super().__new__(cls, template.format(**values))
        message.template, message.values = template, values
        return message

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, object]]:
        return (self.template,), self.values


def reason(error: BaseException) -> str:
    """What an error or a warning says, as a `Message` where it was raised with one."""
    return error.args[0] if error.args and isinstance(error.args[0], Message) else str(error)


def keep(instance: object, **checked: object) -> None:
    """Set fields of a frozen dataclass to what their checks returned, while it is made.

    A check takes any real number and returns a float. The number given is not kept: NumPy computes with its small
    numbers in their own few bits, in which 200 * 2 is 144.
    """
    for name, value in checked.items():
        object.__setattr__(instance, name, value)


def spelt(value: object) -> str:
    """A value as `repr` spells it, in text that UTF-8 can hold; its type where `repr` fails."""
    try:
        text = repr(value)
    except Exception:
        text = f"a {type(value).__name__}"
    return text.encode("utf-8", "backslashreplace").decode()


def shown(value: object) -> str:
    """A value and its type on one line, short enough for a message; of None nothing but its name."""
    if value is None:
        return "None"
    return Message("{value} of type {kind}", value=brief(value), kind=type(value).__name__)


def brief(value: object) -> str:
    """A value on one line, short enough for a message."""
    text = " ".join(spelt(value).split())
    return f"{text[:60]}{'...' if len(text) > 60 else ''}"


def short_repr(instance: Any) -> str:
    """A dataclass as it would be written, on a line: numbers with six digits, and nothing that has its default."""
    shown = ((field, getattr(instance, field.name)) for field in fields(instance) if field.repr)
    arguments = (f"{field.name}={_shortened(value)}" for field, value in shown if not _is_default(value, field.default))
    return f"{type(instance).__name__}({', '.join(arguments)})"


def _is_default(value: object, default: object) -> bool:
    return value is default or (isinstance(value, str | int | float | tuple) and value == default)


def _shortened(value: object) -> str:
    """A value on a line: of a long row the number of its values."""
    if isinstance(value, np.ndarray | tuple | list):
        return f"<{len(value)} values>" if len(value) > NAMED else f"({', '.join(map(_shortened, value))})"
    return f"{value:.6g}" if isinstance(value, float) else spelt(value)


def warn_of(message: str, kind: type[Warning] = UserWarning, *, once: str = "") -> None:
    """Warn of something at the line of the user that led to it: the nearest one outside the package.

    With `once`, what the warning is about, a line warns of it once, whatever the numbers in the message: a search makes
    a hundred motions at one line. The module of that line knows what it was warned of, as it does for `warnings`.
    """
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in PASSED_OVER:
        level, frame = level + 1, frame.f_back
    warned = frame.f_globals.setdefault(WARNED, set())
    if once and (key := (once, frame.f_code, frame.f_lineno)) in warned:
        return
    if once:
        warned.add(key)
    warnings.warn(message, kind, stacklevel=level)


def require_real(name: str, value: object) -> float:
    """Return `value` as a float.

    Raises:
        TypeError: with the name and the value, unless it is a real number. True and False are not.
        ValueError: if it is too large for a float.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, RealNumber):
        raise TypeError(Message("{name} = {value} is not a real number", name=name, value=shown(value)))
    try:
        return float(value)
    except OverflowError:
        text = Message("{name} is a number too large for a float, beyond any valid range", name=name)
        raise ValueError(text) from None


def require_within(name: str, value: object, low: float, high: float, unit: str = "") -> float:
    """Return `value` as a float.

    Raises:
        TypeError: unless it is a real number.
        ValueError: with the value and the range, unless the value lies within [low, high]. NaN never does.
    """
    number = require_real(name, value)
    if not low <= number <= high:
        units = " or ".join(dict.fromkeys(unit.split(", ")))  # a row of numbers may have several
        values = {"name": name, "number": number, "low": low, "high": high, "unit": units and f" {units}"}
        raise ValueError(
            Message("{name} = {number:g}{unit} is outside the valid range {low:g} to {high:g}{unit}", **values)
        )
    return number


class Within(NamedTuple):
    """The valid range of a number, declared with its field: `height: Annotated[float, Within(0, 200, "m")]`.

    Args:
        low, high: the least and the largest valid value.
        unit: of the number.
        name: what messages call it; the name of the field where it is empty.
        whole: whether it is a whole number.
        infinite: whether it may be infinite too.
    """

    low: float
    high: float
    unit: str = ""
    name: str = ""
    whole: bool = False
    infinite: bool = False

    def up_to(self, high: float) -> Within:
        """The part of the range up to another number."""
        return self._replace(high=min(self.high, high))

    def checked(self, name: str, value: object) -> float:
        """The value as a float or an integer; raises as `require_within` and `require_whole`."""
        if self.infinite and require_real(name, value) == math.inf:
            return math.inf
        if self.whole:
            return require_whole(name, value, int(self.low), int(self.high))
        try:
            return require_within(name, value, self.low, self.high, self.unit)
        except ValueError as error:
            cause = reason(error)
            raise ValueError(Message("{cause}, or inf", cause=cause) if self.infinite else cause) from None


def alternatives(hint: object) -> tuple[object, ...]:
    """The types that a value of a hint may be of, one by one, with those that are noted with it."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        kinds = (note for note in arguments[1:] if isinstance(note, type) or get_origin(note) is not None)
        return (*alternatives(arguments[0]), *(part for kind in kinds for part in alternatives(kind)))
    if isinstance(hint, TypeVar):
        return alternatives(hint.__bound__) if hint.__bound__ else hint.__constraints__
    if origin in (Union, UnionType):
        return tuple(kind for argument in arguments for kind in alternatives(argument))
    return (hint,)


class Declaration(NamedTuple):
    """What is declared of a field or an argument.

    Args:
        within: the range of its number, or of each of several.
        optional: whether it may be None.
        several: whether it may be a row of numbers.
        computed: whether it may be a function that gives the number.
    """

    within: Within
    optional: bool
    several: bool = False
    computed: bool = False

    @classmethod
    def from_hint(cls, hint: object) -> Declaration | None:
        """What an annotation declares; None without a range."""
        within = next((note for note in getattr(hint, "__metadata__", ()) if isinstance(note, Within)), None)
        if within is None:
            return None
        kinds = alternatives(hint)
        computed = [kind for kind in kinds if get_origin(kind) is Callable]
        plain = [kind for kind in kinds if kind in (float, int, type(None))]
        return cls(within, type(None) in kinds, len(plain) + len(computed) < len(kinds), bool(computed))

    def checked(self, name: str, value: Any) -> Any:
        """The value, a number as a float or an integer.

        Raises:
            TypeError, ValueError: with the name, for a number outside the range, or what is none.
        """
        if (value is None and self.optional) or (self.computed and callable(value)):
            return value
        if self.several and not isinstance(value, RealNumber):
            row = require_reals(name, value, "a number or a row of them").ravel()
            low, high, *_ = self.within
            for item in row if self.within.whole else row[~((low <= row) & (row <= high))]:
                self.within.checked(name, item)
            return value
        return self.within.checked(name, value)


@cache
def declared(kind: Callable[..., object]) -> dict[str, Declaration]:
    """What each field of a class, or argument of a function, declares that has a range."""
    hints = get_type_hints(kind, include_extras=True)
    declarations = {name: Declaration.from_hint(hint) for name, hint in hints.items()}
    return {name: declaration for name, declaration in declarations.items() if declaration is not None}


def keep_declared(instance: object, owner: str = "", but: Collection[str] = ()) -> None:
    """Check and keep the fields of a frozen dataclass that declare a range, while it is made.

    Args:
        instance: the dataclass.
        owner: the object that messages name as the owner of the number, as in "length of the tie".
        but: fields that are left as they are.

    Raises:
        TypeError, ValueError: with the name, the value and the range, as `require_within`.
    """
    owner_type: Callable[..., object] = type(instance)
    for field, declaration in declared(owner_type).items():
        if field not in but:
            name = declaration.within.name or (f"{field} of the {owner}" if owner else field)
            keep(instance, **{field: declaration.checked(name, getattr(instance, field))})


def within_ranges(function: Callable[P, Result]) -> Callable[P, Result]:
    """A function whose arguments are checked and converted, before it runs, by the ranges that they declare as fields
    do: `height: Annotated[float, Within(0, 200, "m")]`. Errors are those of `keep_declared`."""
    parameters = inspect.signature(function)

    @wraps(function)
    def with_checked(*arguments: P.args, **options: P.kwargs) -> Result:
        try:
            bound = parameters.bind(*arguments, **options)
        except TypeError:
            return function(*arguments, **options)  # whose error names what is missing or too much
        for name, declaration in declared(function).items():
            if name in bound.arguments:
                bound.arguments[name] = declaration.checked(declaration.within.name or name, bound.arguments[name])
        return function(*bound.args, **bound.kwargs)

    return with_checked


def require_whole(name: str, value: object, low: int, high: int) -> int:
    """Return `value` as an integer.

    Raises:
        TypeError: unless it is a real number.
        ValueError: with the value and the range, unless it is a whole number within [low, high].
    """
    number = require_within(name, value, low, high)
    if number != int(number):
        values = {"name": name, "number": number, "low": low, "high": high}
        raise ValueError(
            Message("{name} = {number:g} is not a whole number; the valid range is {low} to {high}", **values)
        )
    return int(number)


def require_kind(name: str, value: object, *kinds: type) -> None:
    """Raise a TypeError that names the value and what is needed, unless it is of one of these types."""
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        needed = " or ".join("None" if kind is type(None) else kind.__name__ for kind in kinds)
        raise TypeError(Message("{name} = {value} is not a {needed}", name=name, value=shown(value), needed=needed))


def is_iterable(values: object) -> TypeGuard[Iterable[object]]:
    """Whether values can be gone through one by one. A text is one value, and so is an array without dimensions."""
    if isinstance(values, str | bytes) or (isinstance(values, np.ndarray | np.generic) and values.ndim == 0):
        return False
    return isinstance(values, Iterable) or hasattr(type(values), "__getitem__")


def listed(name: str, values: Iterable[Element]) -> list[Element]:
    """The values of an iterable as a list, whatever its length is.

    Raises:
        ValueError: if there are more than MOST_LISTED, as where they have no end.
    """
    taken = list(islice(values, MOST_LISTED + 1))
    if len(taken) > MOST_LISTED:
        raise ValueError(f"{name} has more values than the largest valid number, {MOST_LISTED}")
    return taken


def require_flag(name: str, value: object) -> bool:
    """Return `value` as a bool, or raise a TypeError unless it is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name} = {shown(value)} is neither True nor False")
    return bool(value)


def require_text(name: str, value: object, longest: int = 1000) -> str:
    """Return `value`, a text that a model, a page and a table can hold.

    Raises:
        TypeError: unless it is a text.
        ValueError: if it has a NUL, half of a surrogate pair, or more characters than `longest`.
    """
    require_kind(name, value, str)
    text = str(value)
    if len(text) > longest:
        values = {"name": name, "text": shown(text), "count": len(text), "longest": longest}
        raise ValueError(Message("{name} = {text} has {count} characters; the valid range is 0 to {longest}", **values))
    if "\0" in text or text.encode("utf-8", "ignore").decode() != text:
        raise ValueError(f"{name} = {shown(text)} has a NUL or half of a surrogate pair, which no file can hold")
    return text


def require_size(what: str, count: float, remedy: str) -> None:
    """Raise a ValueError with the number and what to change, if there are more samples than MOST_SAMPLES."""
    if not count <= MOST_SAMPLES:
        raise ValueError(f"{what} would be {count:.3g}; at most {MOST_SAMPLES:.0e} fit into memory; {remedy}")


def require_plain(name: str, values: object, takes: str, kinds: str) -> NDArray[Any]:
    """`values` as an array of certain kinds.

    Args:
        name: what it is called.
        values: the values.
        takes: what the values have to be, in words.
        kinds: characters of the kinds, those of `numpy.dtype.kind`.

    Raises:
        TypeError: with the name and what it takes, for values of another kind.
        ValueError: if they are ragged, masked, or more than MOST_SAMPLES.
    """
    try:
        array = np.asarray(values)
    except ValueError:
        raise ValueError(f"{name} = {shown(values)} has rows of different lengths; it takes {takes}") from None
    except MemoryError:
        raise ValueError(f"{name} = {shown(values)} has more values than memory holds; it takes {takes}") from None
    except Exception as error:  # of an object that cannot become an array
        raise TypeError(f"{name} = {shown(values)} cannot be read ({error!r}); it takes {takes}") from None
    if array.dtype.kind not in kinds or ("b" not in kinds and _holds_truth(values)):
        held = "values of these kinds" if "b" in kinds else "real numbers"
        raise TypeError(f"{name} = {shown(values)} does not hold {held} alone; it takes {takes}")
    if _is_masked(values):
        raise ValueError(f"{name} has masked values; it takes {takes}")
    require_size(f"the size of {name}", array.size, "give fewer values")
    return array


def require_reals(name: str, values: object, takes: str) -> Array:
    """`values` as an array of floats, see `require_plain`. True and False are refused, also among numbers."""
    return np.asarray(require_plain(name, values, takes, "iuf"), dtype=float)


def require_row(name: str, values: object, element: str) -> Array:
    """Return a copy of `values` as a row of finite numbers, shape (n,).

    Args:
        name: what it is called.
        values: the numbers.
        element: what each of them is.

    Raises:
        TypeError: unless they are real numbers.
        ValueError: if they are ragged, masked or not finite, not a row, or an empty one.
    """
    row = np.array(require_reals(name, values, f"a row of at least one {element}"))
    if row.ndim != 1 or not row.size:
        raise ValueError(f"{name} has the shape {row.shape}; a row of at least one {element} is needed")
    return _finite(name, row)


def _holds_truth(values: object) -> bool:
    """Whether a list, or a list in it, has True or False among its values: NumPy makes numbers of them."""
    if isinstance(values, list | tuple):
        return any(map(_holds_truth, values))
    return isinstance(values, bool | np.bool_) or (isinstance(values, np.ndarray) and values.dtype.kind == "b")


def _is_masked(values: object) -> bool:
    """Whether an array, or one of a list of arrays, has masked values."""
    if "numpy.ma" not in sys.modules:  # nobody has made any
        return False
    rows = values if isinstance(values, list | tuple) else [values]
    return any(isinstance(row, np.ma.MaskedArray) and np.ma.is_masked(row) for row in rows)


def require_array(name: str, value: object, shape: tuple[int, ...]) -> Array:
    """Return a copy of `value` as an array of finite numbers.

    Raises:
        TypeError: if it is not an array of real numbers.
        ValueError: if it is ragged or masked, has another shape, or a value that is not finite.
    """
    array = np.array(require_reals(name, value, f"an array of real numbers of the shape {shape}"))
    if array.shape != shape:
        raise ValueError(f"{name} has the shape {array.shape}; {shape} is needed")
    return _finite(name, array)


def _finite(name: str, array: Array) -> Array:
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds a value that is not finite")
    return array


NAMED = 5
"""Most names in a message."""


def named(names: Sequence[str]) -> str:
    """Names in a message: the first NAMED, and how many more there are."""
    further = len(names) - NAMED
    return ", ".join(names[:NAMED]) + (f" and {further} more" if further > 0 else "")
