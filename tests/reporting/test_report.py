"""The report: what it answers, in both languages; one page that holds all that it needs, and what it refuses."""

import base64
import html
import re
import string
import sys
from dataclasses import replace
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from everyday import among
from matplotlib.figure import Figure
from PIL import Image

import mjrock as mr
from mjrock.quantities import ratio_text, share_text
from mjrock.reporting import markup
from mjrock.reporting.markup import formula
from mjrock.reporting.texts import DASH, FOUND, Words, languages, texts
from mjrock.study.loading.dynamic_check import RunMaximum
from mjrock.study.loading.mechanism_check import LimitState
from mjrock.study.loading.verdict import Verdict, verdict_rows

WALL = mr.Block.from_size(0.6, 4.2, 3.0, openings=[mr.Opening(1.0, 2.0)])
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, 5e8, 5e8)
TIE = mr.Tie(height=4.0, stiffness=2e6, slack=1e-3, strength=3e3, ultimate=0.002)
MOTION = mr.GroundMotion.synthetic(4.0, 2.0, seed=2)
EFFECTS = (
    TIE,
    mr.Thrust(3.5, 5e2),
    mr.Load(5e3, 4.2),
    mr.AddedMass(200.0, 4.2),
    mr.Damper(2.0, 10.0),
    mr.FrictionDamper(3.0, 1e6, 2e3),
)
CASE = mr.Case(WALL, 0.0, 2.5, motion=MOTION, effects=(TIE,))
SITE = mr.code_spectrum("EC8 type 1", ag=2.0, soil="A")
LANGUAGES = ("en", "it")
CHECK = mr.mechanism_check(CASE, SITE)


@cache
def answer():
    return mr.solve_analytical(CASE, E)


@cache
def variants():
    """Both polarities of a wall with its tie and without."""
    effects = {"tied": (TIE,), "bare": ()}
    return {
        name: [
            mr.solve_analytical(mr.Case(WALL, 0.0, 2.5, motion=motion, effects=own), E) for motion in MOTION.polarities
        ]
        for name, own in effects.items()
    }


@cache
def checks():
    return {
        name: [mr.mechanism_check(runs[0].case, SITE), mr.dynamic_check(runs, natural=False)]
        for name, runs in variants().items()
    }


@cache
def whole(language):
    """The text of a report with all that it may have, its pictures cut out, and its pictures."""
    case = mr.Case(WALL, 0.0, 2.5, motion=MOTION, effects=EFFECTS)
    fit = mr.fit_fragility([1.0, 2.0, 3.0, 4.0, 5.0], [False, True, False, True, True])
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(markup, "DOTS_PER_INCH", 170)  # as users have them
        path = mr.report(
            case,
            variants(),
            Path(folder) / "a.html",
            title="Façade <7>",
            e=E,
            contacts=CONTACTS,
            checks=checks(),
            project={"project": "San <b>Rocco</b> & Co", "client": "</style><script>"},
            language=language,
            basis={"density": "3 cores", "k_base": "mortar", "tie_0": "pulled"},
            notes="Does it stand?",
            sections={"F": {"c": fit}},
        )
        text = path.read_text(encoding="utf-8")
    pictures = re.findall(r'src="data:image/png;base64,([^"]*)"', text)
    return re.sub(r"base64,[^\"]*", "", text), [Image.open(BytesIO(base64.b64decode(data))) for data in pictures]


def read(text):
    """What a reader reads: a page without its head and its tags."""
    body = text[text.index("<body>") :]
    return html.unescape(re.sub(r"<[^>]+>", " ", body)).replace("\u00a0", " ")


def page_of(tmp_path, case, responses, **options):
    path = mr.report(case, responses, tmp_path / "a.html", **options)
    return re.sub(r"base64,[^\"]*", "", path.read_text(encoding="utf-8"))


def places(text):
    """Names of the values that a text has a place for."""
    return sorted(name for _, name, _, _ in string.Formatter().parse(text) if name is not None)


def test_every_text_has_all_languages_and_the_same_places_for_values():
    assert languages() == list(LANGUAGES)
    offenders = [key for key, text in texts().items() if set(text) != set(LANGUAGES)]
    offenders += [key for key, text in texts().items() if places(text["en"]) != places(text["it"])]
    assert offenders == []
    assert len(texts()) > 200


