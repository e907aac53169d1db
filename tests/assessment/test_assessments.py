"""Whole files: jobs of an engineer with the numbers of the same objects in Python, and what they become."""

import dataclasses
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

import mjrock as mr

FILES = Path(__file__).parent / "files"
g = mr.GRAVITY


def same(one, other):
    assert one.verdicts == other.verdicts
    assert one.table() == other.table()


def of_gable():
    """Job 1 in Python."""
    demand = {
        "SLV": mr.code_spectrum("NTC 2018", ag=0.21 * g, F0=2.45, Tc=0.33, soil="C", topography="T1"),
        "SLC": mr.code_spectrum("NTC 2018", ag=0.27 * g, F0=2.47, Tc=0.34, soil="C", topography="T1"),
    }
    openings = [mr.Opening(width=1.6, height=2.6), mr.Opening(width=1.0, height=1.0, sill=4.2, round=True)]
    wall = mr.Block.from_size(0.5, 7.5, 8.0, 1900.0, openings=openings, gable=mr.Gable(height=2.5))
    push = mr.Thrust(7.3, 1.5e3)
    mass = mr.AddedMass(9e3 / g, 7.3, -0.10)

    def tie(plate):
        masonry = {"thickness": 0.5, "shear_strength": 30e3, "compressive_strength": 1.5e6}
        return mr.Tie.of_bar(6.8, 0.016, 235e6, 6.0, plate=plate, ultimate=0.03, **masonry)

    effects = {
        "no beam": (),
        "beam as load": (mr.Load(9e3, 7.3, -0.10), push),
        "beam as mass": (mass, push),
        "tied": (tie(0.3), mass, push),
    }
    return {name: mr.Case(wall, effects=each) for name, each in effects.items()}, demand, tie


def test_the_gable_has_the_verdicts_of_python():
    cases, demand, tie = of_gable()
    assessment = mr.from_toml(FILES / "gable.toml")
    checks = assessment.check()
    assert list(checks) == list(cases)
    for name, case in cases.items():
        same(checks[name], mr.mechanism_check(case, demand))
    wall, beam = cases["tied"].block, cases["tied"].effects[1:]
    found = mr.design(
        lambda plate: mr.Case(wall, effects=(tie(plate), *beam)), [0.2, 0.3, 0.4], demand, method="linear"
    )
    designed = assessment.design()
    assert [trial.ratio for trial in designed.trials] == [trial.ratio for trial in found.trials]
    assert [trial.label for trial in designed.trials] == ["20 cm", "30 cm", "40 cm"]


def test_a_parapet_is_shaken_on_its_floor_as_in_python():
    assessment = mr.from_toml(FILES / "parapet.toml")
    slv = mr.code_spectrum("NTC 2018", ag=0.18 * g, F0=2.5, Tc=0.33, soil="B")
    slc = mr.code_spectrum("NTC 2018", ag=0.23 * g, F0=2.52, Tc=0.34, soil="B")
    floor = {"period": 0.05 * 10.0**0.75, "participation": 9 / 7, "height": 1.0}
    wall = mr.Block.from_size(0.30, 1.2, 10.0, 18e3 / g)
    case = mr.Case(wall, 0.0, 15.0, side_stop=False)
    up = {"SLV": slv.at_height(**floor), "SLC": slc.at_height(**floor)}
    checks = assessment.check()
    same(checks["parapet, rigid"], mr.mechanism_check(case, up))
    same(checks["parapet, elastic"], mr.mechanism_check(case, up, elastic_period=0.11617))
    runs = []
    for seed in range(2):
        record = mr.scaled_to_spectrum(mr.GroundMotion.synthetic(2.0, 12.0, seed=seed), [0.1, 0.5, 1.0, 2.0], slv)
        for motion in record.through_building(**floor).polarities:
            shaken = mr.Case(wall, 0.0, 15.0, motion=motion, side_stop=False)
            runs.append(mr.solve_analytical(shaken, mr.Restitution.from_geometry(wall)))
    answers = assessment.run()
    for name in ("parapet, rigid", "parapet, elastic"):
        assert all(np.array_equal(one.theta, other.theta) for one, other in zip(answers[name], runs, strict=True))
    found, expected = assessment.dynamic_check(answers)["parapet, rigid"], mr.dynamic_check(runs, natural=False)
    assert (found.d_0, found.mean) == (expected.d_0, expected.mean)


