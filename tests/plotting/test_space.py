"""Pictures of blocks in space: where blocks are drawn, which hide which, and what is refused."""

import math

import numpy as np
import pytest
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.proj3d import proj_transform

import mjrock as mr
from mjrock import plotting
from mjrock.geometry.poses import rotations
from mjrock.plotting import animation
from mjrock.plotting.rasterizer import FLOOR, INK, SHADED, View
from mjrock.plotting.solids import Rendering, Solids
from mjrock.result.bodies import BodyMotion

GROUND = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True, name="ground")
PAIR = (mr.Polyhedron.box((1, 1, 1), (0.5, 0, 0.5), name="front"), mr.Polyhedron.box((1, 1, 1), (-0.5, 0, 0.5)))
MASONRY = mr.Masonry((GROUND, *PAIR), xi=0)
REST = np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (2, 1))


def axes():
    return Figure().add_subplot(projection="3d")


def posed(masonry, pose, magnify=1.0, camera=None):
    """Masonry at a pose, as a picture has it."""
    return Solids(BodyMotion(mr.MasonryCase(masonry, 1.0), np.zeros(1), pose[None], magnify), camera)


def drawn_on(ax):
    (drawn,) = (child for child in ax.get_children() if isinstance(child, Rendering))
    return drawn


def shown(solids, size=(240, 240), frame=0):
    """The view of a picture of blocks in space, and which of its surfaces each pixel shows, (height, width)."""
    surfaces = solids.stage(frame)[0]
    middle, pixel = surfaces.corners.mean(axis=(0, 1)), 1.1 * np.ptp(surfaces.corners, axis=(0, 1)).max() / min(size)
    view = View(np.array([*solids.across, solids.eye]), middle, size, pixel)
    return view, view.drawn(surfaces)[1]


def pixels_at(view, points):
    """Columns and rows of the pixels that show points [m]."""
    column, row, _ = np.floor(view.seen(np.asarray(points))).astype(int).T
    return column, row


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
    corners = solids.corners(0)[solids.facets.block == 1].reshape(-1, 3)
    assert np.abs(corners - drawn).sum(axis=1).min() < 1e-12
    np.testing.assert_array_equal(moving.placed(None, at_rest[None])[0, 0], at_rest)


def test_a_picture_has_the_faces_that_are_seen_and_the_same_scale_along_every_axis():
    ax = axes()
    assert plotting.blocks(ax, MASONRY) is ax
    assert not ax.axison
    limits = [getattr(ax, f"get_{name}lim")() for name in "xyz"]
    aspect = ax._box_aspect / np.ptp(limits, axis=1)
    assert aspect.max() == pytest.approx(aspect.min())
    numbers = np.unique(shown(drawn_on(ax).bodies)[1])
    assert len(numbers[numbers >= 0]) == 5  # three of the front box, of the other one its top and its side


@pytest.mark.parametrize(("azimuth", "first"), [(35.0, 1), (-145.0, 2)])
def test_the_nearer_of_two_blocks_hides_the_other(azimuth, first):
    """Half of their common face is looked through at from either side."""
    solids = posed(MASONRY, REST, camera=(20.0, azimuth))
    view, numbers = shown(solids)
    column, row = pixels_at(view, [[0.0, 0.0, 0.5]])
    assert solids.facets.block[numbers[row, column]] == first


def nearest(solids, points, way):
    """Numbers of the blocks that lines through points [m], shape (n, 3), along a unit vector leave last, -1 of none."""
    last, block = np.full(len(points), 1e-6), np.full(len(points), -1)
    poses = dict(zip(solids.masonry.free, solids.moving.pose[0], strict=True))
    for number, rest in zip(solids.shown.tolist(), solids.case.centroids[solids.shown], strict=True):
        turn = rotations(poses[number][None])[0]
        starts, along = (points - rest - poses[number][:3]) @ turn + rest, turn.T @ way
        for body in solids.masonry.polyhedra[number].parts:
            enters, leaves = np.full(len(points), -np.inf), np.full(len(points), np.inf)
            for side in body.sides:
                speed = side.normal @ along
                after = (side.corners[0] - starts) @ side.normal / speed
                if speed < 0:
                    enters = np.maximum(enters, after)
                else:
                    leaves = np.minimum(leaves, after)
            later = (enters < leaves) & (leaves > last)
            last[later], block[later] = leaves[later], number
    return block


