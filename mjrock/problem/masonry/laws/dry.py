"""Joints as objects, dry ones and ones with mortar, and what pairs of blocks without a joint have."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from numbers import Real
from typing import Annotated, Any, NamedTuple

from ....quantities import Within, keep_declared, require_kind, shown
from .bond import Bond
from .joint_law import INTENSIVE
from .own_law import Own, OwnLaw

Properties = dict[str, Any]
"""What a joint has, by the keywords of `Masonry`."""


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
        points: contact lines, 2 to 1000, in space 2 to 50, see `Masonry`.
        law: a law of your own for its stress, see `joint_law`, for `solve_explicit`. None is the spring of k_n. With a
            law k_n is the stiffness to which xi refers, and that of contacts that are found where blocks have left
            their joints.

    Raises:
        TypeError, ValueError: for what is not a number, or lies outside its range; for a law that is none.

    Examples:
        >>> mr.Masonry.arch(radius=5.0, thickness=0.9, joints=mr.Dry(k_n=1e9, friction=0.6)).k_n
        1000000000.0
    """

    k_n: Annotated[float, Within(1e4, 1e14, "N/m3")] = 1e10
    friction: Annotated[float, Within(0, 10)] = 0.7
    xi: Annotated[float, Within(0, 100)] = 0.05
    k_s: Annotated[float | None, Within(1e4, 1e16, "N/m3")] = None
    frequency: Annotated[float | None, Within(1e-3, 1e9, "rad/s")] = None
    points: Annotated[int, Within(2, 1000, whole=True)] = 2
    law: OwnLaw | None = None

    def __repr__(self) -> str:
        values = {name: value for name, value in vars(self).items() if value is not None}
        parts = {name: format(value, "g") if isinstance(value, Real) else repr(value) for name, value in values.items()}
        return f"Dry({', '.join(f'{name}={value}' for name, value in parts.items())})"

    def __post_init__(self) -> None:
        keep_declared(self)
        if self.law is not None:
            if not isinstance(self.law, OwnLaw):
                raise TypeError(
                    f"law = {shown(self.law)} is no object of a class under mr.joint_law, such as Law(a=1.0)"
                )
            require_plain(self, f"law = {self.law!r}")
            k_s = math.inf if self.k_s is None else self.k_s
            Own(self.law, self.k_n, self.friction).require_fit("the joint", self.k_n, k_s, self.friction, self.points)

    @property
    def further(self) -> dict[str, float]:
        """Numbers of its law for which masonry has no keyword, by name."""
        return {name: getattr(self, name) for name in INTENSIVE if name not in KEYWORDS}

    @property
    def properties(self) -> Properties:
        """The keywords of `Masonry` that stand for it. In the place of a bond stands its law, or the joint itself if it
        has numbers that no keyword has."""
        beside = self if self.further != NONE_FURTHER else self.law
        return {"bond": beside, **{name: getattr(self, name) for name in KEYWORDS}}


KEYWORDS = ("k_n", "friction", "xi", "k_s", "frequency", "points")
"""Numbers of a joint that are keywords of masonry too."""
NONE_FURTHER = Dry().further
"""Its other numbers where they are not given."""


def require_plain(dry: Dry, beside: str) -> None:
    """Raise a ValueError for a joint with further numbers, which what it has beside them does not know."""
    for name, value in dry.further.items():
        if value != NONE_FURTHER[name]:
            raise ValueError(f"{name} = {value:g} is given with {beside}, which does not know it; give one of both")


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
        if dry.law is not None:
            raise ValueError(f"bond = {self.bond!r} on a joint whose law is {dry.law!r}: give one of both")
        require_plain(dry, f"bond = {self.bond!r}")
        self.bond.require_fit("the joint", dry.k_n, math.inf if dry.k_s is None else dry.k_s, dry.friction, dry.points)

    @property
    def properties(self) -> Properties:
        """The keywords of `Masonry` that stand for it."""
        return {**self.dry.properties, "bond": self.bond}


OfPair = Callable[[str, str], Dry | None]
"""A function of the names of two blocks, in their order, that gives what they have where they meet, or None."""
AnyPairs = Dry | OfPair | None
"""What all pairs of blocks without a joint have, a function of two blocks, or None."""
RUBBING = ("friction", "xi", "frequency")
"""Fields of a `Dry` that count for a pair. Its springs follow from the joints of its blocks."""


class PairProperties(NamedTuple):
    """What two blocks have where they meet: friction [-], and dashpot over spring, c/k [s]."""

    friction: float
    retardation: float


def required_pairs(pairs: AnyPairs) -> AnyPairs:
    """What pairs have, checked where it is one for all.

    Raises:
        TypeError, ValueError: for another kind, or springs.
    """
    return pairs if callable(pairs) else _rubbing("pairs", pairs)


def requested_pair(pairs: AnyPairs, one: str, other: str) -> Dry | None:
    """What is given for two blocks by their names, or None.

    Raises:
        TypeError, ValueError: with their names, for another kind, or springs.
    """
    if not callable(pairs):
        return pairs
    try:
        requested = pairs(one, other)
    except TypeError as error:
        raise TypeError(f"pairs = {shown(pairs)} is not called as pairs(one, other): {error}") from None
    return _rubbing(f"pairs of {one} and {other}", requested)


def _rubbing(name: str, dry: Dry | None) -> Dry | None:
    """A joint of which friction and damping alone are given, or None."""
    require_kind(name, dry, Dry, type(None))
    if dry is not None:
        others = [
            item.name for item in fields(dry) if item.name not in RUBBING and getattr(dry, item.name) != item.default
        ]
        if others:
            raise ValueError(
                f"{name} has {', '.join(others)}; {', '.join(RUBBING)} are taken: the springs of two blocks without a "
                "joint follow from those of their own joints"
            )
    return dry
