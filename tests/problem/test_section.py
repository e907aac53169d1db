"""Openings, tapered walls and added masses: mass, centroid and inertia against sums of plain bodies."""

import math

import numpy as np
import pytest

import mjrock as mr

PLAIN = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0)


def lump(pieces):
    """Mass, centroid (x, z) and inertia about it of rectangles (mass, x, z, width, height)."""
    mass = sum(piece[0] for piece in pieces)
    x, z = (sum(piece[0] * piece[i] for piece in pieces) / mass for i in (1, 2))
    inertia = sum(m * ((w**2 + h**2) / 12 + (px - x) ** 2 + (pz - z) ** 2) for m, px, pz, w, h in pieces)
    return mass, x, z, inertia


def parts(wall):
    return wall.mass, wall.centroid_offset, wall.centroid_height, wall.inertia


def test_openings_are_subtracted():
    openings = [mr.Opening(1.2, 2.1), mr.Opening(1.0, 1.5, 4.0), mr.Opening(0.8, 1.5, 4.5)]
    wall = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, openings=openings)
    pieces = [(1600 * 0.55 * 9 * 6, 0.0, 4.5, 0.55, 9.0)]
    pieces += [(-1600 * 0.55 * o.width * o.height, 0.0, o.sill + o.height / 2, 0.55, o.height) for o in openings]
    np.testing.assert_allclose(parts(wall), lump(pieces), rtol=1e-12, atol=1e-12)
    assert wall.centroid_offset == 0
    assert wall.alpha == math.atan2(0.275, wall.centroid_height)
    assert wall.base_length == pytest.approx(6.0 - 1.2)


def test_storeys_of_different_thickness():
    """The inner face is straight, so that the centroid of a thinner storey lies inwards."""
    wall = mr.Block.from_size(0.6, 6.0, 2.0, 2000.0, profile=[(0, 0.6), (3.5, 0.6), (3.5, 0.4), (6, 0.4)])
    pieces = [(2000 * 2 * 0.6 * 3.5, 0.0, 1.75, 0.6, 3.5), (2000 * 2 * 0.4 * 2.5, -0.1, 4.75, 0.4, 2.5)]
    np.testing.assert_allclose(parts(wall), lump(pieces), rtol=1e-12)
    assert wall.outline.shape == (6, 2)


def test_a_tapering_wall_is_the_limit_of_many_storeys():
    wall = mr.Block.from_size(0.6, 6.0, 2.0, 2000.0, profile=[(0, 0.6), (6, 0.3)])
    heights = (np.arange(2000) + 0.5) * 6 / 2000
    thickness = 0.6 - 0.05 * heights
    pieces = [(2000 * 2 * t * 0.003, -0.3 + t / 2, z, t, 0.003) for z, t in zip(heights, thickness, strict=True)]
    np.testing.assert_allclose(parts(wall), lump(pieces), rtol=1e-6)
    assert wall.mass == pytest.approx(2000 * 2 * 6 * 0.45)


def test_an_opening_in_a_tapering_wall_takes_what_is_there():
    wall = mr.Block.from_size(0.6, 6.0, 2.0, 2000.0, profile=[(0, 0.6), (6, 0.3)], openings=[mr.Opening(0.5, 1, 2)])
    assert wall.mass == pytest.approx(2000 * 2 * 6 * 0.45 - 2000 * 0.5 * (0.6 - 0.05 * 2.5))


def test_added_masses_move_the_centroid():
    masses = [mr.AddedMass(1500.0, 9.0, 0.5), mr.AddedMass(400.0, 3.0, -0.2)]
    wall = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, masses=masses)
    pieces = [(PLAIN.mass, 0.0, 4.5, 0.55, 9.0), (1500.0, 0.5, 9.0, 0.0, 0.0), (400.0, -0.2, 3.0, 0.0, 0.0)]
    np.testing.assert_allclose(parts(wall), lump(pieces), rtol=1e-12)
    case = mr.Case(PLAIN, 0.0, 1.0, effects=masses)
    assert case.wall == wall
    for side in (1, -1):
        d = 0.275 - side * wall.centroid_offset
        assert wall.inertia_about(side) == pytest.approx(wall.inertia + wall.mass * (d**2 + wall.centroid_height**2))
        assert wall.restoring.towards(side).alpha == pytest.approx(math.atan2(d, wall.centroid_height))


def test_a_gable_is_a_rectangle_and_a_triangle():
    """Volumes, first and second moments of a rectangle of 6 x 6 m below a triangle 3 m high, thickness 0.55 m."""
    wall = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, gable=mr.Gable(3.0))
    below, above = 1600 * 0.55 * 36.0, 1600 * 0.55 * 9.0
    mass, z = below + above, (below * 3.0 + above * 7.0) / (below + above)
    inertia = mass * 0.55**2 / 12 + below * (6**2 / 12 + (z - 3) ** 2) + above * (3**2 / 18 + (z - 7) ** 2)
    np.testing.assert_allclose(parts(wall), (mass, 0.0, z, inertia), rtol=1e-13, atol=1e-13)
    assert math.tan(wall.alpha) == pytest.approx(0.275 / z)
    full = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, gable=mr.Gable(3.0, top=6.0))
    np.testing.assert_allclose(parts(full), parts(PLAIN), rtol=1e-13, atol=1e-13)
    assert wall.base_length == 6.0
    assert "gable of 3 m" in repr(wall)