def heap(seed):
    """Boxes, hulls and a body of two parts, as they may lie after a fall."""
    rng = np.random.default_rng(seed)
    cells = np.stack(np.meshgrid(*[np.arange(3.0)] * 3), axis=-1).reshape(-1, 3)
    size = np.array([1.6, 0.3, 0.8])
    boxes = [mr.Polyhedron.box(size, size * (cell + np.array([0, 0, 0.5]))) for cell in cells[:18]]
    cells = 1.85 * cells
    spread = rng.normal(size=(8, 9, 3))
    spread *= 0.8 / np.linalg.norm(spread, axis=2, keepdims=True)
    hulls = [mr.Polyhedron(9.0 + cell + corners) for cell, corners in zip(cells[18:26], spread, strict=True)]
    legs = mr.Polyhedron.box((0.3, 0.3, 0.9), (-9, 0, 5)), mr.Polyhedron.box((0.6, 0.3, 0.3), (-8.55, 0, 4.7))
    ground = mr.Polyhedron.box((9, 9, 1), (0, 0, -1.5), fixed=True)
    masonry = mr.Masonry((ground, *boxes, *hulls, mr.Compound(legs)), xi=0)
    pose = rng.normal(size=(27, 7))
    pose[:, :3] = rng.permutation(cells) - [body.centroid for body in masonry.polyhedra[1:]]
    pose[:, 3:] /= np.linalg.norm(pose[:, 3:], axis=1)[:, None]
    return posed(masonry, pose, camera=(rng.uniform(-90, 90), rng.uniform(-180, 180)))


@pytest.mark.parametrize("seed", range(6))
def test_a_pixel_shows_what_its_line_of_sight_meets_first(seed):
    """Against the lines through blocks as half spaces. At an outline a line may just miss."""
    solids = heap(seed)
    view, numbers = shown(solids)
    block = np.append(solids.facets.block, -1)[np.maximum(numbers, -1)]
    row, column = np.random.default_rng(seed).integers(0, 240, (300, 2)).T
    points = view.middle + view.pixel * (np.column_stack([column, row]) - 119.5) @ view.axes[:2]
    np.testing.assert_array_equal(block[row, column], nearest(solids, points - 50 * solids.eye, solids.eye))
    assert len(np.unique(block)) > 15


def test_a_point_of_the_ground_lies_in_the_shade_where_a_block_is_between_it_and_the_sun():
    """Against lines to the sun, but for those that pass within a few pixels of an edge."""
    solids = posed(MASONRY, moved(angle=0.4, place=(0.2, 0.0, 0.7)), camera=(50.0, 35.0))
    surfaces, sun, ground = solids.stage(0)
    view = View(np.array([*solids.across, solids.eye]), np.zeros(3), (300, 300), 0.02)
    colours, found = view.picture(surfaces, sun, ground, 1), {True: 0, False: 0}
    points = np.insert(np.random.default_rng(0).uniform(-2, 2, (300, 2)), 2, 0.0, axis=1)
    beside = 0.05 * np.array([(i - 1, j - 1, 0) for i, j in np.ndindex(3, 3)])
    near = np.array([nearest(solids, points + way, sun) for way in beside]) >= 0
    alike = (nearest(solids, points, solids.eye) < 0) & (near == near[0]).all(axis=0)
    for column, row, shaded in zip(*pixels_at(view, points[alike]), near[0, alike].tolist(), strict=True):
        there = colours[row, column, :3]
        if np.abs(there - INK).max() > 0.1 and colours[row, column, 3] > 0.0:
            np.testing.assert_allclose(there, np.multiply(FLOOR, SHADED if shaded else 1.0), atol=1e-6)
            found[shaded] += 1
    assert min(found.values()) > 15


