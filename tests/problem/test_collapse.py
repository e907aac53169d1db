"""Limit analysis: the multiplier of collapse in any plan direction, and what falls in space."""

import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.masonry.effects import applied
from mjrock.problem.masonry.limit.statics import falling, friction_lacking, slippery

box = mr.Polyhedron.box
GROUND = box((8, 8, 1), (0, 0, -0.5), fixed=True, name="ground")
B, T, H = 0.6, 0.4, 2.0


@pytest.mark.parametrize("degrees", [0, 10, 30, 45, 60, 90, 200, -45])
def test_a_box_overturns_about_an_edge(degrees):
    """b/(h cos) about one edge, t/(h sin) about the other, whichever is less; it turns with its top along the force."""
    angle = math.radians(degrees)
    c, s = abs(math.cos(angle)), abs(math.sin(angle))
    expected = min(side / (H * share) for side, share in ((B, c), (T, s)) if share > 1e-9)
    collapse = mr.collapse_multiplier(mr.Masonry.box((B, T, H), friction=0.9), angle=angle)
    assert collapse.multiplier == pytest.approx(expected, rel=1e-9)
    assert collapse.moving == ("block",)
    assert collapse.motion[0, :3] @ collapse.direction == pytest.approx(1.0)
    assert collapse.motion[0, 2] > 0.1  # an overturning block rises
    assert np.cross(collapse.motion[0, 3:], [0, 0, 1]) @ collapse.direction > 0


@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0])
def test_a_box_slides_at_its_friction(angle):
    collapse = mr.collapse_multiplier(mr.Masonry.box((B, T, H), friction=0.13), angle=angle)
    assert collapse.multiplier == pytest.approx(0.13, rel=1e-9)
    assert np.abs(collapse.motion[0, 3:]).max() < 1e-9


def test_an_arch_has_the_same_multiplier_in_the_plane_and_in_space():
    plane = mr.Masonry.arch(5.0, 0.9, voussoirs=9, k_n=1e9, xi=0)
    space = mr.Masonry([mr.Polyhedron.prism(block) for block in plane.blocks], k_n=1e9, xi=0)
    for direction in (1, -1):
        collapse = mr.collapse_multiplier(plane, direction)
        in_space = mr.collapse_multiplier(space, direction)
        assert 0.2 < collapse.multiplier < 0.3
        assert in_space.multiplier == pytest.approx(collapse.multiplier, rel=1e-9)
        assert in_space.moving == collapse.moving


def test_a_facade_overturns_from_return_walls_that_are_not_bonded_to_it():
    """Mechanism A of D'Ayala and Speranza, Earthquake Spectra 19 (2003) 479: thickness over height, outwards alone."""
    facade = box((0.5, 4.0, 6.0), (0.25, 0, 3.0), name="facade")
    walls = [box((3.0, 0.5, 6.0), (-1.5, y, 3.0), name=f"wall {y:g}") for y in (-1.75, 1.75)]
    masonry = mr.Masonry([GROUND, facade, *walls], xi=0, friction=lambda joint: 0.7 if joint.is_bed else 0.0)
    outwards = mr.collapse_multiplier(masonry, (1, 0))
    assert outwards.multiplier == pytest.approx(0.5 / 6.0, rel=1e-9)
    assert outwards.moving == ("facade",)
    assert mr.collapse_multiplier(masonry, -1).multiplier > 3 * outwards.multiplier


def test_a_header_binds_a_facade_to_a_return_wall_by_friction():
    """By hand: the facade slides on smooth ground, and a header that lies on it goes along, out of the return wall. The
    return wall holds by mu N, and N is largest where the header stands on the outer edge of the facade."""
    mu, t, high, reach, inner = 0.6, 0.6, 0.5, 1.2, 1.15
    facade = box((t, 1.0, 1.0), (-0.5 * t, 0, 0.5), name="facade")
    wall = box((1.0, 1.0, 1.0), (-inner - 0.5, 0, 0.5), name="return", fixed=True)
    header = box((reach, 1.0, high), (-0.5 * reach, 0, 1.0 + 0.5 * high), name="header")
    masonry = mr.Masonry([GROUND, facade, wall, header], xi=0, friction=lambda j: mu * ("header" in j.name))
    found = mr.collapse_multiplier(masonry, (1, 0))
    w, W = header.mass, facade.mass
    # N inner = w reach / 2 - multiplier w high / 2 about that edge, and multiplier (W + w) = mu N
    assert found.multiplier == pytest.approx(mu * w * 0.5 * reach / inner / (W + w + mu * w * 0.5 * high / inner))
    assert set(found.moving) == {"facade", "header"}