def test_every_text_is_used():
    package = Path(mr.__file__).parent
    code = "".join(
        path.read_text()
        for path in (
            one for of in ("reporting", "study/loading", "assessment", "commands") for one in package.glob(f"{of}/*.py")
        )
    )
    built = re.findall(r'f"([a-z0-9]+_)\{', code)
    assert {"in_", "run_", "field_"} <= set(built)
    built.append("drawn_")  # what plot functions print, see test_texts_of_pictures.py
    assert [
        key
        for key in texts()
        if f"{key}" not in re.findall(r"words\(f?[\"'](\w+)", code)
        and f'"{key}"' not in code
        and not key.startswith(tuple(built))
    ] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_first_page_answers(language):
    text, _ = whole(language)
    words = Words(language)
    end = text.index(html.escape(words("checks"), quote=False))
    first = read(text[:end])
    order = ["Façade <7>", "San <b>Rocco</b> & Co", "Does it stand?", words("answer"), words("verdict_ratio")]
    places = [first.index(message) for message in order]
    assert places == sorted(places)
    each = [[verdict for check in of for verdict in check.verdicts] for of in checks().values()]
    ranked = sorted(each, key=lambda verdicts: min(verdict.ratio for verdict in verdicts))
    found = [verdict for verdicts in ranked for verdict in verdicts]
    assert 0 < sum(verdict.holds for verdict in found) < len(found)
    rows = [row for row in re.findall(r"<tr>(.*?)</tr>", text[:end]) if "C8.7" in row]
    assert len(rows) == len(found) == 10
    for row, verdict in zip(rows, found, strict=True):
        kind = "holds" if verdict.holds else "fails"
        assert f'<td class="{kind}">{words(kind)}</td>' in row
        assert words.quantity(verdict.capacity, verdict.unit, FOUND) in row
        assert words.ratio(verdict.ratio) in row
    assert text.index("<img") < end


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_name_of_code_is_in_the_text(language):
    message = read(whole(language)[0])
    names = r"\w+_\w+|\b(?:inf|nan|None|True|False|CALIBRATED|N/m3|kg/m3|m/s2|e[+-]\d\d)\b|\d\.\d+e|[{}]"
    assert set(re.findall(names, message.replace(MOTION.name, "").replace("_" * 22, ""))) == set()


@pytest.mark.parametrize(
    ("language", "message"),
    [
        (
            "en",
            ["HOLDS", "FAILS", "linear kinematic", "dynamic: mean of the maxima", "tie 1", "2000 kg/m³", "500 MN/m³"],
        ),
        (
            "en",
            ["breaks when drawn out by 2 mm", "slips at 2 kN", "sill at 0 m", "3 cores", "mortar", "pulled"],
        ),
        ("en", ["ties broke in", "What governs", "alternative methods", "NTC 2018, 10.2", "horizontal"]),
        ("it", ["VERIFICATO", "NON VERIFICATO", "cinematica lineare", "dinamica: media dei massimi", "catena 1"]),
        ("it", ["si rompe per un allungamento di 2 mm", "spessore", "0,6 m", "scorre a 2 kN", "massa volumica"]),
        (
            "it",
            ["catene rotte in", "Cosa governa", "NTC 2018, § 10.2", "Giudizio motivato", "orizzontale", "Committente"],
        ),
    ],
)
def test_words_of_both_languages(language, message):
    text = read(whole(language)[0])
    assert [one for one in message if one not in text] == []


def test_an_italian_report_has_no_english_words_nor_points_in_numbers():
    message = read(whole("it")[0]).replace(MOTION.name, "")
    words = r"\b(?:the|and|of|with|runs?|wall|height|mass|holds|fails|at rest|overturned)\b"
    assert re.findall(words, message) == []
    without = re.sub(r"C8\.[.\d]+|(?:mjrock|MuJoCo|NumPy|SciPy|matplotlib|Python|Apache-|§) ?[.\d]+", "", message)
    assert re.findall(r"\d+\.\d+", without) == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_one_page_that_needs_no_other_file_and_is_read_on_paper_and_phones(language):
    text, pictures = whole(language)
    assert f'<html lang="{language}">' in text
    assert not re.search(r"https?://|<script|<link|src=\"(?!data:)", text)
    assert '<meta name="viewport" content="width=device-width' in text
    assert text.count("<table") == text.count('<div class="wide"><table')
    assert len(pictures) == 6  # the case, its two variants, the curves, the strip and the histories
    assert all(min(picture.size) > 280 and picture.size[0] == 1190 for picture in pictures)
    style = text[text.index("<style>") : text.index("</style>")]
    assert "counter(page)" in style
    assert "<" not in style.removeprefix("<style>")


