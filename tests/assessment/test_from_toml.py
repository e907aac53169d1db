"""Files as the objects that their tables stand for: the same verdicts as from Python, to the last bit."""

import subprocess
import sys
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.wall.effect import CombinedEffect, Effect
from mjrock.quantities import Within

SITE = """
[site]
code = "NTC 2018"
soil = "C"
[site.SLV]
ag = "0.21 g"
F0 = 2.45
Tc = 0.33
[site.SLC]
ag = "0.27 g"
F0 = 2.47
Tc = 0.34
"""
DEMAND = {
    "SLV": mr.code_spectrum("NTC 2018", ag=0.21 * mr.GRAVITY, F0=2.45, Tc=0.33, soil="C"),
    "SLC": mr.code_spectrum("NTC 2018", ag=0.27 * mr.GRAVITY, F0=2.47, Tc=0.34, soil="C"),
}
WALL = """
[wall]
thickness = "50 cm"
height = 7.5
length = 8
density = 1900
gable = { height = 2.5 }
[[wall.openings]]
width = "160 cm"
height = 2.6
[[wall.openings]]
width = 1.0
height = 1.0
sill = 4.2
round = true
"""
GABLE = mr.Block.from_size(
    0.5,
    7.5,
    8.0,
    1900.0,
    openings=[mr.Opening(1.6, 2.6), mr.Opening(1.0, 1.0, 4.2, round=True)],
    gable=mr.Gable(2.5),
)
EFFECTS = """
[[effects]]
kind = "AddedMass"
mass = "9 kN"
height = 7.3
offset = -0.10
[[effects]]
kind = "Tie"
make = "of_bar"
height = 6.8
diameter = "16 mm"
yield_stress = "235 MPa"
length = 6.0
plate = "30 cm"
thickness = 0.5
shear_strength = "30 kPa"
compressive_strength = "1.5 N/mm2"
ultimate = 0.03
[[effects]]
kind = "Wedge"
angle = "15 deg"
thickness = "30 cm"
height = 5.0
"""


def effects():
    masonry = {"thickness": 0.5, "shear_strength": 30e3, "compressive_strength": 1.5e6}
    tie = mr.Tie.of_bar(6.8, 0.016, 235e6, 6.0, plate=0.3, ultimate=0.03, **masonry)
    wedges = mr.Wedge(np.radians(15.0), 0.3, 5.0).behind(GABLE)
    return mr.AddedMass(9e3 / mr.GRAVITY, 7.3, -0.1), tie, *wedges


def same(one, other):
    assert [(v.what, v.demand, v.capacity) for v in one.verdicts] == [
        (v.what, v.demand, v.capacity) for v in other.verdicts
    ]
    assert one.table() == other.table()


def test_a_wall_with_openings_and_effects_is_checked_as_from_python():
    assessment = mr.from_toml(text=f"[check]\nconfidence_factor = 1.2\n{SITE}{WALL}{EFFECTS}")
    assert assessment.mechanisms[""].problem == mr.Case(GABLE, effects=effects())
    same(assessment.check()[""], mr.mechanism_check(mr.Case(GABLE, effects=effects()), DEMAND, confidence_factor=1.2))


def test_a_profile_has_units():
    """The façade with a setback inside, as one writes it."""
    rows = '[["0 m", "60 cm"], ["7 m", "600 mm"], [7, 0.45], ["10.5 m", "45 cm"]]'
    text = f'[wall]\nthickness = "60 cm"\nheight = 10.5\nplumb = "outer"\nprofile = {rows}\n'
    profile = ((0, 0.6), (7, 0.6), (7, 0.45), (10.5, 0.45))
    assert mr.from_toml(text=text).mechanisms[""].problem.block == mr.Block.from_size(
        0.6, 10.5, profile=profile, plumb="outer"
    )
    with pytest.raises(
        mr.AssessmentError, match=r"wall\.profile\[2\]\[1\] = 45 m is outside the valid range 0.001 to 20"
    ):
        mr.from_toml(text=text.replace("[7, 0.45]", "[7, 45]"))


def test_a_decimal_comma_has_its_remedy():
    for given in ("0,45 m", "45,5 cm", "0,45"):
        with pytest.raises(
            mr.AssessmentError, match=rf"wall.thickness = '{given}' has a comma; the decimal mark is a poi"
        ):
            mr.from_toml(text=f'[wall]\nthickness = "{given}"\nheight = 3.0\n')


def test_a_case_needs_no_release_and_no_duration():
    case = mr.Case(GABLE)
    assert (case.theta0, case.duration) == (0.0, 10.0)


