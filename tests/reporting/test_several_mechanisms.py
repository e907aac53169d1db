"""A report of several mechanisms: each has its drawing, its curve and its clauses in one place, and its own runs."""

import re
import tomllib

import pytest
from everyday import among, slow

import mjrock as mr
from mjrock.assessment.assessment import assessment_of
from mjrock.commands import check
from mjrock.reporting.page import Request, required_runs
from mjrock.reporting.pictures import histories, strips
from mjrock.reporting.texts import Words

FILE = """
language = "{language}"
[site]
code = "NTC 2018"
soil = "B"
ag = "0.15 g"
F0 = 2.5
Tc = 0.33
[run]
polarities = false
[mechanisms.front]
side_stop = false
duration = 3.0
wall = {{ thickness = 0.5, height = 4.0 }}
[mechanisms.front.records]
kind = "GroundMotion"
make = "synthetic"
peak = "0.2 g"
duration = 2.0
seed = 1
[mechanisms.tied]
side_stop = false
wall = {{ thickness = 0.5, height = 4.0 }}
[[mechanisms.tied.effects]]
kind = "Tie"
height = 3.8
stiffness = 2e6
strength = 1e4
ultimate = 0.02
[mechanisms.low]
duration = 3.0
side_stop = false
wall = {{ thickness = 0.4, height = 2.0 }}
[mechanisms.low.records]
kind = "GroundMotion"
make = "synthetic"
peak = "0.3 g"
duration = 2.0
seed = 2
[mechanisms.angle]
kind = "Corner"
thickness = 0.5
height = 3.5
angle = "30 deg"
density = 2000
[mechanisms.bent]
kind = "VerticalBending"
load = "60 kN"
wall = {{ thickness = 0.3, height = 3.5, length = 4.0 }}
[mechanisms.stack]
kind = "MasonryCase"
[mechanisms.stack.masonry]
make = "stack"
blocks = [
  {{ thickness = 0.6, height = 1.2, length = 0.6, density = 2600 }},
  {{ thickness = 0.4, height = 1.7, length = 0.4, density = 2600 }},
]
"""


@pytest.fixture(scope="module", params=[slow("en"), "it"])
def page(request, tmp_path_factory):
    """The page of a file of five walls, one of them in two mechanisms, and its words."""
    assessment = mr.from_toml(text=FILE.format(language=request.param))
    moved = {name: [one.solve() for one in assessment.mechanisms[name].analyses()] for name in ("front", "low")}
    path = assessment.report(tmp_path_factory.mktemp("report") / "a.html", moved)
    return path.read_text(encoding="utf-8"), Words(request.param)


def sections(text):
    """What stands below each heading of a mechanism, up to the next heading, with the pictures cut out."""
    short = re.sub(r'src="data:[^"]*"', "src", text)
    return re.findall(r"<h3>(.*?)</h3>(.*?)(?=<h[23]|</body)", short, re.DOTALL)


def test_each_mechanism_has_its_drawing_its_curve_and_its_clauses_in_one_place(page):
    text, words = page
    found = {}
    for name, below in sections(text[: text.index(f"<h2>{words('runs')}</h2>")] + "</body"):
        found.setdefault(name, below)
    assert set(found) == {"front; tied", "low", "angle", "bent", "stack"}
    captions = {
        "low": words("drawing_wall"),
        "angle": words("drawing_corner"),
        "bent": words("drawing_bending"),
        "stack": words("drawing_masonry_mechanism"),
    }
    for name, caption in captions.items():
        drawing, curve = re.findall(r"<figcaption>(.*?)</figcaption>", found[name])
        assert drawing == f"{name}: {caption[0].lower()}{caption[1:]}"
        assert curve == words("curves_caption")
        assert "C8.7.1.2.1.6" in found[name]
    both = re.findall(r"<figcaption>(.*?)</figcaption>", found["front; tied"])
    assert sorted(both[:2])[0].startswith("front: ")
    assert sorted(both[:2])[1].startswith("tied: ")


def test_each_mechanism_has_its_own_runs(page):
    text, words = page
    shaken = text[text.index(f"<h2>{words('runs')}</h2>") :]
    names = [name for name, _ in sections(shaken)]
    assert names.count("front") == names.count("low") == 2  # the pictures, and the table of every run


def test_a_check_by_hand_is_of_each_wall_that_overturns(page):
    text, words = page
    hand = text[text.index(words("hand")) :].partition("</table>")[0]
    assert all(f">{name}</th>" in hand for name in ("front; tied", "low"))
    assert "angle" not in hand
    assert "bent" not in hand


def test_inputs_stand_under_the_names_of_the_mechanisms_alone(page):
    """A corner and a wall that bends are no wall that rocks."""
    text, words = page
    inputs = text[text.index(f"<b>{words('what_stands')}</b>") : text.index(f"<h2>{words('motions')}</h2>")]
    heads = re.findall(r"<th>(.*?)</th>", inputs)
    assert not {words("kind_wall"), words("kind_corner")} & set(heads)
    assert "angle" in heads
    assert "bent" in heads


def test_a_corner_is_called_a_corner(tmp_path):
    corner = mr.Corner(thickness=0.5, height=3.5, angle=0.5, density=2000.0)
    site = mr.code_spectrum("EC8 type 1", ag=1.0, soil="A")
    for language, word in (("en", "corner"), ("it", "cantonata")):
        path = tmp_path / f"{language}.html"
        mr.report(corner, (), path, checks=mr.mechanism_check(corner, site), language=language)
        text = re.sub(r'src="data:[^"]*"', "", path.read_text(encoding="utf-8"))
        assert f"<b>{word}</b>" in text
        assert f"<b>{word}: " in text
        assert f"<h1>{Words(language)('title_corner')}</h1>" in text
        assert Words(language)("in_side_stop") not in text
        assert Words(language)("hand") not in text