def test_what_is_written_is_shown_and_never_run():
    text, _ = whole("en")
    assert "<title>Façade &lt;7&gt;</title>" in text
    assert "San &lt;b&gt;Rocco&lt;/b&gt; &amp; Co" in text
    assert "&lt;/style&gt;&lt;script&gt;" in text
    assert "<script" not in text
    assert text.count("</style>") == 1


def test_a_title_block_leaves_room_for_what_is_not_given():
    text, _ = whole("en")
    assert "<td>Author</td><td></td><td>Date</td><td></td>" in text
    assert "<td>Place</td><td></td>" in text


def test_formulae_are_mathml():
    made = formula("T_{SLV} = 1.68 π √{d/{a_0 alpha}}")
    assert made == (
        "<math><msub><mi>T</mi><mrow><mi>SLV</mi></mrow></msub><mo>=</mo><mn>1.68</mn><mi>π</mi><msqrt><mrow><mfrac>"
        "<mi>d</mi><mrow><msub><mi>a</mi><mn>0</mn></msub><mi>\u03b1</mi></mrow></mfrac></mrow></msqrt></math>"
    )
    assert whole("it")[0].count("<math>") > 15
    assert "<mn>1,68</mn>" in whole("it")[0]
    assert "<mn>1.68</mn>" in whole("en")[0]


@pytest.mark.parametrize(
    ("value", "unit", "given", "found"),
    [
        (126_830.0, "kg", "126.83 t", "127 t"),
        (18_470.0, "J", "18.47 kJ", "18.5 kJ"),
        (0.1, "m", "0.1 m", "0.100 m"),
        (0.002, "m", "2 mm", "2.00 mm"),
        (12.35, "m", "12.35 m", "12.3 m"),
        (5e8, "N/m3", "500 MN/m³", "500 MN/m³"),
        (178_660.0, "N", "178.66 kN", "179 kN"),
        (0.0, "m", "0 m", "0.00 m"),
        (1900.0, "kg/m3", "1900 kg/m³", "1900 kg/m³"),
        (1e-10, "", "1·10⁻¹⁰", "1.00·10⁻¹⁰"),
        (-0.37, "", "\u22120.37", "\u22120.370"),
    ],
)
def test_numbers_have_digits_that_count_and_prefixes(value, unit, given, found):
    words = Words("en")
    message = [words.quantity(value, unit, *digits).replace("\u00a0", " ") for digits in ((), (FOUND,))]
    assert message == [given, found]
    italian = Words("it").quantity(value, unit).replace("\u00a0", " ")
    assert italian == given.replace(".", ",")


def test_a_ratio_below_one_never_reads_as_one():
    assert [Words("en").ratio(x) for x in (0.999, 1.0, 1.234, 1.239, 0.57)] == ["0.99", "1.00", "1.23", "1.23", "0.57"]


@pytest.mark.parametrize("share", [0.994, 1 - 1e-6, 1 - 1e-12, 1.0, 1 + 1e-12, 1.004, 3.345])
def test_what_fails_never_reads_as_if_it_held(share):
    """A capacity of so many demands, and the same demand over the capacity: in every text, cut or rounded up."""
    verdict = Verdict("nonlinear kinematic", "SLV", 1.0, share, "m", "C8.7.1.2.1.8")
    (cells,) = verdict_rows([verdict])[1:]
    assert cells[5] == ratio_text(share) == Words("en").ratio(share)
    assert f"ratio {cells[5]} {verdict.label}" in repr(verdict)
    assert (float(cells[5]) >= 1) == verdict.holds
    assert (float(share_text(1 / share)) <= 1) == (1 / share <= 1)


