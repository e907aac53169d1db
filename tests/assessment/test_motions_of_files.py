"""What moves the mechanisms of a file: records of a folder, a release in MuJoCo, a table that tilts, supports."""

import numpy as np
import pytest

import mjrock as mr

WALL = """duration = 1.0
side_stop = false
[wall]
thickness = "40 cm"
height = 2.0
[site]
code = "EC8 type 1"
ag = "0.2 g"
soil = "B"
"""
BLOCK = mr.Block.from_size(0.4, 2.0)
SPECTRUM = mr.code_spectrum("EC8 type 1", ag=0.2 * mr.GRAVITY, soil="B")
PERIODS = [0.2, 0.5, 1.0]
RECORDS = """[records]
folder = "records"
pattern = "*.AT2"
scaled_to = { periods = [0.2, "500 ms", 1.0] }
"""


def peer(path, peak, frequency, stated=101):
    """A record of PEER of 1 s, at rest at its end, in a file that states its samples: waves [g] of a frequency [Hz]."""
    t = 0.01 * np.arange(101)
    samples = peak * np.sin(np.pi * t) ** 2 * np.sin(2 * np.pi * frequency * (t - 0.5))
    head = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/99\nACCELERATION TIME SERIES IN UNITS OF G\n"
    rows = "\n".join(f"{one:.7E}" for one in samples)
    path.write_text(f"{head}NPTS= {stated}, DT= .0100 SEC\n{rows}\n", encoding="utf-8")


@pytest.fixture
def folder(tmp_path):
    """Two records: one of two horizontal components, one of a single one; and a file that the pattern leaves out."""
    records = tmp_path / "records"
    records.mkdir()
    peer(records / "RSN1_A000.AT2", 0.3, 2.0)
    peer(records / "RSN1_A090.AT2", 0.2, 3.0)
    peer(records / "RSN2_B000.AT2", 0.4, 1.5)
    (records / "notes.txt").write_text("which were chosen, and why", encoding="utf-8")
    return records


def test_records_of_a_folder_shake_the_wall_as_in_python(folder):
    path = folder.parent / "wall.toml"
    path.write_text(WALL + RECORDS + "[dynamic_check]\nlimit_state = 'NC'\nnatural = true\n", encoding="utf-8")
    assessment = mr.from_toml(path)
    records = mr.records_in(folder, pattern="*.AT2").scaled_to(SPECTRUM, PERIODS)
    assert list(records) == ["RSN1_A?.AT2", "RSN2_B000.AT2"]
    assert list(assessment.mechanisms[""].shaking.records) == records.horizontal
    assert len(records.horizontal) == 3
    e = mr.Restitution.from_geometry(BLOCK)
    motions = [motion for record in records.horizontal for motion in record.polarities]
    runs = [mr.solve_analytical(mr.Case(BLOCK, 0.0, 1.0, motion=one, side_stop=False), e) for one in motions]
    found = assessment.run()[""]
    assert all(np.array_equal(one.theta, other.theta) for one, other in zip(found, runs, strict=True))
    assert max(np.abs(one.theta).max() for one in found) > 1e-3


def test_a_damaged_record_of_a_folder_is_named_with_its_line(folder):
    path = folder.parent / "wall.toml"
    path.write_text(WALL + RECORDS, encoding="utf-8")
    line = 1 + WALL.count("\n")
    peer(folder / "RSN3_C000.AT2", 0.4, 1.5, stated=120)
    with pytest.raises(mr.AssessmentError, match=r"RSN3_C000\.AT2: 101 samples; the header states 120") as error:
        mr.from_toml(path)
    assert [fault.line for fault in error.value.faults] == [line]
    (folder / "RSN3_C000.AT2").unlink()
    path.write_text(WALL + RECORDS.replace("*.AT2", "*.ASC"), encoding="utf-8")
    with pytest.raises(mr.AssessmentError, match="has no file that fits the pattern") as error:
        mr.from_toml(path)
    assert [line <= fault.line <= line + 2 for fault in error.value.faults] == [True]
    path.write_text(WALL + RECORDS.replace('"records"', '"recods"'), encoding="utf-8")
    with pytest.raises(mr.AssessmentError, match="recods"):
        mr.from_toml(path)
    with pytest.raises(mr.AssessmentError, match="is the path of a file, and these tables are in none"):
        mr.from_toml(text=WALL + RECORDS)


