import dataclasses
import subprocess

import numpy as np
import pytest
from everyday import among
from PIL import Image

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import animation, histories
from mjrock.plotting.bodies import Bodies, pulling
from mjrock.result.bodies import BodyMotion
from mjrock.result.motion import SampledMotion

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
E = mr.Restitution.from_geometry(WALL)


def theory(duration=0.2, **case):
    return mr.solve_analytical(mr.Case(WALL, 0.5 * WALL.alpha, duration, **case), E)


def drawn(response, frame=0, magnify=1.0):
    """The picture of a response at the start or, with frame = 1, at the end."""
    bodies = Bodies.of(response, magnify).at(response.t[[0, -1]])
    figure, update = animation.scene(bodies, [], response.case)
    update(frame)
    return figure, figure.axes[0]


def test_the_outline_turns_about_the_toe_and_away_from_the_side_stop():
    response = theory()
    bodies = Bodies.of(response)
    corners = bodies.corners(0)[0]
    theta = 0.5 * WALL.alpha
    inner_edge = [0.3 - 0.6 * np.cos(theta), 0.6 * np.sin(theta)]
    np.testing.assert_allclose(corners[:2], [inner_edge, [0.3, 0.0]], atol=1e-12)
    np.testing.assert_allclose(corners[2], [0.3 + 4.2 * np.sin(theta), 4.2 * np.cos(theta)], atol=1e-12)


def test_magnified_displacements_leave_the_toe_where_it_is():
    response = theory()
    bodies = Bodies.of(response, magnify=5.0)
    corners, true = bodies.corners(0)[0], Bodies.of(response).corners(0)[0]
    at_rest = np.array([[-0.3, 0.0], [0.3, 0.0], [0.3, 4.2], [-0.3, 4.2]])
    np.testing.assert_allclose(corners[1], [0.3, 0.0], atol=1e-12)
    np.testing.assert_allclose(corners - at_rest, 5 * (true - at_rest), atol=1e-12)
    assert "displacements x 5" in drawn(response, magnify=5.0)[1].get_title()
    assert "true to scale" in drawn(response)[1].get_title()


@pytest.mark.parametrize(("fps", "speed"), among([(30, 1.0), (12.5, 0.1)], (12.5, 0.1)))
def test_a_gif_takes_the_time_that_the_motion_took(fps, speed, tmp_path):
    path = plotting.animate(theory(0.16 * speed), tmp_path / "rock.gif", fps=fps, speed=speed, dpi=20)
    with Image.open(path) as picture:
        shown = 0
        for i in range(picture.n_frames):
            picture.seek(i)
            shown += picture.info["duration"] / 1000
    last = animation.writer_for(path, fps)[1]
    assert shown == pytest.approx(0.16 + animation.LAST_FRAME_LONGER, abs=1.01 * last)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not animation.MovieWriter.isAvailable(), reason="needs ffmpeg")