SEVERAL = f"""
language = "it"
[project]
project = "Sala parrocchiale"
client = "Parrocchia"
{SITE}
[floor]
period = 0.22
participation = 1.2
[[effects]]
kind = "Thrust"
height = 2.3
force = "1.5 kN"
[mechanisms.whole]
floor = false
{WALL.replace("[wall]", "[mechanisms.whole.wall]").replace("[[wall", "[[mechanisms.whole.wall")}
[[mechanisms.whole.effects]]
kind = "Load"
force = 9e3
height = 7.3
[mechanisms.top.floor]
height = 0.67
[mechanisms.top.wall]
thickness = 0.5
height = 2.5
length = 8
[mechanisms.top.wall.gable]
height = 2.5
[mechanisms."between floors"]
kind = "VerticalBending"
load = "60 kN"
bearing = 0.15
effects = false
[mechanisms."between floors".floor]
height = 0.5
[mechanisms."between floors".wall]
thickness = 0.3
height = 3.0
"""


def test_mechanisms_share_what_stands_at_the_top():
    assessment = mr.from_toml(text=SEVERAL)
    assert list(assessment.mechanisms) == ["whole", "top", "between floors"]
    assert (assessment.language, assessment.project["client"]) == ("it", "Parrocchia")
    thrust = mr.Thrust(2.3, 1.5e3)
    whole = mr.Case(GABLE, effects=(thrust, mr.Load(9e3, 7.3)))
    top = mr.Case(mr.Block.from_size(0.5, 2.5, 8.0, gable=mr.Gable(2.5)), effects=(thrust,))
    bending = mr.VerticalBending(mr.Block.from_size(0.3, 3.0), 60e3, bearing=0.15)

    def above(height):
        return {name: one.at_height(0.22, participation=1.2, height=height) for name, one in DEMAND.items()}

    checks = assessment.check()
    for name, expected in (
        ("whole", mr.mechanism_check(whole, DEMAND)),
        ("top", mr.mechanism_check(top, above(0.67))),
        ("between floors", mr.mechanism_check(bending, above(0.5))),
    ):
        same(checks[name], expected)


def test_masonry_of_blocks_is_made_by_its_builder():
    text = """
kind = "MasonryCase"
[masonry]
make = "stack"
k_n = "1 N/mm3"
[[masonry.blocks]]
thickness = 0.6
height = 1.2
[[masonry.blocks]]
thickness = 0.5
height = 1.0
[[effects]]
kind = "Load"
block = "block_1"
force = "2 kN"
height = 2.2
[limit_curve]
poses = 20
[site]
code = "EC8 type 1"
ag = 1.0
soil = "A"
"""
    assessment = mr.from_toml(text=text)
    blocks = [mr.Block.from_size(0.6, 1.2), mr.Block.from_size(0.5, 1.0)]
    stack, load = mr.Masonry.stack(blocks, k_n=1e9), mr.Load(2e3, 2.2, block=2)
    assert assessment.mechanisms[""].problem == mr.MasonryCase(stack, effects=(load,))
    demand = mr.code_spectrum("EC8 type 1", ag=1.0, soil="A")
    same(assessment.check()[""], mr.mechanism_check(mr.limit_curve(stack, effects=(load,), poses=20), demand))


WRONG = (
    (
        'thickness = "50 cm"',
        'thickness = "50 kg"',
        "wall.thickness = '50 kg' has the unit kg, and a number in m is due",
    ),
    ("length = 8", "lenght = 8", "wall.lenght is not known; did you mean length or height?"),
    ("density = 1900", "density = -1900", "wall.density = -1900 kg/m3 is outside the valid range 100 to 30000 kg/m3"),
    ("height = 7.5", "height = nan", "wall.height = nan m is outside the valid range 0.01 to 200 m"),
    ("height = 7.5", 'height = "7,5 m"', "wall.height = '7,5 m'"),
    ('kind = "Wedge"', 'kind = "Wedges"', "effects[2].kind = 'Wedges' of type str is not known; did you mean 'Wedge'?"),
    ('make = "of_bar"', 'make = "of_rod"', "effects[1].make = 'of_rod'"),
    ("sill = 4.2", "sill = true", "wall.openings[1].sill = True of type bool is not a real number"),
    ("round = true", "round = 1.0", "round"),
    ("height = 5.0", "height = 8.0", "effects[2]"),
    ('ag = "0.21 g"', "ag = 0.21", None),
    ('soil = "C"', 'soil = "F"', "site.soil = 'F' is not one of A, B, C, D, E"),
)


@pytest.mark.parametrize(("right", "wrong", "complaint"), WRONG, ids=[wrong for _, wrong, _ in WRONG])
def test_an_error_names_the_line_of_its_key(right, wrong, complaint):
    text = f"{SITE}{WALL}{EFFECTS}"
    assert text.count(right) == 1 or right == "height = 7.5"
    line = text[: text.index(right)].count("\n") + 1
    text = text.replace(right, wrong, 1)
    if complaint is None:
        mr.from_toml(text=text)
        return
    with pytest.raises(mr.AssessmentError) as error:
        mr.from_toml(text=text)
    fault = error.value.faults[0]
    assert complaint in fault.message
    assert fault.line == line


