"""The plan of the form from the schema of the file, and its input as tables of the file and back."""

import math
import re
import tomllib

import pytest

import mjrock as mr
from mjrock.app import tasks
from mjrock.app.form import TEXTS, Plan, state_of, text_of, texts_of, typed
from mjrock.assessment.assessment import assessment_of
from mjrock.assessment.declarations import subclasses_of
from mjrock.assessment.schema import whole_schema
from mjrock.problem.masonry.laws.own_law import OwnLaw
from mjrock.problem.wall.effect import CombinedEffect, Effect
from mjrock.reporting.texts import Words, languages, texts
from mjrock.toml_text import toml_text

NUMBER, TRUTH, ROW = frozenset({"number", "string"}), frozenset({"boolean"}), frozenset({"array"})
MECHANISMS = {"Case", "Corner", "VerticalBending", "HorizontalBending"}
ITALIAN = MECHANISMS | {"Block", "Opening", "Gable", "SideStop", "code_spectrum", "Restitution"}
ITALIAN |= {"Tie", "Thrust", "Load", "AddedMass", "Wedge", "EarthPressure", "FrictionDamper", "Damper"}


OF_TABLES = {"table", "list", "named", "pairs"}


@pytest.fixture(scope="module")
def plan():
    return Plan(whole_schema(), Words("it", TEXTS))


@pytest.fixture(scope="module")
def english():
    return Plan(whole_schema(), Words("en", TEXTS))


def shown(field):
    """Whether a field is drawn with a line of help."""
    return field.control not in OF_TABLES or (field.control == "table" and bool(field.choices))


def variant_named(plan, field, **names):
    return plan.variant(field, names)


def field_of(plan, *keys, **names):
    """The field of a key within tables of the usual variants."""
    field = plan.root
    for key in keys:
        field = plan.field(plan.tables[plan.variant(field, names).id], key)
        names = {}
    return field


def test_a_field_has_unit_range_default_and_help_of_the_declaration(plan):
    inset = field_of(plan, "wall", "inset")
    assert (inset.control, inset.unit, inset.range, inset.default) == ("number", "m", "da 0 a 10 m", "0")
    assert "schiacciamento" in inset.help
    assert not inset.needed
    thickness = field_of(plan, "wall", "thickness")
    assert (thickness.range, thickness.needed, thickness.label) == ("da 0,002 a 20 m", True, "spessore")
    assert field_of(plan, "wall", "density").unit == "kg/m³"


def test_the_root_is_one_of_the_mechanisms_and_takes_several_by_name(plan):
    assert {one.names["kind"] for one in plan.root.variants} >= MECHANISMS
    assert plan.variant(plan.root, {}).names == {"kind": "Case"}
    assert plan.variant(plan.root, {"kind": "Corner"}).label == "cantonata che ribalta"
    assert field_of(plan, "mechanisms").control == "named"
    assert field_of(plan, "language") is None  # the page has a list for it


def test_effects_are_a_list_of_every_public_effect_and_of_its_constructors(plan):
    effects = field_of(plan, "effects")
    assert effects.control == "list"
    assert {one.names["kind"] for one in effects.variants} >= {"Tie", "Thrust", "Load", "AddedMass", "Damper", "Wedge"}
    of_bar = plan.variant(effects, {"kind": "Tie", "make": "of_bar"})
    assert (of_bar.id, of_bar.label) == ("Tie.of_bar", "catena: di barra con capochiave")
    assert plan.variant(effects, {"kind": "Tie"}).id == "Tie"
    assert plan.field(plan.tables["Tie.of_bar"], "diameter").unit == "m"
    assert plan.field(plan.tables["Tie"], "height").label == "quota"


def test_the_site_takes_limit_states(plan):
    state = field_of(plan, "site", "SLV")
    assert state.control == "table"
    assert plan.field(plan.tables[plan.variant(state, {}).id], "ag").unit == "m/s²"


def test_records_are_a_list_and_a_single_table_is_one_too(plan):
    records = field_of(plan, "records")
    assert records.control == "list"
    of_esm = {"kind": "GroundMotion", "make": "from_esm", "path": "a.ASC"}
    assert plan.field(plan.tables[plan.variant(records, of_esm).id], "path").control == "file"
    assert plan.field(plan.tables[plan.variant(records, {}).id], "folder").control == "folder"
    found = list(plan.files_in({"records": [of_esm, {"folder": "."}], "motion": {"make": "from_at2", "path": "b.AT2"}}))
    assert found == [(("records", 0, "path"), "a.ASC"), (("records", 1, "folder"), "."), (("motion", "path"), "b.AT2")]