def test_a_trapezium_that_tapers_is_the_limit_of_many_storeys():
    profile = [(0, 0.6), (2, 0.6), (6, 0.4)]
    wall = mr.Block.from_size(0.6, 6.0, 4.0, 2000.0, profile=profile, gable=mr.Gable(3.0, top=1.0))
    z = (np.arange(6000) + 0.5) / 1000
    t, length = np.interp(z, [0, 2, 6], [0.6, 0.6, 0.4]), np.interp(z, [3, 6], [4.0, 1.0])
    pieces = np.column_stack([2000 * length * t * 1e-3, -0.3 + t / 2, z, t, np.full(6000, 1e-3)])
    np.testing.assert_allclose(parts(wall), lump(pieces.tolist()), rtol=1e-6)


@pytest.mark.parametrize("profile", [None, [(0, 0.55), (7, 0.55), (9, 0.45)]], ids=["plain", "tapered across it"])
def test_a_rose_window_is_a_disc(profile):
    """Where the thickness is the same, by the closed form; where it changes, against thin slices."""
    rose = mr.Opening(2.0, 2.0, 6.0, round=True)
    wall = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, openings=[rose], profile=profile)
    bare = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, profile=profile)
    if profile is None:
        assert bare.mass - wall.mass == pytest.approx(1600 * 0.55 * math.pi, rel=1e-13)
        disc = 1600 * 0.55 * math.pi * (0.55**2 / 12 + 1 / 4 + 7.0**2)
        gone = bare.inertia + bare.mass * 4.5**2 - wall.inertia - wall.mass * wall.centroid_height**2
        assert gone == pytest.approx(disc, rel=1e-12)
    z = 6.0 + (np.arange(20000) + 0.5) / 10000
    t, width = np.interp(z, *np.transpose(profile or [(0, 0.55), (9, 0.55)])), 2 * np.sqrt(1 - (z - 7) ** 2)
    mass = 1600 * t * width * 1e-4
    assert bare.mass - wall.mass == pytest.approx(mass.sum(), rel=1e-6)
    assert bare.mass * bare.centroid_height - wall.mass * wall.centroid_height == pytest.approx(mass @ z, rel=1e-6)


@pytest.mark.parametrize(
    ("parts", "complaint"),
    [
        ({"gable": mr.Gable(10.0)}, "gable, height = 10 m is outside the valid range 0.01 to 9 m"),
        ({"gable": mr.Gable(3.0, top=7.0)}, "gable, top = 7 m is outside the valid range 0 to 6 m"),
        ({"gable": 3.0}, "gable = 3.0 of type float is not a Gable or None"),
        (
            {"gable": mr.Gable(3.0), "openings": [mr.Opening(3.0, 1.0, 7.0)]},
            "openings at a height of 7.5 m are 3 m wide together; the valid range is less than 3 m",
        ),
        ({"openings": [mr.Opening(4.0, 4.0, 1.0, round=True), mr.Opening(4.0, 4.0, 3.0, round=True)]}, "wide together"),
    ],
)
def test_gables_and_round_openings_that_cannot_be(parts, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, **parts)


def test_parts_that_change_nothing_leave_the_plain_wall():
    full = mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, profile=[(0, 0.55), (4, 0.55), (9, 0.55)])
    np.testing.assert_allclose(parts(full), parts(PLAIN), rtol=1e-12, atol=1e-12)
    assert (full.alpha, full.R, full.p) == (pytest.approx(PLAIN.alpha), pytest.approx(PLAIN.R), pytest.approx(PLAIN.p))
    np.testing.assert_allclose(full.outline[[0, 1, -1]], PLAIN.outline[[0, 1, -1]], atol=1e-12)


def stopped(wall, velocity, point):
    """Velocity of the centroid and rate of rotation after an impulse has stopped a point (x, z) of the wall."""
    x, z = point
    rates = np.array([[1.0, 0.0, z], [0.0, 1.0, -x]])  # of the point, per unit of (vx, vz, omega)
    inverse = np.diag(1 / np.array([wall.mass, wall.mass, wall.inertia]))
    impulse = np.linalg.solve(rates @ inverse @ rates.T, rates @ velocity)
    return velocity - inverse @ rates.T @ impulse