def test_a_check_and_its_report_write_one_ratio(tmp_path):
    """0.6666 is 0.66 in the table of the check and on the page."""
    states = {name: LimitState(0.2, 1.0, 0.3) for name in ("SLV", "SLC")}
    check = replace(CHECK, states=states, peak=None, breaking={})
    assert [line.split()[-2] for line in check.table().splitlines() if line.startswith("capacity over")] == ["0.66"] * 2
    assert "SLV 0.66 FAILS" in repr(check)
    assert ">0.66<" in mr.report(CASE, answer(), tmp_path / "cut.html", checks=check).read_text(encoding="utf-8")


def test_alpha_0_by_hand_is_that_of_the_push_over(tmp_path):
    """Loads and thrusts are in both, and added masses."""
    case = mr.Case(WALL, 0.0, 2.5, motion=MOTION, effects=EFFECTS)
    text = read(page_of(tmp_path, case, answer(), e=E))
    by_hand = re.search(r"ties slack\s+([\d.]+)", text)[1]
    assert float(by_hand) == pytest.approx(mr.pushover(case).start, rel=5e-3)  # three digits are printed


def test_a_check_by_hand_has_the_moments_of_a_wall_that_leans(tmp_path):
    """Two storeys with a setback inside, and a mass behind the middle: levers are from the outer edge."""
    profile = ((0.0, 0.6), (4.0, 0.6), (4.0, 0.4), (6.0, 0.4))
    wall = mr.Block.from_size(0.6, 6.0, 8.0, 1900.0, profile=profile, plumb="outer")
    effects = mr.AddedMass(1000.0, 5.0, -0.1), mr.Thrust(5.0, 2000.0)
    weights, levers = 9.81 * np.array([1900 * 8 * 0.6 * 4, 1900 * 8 * 0.4 * 2, 1000]), (0.3, 0.2, 0.4)
    case = mr.Case(wall, effects=effects)
    checks = mr.mechanism_check(case, mr.code_spectrum("EC8 type 1", ag=2.0, soil="B"))
    page = mr.report(case, (), tmp_path / "leans.html", checks=checks)
    text = read(page.read_text(encoding="utf-8"))
    message = re.search(
        r"hinge, x ([\d.]+) m .*weight, W x ([\d.]+) kN m .*thrusts, M (.[\d.]+) kN m", re.sub(r"\s+", " ", text)
    )
    lever, holding, moment = (float(one.replace("\N{MINUS SIGN}", "-")) for one in message.groups())
    assert lever == pytest.approx(weights @ levers / weights.sum(), rel=5e-3)  # three digits are printed
    assert holding == pytest.approx(weights @ levers / 1e3, rel=5e-3)
    assert moment == pytest.approx(-10.0, rel=5e-3)


def test_side_walls_and_loads_are_no_proposal(tmp_path):
    """A tie is what is proposed; wedges of side walls and a roof are another mechanism of the wall as it is."""
    wall, demand = mr.Block.from_size(0.6, 6.0, 8.0), mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")
    further = {
        "wedges": mr.Wedge(0.4, 0.3, 6.0).behind(wall),
        "roof": (mr.Load(2e4, 5.8),),
        "tied": (mr.Tie(5.8, 1e7, strength=5e4, length=6.0),),
    }
    cases = {"bare": mr.Case(wall), **{name: mr.Case(wall, effects=one) for name, one in further.items()}}
    checks = {name: mr.mechanism_check(one, demand) for name, one in cases.items()}
    page = mr.report(cases["bare"], (), tmp_path / "several.html", checks=checks)
    text = read(page.read_text(encoding="utf-8"))
    assert re.findall(r"With what is proposed, (\w+):", text) == ["tied"]
    assert len(re.findall(r"As it is, \w+ governs:", text)) == 1


def test_how_runs_were_solved_is_said_once(tmp_path):
    answers = [mr.simulate(mr.Case(WALL, share * WALL.alpha, 1.0), CONTACTS) for share in (0.3, 0.5)]
    low, high = sorted(answer.stats["steps"] for answer in answers)
    text = read(page_of(tmp_path, answers[0].case, answers, e=E, contacts=CONTACTS))
    assert text.count("accuracy 0.001") == 1
    assert f"{low} to {high} steps" in text
    assert "There is no ground motion" in text


def test_ties_that_broke_are_told_by_variant(tmp_path):
    runs = variants()["tied"]
    broken = [tie.broken for run in runs for tie in run.plastic.values()]
    text = read(page_of(tmp_path, CASE, variants()))
    assert f"tied: ties broke in 2 of 2 runs with ties, first at {min(broken):.3g}" in text
    assert "bare: ties" not in text


