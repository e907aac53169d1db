"""Files of networks: samples, step, station and component as their headers state them, and what is refused."""

import re

import numpy as np
import pytest
from record_files import CSMIP, GEONET, HEADS, KNET, READ, SAMPLES, SMC, UNAM, body, written

import mjrock as mr

STATED = {
    "knet": ("XYZ001 NS 2001/02/03 04:05:06", "NS", "XYZ001"),
    "geonet": ("WXYZ N10E 2001 February 03         04:05:06 UT", "N10E", "WXYZ"),
    "csmip": ("12345 360", "360", "12345"),
    "cosmos": ("XX WXYZ 45", "45", "WXYZ"),
    "smc": ("a", "270", None),
    "unam": ("MADE N90E", "N90E", "MADE"),
}


@pytest.mark.parametrize("ending", STATED)
def test_what_a_file_states(ending, tmp_path):
    motion = READ[ending](written(tmp_path / f"a.{ending}", HEADS[ending] + body(ending)))
    np.testing.assert_allclose(motion.accel, SAMPLES, rtol=1e-12)
    assert motion.dt == pytest.approx(0.01, rel=1e-12)
    assert (motion.name, motion.header["STREAM"], motion.header.get("STATION_CODE")) == STATED[ending]


@pytest.mark.parametrize("ending", READ)
def test_every_format_that_states_its_unit_is_recognised(ending, tmp_path):
    if ending in ("csv", "txt", "sac"):
        pytest.skip("states no unit")
    path = written(tmp_path / "a", HEADS[ending] + body(ending))
    assert mr.GroundMotion.from_file(path) == READ[ending](path)
    assert mr.components_in(path) == (READ[ending](path),)


@pytest.mark.parametrize("ending", ["knet", "geonet", "csmip", "cosmos", "smc", "unam"])
@pytest.mark.parametrize("count", [5, 7])
def test_another_number_of_samples_than_the_header_states(ending, count, tmp_path):
    """A file of CSMIP or COSMOS goes on after its samples, so that more of them are those of something else."""
    if ending in ("csmip", "cosmos") and count == 7:
        return
    text = HEADS[ending] + "0.1\n" * count
    with pytest.raises(ValueError, match=rf"{count} samples.* states 6"):
        READ[ending](written(tmp_path / "a", text))


def test_counts_are_taken_from_their_mean(tmp_path):
    """As the network does, whose header states the largest acceleration from it. The numbers 4 to 6 are the surface."""
    text = KNET.replace("2000(gal)/2000", "3000(gal)/6000") + "      90       94       80      98      88\n      90\n"
    motion = mr.GroundMotion.from_file(written(tmp_path / "a.NS2", text.replace("N-S", "4")))
    np.testing.assert_allclose(motion.accel, SAMPLES, atol=1e-15)
    assert (motion.header["STREAM"], motion.header["LOCATION"]) == ("NS", "2")
    for line in (
        "Scale Factor      3000(gal)/0",
        "Scale Factor      3000(gal)",
        "Dir.              7",
        "Sampling Freq(Hz) 0Hz",
    ):
        name = line[:12]
        damaged = re.sub(rf"{re.escape(name)}.*", line, text)
        with pytest.raises(ValueError, match=r"not as in a K-NET|is outside the valid range"):
            mr.GroundMotion.from_file(written(tmp_path / "b.NS2", damaged))


def test_components_of_one_file(tmp_path):
    """Velocities and displacements after the accelerations are passed over; columns of a stated width may touch."""
    rows = "  0.000000 20.000000-50.000000 40.000000-10.000000  0.000000\n"
    fixed = CSMIP.replace("in cm/sec2.", "in cm/sec2. (8f10.6)") + rows
    rest = "  6 points of veloc data equally spaced at  .010 sec, in cm/sec.  (8f10.7)\n" + 6 * " 1.0000000" + "\n"
    end = "/&  ----------  End of data for channel  1  ----------\n"
    text = (fixed + rest + end) * 3
    for number, old in enumerate(("Chan  1: 360 Deg", "Chan  1: 360 Deg", "Chan  1: 360 Deg")):
        new = ("Chan  1:  Up ", "Chan  2: 90 Deg", "Chan  3: 360 Deg")[number]
        first = text.index(old)
        after = text.index(end, first)
        text = text[:first] + text[first:after].replace(old, new) + text[after:]
    path = written(tmp_path / "a.V2", text)
    motions = mr.components_in(path)
    assert [motion.header["STREAM"] for motion in motions] == ["90", "360", "UP"]
    for motion in motions:
        np.testing.assert_allclose(motion.accel, 10 * np.array(SAMPLES), rtol=1e-12)
    assert mr.GroundMotion.from_file(path, "UP") == motions[2]
    with pytest.raises(ValueError, match=r"a\.V2: component = None; the file has 'UP', '90', '360'"):
        mr.GroundMotion.from_file(path)
    assert mr.records_in(tmp_path).horizontal == list(motions[:2])
    with pytest.raises(ValueError, match="names no unit of accelerations"):
        mr.GroundMotion.from_file(written(tmp_path / "b.V2", fixed.replace("in cm/sec2.", "in counts")))


