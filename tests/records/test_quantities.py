"""The quantity that a header names: velocities and displacements are no accelerations, whatever unit the call gives."""

import re

import numpy as np
import pytest
from record_files import AT2, CSMIP, HEADS, NUMBERS, SAMPLES, body, esm, written

import mjrock as mr

T = 0.01 * np.arange(30)
A = np.sin(20 * T)
PEER = AT2 + "NPTS= 6, DT= .01 SEC\n" + NUMBERS
VT2, DT2 = (
    PEER.replace("ACCELERATION TIME SERIES IN UNITS OF G", line)
    for line in ("VELOCITY TIME SERIES IN UNITS OF CM/S", "DISPLACEMENT TIME SERIES IN UNITS OF CM")
)
HEADERS = {
    "Time (s);Velocity": "velocities", "Time (s);v (cm/s)": "velocities", "t [s];x [m/s]": "velocities",
    "Velocidad\nt;x": "velocities", "units: cm/sec\nt;x": "velocities", "unit of m/s\nt;x": "velocities",
    "t;Vel_x": "velocities", "1/1/99, in units of CM/S\nt;x": "velocities", "# in kine\nt;x": "velocities",
    "acceleration, integrated\nvelocity\nt;x": "velocities", "3 VELOCITY\nt;x": "velocities",
    "Time;disp": "displacements", "t;x (mm)": "displacements", "t (s);u [m]": "displacements",
    "Spostamento\nt;x": "displacements", "displ., in cm\nt;x": "displacements",
}  # fmt: skip
"""Headers of tables of two columns, and what they are of."""
ACCELERATIONS = (
        "t;x", "t (s);a (m/s2)", "t;acc [m/s/s]", "in m/s^2\nt;x", "unit: m / s / s\nt;x", "units of m/s\xb2\nt;x",
        "peak velocity = 0.3 m/s\nt;x", "velocity and displacement, by integration\nacceleration\nt;x",
        "Vs30 (m/s): 760\nt;x", "height (m): 4\nt;x", "shear wave velocity 300 m/s\nt;x", "t;acc_x", "delta v;t\nt;x",
        "accelerogram, veloc. and displ. follow\nt;x", "Developed in Velletri\nt;x", "disposed\nt;x", "in m s-2\nt;x",
    )  # fmt: skip


@pytest.mark.parametrize("header", HEADERS)
def test_what_a_header_names_is_refused_whatever_unit_is_given(header, tmp_path):
    rows = "".join(f"{t:.2f};{a:.5f}\n" for t, a in zip(T, A, strict=True))
    path = written(tmp_path / "a.txt", f"{header}\n{rows}")
    message = (
        rf"a\.txt: (line \d|the name of the column) is '.*': these are {HEADERS[header]}, whatever unit is given; a"
    )
    message += " record of accelerations is needed$"
    for unit in (None, "m/s2", "cm/s2", "g", 0.5):
        for read in (mr.GroundMotion.from_csv, mr.components_in):
            with pytest.raises(ValueError, match=message):
                read(path, unit)
        with pytest.raises(ValueError, match=message):
            mr.GroundMotion.from_file(path, unit=unit)


@pytest.mark.parametrize("header", ACCELERATIONS)
def test_accelerations_are_read(header, tmp_path):
    rows = "".join(f"{t:.2f};{a:.5f}\n" for t, a in zip(T, A, strict=True))
    motion = mr.GroundMotion.from_csv(written(tmp_path / "a.txt", f"{header}\n{rows}"), "m/s2")
    np.testing.assert_allclose(motion.accel, A, atol=5e-6)


def test_a_column_is_what_its_name_says(tmp_path):
    rows = "".join(f"{t:.2f};{a:.5f};{2 * a:.5f};{3 * a:.5f}\n" for t, a in zip(T, A, strict=True))
    path = written(tmp_path / "a.txt", f"Displacement gauge 7\nt (s);acc;vel (m/s);disp (m)\n{rows}")
    np.testing.assert_allclose(mr.GroundMotion.from_csv(path, "m/s2", columns=("t", "acc")).accel, A, atol=5e-6)
    for column, message in (("vel", "velocities"), (3, "displacements")):
        with pytest.raises(ValueError, match=rf"the name of the column is '.*': these are {message}"):
            mr.GroundMotion.from_csv(path, "m/s2", columns=(0, column))
        with pytest.raises(ValueError, match=message):
            mr.components_in(path, "m/s2", columns=(0, 1, column))


@pytest.mark.parametrize(("text", "message"), [(VT2, "velocities"), (DT2, "displacements")])
def test_the_files_beside_an_at2(text, message, tmp_path):
    path = written(tmp_path / "a.VT2", text)
    for read in (
        mr.GroundMotion.from_file,
        lambda path: mr.GroundMotion.from_file(path, unit="g"),
        lambda path: mr.GroundMotion.from_csv(path, "g", dt=0.01, columns="rows"),
        lambda path: mr.components_in(path, 1e-2),
    ):
        with pytest.raises(ValueError, match=rf"a\.VT2: line 3 is '.*': these are {message}, whatever unit is given"):
            read(path)
    with pytest.raises(ValueError, match=r"line 3 is '(VELOCITY|DISPLACEMENT) .*': not an AT2 file"):
        mr.GroundMotion.from_at2(path)
    np.testing.assert_allclose(mr.GroundMotion.from_csv(path, "g", dt=0.01, skip=4, columns="rows").peak, 0.05 * 9.81)


