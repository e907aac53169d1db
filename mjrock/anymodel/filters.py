"""Which geoms MuJoCo lets collide without an explicit pair: the rules of its manual (Computation, Selection)."""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import numpy as np

from .geoms import GeomPair


def kept_apart(pair: GeomPair) -> str:
    """Why MuJoCo makes no contact of two geoms without an explicit pair, in words; nothing if it makes one.

    Bodies that are welded together without joints are one body. A parent that is the world, or is welded to it, meets
    its children.
    """
    model, (first, second), (a, b) = pair.model, pair.geoms, pair.bodies
    if not (
        model.geom_contype[first] & model.geom_conaffinity[second]
        or model.geom_contype[second] & model.geom_conaffinity[first]
    ):
        return "their contype and conaffinity do not match"
    weld_a, weld_b = int(model.body_weldid[a]), int(model.body_weldid[b])
    if weld_a == weld_b:
        return "they belong to the same body"
    if weld_a and weld_b and not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT):
        parents = (int(model.body_weldid[model.body_parentid[weld]]) for weld in (weld_a, weld_b))
        if {weld_a, weld_b} & {*parents}:
            return "their bodies are parent and child"
    if (model.exclude_signature == (min(a, b) << 16) + max(a, b)).any():
        return "an <exclude> names their bodies"
    return ""


def makes(pair: GeomPair) -> bool:
    """Whether MuJoCo makes contacts of two geoms, by an explicit pair or without one."""
    return pair.explicit >= 0 or (pair.inverse_weight > 0 and not kept_apart(pair))


def every_pair(model: mujoco.MjModel, *, candidates: bool = True) -> Iterator[GeomPair]:
    """The explicit pairs of a model, then the geoms that MuJoCo lets collide without one. Pairs of which neither body
    can move are left out."""
    listed = set()
    for chosen, ends in enumerate(zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)):
        listed.add(frozenset(ends))
        if (pair := GeomPair(model, ends, chosen)).inverse_weight > 0:
            yield pair
    for first in range(model.ngeom if candidates else 0):
        kinds, masks = model.geom_contype[first:], model.geom_conaffinity[first:]
        for later in np.flatnonzero(kinds[0] & masks[1:] | kinds[1:] & masks[0]).tolist():
            pair = GeomPair(model, (first, first + 1 + later))
            if frozenset(pair.geoms) not in listed and pair.inverse_weight > 0 and not kept_apart(pair):
                yield pair