def test_sections_hold_texts_figures_and_tables(tmp_path):
    check = mr.mechanism_check(CASE, SITE)
    figure = Figure(figsize=(2.0, 1.0))
    curve = mr.fit_fragility([1.0, 2.0, 3.0, 4.0, 5.0], [False, True, False, True, True])
    given = {"Code <SLV>": [check, "It is linear & not.", figure], "Fragility": curve}
    text = page_of(tmp_path, CASE, answer(), sections=given)
    assert "<h2>Code &lt;SLV&gt;</h2>" in text
    assert "<td>multiplier alpha_0</td><td>0.1300</td><td>C8.7.1.1</td>" in text
    for message in ("It is linear &amp; not.", f"{curve.median:.3g} ("):
        assert message in text
    bare = page_of(tmp_path, CASE, answer())
    assert text.count("<img") == bare.count("<img") + 1
    assert text.index("The dynamic runs") < text.index("Code &lt;SLV") < text.index("Appendix")


@pytest.mark.parametrize("language", among(LANGUAGES, "it"))
def test_masonry_has_blocks_at_rest_and_as_they_end(tmp_path, language):
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 0.5)] * 2, k_n=1e8)
    case = mr.MasonryCase(masonry, 1e-3)
    kept, bare = mr.solve_explicit(case, forces=True), mr.solve_explicit(case)
    text = page_of(tmp_path, case, [kept, bare], labels=["kept", "bare"], language=language)
    words = Words(language)
    row = "".join(f'<td class="right">{words.quantity(9810.0, "N", FOUND)}</td>' for _ in range(2))  # two of 500 kg
    assert f"<tr><td>kept</td>{row}<td>ground|block_0</td></tr>" in text
    assert text.count(words("forces_reaction")) == 1
    assert text.count("<img") == 4  # at rest, strip, histories, at the end
    assert words("no_check") in html.unescape(text)


def test_what_looks_alike_is_drawn_once_with_all_of_its_names(tmp_path):
    bars = {f"{ultimate:g} m": mr.Tie(2.0, 1e6, strength=1e4, ultimate=ultimate) for ultimate in (0.03, 0.1)}
    walls = {name: mr.Case(WALL, 0.0, 1.0, effects=[bar]) for name, bar in bars.items()}
    checks = {name: mr.mechanism_check(wall, SITE) for name, wall in walls.items()}
    text = page_of(tmp_path, walls["0.1 m"], (), checks=checks)
    captions = [caption for caption in re.findall("<figcaption>(.*?)</figcaption>", text) if "at rest" in caption]
    assert captions == [Words("en")("drawing_wall")]  # of both bars
    slack = mr.Case(WALL, 0.0, 1.0, effects=[mr.Tie(1.0, 1e6, strength=1e4, ultimate=0.1)])
    checks["low"] = mr.mechanism_check(slack, SITE)
    captions = re.findall("<figcaption>(.*?)</figcaption>", page_of(tmp_path, walls["0.1 m"], (), checks=checks))
    assert sum(caption.startswith("0.03 m; 0.1 m: ") for caption in captions) == 1
    assert sum(caption.startswith("low: ") for caption in captions) == 1


def test_masonry_whose_runs_have_further_effects_is_drawn_once(tmp_path):
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 0.5)] * 2, k_n=1e8)
    mass = mr.AddedMass(mass=10.0, at=(0.0, 1.0), block="block_1")
    loaded = mr.solve_explicit(mr.MasonryCase(masonry, 1e-3, effects=[mass]))
    text = page_of(tmp_path, mr.MasonryCase(masonry, 1e-3), [loaded])
    assert text.count(Words("en")("drawing_masonry")) + text.count(": the blocks at rest") == 2  # picture and caption


