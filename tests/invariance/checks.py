"""What holds of every answer to a random scene, whatever it is."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import mjrock as mr
from mjrock.geometry.poses import rotations
from mjrock.problem.masonry.effects import with_added_masses

from .balance import is_stepwise, unbalanced, unbalanced_bodies
from .quantities import Scene
from .random_scenes import DENSITY, on_a_slope

UNBALANCED = 1e-6
"""Largest force that is missing in the balance of all bodies in a step, over their weight and the largest reaction [-].
Explicit steps balance to rounding, of which second differences of the poses keep some 1e-8."""
OVERLAP = 0.01
"""Largest share of a block that lies inside another without a warning [-]."""
UNPAID = 0.01
"""Largest residual of the ledger over its largest part without a warning [-], as `solve_explicit` warns."""
GIVES_BACK = "gives back"
GIVEN_BACK = 5e-3
"""Most that an account which can only take gives back, over the largest part of the ledger [-]."""
BELOW = 0.25
"""How far a corner may lie below the ground, over the size of its block [-], where no overlap is warned of."""


def complaints(scene: Scene, answer: mr.Response, warned: list[str]) -> Iterator[str]:
    """What is wrong with an answer that has its ledger, its forces and a sample of every step.

    Args:
        scene: what was asked.
        answer: the answer.
        warned: the warnings of the run.
    """
    if not finite(answer):
        yield "not finite"
        return
    overlapping = any("lie inside each other" in text for text in warned)
    if answer.stats.get("overlap", 0.0) > OVERLAP + pressed(scene) and not overlapping:
        yield f"overlap without a warning: {answer.stats['overlap']:.1%}"
    if answer.ledger is not None:
        yield from complaints_of_ledger(answer.ledger, warned)
    meets = scene["solver"] == "explicit" and scene["place"] != "wall"  # in MuJoCo blocks meet only at joints of rest
    if meets and not overlapping and (depth := below_the_ground(scene, answer)) > BELOW:
        yield f"below the ground: {depth:.1%} of a block"
    if scene["solver"] == "explicit" and is_stepwise(answer):
        if (missing := unbalanced(answer)) > UNBALANCED:
            yield f"out of balance: {missing:.1e} of the weight"
        alone = scene["place"] != "wall" and answer.stats["overlap"] == 0
        if alone and (missing := unbalanced_bodies(answer)) > UNBALANCED:
            yield f"a body is out of balance: {missing:.1e} of the weight"


def pressed(scene: Scene) -> float:
    """Share of the smallest block by which twice the weight of a column as high as the scene closes its joint [-]."""
    if scene["place"] == "wall":
        return 0.0
    smallest = min(float(np.ptp(part["corners"], axis=0).min()) for unit in scene["units"] for part in unit["parts"])
    return 2 * DENSITY * mr.GRAVITY * scene["size"] / scene["k_n"] / smallest


def finite(answer: mr.Response) -> bool:
    """Whether all numbers of an answer are finite."""
    rows = [answer.t, answer.pose, answer.velocity, answer.energy]
    if answer.ledger is not None:
        rows += answer.ledger.columns().values()
    if answer.kept_forces is not None:
        rows += answer.reactions.values()
    return all(bool(np.isfinite(row).all()) for row in rows)


def complaints_of_ledger(ledger: mr.Ledger, warned: list[str]) -> Iterator[str]:
    """A residual without a warning, and accounts that give back what they took."""
    scale = max(ledger.largest, 1e-300)
    unpaid = float(np.abs(ledger.residual).max()) / scale
    if unpaid > UNPAID and not any("ledger" in text or "energy" in text for text in warned):
        yield f"ledger open without a warning: {unpaid:.1%}"
    takes = {name: account for name, account in ledger.taken.items() if not name.startswith("ends of faces")}
    for name, account in takes.items():
        back = float((np.maximum.accumulate(account) - account).max()) / scale
        if back > GIVEN_BACK:
            yield f"{name} {GIVES_BACK} {back:.1%}"


def below_the_ground(scene: Scene, answer: mr.Response) -> float:
    """How far a corner lies below a slab of ground that its block is above, over the size of its block [-]."""
    masonry, d = answer.case.masonry, 3 if answer.in_space else 2
    slabs = [unit for unit in scene["units"] if unit["fixed"] and unit["name"] == "fixed_0"]
    if scene["kind"] in ("arch", "corner") or not slabs:
        return 0.0
    level = -scene.get("slope", 0.0)
    corners = on_a_slope(slabs[0]["parts"][0]["corners"], level)
    shift = np.zeros((len(answer.t), d))
    for support in answer.case.supports:
        if support.block == "fixed_0":
            shift = support.at(answer.t)
    low, high = corners.min(axis=0), corners.max(axis=0)
    turned, most = rotations(answer.pose), 0.0
    rest = with_added_masses(masonry, answer.case.effects).centroid
    for i, number in enumerate(masonry.free):
        block, middle = masonry.blocks[number], rest[number] + answer.pose[:, i, :d] - shift
        placed = on_a_slope(middle[:, None] + (block.corners - rest[number]) @ turned[:, i].swapaxes(1, 2), level)
        above = ((placed[..., :-1] > low[:-1]) & (placed[..., :-1] < high[:-1])).all(axis=(1, 2))
        depth = high[-1] - placed[..., -1].min(axis=1)
        most = max(most, float(np.where(above, depth, 0.0).max()) / block.size)
    return most
