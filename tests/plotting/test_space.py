"""Pictures of blocks in space: where blocks are drawn, which hide which, and what is refused."""

import math
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.geometry.poses import rotations
from mjrock.plotting import animation
from mjrock.plotting.perspective import Faces
from mjrock.plotting.solids import Solids
from mjrock.result.bodies import Moving

GROUND = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True, name="ground")
PAIR = (mr.Polyhedron.box((1, 1, 1), (0.5, 0, 0.5), name="front"), mr.Polyhedron.box((1, 1, 1), (-0.5, 0, 0.5)))
MASONRY = mr.Masonry((GROUND, *PAIR), xi=0)
REST = np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (2, 1))


def axes():
    return Figure().add_subplot(projection="3d")


def posed(masonry, pose, magnify=1.0, camera=None):
    """Masonry at a pose, as a picture has it."""
    return Solids(Moving(mr.MasonryCase(masonry, 1.0), np.zeros(1), pose[None], magnify), camera)


def faces_of(ax):
    (faces,) = (child for child in ax.collections if isinstance(child, Faces))
    return faces


def moved(angle=math.pi / 2, place=(0.0, 0.0, 0.0)):
    """The front block turned about the vertical and displaced."""
    pose = REST.copy()
    pose[0] = [*place, math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle)]
    return pose


def test_blocks_are_drawn_where_a_pose_has_brought_them():
    """A quarter turn about x brings the corner (1/2, 1/2, 1/2) of the front block to (1/2, -1/2, 1/2)."""
    pose = REST.copy()
    pose[0] = [3.0, 1.0, 0.5, math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0]
    solids = posed(MASONRY, pose, 2.0)
    at_rest, moving = np.array([1.0, 0.5, 1.0]), solids.moving
    drawn = moving.placed(1, at_rest[None])[0, 0]
    np.testing.assert_allclose(
        drawn,
        at_rest + 2 * np.array([3.0, 1.0, 0.5]) + 2 * np.array([0, -1.0, 0]),
        atol=1e-12,
    )
    corners = solids.corners(0)[solids.facets.body == 0].reshape(-1, 3)
    assert np.abs(corners - drawn).sum(axis=1).min() < 1e-12
    np.testing.assert_array_equal(moving.placed(None, at_rest[None])[0, 0], at_rest)


def test_a_picture_has_the_faces_that_are_seen_and_the_same_scale_along_every_axis():
    ax = axes()
    assert plotting.blocks(ax, MASONRY) is ax
    assert len(faces_of(ax).corners) == 6  # three of each box
    assert not ax.axison
    limits = [getattr(ax, f"get_{name}lim")() for name in "xyz"]
    aspect = ax._box_aspect / np.ptp(limits, axis=1)
    assert aspect.max() == pytest.approx(aspect.min())
    colours = faces_of(ax).get_facecolor()
    assert len(np.unique(colours.round(6), axis=0)) == 6  # lit by their direction, and tinted by their block


@pytest.mark.parametrize(("azimuth", "last"), [(35.0, 0), (-145.0, 1)])
def test_the_nearer_of_two_blocks_hides_the_other(azimuth, last):
    assert posed(MASONRY, REST, camera=(20.0, azimuth)).order(0)[-1] == last


def test_a_low_block_before_a_high_one_is_drawn_later_though_its_centroid_is_farther():
    high = mr.Polyhedron.box((1, 1, 9), (-0.5, 0, 4.5))
    low = mr.Polyhedron.box((1, 1, 1), (0.5, 0, 0.5))
    solids = posed(mr.Masonry((GROUND, low, high), xi=0), REST, camera=(60.0, 0.0))
    depth = solids.case.centroids[solids.shown] @ solids.eye
    assert depth[0] < depth[1]
    assert solids.order(0).tolist() == [1, 0]


def test_a_block_within_a_frame_hides_its_far_leg_and_is_hidden_by_the_near_one():
    """Parts are drawn one by one: no order of whole bodies is right."""
    legs = [mr.Polyhedron.box((1, 1, 1), (x, 0, 0.5)) for x in (-1.0, 1.0)]
    frame = mr.Compound([*legs, mr.Polyhedron.box((3, 1, 1), (0, 0, 1.5))])
    within = mr.Polyhedron.box((1, 0.8, 1), (0, 0, 0.5))
    masonry = mr.Masonry((GROUND, frame, within), xi=0)
    for azimuth, order in ((0.0, [0, 3, 1]), (180.0, [1, 3, 0])):
        drawn = posed(masonry, REST, camera=(20.0, azimuth)).order(0).tolist()
        assert [part for part in drawn if part != 2] == order
    top = posed(masonry, REST, camera=(20.0, 0.0)).order(0)[-1]
    assert top == 2


