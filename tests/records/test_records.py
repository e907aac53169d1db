"""Records from files: what is read of them, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest
import synthetic_records
from record_files import AT2, HEADS, NUMBERS, READ, READERS, SAMPLES, body, esm, written

import mjrock as mr

RECORDS = Path(__file__).parent


@pytest.mark.parametrize(
    ("name", "count", "dt", "peak", "peak_velocity"),
    [
        ("far_a.sac", 1001, 0.02, 6.5, 0.74488),
        ("far_b.sac", 1001, 0.02, 6.5, 0.800065),
        ("near_a.sac", 1201, 0.01, 8.22073, 1.22964),
        ("near_b.at2", 1201, 0.01, 5.84763643, 0.911159),
        ("near_b.csv", 1201, 0.01, 5.8476364, 0.911159),
    ],
)
def test_the_records_at_hand(name, count, dt, peak, peak_velocity):
    """Peaks as awk finds them in the text; peak velocities from its sum of trapezoids, at the samples only."""
    path = RECORDS / name
    motion = READ[path.suffix[1:]](path)
    assert (len(motion.accel), motion.name) == (count, path.stem)
    assert motion.dt == pytest.approx(dt, rel=1e-12)
    assert motion.peak == pytest.approx(peak, rel=1e-8)
    assert motion.peak_velocity == pytest.approx(peak_velocity, rel=0.01)
    assert abs(motion.residual_velocity) < 0.01 * motion.peak_velocity
    assert 3 < motion.arias_intensity < 15


def test_the_records_are_what_their_script_writes(tmp_path):
    synthetic_records.write(tmp_path)
    shipped = {path.name for path in RECORDS.iterdir() if path.suffix[1:] in READ}
    assert shipped == {path.name for path in tmp_path.iterdir()}
    for name in shipped:
        new, old = (READ[name[-3:]](folder / name) for folder in (tmp_path, RECORDS))
        np.testing.assert_allclose(new.accel, old.accel, atol=2e-5)


def test_one_motion_in_two_formats():
    one, other = READ["at2"](RECORDS / "near_b.at2"), READ["csv"](RECORDS / "near_b.csv")
    np.testing.assert_allclose(one.accel, other.accel, atol=1e-6)


@pytest.mark.parametrize(
    "head",
    [
        "NPTS=     6, DT=   .0100 SEC",
        "npts= 6, dt= 1.0e-2 sec,",
        "    6    0.0100    NPTS, DT",
        "6, .0100, npts, dt",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_at2(tmp_path, head, encoding):
    path = tmp_path / "RSN9_A.90.AT2"
    path.write_text(AT2.replace("Somewhere", "Düzce") + f"{head}\n{NUMBERS}", encoding=encoding)
    motion = mr.GroundMotion.from_at2(path)
    np.testing.assert_allclose(motion.accel, 9.81 * np.array(SAMPLES), rtol=1e-14)
    assert motion.dt == 0.01
    assert motion.name == "RSN9_A.90"


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (AT2 + "NPTS= 7, DT= .01 SEC\n" + NUMBERS, "6 samples; the header states 7 in line 4"),
        (AT2 + "NPTS= 5, DT= .01 SEC\n" + NUMBERS, "6 samples; the header states 5"),
        (AT2 + "NPTS= 6, DT= SEC\n" + NUMBERS, "line 4 states no NPTS and DT .* alone: 'NPTS= 6, DT= SEC'"),
        (AT2 + "NPTS= 6\n" + NUMBERS, "line 4 states no NPTS and DT"),
        (
            AT2 + "NPTS= 6, DT= 20 SEC\n" + NUMBERS,
            "line 4: time step dt = 20 s is outside the valid range 1e-05 to 1 s",
        ),
        (AT2 + "NPTS= 6, DT= .01 SEC\n" + NUMBERS.replace("-0.01", "*****"), r"line 6: .*'\*\*\*\*\*'"),
        (AT2 + "NPTS= 6, DT= .01 SEC\n" + NUMBERS.replace("-0.01", "nan"), "line 6: 'nan' is not a finite number"),
        (AT2 + "NPTS= 6, DT= .01 SEC\n" + NUMBERS.replace("-.05", "-inf"), "line 5: '-inf' is not a finite number"),
        (AT2.replace("OF G", "OF CM/S") + "NPTS= 6, DT= .01 SEC\n" + NUMBERS, "not an AT2 file"),
        (AT2.replace("OF G", "OF GAL") + "NPTS= 6, DT= .01 SEC\n" + NUMBERS, "not an AT2 file"),
        (NUMBERS, "line 3 is '0': not an AT2 file"),
        ("\n", "an empty file"),
        ("\x00\x01\x02", "a binary file"),
    ],
)
def test_what_is_no_at2(tmp_path, content, complaint):
    path = tmp_path / "bad.AT2"
    path.write_text(content)
    with pytest.raises(ValueError, match=rf"bad\.AT2: .*{complaint}"):
        mr.GroundMotion.from_at2(path)


@pytest.mark.parametrize(
    ("content", "unit", "options", "scale"),
    [
        ("\ufeff0.00,0\n0.01,1\n0.02,-2\n", "m/s2", {}, 1.0),
        ("time [s], accel\n# filtered\n0,0\n\n.01,1\n% note\n.02,-2", "cm/s2", {}, 0.01),
        ("Zeit;a\r\n0,00;0,0\r\n0,01;1,0\r\n0,02;-2,0\r\n", "g", {}, 9.81),
        ("// ms and mm\n  0\t0\n 10   1.\n 20  -2.\n", "mm/s2", {"time_unit": "ms"}, 0.001),
        ("5.00 0\n5.01 1\n5.02 -2\n", "ft/s2", {}, 0.3048),
    ],
)
def test_columns(tmp_path, content, unit, options, scale):
    path = tmp_path / "two columns.csv"
    path.write_text(content, encoding="utf-8")
    if unit == "mm/s2":
        with pytest.warns(UserWarning, match="two columns peaks at 0.002 m/s2 = 0.000204 g only"):
            motion = mr.GroundMotion.from_csv(path, unit, **options)
    else:
        motion = mr.GroundMotion.from_csv(path, unit, **options)
    np.testing.assert_allclose(motion.accel, scale * np.array([0.0, 1.0, -2.0]), rtol=1e-14)
    assert motion.dt == pytest.approx(0.01, rel=1e-12)
    assert motion.name == "two columns"


def columns(t, a) -> str:
    return "".join(f"{x!r},{y!r}\n" for x, y in zip(map(float, t), map(float, a), strict=True))


T = 0.01 * np.arange(50)
CYCLE = np.sin(2 * np.pi * T / T[-1])


@pytest.mark.parametrize(
    ("content", "unit", "complaint"),
    [
        (columns(T, T), "m/s", "unit = 'm/s' is not one of m/s2, cm/s2, mm/s2, g, ft/s2"),
        (
            "t,a\n" + columns(np.delete(T, 20), T[1:]),
            "g",
            "line 22: uneven time steps, 0.02 s from 0.19 s on where 0.01",
        ),
        (columns(T + 0.0005 * np.eye(50)[7], T), "g", "line [89]: uneven time steps, 0.0(10|09)5 s from 0.0[67]"),
        (columns(np.where(T < 0.25, T, 1.1 * T - 0.025), T), "g", "uneven time steps"),
        (columns(T[::-1], T), "g", "line 2: time does not increase, 0.49 s to 0.48 s"),
        (columns([0, 0.01, 0.01], [0, 1, 2]), "g", "line 3: the time 0.01 s stands twice"),
        (columns([0, math.nan, 0.02], [0, 1, 2]), "g", "line 2: 'nan' is not a finite number"),
        (columns([0, 0.01, 0.02], [0, 1, math.inf]), "g", "line 3: 'inf' is not a finite number"),
        (columns([0, 10, 20], [0, 1, 2]), "g", "dt = 10 s is outside"),  # milliseconds
        ("0,0\n0.01,one\n0.02,2\n", "g", "line 2: .*'one'"),
        ("0,zero\n0.01,1\n0.02,2\n", "g", "line 1: .*'zero'"),
        ("0,0,0\n0.01,1,0\n", "g", "line 1 has 3 columns"),
        ("0,0\n0.01,1e308\n0.02,1\n", "g", r"accel\[1\] = inf m/s2 is not finite"),
        ("0\n1\n2\n", "g", "line 1 has one column of accelerations; give its time step dt"),
        ("time,accel\n", "g", "0 rows of numbers in 2 lines, the first of them 'time,accel'"),
        ("", "g", "an empty file"),
        ("0,1\x00", "g", "a binary file"),
    ],
)
def test_columns_that_are_none(tmp_path, content, unit, complaint):
    path = tmp_path / "bad.csv"
    path.write_text(content)
    with pytest.raises(ValueError, match=rf"bad\.csv: .*{complaint}"):
        mr.GroundMotion.from_csv(path, unit)


def test_one_column_needs_its_step(tmp_path):
    path = written(tmp_path / "a.txt", "# one column\n0\n1\n-2\n")
    for dt, unit in ((0.005, "s"), (5.0, "ms")):
        motion = mr.GroundMotion.from_csv(path, "m/s2", dt=dt, time_unit=unit)
        np.testing.assert_array_equal(motion.accel, [0.0, 1.0, -2.0])
        assert motion.dt == pytest.approx(0.005, rel=1e-12)
    with pytest.raises(ValueError, match=r"line 2 has one column of accelerations; give its time step dt"):
        mr.GroundMotion.from_csv(path, "m/s2")
    with pytest.raises(ValueError, match=r"dt = 5 s is outside the valid range"):
        mr.GroundMotion.from_csv(path, "m/s2", dt=5.0)
    with pytest.raises(ValueError, match=r"line 1 has 2 columns; choose with columns=, .* columns='rows' for samples"):
        mr.GroundMotion.from_csv(written(tmp_path / "b.csv", "0,1\n1,2\n"), "m/s2", dt=0.01)


def test_a_motion_is_written_as_it_is_read(tmp_path):
    made = mr.GroundMotion.synthetic(peak=3.0, duration=5.0, seed=1)
    path = made.to_esm(tmp_path / "IT.AMT..HNE.ASC", NETWORK="IT", STATION_CODE="AMT", STREAM="HNE")
    assert len(path.read_text().splitlines()) == 64 + len(made.accel)
    again = mr.GroundMotion.from_esm(path)
    np.testing.assert_allclose(again.accel, made.accel, rtol=1e-15)
    assert (again.dt, again.name, again.header["UNITS"]) == (made.dt, "IT AMT HNE", "cm/s^2")
    with_its_header = mr.GroundMotion.from_esm(written(tmp_path / "b.asc", esm() + body("esm")))
    copy = mr.GroundMotion.from_esm(with_its_header.to_esm(tmp_path / "c.asc", STREAM="HGN"))
    assert copy.header["EVENT_NAME"] == "CENTRAL_ITALY"
    assert copy.header["STREAM"] == "HGN"
    np.testing.assert_allclose(copy.accel, with_its_header.accel, rtol=1e-15)


@pytest.mark.parametrize(
    "field",
    [{"NETWORK": "I\nT"}, {"NETWORK": "I\rT"}, {"network": "IT"}, {"A B": "IT"}, {f"A{i}": "" for i in range(70)}],
)
def test_a_header_that_no_file_can_have(tmp_path, field):
    with pytest.raises(ValueError, match="at most 58 fields, each one line NAME: value with its name in capitals"):
        mr.GroundMotion.sine(1.0, 1.0).to_esm(tmp_path / "a.asc", **field)


class TestEsm:
    """Files of the European and the Italian data base."""

    def test_its_samples_and_its_header(self, tmp_path):
        motion = mr.GroundMotion.from_esm(written(tmp_path / "IT.AMT..HGE.D.ASC", esm() + body("esm")))
        np.testing.assert_allclose(motion.accel, SAMPLES, rtol=1e-14)
        assert motion.dt == 0.01
        assert motion.name == "IT AMT HGE EMSC-20160824_0000006"
        assert motion.header["MAGNITUDE_W"] == "6.0"
        for made in (motion.scaled(2.0), motion.scaled(peak=1.0), motion.reversed(), motion.resampled(0.005)):
            assert made.header == motion.header

    @pytest.mark.parametrize(("unit", "scale"), [("cm/s^2", 0.01), ("m/s^2", 1.0), ("g", 9.81)])
    def test_its_unit_is_that_of_the_header(self, tmp_path, unit, scale):
        path = written(tmp_path / "a.asc", esm(UNITS=unit) + "0\n1\n-2\n1\n0\n0\n")
        np.testing.assert_allclose(mr.GroundMotion.from_esm(path).accel, scale * np.array([0, 1, -2, 1, 0, 0]))

    @pytest.mark.parametrize(
        ("other", "complaint"),
        [
            ({"NDATA": "7"}, "6 samples; the header states 7 in line 11"),
            ({"NDATA": "many"}, "NDATA is 'many'; it has to be the number of samples"),
            ({"NDATA": ""}, "the header has no NDATA"),
            ({"SAMPLING_INTERVAL_S": "0.0"}, "line 10: time step dt = 0 s is outside"),
            ({"SAMPLING_INTERVAL_S": "fine"}, "line 10: 'fine' is not a finite number"),
            ({"UNITS": "counts"}, r"UNITS is 'counts'; the valid ones are cm/s\^2, m/s\^2, g"),
            ({"UNITS": "cm"}, r"line 14 is 'UNITS: cm': these are displacements, whatever unit is given"),
            ({"DATA_TYPE": "VELOCITY"}, "DATA_TYPE is 'VELOCITY'; the record has to be one of ACCELERATION"),
        ],
    )
    def test_what_its_header_must_state(self, tmp_path, other, complaint):
        with pytest.raises(ValueError, match=rf"a\.asc: {complaint}"):
            mr.GroundMotion.from_esm(written(tmp_path / "a.asc", esm(**other) + body("esm")))


def test_an_unknown_unit_of_time(tmp_path):
    (tmp_path / "a.csv").write_text(columns(T, T))
    with pytest.raises(ValueError, match="time_unit = 'h' is not one of s, ms"):
        mr.GroundMotion.from_csv(tmp_path / "a.csv", "g", time_unit="h")


def test_printed_times_may_be_rounded(tmp_path):
    """A record at 128 Hz whose times have four decimals: off the even grid by up to 0.6 % of a step."""
    t = np.arange(1000) / 128
    (tmp_path / "a.csv").write_text(columns(np.round(t, 4), np.sin(2 * np.pi * t / t[-1])))
    assert mr.GroundMotion.from_csv(tmp_path / "a.csv", "m/s2").dt == pytest.approx(1 / 128, rel=1e-5)


@pytest.mark.parametrize(
    ("head", "complaint"),
    [
        ("  6  5.0E-03  0  0  0.", None),
        ("  7  5.0E-03  0  0  0.", "6 samples; the header states 7"),
        ("  5  5.0E-03  0  0  0.", "6 samples; the header states 5"),
        ("  6", "not the plain text of a SAC record"),
        ("0.1  0.2  0.3", "not the plain text of a SAC record"),
        ("  6  0.0", "dt = 0 s"),
    ],
)
def test_sac(tmp_path, head, complaint):
    path = tmp_path / "STA.sac"
    path.write_text(f"STA fn  Somewhere\n{head}\n" + " ".join(str(1000 * x) for x in SAMPLES))
    if complaint:
        with pytest.raises(ValueError, match=rf"STA\.sac: .*{complaint}"):
            mr.GroundMotion.from_sac(path, "cm/s2")
    else:
        motion = mr.GroundMotion.from_sac(path, "cm/s2")
        np.testing.assert_allclose(motion.accel, 10 * np.array(SAMPLES), rtol=1e-14)
        assert (motion.dt, motion.name) == (0.005, "STA")


@READERS
def test_a_file_that_is_not_there(tmp_path, read):
    with pytest.raises(FileNotFoundError, match=r"nowhere\.txt"):
        read(tmp_path / "nowhere.txt")
    with pytest.raises(OSError, match=tmp_path.name):
        read(tmp_path)
    for path in (None, 3, b"a.at2", ["a.at2"]):
        with pytest.raises(TypeError, match=r"path = .* is not a str or PathLike"):
            read(path)


@pytest.mark.parametrize(
    ("accel", "unit", "complaint"),
    [
        (CYCLE, "mm/s2", "peaks at .* = 0.000102 g only"),
        (100 * CYCLE, "g", r"peaks at 98\d.* = 99.9 g"),
        (0.2 + CYCLE, "m/s2", r"residual velocity is 0.098 m/s, its peak velocity 0.\d+ m/s"),
    ],
)
def test_a_record_that_smells(tmp_path, accel, unit, complaint):
    (tmp_path / "a.csv").write_text(columns(T, accel))
    with pytest.warns(UserWarning, match=complaint):
        mr.GroundMotion.from_csv(tmp_path / "a.csv", unit)


@pytest.mark.parametrize("step", ["0.5000D-02", "0.05D-01", ".5d-2", "5.E-03", "0.5E-2", ".0050"])
def test_the_time_step_of_fortran(tmp_path, step):
    heads = [f"NPTS= 6, DT= {step}{unit}" for unit in ("", " SEC", "SEC,", " sec.", " s")]
    for head in (*heads, f"6  {step}  NPTS, DT"):
        assert READ["at2"](written(tmp_path / "a.at2", f"{AT2}{head}\n{NUMBERS}")).dt == 0.005
    assert READ["sac"](written(tmp_path / "a.sac", f"STA\n 6 {step} 0 0.\n{body('sac')}")).dt == 0.005


@pytest.mark.parametrize(
    "numbers",
    [
        " .0000D+00 .2000D-01-.5000D-01 .4000D-01-.1000D-01 .0000D+00",
        "0.000E+00 2.000E-02-5.000E-02\n4.000E-02-1.000E-02+0.000E+00",
        "0.+.02-.05\n+.04-.01-0.",
    ],
)
def test_columns_that_touch(tmp_path, numbers):
    motion = READ["at2"](written(tmp_path / "a.at2", HEADS["at2"] + numbers))
    np.testing.assert_allclose(motion.accel, 9.81 * np.array(SAMPLES), rtol=1e-14)
