"""Assessments that are made in Python are written as files, from which the same is read; or refused by name."""

import dataclasses

import numpy as np
import pytest

import mjrock as mr
from mjrock.assessment.assessment import Assessment
from mjrock.assessment.declarations import makers_of
from mjrock.assessment.mechanisms import Mechanism
from mjrock.assessment.running import Shaking

SLV, SLC = (
    mr.code_spectrum("NTC 2018", ag=ag, F0=2.45, Tc=Tc, soil="C", topography="T2")
    for ag, Tc in ((2, 0.33), (2.6, 0.34))
)
FLOOR = {"period": [0.2, 0.1], "participation": [1.2, -0.3], "height": [0.5, 0.2]}
FACADE = mr.Block.from_size(
    0.5, 7.5, 8.0, 1900.0, openings=[mr.Opening(1.6, 2.6), mr.Opening(1, 1, 4.2, round=True)], gable=mr.Gable(2.5)
)
OF_BAR = {"plate": 0.3, "thickness": 0.5, "shear_strength": 30e3, "compressive_strength": 1.5e6, "ultimate": 0.03}
TIE = mr.Tie.of_bar(6.8, 0.016, 235e6, 6.0, **OF_BAR)
WEDGES = mr.Wedge(0.3, 0.3, 5.0).behind(FACADE)
CONTACTS = mr.Contacts.from_damping(FACADE, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.01)
SHAKING = Shaking(
    (mr.GroundMotion.sine(2.0, 0.5), mr.GroundMotion([0.0, 1 / 3, -2.0, 0.0], 0.01, "mine", {"STREAM": "NS"})),
    "explicit",
    False,
    {"timestep": 1e-4},
    mr.Restitution.from_geometry(FACADE),
    CONTACTS,
    {"limit_state": "SLC", "natural": False},
)
BLOCKS = [
    mr.Polygon([(-0.5, -0.5), (1.5, -0.5), (1.5, 0), (-0.5, 0)], fixed=True, name="ground"),
    mr.Polygon([(0, 0), (1, 0), (1, 1 / 3), (0, 1 / 3)], name="stone"),
]
DRIVEN = mr.MasonryCase(
    mr.Masonry(BLOCKS, k_n=5e9, k_s=2e9, points=3),
    effects=(
        mr.Actuator("stone", (0, 0.3), 1, ([0, 2], [0, 0.008]), 2e7, guided="upright"),
        mr.Load(2e3, at=(0.5, 0.3), block="stone"),
    ),
    supports={"ground": ([0, 1], [0, 0.005], [0, 0])},
    velocity=[[0.1, 0.0, 0.0]],
)
ROUND = {
    "wall": Mechanism(mr.Case(FACADE, effects=(TIE, *WEDGES)), {"SLV": SLV, "SLC": SLC}, {"confidence_factor": 1.2}),
    "wedges before": Mechanism(mr.Case(FACADE, effects=(*WEDGES, mr.AddedMass(900.0, 7.3, -0.1))), SLV),
    "half sizes": Mechanism(mr.Case(mr.Block(0.1, 1 / 3, inset=0.01, profile=None)), SLV),
    "profile": Mechanism(
        mr.Case(mr.Block.from_size(0.6, 9.0, profile=[(0, 0.6), (3, 0.6), (3, 0.45), (9, 0.45)], plumb="outer")), SLV
    ),
    "on a floor": Mechanism(
        mr.Case(FACADE), {"SLV": SLV.at_height(**FLOOR), "SLC": SLC.at_height(**FLOOR)}, {"elastic_period": 0.1}
    ),
    "points": Mechanism(mr.Case(FACADE), mr.PointSpectrum([0, 0.2, 2.0], [1.0, 2.5, 0.5], 0.03)),
    "EC8": Mechanism(mr.Case(FACADE), mr.code_spectrum("EC8 type 2", ag=1.0, soil="B")),
    "runs": Mechanism(mr.Case(FACADE, 0.001, 3.0), None, shaking=SHAKING),
    "in MuJoCo": Mechanism(
        mr.Case(FACADE), None, shaking=dataclasses.replace(SHAKING, solver="MuJoCo", options={"accuracy": 1e-4})
    ),
    "motion": Mechanism(
        mr.Case(FACADE, motion=mr.GroundMotion([0.0, 1.0, 0.0], 0.1), side_stop=mr.SideStop(5.0)), None
    ),
    "two-sided": Mechanism(mr.Case(mr.Block.from_size(0.5, 4.0), -0.01, side_stop=False, omega0=0.1), None),
    "corner": Mechanism(
        mr.Corner(0.5, 4.0, 0.5, effects=(mr.Thrust(4.0, 1e3), mr.Tie(3.8, 1e7, strength=1e4, ultimate=0.03))), SLV
    ),
    "vertical bending": Mechanism(
        mr.VerticalBending(mr.Block.from_size(0.3, 4.0), 20e3, bearing=0.1, effects=mr.Load(1e3, 2.0)), SLV
    ),
    "horizontal bending": Mechanism(mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), 12e3, crack=2.0), SLV),
    "driven blocks": Mechanism(DRIVEN, SLV, curve={"to": 0.1, "direction": -1.0}),
    "tilted": Mechanism(mr.MasonryCase(mr.Masonry(BLOCKS), tilt=([0, 1], [0, 0.1])), None),
}
BUILT = {
    "arch": lambda: mr.Masonry.arch(5.0, (0.9, 0.7), voussoirs=10, chords=2),
    "barrel_vault": lambda: mr.Masonry.barrel_vault(2.0, 0.3, 1.5, 0.5, courses=5),
    "stack": lambda: mr.Masonry.stack([mr.Block.from_size(0.6, 2.6)] * 2, law="CALIBRATED"),
    "running_bond": lambda: mr.Masonry.running_bond(2.0, 1.0, (0.5, 0.25)),
    "column": lambda: mr.Masonry.column((0.5, 0.4), 2.0, 3, sides=6),
    "box": lambda: mr.Masonry.box((1.0, 1.0, 2.0), pairs=mr.Dry(friction=0.5)),
    "facade": lambda: mr.Masonry.facade(2.0, 0.75, 1.0, (0.5, 0.25)),
    "dome": lambda: mr.Masonry.dome(3.0, 0.3, 6, 3),
    "groin_vault": lambda: mr.Masonry.groin_vault(2.0, 0.5, 4.5, 2.0, courses=3),
    "groin_vault, cut": lambda: mr.Masonry.groin_vault(2.0, 0.5, 4.5, 2.0, courses=4, cut=True),
    "bridge": lambda: mr.Masonry.bridge(2.0, 0.3, voussoirs=5, spans=2, pier_width=0.8, pier_height=1.0),
    "shear_wall": lambda: mr.Masonry.shear_wall(0.8, 0.4, (0.2, 0.1), thickness=0.1),
    "wallette": lambda: mr.Masonry.wallette(0.4, 0.2, (0.2, 0.1), 0.2, leaves=2, headers=2),
    "mortar": lambda: mr.Masonry.running_bond(
        1.0, 0.5, (0.5, 0.25), joints=mr.Mortar(mr.Dry(k_s=4e9, points=3), mr.Bond(1e5, 2e5, 10.0, 50.0))
    ),
}
REFUSED = {
    "corner": lambda: mr.Masonry.corner(0.5, 4.0),
    "between_floors": lambda: mr.Masonry.between_floors(mr.Block.from_size(0.3, 3.0), 20e3, bearing=0.1),
    "between_sides": lambda: mr.Masonry.between_sides(
        mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), thrust=12e3)
    ),
}
"""Builders whose joints have a friction by their names, which is a function."""
TEXTS = {"language": "it", "project": {"project": 'Casa "rossa"'}, "texts": {"title": "Prova", "notes": "a: b"}}


