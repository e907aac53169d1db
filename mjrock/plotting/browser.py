"""A page that shows a run in any browser without a network: blocks that are turned, zoomed, scrubbed and played."""

from __future__ import annotations

import base64
import html
import json
import zlib
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from string import Template

import numpy as np
from numpy.typing import ArrayLike

from ..contacts.files import write_text
from ..geometry.parts import creases_of
from ..problem.masonry.blocks.joints import Joint
from ..problem.masonry.blocks.joints_in_space import SpaceJoint
from ..problem.wall.rest_geometry import Solid, in_space
from ..quantities import Array, Integers, require_path
from ..result.bodies import bodies_of, frames_at, without_jumps
from ..result.response import Response
from ..result.ties import link_ends
from .bodies import ends_of
from .forces import LARGE, LEAST_DRAWN, LONGEST, DrawnForces, edges_of
from .picture import kind, picture
from .solids import DEEPEST_SUNK

Json = dict[str, object]
"""An object in the data of the page."""
POSE_STEP, FORCE_STEP = 2.0**-20, 2.0**-13
"""Steps in which places are kept over the extent of the blocks [-], and of rotations; the same for forces."""
LIFT = 1e-3
"""How far the ground is drawn below its top, and forces before the blocks, over the extent of the blocks [-]."""
CAMERA_ROOM = 0.6
"""How far around the blocks at rest the camera looks at those that move, over their extent [-]."""
GROUND_REACH = 1.3
"""Radius of the ground, over the farthest distance of a corner from the middle [-]."""
AFTER_ALL_RUNS = 1e30
"""A time after all runs, for JSON, which has no infinity [s]."""
LINE_POINTS = 1200
"""Points of a line that shows what the ground does."""
CAMERA_DIRECTIONS = {False: (0.42, -1.0, 0.26), True: (0.75, -1.0, 0.42)}
"""From the middle of the blocks to the camera, in the plane and in space."""
GROUND_DIRECTIONS = {"motion": "along x", "vertical": "upwards", "transverse": "along y"}
"""Where the components of the acceleration of the ground point."""


@picture(response=kind(Response))
def view(response: Response, path: str | Path, *, fps: float = 25.0) -> Path:
    """Write a page with the motion of a response that opens in any browser without a network.

    The blocks can be turned, zoomed, scrubbed and played, with what the ground does below the slider. A block that is
    clicked tells its name, mass and displacement, and a line the largest opening of a joint so far. Colours follow the
    light or dark theme of the reader. There is a switch for blocks, ground, supports that move, ties,
    cracks, and, where the run kept them, for forces. `page.html#t=0.7&forces` opens the page at 0.7 s with forces.

    Args:
        response: of any solver, of a wall or of masonry.
        path: where to, with the ending .html. The same response has the same bytes.
        fps: most samples of a second that are kept [1/s], 1 to 10000; the page interpolates between them.

    Returns:
        The path.

    Raises:
        ValueError: for another ending, or a value outside its range.
        OSError: if the file cannot be written.
    """
    path = require_path("path", path)
    if path.suffix != ".html":
        raise ValueError(f"path = {str(path)!r} does not end with .html")
    run = json.dumps(Page(response, frames_at(response.t, fps)).run, separators=(",", ":")).replace("<", "\\u003c")
    parts = files(__package__) / "page"
    script, three = ((parts / name).read_text("utf-8") for name in ("view.js", "three/three.min.js"))
    page = Template((parts / "view.html").read_text("utf-8"))
    return write_text(path, page.substitute(title=html.escape(path.stem), run=run, three=three, script=script))


def packed(rows: Array, step: float) -> Json:
    """Numbers as text, in steps, shape (rows, samples): second differences along each row, which motion has small.

    They are folded to numbers without sign, of four bytes each, of which the lowest bytes of all come first. The script
    of the page unpacks them.
    """
    steps = np.rint(rows / step).astype(np.int64)
    bent = np.diff(steps, n=2, axis=1, prepend=np.zeros((len(rows), 2), dtype=np.int64)).astype(np.int32)
    folded = ((bent << 1) ^ (bent >> 31)).astype("<u4")
    planes = np.ascontiguousarray(folded).view(np.uint8).reshape(-1, 4).T
    data = base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode()
    return {"rows": len(rows), "step": step, "data": data}