@pytest.mark.parametrize(("ending", "mark"), among([("mp4", b"ftyp"), ("webm", b"webm")], ("mp4", b"ftyp")))
def test_a_film_of_ffmpeg_holds_its_end(ending, mark, tmp_path):
    """The motion of 0.4 s has 5 frames at 10 a second; 10 more show the last one, a little changed by the coder."""
    path = plotting.animate(theory(0.4), tmp_path / f"rock.{ending}", fps=10, dpi=20)
    assert mark in path.read_bytes()[:64]
    command = [animation.MovieWriter.bin_path(), "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "gray", "-"]
    film = np.frombuffer(subprocess.run(command, check=True, capture_output=True).stdout, np.uint8)
    frames = film.reshape(5 + 10, -1).astype(float)
    changes = np.abs(frames - frames[-1]).mean(axis=1)
    assert changes[4:].max() < 0.2 * changes[:4].max()
    assert changes[0] > 1.0


def test_mp4_without_ffmpeg(tmp_path, monkeypatch):
    monkeypatch.setattr(animation.MovieWriter, "isAvailable", classmethod(lambda cls: False))
    with pytest.raises(RuntimeError, match=r"rock.mp4: .mp4 needs the program ffmpeg.*pip install imageio-ffmpeg"):
        plotting.animate(theory(0.1), tmp_path / "rock.mp4")


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"speed": 0}, "speed = 0 is outside"),
        ({"fps": 1e3}, "fps = 1000 1/s is outside"),
        ({"magnify": -1}, "magnify = -1 is outside"),
        ({"dpi": 1}, "dpi = 1 is outside"),
        ({"title": 3}, "title = 3 of type int"),
        ({"speed": 0.001, "fps": 120}, "26001 frames; the valid range is 1 to 20000; raise speed"),
        ({"path": "rock.avi"}, "path = 'rock.avi' does not end in .gif, .mp4 or .webm; view"),
        ({"path": "rock.html"}, "path = 'rock.html' does not end in .gif, .mp4 or .webm; view writes an .html"),
        ({"response": 3}, "response = 3 of type int is not a Response"),
    ],
)
def test_what_cannot_be_drawn(options, complaint, tmp_path):
    arguments = {"response": theory(0.52), "path": "rock.gif"} | options
    arguments["path"] = tmp_path / arguments["path"]
    with pytest.raises((ValueError, TypeError), match=complaint):
        plotting.animate(**arguments)
    assert not list(tmp_path.iterdir())


def test_what_the_wall_meets_and_carries_is_drawn():
    wall = mr.Block.from_size(0.6, 4.2, 3.0, openings=[mr.Opening(1.0, 1.2, 0.8)])
    effects = (
        mr.Tie(4.0, 1e6, length=1.5),
        mr.Tie(3.0, 1e6, slack=0.5, length=9.0),
        mr.Thrust(3.5, 2e3),
        mr.Load(5e3, 4.2),
        mr.AddedMass(300.0, 4.2, 0.2),
    )
    case = mr.Case(wall, 0.02, 0.1, side_stop=mr.SideStop(2.5), effects=effects)
    _, ax = drawn(mr.solve_analytical(case, mr.Restitution(0.97, -0.4)))
    texts = {text.get_text().strip() for text in ax.texts}
    assert {"2 kN", "5 kN", "300 kg", "anchor 9 m behind"} <= texts
    boxes = [patch for patch in ax.patches if getattr(patch, "get_hatch", lambda: None)()]
    assert [np.ptp(box.get_xy()[:, 1]) for box in boxes] == [2.5]
    dashed = [line for line in ax.get_lines() if line.get_linestyle() == "--"]
    turned = Bodies.of(mr.solve_analytical(case, mr.Restitution(0.97, -0.4)))
    sill = turned.moving.placed(0, np.array([[-0.3, 0.8], [0.3, 0.8]]))[0]
    np.testing.assert_allclose(dashed[0].get_xydata(), sill)
    ties = [line for line in ax.get_lines() if line.get_color() == mr.Tie.colour and len(line.get_xdata()) == 2]
    assert [line.get_linestyle() for line in ties] == ["-", ":"]
    np.testing.assert_allclose(ties[0].get_xydata()[0], [-1.8, 4.0])


def test_a_tie_that_has_yielded_is_slack_before_it_is_back():
    tie = mr.Tie(4.0, 1e6, strength=1e3)
    case = mr.Case(WALL, 0.0, 1.0, effects=(tie,))
    theta = np.array([0.0, 2e-4, 5e-3, 4e-3, 4.9e-3, 6e-3])
    moving = BodyMotion(case, np.arange(6.0), WALL.pose(theta)[:, None])
    assert pulling(moving, tie)[0].tolist() == [False, True, True, False, True, True]


def bodies_of(blocks, ground, poses, magnify=1.0):
    """Blocks on fixed ground, or above it, as a picture shows them in some poses."""
    masonry = mr.Masonry([*map(mr.Polygon, blocks), mr.Polygon(ground, fixed=True)])
    case = mr.MasonryCase(masonry, 1.0, settled=False)
    return Bodies.of_moving(BodyMotion(case, np.arange(float(len(poses))), poses, magnify))


