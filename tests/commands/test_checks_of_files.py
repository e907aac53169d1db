"""`mjrock new`, `check`, `report` and `schema`: templates run as they are, and a verdict is that of the objects."""

import io
import json
import re
import sys
from functools import cache
from itertools import pairwise

import pytest
from everyday import among

import mjrock as mr
from mjrock.__main__ import main
from mjrock.assessment.templates import TEMPLATE_WIDTH, seeds, templates
from mjrock.command_line import Status

GARDEN_WALL = """
side_stop = false
[wall]
thickness = {thickness}
height = "2 m"
[site]
code = "EC8 type 1"
ag = "0.1 g"
soil = "A"
"""
THICK, THIN = GARDEN_WALL.format(thickness='"50 cm"'), GARDEN_WALL.format(thickness=0.1)
TEMPLATES = list(seeds())
WALLS = [name for name in TEMPLATES if name != "masonry"]


@pytest.fixture(scope="module")
def texts():
    """The text of each template by name."""
    return templates()


@cache
def checks_of(text):
    """The checks of a file by its text, made once."""
    return mr.from_toml(text=text).check()


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """An empty folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def printed(capsys, *arguments, status=Status.HOLDS):
    """The standard output of a command."""
    assert main([str(argument) for argument in arguments]) == status
    return capsys.readouterr().out


def refused(capsys, *arguments):
    """What a command writes to the standard error that ends with an error."""
    assert main([str(argument) for argument in arguments]) == Status.ERROR
    return capsys.readouterr().err


@pytest.mark.parametrize("name", among(TEMPLATES, *WALLS))
def test_a_template_is_checked_as_it_is_and_fits_into_100_columns(name, here, capsys):
    assert printed(capsys, "new", name, "-o", "wall.toml") == "written: wall.toml\n"
    text = (here / "wall.toml").read_text(encoding="utf-8")
    assert printed(capsys, "new", name) == text
    assert max(map(len, text.splitlines())) <= TEMPLATE_WIDTH
    checks = checks_of(text)
    holds = all(verdict.holds for check in checks.values() for verdict in check.verdicts)
    message = printed(capsys, "check", "wall.toml", status=Status.HOLDS if holds else Status.FAILS)
    assert message.count("C8.7.1.2.1.") == sum(len(check.verdicts) for check in checks.values())


@pytest.mark.parametrize("name", among(TEMPLATES, *WALLS))
def test_keys_that_may_be_left_out_have_the_values_that_a_template_shows(name, texts):
    """With all of them taken out of their comments, every step of every check is the same number."""
    text = texts[name]
    whole = re.sub(r"(?m)^#(?=\w+ = \S)", "", text)
    assert whole.count("\n#") < text.count("\n#") - 2
    given, left_out = checks_of(whole), checks_of(text)
    assert {key: check.steps for key, check in given.items()} == {key: one.steps for key, one in left_out.items()}


def test_a_template_says_meaning_unit_and_range_of_each_key_that_it_has(texts):
    for name in TEMPLATES:
        lines = re.sub(r"(?m)^\[project\]\n(.+\n)*", "", texts[name]).splitlines()
        for before, line in pairwise(lines):
            if re.match(r"\w+ = ", line) and not re.match(r"kind|make", line):
                assert before.startswith("# ") or " # " in line, (name, line)
    assert 'thickness = "55 cm"               # 2b at the base [m], 0.002 to 20.' in texts["facade"]


def test_the_exit_status_is_the_verdict_and_the_worst_mechanism_stands_first(here, capsys):
    (here / "thick.toml").write_text(THICK)
    (here / "thin.toml").write_text(THIN)
    site = THICK[THICK.index("[site]") :]
    both = [f"[mechanisms.{name}.wall]\nthickness = {t}\nheight = 2.0\n" for name, t in (("thick", 0.5), ("thin", 0.1))]
    (here / "both.toml").write_text(site + "".join(both))
    printed(capsys, "check", "thick.toml")
    printed(capsys, "check", "thin.toml", status=Status.FAILS)
    message = printed(capsys, "check", "both.toml", "thick.toml", status=Status.FAILS)
    assert message.index("thin ") < message.index("thick ")
    assert "thin governs: no condition holds." in message
    assert message.count(".toml\n") == 2


def test_a_table_is_in_the_language_of_the_file_or_of_the_option(here, capsys):
    (here / "muro.toml").write_text('language = "it"\n' + THICK)
    italian = printed(capsys, "check", "muro.toml", "--steps")
    assert "✓ VERIFICATO" in italian
    assert "moltiplicatore di attivazione" in italian
    assert re.search(r"\d,\d", italian)
    english = printed(capsys, "check", "muro.toml", "--steps", "--language", "en")
    assert "✓ HOLDS" in english
    assert not re.search(r"\d,\d", english)


def test_other_programs_read_the_numbers_of_the_objects(here, capsys):
    (here / "wall.toml").write_text(THIN)
    (found,) = json.loads(printed(capsys, "check", "wall.toml", "--json", status=Status.FAILS))
    check = mr.from_toml("wall.toml").check()[""]
    assert (found["file"], found["mechanism"], found["holds"]) == ("wall.toml", "", False)
    assert [one["ratio"] for one in found["conditions"]] == [verdict.ratio for verdict in check.verdicts]
    assert {one["key"]: one["value"] for one in found["steps"] if not one["of"]}["alpha_0"] == check.alpha_0


def test_what_is_wrong_with_a_file_keeps_no_other_from_being_checked(here, capsys):
    (here / "wrong.toml").write_text(THICK.replace("50 cm", "50 kg"))
    (here / "right.toml").write_text(THICK)
    assert main(["check", "wrong.toml", "none.toml", "right.toml"]) == Status.ERROR
    message = capsys.readouterr()
    assert message.out.startswith("right.toml\n")
    wrong, absent = message.err.splitlines()
    assert wrong.startswith("error: wrong.toml:4: wall.thickness = '50 kg' ")
    assert absent == "error: none.toml: No such file or directory"


@pytest.mark.parametrize("name", ["prova è così.toml", "Müller & Söhne [2].toml", "-wall.toml"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_names_line_ends_and_encodings_of_other_systems(name, end, encoding, here, capsys):
    """PowerShell writes UTF-16."""
    right, wrong = (text.replace("\n", end).encode(encoding) for text in (THICK, THICK.replace("0.1 g", "0.1 kg")))
    (here / name).write_bytes(right)
    assert "✓ HOLDS" in printed(capsys, "check", f"./{name}")
    (here / name).write_bytes(wrong)
    assert refused(capsys, "check", f"./{name}").startswith(f"error: ./{name}:8: site.ag".replace("./", ""))


def test_a_folder_is_no_file(here, capsys):
    assert refused(capsys, "check", ".") == "error: .: is not a file\n"


def test_the_standard_input_is_a_file_too(capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(THICK.encode())))
    assert printed(capsys, "check", "-").startswith("standard input\n")
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"\xffa")))
    assert "standard input:1: is no text in UTF-8" in refused(capsys, "check", "-")


def test_a_report_is_written_beside_its_file_and_replaces_nothing_by_itself(here, capsys):
    (here / "muro di cinta.toml").write_text(THICK)
    assert printed(capsys, "report", "muro di cinta.toml", "-l", "it") == "written: muro di cinta.html\n"
    page = here / "muro di cinta.html"
    assert "VERIFICATO" in page.read_text(encoding="utf-8")
    assert "muro di cinta.html: exists already" in refused(capsys, "report", "muro di cinta.toml")
    assert "VERIFICATO" in page.read_text(encoding="utf-8")
    printed(capsys, "report", "muro di cinta.toml", "--force")
    assert "VERIFICATO" not in page.read_text(encoding="utf-8")
    assert "does not end in .html or .pdf" in refused(capsys, "report", "muro di cinta.toml", "-o", "report.doc")


def test_a_pdf_without_weasyprint_is_refused_with_the_remedy(here, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    (here / "wall.toml").write_text(THICK)
    assert "pip install weasyprint" in refused(capsys, "report", "wall.toml", "-o", "wall.pdf")
    assert [path.name for path in here.iterdir()] == ["wall.toml"]


@pytest.mark.slow
@pytest.mark.parametrize("name", TEMPLATES)
def test_every_template_has_a_report(name, here, capsys):
    printed(capsys, "new", name, "-o", "wall.toml")
    printed(capsys, "report", "wall.toml")
    page = (here / "wall.html").read_text(encoding="utf-8")
    assert page.count('src="data:image/png') >= 2  # what moves, and a curve
    assert "C8.7.1.2.1." in page


def test_the_schema_is_that_of_files(capsys):
    assert json.loads(printed(capsys, "schema")) == json.loads(json.dumps(mr.toml_schema()))
