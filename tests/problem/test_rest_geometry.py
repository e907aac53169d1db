"""What stands, as convex solids, joints and the whole faces that make them."""

import numpy as np
import pytest

import mjrock as mr
from tests.scenes import two_blocks

DOORS = [mr.Opening(1.2, 2.1), mr.Opening(0.9, 2.1), mr.Opening(1.0, 1.5, 4.0, at=1.5)]
SLENDER = mr.Block.from_size(0.5, 4.0, 2.0)
CONTACTS = mr.Contacts.from_law(SLENDER, mr.Restitution.from_geometry(SLENDER), 5e8, 4e8)
ROSE = mr.Opening(1.4, 1.4, 5.0, round=True)
WALLS = {
    "plain": (mr.Block.from_size(0.55, 9.0, 6.0), 1),
    "doors and a window": (mr.Block.from_size(0.55, 9.0, 6.0, openings=DOORS), 7),
    "tapered": (mr.Block.from_size(0.6, 6.0, 4.0, profile=[(0, 0.6), (3, 0.4), (3, 0.3), (6, 0.3)]), 2),
    "plumb outside": (
        mr.Block.from_size(0.6, 6.0, 4.0, profile=[(0, 0.6), (3, 0.4), (3, 0.3), (6, 0.3)], plumb="outer"),
        2,
    ),
    "gable": (mr.Block.from_size(0.55, 9.0, 6.0, gable=mr.Gable(2.0)), 2),
    "all": (
        mr.Block.from_size(0.6, 9.0, 6.0, openings=DOORS, profile=[(0, 0.6), (9, 0.4)], gable=mr.Gable(2.0, 1.0)),
        8,
    ),
}


def require_convex(part):
    """Unit normals point outwards, and every corner lies behind every face, on it to rounding."""
    heights = part.corners @ part.normals.T - part.offsets
    assert heights.max() < 1e-12
    np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1.0, rtol=1e-12)
    for face, height in zip(part.faces, heights.T, strict=True):
        np.testing.assert_allclose(height[list(face)], 0.0, atol=1e-12)
    # by the theorem of Gauss: volume from the faces and their normals alone
    assert part.bulk.volume > 0


@pytest.mark.parametrize(("wall", "count"), WALLS.values(), ids=WALLS)
def test_the_parts_of_a_wall_have_its_mass_centroid_and_inertia(wall, count):
    """Thickness and length are linear between the heights where parts end, so that equality is to rounding."""
    parts = mr.Case(wall, 0.01, 1.0).rest_geometry.solids[0].drawn
    assert len(parts) == count
    for part in parts:
        require_convex(part)
    volumes = np.array([part.bulk.volume for part in parts])
    assert wall.density * volumes.sum() == pytest.approx(wall.mass, rel=1e-12)
    centroid = volumes @ [part.bulk.centroid for part in parts] / volumes.sum()
    np.testing.assert_allclose(centroid[::2], [wall.centroid_offset, wall.centroid_height], atol=1e-12)
    arms = [part.bulk.centroid - centroid for part in parts]
    second = sum(
        part.bulk.second + volume * np.outer(arm, arm) for part, volume, arm in zip(parts, volumes, arms, strict=True)
    )
    assert wall.density * (second[0, 0] + second[2, 2]) == pytest.approx(wall.inertia, rel=1e-12)


def test_a_round_opening_has_straight_sides():
    """A regular polygon of 24 sides within the circle leaves out 1 - 12 sin(pi / 12) / pi of it, 1.1 %."""
    wall = mr.Block.from_size(0.55, 9.0, 6.0, openings=[ROSE])
    volume = sum(part.bulk.volume for part in mr.Case(wall, 0.01, 1.0).rest_geometry.solids[0].drawn)
    circle = 0.55 * np.pi * 0.7**2
    polygon = 0.55 * 0.7**2 * 12 * np.sin(np.pi / 12)
    assert volume == pytest.approx(wall.mass / wall.density + circle - polygon, rel=1e-9)


def test_openings_are_where_they_are_said_to_be():
    """Two doors without a place are at a quarter and three quarters of the length."""
    wall = WALLS["doors and a window"][0]
    assert wall.front.places == (-1.5, 1.5, 1.5)
    low = [part for part in mr.Case(wall, 0.01, 1.0).rest_geometry.solids[0].drawn if part.corners[:, 2].min() == 0]
    ends = sorted((float(part.corners[:, 1].min()), float(part.corners[:, 1].max())) for part in low)
    np.testing.assert_allclose(ends, [(-3, -2.1), (-0.9, 1.05), (1.95, 3)], rtol=1e-12)


def test_boxes_say_so_with_their_half_sizes():
    scene = mr.scene_of(mr.Case(SLENDER, 0.01, 1.0), CONTACTS)
    assert [solid.name for solid in scene.rest_geometry.solids] == ["wall", "base", "side"]
    middle, half = scene.rest_geometry.solids[0].parts[0].box
    np.testing.assert_allclose(middle, 0.0, atol=1e-12)
    np.testing.assert_allclose(half, [0.25, 1.0, 2.0], rtol=1e-12)
    middle, half = scene.rest_geometry.solids[2].parts[0].box
    assert middle[0] + half[0] == pytest.approx(-0.25)
    assert middle[2] - half[2] == 0
    assert mr.Case(WALLS["gable"][0], 0.01, 1.0).rest_geometry.solids[0].parts[1].box is None