class Page:
    """The content of a page: a response at some of its samples."""

    def __init__(self, response: Response, samples: Integers) -> None:
        self.response, self.case, self.samples = response, response.case, samples
        self.t = response.t[samples]
        self.moving = response.moving.at(samples)
        self.bodies = bodies_of(self.moving, response.velocity[samples])
        self.solids, self.grounds = self.case.rest_geometry.solids, self.moving.are_ground
        free = [body for body in self.bodies if not body.fixed]
        self.low, self.high = ends_of(np.concatenate([body.rest + body.corners for body in free]))
        self.reached = ends_of(np.concatenate([ends_of(body.placed(body.corners)) for body in free]))
        self.extent = float((self.high - self.low).max())
        self.digits = max(0, 6 - int(np.floor(np.log10(self.extent))))

    @property
    def run(self) -> Json:
        """All that the script of the page needs."""
        room = CAMERA_ROOM * self.extent
        fixed = [body.rest + body.corners for i, body in enumerate(self.bodies) if body.fixed and not self.grounds[i]]
        low, high = ends_of(np.concatenate([*self.reached[:, None], *fixed]))
        low, high = np.maximum(low, self.low - room), np.minimum(high, self.high + room)
        moves = [i for i, body in enumerate(self.bodies) if body.moves]
        return {
            "t": [float(f"{t:.9g}") for t in self.t],
            **self._bodies(),
            **self._poses(moves),
            "moving": moves,
            "ties": list(self._ties()),
            "cracks": list(self._cracks()),
            "forces": None if self.response.kept_forces is None else self._forces(),
            "track": list(self._track()),
            "opened": self._opened(),
            "box": [self._rounded(low), self._rounded(high)],
            "camera": CAMERA_DIRECTIONS[self.response.in_space],
            "reach": float(np.abs(self.reached - np.array([low, high])).max() + 2 * self.extent),
            "ground": self._ground(),
        }

    def _rounded(self, values: Array) -> list[object]:
        """Lengths [m] to a millionth of the extent."""
        rounded: list[object] = (np.round(values, self.digits) + 0.0).tolist()
        return rounded

    def _bodies(self) -> Json:
        """The bodies, and their shapes, those that are alike once."""
        shapes, numbers = list[Json](), dict[str, int]()
        bodies = list[Json]()
        for i, (body, solid) in enumerate(zip(self.bodies, self.solids, strict=True)):
            corners = self._rounded(body.corners)
            number = numbers.setdefault(repr((corners, body.faces)), len(shapes))
            if number == len(shapes):
                edges = self._rounded(creases_of(solid.parts))
                shapes.append({"corners": corners, "faces": body.faces, "edges": edges})
            look = {"colour": None if body.fixed else body.colour.tolist()}
            look["kind"] = "ground" if self.grounds[i] else "supports" if body.fixed else "blocks"
            named = {"name": body.name, "mass": self._mass(solid), "shape": number}
            bodies.append({**named, "rest": self._rounded(body.rest), **look})
        return {"bodies": bodies, "shapes": shapes}

    def _mass(self, solid: Solid) -> float | None:
        """Mass of a block with what is added to it [kg], None of what a wall stands on."""
        return None if solid.block is None else float(f"{self.case.masses[solid.block]:.6g}")

    def _ground(self) -> Json | None:
        """The ground as a disc that reaches beyond all blocks, or None where blocks fall past the edge of it."""
        if not self.grounds.any():
            return None
        corners = np.concatenate([body.rest + body.corners for i, body in enumerate(self.bodies) if self.grounds[i]])
        level = float(corners[:, 2].max())
        if self.reached[0, 2] < level - DEEPEST_SUNK * self.extent:
            return None
        low, high = ends_of(np.concatenate([corners, self.reached])[:, :2])
        radius = 0.5 * GROUND_REACH * float(np.linalg.norm(high - low)) + 0.5 * self.extent
        return {"level": level - LIFT * self.extent, "middle": (0.5 * (low + high)).tolist(), "radius": radius}

    def _poses(self, moves: list[int]) -> Json:
        """Displacements and quaternions of the bodies that move, sample by sample."""
        poses = np.stack([self.bodies[i].pose for i in moves])
        largest = max(self.extent, float(np.abs(poses[..., :3]).max()))
        places = packed(_by_row(poses[..., :3]), POSE_STEP * largest)
        return {"places": places, "turns": packed(_by_row(without_jumps(poses[..., 3:])), POSE_STEP)}

    def _ties(self) -> Iterator[Json]:
        """The two ends of each link, and when it breaks."""
        for name, link in self.case.links.items():
            ends, ties = link_ends(self.case, link), self.response.ties
            start, end = (self._on_body(block, in_space(point)) for block, point in ends)
            life = [-AFTER_ALL_RUNS, min(float(ties[name].broken), AFTER_ALL_RUNS) if name in ties else AFTER_ALL_RUNS]
            bodies = [-1 if block is None else block for block, _ in ends]
            yield {"name": name, "start": start, "end": end, "bodies": bodies, "life": life}

    def _cracks(self) -> Iterator[Json]:
        """The edges of the joints that lose some of their bond, and since when, where the run kept forces."""
        if self.response.kept_forces is None:
            return
        lost = np.nan_to_num(self.response.forces.damage[self.samples]) > LEAST_DRAWN
        for i in np.flatnonzero(lost.any(axis=0)):
            joint = self.response.of_masonry.masonry.joints[i]
            bodies, life = [joint.below, joint.below], [float(self.t[lost[:, i].argmax()]), AFTER_ALL_RUNS]
            for ends in edges_of(outline_of(joint)):
                start, end = (self._on_body(joint.below, point) for point in ends)
                yield {"name": joint.name, "start": start, "end": end, "bodies": bodies, "life": life}

    def _on_body(self, block: int | None, point: Array) -> list[object]:
        """A point at rest [m] about the centroid of its block, or as it is on the ground."""
        return self._rounded(point if block is None else point - self.bodies[block].rest)

    def _forces(self) -> Json:
        """Places and forces of the joints, forces over their scale, and how bars of them are drawn."""
        acting = DrawnForces(self.response, self.moving)
        frames = [acting.placed(frame) for frame in range(len(self.t))]
        places, shares = (in_space(np.stack(part, axis=1)) for part in zip(*frames, strict=True))
        if not self.response.in_space:  # on the front of the blocks
            places[..., 1] = self.low[1] - LIFT * self.extent
        joints = self.case.rest_geometry.joints
        return {
            "scale": acting.scale,
            "longest": LONGEST * acting.extent,
            "most": LARGE,
            "joints": [[joint.name, joint.below, joint.above] for joint in joints],
            "places": packed(_by_row(places), FORCE_STEP * self.extent),
            "shares": packed(_by_row(shares), FORCE_STEP),
        }

    def _track(self) -> Iterator[Json]:
        """Lines of the accelerations of the ground, the displacements of supports, and the tilt of a table."""
        for name, motion in self.case.grounds.items():
            values = motion(self._instants(motion.times))
            yield _line(f"acceleration of the ground {GROUND_DIRECTIONS[name]}", "m/s²", values)
        for support in self.case.supports:
            values = support.at(self._instants(support.t))
            yield _line(f"displacement of {support.block}", "m", values[:, int(np.abs(values).max(axis=0).argmax())])
        if self.case.tilt is not None:
            t, angle = self.case.tilt
            yield _line("tilt of the table", "rad", np.interp(self._instants(t), t, angle))

    def _opened(self) -> list[float] | None:
        """Largest opening of a joint so far at each sample [m], at the last that of the whole run; None of a wall."""
        if self.response.joints is None:
            return None
        widest = np.maximum.accumulate(self.response.crack_widths.max(axis=1, initial=0.0))[self.samples]
        widest[-1] = max(widest[-1], self.response.opening.max(initial=0.0))
        return [float(f"{width:.4g}") for width in widest]

    def _instants(self, instants: ArrayLike) -> Array:
        """Times of the points of a line, and then those given within the run [s]."""
        times, start, end = np.asarray(instants), float(self.t[0]), float(self.t[-1])
        return np.append(np.linspace(start, end, LINE_POINTS), times[(start <= times) & (times <= end)])


def _by_row(values: Array) -> Array:
    """Vectors of things at samples, shape (things, samples, d), as rows, shape (things d, samples)."""
    return np.swapaxes(values, 1, 2).reshape(-1, values.shape[1])


def _line(name: str, unit: str, values: Array) -> Json:
    """A line of what the ground does, over its peak, which may lie between the points of the line. Its values are those
    at `_instants`."""
    peak = float(np.abs(values).max())
    shares = np.round(values[:LINE_POINTS] / (peak or 1.0), 3)
    return {"name": name, "unit": unit, "peak": peak, "values": shares.tolist()}


def outline_of(joint: Joint | SpaceJoint) -> Array:
    """Corners of a joint at rest [m], shape (n, 3)."""
    if isinstance(joint, SpaceJoint):
        return joint.outline
    ends, half = in_space(np.array([joint.start, joint.end])), np.array([0.0, 0.5 * joint.length, 0.0])
    return np.concatenate([ends - half, ends[::-1] + half])
