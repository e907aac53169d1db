"""The inputs of a report: each number that was given is read back out of the page; a report of checks alone."""

import csv
import html
import re

import numpy as np
import pytest

import mjrock as mr
from mjrock.reporting.markup import picture
from mjrock.reporting.pictures import static_answer_figure, wall_drawing
from mjrock.reporting.texts import DASH, Words

SLV = mr.code_spectrum("NTC 2018", ag=2.2345, F0=2.4567, Tc=0.3456, soil="C", topography="T2")
SLC = mr.code_spectrum("NTC 2018", ag=2.7654, F0=2.5432, Tc=0.3789, soil="C", topography="T2")
FLOOR = SLV.at_height([0.2789, 0.1357], 0.0456, participation=[1.2345, 0.3579], height=[0.6543, -0.2468])
WALL = mr.Block.from_size(
    0.5123,
    6.1234,
    5.4321,
    1912.0,
    0.0123,
    [mr.Opening(1.1357, 2.0864, 0.9753)],
    gable=mr.Gable(height=1.3579, top=0.4444),
)
STEPPED = mr.Block.from_size(0.6789, 7.8912, profile=[(0.0, 0.6789), (4.5671, 0.3456), (7.8912, 0.3456)], plumb="outer")
BARE = (mr.Thrust(5.5551, 1234.5), mr.Load(23456.0, 6.0123, 0.1111))
TIE = mr.Tie(4.4441, 2.3456e7, slack=0.0013, strength=34567.0, ultimate=0.0246)
STRIP = mr.Block.from_size(0.3777, 2.2222, 1.5555, 1777.0)


def case_of(effects, block=WALL):
    return mr.Case(block, 0.0, 10.0, side_stop=mr.SideStop(3.3331), effects=effects)


def read(path):
    """What a reader reads, without units' blanks."""
    text = re.sub(r"base64,[^\"]*", "", path.read_text(encoding="utf-8"))
    return html.unescape(re.sub(r"<[^>]+>", " ", text)).replace("\u00a0", " ")


def table_of(path, heading):
    """The rows of the table below a heading."""
    text = path.read_text(encoding="utf-8")
    body = text[text.index(heading) :]
    body = body[body.index("<tbody>") : body.index("</tbody>")]
    rows = re.findall(r"<tr>(.*?)</tr>", body)
    return [[html.unescape(cell) for cell in re.findall(r"<td[^>]*>(.*?)</td>", row)] for row in rows]


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """A report of checks alone, of five mechanisms."""
    checks = {
        "whole": mr.mechanism_check(case_of(BARE), {"SLV": SLV, "SLC": SLC}),
        "tied": mr.mechanism_check(case_of((*BARE, TIE)), SLV),
        "stepped": mr.mechanism_check(mr.Case(STEPPED, 0.0, 1.0), FLOOR, elastic_period=0.2345),
        "upright": mr.mechanism_check(mr.VerticalBending(STRIP, 54321.0, bearing=0.2223, crack=1.1119), FLOOR),
        "level": mr.mechanism_check(mr.HorizontalBending(STRIP, 65432.0, crack=0.6667), FLOOR),
        "corner": mr.mechanism_check(mr.Corner(0.4567, 3.4567, 0.3141, 1888.0), SLV),
    }
    path = mr.report(case_of(BARE), (), tmp_path_factory.mktemp("report") / "a.html", checks=checks)
    return path, checks


GIVEN = """
2.2345 m/s² 2.4567 0.3456 s C T2 2.7654 m/s² 2.5432 0.3789 s
0.2789 s 0.1357 s 4.56 % 1.2345 0.3579 0.6543 \u22120.2468
0.5123 m 6.1234 m 5.4321 m 1912 kg/m³ 12.3 mm 1.1357 2.0864 0.9753 1.3579 m 0.4444 m 3.3331 m
1.2345 kN 5.5551 m 23.456 kN 6.0123 m 0.1111 m 4.4441 m 23.456 MN/m 1.3 mm 34.567 kN 24.6 mm
0.6789 m 7.8912 m 0.3456 m 4.5671 m 0.3777 m 2.2222 m 1.5555 m 1777 kg/m³ 54.321 kN 0.2223 m 1.1119 m
65.432 kN 0.6667 m 0.4567 m 3.4567 m 0.3141 rad 1888 kg/m³
"""


