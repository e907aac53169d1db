"""Limit analysis of random scenes in the poses that their runs end in: mirrored, moved, larger, denser, renumbered."""

import warnings
from copy import deepcopy

import numpy as np
import pytest

import mjrock as mr
from tests.invariance.quantities import changed, moved, scaled, turned
from tests.invariance.random_scenes import LATER, draw
from tests.invariance.runs import masonry_of, solve

LARGER, AWAY = 4.0, 100.0
"""Factor of lengths, and how far a scene is moved, over its size [-]."""
MIRROR = np.diag([-1.0, 1.0])


def multiplier(scene, pose, way):
    """The multiplier along x in a pose, or None where it is refused."""
    try:
        return mr.collapse_multiplier(masonry_of(scene), way, pose=pose).multiplier
    except ValueError:
        return None


def same(scene, pose):
    """The scene and its pose as they are, and what must have the same multiplier: scene, pose and direction."""
    order = np.random.default_rng(scene["seed"]).permutation(len(scene["units"]))
    free = [i for i in order if not scene["units"][i]["fixed"]]
    row = {i: number for number, i in enumerate(sorted(free))}
    renumbered = deepcopy(scene) | {"units": [scene["units"][i] for i in order]}
    longer = changed(scene, lambda name, value: 3 * value if name == "length" else value)
    yield "mirrored", turned(scene, MIRROR), pose * [-1, 1, -1], -1
    yield "elsewhere", moved(scene, AWAY * scene["size"] * np.eye(2)[0]), pose, 1
    yield "larger", scaled(scene, LARGER, 1.0), pose * [LARGER, LARGER, 1], 1
    yield "heavier", scaled(scene, 1.0, 2.0), pose, 1
    yield "longer", longer, pose, 1
    yield "renumbered", renumbered, pose[[row[i] for i in free]], 1


def compared(seed):
    """What differs in the scene of a seed, in words, and whether there was anything to compare."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        scene = draw(seed) | {"bond": None}
        try:
            pose = solve(scene, output_step=scene["duration"]).pose[-1]
        except (ValueError, RuntimeError):
            return [], False
        there = multiplier(scene, pose, 1)
        found = {name: multiplier(twin, moved_so, way) for name, twin, moved_so, way in same(scene, pose)}
    unlike = {name: x for name, x in found.items() if (x is None) != (there is None)}
    if there is not None:
        unlike |= {n: x for n, x in found.items() if x is not None and abs(x - there) > 1e-6 * (1 + abs(there))}
    return [f"{seed} {scene['kind']}: {there} {unlike}"] if unlike else [], there is not None


@pytest.mark.parametrize("seed", [10, 80, 180])
def test_the_multiplier_in_a_pose_is_that_of_its_twins(seed):
    assert compared(seed) == ([], True)


@pytest.mark.slow
def test_the_multiplier_in_many_poses():
    found = [compared(seed) for seed in (*range(0, 200, 5), *range(LATER, LATER + 100, 5))]
    assert [message for unlike, _ in found for message in unlike] == []
    assert sum(tried for _, tried in found) > 10
