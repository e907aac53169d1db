"""Components of a record: by what headers state, then by names as networks give them; vertical ones are no others."""

import pickle

import numpy as np
import pytest
from record_files import AT2, KNET, body, esm, written

import mjrock as mr


def of_text(path):
    return mr.GroundMotion.from_csv(path, "m/s2", dt=0.01)


def read_names(folder, *names):
    for name in names:
        written(folder / name, "0\n1\n-2\n1\n0\n")
    return mr.records_in(folder, of_text)


@pytest.mark.parametrize(
    "names",
    [
        ("RSN9_NO_XYZ009.AT2", "RSN9_NO_XYZ279.AT2", "RSN9_NO_XYZ-UP.AT2"),
        ("RSN9_NO_XYZ045.AT2", "RSN9_NO_XYZ135.AT2", "RSN9_NO_XYZDWN.AT2"),
        ("RSN9_NO_A-E06140.AT2", "RSN9_NO_A-E06230.AT2", "RSN9_NO_A-E06-UP.AT2"),
        ("RSN9_NO_TCU067-E.AT2", "RSN9_NO_TCU067-N.AT2", "RSN9_NO_TCU067-V.AT2"),
        ("ABC000.AT2", "ABC090.AT2", "ABCVER.AT2"),
        ("TAB-LN.AT2", "TAB-TR.AT2", "TAB-UP.AT2"),
        ("20000101_0101_RawAcc_E.asc", "20000101_0101_RawAcc_N.asc", "20000101_0101_RawAcc_U.asc"),
        ("XYZ0010001011200.EW", "XYZ0010001011200.NS", "XYZ0010001011200.UD"),
        ("XX.STA..HNE.txt", "XX.STA..HNN.txt", "XX.STA..HNZ.txt"),
        ("XX.STA..HN1.txt", "XX.STA..HN2.txt", "XX.STA..HNZ.txt"),
        ("a_H1.txt", "a_H2.txt", "a_V.txt"),
        ("000123xa.txt", "000123ya.txt", "000123za.txt"),
        ("rec_FN.txt", "rec_FP.txt"),
        ("rec-E-W.txt", "rec-N-S.txt", "rec-U-D.txt"),
    ],
)
def test_names_as_networks_give_them(names, tmp_path):
    found = read_names(tmp_path, *reversed(names))
    ((key, members),) = found.items()
    assert [motion.name for motion in members] == [name.rpartition(".")[0] for name in names]
    assert found.horizontal == list(members[:2])
    assert found.by == {key: "names"}
    assert members[0].header["STREAM"] in names[0]


@pytest.mark.parametrize(
    "names",
    [
        ("CHY023.txt", "CHY033.txt"),
        ("ABC023-N.AT2", "ABC033-N.AT2"),
        ("GM1.AT2", "GM2.AT2", "GM3.AT2"),
        ("LUCE.txt", "LUCN.txt"),
        ("a_E.txt", "a_Y.txt"),
        ("RSN9_A-E.AT2", "RSN10_A-N.AT2"),
        ("XYZ001.NS1", "XYZ001.EW2"),
        ("rec001.txt", "rec091.txt", "rec181.txt"),
    ],
)
def test_what_does_not_go_together(names, tmp_path):
    found = read_names(tmp_path, *names)
    assert [len(members) for members in found.values()] == [1] * len(names)
    assert found.by == {}


def test_a_header_tells_more_than_a_name(tmp_path):
    """Three components of one station, whose names say E, N and U, and another station of like names."""
    for code in ("0101", "0102"):
        for letter, stream in zip("ENU", "ENZ", strict=True):
            written(tmp_path / f"{code}_{letter}.asc", esm(STATION_CODE=code, STREAM=f"HN{stream}") + body("esm"))
    found = mr.records_in(tmp_path)
    assert list(found) == ["0101_?.asc", "0102_?.asc"]
    assert [motion.header["STREAM"] for motion in found["0101_?.asc"]] == ["HNE", "HNN", "HNZ"]
    assert set(found.by.values()) == {"header"}
    assert len(found.horizontal) == 4


def test_two_events_of_one_station(tmp_path):
    for event, hour in (("one", "A"), ("two", "B")):
        for letter in "EN":
            text = esm(EVENT_ID=event, STREAM=f"HN{letter}") + body("esm")
            written(tmp_path / f"{hour}{letter}.asc", text)
    found = mr.records_in(tmp_path)
    assert [len({motion.header["EVENT_ID"] for motion in members}) for members in found.values()] == [1, 1]


