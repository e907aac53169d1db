"""Make the models folder: a wall or masonry a folder, each with scene.xml, a card, and the reference motion as CSV."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli
from scripts.shared.models_in_space import IN_SPACE
from scripts.shared.paper import FIGURE_3, K_N, TABLE_2

MODELS = Path(__file__).parents[2] / "models"
OUTPUT_STEP = 0.01
"""Spacing of the reference samples [s]."""
FINE = 1e-5
"""Accuracy of the fitted steps that are the reference of masonry [-]."""


@dataclass(frozen=True)
class Model:
    """A folder of `models/`: the case, its restitution, its contacts, and the step written into the scene."""

    name: str
    title: str
    case: mr.Case
    e: mr.Restitution
    timestep: float
    law: str = "PUBLISHED"

    @property
    def contacts(self) -> mr.Contacts:
        """Corner lines with the law, at the paper's stiffness."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # the specimens lie outside Table 1; their cards say so
            return mr.Contacts.from_law(self.case.block, self.e, k_base=K_N, k_side=K_N, law=self.law)

    def scene(self) -> str:
        """The MJCF text."""
        return mr.wall_mjcf(self.case, self.contacts, self.timestep)

    def reference(self) -> str:
        """Rotation and energy by rocking theory and by the contact law solved with SciPy, as CSV text."""
        theory = mr.solve_analytical(self.case, self.e, output_step=OUTPUT_STEP)
        law = mr.solve_compliant(self.case, self.contacts, output_step=OUTPUT_STEP)
        t = np.linspace(0, self.case.duration, round(self.case.duration / OUTPUT_STEP) + 1)
        columns = [t] + [np.interp(t, r.t, y) for r in (theory, law) for y in (r.theta, r.energy)]
        header = [
            "time [s]",
            "rotation, rocking theory [rad]",
            "energy, rocking theory [J]",
            "rotation, contact law [rad]",
            "energy, contact law [J]",
        ]
        rows = ([f"{value:.7g}" for value in row] for row in zip(*columns, strict=True))
        return cli.csv_text(header, rows)

    def effects(self) -> str:
        """A line for each opening and each effect, and an empty line before them; nothing without them."""
        lines = [f"* {one}" for one in (*self.case.block.openings, *self.case.effects)]
        return "\nOn the wall, in m and N:\n\n" + "\n".join(lines) + "\n" if lines else ""

    def card(self) -> str:
        """What the model is: equations, symbols, units."""
        wall, contacts = self.case.block, self.contacts
        assert contacts.side is not None
        side = f"| side stop | k_n = {contacts.side.k_n:g} N/m3 | xi_s = {contacts.side.xi:.4f} |\n"
        e = f"e_1s = {self.e.lumped:.4f}" if self.case.side_stop else f"e_2s = {self.e.base:.4f}"
        published = self.law == "PUBLISHED"
        law = mr.PUBLISHED if published else mr.CALIBRATED
        covered = ((wall.R, law.R_range), (wall.slenderness, law.slenderness_range))[0 if published else 1 :]
        inside = all(low <= value <= high for value, (low, high) in covered)
        source = "Eqs. 5-6 of the paper" if published else "docs/damping.md"
        beyond = "the ranges of its Table 1" if published else "the range of its fit"
        law_of_motion = "theta'' = -p^2 sin(alpha - theta)"
        if self.case.effects:
            law_of_motion += ",\nless the moments of the effects over I_0"
        plain = wall.is_plain
        angle = "angle of the diagonal alpha = arctan(b/h)" if plain else "angle to the centroid alpha"
        distance = "half diagonal R" if plain else "distance from the edge to the centroid R"
        frequency = "sqrt(3 g / 4 R)" if plain else "sqrt(m g R / I_0)"
        return f"""# {self.title}

Made by `scripts/models/make_models.py`; a test makes it again and compares.

| wall | value | unit |
| --- | --- | --- |
| thickness 2b | {2 * wall.b:.6g} | m |
| height 2h | {2 * wall.h:.6g} | m |
| length | {wall.length:g} | m |
| density | {wall.density:g} | kg/m3 |
| {angle} | {wall.alpha:.6g} | rad |
| {distance} | {wall.R:.6g} | m |
| frequency parameter p = {frequency} | {wall.p:.6g} | rad/s |
| release theta_0 / alpha | {self.case.theta0 / wall.alpha:g} | - |
| restitution | {e} | - |
{self.effects()}
| contact, two corner lines a face | stiffness | damping ratio |
| --- | --- | --- |
| base | k_n = {contacts.base.k_n:g} N/m3 | xi_b = {contacts.base.xi:.4f} |
{side if self.case.side_stop else ""}
Law: {contacts.law} ({source}){"" if inside else f", here outside {beyond}"}.
A line carries k_i = k_n times its tributary area and c_i = (2 xi / omega) k_i,
omega = {contacts.base.frequency:.5g} rad/s.

`scene.xml`: step {self.timestep:g} s, Euler. In stock MuJoCo reset to the keyframe `release` and step. The hinge
`theta` is the rotation [rad], positive away from the side stop; `x` and `z` displace the centroid [m]. Friction holds
the base and the side is smooth: nothing slides, and the text is the whole simulation.

`reference.csv`: rotation and energy above the wall at rest, by rocking theory
({law_of_motion}, omega -> e omega at theta = 0) and by the contact law (f = max(0, -k r - c r'),
integrated by SciPy). MuJoCo is to follow the second; the gap between the two is the damping law's.
"""

    def files(self) -> dict[str, str]:
        """File names and contents."""
        return {"scene.xml": self.scene(), "README.md": self.card(), "reference.csv": self.reference()}


