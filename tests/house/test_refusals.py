"""Paths, options, names and titles that cannot be: refused by name, before anything is written or run."""

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from entries import ENTRIES, entry, solved
from offenders import not_refused

import mjrock as mr
from mjrock import plotting
from mjrock.contacts.files import csv_text
from mjrock.study.campaign.store import ROW_COLUMNS

WALL = mr.Block(0.3, 2.1)
E = mr.Restitution.from_geometry(WALL)
CASE = mr.Case(WALL, 0.05, 0.05)
SHAKE = mr.GroundMotion([0.0, 1.0], 0.1)
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


class Unspeakable:
    """What has no repr."""

    def __repr__(self):
        raise RuntimeError("repr fails")


class Endless:
    """What says that it has more values than memory holds."""

    def __len__(self):
        return 2**62

    def __getitem__(self, i):
        return 1.0


LINES = ("a\nb", "a\n", "\ra", "a\x0bb", "a\u2028b")
COLUMN = mr.Masonry.stack([WALL], 5e8)
BOX = mr.Masonry.box((0.6, 0.4, 2.0))


@cache
def answer():
    return mr.solve_analytical(CASE, E)


@cache
def stands():
    return mr.solve_explicit(mr.MasonryCase(COLUMN, 0.002))


def analysis():
    return mr.Analysis(CASE, "analytical", E)


PATHS = {(name, argument): row for name, row in ENTRIES.items() for argument in sorted(row.paths)}
DRAWN = {
    ("animate", "path"): entry(lambda path: plotting.animate(answer(), path), path="a.gif"),
    ("save", "path"): entry(lambda path: plotting.save(plotting.single(lambda ax: ax), path), path="a.png"),
}
NO_PATHS = (1, 1.0, True, b"a", [], "", "a\0b", "\ud800", Unspeakable())


