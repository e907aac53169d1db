"""What plot functions print stands in one list, by which the pictures of an Italian report have no English word."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest
from everyday import among
from matplotlib.figure import Figure
from matplotlib.text import Text
from trees import nodes

import mjrock as mr
from mjrock.reporting import page
from mjrock.reporting.pictures import Point, _write_beside, design_figure, wall_drawing
from mjrock.reporting.texts import Words, drawn_patterns, texts

DRAWING = ("bodies", "forces", "histories", "masonry", "solids", "studies", "wall")
"""Modules of `mjrock.plotting` that draw on an Axes."""
PRINTS = {"set_xlabel", "set_ylabel", "text", "annotate"}
ENDS = "1"
"""A unit at the end that may be missing."""
LABELS = {"xlabel", "ylabel", "label"}
ITALIAN = Words("it")


def printed(module):
    """The texts that a module prints on an Axes, with 1 in place of values."""
    for node in nodes(Path(mr.__file__).parent / "plotting" / f"{module}.py"):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", "")
            at = {"text": 2}.get(name, 0)
            given = [node.args[at]] if name in PRINTS and len(node.args) > at else []
            given += [one.value for one in node.keywords if one.arg in LABELS]
            yield from (line for one in given for line in literal(one).split("\n"))


def literal(node):
    """A string or an f-string of the source, with 1 in place of values."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "1" for part in node.values)
    return ""


def words_of(text):
    """Words of a text, without its formulae and units."""
    return re.findall(r"[A-Za-z]{3,}", re.sub(r"\$[^$]*\$|\[[^]]*\]", "", text))


@pytest.mark.parametrize("module", DRAWING)
def test_what_a_plot_function_prints_is_in_the_list(module):
    patterns = [pattern for pattern, _ in drawn_patterns()]
    missing = [
        message
        for message in printed(module)
        if words_of(message)
        and not any(one.fullmatch(message) or one.fullmatch(message.removesuffix(ENDS)) for one in patterns)
    ]
    assert missing == []


def test_the_list_is_read_from_the_source_of_plot_functions():
    found = [message for module in DRAWING for message in printed(module)]
    assert {"farthest block [mm]", "capacity over demand [-]", "share of walls overturned [-]"} <= set(found)
    assert len([message for message in found if words_of(message)]) > 15


def test_each_text_of_the_list_is_said_in_italian():
    for key in (key for key in texts() if key.startswith("drawn_")):
        message = Words("en")(key, **dict.fromkeys(re.findall(r"(?<!{){(\w+)}", texts()[key]["en"]), "1.5"))
        expected = Words("it")(key, **dict.fromkeys(re.findall(r"(?<!{){(\w+)}", texts()[key]["it"]), "1,5"))
        assert ITALIAN.drawn(message) == expected
    assert (
        ITALIAN.drawn("MuJoCo, tie_1\n3 of 17 blocks lie outside")
        == "MuJoCo, catena 2\n3 blocchi su 17 fuori dal disegno"
    )
    assert ITALIAN.drawn("A text of the user") == "A text of the user"


def english_words():
    """Words of the list that are no Italian ones."""
    both = {
        lang: {word for key in texts() if key.startswith("drawn_") for word in words_of(texts()[key][lang])}
        for lang in ("en", "it")
    }
    return both["en"] - both["it"]


WALL = mr.Block.from_size(0.5, 4.0, 3.0)
TIE = mr.Tie(3.5, 2e6, strength=5e3, ultimate=0.01)


@pytest.fixture(scope="module")
def figures(tmp_path_factory):
    """The texts of all pictures of an Italian report with each kind of picture."""
    found, drawn = [], page.picture

    def kept(figure, caption, words, *, of_user=False):
        found.append((figure, of_user))
        return drawn(figure, caption, words, of_user=of_user)

    record = mr.GroundMotion.synthetic(3.0, 1.0, seed=1)
    far = mr.Masonry([
        mr.Polygon([(-1, -0.3), (1, -0.3), (1, 0), (-1, 0)], fixed=True),
        *(mr.Polygon([(x, 0), (x + 0.3, 0), (x + 0.3, 1), (x, 1)]) for x in (-0.5, 0.2)),
    ], k_n=1e8, friction=0.6)  # fmt: skip
    run = mr.solve_explicit(mr.MasonryCase(far, 0.5, velocity=[(0, 0, 0), (8.0, 0, 0)]))
    site = mr.code_spectrum("NTC 2018", ag=2.0, F0=2.4, Tc=0.33, soil="C")
    case = mr.Case(WALL, 0.0, 1.0, motion=record, effects=TIE)
    found_design = mr.design(lambda t: mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), [0.5, 0.8], site)
    mine = mr.plotting.pushover({"muro": mr.pushover(case)})
    sections = {
        "Scelta": found_design,
        "Curve": [mr.pushover(case), mr.limit_curve(far, 1), mr.collapse_multiplier(far), mine.figure],
    }
    check = mr.mechanism_check(case, site)
    answer = mr.solve_analytical(case, mr.Restitution.from_geometry(WALL))
    folder = tmp_path_factory.mktemp("pictures")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(page, "picture", kept)
        mr.report(case, {"con catena": answer}, folder / "a.html", checks=check, language="it", sections=sections)
        mr.report(run.case, run, folder / "b.html", language="it")
    return found


