"""A device with a law of its own is one file: the bumper of the page on own effects, at which a block is thrown."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mjrock as mr
from mjrock.distinct import explicit, following, links

PACKAGE = Path(mr.__file__).parent
PAGE = (Path(__file__).parents[2] / "docs" / "own_effect.md").read_text(encoding="utf-8")
TEXT = re.search(r"<!-- bumpers.py -->\n```python\n(.*?)```", PAGE, re.DOTALL)[1]
K, LENGTH, GAP, SPEED = 2e5, 0.3, 0.02, 0.8


def thrown(bumper, in_space):
    """A block of 0.4 m on smooth ground that is thrown at a bumper to its left."""
    if in_space:
        ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True)
        blocks = [ground, mr.Polyhedron.box((0.4, 0.4, 0.4), (0, 0, 0.2), density=1000.0)]
        place, velocity = {"height": 0.2, "at": (-0.2, 0.0, 0.2)}, [[-SPEED, 0, 0, 0, 0, 0]]
    else:
        ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True)
        block = mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 0.4), (-0.2, 0.4)], density=1000.0, length=0.4)
        blocks, place, velocity = [ground, block], {"height": 0.2}, [[-SPEED, 0, 0]]
    masonry = mr.Masonry(blocks, k_n=2e8, friction=0.0, frequency=150.0)
    effect = bumper(k=K, length=LENGTH, gap=GAP, block=1, **place)
    return mr.MasonryCase(masonry, 0.2, velocity=velocity, effects=(effect,), settled=False)


def check(bumper, in_space):
    """The bumper throws the block back as fast; its force is that of its law, and the ledger closes."""
    case = thrown(bumper, in_space)
    answer = mr.solve_explicit(case, ledger=True, forces=True, output_step=1e-3)
    mass, speed, place = case.masonry.blocks[1].mass, answer.velocity[:, 0, 0], answer.pose[:, 0]
    length = np.hypot(LENGTH + GAP + place[:, 0], place[:, 2 if in_space else 1])  # it settles on its joint by 20 um
    short = np.maximum(LENGTH - length, 0.0)
    deepest = (0.5 * mass * SPEED**2 / (0.4 * K)) ** 0.4
    assert speed[-1] == pytest.approx(SPEED, rel=1e-4)
    assert short.max() == pytest.approx(deepest, rel=1e-3)
    np.testing.assert_allclose(answer.forces.links["bumper_0"], -K * short**1.5, rtol=1e-9, atol=1e-6)
    weight = answer.ledger.elastic - 0.4 * K * short**2.5  # what the joint holds
    assert 0 <= weight.min() <= weight.max() < 0.1 * 0.4 * K * deepest**2.5
    assert np.abs(answer.ledger.residual).max() < 2e-3 * 0.5 * mass * SPEED**2
    with pytest.raises(ValueError, match=r"effects\[0\], Bumper: MuJoCo has no row for it; take solve_explicit"):
        mr.simulate(case)


@pytest.fixture
def bumpers(tmp_path, monkeypatch):
    """The module of the page, named among the kinds, with the steps as plain Python."""
    path = tmp_path / "bumpers.py"
    path.write_text(TEXT)
    spec = importlib.util.spec_from_file_location("mjrock.distinct.kinds.bumpers", path)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, module)
    spec.loader.exec_module(module)
    monkeypatch.setattr(links, "KINDS", (*links.KINDS, module.Bumpers))
    monkeypatch.setattr(following, "advance", following.advance.py_func)
    return module


@pytest.mark.parametrize("in_space", [False, True])
def test_a_block_is_thrown_back_by_a_bumper_of_one_file(bumpers, in_space):
    assert explicit.solve_explicit is mr.solve_explicit
    check(bumpers.Bumper, in_space)


@pytest.mark.slow
def test_the_same_compiled_in_a_package_that_has_the_file(tmp_path):
    """The list of kinds names it; nothing else is written."""
    copy = tmp_path / "mjrock"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy / "distinct" / "kinds" / "bumpers.py").write_text(TEXT)
    listed = copy / "distinct" / "links.py"
    text = listed.read_text()
    named = text.replace("Actuators, ConstantForces)", "Actuators, ConstantForces, Bumpers)")
    named = named.replace("from .kinds.dampers", "from .kinds.bumpers import Bumpers\nfrom .kinds.dampers")
    assert named.count("Bumpers") == 2
    listed.write_text(named)
    program = (
        f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); import test_own_device as here;"
        "from mjrock.distinct.kinds.bumpers import Bumper; print(here.mr.__file__); here.check(Bumper, False)"
    )
    setting = os.environ | {"PYTHONPATH": str(tmp_path), "MJROCK_INTERPRET": "0"}
    options = {"env": setting, "cwd": tmp_path, "capture_output": True, "text": True, "check": False}
    done = subprocess.run([sys.executable, "-c", program], **options)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(copy))