def test_each_number_that_was_given_is_read_out_of_the_page(alone):
    text = read(alone[0])
    appendix = text[text.index("Appendix: inputs") :]
    numbers = re.findall(r"[\u2212\d][\d.]*(?: (?:m/s²|kg/m³|MN/m|kN|mm|rad|m|s|%))?|\bC\b|T2", GIVEN)
    assert len(numbers) > 50
    assert [number for number in numbers if number not in appendix] == []
    assert "the outer one" in appendix


def test_a_report_of_checks_alone_has_no_word_of_runs(alone):
    path, checks = alone
    text = read(path)
    assert "dynamic runs" not in text.lower().replace("nonlinear and the dynamic", "").replace("verdict by dynamic", "")
    for word in ("Every run", "Ground motions", "no ground motion", "record that governs", "at least one response"):
        assert word not in text
    assert text.count("HOLDS") + text.count("FAILS") >= sum(len(check.verdicts) for check in checks.values())
    assert "NTC 2018, 10.2" in text


def test_a_report_of_nothing_is_refused(tmp_path):
    with pytest.raises(ValueError, match="responses is empty; give at least one response, or checks, or sections"):
        mr.report(case_of(BARE), (), tmp_path / "a.html")


def test_the_verdict_is_repeated_from_what_the_appendix_says(alone):
    """A few lines that read the table of a spectrum and of a wall, and no object of the program that made it."""
    path, checks = alone
    cells = {name: first for name, first, *_ in table_of(path, "<b>Seismic action")}

    def number(message):
        return float(message.split()[0])

    site = mr.code_spectrum(
        cells["elastic spectrum"],
        ag=number(cells["peak acceleration on rock, ag"]),
        F0=float(cells["largest amplification, F₀"]),
        Tc=number(cells["corner period on rock, TC*"]),
        soil=cells["ground type"],
        topography=cells["topography"],
    )
    walls = {row[0]: row for row in table_of(path, "<b>What stands")}
    opening = [float(x) for x in re.findall(r"\d[\d.]*", walls["opening"][1])]
    gable = [float(x) for x in re.findall(r"\d[\d.]*", walls["gable"][1])]
    inset = number(walls["inset of the hinge"][1]) / 1e3
    sizes = (number(walls[name][1]) for name in ("thickness", "height", "length", "density"))
    wall = mr.Block.from_size(*sizes, inset, [mr.Opening(*opening)], gable=mr.Gable(*gable))
    load = [float(x) for x in re.findall(r"\d[\d.]*", walls["load 1"][1])]
    thrust = [float(x) for x in re.findall(r"\d[\d.]*", walls["thrust 1"][1])]
    effects = mr.Thrust(thrust[0], 1e3 * thrust[1]), mr.Load(1e3 * load[0], load[1], load[2])
    again = mr.mechanism_check(mr.Case(wall, 0.0, 1.0, effects=effects), site)
    one, other = checks["whole"].states["SLV"], again.states["SLV"]
    assert other.ratio == pytest.approx(one.ratio, rel=1e-12)
    assert again.linear_ratio == pytest.approx(checks["whole"].linear_ratio, rel=1e-12)


def test_page_one_answers_in_sentences_the_worst_first(alone):
    path, checks = alone
    text = path.read_text(encoding="utf-8")
    first = read(path)[: read(path).index("The kinematic check")]
    present = {name: min(v.ratio for v in check.verdicts) for name, check in checks.items() if name != "tied"}
    worst = min(present, key=present.get)
    assert f"As it is, {worst} governs:" in first
    assert "With what is proposed, tied:" in first
    rows = re.findall(r"<td rowspan=\"\d\"><b>(\w+)</b>", text)
    least = [min(v.ratio for v in checks[name].verdicts) for name in rows]
    assert len(rows) == 6
    assert least == sorted(least)
    refused = [verdict for verdict in checks["tied"].verdicts if not verdict.holds]
    message = first[first.index("With what is proposed") :].split("Least ratio")[0]
    assert message.count(", SL") == (len(refused) if len(refused) < 3 else 0)


def masonry_of(count):
    ground = mr.Polygon([(-1.2345, -0.3), (2, -0.3), (2, 0), (-1.2345, 0)], fixed=True, name="ground")
    blocks = [
        mr.Polygon([(0.0111, i), (0.4321, i), (0.4321, i + 1), (0.0111, i + 1)], density=1888.0 + i)
        for i in range(count)
    ]
    return mr.Masonry([ground, *blocks], k_n=1.2345e9, friction=0.6543)


