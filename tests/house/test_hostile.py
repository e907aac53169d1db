"""Every public entry with values that cannot be: a result, or an error that names the argument.

A call starts from arguments that work, and one or two of them are replaced. It has to end in a result, or in a
ValueError or TypeError whose message names an argument of the call, or in a SimulationError of the engine.
"""

import math
import re
import warnings
from itertools import repeat

import mujoco
import numpy as np
import pytest
from entries import (
    ANSWERS,
    BOX,
    COLUMN,
    CONTACTS,
    ENTRIES,
    MOTION,
    PARTS,
    RESPONSE,
    SHORT,
    WALL,
    E,
    given_to,
    solved,
    words_for,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import mjrock as mr

CALLS = {name: row for name, row in ENTRIES.items() if row.given and not row.paths}
"""All but those that write files."""

VALUES = [
    None, True, False, "", "0.3", b"1", [], [1.0], (), {}, 1j, 10**400, -(10**400), math.nan, math.inf,
    -math.inf, 0, -1, 1e-300, 1e300, np.nan, np.float32(2.0), np.int64(3), np.array(0.3), np.array([0.1, 0.2]),
    object(),
    WALL, E, SHORT, COLUMN, BOX, CONTACTS, CONTACTS.base, MOTION,
    mr.Load(1e3, 2.0), mr.SideStop(2.0), [mr.Opening(0.2, 1.0)], RESPONSE, mr.CALIBRATED, print, "no", 2.5,
]  # fmt: skip
HOSTILE = st.one_of(st.sampled_from(VALUES), st.floats(), st.integers(-(10**12), 10**12))


def named(message, arguments):
    """Whether a message names an argument, or what it stands for."""
    return any(re.search(rf"\b{re.escape(word)}", message) for name in arguments for word in words_for(name))


ENTRY = st.sampled_from(sorted(CALLS))
REPLACED = {
    name: st.lists(st.sampled_from(sorted(row.given)), min_size=1, max_size=2, unique=True)
    for name, row in CALLS.items()
}
"""Which arguments of an entry are replaced; made once, since making them takes longer than most calls."""


@st.composite
def calls(draw):
    name = draw(ENTRY)
    return name, {one: draw(HOSTILE) for one in draw(REPLACED[name])}


def is_answered(name, replaced):
    arguments = given_to(name) | {one: solved(value) for one, value in replaced.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            CALLS[name].call(**arguments)
        except mr.SimulationError:
            pass
        except (ValueError, TypeError) as error:
            if not named(str(error), arguments):
                pytest.fail(f"{name} names no argument: {type(error).__name__}: {error}")


HEALTH = [HealthCheck.too_slow, HealthCheck.data_too_large]


@given(calls())
@settings(max_examples=200, deadline=None, derandomize=True, suppress_health_check=HEALTH)
def test_a_call_is_answered_or_refused_by_name(call):
    is_answered(*call)


class Unreadable:
    def __array__(self, *arguments, **named):
        raise RuntimeError("there is no array")


class Lying(list):
    """A list that says that it has more values than memory holds."""

    def __len__(self):
        return 10**12


RAGGED = [[1.0], [1.0, 2.0]]
AN_ARRAY_IS_TAKEN = {
    "Damper, space": ("at", "anchor"),
    "Thrust, space": ("direction",),
    "Actuator": ("at", "direction"),
    "collapse_multiplier, in a pose": ("pose",),
    "push": ("to",),
    "dynamic_check": ("runs",),
    "contact_parameters": ("k", "timestep"),
    "MasonryCase": ("velocity",),
}
"""Arguments that take arrays, each by a check of its own."""


def test_what_cannot_be_read_is_refused_by_name():
    """An object that cannot become an array, rows of different lengths, a module."""
    for name, arguments in AN_ARRAY_IS_TAKEN.items():
        for argument in arguments:
            for value in (Unreadable(), RAGGED, np):
                is_answered(name, {argument: value})


A_LIST_IS_TAKEN = {
    "Block": ("openings", "masses"),
    "VerticalBending": ("effects",),
    "Case": ("effects",),
    "contact_for": ("friction",),
    "dynamic_check": ("runs",),
    "scaled_together": ("motions",),
    "Masonry": ("blocks",),
    "Masonry.stack": ("blocks",),
}
"""Arguments that take lists of things."""


@pytest.mark.parametrize("values", [Lying, lambda: Lying([1.0]), lambda: repeat(1.0)], ids=["empty", "one", "endless"])
def test_a_list_that_lies_about_its_length_is_refused_by_name(values):
    for name, arguments in A_LIST_IS_TAKEN.items():
        for argument in arguments:
            with pytest.raises((TypeError, ValueError), match="|".join(words_for(argument))):
                CALLS[name].call(**CALLS[name].given | {argument: values()})


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(CALLS))
def test_what_cannot_be_read_is_refused_by_name_everywhere(name):
    for argument in CALLS[name].given:
        for value in (
            Unreadable(),
            RAGGED,
            Lying([1.0]),
            np,
            np.ma.masked_all(3),
            np.array([1.0, None]),
            {"a": 1},
            [[[[[1.0]]]]],
        ):
            is_answered(name, {argument: value})


@pytest.mark.parametrize(
    ("name", "argument", "value"),
    [
        ("Tie", "strength", 1e308),
        ("contact_stiffness", "inverse_weight", 1e308),
        ("StiffnessRange", "basis", math.nan),
        ("StiffnessRange", "basis", float),
        ("StiffnessRange", "basis", np.ones(3)),
    ],
)
def test_what_no_wall_has_is_refused(name, argument, value):
    with pytest.raises((ValueError, TypeError), match=argument):
        CALLS[name].call(**CALLS[name].given | {argument: value})


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(CALLS))
def test_every_argument_is_answered_for_hostile_values(name):
    """Each one for a fifth of the values and for numbers of any size, half of them beside another hostile argument."""
    rng = np.random.default_rng([ord(letter) for letter in name])
    arguments = sorted(CALLS[name].given)
    for argument in arguments:
        numbers = (*(10.0 ** rng.uniform(-300, 300, 2) * (1, -1)), int(rng.integers(-(10**12), 10**12)))
        values = [*(VALUES[i] for i in rng.choice(len(VALUES), 8, replace=False)), *numbers]
        for i, value in enumerate(values):
            other = {str(rng.choice(arguments)): VALUES[rng.integers(len(VALUES))]} if i % 2 else {}
            is_answered(name, other | {argument: value})


