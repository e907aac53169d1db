"""Overlap: the share of a block that lies inside another, which the energy ledger does not show."""

from __future__ import annotations

import heapq

import numpy as np

from ...geometry.convex import kept_of
from ...geometry.hull import area_vector
from ...problem.masonry.case import AnyCase
from ...quantities import Array, percent_text, warn_of
from ..rotation import set_rotations
from ..setup import Setup
from ..system import System
from .constants import (
    DEEPEST_PAIRS,
    FLUSH,
    OF_STABLE_STEP,
    OVERLAP_SAMPLES,
    OVERLAP_WARNED_OF,
    SOFTENED_WARNED_OF,
)
from .contact_search import ContactSearch
from .pair_law import pair_number
from .softening import unsoftened
from .solids import Poses, Solids


def checked_overlap(setup: Setup, case: AnyCase, pose: Array, t: Array, h: float) -> float:
    """The largest share of a block that lies inside another at samples of a run [-], at most 200 of them.

    All pairs are searched, whether their joint is intact or not. Where no block has come near another one that it has
    no intact joint with, nothing is searched, and the answer is zero.

    Args:
        setup: of the run.
        case: its case.
        pose: at the samples, shape (samples, n, nq).
        t: times of the samples [s], shape (samples,).
        h: length of a step [s].

    Warns:
        UserWarning: of 1 % more than at the start, with the names of the two blocks, when, and what keeps them apart;
            or of contacts that dashpots have softened, see `softened`.
    """
    search = setup.search
    if search is None or not search.state.validity.searched.any():
        return 0.0
    chosen = np.unique(np.linspace(0, len(t) - 1, min(OVERLAP_SAMPLES, len(t))).round().astype(int))
    poses = {i: _poses_at(search, setup.system, pose[i], float(t[i]), case) for i in chosen.tolist()}
    every, deepest = np.ones(search.count, dtype=bool), set[tuple[float, int, int, int]]()
    for i, block_poses in poses.items():
        places = search.finder.places_near(block_poses, np.zeros(search.count), every, np.zeros(0, dtype=np.int64))
        pairs, pair_of_place = np.unique(pair_number(places.face, places.other, search.count), return_inverse=True)
        blocks = np.array(np.divmod(pairs, search.count))
        deep = np.bincount(pair_of_place, weights=places.share * np.maximum(-places.gap, 0.0))
        depth = deep / search.sizes[blocks].min(axis=0)
        new = {
            (float(depth[j]), i, *map(int, blocks[:, j])) for j in np.argsort(-depth)[:DEEPEST_PAIRS] if depth[j] > 0
        }
        deepest = set(heapq.nlargest(DEEPEST_PAIRS, deepest | new)) | {pair for pair in deepest | new if pair[1] == 0}
    worst, at_start, message, finder = 0.0, 0.0, "", search.finder
    posed = {i: finder.posed(poses[i]) for i in {pair[1] for pair in deepest}}
    for _, i, a, b in deepest:
        ours, theirs = finder.parts_of(a), finder.parts_of(b)
        common = sum(common_volume(posed[i], part, other_part) for part in ours for other_part in theirs)
        share = common / float(finder.volumes[[a, b]].min())
        at_start = max(at_start, share if i == 0 else 0.0)
        if share > worst:
            names = case.blocks
            worst, message = share, f"{names[a]} and {names[b]} lie inside each other by {share:.1%} of the smaller one"
            share_left = float(search.state.least_share[[a, b]].max())
            shorter = OF_STABLE_STEP * unsoftened(share_left, h / OF_STABLE_STEP, search.law.slowest)
            message += f" at {t[i]:.4g} s: {overlap_remedy(share, share_left, shorter)}"
    message = message if worst > OVERLAP_WARNED_OF + at_start else softened(search, case, h)
    if message:
        warn_of(message)
    return worst


def softened(search: ContactSearch, case: AnyCase, h: float) -> str:
    """The warning of contacts that dashpots have made softer than a step of h [s] makes their springs; empty where they
    have at least a quarter of that left."""
    shares, step, slow = search.state.least_share[search.blocks.free], h / OF_STABLE_STEP, search.law.slowest
    block, left = int(search.blocks.free[shares.argmin()]), float(shares.min())
    if left >= SOFTENED_WARNED_OF * min(1.0, left * (1 + 2 * slow / step)):
        return ""
    return (
        f"dashpots, c/k = {slow:.2g} s, are too strong for a step of {h:.2g} s: contacts of {case.blocks[block]} have "
        f"{left:.0%} of their stiffness and damping left, and blocks lie {1 / left:.2g} times as deep on each other; "
        f"take timestep = {OF_STABLE_STEP * unsoftened(left, step, slow):.2g} s, or lower xi"
    )


def overlap_remedy(share: float, left: float, shorter: float) -> str:
    """The remedy, in words, that reduces the overlap of a block to the share from which on there is a warning.

    It falls at least as the root of the stiffness, of which the step has left a part, and a shorter one [s] leaves all.
    """
    stiffer = left * (share / OVERLAP_WARNED_OF) ** 2
    joints = f"joints {stiffer:.2g} times as stiff"
    if left == 1:
        return f"{joints} keep blocks apart"
    message = f"this step leaves their contact {percent_text(left)} of its stiffness; timestep = {shorter:.2g} s"
    return f"{message} and {joints} keep blocks apart" if stiffer > 1 else f"{message} keeps blocks apart"


def _poses_at(search: ContactSearch, system: System, pose: Array, t: float, case: AnyCase) -> Poses:
    """Where all blocks are at a sample."""
    bodies, d = system.bodies.copy(), len(system.axes)
    bodies["place"] = pose[:, :d]
    set_rotations(bodies, pose)
    moved = np.concatenate([np.empty((0, d)), *(support.at(np.array([t])) for support in case.supports)])
    return search.poses(system._replace(bodies=bodies, supports=system.supports._replace(moved=moved)))


def common_volume(solids: Solids, a: int, b: int) -> float:
    """Volume that two convex solids have in common [m3]: that of pyramids on what is left of their faces, from a point
    within both."""
    faces, blocks = [], [solids.corners[solids.corner[block] : solids.corner[block + 1]] for block in (a, b)]
    one_plane = FLUSH * float(max(np.abs(corners).max() for corners in blocks))
    for block, other in ((a, b), (b, a)):
        of_other = range(solids.face[other], solids.face[other + 1])
        walls = [(face_corners(solids, wall)[0], solids.normals[wall]) for wall in of_other]
        for face in range(solids.face[block], solids.face[block + 1]):
            normal, polygon = solids.normals[face], face_corners(solids, face)
            for corner, outwards in walls:
                if not len(polygon):
                    break
                beyond = (polygon - corner) @ outwards
                lowest, highest = min(distances := beyond.tolist()), max(distances)
                flush = -one_plane < lowest and highest < one_plane and normal @ outwards > 0
                if not flush and highest > 0:
                    polygon = kept_of(polygon, -beyond)
                if len(polygon) < 3 or (flush and block == b):  # a face that two blocks share counts once
                    polygon = polygon[:0]
            if len(polygon):
                faces.append((normal, polygon))
    if not faces:
        return 0.0
    middle = np.concatenate([polygon for _, polygon in faces]).mean(axis=0)
    return sum(float(normal @ (polygon[0] - middle) * (normal @ area_vector(polygon))) for normal, polygon in faces) / 3


def face_corners(solids: Solids, face: int) -> Array:
    """Corners around a face [m], shape (n, 3)."""
    corners: Array = solids.corners[solids.outline[solids.first[face] : solids.first[face + 1]]]
    return corners
