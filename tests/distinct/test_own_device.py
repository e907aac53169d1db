"""A device with a law of its own is one file: the bumper of the page on own effects."""

import importlib.util
import re
import sys
from pathlib import Path

import numpy as np
import pytest
import test_own_dashpot

import mjrock as mr
from mjrock.compiled import Loop
from mjrock.distinct.kinds import lists

PACKAGE = Path(mr.__file__).parent
PAGE = (Path(__file__).parents[2] / "docs" / "own_effect.md").read_text(encoding="utf-8")
TEXTS = dict(re.findall(r"<!-- (\w+).py -->\n```python\n(.*?)```", PAGE, re.DOTALL))
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


EXAMPLES = {"bumpers": ("KINDS", "Bumpers", "Bumper", check)}
"""The examples of the page by their module: the list that names the kind, the kind, what a user writes, the check."""


@pytest.fixture
def listed(request, tmp_path, monkeypatch):
    """What a user writes of an example, whose kind is listed, with the steps as plain Python; and its check."""
    names, kind, effect, check = EXAMPLES[request.param]
    path = tmp_path / f"{request.param}.py"
    path.write_text(TEXTS[request.param])
    spec = importlib.util.spec_from_file_location(f"mjrock.distinct.kinds.{request.param}", path)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, module)
    spec.loader.exec_module(module)
    monkeypatch.setattr(lists, names, (*getattr(lists, names), getattr(module, kind)))
    monkeypatch.setattr(Loop, "__call__", lambda loop, *given: loop.py_func(*given))
    return getattr(module, effect), check


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("listed", EXAMPLES, indirect=True)
def test_a_kind_of_one_file_has_its_force_and_its_energy(listed, in_space):
    effect, check = listed
    check(effect, in_space)


@pytest.mark.slow
def test_the_same_compiled_in_a_package_that_has_the_files(tmp_path):
    """The lists name the kinds; nothing else is written but what a dashpot with a law of its own takes."""
    copy = tmp_path / "mjrock"
    test_own_dashpot.written(copy)
    path = copy / "distinct" / "kinds" / "lists.py"
    text, program = path.read_text(), "import test_own_device as here\n"
    for example, (names, kind, effect, check) in EXAMPLES.items():
        path.with_name(f"{example}.py").write_text(TEXTS[example])
        text = re.sub(rf"^({names}: .* = \(.*)\)$", rf"\1, {kind})", text, count=1, flags=re.MULTILINE)
        text = text.replace(",, ", ", ").replace("from .ties", f"from .{example} import {kind}\nfrom .ties")
        assert text.count(kind) == 2
        program += f"from mjrock.distinct.kinds.{example} import {effect}; here.{check.__name__}({effect}, False)\n"
    path.write_text(text)
    test_own_dashpot.run_apart(tmp_path, program + test_own_dashpot.CHECKS)