def test_every_public_name_has_a_row():
    named = {name.split(".")[0].split(",")[0] for name in ENTRIES} | ANSWERS.keys() | PARTS
    laws = {"CALIBRATED", "CALIBRATED_BED", "PUBLISHED"}
    public = {name for name in mr.HOME if callable(getattr(mr, name))} - laws
    assert public - named == set(), "each takes a row of ENTRIES in tests/house/entries.py, or of ANSWERS"
    assert (ANSWERS.keys() | PARTS) - set(mr.__all__) == set()


@pytest.mark.parametrize("name", [*CALLS, "toml_schema"])
def test_a_row_works_and_prints_in_a_form_of_its_own(name):
    """Else the calls that replace an argument would be refused for another one."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answer = ENTRIES[name].call(**given_to(name))
    kinds = [getattr(mr, kind) for kind, made_by in ANSWERS.items() if made_by == name]
    assert all(isinstance(answer, kind) for kind in kinds)
    assert " object at 0x" not in repr(answer)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.Block(True, True), "half thickness b = True of type bool is not a real number"),
        (lambda: mr.Block.from_slenderness(-1, 2.0), "slenderness h/b = -1 is outside the valid range 1 to 200"),
        (lambda: mr.Case(WALL, 0.0, 1.0, side_stop="no"), "side_stop = 'no' of type str is neither True nor False"),
        (lambda: mr.simulate(CONTACTS, SHORT), "case and contacts are swapped: the case comes first"),
        (lambda: mr.simulate(SHORT, CONTACTS, start=0), "start = 0 of type int is not a pose and a velocity"),
        (
            lambda: mr.simulate(SHORT, CONTACTS, start=([[0, 0, math.nan]], [[0, 0, 0]])),
            "start, pose holds a value that is not finite",
        ),
        (
            lambda: mr.simulate(SHORT, CONTACTS, start=([[0, 0, 40]], [[0, 0, 0]])),
            "start, rotation = 40 rad is outside the valid range",
        ),
        (lambda: mr.simulate(SHORT, CONTACTS, 1e-3, output_step=-1), "output_step = -1 s is outside"),
        (
            lambda: mr.simulate(mr.Case(WALL, 0.05, 1e5), CONTACTS, 1e-5),
            r"the steps of this run would be 1e\+10; at most 5e\+07 fit into memory; take a longer timestep",
        ),
        (
            lambda: mr.solve_analytical(mr.Case(WALL, 0.05, 1e6), E),
            r"the samples of this answer would be 1e\+09; .* raise output_step",
        ),
        (lambda: mr.calibrate("x", "never.sqlite", points=2.5), "points = 2.5 is not a whole number"),
        (lambda: mr.CALIBRATED.reach(WALL, 5e8, math.nan), "amplitude theta_0/alpha = nan is outside"),
        (lambda: mr.CALIBRATED(WALL, E, 1e300), r"k_n = 1e\+300 N/m3 is outside the valid range"),
        (lambda: mr.Interface(5e8, 0.05, 0.6, -1.0, 30.0), "length = -1 m is outside the valid range"),
        (lambda: mr.Plan(losses=("a",)), "losses = 'a' of type str is not a real number"),
    ],
)
def test_it_says_what_is_wrong(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()


@pytest.mark.parametrize("value", ["nan", "inf", "-1.0", '"text"', "true"])
def test_a_law_with_coefficients_that_cannot_be(value, tmp_path):
    path = mr.CALIBRATED.save(tmp_path / "law.toml")
    text = re.sub(r"(?m)^floor = .*$", f"floor = {value}", path.read_text())
    path.write_text(text)
    with pytest.raises(ValueError, match=r"law.toml is not a damping law: base.floor = "):
        mr.DampingLaw.load(path)


def test_the_engine_leaves_no_log_behind(tmp_path, monkeypatch, caplog):
    monkeypatch.chdir(tmp_path)
    stiff = mr.Contacts.from_damping(WALL, k_base=1e13, xi_base=0.0)
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(mr.Case(WALL, 0.05, 1.0, side_stop=False), stiff, 1e-4))
    data = mujoco.MjData(model)
    data.qpos[0] = math.nan
    mujoco.mj_step(model, data)
    assert "QPOS" in caplog.text
    assert not list(tmp_path.iterdir())
