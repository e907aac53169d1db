"""Properties of joints as they are given, by the keywords of masonry and all its builders, and the table of them."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property, wraps
from typing import Annotated, Any, NamedTuple, TypedDict, TypeVar

import numpy as np

from ....quantities import Array, Integers, Within, declared, named, require_kind, shown, within_ranges
from ....rows import Rows
from ...damping.contacts import AnyLaw
from ..blocks.joints import Joint
from ..blocks.joints_in_space import SpaceJoint
from .bond import Bond
from .dry import NONE_FURTHER, AnyPairs, Dry, Mortar, Properties
from .joint_law import law_rows
from .own_law import Own, OwnLaw

AnyJoint = Joint | SpaceJoint
T = TypeVar("T")
FunctionOfJoint = Callable[[Any], T]
OfJoint = float | FunctionOfJoint[float]
"""A number, or a function of the joint that gives one."""
OfCount = int | FunctionOfJoint[int]
"""A whole number, or a function of the joint that gives one."""
OfStiffness = Annotated[OfJoint | None, declared(Dry)["k_n"].within]
OfFriction = Annotated[OfJoint | None, declared(Dry)["friction"].within]
OfDamping = Annotated[OfJoint | None, declared(Dry)["xi"].within]
OfShear = Annotated[OfJoint | None, declared(Dry)["k_s"].within]
OfFrequency = Annotated[OfJoint | None, declared(Dry)["frequency"].within]
OfPoints = Annotated[OfCount | None, declared(Dry)["points"].within]
"""The properties of joints one by one, in the ranges of a `Dry`."""
OfBond = Bond | OwnLaw | Dry | FunctionOfJoint[Bond | OwnLaw | Dry | None] | None
"""A bond, a law of one's own, or a joint for its further numbers, a function of the joint that gives one or None where
the joint is dry, or None where all are dry."""
AnyJoints = Dry | Mortar | FunctionOfJoint[Dry | Mortar]
"""What all joints of masonry are, or a function of the joint that says what it is."""
PROPERTIES = tuple(Dry().properties)
"""Names of what a joint has, which are keywords of `Masonry` too."""


def value_at(name: str, function: FunctionOfJoint[T], joint: AnyJoint) -> T:
    """What a function of the joint gives for one, or a TypeError that says how it is called."""
    try:
        return function(joint)
    except TypeError as error:
        raise TypeError(f"{name} = {shown(function)} is not called as {name}(joint): {error}") from None


def properties_of(joints: AnyJoints | None, given: Properties) -> Properties:
    """The properties of joints by name, a number or a function of the joint each.

    Args:
        joints: what all joints are, or a function of the joint that gives it, or None.
        given: the properties that are given by keyword instead; None takes that of a `Dry`.

    Raises:
        TypeError: for another kind.
        ValueError: for a number outside its range, or where both are given.
    """
    named = {name: value for name, value in given.items() if value is not None}
    if joints is None:
        ranges = declared(Dry)
        return Dry().properties | {
            name: value if callable(value) or name not in ranges else ranges[name].within.checked(name, value)
            for name, value in named.items()
        }
    if named:
        raise ValueError(f"joints is given with {', '.join(named)}, which it says itself; give one or the other")
    if callable(joints):
        choice = Choice(joints)
        return {name: ChoiceProperty(choice, name) for name in PROPERTIES}
    require_kind("joints", joints, Dry, Mortar)
    return joints.properties


def has_function(value: object) -> bool:
    """Whether a value is, or has in its fields, a function, which has no content to compare or to write."""
    if is_dataclass(value) and not isinstance(value, type):
        return any(has_function(getattr(value, entry.name)) for entry in fields(value))
    if isinstance(value, tuple | list):
        return any(map(has_function, value))
    return callable(value)


@dataclass(frozen=True)
class Choice:
    """A function of the joint that gives what it is, which is called once for each joint."""

    function: FunctionOfJoint[Dry | Mortar]
    known: dict[AnyJoint, Properties] = field(default_factory=dict, compare=False, repr=False)

    def __call__(self, joint: AnyJoint) -> Properties:
        """The properties of a joint by name."""
        if joint not in self.known:
            chosen = value_at("joints", self.function, joint)
            require_kind(f"joints of {joint.name}", chosen, Dry, Mortar)
            self.known[joint] = chosen.properties
        return self.known[joint]


@dataclass(frozen=True)
class ChoiceProperty:
    """One property of what a function of the joint gives."""

    choice: Choice
    name: str

    def __call__(self, joint: AnyJoint) -> Any:
        """The value of a joint."""
        return self.choice(joint)[self.name]


@dataclass(frozen=True)
class ByKind:
    """A property of bed joints, and another of those that are not horizontal, a number or a function of the joint."""

    beds: OfJoint
    others: OfJoint

    def __call__(self, joint: AnyJoint) -> float:
        """The value of a joint."""
        value = self.beds if joint.is_bed else self.others
        return value(joint) if callable(value) else value


@dataclass(frozen=True)
class ByWord:
    """A property of joints whose name has a word, the first of pairs of a word and a value, and that of all others."""

    words: tuple[tuple[str, float], ...]
    otherwise: OfJoint

    def __call__(self, joint: AnyJoint) -> float:
        """The value of a joint."""
        for word, value in self.words:
            if word in joint.name:
                return value
        return self.otherwise(joint) if callable(self.otherwise) else self.otherwise


@dataclass(frozen=True)
class ByName:
    """A property of each joint by its name, as pairs of a name and a value.

    Unlike a function it has content, by which masonry can be compared and a campaign can tell its tasks apart.
    """

    values: tuple[tuple[str, Any], ...]

    @cached_property
    def _by_name(self) -> dict[str, Any]:
        return dict(self.values)

    def __call__(self, joint: AnyJoint) -> Any:
        """The value of a joint.

        Raises:
            ValueError: if it has none.
        """
        if joint.name not in self._by_name:
            raise ValueError(f"the joint {joint.name} has no value among those of {', '.join(self._by_name)}")
        return self._by_name[joint.name]


@dataclass(frozen=True)
class OrElse:
    """A function of the joint, and a number that stands where it gives None."""

    function: FunctionOfJoint[float | None]
    otherwise: float

    def __call__(self, joint: AnyJoint) -> float:
        """The value of a joint."""
        value = self.function(joint)
        return self.otherwise if value is None else value


@dataclass(frozen=True)
class Halved:
    """Bonds of a wall of divided units: `between` them, one or a function of the joint, and `within` them."""

    between: OfBond
    within: Bond

    def __call__(self, joint: AnyJoint) -> Bond | OwnLaw | Dry | None:
        """The bond of a joint."""
        first, second = joint.name.split("|")
        if first[:-1] == second[:-1] and first[-1] + second[-1] == "ab":
            return self.within
        return self.between(joint) if callable(self.between) else self.between


FOR_NONE = {"k_s": np.inf, "frequency": np.nan}
"""What stands for None in a table: a joint that sticks rigidly, and the lowest frequency of the masonry."""


KNOWN_BY_ALL = ("k_n", "xi", "friction")
"""Numbers of a joint that all solvers of masonry know."""
POINTS_IN_SPACE = Within(2, 50, whole=True)
"""Valid `points` of a joint in space. In the plane they are those of `Dry`."""


class JointTable(NamedTuple):
    """Properties of the joints of masonry.

    Args:
        k_n, k_s: stiffness along the normal and along the face [N/m3], k_s infinite for a joint that sticks rigidly,
            shape (joints,) each.
        friction: coefficient [-], shape (joints,).
        xi: damping ratio [-], shape (joints,).
        frequency: to which it refers [rad/s], NaN for the lowest one of the masonry, shape (joints,).
        points: contact lines, shape (joints,).
        bonds: what mortar holds, or the law of one's own on each joint, None where a joint is dry.
        further: the numbers of their law for which masonry has no keyword, by name, shape (joints,) each.
    """

    k_n: Array
    k_s: Array
    friction: Array
    xi: Array
    frequency: Array
    points: Integers
    bonds: tuple[Bond | Own | None, ...]
    further: dict[str, Array]

    @classmethod
    def from_properties(cls, joints: Sequence[AnyJoint], values: Properties) -> JointTable:
        """The table of joints from their properties, a number or a function of the joint each.

        Raises:
            TypeError, ValueError: with the name of the joint, for a value outside its range or a bond that its springs
                cannot have.
        """
        columns = {name: _values(name, values[name], joints) for name in ("k_n", "k_s", "friction", "xi", "frequency")}
        points = _values("points", values["points"], joints).astype(int)
        for joint, count in zip(joints, points.tolist(), strict=True):
            if isinstance(joint, SpaceJoint):
                POINTS_IN_SPACE.checked(f"points of {joint.name}" if callable(values["points"]) else "points", count)
        bonds = _bonds(values["bond"], joints, columns)
        dry = [bond.further if isinstance(bond, Dry) else NONE_FURTHER for bond in bonds]
        further = {name: np.array([numbers_of_bond[name] for numbers_of_bond in dry]) for name in NONE_FURTHER}
        laws = tuple(None if isinstance(bond, Dry) else bond for bond in bonds)
        table = cls(**columns, points=points, bonds=laws, further=further)
        springs = (column.tolist() for column in (table.k_n, table.k_s, table.friction, points))
        for joint, bond, *numbers in zip(joints, table.bonds, *springs, strict=True):
            if bond is not None:
                bond.require_fit(joint.name, *numbers)
        return table

    def laws(self, joint: Integers, **numbers: Array) -> Rows:
        """Rows of the law of lines, see `law_rows`.

        Args:
            joint: of each line, shape (m,).
            numbers: those that are not what their joints have, shape (m,) each.
        """
        of_joints = {"friction": self.friction, **self.further}
        return law_rows(len(joint), **{name: values[joint] for name, values in of_joints.items()} | numbers)

    def require_known(self, what: str, joints: Sequence[AnyJoint], known: tuple[str, ...] = KNOWN_BY_ALL) -> None:
        """Raise a ValueError that names what takes joints with these numbers alone, if some have others, a bond or an
        own law."""

        def names(flags: Sequence[object]) -> str:
            return named([joint.name for joint, flag in zip(joints, flags, strict=True) if flag])

        laws = [bond if isinstance(bond, Own) else None for bond in self.bonds]
        numbers = {name: values != NONE_FURTHER[name] for name, values in self.further.items()}
        unknown = {f"{name} of {names(differs)}": name for name, differs in numbers.items() if differs.any()}
        if any(laws):
            unknown[f"law of {names(laws)}"] = ", ".join(sorted({bond.name for bond in laws if bond}))
        for label, name in unknown.items():
            takes = "it" if name in numbers else "laws of your own"
            raise ValueError(
                f"{label}: {what} knows {', '.join(known[:-1])} and {known[-1]} of a joint, and no {name}; "
                f"solve_explicit takes {takes}"
            )
        if any(self.bonds):
            raise ValueError(
                f"bond of {names(self.bonds)}: {what} takes joints that push only; solve_explicit takes bonds"
            )

    @property
    def residual_friction(self) -> Array:
        """Coefficient of friction of joints that have lost their bond [-], shape (joints,)."""
        residual = [bond and bond.residual_friction for bond in self.bonds]
        return np.array(
            [intact if left is None else left for left, intact in zip(residual, self.friction, strict=True)]
        )


def _values(name: str, value_of: OfJoint | None, joints: Sequence[AnyJoint]) -> Array:
    """A property of each joint, with what stands for None, shape (joints,)."""
    if not callable(value_of):
        return np.full(len(joints), FOR_NONE[name] if value_of is None else value_of)
    declaration, values = declared(Dry)[name], [value_at(name, value_of, joint) for joint in joints]
    for i, joint in enumerate(joints):
        value = declaration.checked(f"{name} of {joint.name}", values[i])
        values[i] = FOR_NONE[name] if value is None else value
    return np.array(values)


def _bonds(bond_of: OfBond, joints: Sequence[AnyJoint], columns: dict[str, Array]) -> list[Bond | Own | Dry | None]:
    """The bond of each joint, the law of one's own, or the joint with its further numbers, None where it has none."""
    bonds: list[Bond | Own | Dry | None] = []
    for i, joint in enumerate(joints):
        bond = value_at("bond", bond_of, joint) if callable(bond_of) else bond_of
        require_kind(f"bond of {joint.name}" if callable(bond_of) else "bond", bond, Bond, OwnLaw, Dry, type(None))
        if isinstance(bond, OwnLaw):
            bonds.append(Own(bond, float(columns["k_n"][i]), float(columns["friction"][i])))
        else:
            bonds.append(None if isinstance(bond, Bond) and bond.is_dry else bond)
    return bonds