def test_other_formats(tmp_path):
    """A file of CSMIP holds velocities after its accelerations, and is one of accelerations."""
    with pytest.raises(ValueError, match="line 14 is 'UNITS: cm/s': these are velocities"):
        mr.GroundMotion.from_esm(written(tmp_path / "a.asc", esm(UNITS="cm/s") + body("esm")))
    with pytest.raises(ValueError, match="line 1 is 'XYZ velocity': these are velocities"):
        mr.GroundMotion.from_sac(written(tmp_path / "a.sac", f"XYZ velocity\n6 .01\n{NUMBERS}"), "cm/s2")
    for first in ("3 VELOCITY", "Corrected velocity    (Format v01.20 with 13 text lines)"):
        with pytest.raises(ValueError, match=rf"line 1 is '{re.escape(first)}': these are velocities"):
            mr.GroundMotion.from_file(written(tmp_path / "a", f"{first}\nmade up: 1 of 3\n1 2 3\nno 5\n"), unit="g")
    np.testing.assert_allclose(mr.GroundMotion.from_file(written(tmp_path / "a", CSMIP + body("csmip"))).accel, SAMPLES)


def test_a_download_of_peer_is_read_as_it_lies_there(tmp_path):
    """Velocities, displacements and the list of results are left out, and named; a damaged record is refused."""
    for token in ("009", "279", "-UP"):
        for ending, text in (("AT2", PEER), ("VT2", VT2), ("DT2", DT2)):
            written(tmp_path / f"RSN1_MADE_UP{token}.{ending}", text)
    written(tmp_path / "_SearchResults.csv", "PEER\nResult ID,Spectral Ordinate\n1,SRSS,0.3\n2,SRSS,0.4\n")
    written(tmp_path / "photo.png", b"\x89PNG\0")
    with pytest.warns(
        UserWarning, match=r"8 of 11 files hold no record and are left out: RSN1.* pattern= takes others"
    ):
        found = mr.records_in(tmp_path)
    assert [motion.header["STREAM"] for motion in found["RSN1_MADE_UP?.AT2"]] == ["009", "279", "UP"]
    assert len(found) == 1
    assert set(found.skipped) == {path.name for path in tmp_path.iterdir() if path.suffix != ".AT2"}
    assert "velocities" in found.skipped["RSN1_MADE_UP009.VT2"]
    assert "'SRSS' is not a finite number" in found.skipped["_SearchResults.csv"]
    assert re.match("a binary file|ObsPy does not read it", found.skipped["photo.png"])
    assert repr(found).splitlines()[-1].startswith("  no records: RSN1_MADE_UP-UP.DT2, ")
    scaled = found.scaled_to([0.01, 0.01], [0.1, 0.2])
    assert (scaled.skipped, (found | scaled).skipped) == (found.skipped, found.skipped)
    assert mr.records_in(tmp_path, pattern="*.AT2").skipped == {}
    written(tmp_path / "RSN2_MADE009.AT2", HEADS["at2"] + "0.1\n")
    with pytest.raises(ValueError, match=r"RSN2_MADE009\.AT2: 1 samples; the header states 6"):
        mr.records_in(tmp_path)
    with pytest.raises(ValueError, match=r"RSN1_MADE_UP279\.VT2: line 3 .* velocities"):
        mr.records_in(tmp_path, pattern="*.VT2")


def test_json_is_named(tmp_path):
    path = written(tmp_path / "a.json", '{"dT": 0.01,\n "data": [\n0.1,\n0.2,\n0.3\n]}')
    with pytest.raises(ValueError, match=r"a\.json: it is JSON; a text of accelerations in columns or rows is needed"):
        mr.GroundMotion.from_csv(path, "g", dt=0.01)


@pytest.mark.parametrize(
    ("name", "line", "stream"),
    [
        ("RSN1_MADE_A-VER083.AT2", "Made up, 1/1/2000, Somewhere, 83", "83"),
        ("RSN1_MADE_A-VER083.AT2", "Made up", "083"),
        ("RSN1_MADE_A-VER-UP.AT2", "Made up, 1/1/2000, Somewhere, UP", "UP"),
        ("RSN1_MADE_A-XYZVER.AT2", "Made up", "VER"),
        ("RSN1_MADE_A-VER.AT2", "Made up, 1/1/2000, Somewhere, 90", "90"),
        ("RSN1_MADE_A-083.AT2", "Made up, 1/1/2000, Somewhere, UP", "UP"),
    ],
)
def test_a_header_comes_before_a_guess_from_the_name(name, line, stream, tmp_path):
    written(tmp_path / name, PEER.replace("Somewhere, 1/1/99", line))
    found = mr.records_in(tmp_path)
    vertical = stream in ("UP", "VER")
    assert [motion.header.get("STREAM", "") for (motion,) in found.values()] == ["" if stream == "083" else stream]
    assert len(found.horizontal) == len(found.first) == (not vertical)
