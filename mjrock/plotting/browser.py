"""A page that shows a run in any browser without a network: blocks that are turned, zoomed, scrubbed and played."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..files import write_text
from ..geometry.poses import rotations
from ..problem.masonry.blocks.joints import Joint
from ..problem.masonry.blocks.joints_in_space import SpaceJoint
from ..problem.wall.standing import in_space
from ..quantities import Array, Integers, require_path
from ..result.bodies import Moving, bodies_of, frames_at
from ..result.response import Response
from .arguments import kind, picture
from .forces import CRACKED, NOTHING, Acting, edges_of
from .perspective import GROUND_COLOUR
from .section import FORCE
from .solids import TINTS

SUPPORT, TIE = "#bdbdbd", "#1f5f9e"
THICK = 0.005
"""Thickness of lines, over the extent of what moves [-]."""
WAY = np.array([0.7, -0.9, 0.3])
"""Vector from the middle of what moves to the camera, over its extent [-]."""
PANEL = """
const world = K3DInstance.getWorld(), objects = Object.values(world.ObjectsListJson);
const panel = document.createElement('div'), last = LAST;
panel.style = 'position:absolute;left:12px;top:12px;font:14px sans-serif;background:#fffd;padding:8px;z-index:99999';
document.body.appendChild(panel);
const add = (tag, more, parent) => (parent || panel).appendChild(Object.assign(document.createElement(tag), more));
const play = add('button', {id: 'play', textContent: 'play'});
const slider = add('input', {id: 'time', type: 'range', min: FIRST, max: last, step: 'any', value: FIRST});
const clock = add('span', {id: 'clock'});
const put = t => { slider.value = t; clock.textContent = t.toFixed(2) + ' s'; return K3DInstance.setTime(t); };
slider.oninput = () => put(+slider.value);
let since = null;
const step = now => {
  if (play.textContent === 'play') { since = null; return; }
  const before = since === null ? now : since, t = +slider.value + (now - before) / 1000;
  since = now;
  put(t > last ? FIRST : t);
  requestAnimationFrame(step);
};
play.onclick = () => {
  play.textContent = play.textContent === 'play' ? 'pause' : 'play';
  if (play.textContent === 'pause') requestAnimationFrame(step);
};
for (const group of new Set(objects.map(o => o.group))) {
  const label = add('label', {style: 'display:block'});
  const box = add('input', {type: 'checkbox', checked: true, name: group}, label);
  label.append(group);
  box.onchange = () => Promise.all(objects.filter(o => o.group === group).map(o => {
    world.ObjectsListJson[o.id].visible = box.checked;
    return K3DInstance.reload(world.ObjectsListJson[o.id], null, true);
  })).then(() => put(+slider.value)).then(() => K3DInstance.render());
}
put(FIRST);
"""
"""The switches and the slider of the page. The names in capitals are the first and the last time [s]."""


@picture(response=kind(Response))
def view(response: Response, path: str | Path, *, fps: float = 25.0) -> Path:
    """Write a page with the motion of a response that opens in any browser without a network.

    The blocks can be turned, zoomed, scrubbed and played. There is a switch for blocks, ground, supports that move,
    ties, and for cracks and forces where the run kept forces. Forces in space act inside the blocks: switch the blocks
    off to see them. Needs `pip install 'mjrock[view]'`.

    Args:
        response: of any solver, of a wall or of masonry. Openings of a wall are left out.
        path: where to, with the ending .html.
        fps: positions that are kept a second [1/s], 1 to 10000; the page interpolates between them.

    Returns:
        The path.

    Raises:
        ImportError: if k3d is missing.
        ValueError: for another ending, or a value outside its range.
        OSError: if the file cannot be written.
    """
    try:
        import k3d
    except ImportError as error:
        raise ImportError(f"{error}; k3d makes this page: pip install 'mjrock[view]'") from error
    path = require_path("path", path)
    if path.suffix != ".html":
        raise ValueError(f"path = {str(path)!r} does not end with .html")
    page = Page(k3d, response, frames_at(response.t, fps))
    page.bodies()
    page.ties()
    if response.kept_forces is not None:
        page.forces()
    return write_text(path, page.text(path.stem))


class Page:
    """What a page shows: a response at some of its samples."""

    def __init__(self, k3d: Any, response: Response, samples: Integers) -> None:
        self.k3d, self.response, self.case, self.samples = k3d, response, response.case, samples
        self.t, self.pose = response.t[samples], response.pose[samples]
        self.moving = Moving(self.case, self.t, self.pose)
        self.all = bodies_of(self.case, self.t, self.pose, response.velocity[samples])
        corners = np.concatenate([body.corners + body.rest for body in self.all if not body.fixed])
        self.middle, self.extent = corners.mean(axis=0), float(np.ptp(corners, axis=0).max())
        self.front = float(corners[:, 1].min()) - 2 * THICK * self.extent
        self.plot = k3d.plot(
            grid_visible=False, camera_auto_fit=False, camera_up_axis="z", menu_visibility=False, axes_helper=0.0
        )
        self.plot.camera = [*(self.middle + WAY * self.extent), *self.middle, 0.0, 0.0, 1.0]

    def bodies(self) -> None:
        """Add blocks, ground and supports."""
        for i, body in enumerate(self.all):
            group, colour = "blocks", TINTS[i % len(TINTS)]
            if body.fixed:
                group, colour = ("supports", SUPPORT) if body.moves else ("ground", GROUND_COLOUR)
            mesh = self.k3d.mesh(
                body.corners.astype(np.float32),
                np.array(body.triangles, dtype=np.uint32),
                color=_number(colour),
                name=body.name,
                group=group,
            )
            matrices = np.tile(np.eye(4, dtype=np.float32), (len(self.t), 1, 1))
            matrices[:, :3, :3], matrices[:, :3, 3] = rotations(body.pose), body.rest + body.pose[:, :3]
            mesh.model_matrix = self._series(matrices) if body.moves else matrices[0]
            self.plot += mesh

    def ties(self) -> None:
        """Add a line for each link, until it breaks."""
        for name, link in self.case.links.items():
            held = self.case.held_by(link)
            ends = ((link.block, held), (link.anchor_block, link.anchor_of(held)))
            placed = [self.moving.placed(block, point[None]) for block, point in ends]
            lines, ties = in_space(np.stack(placed, axis=2)), self.response.ties
            lines[self.t >= (ties[name].broken if name in ties else np.inf)] = lines[0, 0, 0]
            self._lines(name, "ties", lines, TIE)

    def forces(self) -> None:
        """Add a bar for the force of each joint, in the plane on the front, and the outlines of cracked joints."""
        acting = Acting(self.response, self.moving)
        bars = in_space(np.stack([acting.every_bar(frame) for frame in range(len(self.t))]))
        if not self.response.in_space:
            bars[..., 1] = self.front
        self._lines("forces", "forces", bars, FORCE)
        damage = np.nan_to_num(self.response.forces.damage[self.samples])
        for i in np.flatnonzero((damage > NOTHING).any(axis=0)):
            joint = self.response.of_masonry.masonry.joints[i]
            ends = edges_of(outline_of(joint))
            below = self.all[joint.below]
            edges = below.placed(ends.reshape(-1, 3) - below.rest).reshape(-1, *ends.shape)
            edges[damage[:, i] <= NOTHING] = edges[0, 0, 0]
            self._lines(joint.name, "cracks", edges, CRACKED)

    def text(self, title: str) -> str:
        """The page."""
        first, last = float(self.t[0]), float(self.t[-1])
        panel = PANEL.replace("FIRST", repr(first)).replace("LAST", repr(last))
        page = str(self.plot.get_snapshot(additional_js_code=panel))
        return page.replace("<title>K3D snapshot viewer", f"<title>{html.escape(title)}", 1)

    def _lines(self, name: str, group: str, ends: Array, colour: str) -> None:
        """Add lines that move: ends of shape (n, lines, 2, 3) [m]."""
        vertices = ends.reshape(len(ends), -1, 3).astype(np.float32)
        pairs = np.arange(vertices.shape[1], dtype=np.uint32).reshape(-1, 2)
        options = {"color": _number(colour), "width": THICK * self.extent, "name": name, "group": group}
        self.plot += self.k3d.lines(self._series(vertices), pairs, indices_type="segment", shader="mesh", **options)

    def _series(self, values: NDArray[np.float32]) -> dict[str, NDArray[np.float32]]:
        """An array for each time, as k3d takes it."""
        return {repr(float(t)): row for t, row in zip(self.t, values, strict=True)}


def outline_of(joint: Joint | SpaceJoint) -> Array:
    """Corners of a joint at rest [m], shape (n, 3)."""
    if isinstance(joint, SpaceJoint):
        return joint.outline
    ends, half = in_space(np.array([joint.start, joint.end])), np.array([0.0, 0.5 * joint.length, 0.0])
    return np.concatenate([ends - half, ends[::-1] + half])


def _number(colour: str) -> int:
    """A colour as one number."""
    return int(colour[1:], 16)