Class = TypeVar("Class", bound=type)


class OtherOptions(TypedDict, total=False):
    """Keywords of `Masonry` beside `k_n`, see `JointOptions`."""

    joints: AnyJoints | None
    friction: OfFriction
    xi: OfDamping
    k_s: OfShear
    frequency: OfFrequency
    points: OfPoints
    bond: OfBond
    law: AnyLaw | str | None
    tolerance: float
    gap: float | None
    pairs: AnyPairs


class JointOptions(OtherOptions, total=False):
    """Keywords of `Masonry` that its builders hand on: `joints`, or the properties of joints one by one, and the rest.

    `Masonry` describes them. None takes the usual one.
    """

    k_n: OfStiffness


def one_by_one(options: JointOptions) -> Properties:
    """The keywords with the properties of joints one by one in the place of `joints`."""
    keywords = Properties(options)
    properties = {name: keywords.pop(name, None) for name in PROPERTIES}
    return properties_of(keywords.pop("joints", None), properties) | keywords


def keywords_checked(kind: Class) -> Class:
    """A class whose constructors refuse a keyword that they do not take, with the nearest one that they do."""
    for name, member in list(vars(kind).items()):
        if name == "__init__":
            setattr(kind, name, with_known_keywords(member, kind.__name__))
        elif isinstance(member, classmethod) and not name.startswith("_"):
            setattr(kind, name, classmethod(with_known_keywords(member.__func__, f"{kind.__name__}.{name}")))
    return kind


def with_known_keywords(function: Callable[..., object], label: str) -> Callable[..., object]:
    """A function that checks declared ranges, and refuses a keyword that it does not take with the nearest one that it
    does."""
    parameters = list(inspect.signature(function).parameters.values())[1:]
    known = [parameter.name for parameter in parameters if parameter.kind is not parameter.VAR_KEYWORD]
    if len(known) < len(parameters):
        known += [name for name in JointOptions.__annotations__ if name not in known]

    run = within_ranges(function)

    @wraps(function)
    def called(*arguments: object, **options: object) -> object:
        for unknown in sorted(options.keys() - set(known)):
            near = difflib.get_close_matches(unknown, known, 2)
            remedy = f"did you mean {' or '.join(near)}?" if near else f"the valid keywords are {', '.join(known)}"
            raise TypeError(f"{label} does not take {unknown}; {remedy}")
        return run(*arguments, **options)

    return called
