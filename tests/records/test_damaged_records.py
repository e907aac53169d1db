"""Records from files that are damaged, of another kind or of another unit."""

import itertools
import re

import numpy as np
import pytest
from everyday import slow
from offenders import not_refused
from record_files import AT2, FORMATS, HEADS, NUMBERS, READ, SAMPLES, body, row, written

NO_NUMBERS = (
        "0.02-05", "0.02E-02-3", "2-5", ".123E-020.456E-02", ".5E", ".5E+", "1.2.3", "0x1p3", "1_5", "1e999",
        "\u0661\u0662", "\uff11", "0.1\u2212", "--.5", "+-.5", "1,5x", "nan", "1.5F-2", "infinity", "0.1.-.2", '"1"',
        "1\x1a2", "1\x0b2", "1\x0c2", "1\x852", "1\u20282", "1\xa02", "1\x1c2", "1\ufeff",
)  # fmt: skip


def not_named(folder, ending, texts, complaint):
    """Texts of files that are not refused with a complaint, or one for each."""
    complaints = [complaint] * len(texts) if isinstance(complaint, str) else complaint

    def read(text):
        return READ[ending](written(folder / f"a.{ending}", text))

    pairs = zip(texts, complaints, strict=True)
    calls = ((ascii(text), lambda text=text: read(text), complaint) for text, complaint in pairs)
    return not_refused(calls, (ValueError,))


@FORMATS
def test_what_is_no_number(tmp_path, ending):
    """In the first, a middle and the last row. In a file of one column a comma sets two columns apart, and a table may
    have quotes."""
    rows, head = body(ending).splitlines(), HEADS[ending]
    texts, complaints = [], []
    left_out = {"csv": '"', "txt": ',"'}.get(ending, "")
    for value in (one for one in NO_NUMBERS if not set(one) & set(left_out)):
        shown = ascii(value.replace(",", ".") if ending == "csv" else value)
        for i in (0, 2, 5):
            damaged = [*rows]
            damaged[i] = row(ending, i / 100, value, ";")
            texts.append(head + "\n".join(damaged) + "\n")
            line = re.escape(f"a.{ending}: line {head.count(chr(10)) + 1 + i}: {shown}")
            complaints.append(f"{line}.* is not a finite number such as")
    assert not_named(tmp_path, ending, texts, complaints) == []


def test_a_damaged_first_row_is_no_header(tmp_path):
    damages = ["\u0660\u0661,1", "\x1a0.00,1", "\u200b0.00,1", "\x850.00,1", "****,0.1"]
    texts = [f"time,accel\n{damage}\n0.01,2\n0.02,3\n" for damage in damages]
    assert not_named(tmp_path, "csv", texts, r"a\.csv: line 2: .* is not a finite number") == []


def test_a_row_does_not_hide_behind_a_control_character(tmp_path):
    characters = ["\x0b", "\x0c", "\x1a", "\x1e", "\x85", "\u2028", "\u2029"]
    heads = [f"{text}{character}" for text in ("time,accel", "# filtered") for character in characters]
    complaint = r"a\.csv: line 1 has a '.*'; only CR, LF and CR LF end a line"
    assert not_named(tmp_path, "csv", [f"{head}0.00,1\n0.01,2\n0.02,3\n" for head in heads], complaint) == []


@FORMATS
def test_ends_of_lines_and_of_a_dos_file(tmp_path, ending):
    for end, last in itertools.product(["\n", "\r\n", "\r"], ["", "\x1a", 90 * "\x1a", "\x1a\r\n\x1a "]):
        text = (HEADS[ending] + body(ending)).replace("\n", end)
        motion = READ[ending](written(tmp_path / f"a.{ending}", text + last))
        expected = (9.81 if ending == "at2" else 1) * np.array(SAMPLES)
        np.testing.assert_allclose(motion.accel, expected, rtol=1e-14, err_msg=repr((end, last)))


@FORMATS
def test_what_follows_an_end_of_dos_is_not_hidden(tmp_path, ending):
    with pytest.raises(ValueError, match=r"line \d+.* '.*\\x1a"):
        READ[ending](written(tmp_path / f"a.{ending}", HEADS[ending] + body(ending) + "\x1a\n1\n"))


