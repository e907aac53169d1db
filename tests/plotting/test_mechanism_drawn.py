"""Pictures of limit analysis: where blocks have moved to, and where joints press."""

import numpy as np
import pytest
from masonry_blocks import box
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, Polygon

import mjrock as mr
from mjrock import plotting
from mjrock.geometry.convex import area
from mjrock.plotting.solids import Rendering

BLOCK = mr.Masonry.stack([mr.Block.from_size(0.4, 1.6)], k_n=1e9, friction=0.9)


def test_a_block_that_turns_and_the_force_at_its_toe():
    collapse = mr.collapse_multiplier(BLOCK)
    ax = plotting.mechanism(Figure().subplots(), collapse)
    corners = ax.collections[0].get_paths()[0].vertices
    rest = BLOCK.blocks[1].corners
    assert np.hypot(*(corners[:4].mean(axis=0) - rest.mean(axis=0))) == pytest.approx(0.1 * 1.6, rel=1e-6)
    assert corners[:4, 0].mean() > rest[:, 0].mean()  # along the force
    (line,) = ax.get_lines()
    middle, way = np.mean(line.get_xydata(), axis=0), np.diff(line.get_xydata(), axis=0)[0]
    assert middle == pytest.approx([0.2, 0.0], abs=1e-6)
    assert abs(way[0] / way[1]) == pytest.approx(collapse.multiplier)
    assert way[0] * way[1] < 0  # it leans against the push
    assert not plotting.mechanism(Figure().subplots(), collapse, forces=False).get_lines()


def test_the_thrust_of_an_arch_passes_through_the_blocks_that_have_moved():
    """Lines moved back with the block below their joint pass through the joint at rest, where its force acts."""
    arch = mr.Masonry.arch(radius=5.0, thickness=0.9, voussoirs=9)
    collapse = mr.collapse_multiplier(arch)
    ax = plotting.mechanism(Figure().subplots(), collapse)
    points = np.concatenate([block.corners for block in arch.blocks if not block.fixed])
    pose = 0.1 * np.ptp(points, axis=0).max() / np.linalg.norm(collapse.motion[:, :2], axis=1).max() * collapse.motion
    lines = [line.get_xydata().mean(axis=0) for line in ax.get_lines()]
    assert len(lines) == len(arch.joints)
    for joint, line, off in zip(arch.plane_joints, lines, collapse.forces.eccentricity, strict=True):
        expected = joint.middle + off * joint.along
        if not arch.blocks[joint.below].fixed:
            row = arch.free.index(joint.below)
            (x, z), theta = expected - arch.centroids[joint.below], pose[row, 2]
            turned = np.array([x * np.cos(theta) + z * np.sin(theta), z * np.cos(theta) - x * np.sin(theta)])
            expected = arch.centroids[joint.below] + pose[row, :2] + turned
        assert line == pytest.approx(expected, abs=1e-9)


def test_masonry_in_space_moves_along_the_force():
    box = mr.Masonry.box((0.4, 0.4, 0.2), friction=0.3)
    collapse = mr.collapse_multiplier(box, associated=False)
    ax = plotting.mechanism(Figure().add_subplot(projection="3d"), collapse, share=0.5)
    assert any(isinstance(child, Rendering) for child in ax.get_children())


def test_what_has_no_mechanism_has_no_picture():
    collapse = mr.collapse_multiplier(mr.Masonry.stack([mr.Block.from_size(0.5, 1.0)], k_n=1e9, side_stop=True), -1)
    with pytest.raises(ValueError, match="multiplier = inf: nothing gives way"):
        plotting.mechanism(Figure().subplots(), collapse)
    with pytest.raises(ValueError, match="share = 2 is outside"):
        plotting.mechanism(Figure().subplots(), mr.collapse_multiplier(BLOCK), share=2.0)


@pytest.mark.parametrize(
    ("pose", "message"),
    [
        ([[0.1, 0.0, 0.0], [0.1, 0.0, 0.1]], "fixed blocks that have moved"),
        ([[0.1, 0.0]], r"shape \(1, 2\); \(1, 3\)"),
    ],
)
def test_a_pose_of_all_blocks_is_drawn_and_of_moved_supports_is_not(pose, message):
    masonry = mr.Masonry.stack([mr.Block.from_size(0.6, 2.0)])
    drawn = [Figure().add_subplot() for _ in range(2)]
    for ax, given in zip(drawn, ([[0.1, 0.0, 0.1]], [[0.0, 0.0, 0.0], [0.1, 0.0, 0.1]]), strict=True):
        plotting.blocks(ax, masonry, given)
    shapes = [[path.vertices.tolist() for part in ax.collections for path in part.get_paths()] for ax in drawn]
    assert shapes[0] == shapes[1]
    with pytest.raises(ValueError, match=message):
        plotting.blocks(drawn[0], masonry, pose)


def test_fill_and_axle_are_drawn_where_they_are_at_rest():
    """The fill is as large as the earth above the blocks, and the arrow of the axle ends on the ground."""
    flat = [box(-1, 2, -1, 0, fixed=True, name="ground"), box(0, 3, 0, 0.5, name="slab")]
    masonry, fill = mr.Masonry(flat, friction=0.7), mr.Fill(1.0, 1800.0)
    axle = fill.under(masonry, 30e3, at=2.5, width=0.2)
    ax = plotting.mechanism(mr.collapse_multiplier(masonry, None, loads=axle, effects=fill.on(masonry)))
    shapes = [patch.get_xy() for patch in ax.patches if isinstance(patch, Polygon)][1:]  # the first is the ground
    areas = [area(corners[:-1]) for corners in shapes]
    assert areas == pytest.approx([3 * 0.5, 0.5 * (0.2 + 0.7) * 0.5])  # 0.2 m on the ground, 0.7 m on the slab
    (arrow,) = (patch for patch in ax.patches if isinstance(patch, FancyArrowPatch))
    tail, tip = arrow._posA_posB  # matplotlib has no other way to read the ends
    assert tip == pytest.approx((2.5, 1.0))
    assert tail[0] == 2.5
    assert tail[1] > 1.0
    assert [text.get_text() for text in ax.texts] == ["30 kN"]
    assert ax.get_ylim()[1] > tail[1]


def test_forces_on_a_block_are_drawn_on_their_line_of_action():
    """2 kN to the left whose moment about the centroid at 1 m is that of a force at 1.5 m, as `Thrust` has it."""
    flat = [box(-5, 5, -1, 0, fixed=True, name="ground"), box(0, 0.6, 0, 2.0, name="wall")]
    masonry, ends = mr.Masonry(flat, friction=5.0), []
    for loads in ({"wall": (-2e3, 0.0, -1e3)}, mr.Thrust(1.5, -2e3, block="wall")):
        ax = plotting.mechanism(mr.collapse_multiplier(masonry, None, loads=loads))
        (arrow,) = (patch for patch in ax.patches if isinstance(patch, FancyArrowPatch))
        ends.append(np.array(arrow._posA_posB))
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-12)
    assert ends[0][0] == pytest.approx((0.3, 1.5))
    assert ends[0][1, 0] < 0.3