def test_the_dynamic_verdict_of_masonry_stands_on_its_first_page(tmp_path):
    """d_0 is that of the common centroid, and the strip is of the farthest block: it has no line for it."""
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 0.5)] * 2, k_n=1e8)
    pulses = mr.GroundMotion.synthetic(0.5, 1.0, seed=1).polarities
    runs = [mr.solve_explicit(mr.MasonryCase(masonry, 1e-3, motion=motion)) for motion in pulses]
    found = [RunMaximum(motion.name, 0, i > 0, "explicit", 0.02) for i, motion in enumerate(pulses)]
    check = mr.DynamicCheck("SLV", 0.2, (*found,), (), True)
    text = page_of(tmp_path, runs[0].case, runs, checks=check)
    first = read(text[: text.index("The check by dynamic runs")])
    assert first.count("HOLDS") == 3  # both conditions, and the answer
    assert (
        text.count("<td>artificial, 0.5 m/s², seed 1</td>".replace(" m/s", "\u00a0m/s")) == 4
    )  # both polarities, the record and what governs
    assert "The kinematic check" not in read(text)
    assert "largest reaction" not in text  # these runs kept no forces
    assert "The check by dynamic runs" in read(text)


def test_a_wall_that_its_tie_alone_holds_has_no_displacement_of_its_own(tmp_path):
    thrust, tie = mr.Thrust(4.0, 2e4), mr.Tie(height=4.0, stiffness=1e8, strength=1e6)
    case = mr.Case(WALL, 0.0, 0.2, motion=MOTION, effects=(thrust, tie))
    assert case.restoring.outer.alpha <= 0
    text = page_of(tmp_path, case, mr.simulate(case, CONTACTS))
    assert "at rest" in text or "still moving" in text


def test_a_ratio_below_one_that_a_floor_takes_the_place_of_is_not_said_to_fail(tmp_path):
    """A wall between floors: the verdict of the SLV is that of a_g,SLV / a_g (C8.7.1.2.1.8)."""
    bending = mr.VerticalBending(mr.Block.from_size(0.35, 3.2, 1.0, 1800.0), load=12e3)
    site = mr.code_spectrum("NTC 2018", ag=3.0, F0=2.36, Tc=0.347, soil="C")
    check = mr.mechanism_check(bending, site.at_height(0.25, participation=1.2, height=0.4))
    ratio = check.states["SLV"].ratio
    assert ratio < 1 < check.ground_ratio
    text = page_of(tmp_path, CASE, answer(), checks={"bending": check})
    words = Words("en")
    assert f'<td class="right">{words.ratio(ratio)}</td>' in text
    assert f'<td class="right holds">{words.ratio(check.ground_ratio)}</td>' in text
    assert "FAILS" not in read(text)


def test_a_figure_of_the_user_keeps_its_points(tmp_path):
    figure = Figure()
    ax = figure.subplots()
    ax.plot([0.0, 0.5])
    page_of(tmp_path, CASE, answer(), language="it", sections={"F": figure})
    figure.draw_without_rendering()
    assert "0.1" in [tick.get_text() for tick in ax.get_yticklabels()]


def test_long_texts_are_cut_in_the_margins_alone(tmp_path):
    project = "x" * 30 + " " + "y" * 900
    text = page_of(tmp_path, CASE, answer(), project={"project": project})
    style = text[: text.index("</style>")]
    assert project in text
    assert max(map(len, style.splitlines())) < 400


