"""A façade whose mortar ties it to its return walls: when it cracks, parts from them and falls, with lime and dry.

The façade is that of `facade_in_space`, 3.2 m long and 1.6 m high with two windows, in units of 0.4 x 0.2 x 0.2 m on
joints with k_n = k_s = 3e9 N/m3 and mu = 0.6. It is dry, in poor lime mortar (f_t = 0.05 MPa, c = 0.07 MPa, G_I = 5 and
G_II = 50 N/m) and in better lime (twice the strengths, 8 and 80 N/m).
- The ground accelerates away from under the façade, by 0.25 g more each second. Printed are the accelerations at which
  the first joint has cracked, and at which a block of the façade has moved out by 10 mm, and the multiplier of limit
  analysis, which is an upper bound where joints soften.
- Three motions shake it, with peaks of 9, 6 and 4.5 m/s2 along x, y and z. Drawn is how it stands after them. What
  falls depends on the last digits of a run: printed are the least and the most joints that crack and blocks that
  fall, of two runs whose motions differ by 1e-9 of themselves.
Writes bonded_facade.csv, .png and .txt.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.at_times import State, states
from scripts.studies.facade_in_space import CAMERA, DEPTH, HEIGHT, LENGTH, UNIT, WINDOWS, motions

JOINTS: dict[str, Any] = {"k_n": 3e9, "k_s": 3e9, "friction": 0.6, "xi": 0.01, "points": 3}
BONDS = {
    "dry": None,
    "poor lime": mr.Bond(0.05e6, 0.07e6, 5.0, 50.0),
    "better lime": mr.Bond(0.1e6, 0.14e6, 8.0, 80.0),
}
RATE, BEYOND = 0.25, 1.2
"""Growth of the acceleration [g/s], and the largest over the multiplier of limit analysis [-]."""
MOVED = 0.01
"""How far a block has moved out of a façade that has parted from its return walls [m]."""
PEAKS = {"motion": 9.0, "transverse": 6.0, "vertical": 4.5}
"""Largest acceleration of the ground along x, y and z [m/s2]."""
SHAKEN, FOLLOWED = 4.0, 5.0
"""Duration of the motions, and of the runs under them [s]."""
SEEDS, NUDGE = 2, 1e-9
"""Runs of each, and by what their motions differ, over themselves [-]."""


def facade(bond: mr.Bond | None) -> mr.Masonry:
    """The façade with this mortar."""
    return mr.Masonry.facade(LENGTH, HEIGHT, DEPTH, UNIT, openings=WINDOWS, bond=bond, **JOINTS)


def pushed(masonry: mr.Masonry, most: float) -> tuple[float, float]:
    """Accelerations over g at which the first joint has cracked, and a block has moved out, infinite for none."""
    duration = most / RATE
    ground = mr.GroundMotion(np.linspace(0.0, -most * mr.GRAVITY, 1001), duration / 1000)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, duration, ground), output_step=0.01)
    out = np.flatnonzero((answer.pose[:, :, 0] - answer.pose[0, :, 0]).max(axis=1) > MOVED)
    crack = min(answer.cracked.values(), default=np.inf)
    return RATE * crack, RATE * float(answer.t[out[0]]) if len(out) else np.inf


def shaken(masonry: mr.Masonry, duration: float, seed: int) -> mr.Response:
    """The façade under the three motions, which a seed changes in their last digits."""
    peaks = {name: (1 + NUDGE * seed) * peak for name, peak in PEAKS.items()}
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, **motions(peaks, SHAKEN)), output_step=0.01)


def drawn(answers: dict[str, mr.Response]) -> Figure:
    """A façade before the motions, and each after them."""
    first = next(iter(answers.values()))
    ends = [State(f"{name}, after {answer.t[-1]:g} s", answer, len(answer.t) - 1) for name, answer in answers.items()]
    return states([State("each at rest", first, 0), *ends], CAMERA, columns=2)


def main(argv: Sequence[str] | None = None) -> None:
    """Push and shake, print the table and draw."""
    args = cli.parser(__doc__, "bonded_facade").parse_args(argv)
    out, rows, answers = cli.folder(args.out), list[list[object]](), dict[str, mr.Response]()
    for name in tqdm(["poor lime"] if args.quick else list(BONDS), desc="mortars", disable=None, leave=False):
        masonry = facade(BONDS[name])
        bound = mr.collapse_multiplier(masonry, (1.0, 0.0)).multiplier
        crack, parts = pushed(masonry, 0.02 if args.quick else BEYOND * bound)
        runs = [shaken(masonry, 0.02 if args.quick else FOLLOWED, seed) for seed in range(1 if args.quick else SEEDS)]
        answers[name] = runs[0]
        counts = [[len(run.cracked) for run in runs], [len(run.fallen) for run in runs]]
        cells = [f"{bound:.3f}", *(of(count) for count in counts for of in (min, max))]
        rows.append([name, f"{crack:.3f}" if np.isfinite(crack) else "-", f"{parts:.3f}", *cells])
    plotting.save(drawn(answers), out / "bonded_facade.png")
    header = ["mortar", "first crack [g]", "parts at [g]", "limit analysis [g]"]
    header += [f"{what} {of}" for what in ("cracked joints", "fallen") for of in ("least", "most")]
    cli.report(out / "bonded_facade", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