def test_raw_and_processed_files_of_one_station(tmp_path):
    """Their headers say the same; their names tell them apart."""
    for kind in ("CV", "MP"):
        for letter in "ENZ":
            written(tmp_path / f"IT.AMT..HN{letter}.{kind}.ASC", esm(STREAM=f"HN{letter}") + body("esm"))
    found = mr.records_in(tmp_path)
    assert list(found) == ["IT.AMT..HN?.CV.ASC", "IT.AMT..HN?.MP.ASC"]
    assert [len(members) for members in found.values()] == [3, 3]


@pytest.mark.parametrize("up", ["UP", "-UP"])
def test_peer_states_the_azimuth_in_its_second_line(tmp_path, up):
    for name, component in (("a.AT2", "9"), ("b.AT2", "279 (USGS STATION 1)"), ("c.AT2", up)):
        head = AT2.replace("Somewhere, 1/1/99", f"Nowhere-01, 1/1/1999, Some Station, {component}")
        written(tmp_path / name, f"{head}NPTS= 6, DT= .01 SEC\n{body('at2')}")
    found = mr.records_in(tmp_path)
    ((name, members),) = found.items()
    assert name == "a.AT2, b.AT2, c.AT2"
    assert [motion.header["STREAM"] for motion in members] == ["9", "279", "UP"]
    assert members[0].header["EVENT_NAME"] == "Nowhere-01"
    assert found.first == [members[0]]


def test_the_borehole_and_the_surface_stay_apart(tmp_path):
    for number, end in enumerate(("NS1", "EW1", "UD1", "NS2", "EW2", "UD2"), 1):
        text = KNET.replace("N-S", str(number)) + body("knet")
        written(tmp_path / f"XYZ0010102030405.{end}", text)
    found = mr.records_in(tmp_path)
    streams = [
        [motion.header["STREAM"] + motion.header["LOCATION"] for motion in members] for members in found.values()
    ]
    assert streams == [["EW1", "NS1", "UD1"], ["EW2", "NS2", "UD2"]]


def test_a_vertical_component_alone_is_no_record_across_a_wall(tmp_path):
    found = read_names(tmp_path, "RSN9_A-UP.AT2", "B.AT2")
    assert len(found) == 2
    assert [motion.name for motion in found.horizontal] == [motion.name for motion in found.first] == ["B"]
    spectrum, periods = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"), [0.5, 1.0]
    with pytest.raises(ValueError, match=r"RSN9_A-UP\.AT2: no horizontal component; del records\['RSN9_A-UP\.AT2'\]"):
        found.scaled_to(spectrum, periods)
    with pytest.raises(ValueError, match="motions has no horizontal component, but UP"):
        mr.scaled_together(found["RSN9_A-UP.AT2"], periods, spectrum)


@pytest.mark.filterwarnings("ignore:.*accelerations are in m/s2")
def test_a_set_says_what_was_grouped_and_by_what(tmp_path):
    found = read_names(tmp_path, "a_E.txt", "a_N.txt", "a_V.txt", "b.txt")
    assert repr(found) == "<RecordSet of 2 records>\n  a_?.txt: E, N, V (by names)\n  b.txt: b"
    assert pickle.loads(pickle.dumps(found)).by == found.by
    scaled = found.scaled_to(mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"), [0.5, 1.0])
    assert scaled.by == (found | scaled).by == ({} | found).by == found.by
    many = mr.RecordSet({f"{i:02d}": (mr.GroundMotion.sine(1.0, 1.0),) for i in range(20)})
    assert repr(many).splitlines()[-1] == "  ..."
    assert len(repr(many).splitlines()) == 10


def test_the_factor_is_of_the_horizontal_components(tmp_path):
    """A vertical one that stands first does not count."""
    spectrum, periods = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"), np.geomspace(0.2, 2.0, 5)
    level = [mr.GroundMotion.synthetic(3.0, 5.0, seed=i) for i in range(2)]
    upright = mr.GroundMotion(level[0].accel * 0.1, level[0].dt, "up", {"STREAM": "HNZ"})
    up, *others = mr.scaled_together([upright, *level], periods, spectrum)
    assert others == list(mr.scaled_together(level, periods, spectrum))
    assert up.peak == pytest.approx(0.1 * others[0].peak)