@pytest.fixture(scope="module")
def mechanisms():
    """All of them, with those of builders."""
    return ROUND | {f"of {name}": Mechanism(mr.MasonryCase(make(), 5.0), None) for name, make in BUILT.items()}


@pytest.mark.parametrize("name", [*ROUND, *(f"of {name}" for name in BUILT)])
def test_what_is_made_in_python_is_read_again_as_it_was(name, mechanisms, tmp_path):
    for own in ("", "a [b].c"):
        made = Assessment({own: mechanisms[name]}, **TEXTS)
        text = made.to_toml(tmp_path / "made.toml")
        read = mr.from_toml(tmp_path / "made.toml")
        assert read == made
        assert read.to_toml() == text


def test_every_builder_is_written_or_refused():
    """Those that read a file of a drawing are `Masonry` of its blocks."""
    builders = {name for name in makers_of(mr.Masonry) if name and not name.startswith("from_")}
    assert {name.partition(",")[0] for name in BUILT} - {"mortar"} | set(REFUSED) == builders


def test_all_at_once_have_the_same_checks(mechanisms):
    made = Assessment(mechanisms)
    read = mr.from_toml(text=made.to_toml())
    assert read == made
    assert list(read.mechanisms) == list(mechanisms)
    for name in ("wall", "on a floor", "points", "corner", "vertical bending"):
        assert read.mechanisms[name].check().table() == mechanisms[name].check().table()
    one, other = (each.mechanisms["runs"].analyses()[1].solve() for each in (read, made))
    np.testing.assert_array_equal(one.theta, other.theta)


