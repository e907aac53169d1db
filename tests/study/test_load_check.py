"""What is borne beside what is demanded: limit analysis, limit curves, pushes and push-overs, and in a report."""

import html
import re
from functools import cache

import pytest
from everyday import among

import mjrock as mr
from mjrock.reporting.content import content_of
from mjrock.reporting.texts import Words

COLUMN = mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 3)
WALL = mr.Case(mr.Block.from_size(0.6, 3.0), 0.0, 1.0)
BLOCK = mr.Polygon([(0, 0), (0.6, 0), (0.6, 2.0), (0, 2.0)], 2000.0, name="block")
GROUND = mr.Polygon([(-1, -0.3), (2, -0.3), (2, 0), (-1, 0)], fixed=True)
PULLED = mr.Masonry([GROUND, BLOCK], friction=0.7)


@cache
def collapse():
    return mr.collapse_multiplier(COLUMN)


@cache
def loaded():
    return mr.collapse_multiplier(PULLED, None, loads={"block": (2000.0, 0.0)})


@pytest.mark.parametrize(
    "solve",
    [collapse, lambda: mr.limit_curve(COLUMN, 1, poses=20), lambda: mr.pushover(WALL)],
    ids=["collapse", "limit curve", "push-over"],
)
def test_a_horizontal_force_by_hand(solve):
    result, capacity = solve(), 0.6 / 3.0  # b / h of the whole column and of the wall
    check = mr.load_check(result, 0.19)
    assert check.capacity == pytest.approx(capacity, rel=1e-6)
    assert check.holds
    assert not mr.load_check(result, 0.21).holds
    (verdict,) = check.verdicts
    assert verdict.ratio == pytest.approx(capacity / 0.19, rel=1e-6)
    assert "HOLDS" in check.table()
    with pytest.raises(ValueError, match="demand is missing"):
        mr.load_check(result)


@pytest.mark.parametrize(
    ("bears", "call"),
    [(WALL, r"mr\.pushover\(case\)"), (COLUMN, r"mr\.collapse_multiplier\(masonry\)"),
     (mr.MasonryCase(COLUMN, 1.0), r"mr\.collapse_multiplier\(case\.masonry\)")],
)  # fmt: skip
def test_what_bears_is_no_answer(bears, call):
    with pytest.raises(TypeError, match=rf"is what bears, and no answer; take mr\.load_check\({call}, demand\)"):
        mr.load_check(bears, 0.19)


def test_loads_that_grow_have_a_factor_of_one_as_their_demand():
    """A pull of 2 kN at 1 m turns the block about its edge: W 0.3 m over 2 kN m."""
    weight = 0.6 * 2.0 * 2000.0 * mr.GRAVITY
    check = mr.load_check(loaded())
    assert (check.demand, check.unit) == (1.0, "")
    assert check.capacity == pytest.approx(weight * 0.3 / 2000.0, rel=1e-9)
    assert loaded().loads == {"block": (2000.0, 0.0)}


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        (lambda: (3,), "result = 3 of type int is not a Collapse or LimitCurve or Push or PushoverCurve"),
        (lambda: (collapse(), 0.0), "demand = 0 is outside"),
        (lambda: (collapse(), "x"), "demand = 'x'"),
    ],
)
def test_what_is_no_load_check(given, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.load_check(*given())


@pytest.mark.parametrize("language", among(["en", "it"], "it"))
def test_a_report_of_loads_has_the_verdict_the_picture_and_the_loads(tmp_path, language):
    case = mr.MasonryCase(PULLED, 1.0)
    checks = {"pull": loaded(), "wall": mr.load_check(mr.pushover(WALL), 0.25)}
    given = {"checks": checks, "language": language, "sections": {"Curve": mr.limit_curve(COLUMN, 1)}}
    path = mr.report(case, (), tmp_path / "a.html", **given)
    page = path.read_text(encoding="utf-8")
    text = html.unescape(re.sub(r"<[^>]+>", " ", re.sub(r"base64,[^\"]*", "", page))).replace("\u00a0", " ")
    first = text[: text.index("What is borne" if language == "en" else "Quanto è sopportato")]
    assert ("governs" if language == "en" else "Governa") in first
    assert first.index("wall") < first.index("pull")  # the least ratio first
    assert (
        page.count("<img") == 5
    )  # the wall, the blocks with their mechanism, two push-overs, the curve of the section
    assert "C8.7" not in text
    assert ("2 kN; 0 kN" in text) is True
    ratio = 0.6 * 2.0 * 2000.0 * mr.GRAVITY * 0.3 / 2000.0
    assert f"{int(100 * ratio) / 100:.2f}".replace(".", "." if language == "en" else ",") in first


def test_a_collapse_of_a_horizontal_force_in_a_report_needs_its_demand(tmp_path):
    with pytest.raises(ValueError, match="demand is missing"):
        mr.report(mr.MasonryCase(COLUMN, 1.0), (), tmp_path / "a.html", checks={"column": collapse()})
    assert not list(tmp_path.iterdir())


def test_a_wall_under_wind_has_its_factor_and_the_wind_in_the_report(tmp_path):
    """W b / (F z) by hand."""
    case = mr.Case(mr.Block.from_size(0.5, 3.0, 4.0), 0.0, 1.0)
    found = mr.collapse_multiplier(case, None, loads=[mr.Thrust(1.5, 3333.3)])
    assert mr.load_check(found).capacity == pytest.approx(0.5 * 3.0 * 4.0 * 2000.0 * mr.GRAVITY * 0.25 / (3333.3 * 1.5))
    page = mr.report(case, (), tmp_path / "a.html", checks={"wind": found}).read_text(encoding="utf-8")
    assert "thrust 1, growing" in page
    assert "3.3333" in page


def test_a_report_of_an_axle_has_the_fill_and_the_axle_once_each_and_on_its_first_page(tmp_path):
    """Of a slab on half of its ground; the numbers are those that were given."""
    slab = mr.Polygon([(0, 0), (3, 0), (3, 0.5), (0, 0.5)], 2000.0, name="slab")
    masonry, fill = mr.Masonry([GROUND, slab], friction=0.7), mr.Fill(1.25, 1777.0, passive=2.5)
    axle = fill.under(masonry, 31e3, at=2.625, width=0.3)
    found = mr.collapse_multiplier(masonry, None, loads=axle, effects=fill.on(masonry))
    case = mr.MasonryCase(masonry, 1.0, effects=fill.on(masonry))
    page = mr.report(case, (), tmp_path / "a.html", checks={"axle": found}).read_text(encoding="utf-8")
    text = html.unescape(re.sub(r"<[^>]+>", " ", re.sub(r"base64,[^\"]*", "", page))).replace("\u00a0", " ")
    assert text.count("axle, growing") == 1
    for number in ("1.25 m", "1777 kg/m³", "31 kN", "x = 2.625 m", "0.3 m wide", "coefficient 2.5"):
        assert number in text
    drawn = content_of(case).rest_drawing(Words("en"), [found])[0].axes[0]
    assert [note.get_text() for note in drawn.texts] == ["31 kN"]
    assert len(mr.report(case, (), tmp_path / "b.html", checks={"axle": found}, language="it").read_bytes()) > 1000
