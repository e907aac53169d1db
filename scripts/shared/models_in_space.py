"""Models of masonry in space: the case, the step written into the scene, the card, and the reference as CSV."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import mjrock as mr
from scripts.shared import cli

SPACING = 5e-3
"""Of the reference samples [s]."""
FINER = 4
"""How many times shorter the steps of the reference are."""


@dataclass(frozen=True)
class SpaceModel:
    """A folder of `models/` of masonry in space, with velocities at its release. Its case is made when it is first
    asked for."""

    name: str
    title: str
    make: Callable[[], mr.MasonryCase]
    about: str
    timestep: float

    @cached_property
    def case(self) -> mr.MasonryCase:
        """The masonry and its release."""
        return self.make()

    def run(self, timestep: float) -> mr.Response:
        """MuJoCo at a fixed step, on the rows of the text."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # the card says what slides; the step is short enough
            return mr.simulate(self.case, timestep=timestep)

    def scene(self) -> str:
        """The MJCF text."""
        return mr.masonry_mjcf(self.case, self.timestep)

    def reference(self) -> str:
        """Displacement of each centroid and energy, by shorter steps, as CSV text."""
        answer = self.run(self.timestep / FINER)
        names = [self.case.masonry.names[i] for i in self.case.masonry.free]
        header = ["time [s]", *(f"{axis} of {name} [m]" for name in names for axis in "xyz"), "energy [J]"]
        table = np.column_stack([answer.t, answer.pose[:, :, :3].reshape(len(answer.t), -1), answer.energy])
        every = round(SPACING / self.timestep) * FINER
        return cli.csv_text(header, ([f"{value:.6g}" for value in row] for row in table[::every]))

    def card(self) -> str:
        """What the model is: blocks, joints, units."""
        masonry = self.case.masonry
        blocks, velocity = "", np.asarray(self.case.velocity)
        for i, v in zip(masonry.free, velocity, strict=True):
            place = ", ".join(f"{value:.4g}" for value in masonry.centroids[i])
            moving = [", ".join(f"{value:.4g}" for value in part) for part in (v[:3], v[3:])]
            blocks += f"| {masonry.names[i]} | {masonry.blocks[i].mass:.6g} | {place} | {' | '.join(moving)} |\n"
        area = sum(joint.area for joint in masonry.joints)
        k, mu = float(masonry.joint_stiffness[0]), float(masonry.joint_friction[0])
        return f"""# {self.title}

Made by `scripts/models/make_models.py`; a test makes it again and compares.

{self.about}

| block | mass [kg] | centroid x, y, z [m] | velocity at the release x, y, z [m/s] | turning x, y, z [rad/s] |
| --- | --- | --- | --- | --- |
{blocks}
{len(masonry.joints)} joints of {area:.4g} m2 in all have {len(masonry.lines.k)} contact points: k_n = {k:g} N/m3,
friction {mu:g}, c/k = {masonry.retardation[0] * 1e3:.4g} ms. A point carries k_i = k_n times its tributary area and
c_i = (c/k) k_i, and pushes with f = max(0, -k_i r - c_i r'), r the gap. Friction is Coulomb's.

`scene.xml`: step {self.timestep:g} s, Euler. In stock MuJoCo reset to the keyframe `release` and step. The viewer opens
with the blocks as drawn, unloaded and without a velocity; `Load key` in its list Simulation sets the keyframe. Each
block has three slides and a ball joint of MuJoCo, which displace its centroid [m] and turn it. A joint that slides is
pressed apart in stock MuJoCo; steps of mjrock that fit the motion slide by Coulomb's law.

`reference.csv`: displacement of each block and energy above the masonry at rest, by MuJoCo with steps {FINER} times as
short. It says what the step of the scene costs in accuracy.
"""

    def files(self) -> dict[str, str]:
        """File names and contents."""
        return {"scene.xml": self.scene(), "README.md": self.card(), "reference.csv": self.reference()}


def pushed(masonry: mr.Masonry, speed: float) -> np.ndarray:
    """Velocities of a blow along x, which grow with the height [m/s], shape (bodies, 6)."""
    height = masonry.centroids[list(masonry.free), 2]
    velocity = np.zeros((len(height), 6))
    velocity[:, 0] = np.round(speed * height / height.max(), 6)
    return velocity


def _corner_block() -> mr.MasonryCase:
    masonry = mr.Masonry.box((0.6, 0.4, 2.0), k_n=1e8, friction=0.6)
    return mr.MasonryCase(masonry, 1.0, velocity=[(0.35, 0.2, 0.1, -0.2, 0.35, 0.1)])


def _facade() -> mr.MasonryCase:
    masonry = mr.Masonry.facade(2.0, 1.0, 0.5, (0.5, 0.25), k_n=1e9)
    return mr.MasonryCase(masonry, 0.1, velocity=pushed(masonry, 0.5))


def _dome() -> mr.MasonryCase:
    masonry = mr.Masonry.dome(2.5, 0.25, 8, 4, k_n=1e9, friction=0.7)
    return mr.MasonryCase(masonry, 0.1, velocity=pushed(masonry, 0.3))


IN_SPACE = (
    SpaceModel(
        "corner_block",
        "A block that rocks on its corners",
        _corner_block,
        "A block of 0.6 x 0.4 x 2 m that a blow turns askew, so that it rocks from corner to corner.",
        5e-4,
    ),
    SpaceModel(
        "facade_return_walls",
        "A facade with return walls",
        _facade,
        "A facade of 2 x 1 m with bonded return walls, 0.25 m thick. A blow out of its plane grows with the height.",
        2.5e-4,
    ),
    SpaceModel(
        "dome",
        "A dome of thirty-two voussoirs",
        _dome,
        "A hemispherical dome of 8 lunes and 4 hoops, 2.5 m in radius and 0.25 m thick, without an oculus. A blow\n"
        "along x grows with the height.",
        1e-4,
    ),
)
