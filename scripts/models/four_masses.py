"""Four masses that fall on a floor, with MuJoCo's default contact and with a contact in N/m that has a restitution.

    python scripts/models/four_masses.py

Balls of 0.5, 1, 2 and 4 kg fall by 0.3 m. Writes four_masses.png, four_masses.csv and four_masses.txt: how high they
rebound, and how deep they rest.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np
from matplotlib.figure import Figure

from mjrock import plotting
from mjrock.contacts import ContactWarning, contacts_for
from mjrock.plotting.style import BLACK, GREEN, ON_LINES, ORANGE, Picture
from mjrock.quantities import GRAVITY, Array
from scripts.shared import cli

MASSES = (0.5, 1.0, 2.0, 4.0)
K, E, RADIUS, DROP, STEP, DURATION = 2e4, 0.7, 0.05, 0.3, 2e-4, 6.0
LOOKS = ({"color": GREEN, "linestyle": "--", "linewidth": 1.4}, {"color": ORANGE, "linewidth": 1.8})
DEFAULT, REQUESTED = "MuJoCo's default", f"k = {K:g} N/m, e = {E:g}"


def spec() -> mujoco.MjSpec:
    """The balls above the floor, side by side."""
    balls = "".join(
        f'<body pos="{i} 0 {RADIUS + DROP}"><freejoint/><geom name="ball{i}" size="{RADIUS}" mass="{mass}"/></body>'
        for i, mass in enumerate(MASSES)
    )
    return mujoco.MjSpec.from_string(
        f'<mujoco><option timestep="{STEP}"/><worldbody><geom name="floor" type="plane" size="9 9 1"/>{balls}'
        "</worldbody></mujoco>"
    )


def heights(model: mujoco.MjModel, duration: float) -> Array:
    """Distance of each ball from the floor [m], shape (steps, balls)."""
    data, found = mujoco.MjData(model), []
    for _ in range(round(duration / STEP)):
        mujoco.mj_step(model, data)
        found.append(data.qpos[2::7] - RADIUS)
    return np.array(found)


def main(argv: Sequence[str] | None = None) -> None:
    """Both runs, the picture and the table."""
    args = cli.parser(__doc__, "four_masses").parse_args(argv)
    made = spec()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ContactWarning)  # of the shares of e that gravity takes
        contacts_for(made, {("ball*", "floor"): {"k": K, "restitution": E}}).apply(made)
    duration = 3.0 if args.quick else DURATION
    runs = {DEFAULT: heights(spec().compile(), duration), REQUESTED: heights(made.compile(), duration)}
    rows = []
    for name, z in runs.items():
        first = int(np.argmax(z[:, 0] < 0))
        for i, mass in enumerate(MASSES):
            rows.append([name, f"{mass:g}", f"{1e3 * z[first:, i].max():.1f}", f"{-1e3 * z[-1, i]:.3f}"])
    folder = cli.folder(args.out)
    header = ["contact", "mass [kg]", "rebounds to [mm]", "rests deep [mm]"]
    cli.report(folder / "four_masses", cli.table(header, rows), header, rows)
    plotting.save(picture(runs), folder / "four_masses.png")


def picture(runs: dict[str, Array]) -> Figure:
    """How high the heaviest ball rebounds, and how deep all of them rest."""
    figure = Picture(figsize=(7.4, 3.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (name, z), look, mark in zip(runs.items(), LOOKS, "so", strict=True):
        t = STEP * np.arange(1, len(z) + 1)
        left.plot(t, 100 * z[:, -1], label=name, **look)
        right.plot(MASSES, -1e3 * z[-1], mark, color=look["color"], label=name)
    right.plot(MASSES, [1e3 * mass * GRAVITY / K for mass in MASSES], ":", color=BLACK, label="m g / k")
    left.set(xlabel="time [s]", ylabel="height of the ball of 4 kg [cm]", xlim=(0, 2.0))
    right.set(xlabel="mass [kg]", ylabel="depth at rest [mm]", xlim=(0, 4.5), ylim=(0, 2.4))
    left.legend(**ON_LINES)
    right.legend(**ON_LINES)
    return figure


if __name__ == "__main__":
    sys.exit(cli.run(main))
