"""Damaged files: each error names the file and a line that exists, in words, and nothing else is raised."""

import random
import tomllib
from pathlib import Path

import pytest

import mjrock as mr
from mjrock.assessment.tables import MOST_CHARACTERS

WHOLE = (Path(__file__).parent / "files" / "gable.toml").read_text(encoding="utf-8")
TEXT = WHOLE[: WHOLE.index("# The gable above the eaves")]
LINES = TEXT.splitlines()
PAIRS = [i for i, line in enumerate(LINES) if " = " in line and not line.startswith("#")]
HEADS = [i for i, line in enumerate(LINES) if line.startswith("[")]
VALUES = (
    "nan", "-inf", "-1e9", "1e400", '"forty"', '"40 lb"', '"4 m4"', "true", "[]", "{}", "1979-05-27", '""', "[[1], 2]",
    '"' + 300 * "9" + ' m"', '"1e999 m"', "99999999999999999999999999", '"\\u0000"', "[nan]", "{ kind = 3 }", "0x7f",
)  # fmt: skip


def without_line(draw, lines):
    del lines[draw.choice(PAIRS)]


def other_key(draw, lines):
    i = draw.choice(PAIRS)
    key, _, value = lines[i].partition(" = ")
    j = draw.randrange(len(key))
    lines[i] = f"{key[:j]}{draw.choice('xyz_')}{key[j:]} = {value}"


def other_value(draw, lines):
    i = draw.choice(PAIRS)
    lines[i] = f"{lines[i].partition(' = ')[0]} = {draw.choice(VALUES)}"


def doubled(draw, lines):
    i = draw.choice(PAIRS + HEADS)
    lines.insert(i, lines[i])


def other_head(draw, lines):
    i = draw.choice(HEADS)
    lines[i] = draw.choice(
        ["[wall", "[[wall]]", "[]", "[check]", "[mechanisms]", "[[mechanisms]]", "[site.SLX]", "[a.b.c]"]
    )


def cut_off(draw, lines):
    i = draw.choice(PAIRS)
    lines[i] = lines[i][: draw.randrange(1, len(lines[i]))]


def noise(draw, lines):
    i = draw.randrange(len(lines))
    j = draw.randrange(len(lines[i]) + 1)
    lines[i] = lines[i][:j] + draw.choice(["\x00", "=", "]", '"', "\ud7ff", "#", "[", "{", "'''", "\\"]) + lines[i][j:]


DAMAGES = without_line, other_key, other_value, doubled, other_head, cut_off, noise


def require_told(text, path):
    """Read a file and check it; what is wrong with it names its line. Returns whether something is."""
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        mr.from_toml(path).check()
    except mr.AssessmentError as error:
        found = error
    else:
        return False
    for fault in found.faults:
        whole = not fault.place and "[wall]" in fault.message
        assert whole or 1 <= fault.line <= text.count("\n") + 1, fault
        assert fault.message
        assert "\n" not in fault.message
        assert "object at 0x" not in fault.message
        assert len(fault.message) < 1200
    assert str(found).startswith(f"{path}:")
    return True


@pytest.mark.parametrize("count", [14, pytest.param(300, marks=pytest.mark.slow)])
def test_damaged_files_are_refused_with_their_line(count, tmp_path):
    draw, refused = random.Random(7), 0
    for i in range(count):
        lines = list(LINES)
        DAMAGES[i % len(DAMAGES)](draw, lines)
        refused += require_told("\n".join(lines), tmp_path / "wall.toml")
    assert refused > 0.7 * count
    assert [one.name for one in tmp_path.iterdir()] == ["wall.toml"]


def deep(levels):
    return f"a = {levels * '['}{levels * ']'}"


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "has no mechanism|has no wall"),
        ("\x00" * 100, ":1: .* is not TOML|is not TOML"),
        (deep(5000), "nested too deeply|is not TOML"),
        (deep(200), "nested too deeply"),
        (deep(20), "a is not known"),
        (".".join(2000 * "a") + " = 1", "not known|too deeply"),
        ("[wall]\n[wall]", ":2: is not TOML: Cannot declare"),
        ("[wall]\nthickness = 0,45\n", ":2: is not TOML: a number has a comma; the decimal mark is a point"),
        ("[wall]\nthickness = 0.45,\n", ":2: is not TOML: Expected newline"),
        ("wall = 3", "wall is 3 of type int; it takes a table"),
        ("mechanisms = 3", "mechanisms is no table of tables"),
        ("kind = 'Caes'", "did you mean 'Case'"),
        ("kind = 3", "kind = 3 of type int is not known"),
        ("[[wall]]\nthickness = 1", ":1: wall is a list"),
    ],
)  # fmt: skip
def test_odd_files_are_refused(text, complaint, tmp_path):
    path = tmp_path / "odd.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(mr.AssessmentError, match=complaint):
        mr.from_toml(path)


def test_what_is_no_text_is_refused(tmp_path):
    path = tmp_path / "wall.toml"
    path.write_bytes(b"[wall]\nthickness = \xff\xfe")
    with pytest.raises(mr.AssessmentError, match=r"wall.toml:2: is no text in UTF-8: byte 20 is 0xff"):
        mr.from_toml(path)
    with open(path, "wb") as file:
        file.truncate(100_000_000)
    with pytest.raises(mr.AssessmentError, match="has 100000000 bytes; the valid range is 0 to"):
        mr.from_toml(path)
    with pytest.raises(OSError, match="is not a file"):
        mr.from_toml(tmp_path)
    with pytest.raises(FileNotFoundError, match="missing"):
        mr.from_toml(tmp_path / "missing.toml")
    for wrong in ({}, {"path": path, "text": ""}):
        with pytest.raises(TypeError, match="takes a path, or a text"):
            mr.from_toml(**wrong)
    with pytest.raises(ValueError, match="the valid range is 0 to"):
        mr.from_toml(text=" " * (MOST_CHARACTERS + 1))


def test_windows_and_editors_write_it_too(tmp_path):
    path = tmp_path / "parete 1.toml"
    path.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    assert mr.from_toml(path).document == tomllib.loads(TEXT)
    path.write_bytes(TEXT.replace("8.0", "8.0x").replace("\n", "\r\n").encode())
    with pytest.raises(mr.AssessmentError, match=f"parete 1.toml:{1 + TEXT[: TEXT.index('8.0')].count(chr(10))}: "):
        mr.from_toml(path)


def test_a_number_may_be_infinite_where_the_argument_says_so():
    text = "[wall]\nthickness = 0.5\nheight = 4\n[[effects]]\nkind = 'Tie'\nheight = 3\nstiffness = 1e7\nstrength = inf"
    assert mr.from_toml(text=text).mechanisms[""].problem.effects[0] == mr.Tie(3.0, 1e7)
    with pytest.raises(mr.AssessmentError, match=r"line 7: effects\[0\].stiffness = inf N/m is outside"):
        mr.from_toml(text=text.replace("1e7", "inf"))
