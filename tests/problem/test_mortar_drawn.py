"""Brickwork that is drawn with its mortar: joints across a gap, however narrow the faces are."""

import warnings

import ezdxf
import numpy as np
import pytest

import mjrock as mr

MORTAR, LONG, HIGH = 0.01, 0.25, 0.065  # m


def bricks(gap, courses=6, each=4):
    """Bricks in stack bond on the ground, as corners by name."""
    found = {}
    for i, j in np.ndindex(courses, each):
        x, z = (LONG + gap) * j, (HIGH + gap) * i
        found[f"b{i}_{j}"] = [(x, z), (x + LONG, z), (x + LONG, z + HIGH), (x, z + HIGH)]
    return found


def wall(apart, in_space=False, **options):
    ground = mr.Polygon([(-1, -0.2), (3, -0.2), (3, 0), (-1, 0)], fixed=True, name="ground")
    blocks = [ground, *(mr.Polygon(corners, name=name) for name, corners in bricks(apart).items())]
    return mr.Masonry([mr.Polyhedron.prism(b) for b in blocks] if in_space else blocks, **options)


def heads(masonry):
    """How many joints are upright."""
    return sum(abs(joint.normal[-1]) < 0.5 for joint in masonry.joints)


@pytest.mark.parametrize("in_space", [False, True])
def test_bed_joints_and_head_joints_are_found(in_space):
    """24 beds and 18 heads. A tolerance as wide as the mortar leaves out the heads, which are 65 mm high."""
    closed, drawn = wall(0.0, in_space), wall(MORTAR, in_space, gap=MORTAR)
    assert [joint.name for joint in drawn.joints] == [joint.name for joint in closed.joints]
    assert (len(drawn.joints), heads(drawn)) == (42, 18)
    corners = [sorted(joint.corners) for joint in closed.joints]
    assert [sorted(joint.corners) for joint in drawn.joints] == corners
    assert heads(wall(MORTAR, in_space, tolerance=1.1 * MORTAR)) == 0


def test_the_joint_lies_amid_the_gap_and_is_as_wide_as_the_face():
    for joint, there in ((j, j.name.split("|")) for j in wall(MORTAR, gap=MORTAR).joints):
        if there[0] == "ground":
            assert joint.start[1] == joint.end[1] == 0.0
        else:
            i, j = (int(number) for number in there[0][1:].split("_"))
            x, z = (LONG + MORTAR) * j, (HIGH + MORTAR) * i
            beside, above = x + LONG + 0.5 * MORTAR, z + HIGH + 0.5 * MORTAR
            upright = there[1].startswith(f"b{i}_")
            ends = [(beside, z), (beside, z + HIGH)] if upright else [(x, above), (x + LONG, above)]
            np.testing.assert_allclose(sorted([joint.start, joint.end]), ends, atol=1e-12)


def test_a_slender_block_leans_across_the_gap_on_a_squat_one():
    """The head joint rubs not. Blocks of the same height h: the slender one turns about its toe as the other slides:
    a W1 h/2 = W1 b/2 + H h, and H = (mu - a) W2 at its top."""
    b, far, h, mu = 0.1, 1.0, 0.5, 0.5
    outlines = {"ground": (-1, 3, -0.2, 0), "slender": (0, b, 0, h), "squat": (b + MORTAR, b + MORTAR + far, 0, h)}
    blocks = [
        mr.Polygon([(a, c), (e, c), (e, d), (a, d)], fixed=name == "ground", name=name)
        for name, (a, e, c, d) in outlines.items()
    ]
    masonry = mr.Masonry(blocks, gap=MORTAR, friction=lambda joint: mu if joint.is_bed else 0.0)
    w1, w2 = b * h, far * h
    expected = (0.5 * w1 * b / h + mu * w2) / (0.5 * w1 + w2)
    assert mr.collapse_multiplier(masonry).multiplier == pytest.approx(expected, rel=1e-6)


def test_a_gap_moves_as_a_tolerance_does_where_faces_are_wide():
    """A stack of wide blocks has the same joints both ways, and the same motion, bit by bit."""
    rows = {"ground": (-1.0, 1.0, -0.2, 0.0)} | {f"b{i}": (-0.3, 0.3, 0.41 * i, 0.41 * i + 0.4) for i in range(3)}
    blocks = [
        mr.Polygon([(a, c), (b, c), (b, d), (a, d)], fixed=name == "ground", name=name)
        for name, (a, b, c, d) in rows.items()
    ]
    runs = []
    for option in ({"gap": MORTAR}, {"tolerance": 1.1 * MORTAR}):
        case = mr.MasonryCase(mr.Masonry(blocks, k_n=1e9, **option), 0.6, motion=mr.GroundMotion.sine(7.0, 0.5))
        runs.append(mr.solve_explicit(case))
    np.testing.assert_array_equal(runs[0].pose, runs[1].pose)
    assert np.abs(runs[0].theta).max() > 0.01
    assert runs[0].stats["overlap"] < 1e-3