@pytest.mark.parametrize("path", sorted(FILES.glob("*.toml")), ids=lambda path: path.stem)
def test_files_are_written_and_read_again(path, tmp_path):
    assessment = mr.from_toml(path)
    again = tmp_path / path.name
    assessment.to_toml(again)
    assert tomllib.loads(again.read_text(encoding="utf-8")) == assessment.document
    pairs = zip(mr.from_toml(again).mechanisms.values(), assessment.mechanisms.values(), strict=True)
    assert all(one.problem == other.problem for one, other in pairs)


def test_a_report_has_the_checks_and_the_runs(tmp_path):
    assessment = mr.from_toml(FILES / "gable.toml")
    page = assessment.report(tmp_path / "gable.html").read_text(encoding="utf-8")
    for part in ("Parete di timpano", "Sala parrocchiale", "beam as mass", "Tab. C8.5.I"):
        assert part in page
    assert math.isfinite(assessment.check()["tied"].ground_ratio)


def test_the_mechanisms_of_a_facade_have_the_verdicts_of_python():
    """Job 6: storeys above floors, with their floor spectra, and bending between floors."""
    slv = mr.code_spectrum("NTC 2018", ag=0.17 * g, F0=2.5, Tc=0.33, soil="C")
    slc = mr.code_spectrum("NTC 2018", ag=0.22 * g, F0=2.5, Tc=0.34, soil="C")
    ground = {"SLV": slv, "SLC": slc}

    def at(z):
        floor = {"period": 0.05 * 9.6**0.75, "participation": 9 / 7, "height": z / 9.6}
        return {name: one.at_height(**floor) for name, one in ground.items()}

    def windows(count, sill):
        return count * (mr.Opening(1.0, 1.6, sill),)

    def floors(levels, z0=0.0, t=0.6):
        return [mr.AddedMass(144e3 / g, z - z0, -t / 2 + 0.10) for z in levels]

    def tie(z):
        masonry = {"thickness": 0.45, "shear_strength": 30e3, "compressive_strength": 1.5e6}
        return mr.Tie.of_bar(z, 0.020, 235e6, 8.0, plate=0.25, number=3, ultimate=0.03, **masonry)

    size = {"length": 12.0, "density": 1800.0}
    profile = [(0, 0.6), (3.2, 0.6), (3.21, 0.45), (9.6, 0.45)]
    openings = (mr.Opening(1.2, 2.3), *windows(3, 4.2), *windows(4, 7.4))
    whole = mr.Block.from_size(0.60, 9.6, profile=profile, openings=openings, **size)
    upper = mr.Block.from_size(0.45, 6.4, openings=(*windows(3, 1.0), *windows(4, 4.2)), **size)
    top = mr.Block.from_size(0.45, 3.2, openings=windows(4, 1.0), **size)
    above = 144e3 + top.mass * g + 144e3
    strip, low = mr.Block.from_size(0.45, 3.2, **size), mr.Block.from_size(0.60, 3.2, **size)
    carried = above + 144e3 + upper.mass * g / 2
    expected = {
        "A whole, no ties": (mr.Case(whole, effects=floors((3.2, 6.4, 9.6))), ground),
        "A whole, tied": (mr.Case(whole, effects=(*floors((3.2, 6.4, 9.6)), tie(3.2), tie(6.4))), ground),
        "B above floor 1": (mr.Case(upper, effects=(*floors((6.4, 9.6), 3.2, 0.45), tie(3.2))), at(3.2)),
        "C top storey": (mr.Case(top, effects=floors((9.6,), 6.4, 0.45)), at(6.4)),
        "D bending, storey 2": (mr.VerticalBending(strip, above, bearing=0.225), at(3.2)),
        "E bending, storey 1": (mr.VerticalBending(low, carried, bearing=0.3), ground),
    }
    checks = mr.from_toml(FILES / "facade.toml").check()
    assert list(checks) == list(expected)
    for name, (case, demand) in expected.items():
        same(checks[name], mr.mechanism_check(case, demand))


