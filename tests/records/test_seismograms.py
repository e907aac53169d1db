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
    printed = {"delta": 0.01, "network": "XX", "station": "MADE", **header}
    return obspy.Stream([obspy.Trace(COUNTS.copy(), {**printed, "channel": channel}) for channel in channels])


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


@pytest.mark.parametrize("channel", ["BHE", "HHZ", "EHN", "LL1", "SPZ"])
def test_a_seismometer_is_named_by_its_channel(channel, tmp_path, obspy):
    """Its counts are refused. A unit by name says that its response has been removed, and a warning repeats it."""
    path = tmp_path / "a.mseed"
    stream(obspy, channel).write(str(path), "MSEED")
    for read in (mr.GroundMotion.from_file, mr.components_in):
        with pytest.raises(ValueError, match=rf"a\.mseed: the channel {channel} is of a .*, and its counts are no acc"):
            read(path, unit=1e-3)
        with pytest.warns(UserWarning, match=rf"the channel {channel} is of .* are taken as accelerations in mm/s2"):
            read(path, unit="mm/s2")


@pytest.mark.parametrize("channel", ["HNE", "BNZ", "HGN", "E", "", "EW1", "UD2", "ACC"])
def test_other_channels_are_read_without_a_word(channel, tmp_path, obspy):
    path = tmp_path / "a.mseed"
    stream(obspy, channel).write(str(path), "MSEED")
    assert mr.GroundMotion.from_file(path, unit=1e-3).peak == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("idep", "message"), [(6, "displacements"), (7, "velocities"), (8, None), (5, "the channel HHE")]
)
def test_the_quantity_of_a_sac_file(idep, message, tmp_path, obspy):
    """Its header says more than its channel."""
    path, (trace,) = tmp_path / "a.sac", stream(obspy, "HHE")
    trace.stats.sac = {"idep": idep}
    trace.write(str(path), "SAC")
    if message is None:
        assert mr.GroundMotion.from_file(path, unit=1e-3).peak == pytest.approx(0.5)
        return
    for unit in (1e-3, "mm/s2") if idep != 5 else (1e-3,):
        with pytest.raises(ValueError, match=rf"a\.sac: .*{message}"):
            mr.GroundMotion.from_file(path, unit=unit)