def rebuilt(rows):
    """Blocks of name, density, length, whether fixed, and vertices as text."""
    for name, density, length, fixed, vertices in rows:
        pairs = re.findall(r"\(([^)]*)\)", vertices.replace("\u2212", "-"))
        corners = [[float(x) for x in pair.split(";")] for pair in pairs]
        yield mr.Polygon(corners, float(density), float(length), fixed in ("fixed", "fisso"), name)


@pytest.mark.parametrize(("count", "in_file", "language"), [(2, False, "en"), (70, True, "en"), (70, True, "it")])
def test_masonry_is_rebuilt_from_the_page_or_the_file_beside_it(tmp_path, count, in_file, language):
    masonry = masonry_of(count)
    case, given = mr.MasonryCase(masonry, 1.0), {"sections": {"Note": "Blocks."}, "language": language}
    path = mr.report(case, (), tmp_path / "a.html", **given)
    files = [tmp_path / f"a_{key}.csv" for key in ("blocks", "joints")]
    assert set(tmp_path.iterdir()) == {path, *(files if in_file else [])}
    if in_file:
        assert Words(language)("in_a_file", count=count + 1, file="a_blocks.csv") in read(path)
        rows, joints = (list(csv.reader(file.read_text("utf-8").splitlines()))[1:] for file in files)
    else:
        rows, joints = table_of(path, "<b>Blocks"), table_of(path, "<b>Joints")
    again = mr.Masonry(list(rebuilt(rows)), k_n=float(joints[0][1]), friction=float(joints[0][3]))
    assert [block.vertices for block in again.blocks] == [block.vertices for block in masonry.blocks]
    assert [block.density for block in again.blocks] == [block.density for block in masonry.blocks]
    assert len(joints) == len(again.joints)
    if not in_file:
        multipliers = [mr.collapse_multiplier(one).multiplier for one in (masonry, again)]
        assert multipliers[0] == pytest.approx(multipliers[1], rel=1e-12)


def test_restitution_and_contacts_of_each_variant(tmp_path):
    wall = mr.Block.from_size(0.6, 4.2)
    case = mr.Case(wall, 0.02, 0.5)
    answer = mr.solve_analytical(case, mr.Restitution(0.9123, -0.3456))
    e = {"one": mr.Restitution(0.9123, -0.3456), "other": mr.Restitution(0.8765, -0.4321)}
    path = mr.report(case, {"one": answer, "other": answer}, tmp_path / "a.html", e=e)
    rows = table_of(path, "<b>Impacts and contacts")
    assert [row[1:3] for row in rows[:2]] == [["0.912", "0.876"], ["\u22120.346", "\u22120.432"]]
    with pytest.raises(TypeError, match=r"e\['one'\] = 3"):
        mr.report(case, {"one": answer}, tmp_path / "b.html", e={"one": 3})


def test_a_record_has_its_scaling_and_its_floor(tmp_path):
    wall = mr.Block.from_size(0.6, 4.2)
    record = mr.scaled_to_spectrum(mr.GroundMotion.synthetic(1.0, 2.0, seed=1), [0.2, 0.5], SLV)
    floor = record.through_building(0.2789, 0.0456, participation=1.2345, height=0.6543)
    answer = mr.solve_analytical(mr.Case(wall, 0.0, 1.0, motion=floor), mr.Restitution.from_geometry(wall))
    text = read(mr.report(answer.case, answer, tmp_path / "a.html"))
    assert "NTC 2018, ag = 2.2345 m/s²; factor" in text
    assert "over T = 0.2, 0.5 s" in text
    assert "Tk = 0.2789 s, xi = 0.0456, gammak = 1.2345, psik = 0.6543" in text


