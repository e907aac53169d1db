"""Blocks that leave their joints meet the ground and each other, and faces end where they end."""

import math
from dataclasses import replace

import numpy as np
import pytest
from by_hand import system
from everyday import among
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.search.contact_search import ContactSearch
from mjrock.distinct.search.validity import account
from mjrock.distinct.setup import setup_of

TABLE = box(-1, 0, 0, 1, name="table")


@pytest.mark.parametrize("d", among([2, 3], 3))
def test_shear_springs_of_lines_and_bonds_hold_half_of_k_s_times_the_square_of_their_way(d):
    """Those of rigid friction hold nothing."""
    none = np.zeros(0, dtype=np.int64)
    whole, ways = system(d, 3), np.array([[0.2], [-0.3], [0.5]]) if d == 2 else np.array([[0.2, 0.1, -0.4]] * 3)
    for table, k_s in ((whole.lines, [2e3, np.inf, 5e3]), (whole.laws[0].rows, [7e3, 3e3, np.inf])):
        table["k_s"], table["shear_state"] = k_s, ways
    squares = (ways**2).sum(axis=1)
    expected = 0.5 * (2e3 * squares[0] + 5e3 * squares[2] + 7e3 * squares[0] + 3e3 * squares[1])
    assert account(whole, none, np.zeros(0)).sheared == pytest.approx(expected, rel=1e-12)


def test_what_lies_on_fixed_blocks_without_a_joint_presses_on_these():
    """Two boxes on one another on the ground, and one on a table: each has been dropped by 1 mm but for the lowest."""
    table = box(2, 3, 0, 1, fixed=True, name="table")
    low, high = box(0, 0.3, 0, 0.2, name="low"), box(0, 0.3, 0.201, 0.401, name="high")
    masonry = mr.Masonry([GROUND, low, high, table, box(2.2, 2.5, 1.001, 1.301)], k_n=1e7, friction=0.5, xi=1.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.4, settled=False), output_step=2e-3, forces=True)
    weight = [masonry.blocks[i].mass * mr.GRAVITY for i in (1, 2, 4)]
    assert np.argmax(run.reactions["table"][:, 1] > 0) == np.argmax(run.pose[:, 2, 1] < -1e-3)
    assert run.reactions["ground"][-1] == pytest.approx([0.0, weight[0] + weight[1]], abs=1e-3 * weight[0])
    assert run.reactions["table"][-1] == pytest.approx([0.0, weight[2]], abs=1e-3 * weight[0])


def test_a_block_that_is_thrown_off_its_table_comes_to_rest_on_the_ground():
    blocks = [GROUND, TABLE, box(-0.5, -0.1, 1, 1.3, name="box")]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.5, xi=0.2)
    case = mr.MasonryCase(masonry, 2.2, velocity=[(0, 0, 0), (2.5, 0, 0)])
    run = mr.solve_explicit(case, ledger=True)
    x, z, theta = run.pose[-1, 1]
    assert "box" in run.fallen
    assert x > 0.3
    height = 1.15 + z
    lying = abs((theta / (np.pi / 2)) - round(theta / (np.pi / 2))) < 1e-2
    assert lying
    assert min(abs(height - 0.15), abs(height - 0.2)) < 5e-3
    assert np.abs(run.velocity[-1, 1]).max() < 0.02
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.kinetic.max()
    assert "not in the model" not in run.message


def test_a_pebble_that_falls_by_a_fifth_of_its_size_is_met_where_the_ground_is():
    """It is looked at by its own size, and sinks by m v / sqrt(k m) at most, with the weight."""
    pebble = box(0, 0.02, 0.004, 0.024, name="pebble")
    masonry = mr.Masonry([GROUND, box(1, 1.4, 0, 0.4), pebble], k_n=1e8, friction=0.5, xi=0.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.05, settled=False), output_step=5e-4)
    mass, k = masonry.blocks[2].mass, 1e8 * 0.02
    sunk = mass * mr.GRAVITY / k
    most = sunk + np.sqrt(sunk**2 + 2 * mr.GRAVITY * 0.004 * mass / k)
    assert 0.5 * most < -run.pose[:, 1, 1].min() - 0.004 < 1.05 * most