NO_UNITS = (
        "ACCELERATION TIME SERIES IN UNITS OF G/1000", "ACCELERATION TIME SERIES IN UNITS OF G*10",
        "ACCELERATION TIME SERIES IN UNITS OF G, TIMES 10", "VELOCITY TIME SERIES IN UNITS OF CM/S",
        "VELOCITY TIME SERIES IN UNITS OF G", "DISPLACEMENT TIME SERIES IN UNITS OF CM",
        "DISPLACEMENT TIME SERIES IN UNITS OF G", "ACCELERATION TIME SERIES IN UNITS OF M/S/S",
        "ACCELERATION TIME SERIES IN UNITS OF MG", "ACCELERATION TIME SERIES IN UNITS OF 1/G", "UNITS OF G", "",
)  # fmt: skip


def test_a_unit_that_is_not_g(tmp_path):
    end = "NPTS= 6, DT= .01 SEC\n" + NUMBERS
    texts = [AT2.replace("ACCELERATION TIME SERIES IN UNITS OF G", line) + end for line in NO_UNITS]
    message = [re.escape(f"a.at2: line 3 is {line!r}") for line in NO_UNITS]
    kind = "not an AT2 file, whose line 3 is ACCELERATION TIME SERIES IN UNITS"
    assert not_named(tmp_path, "at2", texts, message) == not_named(tmp_path, "at2", texts, kind) == []


@pytest.mark.parametrize(
    "line",
    ["Acceleration time history in units of g.", "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=.1 Hz"],
)
def test_a_unit_that_is_g(tmp_path, line):
    text = AT2.replace("ACCELERATION TIME SERIES IN UNITS OF G", line) + "NPTS= 6, DT= .01 SEC\n" + NUMBERS
    assert READ["at2"](written(tmp_path / "a.at2", text)).peak == pytest.approx(9.81 * 0.05)


NO_HEADERS = (
        "NPTS= 6, DT= .5E -02 SEC", "NPTS= 6, DT= .01 MSEC", "NPTS= 6, DT= .01 SEC, SCALE= 100",
        "NPTS= 6.5, DT= .01 SEC", "NPTS= -6, DT= .01 SEC", "NPTS= \u0666, DT= .01 SEC", "X NPTS= 6, DT= .01 SEC",
        "6 .01 NPTS, DT, SCALE 100", "NPTS= 6, DT= 1_0E-3 SEC", "NPTS= 6, DT= 0.01.0 SEC", "NPTS= 6, DT= nan SEC",
        "NPTS= 99999999999, DT= .01 SEC",
)  # fmt: skip


def test_a_header_with_something_left_over(tmp_path):
    texts = [f"{AT2}{line}\n{NUMBERS}" for line in NO_HEADERS]
    message, kind = [re.escape(ascii(line)) for line in NO_HEADERS], "line 4 states no NPTS and DT as in NPTS= 4000"
    assert not_named(tmp_path, "at2", texts, message) == not_named(tmp_path, "at2", texts, kind) == []


def test_a_sac_header_with_something_left_over(tmp_path):
    texts = [f"STA\n{line}\n{NUMBERS}" for line in ("6 .01 0 zero", "6 .01 0 \u0660", "6 .01, 0")]
    assert not_named(tmp_path, "sac", texts, r"a\.sac: line 2") == []


@FORMATS
def test_an_empty_file(tmp_path, ending):
    contents = [b"", b"\n \t\r\n", b"\xef\xbb\xbf", b"\x1a", b"\x0b\x0c"]
    assert not_named(tmp_path, ending, contents, rf"a\.{ending}: an empty file") == []


OTHERS = (
    '<?xml version="1.0"?>\n<record>\n<unit>UNITS OF G</unit>\n<head>NPTS= 2, DT= .01</head>\n<a>0.1</a>\n</record>\n',
    '{"dt": 0.01,\n"accel": [0.1, 0.2]}\n', "one line", "PK\x03\x04zip", "\x89PNG\r\n\x1a\n",
)  # fmt: skip


