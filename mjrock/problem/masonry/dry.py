"""Joints as objects: dry ones, and ones with mortar."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from ...quantities import keep, require_kind
from .bond import Bond
from .of_joint import AnyJoint, FunctionOfJoint, asked, required_number


@dataclass(frozen=True, repr=False)
class Dry:
    """A dry joint: it presses and rubs, and never pulls.

    A contact line of the joint is a spring and a dashpot along the normal, and Coulomb friction along the face.

    Args:
        k_n: normal stiffness [N/m3], 1e4 to 1e14. `joint_stiffness` and `layered_stiffness` compute it from moduli.
        friction: coefficient of friction [-], 0 to 10.
        xi: damping ratio [-], 0 to 100. The dashpot of a line is c = (2 xi / omega) k, the stiffness-proportional
            damping of distinct-element codes.
        k_s: shear stiffness [N/m3], 1e4 to 1e16, for `solve_explicit`. None lets the joint stick rigidly, up to its
            friction, as joints always do in MuJoCo.
        frequency: omega [rad/s], 1e-3 to 1e9; None takes the lowest natural frequency of the masonry, see `Masonry`.
        points: contact lines, 2 to 1000, in space 2 to 50, see `Masonry`. All joints of masonry have as many.

    Raises:
        TypeError, ValueError: for what is not a number, or lies outside its range.

    Examples:
        >>> mr.Masonry.arch(radius=5.0, thickness=0.9, joints=mr.Dry(k_n=1e9, friction=0.6)).k_n
        1000000000.0
    """

    k_n: float = 1e10
    friction: float = 0.7
    xi: float = 0.05
    k_s: float | None = None
    frequency: float | None = None
    points: int = 2

    def __repr__(self) -> str:
        numbers = ((each.name, getattr(self, each.name)) for each in fields(self))
        return f"Dry({', '.join(f'{name}={value:g}' for name, value in numbers if value is not None)})"

    def __post_init__(self) -> None:
        keep(self, **{each.name: required_number(each.name, getattr(self, each.name)) for each in fields(self)})

    @property
    def properties(self) -> dict[str, Any]:
        """The keywords of `Masonry` that stand for it."""
        return {**vars(self), "bond": None}


@dataclass(frozen=True, repr=False)
class Mortar:
    """A mortared joint: a dry one with a bond, which pulls and holds along the face until it breaks.

    Args:
        dry: the joint without its bond, with `k_s` and three `points` or more. Five or more follow a crack.
        bond: what the mortar holds, see `Bond`. The named ones of `BONDS` have their sources.

    Raises:
        TypeError, ValueError: for another kind, or a bond that the springs of the joint cannot have: of two lines,
            without k_s, with a residual friction above that of the joint, or whose crushing softens faster than the
            joint springs back.

    Examples:
        >>> bed = mr.Dry(k_n=2.5e9, friction=0.75, k_s=2.5e9, points=5)
        >>> mr.Mortar(bed, mr.Bond(tension=0.2e6, cohesion=0.3e6, opening_energy=13.0, slip_energy=130.0))
        Mortar(Dry(k_n=2.5e+09, friction=0.75, xi=0.05, k_s=2.5e+09, points=5), Bond(tension=200000, cohesion=300000))
    """

    dry: Dry
    bond: Bond

    def __repr__(self) -> str:
        return f"Mortar({self.dry!r}, Bond(tension={self.bond.tension:g}, cohesion={self.bond.cohesion:g}))"

    def __post_init__(self) -> None:
        require_kind("dry", self.dry, Dry)
        require_kind("bond", self.bond, Bond)
        dry = self.dry
        self.bond.require_fit("the joint", dry.k_n, math.inf if dry.k_s is None else dry.k_s, dry.friction, dry.points)

    @property
    def properties(self) -> dict[str, Any]:
        """The keywords of `Masonry` that stand for it."""
        return {**self.dry.properties, "bond": self.bond}


PROPERTIES = tuple(Dry().properties)
"""Names of what a joint has, which are keywords of `Masonry` too."""
AnyJoints = Dry | Mortar | FunctionOfJoint[Dry | Mortar]
"""What all joints of masonry are, or a function of the joint that says what it is."""


@dataclass(frozen=True)
class Choice:
    """A function of the joint that gives what it is, which is asked once of each joint."""

    function: FunctionOfJoint[Dry | Mortar]
    known: dict[AnyJoint, dict[str, Any]] = field(default_factory=dict, compare=False, repr=False)

    def __call__(self, joint: AnyJoint) -> dict[str, Any]:
        """The properties of a joint by name."""
        if joint not in self.known:
            chosen = asked("joints", self.function, joint)
            require_kind(f"joints of {joint.name}", chosen, Dry, Mortar)
            self.known[joint] = chosen.properties
        return self.known[joint]


@dataclass(frozen=True)
class Chosen:
    """One property of what a function of the joint gives."""

    choice: Choice
    name: str

    def __call__(self, joint: AnyJoint) -> Any:
        """The value of a joint."""
        return self.choice(joint)[self.name]


def properties_of(joints: AnyJoints | None, given: Mapping[str, Any]) -> dict[str, Any]:
    """The properties of joints by name, a number or a function of the joint each.

    Args:
        joints: what all joints are, or a function of the joint that gives it, or None.
        given: the properties that are given by keyword instead; None takes that of a `Dry`.

    Raises:
        TypeError: for another kind.
        ValueError: where both are given.
    """
    named = {name: value for name, value in given.items() if value is not None}
    if joints is None:
        usual = Dry().properties
        checked = {n: v if callable(v) or n == "bond" else required_number(n, v) for n, v in named.items()}
        return usual | checked
    if named:
        raise ValueError(f"joints is given with {', '.join(named)}, which it says itself; give one or the other")
    if callable(joints):
        choice = Choice(joints)
        return {name: Chosen(choice, name) for name in PROPERTIES}
    require_kind("joints", joints, Dry, Mortar)
    return joints.properties