def _figure_3(name: str, side_stop: bool, duration: float) -> Model:
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, duration, side_stop=side_stop)
    title = f"The wall of Figure 3, {'one' if side_stop else 'two'}-sided"
    return Model(name, title, case, mr.Restitution.from_geometry(FIGURE_3.alpha), timestep=1e-4)


def _facade() -> Model:
    """A façade with a door and a window, a tie that does not yield and a thrust, which all three solvers take."""
    openings = (mr.Opening(1.2, 2.2), mr.Opening(1.0, 1.5, sill=4.0))
    wall = mr.Block.from_size(0.65, 9.0, 6.0, 1600.0, openings=openings)
    effects = (mr.Tie(height=7.0, stiffness=4e4, slack=0.05), mr.Thrust(height=7.0, force=4e3))
    case = mr.Case(wall, 0.5 * wall.alpha, 4.0, effects=effects)
    e = mr.Restitution.from_geometry(wall)
    title = "A façade with a tie, a thrust and openings"
    return Model("facade_tie_thrust_opening", title, case, e, timestep=1e-4, law="CALIBRATED")


ALL = (
    _figure_3("figure3_one_sided", True, 3.0),
    _figure_3("figure3_two_sided", False, 6.0),
    *(
        Model(
            specimen.slug,
            f"Specimen {specimen.name} of Table 2, with its measured restitution",
            mr.Case(specimen.block, 0.5 * specimen.block.alpha, 2.0),
            specimen.restitution,
            timestep=2e-5,
        )
        for specimen in TABLE_2
    ),
    _facade(),
)


@dataclass(frozen=True)
class MasonryModel:
    """A folder of `models/` of many blocks: the case, and the step written into the scene."""

    name: str
    title: str
    case: mr.MasonryCase
    about: str
    timestep: float = 1e-4

    def scene(self) -> str:
        """The MJCF text."""
        return mr.masonry_mjcf(self.case, self.timestep)

    def reference(self) -> str:
        """Rotation of each block and energy, by fine fitted steps, as CSV text."""
        answer = mr.simulate(self.case, accuracy=FINE, output_step=OUTPUT_STEP)
        names = [self.case.masonry.names[i] for i in self.case.masonry.free]
        header = ["time [s]", *(f"rotation of {name} [rad]" for name in names), "energy [J]"]
        table = np.column_stack([answer.t, answer.theta, answer.energy])
        return cli.csv_text(header, ([f"{value:.7g}" for value in row] for row in table))

    def card(self) -> str:
        """What the model is: blocks, joints, units."""
        masonry = self.case.masonry
        blocks, joints = "", ""
        places, velocity = masonry.centroids[list(masonry.free)], np.asarray(self.case.velocity)
        for i, (x, z), (vx, vz, turn) in zip(masonry.free, places, velocity, strict=True):
            cells = (masonry.names[i], f"{masonry.blocks[i].mass:.6g}", f"{x:.4g}, {z:.4g}", f"{vx:.4g}, {vz:.4g}")
            blocks += f"| {' | '.join(cells)} | {turn:.4g} |\n"
        laws = zip(masonry.joints, masonry.joint_stiffness, masonry.joint_friction, masonry.retardation, strict=True)
        for joint, k, mu, lag in laws:
            name = joint.name.replace("|", r"\|")
            joints += f"| {name} | {joint.width:.4g} | {k:g} | {mu:g} | {lag * 1e3:.4g} |\n"
        return f"""# {self.title}

Made by `scripts/models/make_models.py`; a test makes it again and compares.

{self.about}

| block | mass [kg] | centroid x, z [m] | velocity at the release x, z [m/s] | turning [rad/s] |
| --- | --- | --- | --- | --- |
{blocks}
| joint | width [m] | k_n [N/m3] | friction [-] | c/k [ms] |
| --- | --- | --- | --- | --- |
{joints}
A joint has {masonry.points} contact lines. A line carries k_i = k_n times its tributary area and c_i = (c/k) k_i, and
pushes with f = max(0, -k_i r - c_i r'), r the gap. Friction is Coulomb's.

`scene.xml`: step {self.timestep:g} s, Euler. In stock MuJoCo reset to the keyframe `release` and step. Each block has
three joints of MuJoCo: `<block>_theta` is the rotation [rad], positive where its top turns to the right; `<block>_x`
and `<block>_z` displace its centroid [m]. A joint that slides is pressed apart in stock MuJoCo: at 0.1 m/s by up to
{self.lift(0.1):.0%} of the weight that a line of it bears. Steps of mjrock that fit the motion slide by Coulomb's law.

`reference.csv`: rotation of each block and energy above the masonry at rest. The reference is MuJoCo itself, with steps
that fit the motion at an accuracy of {FINE:g}. It says what the step of the scene costs in accuracy, and does not check
the law of the contacts: rocking theory and the SciPy solver of the package are for one wall.
"""

    def lift(self, slip: float) -> float:
        """What a slip [m/s] adds to the normal force of a line in the text, the most over what it bears at rest [-]."""
        scene = mr.masonry_scene(self.case)
        bears = scene.bears > 0
        added = scene.contacts.friction * (scene.contacts.c / 2 + 0.25 * self.timestep * scene.contacts.k) * slip
        return float((added[bears] / (scene.contacts.k * scene.bears)[bears]).max())

    def files(self) -> dict[str, str]:
        """File names and contents."""
        return {"scene.xml": self.scene(), "README.md": self.card(), "reference.csv": self.reference()}