def test_edges_lie_between_plane_pieces_and_not_where_a_body_is_cut_into_parts():
    legs = [mr.Polyhedron.box((1, 1, 1), (x, 0, 0.5)) for x in (-1.0, 1.0)]
    frame = mr.Compound([*legs, mr.Polyhedron.box((3, 1, 1), (0, 0, 1.5))])
    solids = posed(mr.Masonry((GROUND, frame), xi=0), REST[:1], camera=(0.0, -90.0))
    surfaces, sun, _ = solids.stage(0)
    view = View(np.array([*solids.across, solids.eye]), np.array([0.0, 0.0, 1.0]), (400, 400), 0.01)
    colours = view.picture(surfaces, sun, None, 1)
    dark = np.abs(colours[..., :3] - INK).max(axis=2) < 1e-6
    heights = [view.seen(np.array([x, -0.5, z])) for x, z in ((-1.0, 1.0), (-1.0, 2.0), (0.0, 1.0))]
    along_cut, along_top, above_gap = (dark[round(y) - 2 : round(y) + 3, round(x)].any() for x, y, _ in heights)
    assert (along_cut, along_top, above_gap) == (False, True, True)


def test_what_has_sunk_below_the_ground_is_hidden_and_fixed_blocks_are_grey():
    solids = posed(MASONRY, moved(place=(0.0, 0.0, -0.04)))  # by less than its height
    surfaces, sun, ground = solids.stage(0)
    view, _ = shown(solids)
    colours = view.picture(surfaces, sun, ground, 1)
    low, above = (
        colours[row[0], column[0], :3] for column, row in (pixels_at(view, [[1.0, 0.0, z]]) for z in (-0.02, 0.5))
    )
    assert low.min() > 0.6
    assert above[0] > 1.2 * above[2]
    pier = mr.Polyhedron.box((1, 1, 1), (0.5, 0, 0.5), fixed=True)
    red, green, blue = posed(mr.Masonry((GROUND, pier, PAIR[1]), xi=0), REST[:1]).stage(0)[0].colour[0]
    assert red == green == blue


@pytest.mark.parametrize(("lowest", "grounds"), [(0.5, ["ground"]), (-2.0, [])], ids=["stands", "hangs below"])
def test_ground_is_what_lies_lowest_in_a_picture_and_in_the_browser(lowest, grounds):
    """A plinth on the ground is none, and nothing is where a block is below all that is fixed."""
    plinth = mr.Polyhedron.box((1, 1, 0.5), (0, 0, 0.25), fixed=True, name="plinth")
    block = mr.Polyhedron.box((1, 1, 1), (0, 0, lowest + 0.5), name="block")
    solids = posed(mr.Masonry((GROUND, plinth, block), xi=0), REST[:1])
    names = np.array(solids.masonry.names)
    assert [*names[solids.moving.are_ground]] == grounds
    assert [*names[solids.shown]] == [name for name in names if name not in grounds]
    assert (solids.ground is None) == (grounds == [])


def test_blocks_that_fall_past_the_edge_of_the_ground_leave_it_as_it_is():
    solids = posed(MASONRY, moved(place=(9.0, 0.0, -3.0)))
    assert solids.ground is None
    assert len(solids.stage(0)[0].corners) == 3 * 6