@pytest.mark.parametrize(
    ("flat", "speed"),
    among([(flat, round(v / 10, 1)) for flat in (True, False) for v in range(22, 41, 3)], (True, 2.2), (False, 3.1)),
)
def test_a_block_that_is_thrown_at_any_speed_stays_above_the_ground(flat, speed):
    """Prisms are flush with the ground and the table on two sides, where rounding alone parts them."""
    blocks = [GROUND, TABLE, box(-0.5, -0.1, 1, 1.3, name="box")]
    velocity = [(0, 0, 0), (speed, 0, 0)]
    if not flat:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
        velocity = [(0,) * 6, (speed, 0, 0, 0, 0, 0)]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.5, xi=0.2, frequency=60.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 2.0, velocity=velocity), output_step=5e-3)
    x, z, theta = run.pose[-1, 1] if flat else (*run.pose[-1, 1, [0, 2]], 2 * np.arctan2(*run.pose[-1, 1, [5, 3]]))
    lowest = 1.15 + z - 0.15 * abs(np.cos(theta)) - 0.2 * abs(np.sin(theta))
    assert x > 0.3
    assert lowest == pytest.approx(0, abs=1e-3)


def test_a_block_twenty_times_as_long_out_of_the_plane_falls_alike():
    """Mass, springs and dashpots grow with the length, so that the motion is the same to rounding."""
    poses = []
    for length in (1.0, 20.0):
        blocks = [replace(block, length=length) for block in (GROUND, TABLE, box(-0.5, -0.1, 1, 1.3, name="box"))]
        masonry = mr.Masonry(blocks, k_n=1e8, friction=0.5, xi=0.2, frequency=60.0)
        poses.append(mr.solve_explicit(mr.MasonryCase(masonry, 0.9, velocity=[(0, 0, 0), (2.5, 0, 0)])).pose)
    assert poses[0][-1, 1, 0] > 0.3
    np.testing.assert_allclose(poses[1], poses[0], atol=1e-9)


def test_a_face_ends_where_it_ends():
    """A block pushed over the edge of its table tips when its centroid has passed the edge, and not before."""
    blocks = [GROUND, TABLE, box(-0.5, -0.1, 1, 1.3, name="box")]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.2, xi=0.2)
    for reach, tips in ((0.25, False), (0.40, True)):
        speed = np.sqrt(2 * 0.2 * mr.GRAVITY * reach)
        duration = 1.6 if tips else 1.0
        run = mr.solve_explicit(mr.MasonryCase(masonry, duration, velocity=[(0, 0, 0), (speed, 0, 0)]))
        assert ("box" in run.fallen) == tips, reach
        if not tips:
            assert run.pose[-1, 1, 0] == pytest.approx(reach, rel=0.02)


@pytest.mark.parametrize("in_space", among([False, True], True))
def test_a_long_face_ends_where_it_ends_too(in_space):
    """On a step of 10 m a block of 1 m tips when its centroid has come to lie 50 mm past the edge."""
    blocks = [box(-30, 30, -1, 0, fixed=True), box(-10, 0, 0, 1, fixed=True), box(-1.4, -0.4, 1, 1.4, name="box")]
    velocity = [np.sqrt(2 * 0.1 * mr.GRAVITY * 0.95), 0, 0]
    if in_space:
        blocks, velocity = [mr.Polyhedron.prism(block) for block in blocks], [*velocity, 0, 0, 0]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.1, xi=0.3)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 2.5, velocity=[velocity]), output_step=1e-2)
    assert list(run.fallen) == ["box"]


@pytest.mark.parametrize(("beyond", "meets"), [(-0.1, True), (0.012, False)])
def test_the_face_of_a_block_that_lies_ends_where_it_lies(beyond, meets):
    """A bar that stood has turned by 90 degrees and falls freely, and a cube falls faster past its end or on it."""
    masonry = mr.Masonry([GROUND, box(-0.2, 0.2, 0, 0.5), box(2, 2.4, 0, 0.4)], k_n=1e8, friction=0.5, xi=0.0)
    pose = np.array([[0.0, 9.75, np.pi / 2], [0.25 + beyond + 0.2 - 2.2, 10.4, 0.0]])
    velocity = np.array([[0.0, 0.0, 0.0], [0.0, -8.0, 0.0]])
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.15), start=(pose, velocity))
    faster = run.velocity[-1, 1, 1] - run.velocity[-1, 0, 1]
    assert faster > -4.0 if meets else faster == pytest.approx(-8.0, abs=1e-9)