def test_another_number_makes_another_assessment():
    one, other = (Assessment({"": Mechanism(mr.Corner(0.5, height), SLV)}) for height in (4.0, np.nextafter(4.0, 5.0)))
    assert one != other
    assert mr.from_toml(text=other.to_toml()) == other


def test_a_file_that_was_changed_in_python_is_written_as_it_is_now():
    text = "[wall]\nthickness = '50 cm'\nheight = 4.0\n"
    read = mr.from_toml(text=text)
    assert "50 cm" in read.to_toml()
    wall = mr.Block.from_size(0.6, 4.0)
    changed = dataclasses.replace(read, mechanisms={"": Mechanism(mr.Case(wall))}, language="it")
    assert mr.from_toml(text=changed.to_toml()) == changed
    assert mr.from_toml(text=changed.to_toml()).mechanisms[""].problem.block == wall


@pytest.mark.parametrize("make", ["corner", "between_sides"])
def test_a_file_that_names_a_builder_keeps_it(make):
    of = "thickness = 0.5\nheight = 4.0\nangle = 0.3" if make == "corner" else ""
    of = of or "[masonry.bending]\nthrust = 12e3\n[masonry.bending.wall]\nthickness = 0.5\nheight = 2.0\nlength = 6.0"
    read = mr.from_toml(text=f"kind = 'MasonryCase'\n[masonry]\nmake = '{make}'\n{of}\n")
    assert f'make = "{make}"' in read.to_toml()


WALL = mr.Case(FACADE)


@pytest.mark.parametrize(
    ("mechanism", "message"),
    [
        (
            Mechanism(mr.MasonryCase(mr.Masonry(BLOCKS, friction=lambda joint: 0.5))),
            "masonry.friction is a function, for which a file has no words; give a number, a text or a table",
        ),
        *((Mechanism(mr.MasonryCase(make())), "masonry.friction is a function") for make in REFUSED.values()),
        (Mechanism(WALL, lambda T, xi: 0.1), "site = <function .* is no spectrum of a code and no PointSpectrum"),
        (Mechanism(WALL, mr.GroundMotion.sine(1.0, 1.0)), "site = <GroundMotion .* is no spectrum of a code"),
        (
            Mechanism(WALL, {"SLV": SLV.at_height(**FLOOR), "SLC": SLC.at_height([0.2])}),
            "floor differs between limit states, and a file has one for all",
        ),
        (
            Mechanism(WALL, SLV.at_height([0.2]), shaking=Shaking((mr.GroundMotion.sine(1.0, 1.0),))),
            "records are those of the floor, and a file has those of the ground",
        ),
        (
            Mechanism(mr.limit_curve(mr.Masonry(BLOCKS), 1, poses=3)),
            "problem = <LimitCurve.* is not one of Case, Corner, V",
        ),
        (Mechanism(WALL, options={"colour": 3}), "check.colour = 3 of type int is no key of a file; leave it out"),
        (
            Mechanism(WALL, shaking=Shaking((mr.GroundMotion.sine(1.0, 1.0),))),
            r"mechanism: its shaking is .*e=None.*; a file gives .*e=Restitution",
        ),
        (
            Mechanism(mr.Case(FACADE, motion=mr.GroundMotion.pieces([(0.3, 2.0), (0.6, -1.0)]))),
            "mechanism: its problem is <Case .*2 pieces",
        ),
        (
            Mechanism(mr.Case(FACADE, effects=WEDGES[:1])),
            "mechanism: its problem is <Case .*WedgeMass>; a file gives <Case .*WedgeMass, WedgeMass>",
        ),
    ],
)
def test_what_a_file_has_no_words_for_is_refused_by_name(mechanism, message):
    with pytest.raises(mr.AssessmentError, match=message):
        Assessment({"": mechanism}).to_toml()
