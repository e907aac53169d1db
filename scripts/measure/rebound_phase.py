"""How the rebound of a plain model depends on where in a step its touch falls: mean, scatter and range of |e|.

Walls beside a side stop, in plain MuJoCo steps of one length, from states that are shifted along the fall by equal
parts of a step: 1,000 at .2 ms, 250 at other steps. Beside them the mean of rows without the inertia of average
acceleration (Newmark's beta of zero), and the mean over starts that differ by up to .5 mrad/s in their speed, which
spread the touches over a number of steps that is not whole.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

import mjrock as mr
from scripts.shared import cli, paper

WALLS = {
    "0.6 x 4.2 m, 5e8 N/m3": (paper.FIGURE_3, 5e8),
    "0.6 x 4.2 m, 7e8 N/m3": (paper.FIGURE_3, 7e8),
    "0.5 x 3 m, 5e8 N/m3": (mr.Block.from_size(thickness=0.5, height=3.0), 5e8),
    "0.8 x 4 m, 2e8 N/m3": (mr.Block.from_size(thickness=0.8, height=4.0), 2e8),
}
STEPS = {4e-4: 250, 2e-4: 1000, 1e-4: 250}
"""Steps [s], and how many phases of each are looked at."""
NEAR = 0.03
"""Share of the rotation of the release at which the touch is near [-]."""
CHUNK = 20
"""Steps between two looks at the way up to the peak."""
SPREAD = 5e-4
"""Largest speed that is added at the release [rad/s]."""


class Fall:
    """A plain model of a wall beside a stop, released at half of its critical rotation."""

    def __init__(self, wall: mr.Block, k_n: float, timestep: float) -> None:
        contacts = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), k_base=k_n, k_side=k_n)
        case = mr.Case(wall, theta0=0.5 * wall.alpha, duration=1.5)
        text = mr.mjcf_of(case, contacts, timestep, collisions=True)
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data, self.wall, self.timestep = mujoco.MjData(self.model), wall, timestep
        self.law = float(mr.solve_compliant(case, contacts).restitution[0])
        self.start = 0.5 * wall.alpha

    def without_beta(self) -> None:
        """Give every row the inertia h c / 2 in place of h c / 2 + h^2 k / 4."""
        model = self.model
        for i, ends in enumerate(zip(model.pair_geom1, model.pair_geom2, strict=True)):
            weight = float(sum(model.body_invweight0[model.geom_bodyid[geom], 0] for geom in ends))
            k, c = mr.contact_stiffness(model.pair_solref[i], model.pair_solimp[i], inverse_weight=weight)
            made = mr.contact_parameters(k, c, timestep=self.timestep, inverse_weight=weight, newmark_beta=0.0)
            model.pair_solref[i], model.pair_solimp[i] = made.solref, made.solimp

    def fall(self) -> None:
        """Step until the touch is near."""
        while self.data.qpos[2] > NEAR * self.start:
            mujoco.mj_step(self.model, self.data)

    def rebound(self) -> float:
        """|e| of the first rebound from the state of the data, by the energy at the peak [-]."""
        model, data, alpha = self.model, self.data, self.wall.alpha
        self.fall()
        while data.qvel[2] <= 0:
            mujoco.mj_step(model, data)
        while data.qvel[2] > 0:
            mujoco.mj_step(model, data, CHUNK)
        peak = data.qpos[2] - 0.5 * data.qvel[2] ** 2 / data.qacc[2]
        heights = (math.cos(alpha - theta) - math.cos(alpha) for theta in (peak, self.start))
        return math.sqrt(next(heights) / next(heights))

    def over_phases(self, count: int) -> NDArray[np.float64]:
        """|e| of touches that are spread evenly over one step, shape (count,)."""
        model, data, h = self.model, self.data, self.timestep
        mujoco.mj_resetDataKeyframe(model, data, 0)
        self.fall()
        kind = mujoco.mjtState.mjSTATE_INTEGRATION
        state = np.zeros(mujoco.mj_stateSize(model, kind))
        mujoco.mj_getState(model, data, state, kind)
        mujoco.mj_forward(model, data)
        place, speed, fall = (np.array(values) for values in (data.qpos, data.qvel, data.qacc))
        found = np.zeros(count)
        for i in range(count):
            mujoco.mj_setState(model, data, state, kind)
            late = (i + 0.5) / count * h
            data.qpos[:] = place + late * (speed + 0.5 * h * fall) + 0.5 * late**2 * fall  # speeds are half a step old
            data.qvel[:] = speed + late * fall
            found[i] = self.rebound()
        return found

    def over_speeds(self, count: int) -> NDArray[np.float64]:
        """|e| of releases with a speed of their own, shape (count,)."""
        found = np.zeros(count)
        for i in range(count):
            mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
            self.data.qvel[2] -= SPREAD * (i + 0.5) / count
            found[i] = self.rebound()
        return found


def main(argv: Sequence[str] | None = None) -> None:
    """Measure them."""
    args, rows = cli.parser(__doc__, "rebound_phase").parse_args(argv), []
    out = cli.folder(args.out)
    for name, (wall, k_n) in WALLS.items():
        for timestep, count in {2e-4: 8}.items() if args.quick else STEPS.items():
            fall = Fall(wall, k_n, timestep)
            e = fall.over_phases(count) / fall.law - 1
            uneven = fall.over_speeds(8 if args.quick else 100).mean() / fall.law - 1
            fall.without_beta()
            central = fall.over_phases(8 if args.quick else 100).mean() / fall.law - 1
            numbers = e.mean(), e.std(), e.min(), e.max(), central, uneven
            rows.append([name, f"{1e3 * timestep:g}", f"{fall.law:.4f}", *(f"{100 * each:.2f}" for each in numbers)])
    header = [
        "wall",
        "step [ms]",
        "law",
        "mean",
        "standard deviation",
        "least",
        "largest",
        "mean, beta 0",
        "mean over speeds",
    ]
    text = cli.table(header, rows)
    cli.report(out / "rebound_phase", f"{text}\n|e| of the first rebound less that of the law, as a share of it [%]")


if __name__ == "__main__":
    sys.exit(cli.run(main))
