"""The report: one page that holds all that it needs, and what it refuses."""

import base64
import re
from dataclasses import replace
from functools import cache
from io import BytesIO

import pytest
from matplotlib.figure import Figure
from PIL import Image

import mjrock as mr
from mjrock.reporting.content import of_messages

WALL = mr.Block.from_size(0.6, 4.2, 3.0, openings=[mr.Opening(1.0, 2.0)])
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, 5e8, 5e8)
TIE = mr.Tie(height=4.0, stiffness=2e6, slack=1e-3, strength=3e3, ultimate=0.002)
MOTION = mr.GroundMotion.synthetic(4.0, 2.0, seed=2)
EFFECTS = (TIE, mr.Thrust(3.5, 5e2), mr.Load(5e3, 4.2), mr.AddedMass(200.0, 4.2), mr.Damper(2.0, 10.0))
CASE = mr.Case(WALL, 0.0, 2.5, motion=MOTION, effects=(TIE,))


@cache
def answer():
    return mr.solve_analytical(CASE, E)


def test_one_page_with_all_that_it_needs(tmp_path):
    turned = mr.solve_analytical(mr.Case(WALL, 0.0, 2.5, motion=MOTION.reversed(), effects=(TIE,)), E)
    bare = mr.solve_analytical(mr.Case(WALL, 0.0, 2.5, motion=MOTION), E)
    path = mr.report(
        CASE,
        [answer(), bare, turned],
        tmp_path / "façade.html",
        title="Façade <7>",
        labels=["tied", "bare", "reversed"],
        e=E,
        contacts=CONTACTS,
        basis={"density": "3 cores", "k_base": "mortar"},
        notes="Does it stand?",
    )
    text = path.read_text(encoding="utf-8")
    assert "<title>Façade &lt;7&gt;</title>" in text
    assert not re.search(r"https?://|<script|<link|src=\"(?!data:)", text)
    pictures = re.findall(r'src="data:image/png;base64,([^"]*)"', text)
    sizes = [Image.open(BytesIO(base64.b64decode(data))).size for data in pictures]
    assert len(sizes) == 3  # the sketch, and a history for each of two motions
    assert min(min(size) for size in sizes) > 400
    for said in ("3 cores", "mortar", "Does it stand?", "2000 kg/m³", "1 x 2 m, sill 0 m", "breaks at 2 mm"):
        assert said in text
    for said in ("5e+08 N/m³", f"{MOTION.name}, reversed", "peak/alpha", "one record proves little", mr.__version__):
        assert said in text
    assert "both polarities" not in text
    assert answer().message in text.replace("&#x27;", "'")


def test_what_all_responses_were_solved_with_stands_above_the_table(tmp_path):
    """What they share is said once; steps, which differ, stay in the rows."""
    answers = [mr.simulate(mr.Case(WALL, share * WALL.alpha, 1.0), CONTACTS) for share in (0.3, 0.5)]
    steps = [answer.stats["steps"] for answer in answers]
    assert steps[0] != steps[1]
    text = mr.report(answers[0].case, answers, tmp_path / "a.html", e=E, contacts=CONTACTS).read_text(encoding="utf-8")
    assert text.count("accuracy 0.001") == 1
    assert "<p>Solved with MuJoCo, accuracy 0.001, timestep " in text
    assert all(f"{count} steps" in text for count in steps)
    alone = mr.report(CASE, [answer()], tmp_path / "b.html", e=E).read_text(encoding="utf-8")
    assert "<p>Solved with analytical, rtol " in alone
    assert "solved with" not in alone


def test_equal_messages_are_one_line():
    runs, names = [answer()] * 5, list("abcde")
    end = answer().message
    other = replace(answer(), message="It falls.")
    assert of_messages(runs[:2], names[:2]) == [f"a, b: {end}"]
    assert of_messages([*runs[:4], other], names) == [f"4 of 5 responses: {end}", "e: It falls."]


def test_ties_that_broke_are_told_in_one_sentence(tmp_path):
    pair = (TIE, TIE)
    cases = [mr.Case(WALL, 0.0, 2.5, motion=motion, effects=pair) for motion in MOTION.polarities]
    runs = [mr.solve_analytical(case, E) for case in cases]
    broken = [drawn.broken for run in runs for drawn in run.plastic.values()]
    assert len(broken) == 4
    bare = mr.solve_analytical(mr.Case(WALL, 0.0, 2.5, motion=MOTION), E)
    labels = ["recorded", "reversed", "bare"]
    text = mr.report(cases[0], [*runs, bare], tmp_path / "a.html", labels=labels).read_text(encoding="utf-8")
    assert f"tie_0, tie_1 broke in all 2 runs with them, first at {min(broken):.3f} s." in text
    assert text.count("broke in") == 1
    one = mr.report(cases[0], runs[0], tmp_path / "b.html", labels=["recorded"]).read_text(encoding="utf-8")
    assert f"recorded: tie_0, tie_1 broke, first at {min(broken[:2]):.3f} s." in one