@pytest.mark.parametrize("place", [0.02, 0.15, 0.28])
def test_a_corner_meets_an_inclined_edge_where_it_is(place):
    """A small cube falls with its corner on a smooth slope of 60 degrees, and is thrown off along its normal."""
    slope, size = np.pi / 3, 0.1
    along, normal = np.array([np.cos(slope), np.sin(slope)]), np.array([-np.sin(slope), np.cos(slope)])
    foot = np.array([0.0, 0.1])
    wedge = mr.Polygon([foot, foot + 0.3 * along, (foot + 0.3 * along) * (1, 0) + (0, 0.1)], fixed=True, name="wedge")
    masonry = mr.Masonry([GROUND, wedge, box(1.0, 1.0 + size, 0.0, size)], k_n=1e10, friction=0.0, xi=0.0)
    over = foot + place * along + (np.sqrt(0.5) * size + 1e-3) * normal  # its diagonal stands on the slope
    pose = np.array([[*(over - (1.0 + 0.5 * size, 0.5 * size)), np.pi / 4 - slope]])
    speed = -2.0 * normal
    case = mr.MasonryCase(masonry, 1.3e-3)
    run = mr.solve_explicit(case, timestep=1e-6, start=(pose, np.array([[*speed, 0.0]])), output_step=1e-4)
    left = run.velocity[-1, 0, :2] + (0.0, mr.GRAVITY * run.t[-1])
    np.testing.assert_allclose(left, 2.0 * normal, atol=1e-2)


@pytest.mark.slow
def test_a_wall_falls_into_a_heap_and_the_books_close():
    """A push of a second, which topples half of the wall; under a sine of 0.8 s rounding decides what falls."""
    wall = mr.Masonry.running_bond(length=2.0, height=2.0, unit=(0.5, 0.25), k_n=1e9, friction=0.6)
    t = np.arange(0.0, 1.602, 0.002)
    pushed = mr.GroundMotion(np.interp(t, [0.0, 0.05, 0.95, 1.0], [0.0, -8.0, -8.0, 0.0]), 0.002)
    run = mr.solve_explicit(mr.MasonryCase(wall, 1.6, pushed), ledger=True)
    assert 12 <= len(run.fallen) <= 20
    assert np.abs(run.energy_residual).max() < 2e-3 * np.abs(run.ledger.ground).max()
    over_the_ground = np.abs(run.pose[-1, :, 0] + wall.centroids[list(wall.free), 0] - 1.0) < 1.5
    heights = run.pose[-1, :, 1] + wall.centroids[list(wall.free), 1]
    assert heights[over_the_ground].min() > 0.1  # none is in the ground


def test_a_soft_place_that_presses_stays_soft(monkeypatch):
    """A box that lands and slides on is found again and again. The spring that has caught it holds energy, and would
    give back more if it became stiffer."""
    kept, pressed = [], []

    def stable(self, found, *others):
        if pressed:
            kept.append(self.state.share[self.state.pair == pressed[0]].max(initial=0.0))
        pressing = found.gap < 0
        if pressing.any() and not pressed:
            pressed.append(int(self._pair_numbers(found)[pressing][0]))
        return np.full(len(found.gap), 1.0 if pressed else 0.1)

    monkeypatch.setattr(ContactSearch, "_shares", stable)
    masonry = mr.Masonry([GROUND, box(-3, 3, 0, 0.5), box(-0.1, 0.1, 0.501, 0.6)], k_n=1e8, friction=0.1, xi=0.1)
    mr.solve_explicit(mr.MasonryCase(masonry, 0.3, velocity=[(0, 0, 0), (1.0, 0, 0)], settled=False))
    assert kept[:5] == [0.1] * 5  # until it bounces off


def test_a_block_with_a_mass_beside_its_centroid_is_searched_where_it_turns_to():
    """About the centroid that it has with the mass, as its body."""
    masonry = mr.Masonry([GROUND, box(-0.2, 0.2, 0.0, 0.4)], k_n=1e8)
    mass = mr.AddedMass(mass=800.0, height=0.4, block=1)
    setup = setup_of(mr.MasonryCase(masonry, 1.0, effects=(mass,), settled=False), None, None)
    rest, angle = setup.scene.bodies.rest[0], 0.5
    assert rest[1] > 0.25
    setup.system.bodies["angle"] = angle
    posed = setup.search.finder.posed(setup.search.poses(setup.system))
    cos, sin = math.cos(angle), math.sin(angle)
    expected = rest + (masonry.blocks[1].corners - rest) @ np.array([(cos, -sin), (sin, cos)])
    np.testing.assert_allclose(posed.corners[posed.corner[1] :][:4, ::2], expected, atol=1e-12)