def turning_right(masonry: mr.Masonry, rates: Sequence[float]) -> np.ndarray:
    """Velocities of the blocks of a stack that turn to the right, each about the right edge of its base, (n, 3).

    Args:
        masonry: the stack, from the lowest block upwards.
        rates: how fast each block turns [rad/s].
    """
    found, edge = [], np.zeros(2)
    for i, rate in zip(masonry.free, rates, strict=True):
        corners, across = masonry.blocks[i].corners, rate * np.array([[0.0, 1.0], [-1.0, 0.0]])
        right, low, high = corners[:, 0].max(), corners[:, 1].min(), corners[:, 1].max()
        found.append([*(edge + across @ (masonry.centroids[i] - (right, low))), rate])
        edge = edge + across @ (0.0, high - low)
    return np.round(found, 9)  # the same on every machine


def _cracked_facade() -> MasonryModel:
    parts = [mr.Block.from_size(0.5, height, 1.0, 1800.0) for height in (3.6, 2.4)]
    masonry = mr.Masonry.stack(parts, 5e8, law="CALIBRATED", friction=0.7)
    case = mr.MasonryCase(masonry, 3.0, velocity=turning_right(masonry, (0.07, 0.22)))
    about = (
        "A façade 0.5 m thick and 6 m high, cracked at 3.6 m, a metre of its length. Law: CALIBRATED (docs/damping.md)."
    )
    return MasonryModel("cracked_facade", "A cracked façade of two blocks", case, about)


def _four_drum_column() -> MasonryModel:
    drum = mr.Block.from_size(0.9, 1.2, 0.9, 2500.0)
    masonry = mr.Masonry.stack([drum] * 4, 2e8, xi=0.05, friction=0.7)
    case = mr.MasonryCase(masonry, 2.0, velocity=turning_right(masonry, (0.2, 0.3, 0.4, 0.5)))
    about = "Square drums, 0.9 m wide and 1.2 m high. Damping: xi = 0.05 at the lowest frequency with closed joints."
    return MasonryModel("four_drum_column", "A column of four drums", case, about)


def _arch() -> MasonryModel:
    masonry = mr.Masonry.arch(5.0, 0.9, 2.6, 12, k_n=1e8)
    height = masonry.centroids[list(masonry.free), 1]
    velocity = np.zeros((len(height), 3))
    velocity[:, 0] = np.round(0.3 * (height - height.min()) / np.ptp(height), 6)
    about = (
        "Radius 5 m, thickness 0.9 m, 2.6 rad between the springings. Damping: xi = 0.05 at the lowest frequency with\n"
    )
    about += "closed joints. The blow at the release is strongest at the crown and zero at the springings."
    return MasonryModel("arch", "An arch of twelve voussoirs", mr.MasonryCase(masonry, 0.6, velocity=velocity), about)


MASONRY = (_cracked_facade(), _four_drum_column(), _arch())


def main(argv: Sequence[str] | None = None) -> None:
    """Write every model."""
    options = cli.parser(__doc__, "models")
    options.set_defaults(out=MODELS)
    args = options.parse_args(argv)
    for model in tqdm(ALL[:1] if args.quick else (*ALL, *MASONRY, *IN_SPACE), desc="models", disable=None):
        out = cli.folder(args.out / model.name)
        for name, text in model.files().items():
            cli.write_text(out / name, text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