def test_files_are_found_in_further_mechanisms(plan):
    motion = {"make": "from_at2", "path": "/etc/passwd"}
    assert list(plan.files_in({"mechanisms": {"a": {"motion": motion}}})) == [
        (("mechanisms", "a", "motion", "path"), "/etc/passwd")
    ]


def test_a_run_is_by_one_of_the_solvers(plan):
    run = field_of(plan, "run")
    assert [one.names["solver"] for one in run.variants] == ["analytical", "explicit", "MuJoCo", "compliant"]
    assert plan.variant(run, {}).label == "teoria dell'oscillazione"
    assert plan.tables_of({"run": {"solver": "MuJoCo", "accuracy": "1e-4"}}) == {
        "run": {"solver": "MuJoCo", "accuracy": 1e-4}
    }


def test_a_mechanism_may_do_without_a_shared_floor(plan):
    several = {"mechanisms": {"a": {"floor": "false"}}}
    assert plan.tables_of(several) == {"mechanisms": {"a": {"floor": False}}}


def test_keys_that_are_not_known_keep_their_values(plan):
    tables = {"site": {"DL": {"ag": 2.5, "name": "x"}}, "other": [1, 2]}
    assert plan.tables_of(state_of(tables)) == tables


def test_a_stop_is_a_truth_or_a_table(plan):
    stop = field_of(plan, "side_stop")
    assert (stop.control, stop.choices) == ("table", (("true", "sì"), ("false", "no")))
    assert plan.tables_of({"side_stop": "false"}) == {"side_stop": False}
    assert plan.tables_of({"side_stop": {"top": "3"}}) == {"side_stop": {"top": 3}}


@pytest.mark.parametrize(
    ("text", "types", "value"),
    [
        ("6", NUMBER, 6),
        ("6,5", NUMBER, 6.5),
        (" 6.5 ", NUMBER, 6.5),
        ("1e10", NUMBER, 1e10),
        ("inf", NUMBER, math.inf),
        ("30 cm", NUMBER, "30 cm"),
        ("1,5 MPa", NUMBER, "1.5 MPa"),
        ("-0,5", NUMBER, -0.5),
        ("1234,567", NUMBER, 1234.567),
        ("12,000 mm", NUMBER, "12,000 mm"),
        ("1,000", NUMBER, "1,000"),  # a thousand for some, one for others
        ("0,125", NUMBER, 0.125),
        ("1.000,5", NUMBER, "1.000,5"),
        ("abc", NUMBER, "abc"),
        ("true", TRUTH, True),
        ("yes", TRUTH, "yes"),
        ("[1, [2.5, 3]]", ROW, [1, [2.5, 3]]),
        ("[1,", ROW, "[1,"),
        ("[" * 10_000, ROW, "[" * 10_000),
        ("NTC 2018", frozenset({"string"}), "NTC 2018"),
        ("6", frozenset({"string"}), "6"),
    ],
)
def test_a_text_becomes_what_its_field_takes(text, types, value):
    found = typed(text, types)
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize("value", [0.1, 1 / 3, 1e-300, 22e6, 1.5e22, 7, -0.0, math.inf, True, 'a " b', [0.1, [1, 2]]])
def test_values_come_back_with_all_their_digits(value):
    types = frozenset({"number", "boolean", "array"}) - ({"boolean", "array"} if isinstance(value, str) else set())
    found = typed(text_of(value), types)
    assert found == value


@pytest.mark.parametrize("name", sorted(tasks.templates_of()))
def test_templates_come_back_from_the_form_as_they_are(plan, name):
    tables = tasks.templates_of()[name]
    assert plan.tables_of(state_of(tables)) == tables
    assert tomllib.loads(toml_text(plan.tables_of(state_of(tables)))) == tables


def test_input_becomes_an_assessment(plan):
    state = {
        "wall": {"thickness": "50 cm", "height": "5,0", "length": "8", "gable": {"height": "2.5"}},
        "effects": [{"kind": "Tie", "height": "2.4", "stiffness": "22e6", "strength": "60 kN", "slack": ""}],
        "site": {"code": "NTC 2018", "ag": "0.18 g", "F0": "2,5", "Tc": "0.33", "soil": "B"},
    }
    made = assessment_of(plan.tables_of(state)).mechanisms[""]
    wall = mr.Block.from_size(thickness=0.5, height=5.0, length=8.0, gable=mr.Gable(2.5))
    assert made.problem.block == wall
    assert made.problem.effects == (mr.Tie(2.4, 22e6, strength=60e3),)


def test_every_argument_of_walls_has_words_in_each_language():
    """English ones may be those of the program; every other language has its own."""
    for language in languages():
        plan = Plan(whole_schema(), Words(language, TEXTS))
        wanted = {id: fields for id, fields in plan.tables.items() if id.partition(".")[0].rstrip("!?*") in ITALIAN}
        assert len(wanted) > 15
        words = plan.words.texts
        lacking = [
            f"{id}: {field.key}"
            for id, fields in wanted.items()
            for field in fields
            if not {f"arg_{field.key}", f"in_{field.key}"} & words.keys()
        ]
        assert lacking == []


