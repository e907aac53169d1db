"""Write the synthetic records of this folder: python tests/records/synthetic_records.py FOLDER."""

import sys
from pathlib import Path

import numpy as np

import mjrock as mr

FAR = {"far_a": 11, "far_b": 12}
"""Seeds of the records without a pulse."""
NEAR = {"near_a": (21, 1.6), "near_b": (22, 1.1)}
"""Seeds of the records with a pulse, and the period of the pulse [s]."""
START = 3.0
"""Time at which the pulse begins [s]."""


def far(seed: int) -> mr.GroundMotion:
    """Twenty seconds of strong shaking."""
    return mr.GroundMotion.synthetic(6.5, 20.0, seed=seed, dt=0.02)


def near(seed: int, period: float) -> mr.GroundMotion:
    """Weaker shaking and the long pulse of a fault nearby."""
    shaking = mr.GroundMotion.synthetic(5.0, 12.0, seed=seed, dt=0.01)
    pulse = mr.GroundMotion.ricker(4.0, period, antisymmetric=True)
    return mr.GroundMotion(shaking.accel + pulse(shaking.dt * np.arange(len(shaking.accel)) - START), shaking.dt)


def rows(values: np.ndarray, columns: int, form: str) -> str:
    """Numbers in columns of fixed width."""
    lines = (values[i : i + columns] for i in range(0, len(values), columns))
    return "".join("".join(form.format(x) for x in line) + "\n" for line in lines)


def sac(motion: mr.GroundMotion, name: str) -> str:
    """The plain text of a SAC set, cm/s2."""
    head = f"{name}  synthetic, not recorded\n{len(motion.accel):7d}{motion.dt:15.5E}  0  0  0.  0.  0.  0.  0.\n"
    return head + rows(100 * motion.accel, 6, "{:13.5E}")


def at2(motion: mr.GroundMotion, name: str) -> str:
    """PEER AT2, g. A negative number touches the one before it, as it often does in the files of PEER."""
    head = f"SYNTHETIC, NOT RECORDED\n{name}\nACCELERATION TIME SERIES IN UNITS OF G\n"
    head += f"NPTS={len(motion.accel):7d}, DT={motion.dt:9.4f} SEC,\n"
    return head + rows(motion.accel / mr.GRAVITY, 5, "{:14.7E}")


def csv(motion: mr.GroundMotion, name: str) -> str:
    """Columns of time [s] and acceleration [cm/s2]."""
    lines = (f"{motion.dt * i:.2f},{100 * a:.5f}\n" for i, a in enumerate(motion.accel))
    return f"# {name}, synthetic, not recorded\ntime [s],acceleration [cm/s2]\n" + "".join(lines)


def write(folder: Path) -> None:
    """Every record, and the last one in a second format."""
    for name, seed in FAR.items():
        (folder / f"{name}.sac").write_text(sac(far(seed), name))
    (folder / "near_a.sac").write_text(sac(near(*NEAR["near_a"]), "near_a"))
    (folder / "near_b.at2").write_text(at2(near(*NEAR["near_b"]), "near_b"))
    (folder / "near_b.csv").write_text(csv(near(*NEAR["near_b"]), "near_b"))


if __name__ == "__main__":
    write(Path(sys.argv[1]))