def nearest(solids, point):
    """The convex parts that a line of sight through a point meets, the nearest first."""
    met, part = [], 0
    poses = dict(zip(solids.masonry.free, solids.moving.pose[0], strict=True))
    for number, rest in zip(solids.shown.tolist(), solids.case.centroids[solids.shown], strict=True):
        turn = rotations(poses[number][None])[0]
        start, way = turn.T @ (point - rest - poses[number][:3]) + rest, turn.T @ solids.eye
        for body in solids.masonry.polyhedra[number].parts:
            ends = [-np.inf, np.inf]
            for side in body.sides:
                speed, off = side.normal @ way, side.normal @ (side.corners[0] - start)
                ends = [max(ends[0], off / speed), ends[1]] if speed < 0 else [ends[0], min(ends[1], off / speed)]
            met += [(ends[1], part)] if ends[0] < ends[1] - 1e-6 else []
            part += 1
    return [part for _, part in sorted(met, reverse=True)]


@pytest.mark.parametrize("seed", range(6))
def test_what_a_line_of_sight_meets_first_is_drawn_last(seed):
    """Bodies that lie as they fell, far from where they rested: no joint tells their order."""
    rng = np.random.default_rng(seed)
    cells = np.stack(np.meshgrid(*[np.arange(3.0)] * 3), axis=-1).reshape(-1, 3)
    size = np.array([1.6, 0.3, 0.8])
    boxes = [mr.Polyhedron.box(size, size * (cell + np.array([0, 0, 0.5]))) for cell in cells[:18]]
    cells = 1.85 * cells
    spread = rng.normal(size=(8, 9, 3))
    spread *= 0.8 / np.linalg.norm(spread, axis=2, keepdims=True)
    hulls = [mr.Polyhedron(9.0 + cell + corners) for cell, corners in zip(cells[18:26], spread, strict=True)]
    legs = mr.Polyhedron.box((0.3, 0.3, 0.9), (-9, 0, 5)), mr.Polyhedron.box((0.6, 0.3, 0.3), (-8.55, 0, 4.7))
    ground = mr.Polyhedron.box((9, 9, 1), (0, 0, -0.5), fixed=True)
    masonry = mr.Masonry((ground, *boxes, *hulls, mr.Compound(legs)), xi=0)
    pose = rng.normal(size=(27, 7))
    pose[:, :3] = rng.permutation(cells) - [body.centroid for body in masonry.polyhedra[1:]]
    pose[:, 3:] /= np.linalg.norm(pose[:, 3:], axis=1)[:, None]
    camera = (rng.uniform(-90, 90), rng.uniform(-180, 180)) if seed else (0.0, 0.0)
    solids = posed(masonry, pose, camera=camera)
    place, lines = np.argsort(solids.order(0)), 0
    for point in rng.uniform(-0.5, 4.2, (300, 3)):
        met = nearest(solids, point)
        assert all(place[before] > place[behind] for before, behind in pairwise(met))
        lines += len(met) > 1
    assert lines > 50


def test_what_has_sunk_below_the_gspreadis_left_out_and_fixed_blocks_are_grey():
    ax = axes()
    plotting.blocks(ax, MASONRY, moved(place=(0.0, 0.0, -3.0)))
    assert len(faces_of(ax).corners) == 3
    pier = mr.Polyhedron.box((1, 1, 1), (0.5, 0, 0.5), fixed=True)
    plotting.blocks(ax := axes(), mr.Masonry((GROUND, pier, PAIR[1]), xi=0))
    red, green, blue, _ = faces_of(ax).get_facecolor()[-1]
    assert red == green == blue


def test_a_response_is_drawn_as_it_ended_and_moves(tmp_path):
    tie = mr.Tie(at=(-0.25, 0, 1.8), stiffness=1e4, block=1, length=0.8)
    masonry = mr.Masonry.box((0.5, 0.5, 2.0), k_n=1e8)
    case = mr.MasonryCase(masonry, 0.05, velocity=[(0.2, 0.2, 0, 0.6, 1, 0.5)], effects=(tie,))
    response = mr.solve_explicit(case, output_step=1e-2)
    plotting.blocks(ax := axes(), response)
    plotting.blocks(same := axes(), masonry, response.pose[-1])
    np.testing.assert_allclose(np.concatenate(faces_of(ax).corners), np.concatenate(faces_of(same).corners))
    solids = Solids.of(response)
    figure, update = animation.scene(solids, [], case)
    before = np.concatenate(faces_of(figure.axes[0]).corners)
    update(len(response.t) - 1)
    assert np.abs(np.concatenate(faces_of(figure.axes[0]).corners) - before).max() > 0.01
    _, line = figure.axes[0].lines  # the scale bar, and the tie
    np.testing.assert_allclose(np.transpose(line.get_data_3d())[1], (-1.05, 0, 1.8))
    assert plotting.animate(response, tmp_path / "rock.gif", dpi=20, fps=20, camera=(30.0, 60.0)).exists()
    halfway = solids.at(np.array([0.005]))
    assert np.linalg.norm(halfway.moving.pose[0, 0, 3:]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: plotting.blocks(Figure().subplots(), MASONRY), "ax has two dimensions, and the masonry is in space"),
        (lambda: plotting.blocks(axes(), MASONRY, [[0.0] * 3] * 2), r"pose has the shape \(2, 3\); \(2, 7\) is needed"),
        (lambda: plotting.blocks(axes(), MASONRY, camera=(91.0, 0.0)), "elevation of the camera = 91 degrees"),
        (lambda: plotting.blocks(axes(), MASONRY, camera=(1.0,)), r"camera has the shape \(1,\)"),
    ],
)
def test_what_cannot_be_drawn(call, complaint):
    with pytest.raises(ValueError, match=complaint):
        call()


