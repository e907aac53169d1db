"""A code of local mechanisms is one file: the Italian one, one of your own, and what is no code."""

import math
import re
import string
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

import mjrock as mr
from mjrock.study.loading.code import CHECK_STEPS, CODE_FILES, code_of

PAGE = (Path(__file__).parents[2] / "docs" / "own_code.md").read_text(encoding="utf-8")
MUSEUM = re.search(r"^```toml\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)[1]
LINES, SHOWN = re.search(r"^```python\n(.*?)^```\n\n```text\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE).groups()
WALL = mr.Block.from_size(0.5, 2.0, 0.5, 2600.0)
CASE = mr.Case(WALL, 0.0, 1.0, side_stop=False)
SITE = mr.code_spectrum("EC8 type 1", ag=2.5, soil="B")
FILES = sorted(CODE_FILES.glob("*.toml"))


@pytest.fixture
def museum(tmp_path):
    (tmp_path / "museum.toml").write_text(MUSEUM, encoding="utf-8")
    return mr.Code.load(tmp_path / "museum.toml")


def test_the_lines_of_the_page_print_what_it_shows(museum, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with redirect_stdout(StringIO()) as out:
        exec(LINES, {})
    assert out.getvalue().rstrip() == SHOWN.rstrip()


def test_the_numbers_of_another_code_by_hand(museum):
    """d_0 = t / 2 of the centroid, which turns about the toe; half of it, the secant period there, and no more."""
    check = mr.mechanism_check(CASE, SITE, code=museum)
    R, alpha = math.hypot(0.25, 1.0), math.atan2(0.25, 1.0)
    theta = alpha - math.asin(0.125 / R)  # where the centroid has moved by 0.125 m
    a = mr.GRAVITY * math.tan(alpha - theta)
    T = 2 * math.pi * math.sqrt(0.125 / a)
    (name,) = check.states
    state = check.states[name]
    assert (name, check.confidence_factor, check.linear, check.linear_ratio) == ("stays", 1.0, None, None)
    assert state.capacity == pytest.approx(0.125, rel=1e-6)
    assert state.period == pytest.approx(T, rel=1e-4)
    assert state.demand == pytest.approx(float(SITE.displacement(T, 0.05)), rel=1e-4)
    (verdict,) = check.verdicts
    assert (verdict.limit_state, verdict.clause, verdict.unit) == ("stays", "rule 3", "m")
    assert check.ground_ratio == state.ratio  # no acceleration takes its place


def test_its_report_has_its_own_words_and_no_number_that_it_does_not_have(museum, tmp_path):
    motion = mr.GroundMotion.synthetic(1.0, 1.0, seed=1)
    answer = mr.solve_analytical(
        mr.Case(WALL, 0.0, 1.0, motion=motion, side_stop=False), mr.Restitution.from_geometry(WALL)
    )
    check = mr.mechanism_check(CASE, SITE, code=museum)
    path = mr.report(CASE, answer, tmp_path / "a.html", checks={"statue": check})
    page = re.sub(r"base64,[^\"]*", "", path.read_text(encoding="utf-8"))
    message = re.sub(r"<[^>]+>", " ", page)
    assert [one for one in ("rule 1", "rule 2", "rule 3", "museum of 2024", "stays") if one not in message] == []
    assert [one for one in ("SLV", "SLC", "SLD", "Circolare", "C8.7", "NTC 2018") if one in message] == []
    steps = page[page.index("The kinematic check") : page.index("<h2>", page.index("The kinematic check"))]
    # alpha_0, a(d_0) = 0, d = 0.5 d_0, T = 2 pi ..., xi = 5 %
    assert re.findall(r"<mn>(.*?)</mn>", steps) == ["0", "0", "0", "0.5", "0", "2", "5"]
    with pytest.raises(ValueError, match="language = 'it': the texts of Museum are in en"):
        mr.report(CASE, answer, tmp_path / "b.html", checks={"statue": check}, language="it")


def test_two_codes_in_one_report_have_a_table_each(museum, tmp_path):
    motion = mr.GroundMotion.synthetic(1.0, 1.0, seed=1)
    answer = mr.solve_analytical(
        mr.Case(WALL, 0.0, 1.0, motion=motion, side_stop=False), mr.Restitution.from_geometry(WALL)
    )
    checks = {code: mr.mechanism_check(CASE, SITE, code=given) for code, given in (("i", "NTC 2018"), ("m", museum))}
    page = mr.report(CASE, answer, tmp_path / "a.html", checks=checks).read_text(encoding="utf-8")
    assert page.count("<th>formula</th>") == 2


def test_dynamic_runs_are_refused_by_a_code_without_them(museum):
    with pytest.raises(ValueError, match="code = Museum has no check by dynamic runs"):
        mr.dynamic_check([], code=museum)


def test_a_code_is_named_or_given():
    italian = code_of("NTC 2018")
    assert mr.mechanism_check(CASE, SITE).code is italian is code_of(italian)
    assert list(italian.states) == ["SLV", "SLC"]
    with pytest.raises(ValueError, match="code = 'NTC 2008' is not one of NTC 2018"):
        mr.mechanism_check(CASE, SITE, code="NTC 2008")
    with pytest.raises(TypeError, match="code = 3"):
        mr.mechanism_check(CASE, SITE, code=3)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_code_of_the_package_has_every_step_in_both_languages(path):
    code = mr.Code.load(path)
    assert set(code.steps) == set(CHECK_STEPS)
    assert code.languages == ["en", "it"]
    texts = [*code.texts.values(), *(step.text for step in code.steps.values())]
    for text in texts:
        places = [
            sorted(name for _, name, _, _ in string.Formatter().parse(message) if name) for message in text.values()
        ]
        assert places[0] == places[1]


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("share = 0.5", "share = 5", "states.stays: share = 5 is outside the valid range 0.01 to 1"),
        ("damping = 0.05", "dampin = 0.05", "an entry of states.stays = 'dampin' is not one of share, period, damping"),
        ("damping = 0.05\n", "", "states.stays has no damping"),
        ("[steps.ratio]", "[steps.ratios]", "a key of steps = 'ratios' is not one of alpha_0"),
        ("{share:.1f}", "{shore:.1f}", r"steps.capacity has a place for 'shore'; the places are \{of\}, \{share\}"),
        ("PERIOD π", "BEHAVIOUR π", "steps.period.formula has 'BEHAVIOUR', which the code does not have there"),
        ("a(d_0) = 0", "SHARE d_0", "steps.d_0.formula has 'SHARE', which the code does not have there"),
        ('name = "Museum"', 'name = "Museum', "is not a code of local mechanisms"),
        ('name = "Museum"', "", "the file has no name"),
        ("[states.stays]", "[linear]\nstate = 'x'\nbehaviour = 2\n[states.stays]", "linear.state = 'x' is not one of"),
        ("[states.stays]", "[confidence]\nlow = 1.3\n[states.stays]", "do not increase"),
        ('text.en = "demand, xi = {damping:.0%}"', "text.en = 3", "steps.demand.en = 3"),
    ],
)
def test_what_is_no_code(old, new, complaint, tmp_path):
    assert old in MUSEUM
    (tmp_path / "own.toml").write_text(MUSEUM.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=complaint):
        mr.Code.load(tmp_path / "own.toml")
