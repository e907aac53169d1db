"""Whole files: jobs of an engineer with the numbers of the same objects in Python, and what they become."""

import dataclasses
import math
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest
from everyday import among

import mjrock as mr

FILES = Path(__file__).parent / "files"
g = mr.GRAVITY


def same(one, other):
    assert one.verdicts == other.verdicts
    assert one.table() == other.table()


PERIODS = np.linspace(0.1, 2.0, 30)
MASONRY = {"shear_strength": 30e3, "compressive_strength": 1.5e6}


@dataclass
class Job:
    """The checks and runs of a job, by the names of the mechanisms, as its script makes them.

    Args:
        site: spectra of the ground by limit state.
        checked: what is checked, against what, and further arguments of `mechanism_check`.
        floor: of the records, None on the ground.
        shaken: the mechanisms that are run under the records.
    """

    site: dict
    checked: dict
    shaken: tuple
    floor: dict | None = None

    @cached_property
    def motions(self):
        """Eight records scaled to SLV, in both polarities."""
        records = (mr.GroundMotion.synthetic(2.0, 12.0, seed=seed) for seed in range(8))
        scaled = [mr.scaled_to_spectrum(record, PERIODS, self.site["SLV"]) for record in records]
        above = scaled if self.floor is None else [record.through_building(**self.floor) for record in scaled]
        return [motion for record in above for motion in record.polarities]

    def cases(self, name):
        """The cases of the runs of a mechanism."""
        return [dataclasses.replace(self.checked[name][0], motion=motion) for motion in self.motions]


def site_of(slv, slc, **soil):
    """Spectra of NTC 2018 for (ag [g], F0, Tc) of both limit states."""
    states = {"SLV": slv, "SLC": slc}
    return {
        name: mr.code_spectrum("NTC 2018", ag=ag * g, F0=F0, Tc=Tc, **soil) for name, (ag, F0, Tc) in states.items()
    }


def rod(d, plate):
    """The tie of the gable."""
    return mr.Tie.of_bar(6.8, d, 235e6, 6.0, plate=plate, ultimate=0.03, thickness=0.5, **MASONRY)


def of_gable():
    """Job 1: the wall, its ridge beam and its tie; the gable above the eaves; every bar with every plate."""
    site = site_of((0.21, 2.45, 0.33), (0.27, 2.47, 0.34), soil="C", topography="T1")
    openings = [mr.Opening(width=1.6, height=2.6), mr.Opening(width=1.0, height=1.0, sill=4.2, round=True)]
    wall = mr.Block.from_size(0.5, 7.5, 8.0, 1900.0, openings=openings, gable=mr.Gable(height=2.5))
    top = mr.Block.from_size(0.5, 2.5, 8.0, 1900.0, gable=mr.Gable(height=2.5))
    push = mr.Thrust(7.3, 1.5e3)
    beam = mr.AddedMass(9e3 / g, 7.3, -0.10), push
    floor = {"period": 0.05 * 7.5**0.75, "participation": 1.2, "height": 5.0 / 7.5}
    up = {name: one.at_height(**floor) for name, one in site.items()}
    on_top = mr.AddedMass(9e3 / g, 2.3, -0.10), mr.Thrust(2.3, 1.5e3)
    effects = {"no beam": (), "beam as load": (mr.Load(9e3, 7.3, -0.10), push), "beam as mass": beam}
    bars = {(d, plate): (*beam, rod(d / 1000, plate / 100)) for d in (12, 16, 20, 24) for plate in (20, 30, 40)}
    effects["tied"] = bars[16, 20]
    checked = {name: (mr.Case(wall, 0.0, 15.0, effects=some), site, {}) for name, some in effects.items()}
    checked["gable alone"] = mr.Case(top, 0.0, 15.0, effects=on_top), up, {}
    for (d, plate), some in bars.items():
        checked[f"{d} mm, plate {plate} cm"] = mr.Case(wall, 0.0, 15.0, effects=some), site, {}
    return Job(site, checked, ("beam as mass", "tied"))