def test_the_texts_of_the_form_are_in_every_language_and_none_of_the_report_is_hidden():
    own = tomllib.loads(TEXTS.read_text("utf-8"))
    words = {key: text for key, text in own.items() if not key.startswith("help_")}
    assert [key for key, text in words.items() if set(text) != set(languages())] == []
    assert own.keys() & texts().keys() == set()
    assert texts_of(Words("it", TEXTS))["run"] == "Calcola il moto"


@pytest.mark.parametrize("language", languages())
def test_a_range_stands_once_with_its_unit(language):
    """A description that repeats the ends of the schema is without them; the rest of it stays as it is."""
    plan = Plan(whole_schema(), Words(language, TEXTS))
    twice = re.compile(r", (above )?-?[\d.e-]+\d to -?[\d.e-]*\d([.;,:](?!\d)| and |$)")
    found = {
        f"{place}.{one.key}": one.help + one.english
        for place, fields in plan.tables.items()
        for one in fields
        if one.range and twice.search(one.help + one.english)
    }
    assert found == {}


def test_ranges_are_printed_in_the_language(plan, english):
    for one, thickness, mass, height in (
        (english, "0.002 to 20 m", "0 to 10\u2078 kg", "0.01 to 200 m"),
        (plan, "da 0,002 a 20 m", "da 0 a 10\u2078 kg", "da 0,01 a 200 m"),
    ):
        assert one.field(one.tables["Block.from_size!"], "thickness").range == thickness
        assert one.field(one.tables["AddedMass"], "mass").range == mass
        assert one.field(one.tables["Block.from_size!"], "height").range == height
    assert plan.field(plan.tables["Thrust"], "force").range == "da \u221210\u2079 a 10\u2079 N"
    assert plan.field(plan.tables["Tie.of_bar"], "yield_stress").range == "da 5\u00b710\u2077 a 2\u00b710\u2079 Pa"
    assert field_of(english, "wall", "thickness").help == "2b at the base."
    assert field_of(english, "wall", "inset").help.startswith(
        "how far the edges that the wall rocks about lie inside its faces, less than b."
    )
    assert english.field(english.tables["Tie"], "strength").range == "from 0 N"


def test_every_help_label_and_name_that_the_form_shows_is_italian(plan, english):
    """None is the text of the program, and none lacks, but for classes that other tests make. A key with an English
    name in both has that word in Italian."""
    described = {one.help for fields in english.tables.values() for one in fields if one.help}
    found = (kind for base in (Effect, CombinedEffect, OwnLaw) for kind in subclasses_of(base))
    others = {kind.__name__ for kind in found if not kind.__module__.startswith("mjrock.")}
    tables = {place: fields for place, fields in plan.tables.items() if re.split(r"\W", place)[0] not in others}
    used = [(place, one) for place, fields in tables.items() for one in fields if shown(one)]
    assert len(used) > 1000
    assert sorted({f"{place}.{one.key}" for place, one in used if not one.help or one.help in described}) == []
    texts = plan.words.texts
    fields = [(place, one) for place, fields in tables.items() for one in fields]
    own = {
        (place, one.key): f"arg_{plan.names_of(one.key, place)[1].partition('.')[0]}_{one.key}" for place, one in fields
    }
    labels = {
        one.key for place, one in fields if not {own[place, one.key], f"arg_{one.key}", f"in_{one.key}"} & texts.keys()
    }
    assert labels == set()
    names = {name for _, one in fields for each in one.variants for name in each.names.items()}
    names -= {("kind", name) for name in others}
    words = {"kind": "table", "solver": "table", "make": "make"}
    assert sorted(f"{words[key]}_{name}" for key, name in names if f"{words[key]}_{name}" not in texts) == []


def test_a_key_without_italian_help_keeps_its_english_one_apart(english):
    """As that of a class of a user."""
    words = Words("it", TEXTS)
    words.texts = words.texts | {"help_it": {}}
    plan = Plan(whole_schema(), words)
    law = plan.field(plan.tables["DampingLaw!"], "source")
    assert (law.help, law.english) == ("", english.field(english.tables["DampingLaw!"], "source").help)
    assert not any(one.english for fields in english.tables.values() for one in fields)


def test_every_entry_of_the_table_of_helps_is_a_key(plan):
    names = {name for place, fields in plan.tables.items() for one in fields for name in plan.names_of(one.key, place)}
    helps = tomllib.loads(TEXTS.read_text("utf-8"))["help_it"]
    assert len(helps) > 150
    assert helps.keys() - names == set()