def test_what_takes_the_plane_alone_says_so(one_sided, e, tmp_path):
    response = mr.solve_explicit(mr.MasonryCase(mr.Masonry.box((0.5, 0.5, 2.0), k_n=1e8), 0.01))
    with pytest.raises(ValueError, match="Bodies takes blocks in the plane"):
        plotting.bodies.Bodies.of(response)
    with pytest.raises(TypeError, match=r"responses\[0\] is of masonry.*take plotting.displacement"):
        plotting.rotation(Figure().subplots(), [response])
    wall = mr.solve_analytical(one_sided, e)
    with pytest.raises(ValueError, match="blocks takes masonry or a response of it"):
        plotting.blocks(axes(), wall)
    with pytest.raises(ValueError, match=r"camera = .* is for masonry in space"):
        plotting.animate(wall, tmp_path / "a.gif", camera=(10.0, 10.0))


def test_a_block_that_has_flown_far_does_not_shrink_the_picture():
    solids = posed(MASONRY, moved(place=(500.0, 0.0, 2.0)))
    low, high = solids.extent()
    np.testing.assert_allclose(low, [-1.0, -0.5, 0.0], atol=1e-12)
    np.testing.assert_allclose(high, [3.0, 0.5, 3.0], atol=1e-12)


def test_a_moving_picture_fills_its_figure_but_for_its_margin():
    case = mr.MasonryCase(MASONRY, 1.0)
    figure, _ = animation.scene(posed(MASONRY, REST), [], case)
    ax = figure.axes[0]
    seen = np.concatenate([path.vertices for path in faces_of(ax).get_paths()])
    low, high = ax.transData.transform([seen.min(axis=0), seen.max(axis=0)]) / figure.bbox.size
    room = 1 - np.array([0.2, 0.8]) / figure.get_size_inches()
    assert ((high - low) / room).max() == pytest.approx(1.0, abs=0.01)
    np.testing.assert_allclose(0.5 * (low + high), 0.5, atol=0.08)


def test_a_scale_bar_is_as_long_as_it_says_and_lies_across_the_line_of_sight():
    solids = posed(MASONRY, REST)
    figure, _ = animation.scene(solids, [], None)
    ax = figure.axes[0]
    ends = np.transpose(ax.lines[0].get_data_3d())
    (said,) = (text.get_text() for text in ax.texts)
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(float(said.split()[0]))
    assert (ends[1] - ends[0]) @ solids.eye == pytest.approx(0.0, abs=1e-12)
    corners = solids.corners(0).reshape(-1, 3) @ solids.across.T
    assert (ends @ solids.across.T)[:, 1].max() < corners[:, 1].min()


def test_the_ground_is_drawn_beyond_blocks_that_have_fallen_far():
    for far, corner in ((1.5, 2.5), (500.0, 3.0 + 3 * 4.0)):  # the front block reaches 1 m at rest
        solids = posed(MASONRY, moved(angle=0.0, place=(far, 0.0, 0.0)))
        low, high = solids.floor
        size = max(np.ptp(solids.extent(), axis=0))
        np.testing.assert_allclose(low, [-1.0 - 0.15 * size, -0.5 - 0.15 * size])
        assert high[0] == pytest.approx(corner + 0.15 * size)


def test_a_block_that_is_gone_leaves_the_place_where_it_stood():
    masonry = mr.Masonry([GROUND, PAIR[0]], k_n=1e8)
    pose = np.array([[[30.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]])
    low, high = posed(masonry, pose[0]).extent()
    np.testing.assert_allclose([low, high], [[0.0, -0.5, 0.0], [1.0, 0.5, 1.0]], atol=1e-12)