def of_parapet():
    """Job 2: a parapet on the roof, rigid and elastic, and a chimney either way and over its corners."""
    site = site_of((0.18, 2.5, 0.33), (0.23, 2.52, 0.34), soil="B")
    floor = {"period": 0.05 * 10.0**0.75, "participation": 3 * 3 / 7, "height": 1.0}
    up = {name: one.at_height(**floor) for name, one in site.items()}
    density = 18e3 / g

    def elastic(height, thickness):
        return {"elastic_period": 6.2 * (height / thickness) * height * np.sqrt(18e3 / (1.2e9 * g))}

    case = mr.Case(mr.Block.from_size(0.30, 1.2, 10.0, density), 0.0, 15.0, side_stop=False)
    checked = {"parapet, rigid": (case, up, {}), "parapet, elastic": (case, up, elastic(1.2, 0.3))}
    hollow = density * (1 - 0.25**2 / (0.6 * 0.45))
    for side, other, name in ((0.45, 0.6, "thin"), (0.6, 0.45, "wide")):
        stack = mr.Block.from_size(side, 1.8, other, hollow)
        chimney = mr.Case(stack, 0.0, 15.0, side_stop=False)
        checked[f"chimney, {name} way"] = chimney, up, elastic(1.8, side)
    box = mr.Masonry.box((0.45, 0.6, 1.8), joints=mr.Dry(k_n=1e9, friction=0.7), density=hollow)
    for angle in CORNERS:
        checked[f"corner, {angle} deg"] = mr.MasonryCase(box, 15.0), up, {}
    return Job(site, checked, ("parapet, elastic",), floor)


def of_facade():
    """Job 6: storeys above floors, with their floor spectra, and bending between floors."""
    site = site_of((0.17, 2.5, 0.33), (0.22, 2.5, 0.34), soil="C")

    def at(z):
        floor = {"period": 0.05 * 9.6**0.75, "participation": 9 / 7, "height": z / 9.6}
        return {name: one.at_height(**floor) for name, one in site.items()}

    def windows(count, sill):
        return count * (mr.Opening(1.0, 1.6, sill),)

    def floors(levels, z0=0.0, t=0.6):
        return [mr.AddedMass(144e3 / g, z - z0, -t / 2 + 0.10) for z in levels]

    def tie(z):
        return mr.Tie.of_bar(z, 0.020, 235e6, 8.0, plate=0.25, number=3, ultimate=0.03, thickness=0.45, **MASONRY)

    size = {"length": 12.0, "density": 1800.0}
    profile = [(0, 0.6), (3.2, 0.6), (3.21, 0.45), (9.6, 0.45)]
    openings = (mr.Opening(1.2, 2.3), *windows(3, 4.2), *windows(4, 7.4))
    whole = mr.Block.from_size(0.60, 9.6, profile=profile, openings=openings, **size)
    upper = mr.Block.from_size(0.45, 6.4, openings=(*windows(3, 1.0), *windows(4, 4.2)), **size)
    top = mr.Block.from_size(0.45, 3.2, openings=windows(4, 1.0), **size)
    above = 144e3 + top.mass * g + 144e3
    strip, low = mr.Block.from_size(0.45, 3.2, **size), mr.Block.from_size(0.60, 3.2, **size)
    carried = above + 144e3 + upper.mass * g / 2

    def case(wall, *effects):
        return mr.Case(wall, 0.0, 15.0, effects=effects)

    three = floors((3.2, 6.4, 9.6))
    checked = {
        "A whole, no ties": (case(whole, *three), site, {}),
        "A whole, tied": (case(whole, *three, tie(3.2), tie(6.4)), site, {}),
        "B above floor 1": (case(upper, *floors((6.4, 9.6), 3.2, 0.45), tie(3.2)), at(3.2), {}),
        "C top storey": (case(top, *floors((9.6,), 6.4, 0.45)), at(6.4), {}),
        "D bending, storey 2": (mr.VerticalBending(strip, above, bearing=0.225), at(3.2), {}),
        "E bending, storey 1": (mr.VerticalBending(low, carried, bearing=0.3), site, {}),
    }
    return Job(site, checked, ("A whole, tied",))


