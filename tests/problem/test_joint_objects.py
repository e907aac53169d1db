"""Joints as objects, `Dry` and `Mortar`: the keywords of masonry stand for them, and every builder takes both."""

import dataclasses
import inspect
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.problem.masonry.laws.joint_table import JointOptions
from mjrock.study.campaign.task import fingerprint

ROOT = Path(__file__).parents[2]
BOND = mr.Bond(tension=0.2e6, cohesion=0.3e6, opening_energy=18.0, slip_energy=125.0)
NUMBERS = {"k_n": 2e9, "friction": 0.6, "xi": 0.1, "k_s": 1e9, "frequency": 30.0, "points": 3}
DRY = mr.Dry(**NUMBERS)
MORTAR = mr.Mortar(DRY, BOND)
BLOCK, UNIT = mr.Block.from_size(0.5, 2.0), (0.5, 0.25)
BUILDERS = {
    "__call__": (lambda **options: mr.Masonry([GROUND, box(-0.3, 0.3, 0, 2)], **options), ()),
    "stack": (mr.Masonry.stack, ([BLOCK, BLOCK],)),
    "arch": (mr.Masonry.arch, (5.0, 0.8, 2.0, 5)),
    "bridge": (
        lambda *sizes, **options: mr.Masonry.bridge(*sizes, pier_width=4.0, pier_height=2.0, **options),
        (5.0, 0.8, 2.0, 5),
    ),
    "barrel_vault": (mr.Masonry.barrel_vault, (2.0, 0.3, 2.0, 1.0, 2.0, 5)),
    "groin_vault": (mr.Masonry.groin_vault, (1.5, 0.3, 4.0, 1.0, 2.0, 3)),
    "running_bond": (mr.Masonry.running_bond, (1.0, 0.5, UNIT)),
    "shear_wall": (mr.Masonry.shear_wall, (1.0, 0.5, UNIT)),
    "wallette": (mr.Masonry.wallette, (1.0, 0.5, UNIT, 0.2)),
    "box": (mr.Masonry.box, ((0.4, 0.6, 2.0),)),
    "column": (mr.Masonry.column, (0.5, 2.0, 2)),
    "dome": (mr.Masonry.dome, (2.0, 0.3, 4, 2)),
    "facade": (mr.Masonry.facade, (2.0, 0.5, 1.0, UNIT)),
}


@pytest.fixture(params=BUILDERS)
def build(request):
    """A builder that takes the keywords of joints alone."""
    function, sizes = BUILDERS[request.param]
    return lambda **options: function(*sizes, **options)


@pytest.mark.parametrize(("joints", "more"), [(DRY, {}), (MORTAR, {"bond": BOND})])
def test_keywords_are_the_short_way_to_the_object(build, joints, more):
    one, other = build(joints=joints), build(**NUMBERS, **more)
    assert one == other
    assert fingerprint(one) == fingerprint(other)
    assert repr(one) == repr(other)


def test_the_usual_joint_is_the_dry_one(build):
    assert build(joints=mr.Dry()) == build()


def test_a_function_of_the_joint_gives_what_it_is(build):
    """It gives the same table as functions for each property, and is asked once of each joint."""
    stiff, bonded, requested = mr.Dry(4e9, 0.5, 0.2, 2e9, 50.0, 3), mr.Mortar(DRY, BOND), []

    def kind(joint):
        requested.append(joint)
        return bonded if joint.name.startswith(("ground|", "base|")) else stiff

    masonry = build(joints=kind)
    table, joints = masonry.table, masonry.joints
    assert len(requested) == len(set(requested))
    assert set(joints) <= set(requested)
    wanted = [kind(joint).properties for joint in joints]
    assert table.bonds == tuple(each["bond"] for each in wanted)
    for name in ("k_n", "friction", "xi", "k_s", "frequency"):
        np.testing.assert_array_equal(getattr(table, name), [each[name] for each in wanted])
    np.testing.assert_array_equal(masonry.retardation, [2 * each["xi"] / each["frequency"] for each in wanted])
    assert masonry.points == 3


