"""Builders return blocks; the class methods of masonry have their arguments and those of masonry."""

import inspect
import math
import re

import pytest

import mjrock as mr
from mjrock.problem.masonry import constructors
from mjrock.problem.masonry.laws.joint_table import JointOptions
from tests.house import stubs

UNIT = (0.4, 0.2)
WALL = mr.Block.from_size(0.5, 2.0, 6.0)
STRIP = mr.HorizontalBending(WALL, thrust=12e3)
BUILT = {
    "arch": ((5.0, (0.9, 0.6)), {"voussoirs": 5, "chords": 2, "ground": True}),
    "barrel_vault": ((3.0, 0.4, 1.0, 0.5), {"courses": 5}),
    "between_floors": ((mr.Block.from_size(0.3, 4.0), 20e3), {}),
    "between_sides": ((STRIP,), {}),
    "box": (((1.0, 2.0, 3.0),), {"density": 1800.0}),
    "bridge": ((3.0, 0.4, 2.0, 5), {"spans": 2, "pier_width": 1.0, "pier_height": 2.0}),
    "column": ((0.5, 2.0, 3), {"sides": 6}),
    "corner": ((0.5, 4.0, 0.5), {}),
    "dome": ((2.0, 0.3, 4, 2), {}),
    "facade": ((2.4, 1.0, 1.0, UNIT), {"gable": 1}),
    "groin_vault": ((2.0, 0.3, 6.0, 1.0), {"courses": 3}),
    "running_bond": ((1.2, 0.4, UNIT), {"halves": mr.Bond(1e5, 2e5, 10.0, 50.0)}),
    "shear_wall": ((1.2, 0.4, UNIT), {"thickness": 0.1}),
    "stack": (([mr.Block.from_size(0.5, 1.0), mr.Block.from_size(0.4, 1.0)],), {"side_stop": True}),
    "wallette": ((1.2, 0.4, UNIT, 0.2), {"leaves": 2}),
}


@pytest.mark.parametrize("name", mr.blocks.__all__)
def test_a_class_method_takes_the_blocks_of_its_builder(name):
    given, options = BUILT[name]
    joints = {"k_s": 1e9, "points": 3, "friction": 0.5}
    made = getattr(mr.Masonry, name)(*given, **options, **joints)
    blocks = getattr(mr.blocks, name)(*given, **options)
    assert made.blocks == tuple(blocks)
    assert made == getattr(mr.Masonry, name)(*given, **options, joints=mr.Dry(1e10, **joints))
    assert mr.Masonry(blocks, **joints).table.k_s.tolist() == made.table.k_s.tolist()


def test_friction_goes_by_the_names_of_smooth_blocks():
    strip = mr.Masonry.between_floors(*BUILT["between_floors"][0], friction=0.4)
    found = {joint.name: value for joint, value in zip(strip.joints, strip.joint_friction, strict=True)}
    assert found == {
        "base|lower": 0.4,
        "lower|upper": 0.4,
        "upper|floor": 10.0,
        "inner_guide|floor": 0.0,
        "outer_guide|floor": 0.0,
    }


def test_signatures_are_those_of_builders_and_of_masonry():
    for name, builder in constructors.BUILDERS.items():
        own = inspect.signature(builder)
        made = inspect.signature(getattr(mr.Masonry, name))
        if name != "stack":
            assert list(made.parameters) == [*own.parameters, "options"], name
            assert made.parameters["options"].annotation == "Unpack[JointOptions]"
            assert inspect.getdoc(getattr(mr.Masonry, name)).startswith(inspect.getdoc(builder).split("\n\nArgs")[0])
        assert not own.parameters.keys() & JointOptions.__annotations__.keys()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mr.Masonry.arch(5.0), "Masonry.arch: missing a required argument: 'thickness'"),
        (lambda: mr.Masonry.arch(5.0, 0.5, frction=1.0), "Masonry.arch does not take frction; did you mean friction?"),
        (lambda: mr.Masonry.arch(5.0, 0.5, radius=5.0), "Masonry.arch: multiple values for argument 'radius'"),
        (lambda: mr.Masonry.arch(5.0, 0.5, math.pi, 5, 2000.0), "Masonry.arch: too many positional arguments"),
        (lambda: mr.blocks.arch(0.001, 0.5), "radius = 0.001 m is outside the valid range 0.01 to 1000 m"),
        (lambda: mr.blocks.dome(0.05, 0.3, 4, 2), "radius = 0.05 m is outside the valid range 0.1 to 1000 m"),
        (lambda: mr.Masonry.from_obj(), "Masonry.from_obj: missing a required argument: 'path'"),
        (lambda: mr.Masonry.from_obj("none.obj", up="w"), "up = 'w' is not one of x, y, z"),
        (lambda: mr.Masonry.from_obj("none.obj"), "path = none.obj: it is not a file"),
    ],
)
def test_refusals_name_the_class_method(call, message):
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        call()


def test_a_section_of_warnings_has_one_entry():
    """Sphinx takes no more."""
    for name in (*constructors.BUILDERS, *constructors.READERS):
        warns = (inspect.getdoc(getattr(mr.Masonry, name)) or "").partition("Warns:\n")[2].partition("\n\n")[0]
        assert len(re.findall(r"^ {4}\w", warns, re.MULTILINE)) <= 1, name


def test_the_stub_is_what_is_made():
    assert stubs.STUB.read_text() == stubs.stub()
