"""Thirty small scenes, and a digest of each answer: the same as plain Python and compiled, to the last bit."""

from __future__ import annotations

import hashlib
import json
import sys
import warnings
from collections.abc import Iterator

import numpy as np

import mjrock as mr

K_N = 5e8
WALLS = [mr.Block.from_size(0.6, 4.2), mr.Block.from_size(1.1, 5.0, gable=mr.Gable(1.5))]
RECORD = mr.GroundMotion.synthetic(peak=3.0, duration=1.0, seed=3)
UP = mr.GroundMotion.synthetic(peak=1.5, duration=1.0, seed=4)
EFFECTS = {
    "tie": mr.Tie(height=3.0, stiffness=2e7, slack=1e-3, strength=4e4, ultimate=0.02),
    "thrust": mr.Thrust(height=3.5, force=1e3),
    "load": mr.Load(force=5e3, height=4.0, offset=0.1),
    "mass": mr.AddedMass(mass=800.0, height=4.0),
    "damper": mr.Damper(height=3.0, c=2e4),
    "slider": mr.FrictionDamper(height=3.0, stiffness=1e7, slip_force=2e3),
}


def walls() -> Iterator[tuple[str, str]]:
    """Digests of walls: released, shaken, with each effect, at a fixed step, by theory."""
    for wall in WALLS:
        e = mr.Restitution.from_geometry(wall)
        contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05, k_side=K_N, xi_side=0.012)
        bed = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05, friction=0.4, points=5)
        released = mr.Case(wall, 0.4 * wall.alpha, 0.8)
        shaken = mr.Case(wall, 0.0, 0.6, motion=RECORD.scaled(2.0), vertical=UP, side_stop=False)
        name = f"{2 * wall.h:g} m"
        yield f"{name} released", digest(mr.simulate(released, contacts, ledger=True))
        yield f"{name} shaken", digest(mr.simulate(shaken, contacts))
        yield f"{name} slides", digest(mr.simulate(shaken, bed))
        yield f"{name} fixed", digest(mr.simulate(released, contacts, 2e-4))
        yield f"{name} theory", digest(mr.solve_analytical(released, e))
        yield f"{name} theory, shaken", digest(mr.solve_analytical(mr.Case(wall, 0.0, 0.6, motion=RECORD), e))
    wall = WALLS[0]
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05, k_side=K_N, xi_side=0.012)
    for name, effect in EFFECTS.items():
        case = mr.Case(wall, 0.3 * wall.alpha, 0.6, motion=RECORD, effects=effect)
        yield name, digest(mr.simulate(case, contacts, ledger=True))
    for name in ("tie", "thrust", "load"):
        case = mr.Case(wall, 0.3 * wall.alpha, 0.6, motion=RECORD, effects=EFFECTS[name])
        yield f"{name}, theory", digest(mr.solve_analytical(case, mr.Restitution.from_geometry(wall)))


def masonry() -> Iterator[tuple[str, str]]:
    """Digests of masonry in MuJoCo, in the plane and in space."""
    scenes = {
        "stack": mr.Masonry.stack([WALLS[0]] * 2, K_N),
        "stack by a law": mr.Masonry.stack([WALLS[0]] * 2, K_N, law="CALIBRATED"),
        "column": mr.Masonry.column(width=0.6, height=2.4, drums=3),
        "arch": mr.Masonry.arch(3.0, 0.6, 2.6, voussoirs=5),
        "box": mr.Masonry.box((0.6, 0.4, 2.0), k_n=K_N),
    }
    for name, made in scenes.items():
        shaken = mr.MasonryCase(made, 0.2, motion=RECORD)
        yield f"{name} shaken", digest(mr.simulate(shaken, ledger=True, forces=True))
        if name != "arch":
            yield f"{name} fixed", digest(mr.simulate(shaken, timestep=2e-4))


def digest(answer: mr.Response) -> str:
    """Of times, poses and energies."""
    parts = [answer.t, answer.pose, answer.energy]
    if answer.ledger is not None:
        parts.append(answer.ledger.residual)
    return hashlib.sha256(b"".join(np.ascontiguousarray(part).tobytes() for part in parts)).hexdigest()[:16]


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    json.dump(dict([*walls(), *masonry()]), sys.stdout, indent=1)