def test_records_are_called_by_station_component_and_factor(tmp_path):
    wall = mr.Block.from_size(0.6, 4.2)
    header = {"STATION_CODE": "ST1", "STREAM": "HNE"}
    record = mr.GroundMotion(np.sin(np.linspace(0.0, 12.0, 200)), 0.01, "ST1 HNE", header).scaled(1.27238)
    cases = [mr.Case(wall, 0.0, 1.0, motion=motion) for motion in record.polarities]
    answers = [mr.solve_analytical(case, mr.Restitution.from_geometry(wall)) for case in cases]
    text = mr.report(cases[0], answers, tmp_path / "a.html").read_text(encoding="utf-8")
    assert text.count("<td>station ST1, E, factor 1.27</td>") == 3  # a row for each polarity, and the record
    assert "ST1 HNE x" not in text
    check = mr.dynamic_check(answers, natural=True)
    text = read(mr.report(cases[0], answers, tmp_path / "b.html", checks=check))
    assert "ST1 HNE x" not in text[text.index("What governs") : text.index("What these results")]
    assert "station ST1, E, factor 1.27" in text[text.index("What governs") : text.index("What these results")]


def test_an_italian_report_of_blocks_names_them_in_italian(tmp_path):
    column = mr.Masonry.stack([mr.Block.from_size(0.4, 0.5)] * 8, k_n=1e9, friction=0.9)
    curve = mr.limit_curve(column, 1, poses=20)
    run = mr.solve_explicit(mr.MasonryCase(column, 0.01, motion=mr.GroundMotion.half_sine(0.5, 0.2)))
    checks = {
        "curva": [mr.dynamic_check([run], curve=curve, natural=True)],
        "limite": [mr.load_check(curve.start, 0.1)],
    }
    text = read(mr.report(run.case, run, tmp_path / "a.html", checks=checks, language="it"))
    assert "e altri 3" in text
    assert "and 3 more" not in text
    assert re.search(r"baricentro di block_0, .* e altri 3, lungo \(1; 0\)", text)
    figure = static_answer_figure(curve.start, Words("it"))
    picture(figure, "limite", Words("it"))
    forces = curve.start.forces
    largest = Words("it").quantity(float(np.hypot(forces.normal, forces.shear).max()), "N", 3)
    assert figure.axes[0].get_legend().get_texts()[0].get_text() == largest.replace("\u00a0", " ")


def test_the_linear_ratio_of_a_free_element_stands_over_what_it_is_compared_with():
    rigid, free = (mr.mechanism_check(case_of(BARE), SLV, elastic_period=T_0) for T_0 in (None, 0.2345))
    steps = [{step.key: step.value for step in one.steps} for one in (rigid, free)]
    assert steps[0]["linear_ratio"] == pytest.approx(steps[0]["linear"] / steps[0]["peak"])
    assert steps[1]["free_linear_ratio"] == pytest.approx(steps[1]["linear"] / steps[1]["free_peak"])
    assert [sorted(key for key in one if key.endswith("linear_ratio")) for one in steps] == [
        ["linear_ratio"],
        ["free_linear_ratio"],
    ]
    assert free.code.steps["free_linear_ratio"].formula == "{q a_0}/{S_{eZ}(T_0)}"


@pytest.mark.parametrize(("length", "one"), [(4.0, True), (12.0, True), (20.0, True), (40.0, False)])
def test_section_and_elevation_have_one_scale_or_say_that_they_have_not(length, one):
    case = mr.Case(mr.Block.from_size(0.8, 9.0, length), 0.0, 1.0)
    drawn = wall_drawing(case, Words("en"))
    drawn.figure.draw_without_rendering()
    scales = [ax.transData.transform([(0.0, 9.0), (1.0, 9.0)]) for ax in drawn.figure.axes]
    left, right = (float(ends[1, 0] - ends[0, 0]) for ends in scales)
    assert drawn.one_scale is one
    assert [ax.get_title() + ax.get_title("left") for ax in drawn.figure.axes] == [
        Words("en")(key) for key in ("section", "elevation")
    ]
    assert (abs(left / right - 1) < 1e-9) is one
    for ax in drawn.figure.axes:  # x and y alike
        (x, _), (_, y) = ax.transData.transform([(1.0, 0.0), (0.0, 1.0)]) - ax.transData.transform((0.0, 0.0))
        assert x == pytest.approx(y, rel=1e-9)


def test_a_check_of_blocks_names_what_moves_and_lists_its_blocks(tmp_path):
    masonry = masonry_of(2)
    check = mr.mechanism_check(mr.limit_curve(masonry, 1, poses=20), SLV)
    text = read(mr.report(mr.MasonryCase(masonry, 1.0), (), tmp_path / "a.html", checks={"statue": check}))
    assert "what moves" in text
    for message in ("0.4321; 2", "1889", "1.2345 GN/m³", "0.6543", "2.2345 m/s²"):
        assert message in text