def of_row_houses():
    """Job 8: wedges of party walls, ties, one house alone, and a strip under the roof that bends in plan."""
    site = site_of((0.22, 2.4, 0.34), (0.28, 2.4, 0.35), soil="C")
    doors, windows = 3 * [mr.Opening(1.0, 2.2)], 6 * [mr.Opening(1.0, 1.4, 3.8)]
    wall = mr.Block.from_size(0.5, 6.2, 18.0, 1900.0, openings=[*doors, *windows])
    roof = (mr.Thrust(6.2, 1.0e3 * 18), mr.AddedMass(3e3 * 18 / g, 6.2, 0.0))
    tie = mr.Tie.of_bar(5.9, 0.020, 235e6, 6.0, plate=0.25, number=4, ultimate=0.03, thickness=0.5, **MASONRY)

    def wedges(count):
        return mr.Wedge(np.radians(15), 0.30, 6.2, number=count).behind(wall)

    further = {"no bond": (), "4 walls, 15 deg": wedges(4), "2 ends, 15 deg": wedges(2), "4 ties": (tie,)}
    checked = {name: (mr.Case(wall, 0.0, 15.0, effects=(*roof, *one)), site, {}) for name, one in further.items()}
    one = mr.Block.from_size(0.5, 6.2, 6.0, 1900.0, openings=[doors[0], *windows[:2]])
    above = mr.Thrust(6.2, 6e3), mr.AddedMass(18e3 / g, 6.2, 0.0)
    checked["one house"] = mr.Case(one, 0.0, 15.0, effects=above), site, {}
    strip = mr.Block.from_size(0.5, 1.0, 6.0, 1900.0)
    checked["strip of one house"] = mr.HorizontalBending(strip, thrust=20e3), site, {}
    return Job(site, checked, ("no bond", "4 ties"))


CORNERS = 0, 30, 37, 45, 53, 90
"""Directions [degrees] in which the chimney falls over an edge or over a corner."""
JOBS = {"gable": of_gable, "parapet": of_parapet, "facade": of_facade, "row_houses": of_row_houses}


@pytest.mark.parametrize("name", among(list(JOBS), "parapet", "facade"))
def test_a_whole_job_has_the_verdicts_and_the_runs_of_python(name):
    job, assessment = JOBS[name](), mr.from_toml(FILES / f"{name}.toml")
    assert list(assessment.mechanisms) == list(job.checked)
    for own, (problem, demand, options) in job.checked.items():
        mechanism = assessment.mechanisms[own]
        assert mechanism.problem == problem
        if mechanism.is_wall:
            same(mechanism.check(), mr.mechanism_check(problem, demand, **options))
    tasks = assessment.analyses()
    assert tuple(tasks) == job.shaken
    for own, some in tasks.items():
        e = mr.Restitution.from_geometry(job.checked[own][0].block)
        assert some == [mr.Analysis(case, "analytical", e=e) for case in job.cases(own)]


@pytest.mark.slow
@pytest.mark.parametrize("name", JOBS)
def test_the_runs_of_a_job_have_the_motions_and_the_verdict_of_python(name):
    job, assessment = JOBS[name](), mr.from_toml(FILES / f"{name}.toml")
    answers = assessment.run()
    verdicts = assessment.dynamic_check(answers)
    for own, some in answers.items():
        e = mr.Restitution.from_geometry(job.checked[own][0].block)
        runs = [mr.solve_analytical(case, e) for case in job.cases(own)]
        assert all(np.array_equal(one.theta, other.theta) for one, other in zip(some, runs, strict=True))
        same(verdicts[own], mr.dynamic_check(runs, "SLV", natural=False))


