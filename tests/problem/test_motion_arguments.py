"""Arguments of ground motions that are not numbers, and sizes that do not fit into memory."""

import inspect

import numpy as np
import pytest
from offenders import not_refused

import mjrock as mr

NO_NUMBERS = [None, "1", "a", [1.0], (), {}, object(), 1j, True, np.True_, b"1", 10**400, -(10**400), float("nan")]
ROW = mr.GroundMotion([0.0, 1.0, 0.0], 0.1)
MADE = {
    "sine": (1.0, 1.0),
    "half_sine": (1.0, 1.0),
    "rectangular": (1.0, 1.0),
    "ricker": (1.0, 1.0),
    "synthetic": (1.0, 1.0),
}
SCALARS = [
    (made, name)
    for made in MADE
    for name in inspect.signature(getattr(mr.GroundMotion, made)).parameters
    if name != "antisymmetric"
]


def refused(function, name, values=NO_NUMBERS):
    """Values of an argument that a function does not refuse by its name."""
    complaint = rf"\b{name}( =| is a number too large for a float)"
    return not_refused((repr(value)[:12], lambda value=value: function(value), complaint) for value in values)


@pytest.mark.parametrize(("made", "name"), SCALARS)
def test_scalars_of_pulses_and_artificial_records(made, name):
    function = getattr(mr.GroundMotion, made)
    given = inspect.signature(function).bind(*MADE[made], **({"seed": 1} if made == "synthetic" else {})).arguments
    assert refused(lambda value: function(**(given | {name: value})), name) == []


def test_scalars_of_a_motion():
    assert refused(lambda value: mr.GroundMotion([0.0, 1.0], value), "time step dt") == []
    assert refused(ROW.resampled, "time step dt") == []
    assert refused(ROW.scaled, "factor") == []


NO_ROWS = [
    (None, TypeError, "accel = None does not hold real numbers alone; it takes one row of at"),
    ("0 1 2", TypeError, "accel = '0 1 2' of type str"),
    (["0", "1"], TypeError, r"accel = \['0', '1'\] of type list"),
    ([0, None], TypeError, r"accel = \[0, None\]"),
    ([True, False], TypeError, "accel = .* of type list"),
    ([1j, 2j], TypeError, "accel = .* of type list"),
    (np.array([1j, 2j]), TypeError, "accel = .* of type ndarray"),
    ([0, 10**400], TypeError, "accel = .*000... of type list"),
    ({0: 1.0, 1: 2.0}, TypeError, "accel = .* of type dict"),
    (ROW, TypeError, "accel = <GroundMotion"),
    (np.array(["2020-01-01"] * 2, "M8[D]"), TypeError, "accel = "),
    ([[0.0, 1.0], [2.0]], ValueError, "accel = .* has rows of different lengths; it takes one row"),
    (1.0, ValueError, r"accel has the shape \(\); one row of at least 2"),
    ([], ValueError, r"accel has the shape \(0,\); one row of at least 2"),
    (np.ma.masked_equal([0.0, 1.0, 9.0], 9.0), ValueError, "accel has masked values; it takes one row"),
    (np.broadcast_to(0.0, (10**12,)), ValueError, r"size of accel would be 1e\+12; .* give fewer values"),
]


def test_accelerations_that_are_none():
    for accel, error, complaint in NO_ROWS:
        with pytest.raises(error, match=complaint):
            mr.GroundMotion(accel, 0.01)


def test_accelerations_that_are_some():
    for accel in ([0, 1, 2], range(3), (0.0, 1.0, 2.0), np.arange(3, dtype=np.float32)):
        np.testing.assert_array_equal(mr.GroundMotion(accel, 0.01).accel, [0.0, 1.0, 2.0])


@pytest.mark.parametrize("function", [ROW, ROW.velocity], ids=["motion", "velocity"])
def test_times_that_are_none(function):
    values = [None, "1", ["1"], {}, object(), 1j, True, 10**400, float("nan"), [0.0, float("nan")]]
    complaint = "t .*it takes one or more times"
    assert not_refused((repr(each)[:12], lambda each=each: function(each), complaint) for each in values) == []


def test_flags_names_and_units_of_another_type(tmp_path):
    with pytest.raises(TypeError, match="antisymmetric = 'no' of type str is neither True nor False"):
        mr.GroundMotion.ricker(1.0, 1.0, "no")
    with pytest.raises(TypeError, match="name = 3 of type int is not a str"):
        mr.GroundMotion([0.0, 1.0], 0.01, 3)
    (tmp_path / "a.csv").write_text("0,0\n.01,1\n")
    with pytest.raises(ValueError, match=r"a\.csv: the header names no unit; give unit=, one of m/s2, cm/s2, mm/s2, g"):
        mr.GroundMotion.from_csv(tmp_path / "a.csv")
    with pytest.raises(ValueError, match=r"a\.csv: unit = 0 m/s2 is outside the valid range"):
        mr.GroundMotion.from_csv(tmp_path / "a.csv", 0)
    for unit in (True, ["g"], "G"):
        with pytest.raises(ValueError, match=r"a\.csv: unit = .* is not one of m/s2, cm/s2, mm/s2, g, ft/s2"):
            mr.GroundMotion.from_csv(tmp_path / "a.csv", unit)
        with pytest.raises(ValueError, match=r"a\.csv: time_unit = .* is not one of s, ms"):
            mr.GroundMotion.from_csv(tmp_path / "a.csv", "g", time_unit=unit)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (
            lambda: mr.GroundMotion(np.zeros(100_001), 1.0).resampled(1e-5),
            r"number of samples of 100000 s at dt = 1e-05 s would be 1e\+10; .*; make dt longer than 0.002 s",
        ),
        (
            lambda: mr.GroundMotion(np.zeros(100_001), 1.0).resampled(1e-9),
            "time step dt = 1e-09 s is outside the valid range 1e-05 to 1 s",
        ),
        (
            lambda: mr.GroundMotion.synthetic(1.0, 1000.0, seed=1, dt=1e-5),
            r"samples of 1000 s at dt = 1e-05 s would be 1e\+08; .*; choose a shorter duration or a longer dt",
        ),
        (
            lambda: mr.GroundMotion.sine(1.0, 100.0, 1000.0, 1_000_000),
            r"samples would be 1e\+09; .*; choose fewer cycles or fewer samples to a cycle",
        ),
    ],
)
def test_a_size_that_does_not_fit_is_said_before_it_is_made(monkeypatch, make, complaint):
    arange = np.arange

    def small(*args, **options):
        assert max(args) < 1e7
        return arange(*args, **options)

    monkeypatch.setattr(np, "arange", small)
    with pytest.raises(ValueError, match=complaint):
        make()
