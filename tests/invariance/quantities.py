"""What the values of a random scene are, by name: how they scale, turn and move.

A random scene is a tree of dicts and lists with a value at each leaf. The name of a leaf says what it is, wherever it
stands in the tree. So a scene is scaled, turned or moved by one function each, which know no kind of scene.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

Scene = dict[str, Any]


class Quantity(NamedTuple):
    """The powers of length, time and mass in the unit of a value, and how it turns.

    A "point" turns and moves, a "vector" turns, a "spin" is a rotation about axes, or in the plane about the axis
    across it, and a "number" does neither.
    """

    length: float
    time: float
    mass: float
    turns: str = "number"


QUANTITIES = {
    "size": Quantity(1, 0, 0),
    "corners": Quantity(1, 0, 0, "point"),
    "density": Quantity(-3, 0, 1),
    "length": Quantity(1, 0, 0),
    **dict.fromkeys(("k_n", "k_s", "k_side"), Quantity(-2, -2, 1)),
    "frequency": Quantity(0, -1, 0),
    "tolerance": Quantity(1, 0, 0),
    **dict.fromkeys(("tension", "cohesion", "crushing"), Quantity(-1, -2, 1)),
    **dict.fromkeys(("opening_energy", "slip_energy", "crushing_energy"), Quantity(0, -2, 1)),
    **dict.fromkeys(("hardening", "softness"), Quantity(1, 0, 0)),
    **dict.fromkeys(("duration", "dt", "t"), Quantity(0, 1, 0)),
    "acceleration": Quantity(1, -2, 0, "vector"),
    **dict.fromkeys(("angle", "slope"), Quantity(0, 0, 0, "spin in the plane")),
    "velocity": Quantity(1, -1, 0, "vector"),
    "spin": Quantity(0, -1, 0, "spin"),
    "displacement": Quantity(1, 0, 0, "vector"),
    "at": Quantity(1, 0, 0, "point"),
    "reach": Quantity(1, 0, 0, "vector"),
    "direction": Quantity(0, 0, 0, "vector"),
    "stroke": Quantity(1, 0, 0),
    "stiffness": Quantity(0, -2, 1),
    "damping": Quantity(0, -1, 1),
    **dict.fromkeys(("strength", "slip_force", "prestress"), Quantity(1, -2, 1)),
    "force": Quantity(1, -2, 1, "vector"),
    "slack": Quantity(1, 0, 0),
    "ultimate": Quantity(1, 0, 0),
    "mass": Quantity(0, 0, 1),
    **dict.fromkeys(("thickness", "height", "stop"), Quantity(1, 0, 0)),
    "theta0": Quantity(0, 0, 0, "spin in the plane"),
}
"""By the name of a leaf. Leaves that are not here, such as a coefficient of friction or a name, stay as they are."""


def changed(tree: Any, change: Callable[[str, Any], Any], name: str = "") -> Any:
    """A copy of a tree with each leaf changed by its name and its value; a leaf of None stays None."""
    if isinstance(tree, dict):
        return {key: changed(value, change, key) for key, value in tree.items()}
    if isinstance(tree, list):
        return [changed(value, change, name) for value in tree]
    return None if tree is None else change(name, tree)


def scaled(scene: Scene, length: float, density: float) -> Scene:
    """Lengths and densities multiplied, and all else so that gravity stays: times by the root of the length."""
    time, mass = np.sqrt(length), density * length**3

    def change(name: str, value: Any) -> Any:
        unit = QUANTITIES.get(name)
        return value if unit is None else value * (length**unit.length * time**unit.time * mass**unit.mass)

    return changed(scene, change)


def turned(scene: Scene, matrix: np.ndarray) -> Scene:
    """Turned or mirrored by an orthogonal matrix, of shape (2, 2) in the plane x, z and (3, 3) in space."""
    about = round(float(np.linalg.det(matrix)))

    def change(name: str, value: Any) -> Any:
        match QUANTITIES.get(name, Quantity(0, 0, 0)).turns:
            case "point" | "vector":
                return value @ matrix.T
            case "spin":
                return about * (value @ matrix.T if len(matrix) == 3 else value)
            case "spin in the plane":
                return about * value
        return value

    return changed(scene, change)


def moved(scene: Scene, by: np.ndarray) -> Scene:
    """Moved by a vector [m]."""
    points = {name for name, quantity in QUANTITIES.items() if quantity.turns == "point"}
    return changed(scene, lambda name, value: value + by if name in points else value)
