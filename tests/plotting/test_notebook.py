"""What a notebook shows without a call: pictures as PNG and tables with colours."""

import io
import pickle

import numpy as np
import pytest
from matplotlib.text import Text
from PIL import Image

import mjrock as mr
from mjrock.plotting import notebook

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
E = mr.Restitution.from_geometry(WALL)
RELEASED = mr.Case(WALL, 0.5 * WALL.alpha, 2.0)
SHAKEN = mr.Case(WALL, 0.0, 2.0, motion=mr.GroundMotion.sine(3.0, 0.8), effects=mr.Tie(4.0, 1e6))
BOND = mr.Masonry.running_bond(1.0, 0.5, (0.5, 0.25))
BOX = mr.Masonry.box((0.5, 0.5, 1.0))
SHOWN = {
    "case": lambda: SHAKEN,
    "response": lambda: mr.solve_analytical(SHAKEN, E),
    "comparison": lambda: mr.compare(*(mr.solve_analytical(RELEASED, e) for e in (E, mr.Restitution(0.9, -0.4)))),
    "fragility": lambda: mr.fit_capacities([0.3, 0.4, 0.5, 0.45, 0.35]),
    "push-over": lambda: mr.pushover(RELEASED),
    "masonry": lambda: BOND,
    "masonry in space": lambda: BOX,
    "case of masonry": lambda: mr.MasonryCase(BOND, 1.0),
    "answer of masonry": lambda: mr.solve_explicit(mr.MasonryCase(BOND, 0.1, mr.GroundMotion.sine(3.0, 0.1))),
    "answer of masonry in space": lambda: mr.solve_explicit(mr.MasonryCase(BOX, 0.02)),
    "collapse": lambda: mr.collapse_multiplier(BOND),
}


@pytest.fixture(scope="module")
def theory():
    return mr.solve_analytical(RELEASED, E)


@pytest.fixture(scope="module")
def check():
    return mr.mechanism_check(RELEASED, mr.code_spectrum("EC8 type 1", ag=2.5, soil="B"))


def pixels(png):
    """The picture of a PNG, shape (rows, columns, 3)."""
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