@FORMATS
def test_a_file_of_another_format(tmp_path, ending):
    complaint = (
        rf"a\.{ending}: .*(not an? [\w ,-]+ file|none of the formats|not the plain text of a SAC|needed|only CR)"
    )
    assert not_named(tmp_path, ending, OTHERS, complaint) == []


@FORMATS
def test_utf_16_is_named(tmp_path, ending):
    with pytest.raises(ValueError, match="a binary file or one in UTF-16"):
        READ[ending](written(tmp_path / f"a.{ending}", (HEADS[ending] + body(ending)).encode("utf-16")))


@FORMATS
def test_a_unit_off_by_a_thousand_warns(tmp_path, ending):
    scale = {"at2": 1e3, "geonet": 1e6}.get(ending, 1e5)
    lines = (row(ending, 0.01 * i, f"{scale * x:g}") for i, x in enumerate(SAMPLES))
    with pytest.warns(UserWarning, match=r"\w.* peaks at [\d.]+ m/s2 = [\d.]+ g; accelerations are in m/s2"):
        READ[ending](written(tmp_path / f"a.{ending}", HEADS[ending] + "\n".join(lines)))


WORDS = [
    "nan",
    "-inf",
    "1e999",
    "1D-02",
    "NPTS",
    ":",
    "=",
    "\t",
    ",",
    ";",
    "#",
    "0x1",
    "\u0661",
    "\x1a",
    "\x0b",
    "9" * 400,
]
UNITS = ["m/s2", "g", "CM/S^2", "", "0", "-1", "6.5", "1e-9", "VELOCITY"]


def changed(rng, text):
    """A file with one to four damages: bytes, words, lines, its header, its end."""
    for _ in range(int(rng.integers(1, 5))):
        lines = text.split("\n")
        i, j = (int(k) for k in rng.integers(len(lines), size=2))
        words = lines[i].split(" ")
        kind = int(rng.integers(9))
        if kind == 0:
            k = int(rng.integers(len(text) + 1))
            text = text[:k] + chr(int(rng.integers(1, 0x250))) + text[k + int(rng.integers(3)) :]
        elif kind == 1:
            text = text[: int(rng.integers(len(text) + 1))]
        elif kind == 2:
            words[int(rng.integers(len(words)))] = str(rng.choice(WORDS))
        elif kind == 3:
            words[-1] = str(rng.choice(UNITS))
        elif kind == 4:
            lines[i], lines[j] = lines[j], lines[i]
        elif kind == 5:
            del lines[i]
        elif kind == 6:
            lines.insert(j, lines[i])
        elif kind == 7:
            text = text.replace("\n", str(rng.choice(["\r", "\r\n", " ", "\n\n"])), int(rng.integers(1, 9)))
        else:
            text += body(str(rng.choice(list(READ))))
        if kind in (2, 3):
            lines[i] = " ".join(words)
        if kind in (2, 3, 4, 5, 6):
            text = "\n".join(lines)
    return text


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("count", [40, slow(1000)])
@FORMATS
def test_any_damage_is_read_or_named(tmp_path, ending, count):
    """A damaged file gives finite accelerations, or a ValueError that begins with its name."""
    rng = np.random.default_rng(5)
    path, refused = tmp_path / f"a.{ending}", 0
    for _ in range(count):
        content = changed(rng, HEADS[ending] + body(ending)).encode(str(rng.choice(["utf-8", "latin-1"])), "replace")
        if rng.random() < 0.2:
            k = int(rng.integers(len(content) + 1))
            content = content[:k] + rng.bytes(3) + content[k:]
        written(path, content)
        motion, message = None, ""
        try:
            motion = READ[ending](path)
        except ValueError as error:
            message = str(error)
        if motion is None:
            assert message.startswith(f"{path}: "), content
            assert message.isprintable(), content
            refused += 1
        else:
            assert np.isfinite(motion.accel).all()
            assert len(motion.accel) >= 2
    assert 0.3 * count < refused < count
