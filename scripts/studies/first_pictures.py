"""The pictures of the first pages: effects with their arguments, a façade with and without a tie, a record, a design.

Writes effects.png, tutorial.png, record.png and design.png. It prints how far the tie was drawn out, which thickness is
chosen and where the record ends.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli


def with_every_effect() -> mr.Case:
    """A wall that carries one of each effect."""
    wall = mr.Block.from_size(
        thickness=0.7, height=6.0, length=4.0, gable=mr.Gable(1.2), openings=[mr.Opening(width=1.0, height=2.0)]
    )
    effects = (
        mr.Tie(height=5.2, stiffness=2e6, strength=2e4, length=2.0),
        mr.Thrust(height=4.4, force=3e3),
        mr.Load(force=2e4, height=6.0, offset=0.2),
        mr.AddedMass(mass=500.0, height=5.65, offset=-0.1),
        mr.FrictionDamper(height=3.4, stiffness=2e6, slip_force=5e3, length=2.0),
        mr.Damper(height=0.7, c=1e4, length=2.0),
    )
    return mr.Case(wall, 0.0, 1.0, side_stop=mr.SideStop(4.0), effects=effects)


def of_the_tutorial(duration: float) -> list[mr.Response]:
    """The façade of docs/tutorial.md in the reversed motion, with the tie of its sixth step and without it."""
    door = mr.Opening(width=1.2, height=2.2)
    wall = mr.Block.from_size(thickness=0.5, height=6.0, length=5.0, density=1800.0, openings=[door])
    contacts = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), k_base=5e8, k_side=5e8)
    motion = mr.GroundMotion.synthetic(peak=4.0, duration=12.0, seed=7).reversed()
    tie = mr.Tie(height=5.5, stiffness=20e6, slack=0.005, strength=15e3, length=2.0, ultimate=0.05)
    cases = [mr.Case(wall, 0.0, duration, motion=motion, effects=effects) for effects in ((tie,), ())]
    return [mr.simulate(case, contacts, accuracy=1e-4) for case in cases]


def of_a_record() -> list[mr.GroundMotion]:
    """A record that drifts, without its baseline, and then within a band."""
    made = mr.GroundMotion.synthetic(peak=3.0, duration=20.0, seed=1)
    drift = 0.02 + 0.001 * made.dt * np.arange(len(made.accel))
    motion = mr.GroundMotion(made.accel + drift, made.dt, "as recorded")
    return [motion, motion.corrected("linear"), motion.corrected("linear", (0.1, 25.0))]


def how_thick() -> mr.Design:
    """The thickness of a wall 4 m high by the code check."""
    site = mr.code_spectrum("NTC 2018", ag=2.06, F0=2.45, Tc=0.33, soil="C")
    thicknesses = [0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
    return mr.design(lambda t: mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), thicknesses, site)


def main(argv: Sequence[str] | None = None) -> None:
    """Draw them."""
    args = cli.parser(__doc__, "first_pictures").parse_args(argv)
    out = cli.folder(args.out)
    plotting.save(plotting.sketch(with_every_effect(), arguments=True), out / "effects.png")
    responses = of_the_tutorial(0.5 if args.quick else 15.0)
    plotting.save(plotting.history(responses, labels=["with the tie", "without the tie"]), out / "tutorial.png")
    for response in responses:
        print(response.message)
    found = how_thick()
    ax = plotting.design(found)
    ax.set_xlabel("thickness [m]")
    plotting.save(ax, out / "design.png")
    print(found.sentence)
    motions = of_a_record()
    plotting.save(plotting.record(motions), out / "record.png")
    for motion in motions:
        print(f"{motion.name}: {motion.residual_velocity:.3f} m/s, {motion.residual_displacement:.2f} m")


if __name__ == "__main__":
    sys.exit(cli.run(main))