WALLS = {
    "plain": PLAIN,
    "inset": mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, inset=0.05),
    "openings": mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, openings=[mr.Opening(1.2, 2.1), mr.Opening(2, 2, 5)]),
    "lopsided": mr.Block.from_size(0.55, 9.0, 6.0, 1600.0, masses=[mr.AddedMass(9000.0, 8.0, 0.4)]),
    "tapered": mr.Block.from_size(0.8, 9.0, 6.0, 1600.0, profile=[(0, 0.8), (9, 0.3)]),
}


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("top", [None, 8.0, 6.5, 5.5])
def test_restitution_is_what_impulses_leave(name, top):
    """An impulse at the new edge, or at the highest point of the stop, stops that point: Eqs. 2-3 for any wall."""
    wall = WALLS[name]
    e, x, z = mr.Restitution.from_geometry(wall, top), wall.centroid_offset, wall.centroid_height
    outer, inner = wall.turning(0.0, 1.0), wall.turning(0.0, -1.0)
    after = stopped(wall, outer, (-wall.half_base - x, -z))[2] * math.sqrt(
        wall.inertia_about(-1) / wall.inertia_about(1)
    )
    back = stopped(wall, inner, (wall.half_base - x, -z))[2] * math.sqrt(wall.inertia_about(1) / wall.inertia_about(-1))
    assert e.base == pytest.approx(after, rel=1e-9) == pytest.approx(back, rel=1e-9)
    side = stopped(wall, inner, (-wall.b - x, (9.0 if top is None else top) - z))[2]
    assert e.side == pytest.approx(side, rel=1e-9)


def test_a_low_stop_gives_no_rebound():
    """Below two thirds of the height the momentum carries a slender wall on over the stop."""
    slender = mr.Block.from_size(0.2, 9.0)
    assert mr.Restitution.from_geometry(slender, 6.1).side < 0 < mr.Restitution.from_geometry(slender, 5.9).side
    with pytest.raises(ValueError, match="outside the valid range -1 <= e_1s < 0"):
        mr.solve_analytical(
            mr.Case(slender, 0.005, 1.0, side_stop=mr.SideStop(5.9)), mr.Restitution.from_geometry(slender, 5.9)
        )


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.Opening(-1, 1), "width of the opening = -1 m is outside"),
        (lambda: mr.Opening(1, math.nan), "height of the opening = nan m is outside"),
        (
            lambda: mr.Block(0.3, 2.1, openings=[mr.Opening(0.5, 3.0, 2.0)]),
            r"openings\[0\] reaches from 2 to 5 m; the valid range is 0 to 4.2 m",
        ),
        (
            lambda: mr.Block(0.3, 2.1, openings=[mr.Opening(1.0, 1.0)]),
            "1 m wide together; the valid range is less than 1 m",
        ),
        (
            lambda: mr.Block(0.3, 2.1, openings=[mr.Opening(0.6, 1.0), mr.Opening(0.5, 1.0, 0.5)]),
            "openings at a height of 0.5 m are 1.1 m wide together",
        ),
        (lambda: mr.Block(0.3, 2.1, openings=[1]), r"openings\[0\] = 1 of type int is not a Opening"),
        (lambda: mr.Block(0.3, 2.1, openings=3), "openings = 3 of type int is not a sequence"),
        (lambda: mr.Block(0.3, 2.1, profile=[(0, 0.6), (4, 0.6)]), "profile = .* ends at the height 4.2 m"),
        (lambda: mr.Block(0.3, 2.1, profile=[(0, 0.5), (4.2, 0.6)]), "starts at height 0 with the thickness 0.6 m"),
        (lambda: mr.Block(0.3, 2.1, profile=[(0, 0.6), (4.2, -0.6)]), r"profile\[1\], thickness = -0.6 m is outside"),
        (
            lambda: mr.Block(0.3, 2.1, profile=[(0, 0.6), (3, 0.6), (2, 0.6), (4.2, 0.6)]),
            r"profile\[2\], height = 2 m is",
        ),
        (lambda: mr.Block(0.3, 2.1, profile=[0.6, 0.6]), r"profile\[0\] = 0.6 of type float is not a pair"),
        (lambda: mr.Block(0.3, 2.1, masses=[mr.AddedMass(1.0, 5.0)]), r"masses\[0\], height = 5 m is outside"),
        (lambda: mr.Block(0.3, 2.1, masses=[mr.AddedMass(1.0, 2.0, 4.0)]), r"masses\[0\], offset = 4 m is outside"),
        (
            lambda: mr.Block(0.3, 2.1, masses=[mr.AddedMass(5000.0, 2.0, 1.0)]),
            "the centroid of the wall lies 0.498.* m from the middle of the base; the valid range is less than 0.3 m",
        ),
        (
            lambda: mr.Restitution.from_geometry(PLAIN, 10.0),
            "top of the side stop = 10 m is outside the valid range 0.01 to 9 m",
        ),
        (lambda: mr.Restitution.from_geometry(0.1, 3.0), "a side stop needs the wall"),
    ],
)
def test_parts_that_cannot_be(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()


@pytest.mark.parametrize(("thickness", "taken"), [(9e-4, False), (1e-3, True), (20.0, True), (20.1, False)])
def test_a_profile_has_a_thickness_of_a_millimetre_to_twenty_metres(thickness, taken):
    parts = {"thickness": 20.0, "height": 40.0, "profile": [(0, 20.0), (40.0, thickness)]}
    if taken:
        assert mr.Block.from_size(**parts).profile[1] == (40.0, thickness)
        return
    with pytest.raises(ValueError, match=r"profile\[1\], thickness = .* is outside the valid range 0.001 to 20 m"):
        mr.Block.from_size(**parts)