def test_bars_and_plates_of_the_gable_are_designed_as_in_python():
    job, assessment = of_gable(), mr.from_toml(FILES / "gable.toml")
    case, demand, _ = job.checked["beam as mass"]

    def tied(plate):
        return dataclasses.replace(case, effects=(*case.effects, rod(0.016, plate)))

    found, designed = mr.design(tied, [0.2, 0.3, 0.4], demand, method="linear"), assessment.design()
    assert [trial.ratio for trial in designed.trials] == [trial.ratio for trial in found.trials]
    assert [trial.label for trial in designed.trials] == ["20 cm", "30 cm", "40 cm"]
    linear = {name: one.linear_ratio for name, one in assessment.check().items() if name.startswith(("12", "16"))}
    assert next(name for name, ratio in linear.items() if ratio >= 1) == "16 mm, plate 20 cm"


def test_the_chimney_falls_over_the_nearer_edge_in_each_direction():
    """A rigid box on its bed: the multiplier is half a side over the height of the centroid, along the direction."""
    mechanisms = mr.from_toml(FILES / "parapet.toml").mechanisms
    for degrees in CORNERS:
        one = mechanisms[f"corner, {degrees} deg"]
        found = mr.collapse_multiplier(one.problem.masonry, angle=one.curve["angle"]).multiplier
        across, along = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        edges = [side / 1.8 / way for side, way in ((0.45, across), (0.6, along)) if way > 1e-9]
        assert found == pytest.approx(min(edges), rel=1e-9)


@pytest.mark.slow
def test_the_corners_of_the_chimney_have_the_verdicts_of_python():
    job, assessment = of_parapet(), mr.from_toml(FILES / "parapet.toml")
    for degrees in CORNERS:
        case, demand, _ = job.checked[name := f"corner, {degrees} deg"]
        curve = mr.limit_curve(case.masonry, angle=np.radians(degrees), poses=20)
        same(assessment.mechanisms[name].check(), mr.mechanism_check(curve, demand))


def test_openings_of_a_wall_that_bends_are_refused_with_their_line(tmp_path):
    """As in the job of the façade, which had to leave them out."""
    text = (FILES / "facade.toml").read_text(encoding="utf-8")
    head = '[mechanisms."D bending, storey 2".wall]\n'
    path = tmp_path / "facade.toml"
    row = "openings = [{ width = 1.0, height = 1.6, sill = 1.0 }]\n"
    path.write_text(text.replace(head, head + row), encoding="utf-8")
    wall = mr.Block.from_size(0.45, 3.2, 12.0, 1800.0, openings=[mr.Opening(1.0, 1.6, 1.0)])
    with pytest.raises(ValueError, match="cut it to the strip between its openings") as python:
        mr.VerticalBending(wall, 144e3)
    with pytest.raises(mr.AssessmentError) as error:
        mr.from_toml(path)
    (fault,) = error.value.faults
    assert fault.message.endswith(str(python.value))
    assert fault.line == text[: text.index(head)].count("\n") + 2


@pytest.mark.parametrize(
    "path",
    among(sorted(FILES.glob("*.toml")), FILES / "parapet.toml", FILES / "row_houses.toml"),
    ids=lambda path: path.stem,
)
def test_files_are_written_and_read_again(path, tmp_path):
    assessment = mr.from_toml(path)
    again = tmp_path / path.name
    assessment.to_toml(again)
    assert tomllib.loads(again.read_text(encoding="utf-8")) == assessment.document
    pairs = zip(mr.from_toml(again).mechanisms.values(), assessment.mechanisms.values(), strict=True)
    assert all(one.problem == other.problem for one, other in pairs)


def test_a_report_has_the_checks_and_the_runs(tmp_path):
    assessment = mr.from_toml(FILES / "gable.toml")
    few = {name: assessment.mechanisms[name] for name in ("beam as mass", "tied")}
    assessment = dataclasses.replace(assessment, mechanisms=few)
    page = assessment.report(tmp_path / "gable.html").read_text(encoding="utf-8")
    for part in ("Parete di timpano", "Sala parrocchiale", "beam as mass", "Tab. C8.5.I"):
        assert part in page
    assert math.isfinite(assessment.check()["tied"].ground_ratio)


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
