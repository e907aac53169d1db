"""Baselines and bands: what is taken off a record, what is left of it, and where it ends."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import mjrock as mr

DT = 0.01
T = DT * np.arange(2001)
MADE = mr.GroundMotion.synthetic(3.0, 20.0, seed=1)


@pytest.mark.parametrize(("baseline", "degree"), [("constant", 0), ("linear", 1), ("quadratic", 2)])
def test_a_baseline_of_its_degree_leaves_nothing(baseline, degree):
    """A polynomial of that degree is taken off whole, whatever it is added to."""
    drift = sum((0.03 / (k + 1)) * (T / 20.0) ** k for k in range(degree + 1))
    np.testing.assert_allclose(mr.GroundMotion(drift, DT).corrected(baseline).accel, 0.0, atol=1e-12)
    with_it, without = (mr.GroundMotion(MADE.accel + x, DT).corrected(baseline) for x in (drift, 0.0))
    np.testing.assert_allclose(with_it.accel, without.accel, atol=1e-11)


def test_a_record_that_drifts_ends_near_rest():
    """The velocity that is left has no mean product with time, since the fit of a line through it is zero."""
    drifts = mr.GroundMotion(MADE.accel + 0.03, DT, "x")
    fixed = drifts.corrected("linear")
    assert drifts.residual_velocity == pytest.approx(0.6, rel=1e-3)
    assert abs(fixed.residual_velocity) < 0.05 * fixed.peak_velocity
    assert abs(fixed.residual_displacement) < 0.01 * drifts.residual_displacement
    assert abs(fixed.velocities @ T) < 1e-9 * (np.abs(fixed.velocities) @ T)
    assert (fixed.name, fixed.dt, len(fixed.accel)) == ("x, without linear baseline", DT, len(MADE.accel))
    assert fixed.displacements[-1] == fixed.residual_displacement


@pytest.mark.parametrize(
    ("band", "frequency", "gain"),
    [
        ((0.5, 5.0), 1.58, 1.0), ((0.5, 5.0), 0.5, 0.5), ((0.5, 5.0), 5.0, 0.5), ((None, 5.0), 0.2, 1.0),
        ((0.5, None), 20.0, 1.0), ((0.5, None), 0.1, 0.0), ((None, 5.0), 40.0, 0.0),
    ],
)  # fmt: skip
def test_a_band_keeps_phases_and_half_of_its_corners(band, frequency, gain):
    """A Butterworth filter has 1 / sqrt(2) at its corner in one pass, and a half in two; those of a band differ by less
    than a thousandth from it where its corners are a decade apart. Ends have transients, which the middle has not."""
    wave = np.sin(2 * np.pi * frequency * T)
    kept = mr.GroundMotion(wave, DT).corrected(band=band)
    assert np.abs(kept.accel - gain * wave)[800:1200].max() < 0.005
    assert len(kept.accel) == len(wave)


def test_both_end_nearer_to_rest_than_the_band_alone():
    drifts = mr.GroundMotion(MADE.accel + 0.02, DT, "x")
    alone, both = drifts.corrected(band=(0.1, 25.0)), drifts.corrected("linear", (0.1, 25.0))
    assert abs(both.residual_displacement) < 0.2 * abs(alone.residual_displacement)
    assert both.name == "x, without linear baseline, above 0.1 Hz, below 25 Hz"


@pytest.mark.parametrize(
    ("options", "error", "complaint"),
    [
        ({}, ValueError, "corrected takes a baseline, a band, or both"),
        ({"baseline": "cubic"}, ValueError, "baseline = 'cubic' is not one of constant, linear, quadratic"),
        ({"baseline": 1}, ValueError, "baseline = 1 is not one of"),
        ({"band": 5.0}, TypeError, "band = 5.0 of type float is not a pair of corners"),
        ({"band": "ab"}, TypeError, "band = 'ab' of type str is not a pair of corners"),
        ({"band": (None, None)}, TypeError, "is not a pair of corners"),
        ({"band": (5.0, 0.5)}, ValueError, "upper corner of band = 0.5 Hz is outside the valid range 5.05 to 49 Hz"),
        ({"band": (0.1, 60.0)}, ValueError, "upper corner of band = 60 Hz is outside the valid range"),
        ({"band": (0.0, None)}, ValueError, "lower corner of band = 0 Hz is outside the valid range 0.001 to 49 Hz"),
    ],
)
def test_what_is_no_correction(options, error, complaint):
    with pytest.raises(error, match=complaint):
        MADE.corrected(**options)


def test_a_file_that_drifts_names_the_correction(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("\n".join(f"{x:.5f}" for x in MADE.accel + 0.05))
    with pytest.warns(UserWarning, match=r"it needs a baseline correction, motion\.corrected\(baseline='linear'\)"):
        mr.GroundMotion.from_csv(path, "m/s2", dt=DT)


def test_the_picture_of_a_record_says_where_it_ends():
    figure = mr.plotting.record([MADE, MADE.scaled(2.0)])
    assert isinstance(figure, Figure)
    accel, velocity, displacement = figure.axes
    np.testing.assert_array_equal(accel.lines[1].get_ydata(), 2 * MADE.accel)
    for ax, expected in ((velocity, MADE.velocities), (displacement, MADE.displacements)):
        t, drawn = ax.lines[0].get_data()
        np.testing.assert_allclose(drawn[np.searchsorted(t, MADE.times)], expected, atol=1e-12)
    (text, _) = displacement.get_legend().get_texts()
    assert text.get_text().startswith(f"end {MADE.residual_displacement:.2g}, peak ")
    assert len(mr.plotting.record(MADE).axes[0].get_legend().get_texts()) == 1
    with pytest.raises(TypeError, match="motions"):
        mr.plotting.record([3])