def test_a_design_reads_no_records(folder):
    """They are read once, with the file, and not again for each value."""
    path = folder.parent / "wall.toml"
    path.write_text(
        WALL + RECORDS + '[design]\nkey = "wall.thickness"\nvalues = ["40 cm", "90 cm"]\n', encoding="utf-8"
    )
    assessment = mr.from_toml(path)
    for record in folder.iterdir():
        record.unlink()
    ratios = [trial.ratio for trial in assessment.design().trials]
    assert ratios[0] == min(verdict.ratio for verdict in assessment.check()[""].verdicts) < ratios[1]


def test_a_wall_is_run_in_mujoco_as_from_python():
    text = """theta0 = 0.06
duration = 0.5
[wall]
thickness = "40 cm"
height = 2.0
[contacts]
k_base = "0.5 N/mm3"
k_side = 5e8
[run]
solver = "MuJoCo"
timestep = "0.1 ms"
"""
    assessment = mr.from_toml(text=text)
    shaking = assessment.mechanisms[""].shaking
    e = mr.Restitution.from_geometry(BLOCK)
    contacts = mr.Contacts.from_law(BLOCK, e, k_base=5e8, k_side=5e8)
    assert shaking.contacts == contacts
    case = mr.Case(BLOCK, 0.06, 0.5)
    (run,), expected = assessment.run()[""], mr.simulate(case, contacts, timestep=1e-4)
    assert run.theta.tobytes() == expected.theta.tobytes()
    assert run.t.tobytes() == expected.t.tobytes()
    theory = mr.solve_analytical(case, e)
    np.testing.assert_allclose(run.theta[-1], np.interp(run.t[-1], theory.t, theory.theta), atol=2e-3)


DRIVEN = """
kind = "MasonryCase"
duration = 2.0
[masonry]
make = "stack"
k_n = "1 N/mm3"
friction = 0.8
[[masonry.blocks]]
thickness = "50 cm"
height = 2.0
length = 1.0
"""


@pytest.mark.parametrize(("degrees", "stands"), [(13.0, True), (15.5, False)])
def test_a_table_tilts_until_the_block_on_it_falls(degrees, stands):
    """It falls where the weight leaves the base, tan a = 0.5 / 2.0, a = 14.0 degrees."""
    text = DRIVEN.replace("2.0\n", "2.0\ntilt = [['0 s', 1.0], [0, 'A deg']]\n".replace("A", str(degrees)), 1)
    assessment = mr.from_toml(text=text)
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 2.0)], k_n=1e9, friction=0.8)
    case = mr.MasonryCase(masonry, 2.0, tilt=([0.0, 1.0], [0.0, np.radians(degrees)]))
    assert assessment.mechanisms[""].problem == case
    (run,), expected = assessment.run()[""], mr.solve_explicit(case)
    assert run.peak.tobytes() == expected.peak.tobytes()
    assert (run.peak.max() < 0.01) == stands


def test_a_support_moves_what_stands_on_it():
    text = DRIVEN + "[supports]\nground = [[0, '1 s'], [0, '3 cm'], [0, '-2 cm']]\n"
    assessment = mr.from_toml(text=text)
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 2.0)], k_n=1e9, friction=0.8)
    case = mr.MasonryCase(masonry, 2.0, supports={"ground": ([0.0, 1.0], [0.0, 0.03], [0.0, -0.02])})
    assert assessment.mechanisms[""].problem == case
    (run,), expected = assessment.run()[""], mr.solve_explicit(case)
    assert run.pose.tobytes() == expected.pose.tobytes()
    with pytest.raises(mr.AssessmentError, match="supports") as error:
        mr.from_toml(text=text.replace("ground =", "gruond ="))
    assert error.value.faults[0].line is not None