@pytest.mark.parametrize("wide", among([1, 4], 4))
def test_a_film_of_masonry_fills_its_frame_above_the_motion_of_the_ground(wide, tmp_path):
    """Its height follows from what it shows: 8 inch wide, between 2 and 6 inch high."""
    masonry = mr.Masonry.running_bond(0.8 * wide, 0.8, (0.4, 0.2), k_n=1e9)
    case = mr.MasonryCase(masonry, 0.1, mr.GroundMotion.sine(2.0, 0.05))
    response = mr.solve_explicit(case)
    bodies = Bodies.of(response).at(response.t[[0, -1]])
    figure, _ = animation.scene(bodies, animation.film_of(case).beside(response), case)
    shown, strip = figure.axes
    wanted = np.clip(8.0 * np.divide(*bodies.extent_seen[::-1]), 2.0, 6.0)
    assert figure.get_size_inches() == pytest.approx((8.0, wanted + animation.CLOCK + animation.STRIP), abs=0.02)
    assert not shown.axison
    box = shown.get_window_extent()
    assert max(box.width / figure.bbox.width, box.height / (figure.dpi * wanted)) > 0.9
    assert strip.get_ylabel() == "base [m/s²]"
    assert strip.get_window_extent().y1 < box.y0
    path = plotting.animate(response, tmp_path / "wall.gif", fps=20, dpi=25)
    with Image.open(path) as film:
        assert film.convert("RGB").getpixel((1, 1)) == (255, 255, 255)
        film.seek(film.n_frames - 1)
        assert film.info["duration"] == 1050


def test_bodies_of_many_shapes_are_placed_and_drawn_at_once():
    triangle, square = [[-1.0, -0.2], [1.0, -0.2], [0.0, 1.8]], [[2.5, 1.0], [3.5, 1.0], [3.5, 2.0], [2.5, 2.0]]
    poses = 0.1 * np.random.default_rng(0).normal(size=(4, 2, 3))
    ground = np.array([[-2.0, -0.5], [1.0, -0.5], [1.0, -0.2], [-2.0, -0.2]])
    bodies = bodies_of((triangle, square), ground, poses, 2.0)
    each = [[bodies.corners(i)[j, : len(one)] for j, one in enumerate(bodies.outlines)] for i in range(4)]
    for i, (three, four) in enumerate(each):
        np.testing.assert_allclose(bodies.corners(i), [[*three, three[-1]], four])
    points = np.concatenate([ground, *(corners for frame in each for corners in frame)])
    np.testing.assert_allclose(bodies.extent(), [points.min(axis=0), points.max(axis=0)])
    figure, update = animation.scene(bodies, [], None)
    update(3)
    drawn = [path.vertices[:4] for path in figure.axes[0].collections[0].get_paths()]
    np.testing.assert_allclose(drawn, bodies.corners(3))


