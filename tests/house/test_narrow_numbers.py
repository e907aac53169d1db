"""Numbers of few bits, fractions and decimals: the answer of the float of the same value, or a refusal by name.

NumPy computes with its small numbers in their own bits: np.uint8(100) * 4 is 144. The arguments of each public entry
are given as such numbers, all of one kind at once, and what comes back has to be bitwise what the floats give.
"""

import dataclasses
import re
import warnings
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from entries import ENTRIES, given_to, words_for
from offenders import not_refused

import mjrock as mr
from mjrock.quantities import shown

NARROW = (np.int8, np.uint8, np.int16, np.float16, np.float32, Fraction, Decimal)
HUGE, TRUTHS = (Fraction(10**500, 3), -Fraction(10**500, 3), 10**500), (True, np.True_)
ROWS = [name for name, row in ENTRIES.items() if row.numbers and not row.paths]


def as_narrow(value, kind):
    """The value as a number of a kind, or None where that kind does not hold it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            made = kind(value)
        except OverflowError:
            return None
    return made if float(made) == value else None


def pieces(answer):
    """Everything in an answer but what depends on the clock: bytes, types and values."""
    if isinstance(answer, np.ndarray):
        return answer.dtype.str, answer.shape, answer.tobytes()
    if isinstance(answer, mr.Response | mr.MasonryResponse):
        stats = {name: value for name, value in answer.stats.items() if "time" not in name or name == "timestep"}
        return pieces([answer.case, answer.t, answer.pose, answer.energy, stats])
    if dataclasses.is_dataclass(answer):
        parts = [getattr(answer, one.name) for one in dataclasses.fields(answer)]
        seen = [getattr(answer, name) for name in ("mass", "inertia", "stiffness", "lines") if hasattr(answer, name)]
        return type(answer).__name__, [pieces(one) for one in parts + seen]
    if isinstance(answer, dict):
        return {name: pieces(value) for name, value in answer.items()}
    if isinstance(answer, tuple | list):
        return [pieces(one) for one in answer]
    if isinstance(answer, float):
        return "float", answer.hex()
    return type(answer).__name__, answer


def called(name, numbers):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ENTRIES[name].call(**given_to(name) | numbers)


def refused(name, argument, values):
    """The calls of an entry that are to be refused by the name of an argument, see `not_refused`."""
    complaint = "|".join(map(re.escape, words_for(argument)))
    for value in values:
        yield f"{argument} = {shown(value)}", lambda value=value: called(name, {argument: value}), complaint


@pytest.mark.parametrize("name", ROWS)
def test_a_narrow_number_counts_as_the_float_of_its_value(name):
    floats, offenders = {key: float(value) for key, value in ENTRIES[name].numbers.items()}, []
    answer = pieces(called(name, floats))
    narrow = {kind: {key: as_narrow(value, kind) for key, value in floats.items()} for kind in NARROW}
    for argument in floats:
        assert sum(values[argument] is not None for values in narrow.values()) >= 3, argument
    decimals = narrow.pop(Decimal)
    offenders += not_refused(one for each in decimals for one in refused(name, each, [decimals[each]]))
    with np.errstate(over="raise", invalid="raise"):
        for kind, values in narrow.items():
            held = {argument: value for argument, value in values.items() if value is not None}
            same = pieces(called(name, floats | held)) == answer
            offenders += [] if same else [f"{', '.join(held)} as {kind.__name__} give another answer"]
    assert offenders == []


@pytest.mark.parametrize("name", ROWS)
def test_what_no_float_holds_is_refused_by_name(name):
    calls = (refused(name, argument, HUGE + TRUTHS) for argument in ENTRIES[name].numbers)
    assert not_refused(one for each in calls for one in each) == []


def test_the_small_numbers_of_numpy_made_a_wall_lighter():
    assert mr.Block(np.uint8(1), np.uint8(100)).mass == 800_000.0
    assert mr.Block.from_size(np.float16(0.5), np.float16(4), density=np.float16(2000)).inertia == pytest.approx(
        mr.Block.from_size(0.5, 4.0).inertia, rel=1e-15
    )
    with pytest.raises(ValueError, match="height of the tie is a number too large"):
        mr.Tie(Fraction(10**500, 3), 1e5)