def test_responses_of_no_mechanism_are_refused(tmp_path):
    """A run of another wall than all that is checked."""
    site = mr.code_spectrum("EC8 type 1", ag=1.0, soil="A")
    low, other = (mr.Case(mr.Block.from_size(0.4, high), 0.01, 0.1) for high in (2.0, 3.0))
    runs = {"low": mr.solve_analytical(other, mr.Restitution.from_geometry(other.wall))}
    with pytest.raises(ValueError, match=r"\['low'\]\[0\] is of .* and the case and the checked mechanisms of"):
        mr.report(low, runs, tmp_path / "a.html", checks={"low": mr.mechanism_check(low, site)})


TIED = """
language = "{language}"
[site]
code = "NTC 2018"
soil = "B"
ag = "0.25 g"
F0 = 2.5
Tc = 0.33
[wall]
thickness = "50 cm"
height = "7.5 m"
length = "8 m"
[[effects]]
kind = "Tie"
height = "6.8 m"
stiffness = 7e6
strength = "60 kN"
ultimate = "10 cm"
[design]
key = "effects[0].strength"
values = ["-1 kN", "40 kN", "200 kN"]
method = "linear"
"""


@pytest.mark.parametrize("language", among(["en", "it"], "it"))
def test_a_report_has_the_design_of_its_file(language, tmp_path):
    """Every value with its ratio, the sentence, and all conditions of the value that is chosen."""
    assessment, words = mr.from_toml(text=TIED.format(language=language)), Words(language)
    found = assessment.design()
    text = assessment.report(tmp_path / "a.html").read_text(encoding="utf-8")
    part = text[text.index(f"<h2>{words('design')}</h2>") :].partition("<h2>")[2].partition("<h2>")[0]
    assert words("design_of", key="effects[0].strength") in part
    values, proposed = re.findall(r"<table.*?</table>", part)
    assert [f"{value}</td>" in values for value in ("-1 kN", "40 kN", "200 kN")] == [True] * 3
    assert found.value == "200 kN"
    verdicts = found.chosen.checks[""].verdicts
    assert [words.ratio(one.ratio) for one in verdicts] == re.findall(
        r'right">(\d+[.,]\d\d)</td><td class="(?:holds|fails)', proposed
    )
    assert {words("holds"), words("fails")} == set(re.findall(r"[✓✗][^<]*", proposed))


def test_what_a_design_tries_names_no_file_beyond_the_folder(tmp_path):
    """A key of a path is held to the folder, as that of the file is."""
    (tmp_path / "inner").mkdir()
    for file in ("outer.json", "inner/a.json"):
        mr.Masonry.box((0.5, 0.5, 2.0)).to_compas(tmp_path / file)
    masonry = 'kind = "MasonryCase"\n[masonry]\nmake = "from_compas"\npath = "a.json"\nfixed = ["ground"]\n'
    text = TIED.format(language="en")
    site = text[text.index("[site]") : text.index("[", text.index("[site]") + 1)]
    design = '[design]\nkey = "masonry.path"\nvalues = ["../outer.json"]\n'
    document = tomllib.loads(f"{masonry}{site}{design}")
    free, confined = (assessment_of(document, folder=tmp_path / "inner", confined=given) for given in (False, True))
    (tried,) = free.design().trials
    assert not tried.refused
    with pytest.raises(mr.AssessmentError, match=r"'../outer.json' leads out of the folder"):
        confined.design()


@pytest.mark.parametrize("method", ["linear", "nonlinear"])
def test_the_method_that_counts_is_one_in_check_command_and_report(method, tmp_path, capsys):
    """By itself the linear check of this wall holds, and the nonlinear one does not."""
    text = TIED.format(language="en").replace('"60 kN"', '"200 kN"').partition("[design]")[0]
    file = tmp_path / "wall.toml"
    file.write_text(f'{text}[check]\nmethod = "{method}"\n', encoding="utf-8")
    assert check.answer([str(file)]).status == (0 if method == "linear" else 1)
    assessment = mr.from_toml(file)
    (found,) = assessment.check().values()
    assert {one.what for one in found.verdicts} == {f"{method} kinematic"}
    page = assessment.report(tmp_path / "a.html").read_text(encoding="utf-8")
    assert f"The {method} check alone counts" in page
    counted = 1 if method == "linear" else 2  # on page 1 and in the steps
    assert len(re.findall(r'class="(?:holds|fails)">[✓✗]', page)) == 1 + counted  # the sentence, and each condition
    assert len(re.findall(r'class="right (?:holds|fails)"', page)) == counted
    assert found.table().count("does not count") == 3 - counted
    file.write_text(text, encoding="utf-8")
    answer = check.answer([str(file)])
    assert answer.status == 1
    assert "Methods are alternatives" in answer.text


def test_no_picture_of_many_records_fills_a_page():
    """Fourteen records: a second picture of each kind, in the scale of the first."""
    wall = mr.Block.from_size(0.5, 4.0)
    e = mr.Restitution.from_geometry(wall)
    motions = [mr.GroundMotion.half_sine(2.0 + 0.01 * i, 0.4) for i in range(14)]
    runs = [mr.solve_analytical(mr.Case(wall, 0.0, 0.5, motion=motion), e) for motion in motions]
    words = Words("en")
    found = required_runs(Request(runs[0].case, runs), words)
    for figures in (strips(found, [], "", words), histories(found, [run.theta for run in runs], None, words)):
        assert len(figures) == 2
        assert all(figure.get_figheight() < 5.2 for figure in figures)
        assert len({ax.get_xlim() for figure in figures for ax in figure.axes if ax.lines}) == 1