def test_the_variants_of_row_houses_have_the_verdicts_of_python():
    """Job 8: wedges of party walls, ties, and a strip under the roof that bends in plan."""
    slv = mr.code_spectrum("NTC 2018", ag=0.22 * g, F0=2.4, Tc=0.34, soil="C")
    slc = mr.code_spectrum("NTC 2018", ag=0.28 * g, F0=2.4, Tc=0.35, soil="C")
    openings = [*3 * [mr.Opening(1.0, 2.2)], *6 * [mr.Opening(1.0, 1.4, 3.8)]]
    wall = mr.Block.from_size(0.5, 6.2, 18.0, 1900.0, openings=openings)
    roof = (mr.Thrust(6.2, 1.0e3 * 18), mr.AddedMass(3e3 * 18 / g, 6.2, 0.0))
    masonry = {"thickness": 0.5, "shear_strength": 30e3, "compressive_strength": 1.5e6}
    tie = mr.Tie.of_bar(5.9, 0.020, 235e6, 6.0, plate=0.25, number=4, ultimate=0.03, **masonry)

    def wedges(count):
        return mr.Wedge(np.radians(15), 0.30, 6.2, number=count).behind(wall)

    further = {"no bond": (), "4 walls, 15 deg": wedges(4), "2 ends, 15 deg": wedges(2), "4 ties": (tie,)}
    expected = {name: mr.Case(wall, effects=(*roof, *one)) for name, one in further.items()}
    strip = mr.Block.from_size(0.5, 1.0, 6.0, 1900.0)
    expected["strip of one house"] = mr.HorizontalBending(strip, thrust=20e3)
    checks = mr.from_toml(FILES / "row_houses.toml").check()
    assert list(checks) == list(expected)
    for name, case in expected.items():
        same(checks[name], mr.mechanism_check(case, {"SLV": slv, "SLC": slc}))


CORNER = """
kind = "Corner"
thickness = "50 cm"
height = 4.0
angle = "30 deg"
[site]
code = "EC8 type 1"
ag = "0.15 g"
soil = "A"
[[effects]]
kind = "Thrust"
height = "4 m"
force = "2 kN"
[[effects]]
kind = "Load"
height = 4.0
force = "12 kN"
offset = "-60 cm"
[[effects]]
kind = "Tie"
make = "of_bar"
height = 3.8
diameter = "16 mm"
yield_stress = "235 MPa"
length = 6.0
plate = "20 cm"
thickness = "50 cm"
shear_strength = "30 kPa"
compressive_strength = "1.5 MPa"
ultimate = "3 cm"
[run]
solver = "analytical"
"""


def test_a_corner_with_its_roof_and_rods_is_that_of_python(tmp_path):
    masonry = {"thickness": 0.5, "shear_strength": 30e3, "compressive_strength": 1.5e6}
    tie = mr.Tie.of_bar(3.8, 0.016, 235e6, 6.0, plate=0.2, ultimate=0.03, **masonry)
    roof = mr.Thrust(4.0, 2e3), mr.Load(12e3, 4.0, -0.6)
    corner = mr.Corner(0.5, 4.0, math.pi / 6, effects=(*roof, tie))
    assessment = mr.from_toml(text=CORNER)
    mechanism = assessment.mechanisms[""]
    assert mechanism.problem == corner
    same(assessment.check()[""], mr.mechanism_check(corner, mr.code_spectrum("EC8 type 1", ag=0.15 * g, soil="A")))
    assert mechanism.case.effects == corner.case.effects
    page = assessment.report(tmp_path / "corner.html", language="it").read_text(encoding="utf-8")
    assert "in ciascuna parete" in page
    with pytest.raises(
        mr.AssessmentError, match=r"line 18: effects\[1\]\.offset: effects\[1\], offset of the Load = -6 m"
    ):
        mr.from_toml(text=CORNER.replace("-60 cm", "-6 m"))
    damper = CORNER.replace('kind = "Thrust"', 'kind = "Damper"')
    with pytest.raises(mr.AssessmentError, match=r"kind = 'Damper' .*is not known; it is one of Tie, "):
        mr.from_toml(text=damper)
    designed = CORNER + """[design]\nkey = "effects[2].diameter"\nvalues = ["12 mm", "16 mm", "20 mm"]\n"""
    found = mr.from_toml(text=designed).design()
    by_hand = mr.design(
        lambda d: dataclasses.replace(
            corner, effects=(*roof, mr.Tie.of_bar(3.8, d, 235e6, 6.0, plate=0.2, ultimate=0.03, **masonry))
        ),
        [0.012, 0.016, 0.020],
        mr.code_spectrum("EC8 type 1", ag=0.15 * g, soil="A"),
    )
    assert [trial.ratio for trial in found.trials] == [trial.ratio for trial in by_hand.trials]