def drawn(path, gap, twice=(), unit=6):
    document = ezdxf.new()
    document.header["$INSUNITS"] = unit
    for name, corners in bricks(gap).items():
        document.modelspace().add_lwpolyline(corners, close=True)
        if name in twice:  # begun at another corner, the other way round
            document.modelspace().add_lwpolyline([*corners[2:], *corners[:2]][::-1], close=True)
    document.saveas(path)
    return path


def test_a_drawing_names_the_gap_and_what_a_tolerance_loses(tmp_path):
    path = drawn(tmp_path / "a.dxf", MORTAR)
    with pytest.raises(ValueError, match=r"gap = 0\.01\d* m joins all of them: it finds 42 joints"):
        mr.Masonry.from_dxf(path, ground=True)
    assert heads(mr.Masonry.from_dxf(path, ground=True, gap=MORTAR)) == 18
    complaint = (
        r"18 pairs of blocks have no joint .* no wider than 10 times the tolerance of 0\.011 m; gap = 0\.011 m in its"
    )
    with pytest.warns(mr.Implausible, match=complaint):
        assert heads(mr.Masonry.from_dxf(path, ground=True, tolerance=0.011)) == 0


def test_an_overlap_names_what_its_tolerance_loses():
    """Bricks that sink 8 mm into each other: a tolerance that takes this finds no joint at the heads."""
    sunk = [mr.Polygon([(-1, -1), (9, -1), (9, 0), (-1, 0)], fixed=True)]
    sunk += [mr.Polygon(corners) for corners in bricks(-0.008, courses=2, each=3).values()]
    with pytest.raises(
        ValueError, match=r"tolerance = 0\.008\d m takes them: it finds 6 joints, and leaves 8 pairs of"
    ):
        mr.Masonry(sunk)


def test_an_outline_that_is_drawn_twice_is_read_once(tmp_path):
    path = drawn(tmp_path / "a.dxf", 0.0, twice=("b0_1", "b2_3"))
    with pytest.warns(UserWarning, match=r"2 outlines are drawn twice, and read once: 0_2, 0_13"):
        masonry = mr.Masonry.from_dxf(path, ground=True)
    np.testing.assert_allclose(masonry.centroids[1:], wall(0.0).centroids[1:], atol=1e-12)


def test_small_blocks_are_as_odd_as_large_ones(tmp_path):
    """A drawing in m under the header of a template in inches: bricks of 6.4 x 1.7 mm."""
    path = drawn(tmp_path / "a.dxf", 0.0, unit=1)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mr.Masonry.from_dxf(path, ground=True)
    texts = " ".join(str(each.message) for each in caught)
    assert "0.006561 m across: is the unit too small? A file takes unit='m'" in texts
    assert (
        "its header says that its unit is 0.0254 m, which a template may have left there; unit= takes another" in texts
    )
    assert mr.Masonry.from_dxf(path, ground=True, unit="m").centroids[1, 0] == pytest.approx(0.5 * LONG)


def test_walls_of_a_storey_that_stand_side_by_side_are_not_asked_for_their_axis():
    """A wall of bricks that lies on its face still is."""
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]

    def bodies(size, places):
        unit = np.array(list(np.ndindex(2, 2, 2)))
        return {f"b{i}": (size * (unit + place), faces) for i, place in enumerate(places)}

    walls = bodies(np.array([3.5, 0.3, 3.2]), [(i, 0, 0) for i in range(4)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(mr.Masonry.from_meshes(walls, ground=True).joints) == 7
    laid = bodies(np.array([0.25, 0.06, 0.12]), [(i, j, 0) for i in range(3) for j in range(6)])
    with pytest.warns(mr.Implausible, match=r"18 of 18 blocks lie on the ground, side by side along y"):
        mr.Masonry.from_meshes(laid, ground=True)
    far = {"wall": (walls["b0"][0] + [601200.0, 5340100.0, 250.0], faces)}
    with pytest.raises(ValueError, match=r"body wall: .* national coordinates\? Subtract an origin near the masonry"):
        mr.Masonry.from_meshes(far, ground=True)
    with pytest.raises(ValueError, match=r"4 free and 0 fixed; .*fixed=\['b0'\] names a support, and ground=True puts"):
        mr.Masonry.from_meshes(walls)


@pytest.mark.parametrize("head", ["element face 0\nproperty list uchar int vertex_indices\n", ""])
def test_a_cloud_of_points_is_named(head, tmp_path):
    path = tmp_path / "a.ply"
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    path.write_text(f"ply\nformat ascii 1.0\nelement vertex 1\n{axes}{head}end_header\n0 0 0\n")
    with pytest.raises(
        ValueError, match=r"a\.ply: it is not a PLY file of faces, .*: it has no faces, as a cloud of points$"
    ):
        mr.Masonry.from_ply(path)
