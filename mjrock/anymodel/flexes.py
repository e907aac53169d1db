"""Contacts of the flexes of a model with its geoms, in N/m and N s/m.

MuJoCo mixes the parameters of a flex and a geom as those of two geoms. The inverse weight of a contact is that of the
body of the geom and of the bodies of the vertices that meet it, with the weights of the contact point among them. On a
plane it is one vertex. The contacts of all vertices are therefore between the softest and the stiffest of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from ..quantities import Array, short_repr
from .geoms import compiled_model, geom_label
from .notes import model_spoilers
from .row_of_model import Mixed, ModelRow


@dataclass(frozen=True, eq=False)
class FlexContact:
    """The contacts of a flex with a geom.

    Args:
        flex, geom: their labels.
        points: vertices of the flex.
        k, c: spring [N/m] and dashpot [N s/m] at zero penetration of the softest and the stiffest vertex, shape (2,).
    """

    flex: str
    geom: str
    points: int
    k: Array
    c: Array

    __repr__ = short_repr

    def __str__(self) -> str:
        """Its numbers as one line of text."""
        k, c = (" to ".join(dict.fromkeys(f"{value:.4g}" for value in values)) for values in (self.k, self.c))
        return f"{self.flex} on {self.geom}: k = {k} N/m, c = {c} N s/m at each of up to {self.points} points"


def inspect_flexes(model: mujoco.MjModel | mujoco.MjSpec) -> tuple[FlexContact, ...]:
    """Every contact that a flex of a model can make with a geom, in physical units; those of flexes alone are left out.

    Args:
        model: a compiled model or a specification; it is not changed.

    Raises:
        TypeError: unless it is a model.
        ValueError: if the specification does not compile.
    """
    return tuple(_contacts(compiled_model(model)))


def _contacts(model: mujoco.MjModel) -> Iterator[FlexContact]:
    for flex in range(model.nflex):
        start = int(model.flex_vertadr[flex])
        bodies = model.flex_vertbodyid[start : start + int(model.flex_vertnum[flex])]
        if model.flex_interp[flex]:  # its vertices hang on nodes
            start = int(model.flex_nodeadr[flex])
            bodies = model.flex_nodebodyid[start : start + int(model.flex_nodenum[flex])]
        vertices = model.body_invweight0[bodies, 0]
        kinds, masks = int(model.flex_contype[flex]), int(model.flex_conaffinity[flex])
        for geom in np.flatnonzero(model.geom_contype & masks | model.geom_conaffinity & kinds).tolist():
            weights = model.body_invweight0[model.geom_bodyid[geom], 0] + vertices
            if weights.max() > 0:
                mixed = Mixed.of_sides(model, (("geom", geom), ("flex", flex)))
                ends = (weights.max(), weights[weights > 0].min())
                rows = [ModelRow(model, float(weight), mixed) for weight in ends]
                name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_FLEX, flex) or f"[{flex}]"
                k, c = (np.array([getattr(row, each) for row in rows]) for each in ("k", "c"))
                yield FlexContact(name, geom_label(model, geom), int(model.flex_vertnum[flex]), k, c)


def flex_report(model: mujoco.MjModel) -> str:
    """A line for each flex and geom that can meet, and what the options of the model do; empty without any."""
    found = [str(contact) for contact in inspect_flexes(model)]
    if not found:
        return ""
    said = [f"For all of them: {sentence}." for sentence in model_spoilers(model)]
    return "\n".join(["", "Contacts of flexes, at zero penetration:", *found, *said])
