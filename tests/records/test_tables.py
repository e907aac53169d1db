"""Tables as people have them: which columns, which decimal point, and what a header says against what a caller says."""

import time

import numpy as np
import pytest
import scipy.io
from record_files import written

import mjrock as mr

T = 0.01 * np.arange(200)
A = np.round(2.0 * np.exp(-((4 * (T - 1.0)) ** 2)) * np.sin(2 * np.pi * (T - 1.0) / 0.4), 5)
"""Accelerations of numbers of their own [m/s2], which end at rest."""


def lines(*columns, form="{:.5f}", between=" "):
    return "".join(between.join(form.format(x) for x in row) + "\n" for row in zip(*columns, strict=True))


def in_rows(count, form="{:.5f}", between=" ", values=A):
    rows = (values[i : i + count] for i in range(0, len(values), count))
    return "".join(between.join(form.format(x) for x in row) + "\n" for row in rows)


COMMAS = lines(T, A, between="\t").replace(".", ",")
FORMS = {
    "decimal commas between tabs": (COMMAS, {}),
    "decimal commas between blanks": (COMMAS.replace("\t", "   "), {}),
    "decimal commas between semicolons": (COMMAS.replace("\t", ";"), {}),
    "one column of decimal commas": (lines(A).replace(".", ","), {"dt": 0.01}),
    "quotes": ("".join(f'"{t:.2f}","{a:.5f}"\n' for t, a in zip(T, A, strict=True)), {}),
    "decimal commas in quotes": (
        "".join(f'"{t:.2f}","{a:.5f}"\n' for t, a in zip(T, A, strict=True)).replace(".", ","), {},
    ),
    "a last semicolon": (lines(T, A, between=";").replace("\n", ";\n"), {}),
    "a last comma and tab": (lines(T, A, between=",").replace("\n", ",\t\n"), {}),
    "a mark of UTF-8": ("\ufeff" + lines(T, A), {}),
    "CR CR LF": (lines(T, A).replace("\n", "\r\r\n"), {}),
    "Fortran exponents": (lines(T, A, form="{:.7E}").replace("E", "D"), {}),
    "glued columns": (in_rows(5, form="{:+.7E}", between=""), {"dt": 0.01}),
    "rows of five": (in_rows(5), {"dt": 0.01}),
    "rows of eight with a short one": (in_rows(7), {"dt": 0.01}),
    "rows, told so": (in_rows(2), {"dt": 0.01, "columns": "rows"}),
    "t a v d by number": (lines(T, A, T, -T), {"columns": (0, 1)}),
    "d v a t by number": (lines(T, -T, A, T), {"columns": (3, 2)}),
    "by name": ("Time (s),Vel (cm/s),Acc (m/s2)\n" + lines(T, T, A, between=","), {"columns": ("time", "ACC (m/s2)")}),
    "one of three with a step": (lines(T % 0.1, A, -A), {"columns": 1, "dt": 0.01}),
    "a step beside times": (lines(T, A), {"dt": 0.01}),
    "a step beside numbers of rows": (lines(np.arange(200), A, form="{:g}"), {"dt": 0.01}),
    "count and step ahead of times": ("200 0.01\n" + lines(T, A), {}),
    "count ahead of accelerations": ("200\n" + lines(A), {"dt": 0.01}),
    "count and step ahead of accelerations": ("200\n0.01\n" + lines(A), {}),
    "scale and step, left out": ("1\n0.01\n" + lines(A), {"dt": 0.01, "skip": 2}),
    "a title of digits": ("1999 Nowhere, a record\n" + lines(T, A), {}),
    "a step in the header": ("Made up, NPTS= 200, DT= .01 SEC\n" + in_rows(8), {}),
    "a rate in the header": ("sampling rate: 100 Hz\n" + lines(A), {}),
    "a corner of a filter in the header": ("cut-off frequency: 25 Hz, scale: 1.0\n" + lines(T, A), {}),
    "milliseconds in the header": ("time step 10 ms\n" + lines(A), {}),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_a_form_that_people_have(form, tmp_path):
    text, options = FORMS[form]
    motion = mr.GroundMotion.from_csv(written(tmp_path / "a.txt", text), "m/s2", **options)
    np.testing.assert_allclose(motion.accel, A, rtol=1e-12, atol=1e-9)
    assert motion.dt == pytest.approx(0.01, rel=1e-9)


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8"])
def test_a_header_in_any_letters(encoding, tmp_path):
    text = "Küste (cm/s²)\n" + lines(100 * A)
    motion = mr.GroundMotion.from_csv(written(tmp_path / "a.txt", text.encode(encoding)), dt=0.01)
    np.testing.assert_allclose(motion.accel, A, rtol=1e-12)


@pytest.mark.parametrize(
    ("written_so", "unit"),
    [
        ("Acc (g)", "g"), ("acceleration in units of g", "g"), ("Units: G", "g"), ("[cm/s2]", "cm/s2"),
        ("cm/sec/sec", "cm/s2"), ("GAL", "cm/s2"), ("a [m/s^2]", "m/s2"), ("m/s**2", "m/s2"), ("m s-2", "m/s2"),
        ("mm/s/s", "mm/s2"), ("ft/sec2", "ft/s2"),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore:.*is its unit right")
def test_a_unit_that_the_header_names(written_so, unit, tmp_path):
    """It is taken where none is given, and held against one that is."""
    path = written(tmp_path / "a.txt", f"# made up, {written_so}\n" + lines(A))
    requested = mr.GroundMotion.from_csv(written(tmp_path / "b.txt", lines(A)), unit, dt=0.01)
    assert mr.GroundMotion.from_csv(path, dt=0.01) == requested
    assert mr.GroundMotion.from_csv(path, unit, dt=0.01) == requested
    other = "cm/s2" if unit == "g" else "g"
    with pytest.raises(ValueError, match=rf"unit = '{other}' was given, and .* says {unit}; skip= leaves it out"):
        mr.GroundMotion.from_csv(path, other, dt=0.01)
    assert mr.GroundMotion.from_csv(path, "m/s2", dt=0.01, skip=1).peak == pytest.approx(np.abs(A).max())


DOUBTS = {
    "scale and step": (
        "1\n0.01\n" + lines(A), {"dt": 0.01},
        r"line 1 is 1 and line 2 is 0\.01 \(dt = 0\.01 s was given\): of the header, .* skip=2 reads .* skip=0 takes",
    ),
    "a step alone": ("0.01\n" + lines(A), {"dt": 0.01}, r"line 1 is 0\.01 .* skip=1 reads what follows"),
    "a number that stands alone": ("made up\n400\n" + lines(A), {"dt": 0.01}, r"line 2 is 400 .* skip=2 .* skip=1"),
    "a number beyond the peak": ("4\n" + lines(A), {"dt": 0.01}, r"line 1 is 4 .* skip=1 .* skip=0"),
    "a row ahead of the others": ("400 7\n" + lines(T, A, A), {"columns": (0, 1)}, r"line 1 is 400 7: of the header"),
    "numbers ahead of times": ("400 7\n" + lines(T, A), {}, r"line 1 is 400 7: of the header, or the first row"),
    "numbers of rows": (lines(np.arange(200), A, form="{:g}"), {}, r"first column steps by 1 s: times .* dt=1 takes"),
    "another step in the header": (
        "dt=0.005\n" + lines(A), {"dt": 0.01}, r"dt, which was given, is 0\.01 s, and line 1 states 0\.005 s; skip=",
    ),
    "another step in the times": (lines(T, A), {"dt": 0.005}, r"dt = 0\.005 s was given, and the times from line 1 on"),
    "another step of the times": (
        "dt=0.005\n" + lines(T, A), {}, r"the step of the times is 0\.01 s, and line 1 states 0\.005 s",
    ),
    "a scale": ("Scale factor = 2.5\n" + lines(T, A), {}, r"line 1 states a scale of 2\.5: of the samples, .* skip="),
    "another count": ("npts: 300\n" + lines(T, A), {}, r"200 samples; the header states 300 in line 1; skip="),
    "four columns": (
        "t;a;v;d\n" + lines(T, A, A, A, between=";"), {}, r"line 2 has 4 columns: 0 't', 1 'a', .* as columns=\(0, 1\)",
    ),
    "three of accelerations": (lines(A, A[::-1], A), {"dt": 0.01}, r"line 1 has 3 columns; .* such as columns=0"),
    "names in a file of one column": (
        lines(A), {"columns": ("time", "EW")}, r"line 1 has one column, .* takes several; leave it out and give its t"
    ),
    "a name in a file without names": (
        lines(T, A), {"columns": "EW"}, r"columns has 'EW'; the file has no names; give numbers, 0 to 1"
    ),
    "a name that is not there": ("t,a\n" + lines(T, A, between=","), {"columns": "b"}, r"'b'; the names are 't', 'a'"),
    "a column that is not there": (lines(T, A), {"columns": 2, "dt": 0.01}, r"a number in columns = 2 is outside"),
    "rows without a step": (in_rows(5), {}, r"or dt= and columns='rows' for samples in rows"),
    "a shorter last row of five": (in_rows(7), {}, r"line 29 has 4 columns; .* 7; samples in rows are read with dt"),
    "no unit": (lines(T, A), {"unit": None}, r"the header names no unit; give unit="),
    "two units": ("(g) or gal; made; up\n" + lines(T, A), {"unit": None}, r"the header names cm/s2 and g; give unit="),
    "two accelerations": (lines(T, A, A), {"columns": (0, 1, 2)}, r"columns has 2 accelerations; components_in reads"),
    "a shorter row": (lines(T, A) + "2.00\n", {}, r"line 201 has 1 columns; the others have 2"),
}  # fmt: skip


@pytest.mark.parametrize("doubt", DOUBTS)
def test_a_doubt_names_the_line_and_both_readings(doubt, tmp_path):
    text, options, complaint = DOUBTS[doubt]
    with pytest.raises(ValueError, match=rf"a\.txt: .*{complaint}"):
        mr.GroundMotion.from_csv(written(tmp_path / "a.txt", text), **({"unit": "m/s2"} | options))


def test_times_that_are_rounded_to_a_tenth_of_their_step(tmp_path):
    """1/128 s with three decimals; the step is that of the closest grid, and a missing row is none of rounding."""
    rows = [f"{i / 128:.3f} {a}" for i, a in enumerate(A)]
    motion = mr.GroundMotion.from_csv(written(tmp_path / "a.txt", "\n".join(rows)), "m/s2")
    assert motion.dt == pytest.approx(1 / 128, rel=1e-4)
    assert mr.GroundMotion.from_csv(tmp_path / "a.txt", "m/s2", dt=1 / 128).dt == 1 / 128
    del rows[70]
    with pytest.raises(ValueError, match="line 71: uneven time steps"):
        mr.GroundMotion.from_csv(written(tmp_path / "a.txt", "\n".join(rows)), "m/s2")


def test_all_components_of_a_table(tmp_path):
    text = "Time,NS (gal),UD (gal),EW (gal)\n" + lines(T, 100 * A, 10 * A, -100 * A, between=",")
    path = written(tmp_path / "XYZ.csv", text)
    east, north, up = mr.components_in(path, columns=(0, 1, 2, 3))
    assert [east.name, north.name, up.name] == ["XYZ EW", "XYZ NS", "XYZ UD"]
    for motion, factor in ((east, -1), (north, 1), (up, 0.1)):
        np.testing.assert_allclose(motion.accel, factor * A, rtol=1e-12)
    assert mr.GroundMotion.from_csv(path, columns=("time", "ns")) == north
    records = mr.records_in(tmp_path, lambda file: mr.components_in(file, columns=(0, 1, 2, 3)))
    assert records.horizontal == [east, north]
    assert records.by == {"XYZ.csv": "one file"}


def test_components_of_a_table_whose_times_are_in_milliseconds(tmp_path):
    """The unit of the times alone makes a file a table."""
    path = written(tmp_path / "a.txt", "t,a (gal)\n" + lines(1e3 * T, 100 * A, between=","))
    (motion,) = mr.components_in(path, time_unit="ms")
    assert motion.dt == pytest.approx(0.01)
    assert motion == mr.GroundMotion.from_csv(path, time_unit="ms")
    assert (motion,) == mr.components_in(path, time_unit="ms", columns=np.array([0, 1]))
    with pytest.raises(ValueError, match="time_unit = 'h' is not one of s, ms"):
        mr.components_in(path, time_unit="h")


def test_a_spreadsheet(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("openpyxl")
    frame = pandas.DataFrame({"t [s]": T, "a [g]": A / 9.81})
    with pandas.ExcelWriter(tmp_path / "a.xlsx") as file:
        frame.to_excel(file, sheet_name="record", index=False)
        pandas.DataFrame({"made": ["up"]}).to_excel(file, sheet_name="about")
    np.testing.assert_allclose(mr.GroundMotion.from_csv(tmp_path / "a.xlsx").accel, A, rtol=1e-12)
    with pandas.ExcelWriter(tmp_path / "b.xlsx") as file:
        for name, factor in (("one", 1), ("other", -1)):
            frame.assign(**{"a [g]": factor * A / 9.81}).to_excel(file, sheet_name=name, index=False)
    with pytest.raises(ValueError, match="2 sheets have rows of numbers, 'one, other'; choose with sheet=, such"):
        mr.GroundMotion.from_csv(tmp_path / "b.xlsx")
    np.testing.assert_allclose(mr.GroundMotion.from_csv(tmp_path / "b.xlsx", sheet="other").accel, -A, rtol=1e-12)
    assert mr.components_in(tmp_path / "b.xlsx", sheet="one")[0].peak == pytest.approx(A.max())
    with pytest.raises(ValueError, match="sheet = 'two' is not one of one, other"):
        mr.GroundMotion.from_csv(tmp_path / "b.xlsx", sheet="two")
    with pytest.raises(ValueError, match="sheet = 'one' is of a spreadsheet or a MATLAB file, and this is a text"):
        mr.GroundMotion.from_csv(written(tmp_path / "b.txt", lines(T, A)), "g", sheet="one")
    with pytest.raises(ValueError, match=r"c\.xlsx: pandas does not read it as a spreadsheet"):
        mr.GroundMotion.from_csv(written(tmp_path / "c.xlsx", "0 1\n"), "g")


def test_variables_of_matlab(tmp_path):
    """Vectors of one length are columns, scalars and words are the header, fields of a structure have its name."""
    path = tmp_path / "a.mat"
    scipy.io.savemat(path, {"acc": A[:, None], "dt": 0.01, "unit": "m/s2", "note": "made up"})
    assert mr.GroundMotion.from_csv(path) == mr.GroundMotion.from_file(path) == mr.components_in(path)[0]
    np.testing.assert_array_equal(mr.GroundMotion.from_csv(path).accel, A)
    assert mr.GroundMotion.from_csv(path).dt == 0.01
    scipy.io.savemat(path, {"rec": {"t": T, "a": A / 9.81, "fs": 100, "name": "made up"}, "T": np.arange(9.0)})
    with pytest.raises(ValueError, match=r"2 sheets have rows of numbers, 'rec\.t, T'; choose with sheet=, such as"):
        mr.GroundMotion.from_csv(path, "g")
    motion = mr.GroundMotion.from_csv(path, "g", columns=("rec.t", "rec.a"), sheet="rec.t")
    np.testing.assert_allclose(motion.accel, A, rtol=1e-12)
    scipy.io.savemat(path, {"data": np.stack([T, A, -A]), "Fs": 100.0})
    for column, sign in (("data 1", 1), (2, -1)):
        np.testing.assert_array_equal(mr.GroundMotion.from_csv(path, "m/s2", columns=(0, column)).accel, sign * A)
    for name, message in (
        ("vel", "these are velocities"),
        ("acc", "one column of accelerations; give its time step dt"),
    ):
        scipy.io.savemat(path, {name: A})
        with pytest.raises(ValueError, match=rf"a\.mat: .*{message}"):
            mr.GroundMotion.from_csv(path, "m/s2", dt=0.01 if name == "vel" else None)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_damaged_files_of_matlab(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"acc": A, "dt": 0.01})
    content, rng = (tmp_path / "a.mat").read_bytes(), np.random.default_rng(3)
    for _ in range(60):
        i = int(rng.integers(len(content)))
        damaged = (
            content[:i] + rng.bytes(2) + content[i + int(rng.integers(3)) :] if rng.random() < 0.7 else content[:i]
        )
        motion, message = None, f"{tmp_path / 'b.mat'}: "
        try:
            motion = mr.GroundMotion.from_csv(written(tmp_path / "b.mat", damaged), "m/s2")
        except ValueError as error:
            message = str(error)
        assert message.startswith(f"{tmp_path / 'b.mat'}: ")
        assert message.isprintable()
        assert motion is None or np.isfinite(motion.accel).all()
    with pytest.raises(
        ValueError, match=r"c\.at2: a MATLAB file, which GroundMotion\.from_csv reads by its name \.mat"
    ):
        mr.GroundMotion.from_at2(written(tmp_path / "c.at2", content))


@pytest.mark.parametrize("count", [4, 8])
def test_pairs_of_times_and_accelerations_in_rows(count, tmp_path):
    """As old files have them: t a t a. As samples they would be twice as many, half of them times."""
    pairs = np.column_stack([T, A]).ravel()
    path = written(tmp_path / "a.txt", in_rows(count, values=pairs))
    for dt in (None, 0.01):
        motion = mr.GroundMotion.from_csv(path, "m/s2", dt=dt, columns="rows")
        np.testing.assert_allclose(motion.accel, A, atol=1e-5)
        assert motion.dt == pytest.approx(0.01)
    with pytest.raises(ValueError, match=r"dt, which was given, is 0\.02 s, and line 1 states 0\.01 s"):
        mr.GroundMotion.from_csv(path, "m/s2", dt=0.02, columns="rows")
    for columns in ((0, 1), None):
        with pytest.raises(ValueError, match=rf"line 1 begins rows of {count // 2} pairs .* columns='rows' reads them"):
            mr.GroundMotion.from_csv(path, "m/s2", columns=columns)


@pytest.mark.filterwarnings("ignore:.*drifts")
def test_the_time_goes_with_the_length_of_a_file(tmp_path):
    """A table of four times as many rows takes some four times as long, and not sixteen times."""

    def seconds(count):
        path = written(tmp_path / "a.txt", "".join(f"{0.01 * i:.2f} {i % 7} {i % 5}\n" for i in range(count)))
        start = time.process_time()
        mr.components_in(path, 0.01, columns=(0, 1, 2))
        return time.process_time() - start

    seconds(1000)
    assert min(seconds(16_000) for _ in range(2)) < 10 * min(seconds(4000) for _ in range(2))