@pytest.mark.parametrize(("name", "argument"), [*PATHS, *DRAWN])
def test_what_is_no_path(name, argument, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    row = (PATHS | DRAWN)[name, argument]
    given = {one: solved(value) for one, value in row.given.items()}
    calls = (
        (type(path).__name__, lambda path=path: row.call(**given | {argument: path}), f"^{argument} = ")
        for path in NO_PATHS
    )
    assert not_refused(calls) == []
    assert not list(tmp_path.iterdir())


OPTIONS = (
    ({"workers": 1.5}, "workers = 1.5 is not a whole number"),
    ({"workers": True}, "workers = True of type bool is not a real number"),
    ({"workers": [1]}, r"workers = \[1\] of type list is not a real number"),
    ({"workers": 0}, "workers = 0 is outside the valid range 1 to 10000"),
    ({"workers": math.nan}, "workers = nan is outside"),
    ({"time_limit": True}, "time_limit = True of type bool is not a real number"),
    ({"time_limit": (1,)}, r"time_limit = \(1,\) of type tuple is not a real number"),
    ({"time_limit": math.nan}, "time_limit = nan s is outside"),
    ({"retry": "no"}, "retry = 'no' of type str is neither True nor False"),
    ({"retry": 1}, "retry = 1 of type int is neither True nor False"),
    ({"executor": 1}, "executor = 1 of type int is not an executor"),
    ({"tasks": 1.0}, "tasks = 1.0 of type float are not tasks"),
    ({"tasks": "tasks"}, "tasks = 'tasks' of type str are not tasks"),
    ({"tasks": None}, "tasks = None are not tasks"),
)


def test_options_of_a_campaign(tmp_path):
    store = tmp_path / "c.sqlite"
    calls = []
    for options, complaint in OPTIONS:
        given = {"tasks": [analysis()], "store": store} | options
        calls.append((str(options), lambda given=given: mr.campaign(**given), complaint))
        if "tasks" in options:
            calls.append((f"results, {options}", lambda given=given: mr.results(given["tasks"], store), complaint))
    assert not_refused(calls) == []
    assert not list(tmp_path.iterdir())


def test_numbers_of_numpy_are_options_too(tmp_path):
    options = {"workers": np.float32(1), "retry": np.True_}
    path = mr.campaign([analysis()], tmp_path / "c.sqlite", **options)
    assert mr.results([analysis()], path)[0]["status"] == "done"


CANNOT_BE = (
    (lambda: mr.SideStop(Unspeakable()), "top of the side stop = a Unspeakable of type Unspeakable"),
    (lambda: mr.Polygon(SQUARE, name="\0x"), r"name = '\\x00x' of type str has a NUL"),
    (lambda: mr.Polygon(SQUARE, name="\ud800"), "name = .* half of a surrogate pair"),
    (lambda: mr.Polygon(SQUARE, name="x" * 1001), "name = .* has 1001 characters; the valid range is 0 to 1000"),
    (lambda: mr.Polygon(SQUARE, name=1), "name = 1 of type int is not a str"),
    (lambda: mr.Polygon(np.ma.array(SQUARE, mask=[[1, 0]] + [[0, 0]] * 3)), "vertices has masked values"),
    (lambda: mr.Polygon([np.ma.array(p, mask=[1, 0]) for p in SQUARE]), "vertices has masked values"),
    (lambda: mr.Polygon(np.array(SQUARE, complex)), "vertices = .* does not hold real numbers alone"),
    (lambda: mr.Polygon(np.array(SQUARE, bool)), "vertices = .* does not hold real numbers alone"),
    (lambda: mr.Polygon([(0, 0), (1, 0), (1, True), (0, 1)]), "vertices = .* does not hold real numbers alone"),
    (lambda: mr.Polygon([*SQUARE[:3], np.array([False, True])]), "vertices = .* does not hold real numbers alone"),
    (lambda: mr.GroundMotion([0.0, True], 0.1), "accel = .* does not hold real numbers alone"),
    (lambda: mr.Contacts(None), "base = None is not a Interface"),
    (lambda: mr.Polygon(np.array(SQUARE, str)), "vertices = .* does not hold real numbers alone"),
    (lambda: mr.Polygon(np.array(SQUARE, "m8[s]")), "vertices = .* does not hold real numbers alone"),
    (lambda: mr.Polygon([[0, 0], [1, 0, 2], [1, 1]]), "vertices = .* has rows of different lengths"),
    (
        lambda: mr.simulate(CASE, contacts(), start=(np.zeros((1, 3), complex), np.zeros((1, 3)))),
        "start, pose = .* does not hold real numbers alone",
    ),
    (
        lambda: mr.simulate(CASE, contacts(), start=(np.ma.masked_equal(np.zeros((1, 3)), 0), np.zeros((1, 3)))),
        "start, pose has masked values",
    ),
    (lambda: mr.Analysis(CASE, np.array([1])), r"solver = array\(\[1\]\) is not one of"),
    (lambda: mr.Analysis(CASE, Unspeakable()), "solver = a Unspeakable"),
    (lambda: mr.dynamic_check([], "x" * 99), r"limit_state = 'x{59}\.\.\. is not one of SLV, SLC"),
    (lambda: mr.dynamic_check([], np.zeros(99)), r"limit_state = array\(\[0[0., ]+\.\.\. is not one of SLV, SLC"),
    (lambda: contacts(side_friction=11.0), "^side_friction = 11 is outside"),
    (lambda: contacts(friction=11.0), "^friction = 11 is outside"),
    (
        lambda: mr.Contacts.from_damping(WALL, k_base=5e8, xi_base=0.05, law="a\0b"),
        r"law = 'a\\x00b' of type str has a NUL",
    ),
    (lambda: contacts(law=lambda wall, e, k_base: "x"), "law = .* to give two numbers: it gives 'x' of type str"),
    (lambda: contacts(law=lambda wall, e: (0.05, 0.05)), r"law = .* is not called as law\(wall, e, k_base\)"),
    (lambda: contacts(law=lambda wall, e, k_base: None + k_base), "^unsupported operand"),  # a fault of the law's own
    (lambda: contacts(law=lambda wall, e, k_base: 0.05), "law = .* to give two numbers: it gives 0.05"),
    (lambda: mr.contact_for(None, 0, 1, k=1.0, c=Unspeakable(), xi=0.1), "model = None"),
    (
        lambda: mr.GroundMotion([0.0, 1.0], 0.1).scaled(Unspeakable(), peak=1.0),
        "factor = a Unspeakable, peak = 1.0",
    ),
    (lambda: plotting.animate(answer(), "a.gif", title="\ud800"), "title = .* half of a surrogate pair"),
    (lambda: plotting.animate(answer(), "a.gif", title="x" * 1001), "title = .* has 1001 characters"),
    (lambda: plotting.tornado(plotting.single(lambda ax: ax).axes[0], 2), "found = 2 of type int is not a Sens"),
    (lambda: plotting.tornado(2, ax=2), "ax = 2 of type int is not a Axes"),
    (lambda: plotting.save(3, "x.png"), "figure = 3 of type int is not a Figure"),
    (lambda: plotting.save(plotting.single(lambda ax: ax), "0.5"), r"path = '0.5' does not end in .*\.png"),
    (lambda: plotting.thrust(answer(), ax=1), "ax = 1 of type int is not a Axes"),
    (lambda: plotting.animate(COLUMN, "a.gif"), "response = .* is not a Response"),
    (lambda: plotting.blocks(COLUMN, ax=1), "ax = 1 of type int is not a Axes"),
    (lambda: plotting.history(answer(), title=object()), "title = .* of type object is not a str"),
    (lambda: mr.Grid(analysis, i=3), "the axis i = 3 of type int is not a row of values"),
    (lambda: mr.Grid(analysis, i=Endless()), "the axis i has more values than the largest valid number, 1000000"),
    (lambda: mr.Grid("nan", i=[1]), "build = 'nan' of type str is not a function"),
    (lambda: mr.GroundMotion(Endless(), 0.1), "accel = .* has more values than memory holds"),
    (lambda: mr.compare(answer(), stands()), "candidate is that of masonry; responses of one wall are compared"),
    (lambda: mr.collapse_multiplier(COLUMN, set()), "direction = set.* does not hold real numbers alone"),
    (lambda: mr.collapse_multiplier(BOX, set(), angle=0.1), "direction = set.* does not hold real numbers alone"),
    (lambda: mr.collapse_multiplier(BOX, 2, angle=0.1), "direction = 2 of type int is not a direction"),
    (lambda: mr.lost([{"outcome": 3, "peak_over_alpha": 0.1}]), r"rows\[0\] has outcome = 3 of type int"),
    (lambda: mr.lost([{"outcome": [], "peak_over_alpha": 0.1}]), r"rows\[0\] has outcome = \[\] of type list"),
    (lambda: mr.lost([{"outcome": "lost", "peak_over_alpha": 0.1}]), r"rows\[0\] has outcome = 'lost'"),
    (
        lambda: mr.lost([{"outcome": "at rest", "peak_over_alpha": "high"}]),
        r"rows\[0\], peak_over_alpha = 'high' of type str is not a real number",
    ),
    (
        lambda: mr.lost([{"outcome": np.zeros(2), "peak_over_alpha": 0.1}]),
        r"rows\[0\] has outcome = array\(.* of type ndarray",
    ),
    (
        lambda: mr.sensitivity(lambda k: 0.01 * k, {"k": np.datetime64("2020-01-01")}, {"k": [0.5]}),
        r"build fails at k = .*datetime64\('2020-01-01'\) of type datetime64: \w+: ufunc",
    ),
    (lambda: plotting.rotation([answer()], ax=2), "ax = 2 of type int is not a Axes"),
    (lambda: drawn(plotting.rotation, 3), "responses = 3 of type int is not a sequence of at least one"),
    (lambda: drawn(plotting.energy, [answer(), 3]), r"responses\[1\] = 3 of type int is not a Response"),
    (lambda: drawn(plotting.ties, [answer()], ["a", "b"]), "labels has 2 texts for 1 responses"),
    (lambda: drawn(plotting.acceleration, CASE, math.nan), "until = nan is outside the valid range"),
    (lambda: drawn(plotting.pushover, {"a": 1}), r"curves\['a'\] = 1 of type int is not a PushoverCurve"),
    (lambda: drawn(plotting.incremental, [1.0], [[1.0, 2.0]], "a"), r"peaks has the shape \(1, 2\)"),
    (lambda: plotting.panels([]), r"drawings = \[\] of type list is not a sequence of at least one"),
    (lambda: plotting.panels([("a", 3)]), r"drawings\[0\]\[1\] = 3 of type int is not a function that draws"),
    (lambda: plotting.grid([("a", [answer()])], 0), "columns = 0 is outside the valid range 1 to 50"),
    *((lambda name=name: mr.Polygon(SQUARE, name=name), "name = .* the end of a line") for name in LINES),
)


def test_what_cannot_be_is_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert not_refused((complaint, call, complaint) for call, complaint in CANNOT_BE) == []
    assert not list(tmp_path.iterdir())


def contacts(**options):
    return mr.Contacts.from_law(WALL, E, 5e8, 5e8, **options)


def drawn(draw, *given):
    return draw(plotting.single(lambda ax: ax).axes[0], *given)


def test_a_fraction_is_a_factor_and_a_file_may_have_any_name(tmp_path):
    path = plotting.animate(answer(), tmp_path / "x\udcff.gif", magnify=Fraction(1, 2), fps=5.0, dpi=20.0)
    assert path.stat().st_size
    assert mr.GroundMotion.sine(1.0, Fraction(1, 2)) == mr.GroundMotion.sine(1.0, 0.5)


FORMULAS = {
    "=HYPERLINK(1)": "'=HYPERLINK(1)", "=1+1": "'=1+1", "@SUM(A1)": "'@SUM(A1)", "+a": "'+a", "-a": "'-a",
    "\t=1": "'\t=1", "-0.5": "-0.5", "+1e3": "+1e3", "-inf": "-inf", "a=1": "a=1", "": "",
}  # fmt: skip


def test_no_cell_is_a_formula(tmp_path):
    assert {text: csv_text(["a", "b"], [[text, -0.5]]) for text in FORMULAS} == {
        text: f"a,b\n{plain},-0.5\n" for text, plain in FORMULAS.items()
    }
    with mr.Store(tmp_path / "s.sqlite", writing=True) as store:
        store.add_columns(["=note"])
        plain = dict.fromkeys(ROW_COLUMNS, 0) | {"seconds": -1.5}
        store.add([plain | {"key": f"k{i}", "=note": text} for i, text in enumerate(FORMULAS)])
        head, *lines = store.csv().splitlines()
        assert head.split(",")[-1] == "'=note"
        assert sorted(line.split(",")[-2:] for line in lines) == sorted(["-1.5", shown] for shown in FORMULAS.values())
        assert {row["=note"] for row in store.rows()} == set(FORMULAS)


def test_a_long_value_that_is_not_one_of_some_names_is_cut_short():
    for long in ("x" * 1000, np.zeros((30, 30)), 10**400):
        with pytest.raises(ValueError, match=r"baseline = .*\.\.\. is not one of constant, linear") as refused:
            SHAKE.corrected(long)
        assert len(str(refused.value)) < 150