def test_three_channels_of_unam(tmp_path):
    """A column of each, by the orientation that the header states; its counts and steps are held against the rows."""
    three = UNAM.replace("/N90E", "/N00E/V/N90W").replace(": /100", ": /100/100/100")
    three = three.replace("/.01", "/.01/.01/.01").replace(": /6", ": /6/6/6")
    rows = "".join(f"{100 * x:12.4f}{50 * x:12.4f}{-100 * x:12.4f}\n" for x in SAMPLES)
    motions = mr.components_in(written(tmp_path / "a.031", three + rows))
    assert [motion.header["STREAM"] for motion in motions] == ["N90W", "N00E", "V"]
    for motion, factor in zip(motions, (-1, 1, 0.5), strict=True):
        np.testing.assert_allclose(motion.accel, factor * np.array(SAMPLES), atol=1e-12)
    assert len(mr.records_in(tmp_path).horizontal) == 2
    for text, message in (
        (three + rows + rows[:37], "7 samples of 3 channels; line 10 states 6, 6, 6"),
        (three + rows.replace(rows[:12], "", 1), "line 16 has 2 columns for 3 channels"),
        (three.replace("Gal (cm/s/s)", "cm/s") + rows, "line 12 is 'units:  cm/s': these are velocities"),
        (three.replace("Gal (cm/s/s)", "cuentas") + rows, "line 12 names no unit of accelerations: 'cuentas'"),
        (three.replace("CLAVE DE LA", "SITIO") + rows, "the header has no CLAVE DE LA ESTACION"),
    ):
        with pytest.raises(ValueError, match=rf"b\.031: {message}"):
            mr.GroundMotion.from_file(written(tmp_path / "b.031", text), "V")


def test_spectra_are_no_record(tmp_path):
    """As the third volume of CSMIP has them."""
    text = "Response and Fourier Amplitude Spectra\nmade up\n 0.04 0.05 0.06\n0.1 0.2 0.3\n"
    with pytest.raises(ValueError, match=r"line 1 is 'Response and .*': these are spectra"):
        mr.GroundMotion.from_csv(written(tmp_path / "a.V3", text), "g", dt=0.01, columns="rows")
    text = "compatible with the response spectra of EC8\n" + "".join(f"{x}\n" for x in SAMPLES)
    assert mr.GroundMotion.from_csv(written(tmp_path / "a.txt", text), "m/s2", dt=0.01).peak == 0.05


def test_three_components_of_geonet(tmp_path):
    one = GEONET + body("geonet") + 12 * "0.5\n"
    text = one + one.replace("N10E", "N80W") + one.replace("N10E", "Up  ")
    motions = mr.components_in(written(tmp_path / "a.V2A", text))
    assert [motion.header["STREAM"] for motion in motions] == ["N80W", "N10E", "Up"]
    np.testing.assert_allclose([motion.accel for motion in motions], [SAMPLES] * 3, rtol=1e-12)
    uncorrected = GEONET.replace("Corrected", "Uncorrected").replace(
        "Instrument corrected data at 0.010 sec intervals",
        "Raw readings in units of 1.00 mm/s/s  at intervals of 0.010 s",
    )
    assert mr.GroundMotion.from_file(written(tmp_path / "a.V1A", uncorrected + body("geonet"))).dt == 0.01


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        (SMC.replace("2 CORRECTED", "1 UNCORRECTED"), "not an SMC file of a record, 2 CORRECTED ACCELEROGRAM"),
        (SMC.replace("  1.0000000E+02", "  1.7000000E+38"), "line 18: samples a second = 1.7e\\+38 Hz is outside"),
        (GEONET.replace("Component", "Part"), "lines 1 to 16 state no STREAM"),
        ("made up\n\n", "0 rows .* as a table, as from_csv .* none of the formats PEER AT2, .* SAC, miniSEED"),
    ],
)
def test_what_is_refused_names_the_line(text, complaint, tmp_path):
    with pytest.raises(ValueError, match=rf"a\.dat: .*{complaint}"):
        mr.GroundMotion.from_file(written(tmp_path / "a.dat", text + body("smc")[:0]))


@pytest.mark.parametrize(
    "tail",
    [
        " ",
        "   0 POLE @    13.90000 HZ,  -5 POLE @      .10000",
        ", HP= .1 HZ",
        ",LP=25.0 Hz HP= .1",
        " filter points: HP=.1 Hz",
    ],
)
def test_filters_after_the_step_of_an_at2(tail, tmp_path):
    text = HEADS["at2"].replace("SEC", "SEC," + tail)
    assert READ["at2"](written(tmp_path / "a.at2", text + body("at2"))).dt == 0.01


def test_an_old_table_with_the_step_in_its_header(tmp_path):
    """As an old record has it that OpenSees comes with: no title of PEER, and eight samples in a row."""
    text = "Made up, north south\n6 points at equal spacing of 0.01 sec\nThe units are (g)\nNPTS= 6, DT= .01 SEC\n"
    motion = mr.GroundMotion.from_file(written(tmp_path / "a.AT2", text + "  0.0 0.02 -0.05 0.04\n -0.01 0.0\n"))
    np.testing.assert_allclose(motion.accel, 9.81 * np.array(SAMPLES), rtol=1e-12)
    assert motion.dt == 0.01


def test_a_sac_text_asks_for_its_unit(tmp_path):
    path = written(tmp_path / "a.sac", HEADS["sac"] + body("sac"))
    with pytest.warns(FutureWarning, match=r"states no unit: give unit=, .* cm/s2 are taken"):
        assert mr.GroundMotion.from_sac(path) == mr.GroundMotion.from_sac(path, "cm/s2")
    assert mr.GroundMotion.from_sac(path, "m/s2").peak == 100 * mr.GroundMotion.from_sac(path, 0.01).peak


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (bytes(304) + b"\6\0\0\0" + bytes(400), "a binary SAC file, which GroundMotion.from_file reads by ObsPy"),
        (b"000001D STA" + bytes(500), "a miniSEED file, which GroundMotion.from_file reads by ObsPy"),
    ],
)
def test_files_of_seismology_are_called_by_their_name(data, kind, tmp_path):
    path = written(tmp_path / "a.sac", data)
    for read in (READ["sac"], READ["csv"], READ["at2"]):
        with pytest.raises(ValueError, match=rf"a\.sac: {kind}"):
            read(path)