def test_all_that_is_wrong_is_told_at_once(tmp_path):
    path = tmp_path / "parete è.toml"
    path.write_text(f"{SITE}{WALL}".replace("length = 8", "length = 0").replace("sill = 4.2", "sil = 4.2"))
    with pytest.raises(ValueError, match="length") as error:
        mr.from_toml(path)
    assert str(error.value).splitlines() == [
        f"{path}:17: wall.length = 0 m is outside the valid range 0.001 to 1000 m",
        f"{path}:26: wall.openings[1].sil is not known; did you mean sill?",
    ]


def test_what_is_missing_is_named_with_its_table():
    with pytest.raises(mr.AssessmentError, match=r"wall has no height; it takes a number of 0.01 to 200 m"):
        mr.from_toml(text="[wall]\nthickness = 0.5")
    with pytest.raises(mr.AssessmentError, match="has no site, which a check is against"):
        mr.from_toml(text="[wall]\nthickness = 0.5\nheight = 3").check()


def test_the_range_of_the_code_counts_too():
    text = f"[check]\nconfidence_factor = 2\n{SITE}{WALL}"
    with pytest.raises(mr.AssessmentError, match=r"^line 2: check.confidence_factor: .* range 1 to 1.35 by NTC 2018"):
        mr.from_toml(text=text)


@dataclass(frozen=True, repr=False)
class Brace(mr.Tie):
    """A tie of a test, with a further number.

    Args:
        number: how many [-], 1 to 9.
    """

    number: Annotated[int, Within(1, 9, whole=True)] = field(default=1, kw_only=True)


@dataclass(frozen=True)
class Buttress(CombinedEffect):
    """What holds a wall of a test as two ties do.

    Args:
        height: of the upper one [m], 0 to 9.
    """

    height: Annotated[float, Within(0, 9, "m")]

    def on(self, wall):
        return mr.Tie(self.height, 1e7), mr.Tie(self.height / 2, wall.density * 1e4)


def test_a_class_of_a_user_is_in_the_file_the_day_it_exists():
    text = f"{SITE}{WALL}[[effects]]\nkind = 'Brace'\nheight = 3.0\nstiffness = '10 MN/m'\nnumber = 3\n"
    text += "[[effects]]\nkind = 'Buttress'\nheight = '400 cm'"
    effects = mr.from_toml(text=text).mechanisms[""].problem.effects
    assert effects == (Brace(3.0, 1e7, number=3), mr.Tie(4.0, 1e7), mr.Tie(2.0, 1.9e7))
    for wrong, complaint in (
        (text.replace("number = 3", "number = 12"), r"effects\[0\].number = 12 is outside the valid range 1 to 9"),
        (
            text.replace("400 cm", "950 cm"),
            r"effects\[1\].height = '950 cm' = 9.5 m is outside the valid range 0 to 9 m",
        ),
    ):
        with pytest.raises(mr.AssessmentError, match=complaint):
            mr.from_toml(text=wrong)
    number = mr.toml_schema()["$defs"]["Brace"]["properties"]["number"]
    assert (number["type"], number["minimum"], number["maximum"]) == ("integer", 1, 9)
    assert number["description"] == "how many [-], 1 to 9."


def test_every_public_effect_and_builder_is_in_the_schema():
    parts = mr.toml_schema()["$defs"]
    effects = [
        kind for kind in (getattr(mr, name) for name in dir(mr)) if isinstance(kind, type) and issubclass(kind, Effect)
    ]
    assert len(effects) >= 7
    assert {kind.__name__ for kind in effects} - {"Link"} <= set(
        parts
    )  # its law is a class, for which a file has no words
    for builder in ("arch", "stack", "running_bond", "dome", "facade", "corner", "from_obj", "between_sides"):
        assert f"Masonry.{builder}!" in parts
    assert {"Tie.of_bar", "Wedge", "EarthPressure", "Block.from_slenderness!"} <= set(parts)


def test_a_kinematic_check_and_its_command_bring_no_mujoco():
    """Whatever the file has for runs by other solvers and for reports, which bring Matplotlib."""
    sections = ["", "[run]\nsolver = 'explicit'\n", "[run]\nrtol = 1e-8\n", "[report]\ntitle = 'x'\n"]
    code = f"""
import io, sys
import mjrock as mr
from mjrock.__main__ import main
for text in {[f"{SITE}{WALL}{section}{EFFECTS}" for section in sections]!r}:
    print(mr.from_toml(text=text).check()[""].table())
    unneeded = "mujoco", "pandas", *(["matplotlib"] if "[report]" not in text else [])
    assert not [name for name in unneeded if name in sys.modules], text
sys.stdin = io.TextIOWrapper(io.BytesIO(text.encode()))
assert main(["check", "-"]) < 2
assert "mujoco" not in sys.modules
"""
    subprocess.run([sys.executable, "-W", "error", "-W", "ignore::UserWarning", "-c", code], check=True)
