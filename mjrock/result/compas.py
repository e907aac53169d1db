"""Forces and displacements of blocks in space as the results of a COMPAS model, for its viewer and Rhino plug-in.

The file is a `Results` of compas_dem 0.6: transformations by block, and by pair of blocks the polygon of their joint,
the forces at its corners, gaps and status. Blocks are numbered as `Masonry.to_compas` writes them.
"""

from __future__ import annotations

import json

import numpy as np

from ..geometry.poses import rotations
from ..problem.masonry.blocks.joints_in_space import SpaceJoint
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.files.compas import guid_of, held, model_guid
from ..quantities import Array
from .bodies import Body
from .forces import Forces

NEGLIGIBLE_FORCE = 1e-9
"""Normal force of a joint that carries none, over the largest of all [-]."""
SLIPS = 1 - 1e-6
"""Share of the friction from which a joint slides [-]."""


def results_text(case: MasonryCase, bodies: list[Body], at: float, forces: Forces | None, sample: int) -> str:
    """The text of a file.

    Args:
        case: what was asked.
        bodies: all blocks at one time.
        at: that time [s].
        forces: of the run, or None.
        sample: number of the sample of the forces.
    """
    names = case.masonry.names
    nodes = {str(i): {"transformation": _transformation(body, f"{names[i]} {at!r}")} for i, body in enumerate(bodies)}
    edges = {} if forces is None else dict(_edge(case, bodies, forces, sample, i) for i in range(len(forces.joints)))
    content = {
        "model_id": model_guid(names),
        "problem_id": guid_of("problem", repr(case.masonry)),
        "displacement_scale": 1.0,
        "node_data": nodes,
        "edge_data": edges,
        "metadata": {"solver": "mjrock", "time": at},
    }
    return json.dumps(held("compas_dem.problem/Results", content, guid_of("results", at)), indent=1) + "\n"


def _transformation(body: Body, name: str) -> dict[str, object]:
    """The transformation from the drawn to the present position of a body."""
    turn, matrix = rotations(body.pose)[0], np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, body.rest + body.pose[0, :3] - turn @ body.rest
    return held("compas.geometry/Transformation", {"matrix": matrix.tolist()}, guid_of("transformation", name))


def _edge(
    case: MasonryCase, bodies: list[Body], forces: Forces, sample: int, number: int
) -> tuple[str, dict[str, object]]:
    """The key and the contact of a joint: the block above it comes first, and forces are those on it."""
    joint = case.masonry.joints[number]
    assert isinstance(joint, SpaceJoint)
    below, above = bodies[joint.below], bodies[joint.above]
    corners, met = (body.placed(joint.outline - body.rest)[0] for body in (below, above))
    normal, *along = below.turned(np.array([joint.normal, *joint.axes]))[0]
    place = (joint.outline - joint.middle) @ joint.axes.T
    pressed, slid = forces.normal[sample, number], forces.shear[sample, number]
    presses = pressed > NEGLIGIBLE_FORCE * forces.normal.max()
    shares = at_corners(place, forces.eccentricity[sample, number]) if presses else np.full(len(place), 1 / len(place))
    parts = [shares * part + 0.0 for part in (pressed, *slid)]
    total = pressed * normal + slid @ along
    slides = presses and np.linalg.norm(slid) >= SLIPS * case.masonry.joint_friction[number] * pressed
    frame = {"point": corners.mean(axis=0).tolist(), "xaxis": along[0].tolist(), "yaxis": along[1].tolist()}
    where = held("compas.geometry/Frame", frame, guid_of("frame", joint.name))
    points = [
        held("compas.geometry/Point", at, guid_of("point", (joint.name, i))) for i, at in enumerate(corners.tolist())
    ]
    at_points = [
        {"c_np": max(0.0, n), "c_nn": max(0.0, -n), "c_u": u, "c_v": v} for n, u, v in np.column_stack(parts).tolist()
    ]
    contact = {
        "points": points,
        "frame": where,
        "size": joint.area,
        "mesh": None,
        "name": joint.name,
        "forces": at_points,
    }
    edge = {
        "face_contact": True,
        "edge_contact": False,
        "point_contact": False,
        "contact_polygon": held(
            "compas.geometry/Polygon", {"points": corners.tolist()}, guid_of("polygon", joint.name)
        ),
        "contact_points": corners.tolist(),
        "contact_frame": where,
        "contact_data": held("compas_dem.interactions/FrictionContact", contact, guid_of("contact", joint.name)),
        **dict(
            zip(("force_normal", "force_tangent1", "force_tangent2"), (part.tolist() for part in parts), strict=True)
        ),
        "force_point": (shares @ corners).tolist(),
        "resultant_global": total.tolist(),
        "resultant_local": [*slid.tolist(), float(pressed)],
        "force_magnitude": float(np.linalg.norm(total)),
        "gap": ((met - corners) @ normal).tolist(),
        "status": ["slide" if slides else "stick" if presses else "noctc"] * len(corners),
    }
    return f"{joint.above},{joint.below}", edge


def at_corners(corners: Array, eccentricity: Array) -> Array:
    """Shares of a force at corners, none of them negative, that add up to it and act where it does.

    They have the least sum of squares, where none of these pulls. A force beyond the outline, as on an
    edge that has slipped, is put on it.

    Args:
        corners: from the middle of the joint [m], shape (n, 2).
        eccentricity: of the force from there [m], shape (2,).
    """
    conditions = np.vstack([np.ones(len(corners)), corners.T / np.abs(corners).max()])
    wanted = np.append(1.0, eccentricity / np.abs(corners).max())
    shares = np.linalg.lstsq(conditions, wanted)[0]
    if shares.min() < 0:
        from scipy.optimize import nnls  # half a second, which nobody else waits for

        shares = nnls(conditions, wanted)[0]
    return np.asarray(shares / shares.sum())
