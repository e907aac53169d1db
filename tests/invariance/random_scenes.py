"""Random scenes by their seeds: walls, and masonry in the plane and in space, with all that can act on it.

`draw` makes the description of a scene, see `tests.invariance.quantities`; `tests.invariance.runs` makes a case of it.
Scenes have 1 to 12 blocks of 0.1 to 10 m and last for one to two times the root of their size over gravity. Most
of them are valid; what is refused by name is counted.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import mjrock as mr

from .quantities import Scene

Rng = np.random.Generator
Outline = np.ndarray
"""Corners x, z of a convex part [m], shape (n, 2)."""
PLACES = ("plane", "space", "wall", "plane", "space")
"""Where scenes are, in turn."""
LENGTH = 0.3
"""Length of blocks of the plane, over the size of the scene [-]. As prisms in space they stand."""
DENSITY = 2000.0
"""Of most blocks [kg/m3]."""
LATER = 100_000
"""Seeds from here on also draw what was added later: slopes, corners, pairs and prestressed ties. Those before keep
their scenes, which tests name."""


def place_of(seed: int) -> str:
    """Where the scene of a seed is: "plane", "space" or "wall"."""
    return PLACES[seed % len(PLACES)]


def draw(seed: int) -> Scene:
    """The scene of a seed."""
    place, later = place_of(seed), seed >= LATER
    rng = np.random.default_rng(seed)
    size = log_uniform(rng, 0.1, 10.0)
    scene: Scene = {"place": place, "seed": seed, "size": size, "solver": "explicit", "timestep": None}
    if place == "wall":
        scene |= wall(rng, size)
        return prestressed(rng, scene) if later else scene
    kinds = KINDS if place == "plane" else KINDS | {"hulls": hulls} | ({"corner": corner} if later else {})
    kind = str(rng.choice(list(kinds)))
    units = kinds[kind](rng, size)
    if place == "space" and kind != "corner":
        units = [in_space(rng, unit, size) for unit in units]
    loose = kind in ("rain", "hulls", "pile")
    if later and rng.random() < 0.25:
        scene["slope"] = rng.uniform(-0.4, 0.4)
        units = [flat | {"parts": [on_a_slope(part, scene["slope"]) for part in flat["parts"]]} for flat in units]
    scene |= {"kind": kind, "units": [finished(rng, i, unit, LENGTH * size) for i, unit in enumerate(units)]}
    scene |= joints(rng, size, loose=loose)
    stands = STANDS.get(kind, 0.0) if scene["friction"] or kind == "stack" else 0.0
    scene |= actions(rng, scene, settled=bool(rng.random() < stands))
    scene["devices"] = devices(rng, scene)
    if later:
        scene |= {"pairs": perhaps(rng, 0.5, pairs(rng, scene))}
        scene = prestressed(rng, scene)
    beyond_the_engine = scene["bond"] or scene["supports"] or any(each["kind"] == "jack" for each in scene["devices"])
    if scene["settled"] and not beyond_the_engine and rng.random() < 0.3:
        scene["solver"] = "MuJoCo"
    return scene


def log_uniform(rng: Rng, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def perhaps(rng: Rng, share: float, value: Any) -> Any:
    """A value, or None."""
    return value if rng.random() < share else None


# one wall


def wall(rng: Rng, size: float) -> Scene:
    """A wall that is released or shaken, with effects, for one of the solvers."""
    height, thickness = size, size / rng.uniform(4, 12)
    alpha, weight = thickness / height, DENSITY * size * thickness * size * mr.GRAVITY
    one_sided = bool(rng.random() < 0.4)
    scene: Scene = {
        "kind": "wall",
        "solver": str(rng.choice(["explicit", "MuJoCo", "theory"])),
        "block": {"thickness": thickness, "height": height, "length": size, "density": DENSITY},
        "k_n": log_uniform(rng, 300, 30000) * DENSITY * mr.GRAVITY,
        "k_side": log_uniform(rng, 300, 30000) * DENSITY * mr.GRAVITY,
        "xi": log_uniform(rng, 0.005, 0.1),
        "stop": perhaps(rng, 0.2, rng.uniform(0.75, 1) * height) if one_sided else None,
        "one_sided": one_sided,
        "theta0": alpha * rng.uniform(0.1, 0.7),
        "duration": 4 * math.sqrt(size / mr.GRAVITY) * rng.uniform(0.5, 1),
    }
    scene["record"] = perhaps(rng, 0.6, record(rng, scene["duration"], (alpha, 0.1)))
    if scene["record"]:
        scene["theta0"] = 0.0
    at = np.array([0.0, rng.uniform(0.4, 1) * height])
    chosen = [
        {"kind": "tie", "stiffness": weight / height * log_uniform(rng, 1, 30)},
        {"kind": "tie", "stiffness": 30 * weight / height, "strength": 0.1 * weight, "slack": 1e-3 * height},
        {"kind": "damper", "damping": 0.1 * weight / math.sqrt(mr.GRAVITY * height)},
        {"kind": "friction damper", "stiffness": 10 * weight / height, "slip_force": 0.02 * weight},
        {"kind": "thrust", "force": np.array([rng.uniform(0, 0.2) * alpha * weight, 0])},
        {"kind": "load", "force": np.array([0, -rng.uniform(0, 0.5) * weight])},
        {"kind": "mass", "mass": rng.uniform(0, 0.3) * weight / mr.GRAVITY},
    ]
    if scene["solver"] == "theory":
        chosen = [device for device in chosen if device["kind"] not in ("damper", "friction damper")]
    kept = rng.permutation(len(chosen))[: rng.integers(3)]
    scene["devices"] = [{"at": at, "reach": np.array([-size, 0]), **chosen[i]} for i in kept]
    return scene


# outlines of masonry: lists of units with their convex parts in the plane


def box(x: float, z: float, width: float, height: float) -> Outline:
    """A rectangle from its lower left corner."""
    return np.array([(x, z), (x + width, z), (x + width, z + height), (x, z + height)])


def unit(*parts: Outline, fixed: bool = False, depth: float = 0.3, y: float = 0.0) -> Scene:
    """A unit of one or more parts. Its depth and the y of its middle are over the size of the scene, for space."""
    return {"parts": list(parts), "fixed": fixed, "depth": depth, "y": y}


def ground(size: float) -> Scene:
    """A slab whose top is z = 0."""
    return unit(box(-4 * size, -0.3 * size, 9 * size, 0.3 * size), fixed=True, depth=9.0)


def stack(rng: Rng, size: float) -> list[Scene]:
    """Blocks one on the other, each shifted a little."""
    units, z, width = [ground(size)], 0.0, size * rng.uniform(0.2, 0.6)
    for _ in range(rng.integers(1, 6)):
        height = size * rng.uniform(0.08, 0.5)
        units.append(unit(box(width * rng.uniform(-0.15, 0.15), z, width, height), y=rng.uniform(-0.03, 0.03)))
        z += height
    return units


def bond(rng: Rng, size: float) -> list[Scene]:
    """A wall in running bond."""
    width, height = 0.3 * size, 0.12 * size
    courses, count = rng.integers(1, 5), rng.integers(2, 4)
    return [ground(size)] + [
        unit(box((i + 0.5 * (course % 2)) * width, course * height, width, height))
        for course in range(courses)
        for i in range(count)
    ]


def arch(rng: Rng, size: float) -> list[Scene]:
    """Voussoirs between two abutments."""
    drawn = mr.Masonry.arch(size, size * rng.uniform(0.12, 0.5), rng.uniform(0.8, math.pi), int(rng.integers(2, 10)))
    return [unit(np.array(block.corners), fixed=block.fixed) for block in drawn.blocks]


def voronoi(rng: Rng, size: float) -> list[Scene]:
    """A wall of irregular stones: the cells of random points."""
    width, seeds = size * rng.uniform(0.4, 1), rng.random((rng.integers(2, 10), 2))
    seeds *= width, size
    units = [ground(size)]
    for i, here in enumerate(seeds):
        cell = box(0, 0, width, size)
        for j, there in enumerate(seeds):
            if i != j:
                cell = cut(cell, there - here, 0.5 * (there - here) @ (there + here))
        units.append(unit(cell))
    return units


def cut(outline: Outline, normal: np.ndarray, offset: float) -> Outline:
    """What of an outline lies below an offset along a normal."""
    beyond, kept = outline @ normal - offset, []
    for i in range(len(outline)):
        j = (i + 1) % len(outline)
        if beyond[i] <= 0:
            kept.append(outline[i])
        if beyond[i] * beyond[j] < 0:
            kept.append(outline[i] + (outline[j] - outline[i]) * beyond[i] / (beyond[i] - beyond[j]))
    return np.array(kept)


def lintel(rng: Rng, size: float) -> list[Scene]:
    """Beams on two fixed piers above the ground."""
    gap, z = size * rng.uniform(0.3, 0.8), 0.3 * size
    units = [ground(size), unit(box(-size, 0, size, z), fixed=True), unit(box(gap, 0, size, z), fixed=True)]
    for _ in range(rng.integers(1, 4)):
        height, over = size * rng.uniform(0.05, 0.2), size * rng.uniform(0.05, 0.2, 2)
        units.append(unit(box(-over[0], z, gap + over.sum(), height)))
        z += height
    return units


def pile(rng: Rng, size: float) -> list[Scene]:
    """Blocks of any width one on the other, which need not stand."""
    units, z = [ground(size), unit(box(0, 0, 0.5 * size, 0.2 * size))], 0.2 * size
    for _ in range(rng.integers(1, 5)):
        height = size * rng.uniform(0.1, 0.3)
        units.append(unit(box(size * rng.uniform(-0.1, 0.3), z, size * rng.uniform(0.2, 0.5), height)))
        z += height
    return units


def compound(rng: Rng, size: float) -> list[Scene]:
    """An L on the ground with blocks that lean on it, and sometimes another L above."""
    thick, long = 0.2 * size, 0.6 * size
    units = [ground(size), unit(box(0, 0, thick, long), box(thick, 0, long, thick))]
    if rng.random() < 0.7:
        units.append(unit(box(thick, thick, long * rng.uniform(0.3, 1), thick)))
    if rng.random() < 0.5:
        units.append(unit(box(-0.5 * thick, long, 2 * thick, thick)))
    if rng.random() < 0.4:
        x, z = size * rng.uniform(0, 1), long + 3 * thick
        units.append(unit(box(x, z, thick, long), box(x + thick, z + long - thick, long, thick)))
    return units


def rain(rng: Rng, size: float) -> list[Scene]:
    """A block on the ground, and polygons and boxes above it that fall, most of them without a joint."""
    units, z = [ground(size), unit(box(0, 0, 0.3 * size, 0.15 * size))], 0.2 * size
    for _ in range(rng.integers(1, 7)):
        across = size * rng.uniform(0.06, 0.3)
        corners = hull(rng.uniform(-0.5, 0.5, (rng.integers(4, 10), 2)) * across)
        if rng.random() < 0.4:
            corners = box(-0.5 * across, -0.2 * across, across, 0.4 * across)
        turn = rng.choice([0.0, rng.uniform(0, 2 * math.pi), 0.5 * math.pi, 0.25 * math.pi])
        corners = corners @ np.array([(math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))])
        z += 0.75 * across
        corners = corners + np.array([size * rng.uniform(-0.3, 0.6), z])
        falling = unit(corners, depth=across / size, y=rng.uniform(-0.3, 0.3))
        units.append(falling | {"turned": bool(rng.random() < 0.5)})
        z += 0.75 * across
    return units


def hulls(rng: Rng, size: float) -> list[Scene]:
    """As rain, of convex hulls of random points on a sphere."""
    units = rain(rng, size)
    for falling in units[2:]:
        points = rng.normal(size=(rng.integers(6, 15), 3))
        falling["hull"] = 0.5 * falling["depth"] * size * points / np.linalg.norm(points, axis=1)[:, None]
    return units


def hull(points: Outline) -> Outline:
    """The convex hull of points, counterclockwise."""

    def half(ordered: list[np.ndarray]) -> list[np.ndarray]:
        kept: list[np.ndarray] = []
        for point in ordered:
            while len(kept) > 1 and np.linalg.det([kept[-1] - kept[-2], point - kept[-2]]) <= 0:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    ordered = sorted(points, key=tuple)
    return np.array(half(ordered) + half(ordered[::-1]))


def corner(rng: Rng, size: float) -> list[Scene]:
    """The corner of two walls with a wedge of either, in space."""
    drawn = mr.Masonry.corner(size * rng.uniform(0.1, 0.3), size, float(rng.choice([0.0, rng.uniform(0.1, 0.6)])))
    return [{"parts": [np.array(p.corners) for p in block.parts], "fixed": block.fixed} for block in drawn.blocks]


def on_a_slope(places: Outline, slope: float) -> Outline:
    """Places in the plane or in space, turned in the plane x, z by an angle [rad]."""
    x, z = places[..., 0], places[..., -1]
    turned = places.copy()
    turned[..., 0] = math.cos(slope) * x + math.sin(slope) * z
    turned[..., -1] = math.cos(slope) * z - math.sin(slope) * x
    return turned


STANDS = {"stack": 0.9, "corner": 0.3, "bond": 0.8, "arch": 0.8, "lintel": 0.9, "voronoi": 0.3, "compound": 0.3}
"""Share of the scenes that start at rest. Others are as drawn: many of them would not stand."""
KINDS = {each.__name__: each for each in (stack, bond, arch, voronoi, lintel, pile, compound, rain)}


def in_space(rng: Rng, flat: Scene, size: float) -> Scene:
    """A unit with its parts in space: prisms, a hull, or a box that is turned anyhow."""
    half, y = 0.5 * flat["depth"] * size, flat["y"] * size
    parts = [np.array([(x, y + end, z) for x, z in part for end in (-half, half)]) for part in flat["parts"]]
    if "hull" in flat:
        parts = [flat["hull"] + parts[0].mean(axis=0)]
    elif flat.get("turned"):
        middle, turn = parts[0].mean(axis=0), np.linalg.qr(rng.normal(size=(3, 3)))[0]
        parts = [(parts[0] - middle) @ turn.T + middle]
    return flat | {"parts": parts}


def finished(rng: Rng, number: int, drawn: Scene, length: float) -> Scene:
    """A unit as a scene has it."""
    return {
        "name": f"{'fixed' if drawn['fixed'] else 'block'}_{number}",
        "parts": [{"corners": part} for part in drawn["parts"]],
        "density": float(rng.choice([DENSITY, rng.uniform(500, 4000)])),
        "length": length,
        "fixed": drawn["fixed"],
    }


# joints and actions


def joints(rng: Rng, size: float, *, loose: bool) -> Scene:
    """The joints and their bond. Joints of blocks that fall are stiffer, so that they hardly sink into each other."""
    k = log_uniform(rng, 3e3 if loose else 300, 3e4) * DENSITY * mr.GRAVITY
    k_s, friction = (
        perhaps(rng, 0.6, k * log_uniform(rng, 0.1, 1)),
        float(rng.choice([0.7, rng.uniform(0.2, 1), 0, 1.5])),
    )
    scene: Scene = {
        "k_n": k,
        "k_s": k_s,
        "friction": friction,
        "xi": float(rng.choice([0, 0.01, 0.05, 0.05, 0.2, 1.0])),
        "frequency": perhaps(rng, 0.3, math.sqrt(k / DENSITY / size) * rng.uniform(0.1, 1)),
        "points": int(rng.choice([2, 2, 3, 4])),
        "tolerance": 2e-6 * size,
        "bond": None,
    }
    if k_s and not loose and rng.random() < 0.4:
        scene["bond"] = mortar(rng, size, k, friction)
        scene["points"] = int(rng.choice([3, 5]))
    return scene


def pairs(rng: Rng, scene: Scene) -> Scene:
    """Friction and damping of blocks that have no joint, where they meet."""
    lowest = math.sqrt(scene["k_n"] / DENSITY / scene["size"])
    return {
        "friction": float(rng.choice([0.0, rng.uniform(0.1, 1.2)])),
        "xi": float(rng.choice([0.0, 0.05, 0.3, 1.0])),
        "frequency": lowest * rng.uniform(0.1, 1),
    }


def prestressed(rng: Rng, scene: Scene) -> Scene:
    """A scene, half of whose ties have a prestress in the place of a slack."""
    made = []
    for device in scene["devices"]:
        if device["kind"] == "tie" and rng.random() < 0.5:
            strength = device.get("strength") or 0.1 * device["stiffness"] * scene["size"]
            device = device | {"slack": None, "prestress": strength * rng.uniform(0.05, 0.8)}
        made.append(device)
    return scene | {"devices": made}


def mortar(rng: Rng, size: float, k: float, friction: float) -> Scene:
    """A bond that breaks in some scenes and holds in others."""
    strength = DENSITY * mr.GRAVITY * size * log_uniform(rng, 0.3, 300)
    bond: Scene = {
        "tension": strength,
        "cohesion": strength * rng.uniform(0.5, 2),
        "opening_energy": strength**2 / k * log_uniform(rng, 0.7, 30),
        "slip_energy": strength**2 / k * log_uniform(rng, 1, 60),
        "residual_friction": perhaps(rng, 0.3, friction * rng.uniform(0.3, 1)),
    }
    if rng.random() < 0.4:
        crushing = strength * rng.uniform(5, 20)
        bond |= {"crushing": crushing, "crushing_energy": crushing**2 / k * log_uniform(rng, 2, 50)}
        bond["hardening"] = perhaps(rng, 0.5, min(0.2 * bond["crushing_energy"] / crushing, 0.02))
    return bond


def record(rng: Rng, duration: float, peaks: tuple[float, ...]) -> Scene:
    """A ground motion with peaks over gravity, along each axis, that starts and ends with zero.

    Its samples are at most half of what a `GroundMotion` takes apart, so that one twice as slow is taken too."""
    count = int(rng.integers(5, 60))
    accel = rng.normal(size=(count, len(peaks))) * peaks * mr.GRAVITY
    accel[[0, -1]] = 0
    accel[:, rng.random(len(peaks)) < 0.3] = 0
    return {"dt": min(duration / count, 0.5), "acceleration": accel}


def actions(rng: Rng, scene: Scene, *, settled: bool) -> Scene:
    """How long a scene lasts, and what moves it."""
    size, d = scene["size"], 2 if scene["place"] == "plane" else 3
    time, speed = math.sqrt(size / mr.GRAVITY), math.sqrt(size * mr.GRAVITY)
    made: Scene = {"duration": time * rng.uniform(0.6, 2), "settled": settled}
    strength = float(rng.choice([0.05, 0.2, 0.5]))
    made["record"] = perhaps(rng, 0.5, record(rng, made["duration"], (strength,) * d))
    still = made["record"] is None
    ends = np.array([0.0, made["duration"]])
    made["tilt"] = perhaps(rng, 0.35 if still else 0, {"t": ends, "angle": np.array([0.0, rng.uniform(-0.8, 0.8)])})
    free = sum(not unit["fixed"] for unit in scene["units"])
    strength = float(rng.choice([0.1, 0.5]))
    kick = {
        "velocity": strength * speed * rng.normal(size=(free, d)),
        "spin": strength * speed / size * rng.normal(size=(free, 1 if d == 2 else 3)),
    }
    made["kick"] = perhaps(rng, 0.4, kick)
    t = np.array([0.0, 0.3, 0.6, 1.0]) * made["duration"]
    way = np.concatenate([np.zeros((1, d)), 0.05 * size * rng.normal(size=(3, d))])
    names = [unit["name"] for unit in scene["units"] if unit["fixed"]]
    made["supports"] = {str(rng.choice(names)): {"t": t, "displacement": way}} if rng.random() < 0.3 else {}
    return made


def to_another(rng: Rng, scene: Scene, device: Scene) -> Scene:
    """Where a device ends that is fixed to another block."""
    other = scene["units"][rng.integers(len(scene["units"]))]
    reach = other["parts"][0]["corners"].mean(axis=0) - device["at"]
    return {} if other["name"] == device["block"] else {"reach": reach, "to": other["name"]}


def devices(rng: Rng, scene: Scene) -> list[Scene]:
    """At most two devices, of which one may be a jack."""
    size, d = scene["size"], 2 if scene["place"] == "plane" else 3
    free = [unit for unit in scene["units"] if not unit["fixed"]]
    made: list[Scene] = []
    for _ in range(rng.choice([0, 0, 1, 1, 2])):
        held = free[rng.integers(len(free))]
        corners = held["parts"][0]["corners"]
        weight = (
            held["density"] * mr.GRAVITY * float(np.prod(np.ptp(corners, axis=0))) * (held["length"] if d == 2 else 1)
        )
        stiffness, time = weight / size * log_uniform(rng, 3, 300), math.sqrt(size / mr.GRAVITY)
        way = np.eye(d)[0] if d == 2 or rng.random() < 0.5 else np.eye(d)[1]
        push = rng.normal(size=d) * np.append(np.ones(d - 1), 0.2)
        chosen = [
            {
                "kind": "tie",
                "stiffness": stiffness,
                "strength": weight * log_uniform(rng, 0.1, 3),
                "ultimate": perhaps(rng, 0.5, 0.01 * size),
                "slack": perhaps(rng, 0.3, 1e-3 * size),
            },
            {"kind": "damper", "damping": weight * time / size * log_uniform(rng, 0.01, 1)},
            {
                "kind": "friction damper",
                "stiffness": stiffness,
                "slip_force": weight * log_uniform(rng, 0.03, 1),
            },
            {"kind": "thrust", "force": weight * rng.uniform(-0.1, 0.1) * way},
            {"kind": "load", "force": -weight * rng.uniform(0, 1) * np.eye(d)[-1]},
            {"kind": "mass", "mass": weight / mr.GRAVITY * rng.uniform(0, 0.5)},
            {
                "kind": "jack",
                "direction": push / np.linalg.norm(push),
                "t": np.array([0.0, 0.4, 1.0]) * scene["duration"],
                "stroke": np.array([0.0, *(0.05 * size * rng.normal(size=2))]),
                "stiffness": 10 * stiffness,
                "damping": 0.5 * math.sqrt(10 * stiffness * weight / mr.GRAVITY),
                "guided": perhaps(rng, 0.5, str(rng.choice(["upright", "translation"]))),
            },
        ]
        device = chosen[rng.choice(7, p=[0.15, 0.15, 0.15, 0.1, 0.1, 0.1, 0.25])]
        if device["kind"] == "jack":
            if any(other["kind"] == "jack" for other in made):
                continue
            if device["guided"] == "translation":
                device["direction"] = np.sign(push[0]) * np.eye(d)[0]
            if device["guided"]:
                scene["kick"] = None
        device = {"block": held["name"], "at": corners.mean(axis=0), "reach": -size * way} | device
        if d == 3 and rng.random() < 0.3:
            made.append(device | to_another(rng, scene, device))
        else:
            made.append(device)
    return made
