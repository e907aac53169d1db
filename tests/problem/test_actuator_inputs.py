"""What an actuator takes, at the bounds of its numbers, and what it says of itself."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.actuator import Guide

HISTORY = ([0.0, 1.0, 2.0], [0.0, -0.05, 0.02])


def actuator(**changed):
    given = {"block": "beam", "at": (-0.4, 2.5), "direction": 1, "displacement": HISTORY, "stiffness": 2e7} | changed
    return mr.Actuator(**given)


def test_an_actuator_has_no_dashpot_and_no_guide_unless_it_is_asked_for():
    one = actuator()
    assert (one.damping, one.guide, one.height) == (0.0, Guide(), 2.5)
    assert actuator(guided="upright").guide == Guide(rising=False, turning=True)
    assert actuator(guided="translation").guide == Guide(rising=True, turning=True)
    for wrong in ("sideways", 1, True):
        with pytest.raises(ValueError, match=r"guided of the actuator = .* is not known"):
            actuator(guided=wrong)


def test_a_point_and_a_direction_have_two_or_three_numbers():
    one = actuator(at=(-0.4, 0.1, 2.5), direction=(3.0, 0.0, -4.0))
    assert (one.at, one.height) == ((-0.4, 0.1, 2.5), 2.5)
    np.testing.assert_allclose(one.direction, [0.6, 0.0, -0.8])
    np.testing.assert_allclose(actuator(direction=(3e-9, -4e-9)).direction, [0.6, -0.8])
    for shape in ((0.4,), (0.4, 0.1, 2.5, 1.0)):
        with pytest.raises((TypeError, ValueError), match="at of the actuator"):
            actuator(at=shape)
    with pytest.raises((TypeError, ValueError), match="direction of the actuator"):
        actuator(direction=(1.0, 0.0, 0.0))


@pytest.mark.parametrize("way", [1, -1, 1.0])
def test_one_is_along_x(way):
    np.testing.assert_array_equal(actuator(direction=way).direction, [way, 0.0])
    np.testing.assert_array_equal(actuator(at=(0.0, 0.0, 1.0), direction=way).direction, [way, 0.0, 0.0])


@pytest.mark.parametrize("direction", [(0.0, 0.0), (0.6e-9, 0.8e-9), (1e-9, 0.0), (1.7e308, 1.7e308), 2, 0.5])
def test_a_direction_without_length_is_refused(direction):
    with pytest.raises((TypeError, ValueError), match="direction of the actuator"):
        actuator(direction=direction)


def test_short_and_long_directions_are_taken():
    for size in (1.5e-9, 1e200):
        np.testing.assert_allclose(actuator(direction=(0.6 * size, 0.8 * size)).direction, [0.6, 0.8])


def test_the_actuator_of_a_push_rests():
    assert actuator(displacement=None).displacement == ((0.0,), (0.0,))


@pytest.mark.parametrize(
    ("name", "taken", "refused"),
    [
        ("stiffness", (1.0, 1e12), (0.99, 1.01e12)),
        ("damping", (0.0, 0.5, 1e12), (-1e-9, 1.01e12)),
        ("block", (0, 3, "beam"), (-1, 1.5)),
    ],
)
def test_numbers_at_their_bounds(name, taken, refused):
    for value in taken:
        assert getattr(actuator(**{name: value}), name) == value
    for value in refused:
        with pytest.raises((TypeError, ValueError), match=f"{name} of the actuator"):
            actuator(**{name: value})


def test_a_displacement_in_millimetres_is_refused():
    assert actuator(displacement=([0.0, 1.0], [0.0, 10.0])).displacement[1][1] == 10.0
    with pytest.raises(ValueError, match=r"displacement of the actuator, values = 10\.1 .*-10 to 10 m"):
        actuator(displacement=([0.0, 1.0], [0.0, 10.1]))


def test_it_says_its_height_its_farthest_displacement_and_its_stiffness():
    assert actuator().description == "z = 2.5 m,\nto -50 mm, k = 20 kN/mm"


def test_an_actuator_of_all_blocks_has_no_point_and_no_guide():
    whole = {"block": None, "at": None, "direction": (-2.0, 0.0)}
    one = actuator(**whole)
    assert (one.block, one.at, one.direction) == (None, None, (-1.0, 0.0))
    assert np.isnan(one.height)
    assert one.description == "all blocks,\nto -50 mm, k = 20 kN/mm"
    assert actuator(block=None, at=None).direction == (1.0, 0.0)
    assert actuator(**whole | {"direction": (0.0, 3.0, 0.0)}).direction == (0.0, 1.0, 0.0)
    for changed in ({"at": (0.0, 1.0)}, {"guided": "upright"}):
        with pytest.raises(ValueError, match="needs a block; block = None drives all blocks"):
            actuator(**whole | changed)
    with pytest.raises((TypeError, ValueError), match="at of the actuator"):
        actuator(at=None)