def test_what_nothing_moves_has_an_infinite_multiplier():
    stops = [box((1, 1, 1), (x, 0, 0.5), fixed=True) for x in (-1, 1)]
    masonry = mr.Masonry([GROUND, *stops, box((1, 1, 1), (0, 0, 0.5))], xi=0, friction=lambda j: 0.7 * j.is_bed)
    collapse = mr.collapse_multiplier(masonry, 1)
    assert collapse.multiplier == math.inf
    assert collapse.moving == ()
    assert mr.collapse_multiplier(masonry, (0, 1)).multiplier == pytest.approx(0.7)


def test_a_block_that_overhangs_falls_and_a_load_holds_it():
    masonry = mr.Masonry([GROUND, box((1, 1, 1), (0, 0, 0.5)), box((1, 1, 1), (0.6, 0, 1.5), name="top")], xi=0)
    assert falling(masonry) == ("top",)
    assert friction_lacking(masonry) is None
    # the weight acts 0.1 m beyond the edge, and the load 0.4 m within it
    for share, falls in ((0.249, ("top",)), (0.251, ())):
        load = mr.Load(share * 2000 * mr.GRAVITY, at=(0.1, 0.0, 2.0), block=2)
        assert falling(masonry, applied(masonry, (load,))) == falls
    with pytest.raises(ValueError, match="cannot stand: top would fall"):
        mr.collapse_multiplier(masonry)


def wedge(friction):
    """A block on a plane that slopes by tan = 0.5 along y."""
    slope = mr.Polygon([(0, 0), (2, 0), (2, 1)], length=2.0, fixed=True)
    block = mr.Polygon([(0.8, 0.4), (1.2, 0.6), (1.1, 0.8), (0.7, 0.6)], length=0.4)
    turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    blocks = [mr.Polyhedron(mr.Polyhedron.prism(p).corners @ turn.T, fixed=p.fixed) for p in (slope, block)]
    return mr.Masonry(blocks, friction=friction, xi=0)


def test_a_block_on_a_slope_needs_its_tangent():
    assert falling(wedge(0.51)) == ()
    assert falling(wedge(0.45)) == ("block_1",)
    lacking, joints = friction_lacking(wedge(0.1))
    assert 0.5 <= lacking <= 0.5 / math.cos(math.pi / 8) + 1e-3
    assert joints == ("block_0|block_1",)
    assert slippery(wedge(0.0)) == (("block_1",), ("block_0|block_1",))
    assert slippery(wedge(0.1)) == ((), ())


@pytest.mark.parametrize(("degrees", "share"), [(0.0, 1.0), (45.0, 1.0), (22.5, math.cos(math.pi / 8))])
def test_eight_edges_stand_for_the_cone_of_friction(degrees, share):
    slab = mr.Masonry.box((B, B, 0.1), friction=0.3)
    way, weight = math.radians(degrees), slab.blocks[1].mass * mr.GRAVITY
    for of_it, falls in ((0.999, ()), (1.001, ("block",))):
        push = of_it * share * 0.3 * weight
        assert falling(slab, [[push * math.cos(way), push * math.sin(way), 0, 0, 0, 0]]) == falls


@pytest.mark.slow
def test_the_least_thickness_of_a_dome():
    """Heyman, The Stone Skeleton (1995): a hemisphere stands from t/R = 0.042 on."""
    for share, stands in ((0.041, False), (0.0415, False), (0.0425, True)):
        dome = mr.Masonry.dome(5.0, share * 5.0, 16, 14, xi=0, friction=0.9)
        assert (falling(dome) == ()) == stands


def test_the_least_thickness_of_a_coarse_dome():
    """The thresholds of 12 lunes and 9 hoops lie beside 0.042; 6 and 5 are quick."""
    for share, stands in ((0.035, False), (0.045, True)):
        assert (falling(mr.Masonry.dome(5.0, share * 5.0, 6, 5, xi=0, friction=0.9)) == ()) == stands


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (
            {"direction": 0.5},
            "direction = 0.5 of type float is not a direction; the valid ones are 1 or -1, or a vector",
        ),
        ({"direction": (0, 0)}, "has a length of 0"),
        ({"direction": (1, 0, 0)}, "is not a direction"),
        ({"angle": 7.0}, "angle = 7 rad is outside the valid range"),
        ({"direction": "x"}, "direction = 'x'"),
    ],
)
def test_directions_are_checked(arguments, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.collapse_multiplier(mr.Masonry.box((B, T, H)), **arguments)


def test_the_plane_has_two_directions():
    stack = mr.Masonry.stack([mr.Block(0.3, 1.0)], 1e8)
    assert mr.collapse_multiplier(stack, -1).multiplier == pytest.approx(0.3)
    with pytest.raises(ValueError, match=r"angle = .* is for masonry in space"):
        mr.collapse_multiplier(stack, angle=0.0)
    with pytest.raises(ValueError, match=r"the valid ones are 1 or -1$"):
        mr.collapse_multiplier(stack, (1, 0))