def test_a_response_is_drawn_as_it_ended_and_moves(tmp_path):
    tie = mr.Tie(at=(-0.25, 0, 1.8), stiffness=1e4, block=1, length=0.8)
    masonry = mr.Masonry.box((0.5, 0.5, 2.0), k_n=1e8)
    case = mr.MasonryCase(masonry, 0.05, velocity=[(0.2, 0.2, 0, 0.6, 1, 0.5)], effects=(tie,))
    response = mr.solve_explicit(case, output_step=1e-2)
    plotting.blocks(ax := axes(), response)
    plotting.blocks(same := axes(), masonry, response.pose[-1])
    corners = [drawn_on(one).bodies.stage(0)[0].corners for one in (ax, same)]
    np.testing.assert_allclose(*corners)
    solids = Solids.of(response)
    figure, update = animation.scene(solids, [], case)
    update(len(response.t) - 1)
    assert drawn_on(figure.axes[0]).frame == len(response.t) - 1
    assert np.abs(solids.corners(len(response.t) - 1) - solids.corners(0)).max() > 0.01
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
    figure, _ = animation.scene(posed(MASONRY, REST), [], mr.MasonryCase(MASONRY, 1.0))
    figure.draw_without_rendering()
    drawn = drawn_on(figure.axes[0])
    seen = drawn.view().seen(drawn.bodies.corners(0).reshape(-1, 3))[:, :2] / drawn.box.size
    low, high = seen.min(axis=0), seen.max(axis=0)
    room = 1 - np.array([0.2, 0.8]) / figure.get_size_inches()
    assert ((high - low) / room).max() == pytest.approx(1.0, abs=0.01)
    np.testing.assert_allclose(0.5 * (low + high), 0.5, atol=0.08)


def test_blocks_are_drawn_where_an_axes_of_three_dimensions_has_them():
    """Forces and ties are drawn on top of them by its projection."""
    figure = Figure(figsize=(5, 4), dpi=100)
    ax = plotting.blocks(figure.add_subplot(1, 2, 1, projection="3d"), MASONRY)
    figure.draw_without_rendering()
    drawn = drawn_on(ax)
    points = drawn.bodies.corners(0).reshape(-1, 3)
    x, y, _ = proj_transform(*points.T, ax.get_proj())
    expected = ax.transData.transform(np.column_stack([x, y]))
    found = drawn.view().seen(points)[:, :2] * drawn.box.size / drawn.view().size + drawn.box.min
    np.testing.assert_allclose(found, expected, atol=0.6)


def test_a_scale_bar_is_as_long_as_it_says_and_lies_across_the_line_of_sight():
    solids = posed(MASONRY, REST)
    figure, _ = animation.scene(solids, [], None)
    ax = figure.axes[0]
    ends = np.transpose(ax.lines[0].get_data_3d())
    (message,) = (text.get_text() for text in ax.texts)
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(float(message.split()[0]))
    assert (ends[1] - ends[0]) @ solids.eye == pytest.approx(0.0, abs=1e-12)
    corners = solids.corners(0).reshape(-1, 3) @ solids.across.T
    assert (ends @ solids.across.T)[:, 1].max() < corners[:, 1].min()


def test_the_ground_is_drawn_beyond_blocks_that_have_fallen_far():
    for far, corner in ((1.5, 2.5), (500.0, 3.0 + 3 * 4.0)):  # the front block reaches 1 m at rest
        solids = posed(MASONRY, moved(angle=0.0, place=(far, 0.0, 0.0)))
        size = max(np.ptp(solids.extent(), axis=0))
        middle, radius = solids.ground.middle, solids.ground.radius
        np.testing.assert_allclose(middle, [0.5 * (corner - 1.0), 0.0], atol=1e-12)
        assert radius == pytest.approx(0.5 * math.hypot(corner + 1.0, 1.0) + 0.6 * size)


def test_a_block_that_is_gone_leaves_the_place_where_it_stood():
    masonry = mr.Masonry([GROUND, PAIR[0]], k_n=1e8)
    pose = np.array([[[30.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]])
    low, high = posed(masonry, pose[0]).extent()
    np.testing.assert_allclose([low, high], [[0.0, -0.5, 0.0], [1.0, 0.5, 1.0]], atol=1e-12)