def test_a_side_stop_that_nobody_gave_is_said_to_be_assumed(tmp_path):
    wall = mr.Block.from_size(0.5, 2.6)
    for stop, message in ((True, "assumed, not given"), (mr.SideStop(2.6), "not given"), (False, "not given")):
        case = mr.Case(wall, 0.0, 1.0, side_stop=stop)
        path = mr.report(case, (), tmp_path / "a.html", sections={"Note": "Wall."})
        (row,) = (row for row in table_of(path, "<b>What stands") if row[0] == "side walls")
        assert row[2] == message
        assert ("up to 2.6\u00a0m" in row[1]) is isinstance(stop, mr.SideStop)


@pytest.mark.parametrize("language", ["en", "it"])
def test_loads_have_a_weight_and_no_inertia_which_the_limits_say(tmp_path, language):
    words = Words(language)
    for effects, names in (((), ""), ((mr.AddedMass(300.0, 6.0),), ""), (BARE[1:], "load 1")):
        case = case_of(effects)
        path = mr.report(case, (), tmp_path / "a.html", sections={"Note": "Wall."}, language=language)
        message = words("limit_load", names=names.replace("load", words("effect_load")))
        assert (message in read(path)) is bool(names)


def test_a_collapse_of_a_wall_has_its_sizes_and_what_grows(tmp_path):
    case = case_of(BARE)
    found = mr.collapse_multiplier(case, None, loads=[mr.Thrust(2.2223, 4567.8)])
    other = mr.Case(mr.Block.from_size(0.4, 3.0), 0.0, 1.0)
    path = mr.report(other, (), tmp_path / "a.html", checks={"wind": found}, language="it")
    text = read(path)
    for message in (
        "0,5123 m",
        "6,1234 m",
        "1912 kg/m³",
        "12,3 mm",
        "spinta 1, crescente",
        "4,5678 kN",
        "2,2223 m",
        "1,2345 kN",
    ):
        assert message in text
    (row,) = (row for row in table_of(path, "<h2>Quanto è sopportato") if row[0] == "parte in moto")
    assert row[1] == "parete"


def test_what_is_driven_has_its_history_and_pairs_have_their_friction(tmp_path):
    t, dx = (0.0, 0.25, 0.75), (0.0, 0.0123, 0.0234)
    jack = mr.Actuator("block_1", (0.0111, 0.5), 1, ((0.0, 0.5), (0.0, 0.0045)), 1.2345e6, 321.0, guided="upright")
    masonry = masonry_of(2)
    own = mr.Masonry(
        masonry.blocks,
        k_n=1e9,
        friction=0.6,
        pairs=lambda one, other: mr.Dry(friction=0.4321) if one == "ground" else None,
    )
    given = {"supports": {"ground": (t, dx, (0.0, 0.0, -0.0031))}, "effects": jack, "settled": False}
    case = mr.MasonryCase(own, 1.0, **given)
    path = mr.report(case, (), tmp_path / "a.html", sections={"Note": "Blocks."})
    rows = table_of(path, "<b>What is driven")
    assert rows[:3] == [
        ["ground", "0", "0", "0", DASH],
        ["ground", "0.25", "0.0123", "0", DASH],
        ["ground", "0.75", "0.0234", "\u22120.0031", DASH],
    ]
    assert rows[3:] == [["actuator 1", "0", "0", DASH, DASH], ["actuator 1", "0.5", "0.0045", DASH, DASH]]
    assert [row[:3] for row in table_of(path, "<b>Blocks without a joint")] == [
        ["ground", name, "0.4321"] for name in ("block_1", "block_2")
    ]
    text = read(path)
    for message in (
        "on block_1, at (0.0111; 0.5) m",
        "1.2345 MN/m",
        "damping 0.321 kN s/m",
        "kept from turning",
        "as drawn, not at rest",
    ):
        assert message in text
    alike = mr.Masonry(masonry.blocks, k_n=1e9, friction=0.6, pairs=mr.Dry(friction=0.3456, xi=0.0789))
    text = read(mr.report(mr.MasonryCase(alike, 1.0), (), tmp_path / "b.html", sections={"Note": "Blocks."}))
    assert "friction 0.3456, damping ratio 7.89 %" in text


