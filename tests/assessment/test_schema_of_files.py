"""The JSON schema: it takes every file that the reader takes, refuses damaged ones, and is short enough for editors."""

import copy
import json
import random
import tomllib
from pathlib import Path

import pytest
from everyday import slow

import mjrock as mr
from mjrock.assessment.schema import whole_schema
from mjrock.assessment.templates import templates
from mjrock.toml_text import toml_text

jsonschema = pytest.importorskip("jsonschema")
FILES = {
    f"file {path.stem}": path.read_text(encoding="utf-8") for path in (Path(__file__).parent / "files").glob("*.toml")
}
DAMAGES = {
    "gone": lambda table, key, draw: table.pop(key),
    "huge": lambda table, key, draw: table.update({key: -1e30}),
    "table": lambda table, key, draw: table.update({key: {"x": 1}}),
    "list": lambda table, key, draw: table.update({key: [True]}),
    "misspelt": lambda table, key, draw: table.update({f"{key}x": table.pop(key)}),
    "swapped": lambda table, key, draw: table.update({key: table[draw.choice(sorted(table))]}),
}


@pytest.fixture(scope="module")
def validator():
    schema = mr.toml_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.fixture(scope="module")
def documents():
    return {name: tomllib.loads(text) for name, text in (FILES | templates()).items()}


def tables_in(value):
    """All tables of a document that have a key."""
    if isinstance(value, dict) and value:
        yield value
    if isinstance(value, dict | list):
        for one in value.values() if isinstance(value, dict) else value:
            yield from tables_in(one)


def is_read(document):
    try:
        mr.from_toml(text=toml_text(document))
    except mr.AssessmentError:
        return False
    return True


def test_equal_parts_stand_once():
    assert 3 * len(json.dumps(mr.toml_schema())) < len(json.dumps(whole_schema()))


def test_files_and_templates_fit(validator, documents):
    assert len(documents) > 8
    for name, document in documents.items():
        assert validator.is_valid(document), name


@pytest.mark.parametrize(
    "wrong",
    [
        {"language": "fr"},
        {"wal": {}},
        {"mechanisms": {"a": {"wall": {"thicknes": 0.3}}}},
        {"mechanisms": {"a": {"language": "it"}}},
        {"mechanisms": {"a": {"mechanisms": {}}}},
    ],
)
def test_wrong_keys_and_values_are_refused(validator, documents, wrong):
    for document in documents.values():
        assert not validator.is_valid(document | wrong)


def test_a_class_may_be_named_where_there_is_no_other(validator):
    document = {"wall": {"kind": "Block", "thickness": 0.3, "height": 3.0}}
    assert validator.is_valid(document)
    assert not validator.is_valid({"wall": document["wall"] | {"kind": "Gable"}})
    assert is_read(document)


@pytest.mark.parametrize(("of_file", "of_template"), [(1, 3), slow((2, len(DAMAGES)))])
def test_a_file_that_is_read_fits_and_parts_that_stand_once_mean_what_they_mean_in_full(
    validator, documents, of_file, of_template
):
    """The schema with every part in its place gives the same verdict on every damaged file, and is built otherwise.

    A template has some damages, and a whole file, of up to twenty mechanisms, fewer."""
    draw, whole = random.Random(4), jsonschema.Draft202012Validator(whole_schema())
    refused = tried = 0
    for name, document in documents.items():
        for damage in draw.sample(list(DAMAGES), of_file if name.startswith("file") else of_template):
            damaged = copy.deepcopy(document)
            table = draw.choice(list(tables_in(damaged)))
            key = draw.choice(sorted(table))
            DAMAGES[damage](table, key, draw)
            fits = validator.is_valid(damaged)
            assert fits == whole.is_valid(damaged), (name, damage, key)
            assert fits or not is_read(damaged), (name, damage, key)
            refused, tried = refused + (not fits), tried + 1
    assert refused > 0.6 * tried
