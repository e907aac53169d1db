"""Where the forces of joints act and along which axes, for walls and masonry."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.bodies import BodyMotion
from mjrock.result.ties import link_vector


@pytest.fixture(scope="module")
def rocking():
    wall = mr.Block.from_size(thickness=0.5, height=4.0, length=2.0, density=1800.0)
    contacts = mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), k_base=5e8, k_side=5e8, side_friction=0.3)
    return mr.simulate(mr.Case(wall, 0.4 * wall.alpha, 3.0, side_stop=True), contacts, forces=True)


@pytest.mark.filterwarnings("ignore:CALIBRATED was fitted for a base that holds")
def test_forces_of_a_wall_are_its_reactions_along_the_axes_of_base_and_side(rocking):
    """The base presses upwards and rubs along x, the side presses along x and rubs downwards where its shear is."""
    normal, shear, reactions = rocking.forces.normal, rocking.forces.shear, rocking.reactions
    np.testing.assert_allclose(reactions["base"], np.column_stack([shear[:, 0], normal[:, 0]]), atol=1e-6)
    np.testing.assert_allclose(reactions["side"], np.column_stack([normal[:, 1], -shear[:, 1]]), atol=1e-6)
    assert np.abs(shear).max(axis=0).min() > 100.0


@pytest.mark.filterwarnings("ignore:CALIBRATED was fitted for a base that holds")
def test_forces_of_a_wall_pass_through_its_faces(rocking):
    """Rocking over its outer edge the wall stands on it, and it meets the stop between its ends."""
    wall, off = rocking.case.wall, rocking.forces.eccentricity
    over = rocking.theta > 0.1 * wall.alpha
    np.testing.assert_allclose(off[over, 0], wall.b, rtol=1e-3)
    assert np.nanmax(np.abs(off[:, 0])) <= 1.001 * wall.b
    assert np.nanmax(np.abs(off[:, 1])) <= 1.001 * wall.h


def test_the_joint_on_the_lowest_free_block_moves_and_turns_with_it():
    block = mr.Block.from_size(thickness=0.5, height=0.8, length=1.0, density=2000.0)
    case = mr.MasonryCase(mr.Masonry.stack([block, block], 1e9), 1.0)
    x, z, turn = 0.1, 0.2, 0.3
    middle, axes = BodyMotion(case, np.zeros(1), np.array([[(x, z, turn), (0.0, 0.0, 0.0)]])).joints(
        case.rest_geometry.frames
    )
    np.testing.assert_allclose(middle[0, 0], (0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(middle[0, 1], (x + 0.4 * np.sin(turn), 0.4 + z + 0.4 * np.cos(turn)), atol=1e-12)
    np.testing.assert_allclose(axes[0, 1, 0], (np.sin(turn), np.cos(turn)), atol=1e-12)
    np.testing.assert_allclose(axes[0, 0, 0], (0.0, 1.0), atol=1e-12)


def test_the_joint_on_a_support_moves_with_it():
    block = mr.Block.from_size(thickness=0.5, height=0.8, length=1.0, density=2000.0)
    masonry = mr.Masonry.stack([block], 1e9)
    ground = next(name for name, one in zip(masonry.names, masonry.blocks, strict=True) if one.fixed)
    case = mr.MasonryCase(masonry, 1.0, supports={ground: ([0.0, 1.0], [0.0, 0.2], [0.0, -0.1])})
    middle, axes = BodyMotion(case, np.array([0.5]), np.zeros((1, 1, 3))).joints(case.rest_geometry.frames)
    np.testing.assert_allclose(middle[0, 0], (0.1, -0.05), atol=1e-12)
    np.testing.assert_allclose(axes[0, 0, 0], (0.0, 1.0), atol=1e-12)


def test_a_tie_of_a_wall_holds_its_inner_face():
    """Turned about its outer toe, at half the thickness outwards."""
    wall = mr.Block.from_size(thickness=0.5, height=4.0, length=2.0, density=1800.0)
    case, turn = mr.Case(wall, 0.0, 1.0, motion=mr.GroundMotion.rectangular(1.0, 0.5), effects=mr.Tie(3.0, 1e6)), 0.1
    way = link_vector(BodyMotion(case, np.zeros(1), wall.pose(np.array([turn]))[None]), case.links["tie_0"])[0]
    sine, cosine = np.sin(turn), np.cos(turn)
    outwards = case.links["tie_0"].length + 0.25 - 0.5 * cosine + 3.0 * sine + 0.25
    np.testing.assert_allclose(way, (outwards, 0.5 * sine + 3.0 * cosine - 3.0), atol=1e-12)