def test_masonry_of_the_plane_stands_as_prisms():
    """A box of its length, and a keystone that is none; fixed blocks too."""
    masonry = mr.Masonry.arch(2.0, 0.4, voussoirs=5, length=0.7)
    solids = mr.scene_of(mr.MasonryCase(masonry, 1.0)).rest_geometry.solids
    assert [solid.name for solid in solids] == list(masonry.names)
    assert [solid.fixed for solid in solids] == [block.fixed for block in masonry.blocks]
    assert [solid.body for solid in solids if not solid.fixed] == list(range(5))
    for solid, block in zip(solids, masonry.blocks, strict=True):
        (part,) = solid.parts
        require_convex(part)
        assert part.bulk.volume == pytest.approx(0.7 * block.area, rel=1e-12)
        np.testing.assert_allclose(part.bulk.centroid, 0.0, atol=1e-12)
        assert (part.box is None) is not solid.fixed
        assert solid.inside[0].tolist() == [True, True] + [False] * 4
    stack = mr.Masonry.stack([mr.Block.from_size(0.5, 0.8, 0.6)], 1e9)
    (_, half) = mr.scene_of(mr.MasonryCase(stack, 1.0)).rest_geometry.solids[1].parts[0].box
    np.testing.assert_allclose(half, [0.25, 0.3, 0.4], rtol=1e-12)


def test_a_unit_of_several_parts_moves_about_its_centroid():
    """An L in space with a mass added to it. Where its parts lie on each other nothing meets them."""
    parts = [mr.Polyhedron.box((1, 1, 3), (0.5, 0, 1.5)), mr.Polyhedron.box((1, 1, 1), (1.5, 0, 0.5))]
    ground = mr.Polyhedron.box((6, 6, 1), (0, 0, -0.5), fixed=True)
    masonry = mr.Masonry([ground, mr.Compound(parts, name="L")], 1e9)
    added = mr.AddedMass(mass=4000.0, block="L", at=(0.5, 0.0, 2.5))
    scene = mr.scene_of(mr.MasonryCase(masonry, 1.0, effects=(added,)))
    solid = scene.rest_geometry.solids[1]
    np.testing.assert_allclose(solid.rest, scene.bodies.rest[0])
    assert solid.rest[2] > masonry.centroids[1][2]
    np.testing.assert_allclose(np.concatenate([p.corners for p in solid.drawn]) - solid.rest, solid.corners)
    assert [int(inside.sum()) for inside in solid.inside] == [0, 1]  # the foot's face lies within, the other's in part
    assert len(solid.faces) == 12
    assert all(part.box is not None for part in solid.parts)


@pytest.mark.parametrize("stop", [False, True, mr.SideStop(top=5.0)])
def test_the_faces_of_a_wall_are_whole_and_look_at_each_other(stop):
    case = mr.Case(WALLS["plain"][0], 0.01, 1.0, side_stop=stop)
    joints, faces, frames = case.rest_geometry.joints, case.rest_geometry.faces, case.rest_geometry.frames
    assert tuple(joint.name for joint in joints) == frames.names
    for joint, (below, above), axes in zip(joints, faces, frames.axes, strict=True):
        np.testing.assert_allclose(below.normal, axes[0], atol=1e-15)
        np.testing.assert_allclose(above.normal, -axes[0], atol=1e-15)
        spans = [np.sort(face.corners @ axes[1]) for face in (below, above)]
        common = min(span[1] for span in spans) - max(span[0] for span in spans)
        assert common == pytest.approx(joint.width)
        for face, number in ((below, joint.below), (above, joint.above)):  # a face of a part of the solid
            corners = np.concatenate([part.corners for part in case.rest_geometry.solids[number].drawn])
            for corner in face.corners:
                assert np.abs(corners[:, ::2] - corner).max(axis=1).min() < 1e-12
    assert joints[0].area == pytest.approx(0.55 * 6.0)


@pytest.mark.parametrize("in_space", [False, True])
def test_the_faces_of_a_joint_of_masonry_hold_it(in_space):
    """A joint covers a part of both of its faces."""
    masonry = mr.Masonry.dome(2.0, 0.3, 8, 3) if in_space else mr.Masonry.running_bond(1.0, 0.4, (0.3, 0.2))
    standing = mr.MasonryCase(masonry, 1.0, settled=False).rest_geometry
    for joint, faces in zip(standing.joints, standing.faces, strict=True):
        outline = joint.outline if in_space else np.array([joint.start, joint.end])
        for face, normal in zip(faces, (joint.normal, -joint.normal), strict=True):
            assert face.normal @ normal > 1 - 1e-3
            middle = face.corners.mean(axis=0)
            reach = ((face.corners - middle) @ face.edge_normals.T).max(axis=0)
            assert ((outline - middle) @ face.edge_normals.T <= reach + 1e-9).all()


def test_springs_of_joints():
    masonry = mr.Masonry.stack([mr.Block.from_size(0.5, 0.8, 0.6)], 1e9, friction=0.5, k_s=4e8)
    springs = mr.scene_of(mr.MasonryCase(masonry, 1.0)).springs
    assert (springs.k_n, springs.k_s, springs.friction, springs.residual) == (1e9, 4e8, 0.5, 0.5)


def test_what_is_not_asked_for_is_not_made():
    scene = mr.scene_of(mr.MasonryCase(mr.Masonry.running_bond(1.0, 0.4, (0.3, 0.2)), 1.0))
    assert "solids" not in vars(scene.made_of)
    assert scene.rest_geometry.solids is scene.rest_geometry.solids


def test_a_scene_that_is_written_by_hand_has_no_solids():
    with pytest.raises(ValueError, match="written by hand and has no solids"):
        _ = two_blocks().rest_geometry
