"""Files of seismology, by ObsPy."""

import sys

import numpy as np
import pytest
from record_files import written

import mjrock as mr

COUNTS = np.array([0, 200, -500, 400, -100, 0], dtype=np.int32)


def test_without_obspy_the_way_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "obspy", None)
    path = written(tmp_path / "a.mseed", b"000001D STA" + bytes(500))
    with pytest.raises(ImportError, match=r"ObsPy reads SAC, miniSEED and more: pip install obspy"):
        mr.GroundMotion.from_file(path)


@pytest.fixture(scope="module")
def obspy():
    return pytest.importorskip("obspy")


def stream(obspy, *channels, **header):
    told = {"delta": 0.01, "network": "XX", "station": "MADE", **header}
    return obspy.Stream([obspy.Trace(COUNTS.copy(), {**told, "channel": channel}) for channel in channels])


@pytest.mark.parametrize("kind", ["SAC", "MSEED", "SLIST", "GSE2"])
def test_a_component(kind, tmp_path, obspy):
    path = tmp_path / f"a.{kind.lower()}"
    stream(obspy, "HNE").write(str(path), kind)
    motion = mr.GroundMotion.from_file(path, unit=1e-3)
    np.testing.assert_allclose(motion.accel, 1e-3 * COUNTS, rtol=1e-6)
    assert motion.dt == pytest.approx(0.01, rel=1e-6)
    assert motion.header["STREAM"] == "HNE"
    assert mr.GroundMotion.from_file(path, unit="mm/s2") == motion
    with pytest.raises(ValueError, match=rf"a file of {kind} states no unit: give unit=, one of m/s2, .* m/s2 a count"):
        mr.GroundMotion.from_file(path)


def test_all_components_of_a_file(tmp_path, obspy):
    path = tmp_path / "a.mseed"
    stream(obspy, "HNZ", "HNN", "HNE").write(str(path), "MSEED")
    motions = mr.components_in(path, 1e-3)
    assert [motion.name for motion in motions] == ["XX MADE HNE", "XX MADE HNN", "XX MADE HNZ"]
    assert mr.records_in(tmp_path, lambda file: mr.components_in(file, 1e-3)).horizontal == list(motions[:2])


def test_a_record_with_a_gap(tmp_path, obspy):
    path = tmp_path / "a.mseed"
    later = stream(obspy, "HNE", starttime=obspy.UTCDateTime(60))
    (stream(obspy, "HNE") + later).write(str(path), "MSEED")
    with pytest.raises(ValueError, match=r"a\.mseed: XX\.MADE\.\.HNE has a gap or an overlap: 2 pieces"):
        mr.components_in(path, 1.0)


def test_a_damaged_file(tmp_path, obspy):
    path = tmp_path / "a.sac"
    stream(obspy, "HNE").write(str(path), "SAC")
    written(path, path.read_bytes()[:-2])
    with pytest.raises(ValueError, match=r"a\.sac: ObsPy does not read it"):
        mr.GroundMotion.from_file(path, unit="g")