def test_a_keyword_that_no_joint_has_is_refused_with_the_nearest_one(build):
    with pytest.raises(TypeError, match=r"Masonry.* does not take frction; did you mean friction"):
        build(frction=0.6)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.Masonry.arch(5.0, 0.8, voussoir=9), "Masonry.arch does not take voussoir; did you mean voussoirs"),
        (lambda: mr.Masonry.box((1, 1, 1), rigid=1), "Masonry.box does not take rigid; the valid keywords are size, d"),
        (lambda: mr.Masonry.from_obj("x.obj", grund=True), "Masonry.from_obj does not take grund; did you mean ground"),
        (lambda: mr.Masonry.box((1, 1, 1), k_n=1e10, joints=DRY), "joints is given with k_n, which it says itself"),
        (lambda: mr.Masonry.stack([BLOCK], 1e10, joints=DRY), "joints is given with k_n, which it says itself"),
        (lambda: mr.Masonry.box((1, 1, 1), joints=BOND), r"joints = Bond\(.* of type Bond is not a Dry or Mortar"),
        (lambda: mr.Masonry.box((1, 1, 1), joints=lambda j: 3), r"joints of ground\|block = 3 .* is not a Dry or Mo"),
        (lambda: mr.Masonry.box((1, 1, 1), joints=len), "joints = .* is not called as joints"),
        (
            lambda: mr.Masonry.column(0.5, 2.0, 2, joints=lambda j: mr.Dry(points=99 if "ground" in j.name else 2)),
            r"points of ground\|drum_0 = 99 is outside the valid range 2 to 50",
        ),
        (
            lambda: mr.Masonry.column(0.5, 2.0, 2, points=lambda j: 2.5),
            r"points of ground\|drum_0 = 2.5 is not a whole number",
        ),
        (lambda: mr.Masonry.box((1, 1, 1), joints=mr.Dry(points=51)), "points = 51 is outside the valid range 2 to 50"),
        (lambda: mr.Dry(k_n=1e3), r"k_n = 1000 N/m3 is outside the valid range 10000 to 1e\+14 N/m3"),
        (lambda: mr.Dry(k_n=None), "k_n = None is not a real number"),
        (lambda: mr.Dry(friction=-0.1), "friction = -0.1 is outside the valid range 0 to 10"),
        (lambda: mr.Dry(xi=np.nan), "xi = nan is outside the valid range 0 to 100"),
        (lambda: mr.Dry(k_s=1.0), "k_s = 1 N/m3 is outside"),
        (lambda: mr.Dry(frequency=0.0), "frequency = 0 rad/s is outside the valid range 0.001 to"),
        (lambda: mr.Dry(points=2.5), "points = 2.5 is not a whole number; the valid range is 2 to 1000"),
        (lambda: mr.Dry(lambda joint: 1e9), "k_n = .* is not a real number"),
        (lambda: mr.Mortar(1e9, BOND), "dry = .* is not a Dry"),
        (lambda: mr.Mortar(DRY, None), "bond = None is not a Bond"),
        (lambda: mr.Mortar(mr.Dry(k_s=1e9), BOND), "points = 2, and the joint has a bond: .* valid range is 3 or more"),
        (lambda: mr.Mortar(mr.Dry(points=3), BOND), "bond of the joint: k_s = None, and a bond needs a shear stiffnes"),
        (
            lambda: mr.Mortar(DRY, dataclasses.replace(BOND, residual_friction=0.7)),
            "residual_friction of the joint = 0.7 is outside the valid range 0 to 0.6",
        ),
        (
            lambda: mr.Mortar(DRY, mr.BONDS["clay brick, SAFEGO"]),
            r"bond of the joint: its spring of k_n = 2e\+09 N/m3 gives back more than crushing takes; the valid range",
        ),
    ],
)
def test_what_cannot_be_is_refused_by_name(call, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        call()


def test_they_are_values():
    assert repr(DRY) == "Dry(k_n=2e+09, friction=0.6, xi=0.1, k_s=1e+09, frequency=30, points=3)"
    assert repr(mr.Dry()) == "Dry(k_n=1e+10, friction=0.7, xi=0.05, points=2)"
    assert repr(MORTAR) == f"Mortar({DRY!r}, Bond(tension=200000, cohesion=300000))"
    for each in (DRY, MORTAR):
        assert pickle.loads(pickle.dumps(each)) == each
        assert len({each, dataclasses.replace(each)}) == 1
        with pytest.raises(dataclasses.FrozenInstanceError):
            each.points = 3
    assert dataclasses.replace(DRY, k_n=1e9) != DRY
    assert fingerprint(DRY) != fingerprint(dataclasses.replace(DRY, friction=0.5))


def test_masonry_of_objects_is_a_task_and_can_be_changed():
    masonry = mr.Masonry.column(0.5, 2.0, 2, joints=MORTAR)
    assert pickle.loads(pickle.dumps(masonry)) == masonry
    assert dataclasses.replace(masonry, bond=None) == mr.Masonry.column(0.5, 2.0, 2, joints=DRY)
    chosen = mr.Masonry.column(0.5, 2.0, 2, joints=lambda joint: mr.Dry(1e9))
    assert dataclasses.replace(chosen, friction=0.1).table.friction.tolist() == [0.1, 0.1]
    assert dataclasses.replace(chosen, friction=0.1).table.k_n.tolist() == [1e9, 1e9]


def test_a_law_takes_the_place_of_xi_and_leaves_the_rest():
    given = {"k_n": 5e8, "friction": 0.6}
    one = mr.Masonry.stack([BLOCK], **given, law="CALIBRATED")
    other = mr.Masonry.stack([BLOCK], joints=mr.Dry(**given), law="CALIBRATED")
    assert one == other
    e = mr.Restitution.from_geometry(BLOCK)
    base = mr.Contacts.from_law(BLOCK, e, 5e8, law="CALIBRATED").base
    assert one.table.xi.tolist() == pytest.approx([base.xi])
    assert one.table.frequency.tolist() == pytest.approx([base.frequency])
    with pytest.raises(ValueError, match="frequency = 30 rad/s is given with a law, which has its own; leave it"):
        mr.Masonry.stack([BLOCK], joints=DRY, law="CALIBRATED_BED")


@pytest.mark.parametrize("frequency", [None, 40.0])
def test_a_side_stop_beside_joints_that_a_function_gives(frequency):
    dry = mr.Dry(5e8, 0.6, frequency=frequency)
    given = {"side_stop": True, "k_side": 1e9, "side_friction": 0.2}
    one, other = (mr.Masonry.stack([BLOCK], joints=each, **given) for each in (dry, lambda joint: dry))
    assert one.table.k_n.tolist() == other.table.k_n.tolist() == [5e8, 1e9]
    assert one.table.friction.tolist() == other.table.friction.tolist() == [0.6, 0.2]
    np.testing.assert_array_equal(one.retardation, other.retardation)
    bare = mr.Masonry.stack([BLOCK], joints=dry).retardation[0]
    assert one.retardation.tolist() == pytest.approx([bare, bare])


def test_halves_divide_the_units_of_walls_of_mortar():
    inner = dataclasses.replace(BOND, tension=2e6)
    one, other = (
        mr.Masonry.running_bond(1.0, 0.5, UNIT, halves=inner, joints=each) for each in (MORTAR, lambda joint: MORTAR)
    )
    assert one.table.bonds == other.table.bonds
    assert set(one.table.bonds) == {BOND, inner}
    assert one == mr.Masonry.running_bond(1.0, 0.5, UNIT, halves=inner, bond=BOND, **NUMBERS)


def test_joints_whose_frequency_differs():
    masonry = mr.Masonry.column(0.5, 2.0, 2, joints=lambda j: mr.Dry(frequency=50.0 if "ground" in j.name else None))
    lowest = 0.1 / mr.Masonry.column(0.5, 2.0, 2).retardation[0]
    assert masonry.retardation.tolist() == pytest.approx([0.1 / 50.0, 0.1 / lowest])


def test_the_typed_keywords_are_those_of_masonry():
    own = set(inspect.signature(mr.Masonry).parameters) - {"blocks"}
    assert own == set(JointOptions.__annotations__)
    assert {each.name for each in dataclasses.fields(mr.Masonry)} == own - {"joints"} | {"blocks"}
    takers = [name for name, member in inspect.getmembers(mr.Masonry, inspect.ismethod) if name[0] != "_"]
    assert {"stack", "arch", "dome", "from_dxf"} <= set(takers)
    for name in takers:
        assert inspect.signature(getattr(mr.Masonry, name)).parameters["options"].annotation.startswith("Unpack[")


TYPED = """
import mjrock as mr
unit = (0.5, 0.25)
mr.Masonry.running_bond(1.0, 0.5, unit, joints=mr.Dry(k_n=1e9), tolerance=1e-4)
mr.Masonry.arch(5.0, 0.5, k_n=lambda joint: 1e9, law=None)
mr.Masonry.running_bond(1.0, 0.5, unit, frction=0.6)
mr.Masonry.arch(5.0, 0.5, friction="rough")
mr.Masonry.dome(2.0, 0.3, 4, 2, joints=3)
mr.Masonry.from_dxf("wall.dxf", kn=1e9)
mr.Masonry.stack([mr.Block(0.3, 2.0)], 1e9, bond=0.2e6)
mr.Masonry([], friktion=0.6)
mr.Dry(stiffness=1e9)
"""
WRONG = {6: "frction", 7: "friction", 8: "joints", 9: "kn", 10: "bond", 11: "friktion", 12: "stiffness"}
"""Lines of the text above that a type checker refuses, and what they name."""


@pytest.mark.slow
def test_a_type_checker_refuses_a_wrong_keyword(tmp_path):
    (tmp_path / "typed.py").write_text(TYPED)
    command = [sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", tmp_path / "typed.py"]
    message = subprocess.run(command, cwd=ROOT, capture_output=True, text=True).stdout.splitlines()
    errors = {int(line.split(":")[1]): line for line in message if "typed.py:" in line and ": error:" in line}
    assert sorted(errors) == sorted(WRONG), message
    for number, name in WRONG.items():
        assert f'"{name}"' in errors[number], errors[number]
