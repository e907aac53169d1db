import math

import numpy as np
import pytest

import mjrock as mr


def test_the_figure_3_wall(wall):
    assert wall.alpha == pytest.approx(math.atan(0.3 / 2.1), abs=1e-15)
    assert wall.slenderness == pytest.approx(7)
    assert wall.mass == pytest.approx(5040)
    assert pytest.approx(math.sqrt(3 * mr.GRAVITY / (4 * wall.R))) == wall.p
    assert wall.toe_inertia == pytest.approx(4 / 3 * wall.mass * wall.R**2)


def test_sizes_are_full_and_halves_are_half():
    assert mr.Block.from_size(0.6, 4.2, 2.0, 1800.0) == mr.Block(b=0.3, h=2.1, length=2.0, density=1800.0)


def test_potential_energy_has_its_top_at_alpha_and_its_foot_at_rest(wall):
    theta = np.linspace(-wall.alpha, wall.alpha, 201)
    energy = wall.potential_energy(theta)
    assert energy[100] == 0
    assert np.argmax(energy) in (0, 200)
    np.testing.assert_allclose(energy, energy[::-1], rtol=1e-12)
    # its slope is the rigid moment-rotation curve M = m g R sin(alpha - theta)
    slope = np.gradient(energy[101:], theta[101:])[1:-1]
    np.testing.assert_allclose(slope, wall.weight * wall.R * np.sin(wall.alpha - theta[102:-1]), rtol=1e-3)


@pytest.mark.parametrize("share", [0.0, 1e-6, 0.3, 1.0])
def test_rotation_at_inverts_potential_energy(wall, share):
    assert wall.rotation_at(float(wall.potential_energy(share * wall.alpha))) == pytest.approx(
        share * wall.alpha, abs=1e-8
    )


@pytest.mark.parametrize(
    ("sizes", "complaint"),
    [
        (
            {"thickness": 600, "height": 4200},
            r"thickness = 600 m is outside the valid range 0.002 to 20 m",
        ),  # millimetres
        ({"thickness": 0.6, "height": 4200}, r"height = 4200 m"),
        ({"thickness": -0.6, "height": 4.2}, r"thickness = -0.6 m"),
        ({"thickness": math.nan, "height": 4.2}, r"thickness = nan m"),
        ({"thickness": 0.6, "height": 4.2, "density": 2.0}, r"density = 2 kg/m3"),  # tonnes
        ({"thickness": 4.2, "height": 0.6}, r"height = 0.6 m is less than thickness = 4.2 m: are they swapped"),
        ({"thickness": 0.6, "height": 4.2, "length": 0}, r"length = 0 m"),
    ],
)
def test_bad_sizes_are_named_with_the_valid_range(sizes, complaint):
    with pytest.raises(ValueError, match=complaint):
        mr.Block.from_size(**sizes)


def test_an_energy_beyond_overturning_has_no_rotation(wall):
    with pytest.raises(ValueError, match="overturning"):
        wall.rotation_at(2 * float(wall.potential_energy(wall.alpha)))


def test_the_wall_of_a_slenderness():
    wall = mr.Block.from_slenderness(7.0, 2.1, length=3.0, density=1800.0)
    assert (wall.slenderness, wall.R) == (pytest.approx(7.0), pytest.approx(2.1))
    assert (wall.length, wall.density) == (3.0, 1800.0)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda wall: wall.rotation_at("1"), "energy = '1' of type str is not a real number"),
        (lambda wall: wall.rotation_at(True), "energy = True of type bool is not a real number"),
        (lambda wall: wall.rotation_at(float("nan")), "energy = nan J is outside"),
        (lambda wall: wall.pose(0.1), r"theta has the shape \(\)"),
        (lambda wall: wall.pose([0.1, True]), "theta = .* does not hold real numbers alone"),
        (lambda wall: wall.pose([float("nan")]), "theta holds a value that is not finite"),
    ],
)
def test_rotations_and_energies_are_numbers(wall, call, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        call(wall)