def test_a_pdf_needs_weasyprint_and_says_so(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    with pytest.raises(ImportError, match="pip install weasyprint"):
        mr.report(CASE, answer(), tmp_path / "a.pdf")
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_pdf_has_few_pages(tmp_path):
    weasyprint = pytest.importorskip("weasyprint", reason="the extra pdf is not installed: pip install weasyprint")
    given = {"checks": checks(), "language": "it"}
    path = mr.report(CASE, variants(), tmp_path / "a.pdf", **given)
    assert path.read_bytes().startswith(b"%PDF-")
    page = weasyprint.HTML(mr.report(CASE, variants(), tmp_path / "a.html", **given)).render()
    assert 4 <= len(page.pages) <= 6


@pytest.mark.slow
def test_the_same_report_is_the_same_bytes(tmp_path):
    paths = [mr.report(CASE, answer(), tmp_path / name) for name in ("a.html", "b.html")]
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert "in one polarity alone" in paths[0].read_text(encoding="utf-8")


def test_a_sketch_names_values_or_arguments():
    case = mr.Case(WALL, 0.0, 1.0, side_stop=mr.SideStop(3.0), effects=EFFECTS)
    figure = mr.plotting.sketch(case)
    texts = "\n".join(text.get_text() for ax in figure.axes for text in ax.texts)
    for message in ("4.2 m", "0.6 m", "stop 3 m", "breaks at 2 mm", "0.5 kN outwards", "5 kN downwards", "200 kg"):
        assert message in texts
    figure = mr.plotting.sketch(case, arguments=True)
    texts = "\n".join(text.get_text() for ax in figure.axes for text in ax.texts)
    for message in ("Tie(height", "Thrust(height, force)", "Load(", "AddedMass(", "SideStop(top)", "Damper("):
        assert message in texts


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        ({"path": "facade.doc"}, "path = 'facade.doc' does not end in .html or .pdf"),
        ({"language": "de"}, "language = 'de' is not one of en, it"),
        ({"language": 3}, "language = 3"),
        ({"responses": {"a": 3}}, r"responses\['a'\] = 3 of type int"),
        ({"responses": {}}, "responses is empty"),
        ({"responses": {3: []}}, "a name of responses = 3"),
        ({"responses": {"a": []}, "labels": ["a"]}, "labels are for a sequence"),
        ({"checks": 3}, "checks = 3 of type int is no MechanismCheck"),
        ({"checks": {"a": [3]}}, r"checks\['a'\] = 3"),
        ({"checks": {"a": []}}, r"checks\['a'\] is empty"),
        ({"checks": {"a": [CHECK, CHECK]}}, r"checks\['a'\] has 2 kinematic checks"),
        ({"project": {"owner": "?"}}, "project has 'owner', which is not one of project, client, author, date, place"),
        ({"project": "San Rocco"}, "project = 'San Rocco'"),
        ({"project": {"client": 3}}, r"project\['client'\] = 3"),
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


def test_a_design_is_a_table_in_the_language_of_the_report(tmp_path):
    build = {0.3: None, 0.5: mr.Block.from_size(0.5, 4.0), 0.8: mr.Block.from_size(0.8, 4.0)}

    def case_of(thickness):
        if build[thickness] is None:
            raise ValueError("too thin")
        return mr.Case(build[thickness], 0.0, 1.0)

    found = mr.design(case_of, list(build), SITE, method="linear")
    text = page_of(tmp_path, CASE, answer(), sections={"Scelta": found}, language="it")
    part = text[text.index("<h2>Scelta") :]
    rows = [re.sub(r"<[^>]+>", "|", row).strip("|") for row in re.findall(r"<tr>(.*?)</tr>", part)[:4]]
    assert rows[0].split("||") == ["valore", "rapporto", "esito", "verifica", "punto"]
    assert rows[1].split("||") == ["0,3", DASH, DASH, "too thin", DASH]
    ratio = Words("it").ratio(found.trials[2].ratio)
    assert rows[3].split("||")[:2] == ["0,8", ratio]
    assert "cinematica lineare, SLV" in rows[3]
    sentence = read(text)
    assert ("0,8 è il primo di 3 valori" if found.chosen else "Nessuno dei 3 valori è verificato") in sentence


def test_no_cell_of_the_answer_is_empty_and_no_name_is_said_twice(tmp_path):
    load = mr.load_check(mr.collapse_multiplier(CASE, None, loads=[mr.Thrust(2.0, 3e3)]))
    given = {"stato di fatto": mr.mechanism_check(mr.Case(WALL, 0.0, 1.0), SITE), "vento": load, "con catena": CHECK}
    text = page_of(tmp_path, CASE, answer(), checks=given, language="it")
    first = text[: text.index("<h2>La verifica cinematica")]
    assert "<td></td>" not in first[first.index("<thead>") :]
    assert "stato di fatto, stato di fatto" not in read(first).lower()
    assert "fatto governa stato di fatto" not in read(first)


@pytest.mark.slow
def test_no_page_of_a_pdf_has_one_row(tmp_path):
    """Versions and the record that is lacking stood alone on a page before."""
    weasyprint = pytest.importorskip("weasyprint", reason="the extra pdf is not installed: pip install weasyprint")
    page = weasyprint.HTML(mr.report(CASE, variants(), tmp_path / "a.html", checks=checks(), language="it")).render()
    for one in page.pages[1:]:
        lines = [box for box in one._page_box.descendants() if type(box).__name__ == "LineBox"]
        assert len(lines) > 8