def test_what_has_fallen_far_and_wide_ground_do_not_shrink_the_picture():
    """Two unit squares side by side, of which one ends 100 m off and below: the picture goes two extents of both, 4 m,
    to the side, and a quarter of one down and beyond on the ground."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    poses = np.zeros((2, 2, 3))
    poses[1, 1, :2] = 100.0, -100.0
    ground = np.array([[-50.0, -9.0], [50.0, -9.0], [50.0, 0.0], [-50.0, 0.0]])
    bodies = bodies_of((square, square + np.array([1.0, 0.0])), ground, poses)
    np.testing.assert_allclose(bodies.extent(), [[-0.5, -1.0], [6.5, 1.0]], atol=1e-12)


def test_a_tie_is_drawn_to_the_block_that_its_anchor_moves_with():
    """A jack that a support draws back by 0.3 m, and a block that a pose brings forth by 0.1 m, drawn twice as far."""

    def square(left, **options):
        return mr.Polygon([(left, 0), (left + 1, 0), (left + 1, 1), (left, 1)], **options)

    ground = mr.Polygon([(-9, -1), (9, -1), (9, 0), (-9, 0)], fixed=True)
    masonry = mr.Masonry([ground, square(-4, fixed=True, name="jack"), square(0), square(3)])
    far, near = (
        mr.Tie(0.5, 1e6, length=3.0, block=2, anchor_block=1),
        mr.Tie(0.5, 1e6, length=2.0, block=3, anchor_block=2),
    )
    case = mr.MasonryCase(masonry, 1.0, effects=(far, near), supports={"jack": ([0, 1], [0, -0.3], [0, 0])})
    poses = np.zeros((2, 2, 3))
    poses[1, 0, 0] = 0.1
    motion = SampledMotion(poses, np.zeros_like(poses), np.zeros(2))
    response = dataclasses.replace(theory(), t=np.array([0.0, 1.0]), case=case, motion=motion)
    figure, update = animation.scene(Bodies.of(response, 2.0), [], case)
    marks = [line for line in figure.axes[0].lines if line.get_marker() == "s"]
    for frame, places in enumerate([(-3.0, 1.0), (-3.6, 1.2)]):
        update(frame)
        np.testing.assert_allclose([mark.get_data()[0][0] for mark in marks], places, atol=1e-12)


@pytest.mark.parametrize("mass", [0.0, 500.0])
def test_blocks_of_masonry_are_drawn_where_they_are(mass):
    """Blocks, one of them fixed, the upper one with a mass on it, which a pose counts from the common centroid."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]])
    blocks = [mr.Polygon(corners + np.array([0, z]), fixed=z < 0) for z in (-2.0, 0.0, 2.0)]
    case = mr.MasonryCase(
        mr.Masonry(tuple(blocks), 1e9, friction=0.7, xi=0.02), 1.0, effects=(mr.AddedMass(mass, 4.0, block=2),)
    )
    poses = np.zeros((5, 2, 3))
    poses[-1, 1] = [0.1, 0.0, np.pi / 2]
    motion = SampledMotion(poses, np.zeros_like(poses), np.zeros(5))
    bodies = Bodies.of(dataclasses.replace(theory(), t=np.linspace(0, 1, 5), case=case, motion=motion))
    np.testing.assert_array_equal(bodies.moving.case.fixed[0], corners - [0, 2])
    np.testing.assert_allclose(bodies.corners(-1)[0], corners, atol=1e-12)
    centroid = np.array([0.5, 3.0 + mass / (mass + blocks[2].mass)])
    from_it = corners + np.array([0, 2]) - centroid
    fallen = centroid + np.array([0.1, 0.0]) + np.column_stack([from_it[:, 1], -from_it[:, 0]])
    np.testing.assert_allclose(bodies.corners(-1)[1], fallen, atol=1e-12)


def test_a_history_stops_where_the_wall_has_fallen():
    motion = mr.GroundMotion.rectangular(-4.0, 1.0)
    response = mr.solve_analytical(mr.Case(WALL, 0.0, 5.0, motion=motion), E)
    fell = histories.overturned_at(response)
    assert np.interp(fell, response.t, response.theta) == pytest.approx(WALL.alpha, rel=0.02)
    figure = plotting.history(response)
    above, below = figure.axes
    (note,) = (text for text in below.texts if text.get_text() == f"beyond return from t = {fell:.3g} s")
    ends = below.get_lines()[0].get_clip_box()
    assert ends.y1 == pytest.approx(below.transData.transform((0.0, 1.2))[1])
    assert note.get_window_extent().y0 >= ends.y1
    assert above.get_ylabel() == "base [m/s²]"
    np.testing.assert_allclose(above.get_lines()[0].get_ydata().min(), -4.0)
    assert len(plotting.history([theory()] * 2, "both").axes) == 1
    assert histories.overturned_at(theory()) is None
    with pytest.raises(ValueError, match="responses is empty"):
        plotting.history([])
    with pytest.raises(TypeError, match="responses = 3 of type int is not a Response"):
        plotting.history(3)


def test_a_figure_is_saved_under_a_plain_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert str(plotting.save(plotting.history(theory()), "rock")) == "rock.png"
    assert (tmp_path / "rock.png").exists()