@pytest.mark.parametrize("make", SHOWN.values(), ids=SHOWN)
def test_problems_and_answers_are_drawn(make):
    """Some six inches wide, with a title in the upper quarter, and more than black and white below it."""
    drawn = pixels(make()._repr_png_())
    rows, columns, _ = drawn.shape
    assert 500 < columns < 1300
    assert rows > 300
    assert (drawn[: rows // 4] < 100).all(axis=2).any()
    below = drawn[rows // 10 :].astype(int)
    assert np.ptp(below, axis=2).max() > 20 or len(np.unique(below)) > 20


@pytest.mark.parametrize("make", SHOWN.values(), ids=SHOWN)
def test_the_title_has_two_lines_and_does_not_repeat_what_is_drawn(monkeypatch, make):
    shown, figures = make(), []
    monkeypatch.setattr(notebook, "png", figures.append)
    notebook.png_of(shown)
    texts = [text.get_text() for text in figures[0].findobj(Text) if text.get_text()]
    assert any(text.split()[0].strip(":") in repr(shown) for text in texts)
    assert not [text for text in texts if "<" in text or text.count("\n") > 1]


def test_an_answer_of_masonry_shows_its_blocks_where_they_are_at_the_end():
    """A wall that a pulse of the ground throws over: the upper part has brick where it lies, beside its base."""
    wall = mr.Masonry.running_bond(0.25, 1.0, (0.25, 0.25), k_n=1e9, friction=0.9)
    run = mr.solve_explicit(mr.MasonryCase(wall, 1.2, motion=mr.GroundMotion.rectangular(-8.0, 0.5)))
    assert run.fallen
    places = {}
    for name, answer in (("at the end", run), ("at rest", mr.solve_explicit(mr.MasonryCase(wall, 0.01)))):
        drawn = pixels(answer._repr_png_()).astype(int)
        upper = drawn[drawn.shape[0] // 8 : drawn.shape[0] * 3 // 5]
        places[name] = np.argwhere((upper[..., 0] - upper[..., 2] > 40) & (upper[..., 0] > 120))
        assert len(places[name]) > 500
    rest, end = (np.ptp(places[name], axis=0) for name in ("at rest", "at the end"))
    assert rest[0] > rest[1]
    assert end[1] > end[0]


def test_the_title_is_what_it_prints_as(monkeypatch, theory):
    titles = []
    monkeypatch.setitem(notebook.PICTURES, mr.Response, lambda response, message: titles.append(message))
    assert notebook.png_of(theory) is None
    assert titles == [repr(theory)[1:-1]]


def test_what_has_no_picture_stays_text(monkeypatch):
    """Masonry that would take long to draw, and masonry in which nothing gives way."""
    monkeypatch.setattr(notebook, "MOST_BLOCKS", 3)
    assert BOND._repr_png_() is None
    held = mr.collapse_multiplier(mr.Masonry.box((1.0, 1.0, 0.1)), None, loads={"block": (0, 0, -1.0, 0, 0, 0)})
    assert held._repr_png_() is None


@pytest.mark.parametrize(
    "draw",
    [
        lambda theory: mr.plotting.sketch(SHAKEN),
        lambda theory: mr.plotting.history(theory),
        lambda theory: mr.plotting.comparison([theory]),
        lambda theory: mr.plotting.grid([("one", [theory])]),
        lambda theory: mr.plotting.panels([("one", lambda ax: mr.plotting.rotation(ax, [theory]))]),
        lambda theory: mr.plotting.single(lambda ax: mr.plotting.rotation(ax, [theory])),
        lambda theory: mr.plotting.rotation([theory]),
        lambda theory: mr.plotting.blocks(BOND),
        lambda theory: mr.plotting.blocks(BOX),
    ],
)
def test_figures_and_axes_of_pictures_are_shown(draw, theory):
    """Also those that have been pickled."""
    drawn = pixels(pickle.loads(pickle.dumps(draw(theory)))._repr_png_())
    assert drawn.shape[1] > 400
    assert (drawn < 100).any()


def test_a_picture_on_axes_of_the_user_is_left_to_the_user(theory):
    figure = mr.plotting.single(lambda ax: ax)
    assert not hasattr(mr.plotting.rotation(figure.axes[0], [theory]), "_repr_png_")


def test_ipython_shows_them(theory, check):
    formatters = pytest.importorskip("IPython.core.formatters")
    formatter = formatters.DisplayFormatter()
    formatter.active_types = list(formatter.formatters)
    for shown in (SHAKEN, theory, mr.plotting.history(theory), mr.plotting.rotation([theory])):
        held, _ = formatter.format(shown)
        assert held["image/png"].startswith(b"\x89PNG")
        assert held["text/plain"]
    held, _ = formatter.format(check)
    assert "text/html" in held
    assert "image/png" not in held


def test_checks_are_tables_with_colours(check):
    """A verdict for each condition, red and green, and every step of the table in text."""
    html = check._repr_html_()
    assert html.count("<table>") == 2
    for verdict in check.verdicts:
        assert f'font-weight: bold">{verdict.label}<' in html
    fails = mr.mechanism_check(RELEASED, mr.code_spectrum("EC8 type 1", ag=5.0, soil="D"))._repr_html_()
    assert "#b5402a" in fails
    for line in check.table().splitlines():
        assert f'<td style="text-align: left">{line.split("  ")[0].replace("&", "&amp;")}</td>' in html
    runs = mr.dynamic_check([SHOWN["response"]()])
    assert f">{runs.runs[0].name}<" in runs._repr_html_()


def test_what_a_check_says_cannot_be_code():
    case = mr.Case(WALL, 0.0, 2.0, motion=mr.GroundMotion([0.0, 1.0], 0.1, "<script>"))
    assert "<script>" not in mr.dynamic_check([mr.solve_analytical(case, E)])._repr_html_()
