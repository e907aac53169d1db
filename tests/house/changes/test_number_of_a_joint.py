"""A new number of a joint touches two files: its declaration, and the law. It is carried out in a copy of the package.

The number makes joints stiffer as they close: a line of the stiffness k that closes by u presses with k u (1 + s u).
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import mjrock

LAWS = "mjrock/problem/masonry/laws/"
EDITS = {
    LAWS + "dry.py": (
        (
            "    law: OwnLaw | None = None\n",
            '    stiffening: Annotated[float, Within(0, 1e5, "1/m")] = 0.0\n    law: OwnLaw | None = None\n',
        ),
    ),
    LAWS + "joint_law.py": (
        ("    k_excess: Any = 0.0\n", "    k_excess: Any = 0.0\n    stiffening: Any = 0.0\n"),
        (
            'over its depth [N/m], at a depth [m]."""\n    return row.k\n',
            'over its depth [N/m], at a depth [m]."""\n    return row.k * (1.0 + row.stiffening * depth)\n',
        ),
        (
            "    return row.k + row.k_excess\n",
            "    return row.k * (1.0 + 2.0 / 3.0 * row.stiffening * depth) + row.k_excess\n",
        ),
        (
            'with the depth [N/m], at a depth [m]."""\n    return row.k\n',
            'with the depth [N/m], at a depth [m]."""\n    return row.k * (1.0 + 2.0 * row.stiffening * depth)\n',
        ),
        (
            'the largest depth for which the law holds."""\n    return row.k\n',
            'the largest depth for which the law holds."""\n    return row.k * (1.0 + 2.0 * row.stiffening * 1e-3)\n',
        ),
        (
            "    return factor * depth\n",
            "    s = row.stiffening\n"
            "    force = factor * depth * (1.0 + s * depth)\n"
            "    return 2.0 * force / (1.0 + math.sqrt(1.0 + 4.0 * s * force))\n",
        ),
        (
            "    return math.sqrt(factor) * depth\n",
            "    s, at = row.stiffening, math.sqrt(factor) * depth\n"
            "    energy = factor * depth * depth * (0.5 + s * depth / 3.0)\n"
            "    for _ in range(20):\n"
            "        at -= (at * at * (0.5 + s * at / 3.0) - energy) / max(at * (1.0 + s * at), 1e-300)\n"
            "    return at\n",
        ),
    ),
}
"""Texts that the change replaces, by file."""
TRY = r"""
import math, sys, warnings
import mjrock as mr
from dataclasses import replace
from scipy.optimize import brentq

warnings.simplefilter("ignore")
ground = mr.Polygon([(-2, -1), (4, -1), (4, 0), (-2, 0)], fixed=True, name="ground")
block = mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 0.4), (-0.2, 0.4)], density=1000.0, name="block")
K, W, S = 1e8 * 0.4, 160.0 * mr.GRAVITY, 3e5 / 4
rests = lambda s: (math.sqrt(1 + 4 * s * W / K) - 1) / (2 * s)


def masonry(xi=0.0, **more):
    joint = mr.Dry(k_n=1e8, k_s=1e8, friction=0.5, xi=xi, frequency=100.0, stiffening=S, **more)
    return mr.Masonry([ground, block], joints=joint)


def near(found, expected, within):
    assert abs(found / expected - 1) < within, (found, expected)


def refused(call, text):
    try:
        call()
    except ValueError as error:
        assert text in str(error), error
        return
    raise AssertionError(text)


# at rest, and thrown down: depths by the closed form of the spring's energy, and a ledger that closes
u, held = rests(S), lambda d: K * (d * d / 2 + S * d**3 / 3)
case = mr.MasonryCase(masonry(), 0.02, velocity=[[0, -0.05, 0]])
answer = mr.solve_explicit(case, ledger=True, output_step=1e-4)
depth = brentq(lambda d: held(d) - held(u) - W * (d - u) - 0.5 * 160.0 * 0.05**2, u, 1e-2)
near(-answer.pose[0, 0, 1], u, 1e-9)
near(-answer.pose[:, 0, 1].min(), depth, 2e-3)
assert abs(answer.ledger.residual).max() < 5e-3 * 0.2, abs(answer.ledger.residual).max()  # second order in the step
# it slides off its joint, and what is found there has the same law
slid = mr.solve_explicit(mr.MasonryCase(masonry(xi=0.5), 0.6, velocity=[[2.5, 0, 0]]))
assert slid.pose[-1, 0, 0] > 0.5 and "block" in str(slid.fallen or "block")
near(-slid.pose[-1, 0, 1], u, 1e-2)
# functions of the joint, other keywords beside it, and equality
same = mr.Masonry([ground, block], joints=lambda joint: mr.Dry(k_n=1e8, stiffening=S))
assert same.table.further["stiffening"].tolist() == [S]
assert replace(masonry(), friction=0.1).table.further["stiffening"].tolist() == [S]
assert masonry() == masonry() != mr.Masonry([ground, block], joints=replace(mr.Dry(), k_n=1e8))
near(mr.collapse_multiplier(masonry()).multiplier, 0.5, 1e-6)
# what does not know it refuses it by its name
case = mr.MasonryCase(masonry(), 0.02)
refused(lambda: mr.simulate(case), "stiffening of ground|block: MuJoCo knows k_n, xi and friction of a joint")
refused(lambda: mr.rigid_impact(masonry(), [[0, -1, 0]]), "stiffening of ground|block: rigid_impact knows")
refused(lambda: mr.Mortar(mr.Dry(k_s=1e9, stiffening=1.0), mr.Bond(1e5, 1e5, 10.0, 10.0)), "stiffening = 1 is given")
refused(lambda: mr.Dry(stiffening=-1.0), "stiffening = -1 1/m is outside the valid range 0 to 100000 1/m")
answer.save(sys.argv[1])
near(-mr.load(sys.argv[1]).pose[0, 0, 1], u, 1e-9)
assert mr.load(sys.argv[1]).case == answer.case
print("all hold")
"""


def carry_out(root, edits):
    """Make the edits in a checkout."""
    for name, pairs in edits.items():
        path = root / name
        text = path.read_text(encoding="utf-8")
        for old, new in pairs:
            assert text.count(old) == 1, (name, old)
            text = text.replace(old, new)
        path.write_text(text, encoding="utf-8")


@pytest.mark.slow
def test_a_number_of_a_joint_touches_its_declaration_and_its_law(tmp_path):
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(mjrock.__file__).parent, tmp_path / "mjrock", ignore=ignored)
    carry_out(tmp_path, EDITS)
    assert len(EDITS) == 2
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-c", TRY, str(tmp_path / "run.h5")]
    run = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.stdout.endswith("all hold\n"), run.stderr[-2000:]