def test_sections_hold_texts_figures_and_tables(tmp_path):
    check = mr.mechanism_check(CASE, lambda T, xi: 0.1)
    figure = Figure(figsize=(2.0, 1.0))
    curve = mr.fit_fragility([1.0, 2.0, 3.0, 4.0, 5.0], [False, True, False, True, True])
    given = {"Code check <SLV>": [check, "It is linear & not.", figure], "Fragility": curve}
    text = mr.report(CASE, answer(), tmp_path / "a.html", sections=given).read_text(encoding="utf-8")
    assert "<h2>Code check &lt;SLV&gt;</h2>" in text
    for said in (check.table(), curve.table(), "It is linear &amp; not."):
        assert said in text
    bare = mr.report(CASE, answer(), tmp_path / "b.html").read_text(encoding="utf-8")
    assert text.count("<img") == bare.count("<img") + 1
    assert "<pre>" not in bare
    assert text.index("<h2>Results") < text.index("<h2>Code check") < text.index("<h2>Inputs: wall")


def test_largest_forces_of_runs_that_kept_them(tmp_path):
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 0.5)] * 2, k_n=1e8)
    case = mr.MasonryCase(masonry, 1e-3)
    kept, bare = mr.solve_explicit(case, forces=True), mr.solve_explicit(case)
    text = mr.report(case, [kept, bare], tmp_path / "a.html", labels=["kept", "bare"]).read_text(encoding="utf-8")
    assert "<tr><td>kept</td><td>9.81 kN</td><td>9.81 kN</td><td>ground|block_0</td></tr>" in text  # two of 500 kg
    assert text.count("largest force of a joint") == 1
    assert "largest reaction" not in mr.report(case, bare, tmp_path / "b.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_same_report_is_the_same_bytes(tmp_path):
    paths = [mr.report(CASE, answer(), tmp_path / name) for name in ("a.html", "b.html")]
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert "in both polarities" in paths[0].read_text()


def test_a_sketch_names_values_or_arguments():
    case = mr.Case(WALL, 0.0, 1.0, side_stop=mr.SideStop(3.0), effects=EFFECTS)
    figure = mr.plotting.sketch(case)
    texts = "\n".join(text.get_text() for ax in figure.axes for text in ax.texts)
    for said in ("4.2 m", "0.6 m", "stop 3 m", "breaks at 2 mm", "0.5 kN outwards", "5 kN downwards", "200 kg"):
        assert said in texts
    figure = mr.plotting.sketch(case, arguments=True)
    texts = "\n".join(text.get_text() for ax in figure.axes for text in ax.texts)
    for said in ("Tie(height", "Thrust(height, force)", "Load(", "AddedMass(", "SideStop(top)", "Damper("):
        assert said in texts


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        ({"path": "facade.pdf"}, "path = 'facade.pdf' does not end in .html"),
        ({"responses": []}, "responses is empty"),
        ({"responses": 3}, "responses = 3 of type int"),
        ({"responses": [3]}, r"responses\[0\] = 3"),
        ({"labels": ["a", "b"]}, "labels has 2 texts for 1 responses"),
        ({"basis": {"k": "?"}}, "basis has 'k', which is not one of"),
        ({"basis": "mortar"}, "basis = 'mortar'"),
        ({"title": 3}, "title = 3"),
        ({"sections": "fragility"}, "sections = 'fragility' of type str is not a mapping of headings"),
        ({"sections": {"Code": 3}}, r"sections\['Code'\] = 3 of type int is not a text, a figure or a result"),
        ({"sections": {3: "x"}}, "a heading of sections = 3"),
        ({"e": 3}, "e = 3"),
        ({"case": mr.Case(mr.Block.from_size(0.5, 4.2), 0.0, 1.0)}, r"responses\[0\] is of"),
    ],
)
def test_what_cannot_be_reported(changed, complaint, tmp_path):
    given = {"case": CASE, "responses": answer(), "path": "facade.html"} | changed
    given["path"] = tmp_path / given["path"]
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.report(**given)
    assert not list(tmp_path.iterdir())


def test_masonry_is_not_of_the_wall(tmp_path):
    column = mr.Masonry.stack([mr.Block(0.3, 2.1)], 5e8)
    answer = mr.simulate(mr.MasonryCase(column, 0.05))
    with pytest.raises(ValueError, match=r"responses\[0\] is of masonry, and the case of <Block 0.6 x 4.2 m"):
        mr.report(CASE, answer, tmp_path / "a.html")
