"""Folders of records: which files go together, and one factor for their components."""

import numpy as np
import pytest
from record_files import body, esm, written

import mjrock as mr

SPECTRUM = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")


def stations(folder, *names):
    for name in names:
        written(folder / name, esm(STREAM=name.split(".")[3]) + body("esm"))


def test_components_of_a_record_go_together(tmp_path):
    stations(tmp_path, "IT.AMT..HGN.ASC", "IT.AMT..HGE.ASC", "IT.AMT..HGZ.ASC", "IT.NRC..HNE.ASC", "IT.NRC..HNN.ASC")
    found = mr.records_in(tmp_path)
    assert list(found) == ["IT.AMT..HG?.ASC", "IT.NRC..HN?.ASC"]
    assert [motion.header["STREAM"] for motion in found["IT.AMT..HG?.ASC"]] == ["HGE", "HGN", "HGZ"]
    assert [motion.header["STREAM"] for motion in found["IT.NRC..HN?.ASC"]] == ["HNE", "HNN"]


def test_numbers_tell_stations_apart(tmp_path):
    for i in "123":
        for letter in "EN" if i < "3" else "E":
            name = f"IT.T120{i}..HN{letter}.ASC"
            written(tmp_path / name, esm(STATION_CODE=f"T120{i}", STREAM=f"HN{letter}") + body("esm"))
    both = ["IT.T1201..HN?.ASC", "IT.T1202..HN?.ASC"]
    assert list(mr.records_in(tmp_path)) == [*both, "IT.T1203..HNE.ASC"]
    assert {len(members) for members in mr.records_in(tmp_path, pattern="*E.ASC").values()} == {1}
    for i in "12z":
        written(tmp_path / f"IT.B..HN{i.upper()}.ASC", esm(STREAM="") + body("esm"))
        written(tmp_path / f"it.b..hn{i}.asc", esm(STREAM="") + body("esm"))
    found = mr.records_in(tmp_path)
    assert len(found["IT.B..HN?.ASC"]) == len(found["it.b..hn?.asc"]) == 3


def test_other_formats_and_single_files(tmp_path):
    for name in ("000199xa.txt", "000199ya.txt", "alone.txt", "notes.md"):
        written(tmp_path / name, "0\n1\n-2\n1\n0\n")
    read = lambda path: mr.GroundMotion.from_csv(path, "m/s2", dt=0.01)  # noqa: E731
    found = mr.records_in(tmp_path, read, "*.txt")
    assert {name: len(members) for name, members in found.items()} == {"000199?a.txt": 2, "alone.txt": 1}


@pytest.mark.parametrize(
    ("names", "pattern", "complaint"),
    [
        ((), "*", "has no file that fits the pattern '\\*'"),
        (("a.ASC",), "*.at2", r"has no file that fits the pattern '\*\.at2'$"),
        (("E_E.1", "E_N.1", "N_E.1"), "*", "E_E.1 goes with other files in more than one way: "),
    ],
)
def test_what_cannot_be_told(tmp_path, names, pattern, complaint):
    for name in names:
        written(tmp_path / name, esm() + body("esm"))
    with pytest.raises(ValueError, match=complaint):
        mr.records_in(tmp_path, pattern=pattern)


def test_a_damaged_file_is_named(tmp_path):
    written(tmp_path / "a.asc", esm() + "0\n1\n")
    with pytest.raises(ValueError, match=r"a\.asc: 2 samples; the header states 6"):
        mr.records_in(tmp_path)


def test_one_factor_for_all_components():
    motions = [mr.GroundMotion.synthetic(peak, 10.0, seed=seed) for seed, peak in enumerate((3.0, 1.5, 2.0))]
    T = np.geomspace(0.2, 2.0, 10)
    made = mr.scaled_together(motions, T, SPECTRUM)
    factors = [after.peak / before.peak for after, before in zip(made, motions, strict=True)]
    np.testing.assert_allclose(factors, factors[0])
    mean = np.exp(np.mean([np.log(mr.response_spectrum(motion, T).Sa) for motion in made[:2]], axis=0))
    assert np.exp(np.log(mean / SPECTRUM(T)).mean()) == pytest.approx(1.0)


def test_a_set_is_scaled_record_by_record(tmp_path):
    """As REXEL selects them: pairs by folder. Each pair has its own factor, and the mean lies on the target in the
    geometric mean over the periods, but for the scatter of the records."""
    for i in range(4):
        for letter in "xy":
            record = mr.GroundMotion.synthetic(1.0 + i, 8.0, seed=2 * i + (letter == "y"))
            lines = "\n".join(f"{a:.9g}" for a in record.accel)
            written(tmp_path / f"00{i}{letter}a.txt", lines + "\n")
    records = mr.records_in(tmp_path, lambda path: mr.GroundMotion.from_csv(path, "m/s2", dt=0.01), "*.txt")
    assert [len(components) for components in records.values()] == [2] * 4
    T = np.geomspace(0.15, 2.0, 10)
    scaled = records.scaled_to(SPECTRUM, T)
    assert isinstance(scaled, mr.RecordSet)
    assert list(scaled) == list(records)
    for before, after in zip(records.values(), scaled.values(), strict=True):
        assert after == mr.scaled_together(before, T, SPECTRUM)
    assert scaled.first == [pair[0] for pair in scaled.values()]
    own = [mr.response_spectrum(motion, T).Sa for motion in scaled.horizontal]
    np.testing.assert_allclose(scaled.mean_over(SPECTRUM, T), np.mean(own, axis=0) / SPECTRUM(T))
    assert np.exp(np.log(scaled.mean_over(SPECTRUM, T)).mean()) == pytest.approx(1.0, abs=0.1)


def test_what_a_set_cannot_do():
    with pytest.raises(ValueError, match="the set has no records"):
        mr.RecordSet().mean_over(SPECTRUM, [1.0])
    with pytest.raises(TypeError, match="spectrum"):
        mr.RecordSet().mean_over([1.0], [1.0])
