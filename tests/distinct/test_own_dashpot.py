"""A dashpot with a law of its own takes two modules and two lists of names in all solvers: the page on own effects."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mjrock as mr
from mjrock.reference.equations import Wall

PACKAGE = Path(mr.__file__).parent
PAGE = (Path(__file__).parents[2] / "docs" / "own_effect.md").read_text(encoding="utf-8")
TEXTS = dict(re.findall(r"<!-- (\w+).py -->\n```python\n(.*?)```", PAGE, re.DOTALL))
NAME, SPEED, C = "orifice_damper_0", 0.8, 400.0


def written(copy):
    """A copy of the package with the texts of the page, and the name in two lists."""
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy / "problem" / "wall" / "orifice.py").write_text(TEXTS["orifice"])
    law = (copy / "problem" / "wall" / "effect.py").read_text()
    known, own = law[law.index("DASHPOT = ") : law.index("\n\n\nclass Told")], TEXTS["effect"].rstrip()
    for path, old, new in (
        ("problem/wall/effect.py", known, own),
        ("problem/wall/effect.py", "    c: float = 0.0\n", "{}    power: float = 1.0\n"),
        ("problem/wall/effects.py", "from .tie import", "from .orifice import OrificeDamper\n{}"),
        ("problem/wall/effects.py", "FrictionDamper, AddedMass", "FrictionDamper, OrificeDamper, AddedMass"),
        ("__init__.py", "    from .problem.wall.tie", "    from .problem.wall.orifice import OrificeDamper\n{}"),
        ("__init__.py", '"FrictionDamper",', '{} "OrificeDamper",'),
    ):
        text = (copy / path).read_text()
        assert text.count(old) == 1, (path, old)
        (copy / path).write_text(text.replace(old, new.replace("{}", old)))


def check_thrown(solver, **options):
    """A block that is thrown on smooth ground: v = v0 / (1 + c v0 t / m), and the damper takes what it loses."""
    ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True)
    block = mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 0.4), (-0.2, 0.4)], density=1000.0, length=0.4)
    masonry = mr.Masonry([ground, block], k_n=2e8, friction=0.0, frequency=150.0)
    damper = mr.OrificeDamper(0.2, C, 2.0, block=1)
    case = mr.MasonryCase(masonry, 0.1, velocity=[[SPEED, 0, 0]], effects=damper)
    answer = solver(case, ledger=True, forces=True, output_step=2e-3, **options)
    mass, speed = block.mass, answer.velocity[:, 0, 0]
    np.testing.assert_allclose(speed, SPEED / (1 + C * SPEED * answer.t / mass), rtol=0, atol=1e-3 * SPEED)
    np.testing.assert_allclose(answer.forces.links[NAME], C * speed**2, rtol=5e-3)  # of half a step before
    lost = 0.5 * mass * (SPEED**2 - speed[-1] ** 2)
    assert lost > 0.4 * 0.5 * mass * SPEED**2
    assert answer.ledger.dashpots[NAME][-1] == pytest.approx(lost, rel=1e-3)
    assert np.abs(answer.ledger.residual).max() < 1e-3 * lost


def check_wall():
    """A wall by SciPy: force and power of the damper at a state, its work along a motion, and MuJoCo beside it."""
    wall = mr.Block.from_size(0.6, 4.2)
    damped, bare = (
        mr.Case(wall, 0.5 * wall.alpha, 0.6, effects=mr.OrificeDamper(3.0, c, 2.0), side_stop=False) for c in (2e4, 0.0)
    )
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.0)
    one, two = Wall(damped, contacts), Wall(bare, contacts)
    state = one.released() + np.array([0, 0, 0, 0.3, -0.1, -0.4])
    push = (one.free(0.0, state) - two.free(0.0, state))[3:] * (wall.mass, wall.mass, wall.inertia)
    h = 1e-6  # s, over which the length changes by 0.3 um, rounded to 1e-16 m
    before, after = (length_of(wall, state[:3] + way * h * state[3:]) for way in (-1, 1))
    rate = (after - before) / (2 * h)
    assert np.hypot(*push[:2]) == pytest.approx(2e4 * rate**2, rel=1e-6)
    assert push @ state[3:] == pytest.approx(-2e4 * abs(rate) ** 3, rel=1e-6)
    exact = mr.solve_compliant(damped, contacts)
    rates = np.gradient([length_of(wall, pose) for pose in exact.pose[:, 0]], exact.t)
    taken = np.trapezoid(2e4 * np.abs(rates) ** 3, exact.t)
    assert exact.energy[0] - exact.energy[-1] == pytest.approx(taken, rel=1e-3)
    assert taken > 0.02 * exact.energy[0]
    run = mr.simulate(damped, contacts, ledger=True)
    assert mr.compare(exact, run).rms < 1e-3
    assert run.ledger.dashpots[NAME][-1] == pytest.approx(taken, rel=2e-2)
    with pytest.raises(ValueError, match="orifice_damper_0 has power = 2; leave timestep out"):
        mr.simulate(damped, contacts, timestep=1e-4)
    with pytest.raises(ValueError, match="rocking theory has links that only pull"):
        mr.solve_analytical(damped, mr.Restitution.from_geometry(wall))


def length_of(wall, pose):
    """Length of a damper of 5 m at the height of 3 m at a pose of the wall: from its inner face to its anchor [m]."""
    x, z, theta = pose
    px, pz = -wall.b, 3.0 - wall.h
    at = x + px * np.cos(theta) + pz * np.sin(theta), z - px * np.sin(theta) + pz * np.cos(theta)
    return np.hypot(at[0] + wall.b + 5.0, at[1] - pz)


CHECKS = """
import test_own_dashpot as here
here.check_thrown(here.mr.solve_explicit)
here.check_thrown(here.mr.simulate, accuracy=1e-5)
here.check_wall()
print(here.mr.__file__)
"""


def run_apart(folder, program, **environment):
    """Run a program in a process of its own, with the package that stands in a folder."""
    path = os.pathsep.join(map(str, (folder, Path(__file__).parent)))
    setting = os.environ | {"PYTHONPATH": path, "MJROCK_INTERPRET": "0", **environment}
    options = {"env": setting, "cwd": folder, "capture_output": True, "text": True, "check": False}
    done = subprocess.run([sys.executable, "-c", program], **options)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(folder))


@pytest.mark.slow
def test_two_modules_and_two_lists_have_the_law_in_all_solvers(tmp_path):
    """As plain Python; `test_own_device` has the same compiled."""
    written(tmp_path / "mjrock")
    run_apart(tmp_path, CHECKS, NUMBA_DISABLE_JIT="1")