@pytest.mark.parametrize(
    ("text", "message"), [("0.55 m", "0,55 m"), ("\u22121.5 kN", "\u22121,5 kN"), ("v1.5 m", "v1.5 m")]
)
def test_a_number_with_its_unit_has_the_decimal_mark_of_the_language(text, message):
    assert ITALIAN.drawn(text) == message
    assert Words("en").drawn(text) == text


def test_pictures_of_an_italian_report_have_no_english_word(figures):
    assert len(figures) > 10
    message = [text.get_text() for figure, own in figures if not own for text in figure.findobj(Text)]
    assert any("fuori dal disegno" in one for one in message)
    assert "capacità su domanda [-]" in message
    assert [one for one in message if set(words_of(one)) & english_words()] == []


def test_a_picture_of_the_user_is_drawn_in_italian_and_left_as_it_was(figures):
    (mine,) = (figure for figure, own in figures if own)
    assert mine.axes[0].get_xlabel() == r"rotation $\theta$ [rad]"
    seen = []
    mine.savefig = lambda *given, **options: (
        seen.append(mine.axes[0].get_xlabel()),
        Figure.savefig(mine, *given, **options),
    )
    page.picture(mine, "", ITALIAN, of_user=True)
    assert seen == [r"rotazione $\theta$ [rad]"]


def test_ticks_keep_their_factor_with_the_decimal_mark_of_the_language():
    """A motion of less than a thousandth of a millimetre: 0.25 to 2 at the ticks stand for so many 1e-7."""
    figure = Figure()
    ax = figure.subplots()
    ax.plot([0.0, 1.0], [0.0, 2e-7])
    page.picture(figure, "", ITALIAN)
    figure.draw_without_rendering()
    labels = [label.get_text() for label in ax.get_yticklabels()]
    assert "0,50" in labels
    assert not any("." in label for label in labels)
    assert ax.yaxis.get_offset_text().get_text() == "1e\N{MINUS SIGN}7"


def overlapping(figure):
    """Pairs of texts of a figure that lie on each other."""
    figure.draw_without_rendering()
    shown = [text for ax in figure.axes for text in ax.texts if text.get_text() and text.get_visible()]
    boxes = [(text.get_text(), text.get_window_extent()) for text in shown]
    return [(a, b) for i, (a, one) in enumerate(boxes) for b, other in boxes[:i] if one.overlaps(other)]


@pytest.mark.parametrize("language", among(["en", "it"], "it"))
@pytest.mark.parametrize(
    ("thickness", "height", "length"), [(0.5, 7.5, 8.0), (0.6, 9.6, 12.0), (0.5, 6.2, 18.0), (0.3, 1.2, 10.0)]
)
def test_no_name_of_a_sketch_lies_on_another(thickness, height, length, language):
    """The hinge beside the thickness, ties and masses at the same heights, the elevation beside long names."""
    heights = [height * share for share in (0.33, 0.66, 1.0)]
    effects = [mr.Tie(z, 1e7) for z in heights] + [mr.AddedMass(500.0, z) for z in heights] + [mr.Load(9e3, height)]
    case = mr.Case(mr.Block.from_size(thickness, height, length), 0.0, 1.0, effects=effects)
    drawn = wall_drawing(case, Words(language))
    assert overlapping(drawn.figure) == []
    left, right = drawn.figure.axes
    ends = [text.get_window_extent().x1 for text in left.texts]
    assert max(ends) < right.get_window_extent().x0  # no name on the elevation


def test_names_of_points_that_are_near_do_not_lie_on_each_other():
    figure = Figure(figsize=(3.5, 2.25))
    ax = figure.subplots()
    ax.set(xlim=(0, 1), ylim=(0, 1))
    places = [("SLV", 0.5, 0.5), ("SLV", 0.52, 0.45), ("SLC", 0.55, 0.5), ("SLC", 0.56, 0.42), ("d₀", 0.95, 0.0)]
    points = [Point(*place) for place in places]
    _write_beside(ax, points)
    assert [text.get_text() for text in ax.texts] == [name for name, *_ in points]
    assert overlapping(figure) == []


def test_a_design_is_drawn_with_its_conditions_in_italian():
    site = mr.code_spectrum("NTC 2018", ag=2.0, F0=2.4, Tc=0.33, soil="C")
    found = mr.design(lambda t: {"sopra": mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0)}, [0.5, 0.8], site)
    (ax,) = design_figure(found, ITALIAN).axes
    named = [text.get_text() for text in ax.get_legend().get_texts()]
    assert named[0] == "sopra: cinematica lineare, SLV"
    assert len(named) == 3
    assert np.allclose(sorted(line.get_xdata()[0] for line in ax.get_lines() if len(line.get_xdata()) == 2)[-1], 0.5)