def test_effects_on_masonry_name_their_blocks(tmp_path):
    effects = (
        mr.Load(1234.0, 1.9, 0.05, block="block_2"),
        mr.Tie(1.5, 1e6, strength=5e3, prestress=432.1, block="block_2"),
    )
    case = mr.MasonryCase(masonry_of(2), 1.0, effects=effects)
    text = read(mr.report(case, (), tmp_path / "a.html", sections={"Note": "Blocks."}))
    assert "1.234 kN, at 1.9 m, 50 mm to the right of its centroid, on block_2" in text
    assert "prestress 0.4321 kN" in text


def test_vertices_have_no_digits_below_those_of_a_drawing(tmp_path):
    """The middle of an arch is drawn at 6.67e-16 m."""
    arch = mr.Masonry.arch(2.0, 0.4, voussoirs=8)
    smallest = min(abs(x) for block in arch.blocks for vertex in block.vertices for x in vertex if x)
    assert 0 < smallest < 1e-12
    path = mr.report(mr.MasonryCase(arch, 1.0), (), tmp_path / "a.html", sections={"Note": "Arch."})
    assert "10⁻" not in " ".join(row[4] for row in table_of(path, "<b>Blocks"))


def test_records_of_one_run_stand_beside_each_other(tmp_path):
    wall = mr.Block.from_size(0.6, 4.2)
    along, up = (mr.GroundMotion.synthetic(peak, 1.0, seed=seed) for peak, seed in ((1.0, 1), (0.6, 2)))
    case = mr.Case(wall, 0.0, 1.0, motion=along, vertical=up)
    path = mr.report(
        case, mr.solve_analytical(case, mr.Restitution.from_geometry(wall)), tmp_path / "a.html", language="it"
    )
    (run,) = table_of(path, "<h2>Tutte le analisi")
    assert run[1] == "artificiale, 0,6\u00a0m/s², seme 2"
    assert [row[0] for row in table_of(path, "<h2>Moti del suolo")] == [
        f"artificiale, {peak}\u00a0m/s², seme {n}" for peak, n in (("1", 1), ("0,6", 2))
    ]


def test_a_floor_has_its_peak_and_the_ground_has_its_own(alone):
    _, checks = alone
    steps = [{step.key for step in checks[name].steps} for name in ("whole", "upright", "stepped")]
    for kind, keys in zip(("", "floor_", "free_"), steps, strict=True):
        assert {key for key in keys if key.endswith("peak")} == {f"{kind}peak"}
        assert {key for key in keys if key.endswith("linear_ratio")} == {f"{kind}linear_ratio"}
    code = checks["upright"].code
    assert code.steps["floor_peak"].formula == "a_Z"
    assert code.steps["floor_linear_ratio"].formula == "{q a_0}/{a_Z}"
    record = mr.GroundMotion.synthetic(2.0, 2.0, seed=1).through_building(0.2, participation=1.2, height=0.7)
    assert mr.mechanism_check(case_of(BARE), record).peak == pytest.approx(record.peak)


def test_both_d_0_are_named_where_they_stand(tmp_path):
    """That of the curve is that of the centroid over e*; a mass at the top makes them differ."""
    case = mr.Case(WALL, 0.0, 1.0, motion=mr.GroundMotion.synthetic(1.0, 1.0, seed=1), effects=mr.AddedMass(9e3, 6.0))
    check = mr.mechanism_check(case, SLV)
    runs = [mr.solve_analytical(case, mr.Restitution.from_geometry(case.wall))]
    dynamic = mr.dynamic_check(runs, natural=True)
    assert dynamic.d_0 == pytest.approx(check.participation * check.d_0)
    assert check.participation < 0.99
    assert f"d_0 of the centroid: {dynamic.d_0:.4f} m; over e*" in dynamic.table()
    assert "d_0 of the curve a(d), over e* [m]" in check.table()
    text = read(mr.report(case, runs, tmp_path / "a.html", checks=[check, dynamic], language="it"))
    for message, d_0 in (
        ("d₀ della curva a(d): spostamento del baricentro", check.d_0),
        ("d₀ del baricentro, senza catene", dynamic.d_0),
    ):
        assert Words("it").quantity(d_0, "m", 3).replace("\u00a0", " ") in text[text.index(message) :][:160]
