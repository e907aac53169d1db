"""Make the models folder: a wall a folder, each with scene.xml, a card, and the reference motion as CSV."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tqdm import tqdm

import cli
import mjrock as mr
from paper import FIGURE_3, K_N, TABLE_2

MODELS = Path(__file__).parents[1] / "models"
OUTPUT_STEP = 0.01
"""Spacing of the reference samples [s]."""


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

Made by `scripts/make_models.py`; a test makes it again and compares.

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
`theta` is the rotation [rad], positive away from the side stop; `x` and `z` displace the centroid [m].

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


def main(argv: Sequence[str] | None = None) -> None:
    """Write every model."""
    options = cli.parser(__doc__, "models")
    options.set_defaults(out=MODELS)
    args = options.parse_args(argv)
    for model in tqdm(ALL[:1] if args.quick else ALL, desc="models", disable=None):
        out = cli.folder(args.out / model.name)
        for name, text in model.files().items():
            cli.write(out / name, text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
