"""Earth on walls: Mononobe and Okabe beside trial wedges, and the factor of safety of a wall against overturning."""

import math
import warnings

import numpy as np
import pytest
from everyday import among

import mjrock as mr

G = mr.GRAVITY
SITES = {
    "at rest": {},
    "rough wall": {"wall_friction": 0.35},
    "slope": {"wall_friction": 0.2, "slope": 0.25},
    "earthquake": {"wall_friction": 0.3, "slope": 0.1, "k_h": 0.2},
    "upwards": {"wall_friction": 0.3, "k_h": 0.25, "k_v": 0.1},
}


def of_wedge(plane, sense, *, phi, H, rho, wall_friction=0.0, slope=0.0, k_h=0.0, k_v=0.0):
    """Force of a wedge of earth on a metre of wall [N/m], that slides down (1) or is pushed up (-1) a plane that rises
    at an angle: equilibrium of the wedge along x and z with the forces on the plane and on the wall."""
    weight = 0.5 * rho * G * H**2 / (math.tan(plane) - math.tan(slope))
    friction, delta = sense * phi, sense * wall_friction
    columns = [[math.cos(delta), -math.sin(plane - friction)], [math.sin(delta), math.cos(plane - friction)]]
    return np.linalg.solve(columns, [sense * k_h * weight, (1 - k_v) * weight])[0]


@pytest.mark.parametrize("name", among(list(SITES), "at rest", "earthquake", "upwards"))
def test_active_and_passive_are_the_worst_of_trial_wedges(name):
    site = SITES[name]
    phi, H, rho = 0.6, 4.0, 1900.0
    earth = mr.EarthPressure(H, phi, rho, **site)
    low = site.get("slope", 0.0)
    planes = np.linspace(low + 1e-3, 1.5, 20001)
    active = max(of_wedge(plane, 1, phi=phi, H=H, rho=rho, **site) for plane in planes)
    assert earth.force == pytest.approx(active, rel=1e-6)
    resisting = [of_wedge(plane, -1, phi=phi, H=H, rho=rho, **site) for plane in planes]
    passive = min(force for force in resisting if force > 0)
    whole = 0.5 * rho * G * H**2 * (1 - earth.k_v)
    assert earth.passive == pytest.approx(passive / whole, rel=1e-6)


def test_rankine():
    earth = mr.EarthPressure(3.0, math.radians(30), 2000.0)
    assert (earth.active, earth.passive) == (pytest.approx(1 / 3), pytest.approx(3.0))
    assert earth.force == pytest.approx(0.5 * 2000 * G * 9 / 3)
    assert earth.level == pytest.approx(1.0)


def test_what_an_earthquake_adds_acts_at_half_the_height():
    still = mr.EarthPressure(3.0, 0.6, wall_friction=0.2)
    shaken = mr.EarthPressure(3.0, 0.6, wall_friction=0.2, k_h=0.2)
    moment = still.force * 1.0 + (shaken.force - still.force) * 1.5
    assert shaken.force * shaken.level == pytest.approx(moment)


def test_a_retaining_wall_by_hand():
    """Moments about the toe: weight at half the thickness, friction of the earth at the whole of it."""
    wall = mr.Block.from_size(1.2, 3.5, 2.0, 2200.0)
    earth = mr.EarthPressure(3.0, 0.6, 1900.0, wall_friction=0.3)
    P = earth.force * 2.0
    held = wall.weight * 0.6
    over = P * math.cos(0.3) * 1.0 - P * math.sin(0.3) * 1.2
    found = mr.collapse_multiplier(mr.Case(wall, 0.0, 1.0), None, loads=earth.on(wall))
    assert found.multiplier == pytest.approx(held / over)
    assert found.moving == ("wall",)
    stands = mr.mechanism_check(
        mr.Case(wall, 0.0, 1.0, effects=earth.on(wall)), mr.code_spectrum("EC8 type 1", ag=1.0, soil="A")
    )
    assert stands.alpha_0 == pytest.approx((held - over) / (wall.weight * 1.75))


def test_a_dam_of_a_text_book():
    """Example 9.1: 5 m at the base, 1.5 m at the top, 8 m high, 22.4 kN/m3, water 7.5 m: 2.67 against overturning."""
    wall = mr.Block.from_size(5.0, 8.0, 1.0, 22.4e3 / G, profile=[(0, 5.0), (8.0, 1.5)])
    water = 0.5 * 10e3 * 7.5**2
    found = mr.collapse_multiplier(mr.Case(wall, 0.0, 1.0), None, loads=(mr.Thrust(2.5, water),))
    assert found.multiplier == pytest.approx(2.67, abs=5e-3)


def test_the_wind_on_a_chimney():
    """18 inches wide and 17.5 feet high; a force at half the height overturns it where their moments are equal."""
    wide, high = 18 * 0.0254, 17.5 * 0.3048
    stack = mr.Block.from_size(wide, high, wide, 1500.0)
    wind = mr.Thrust(high / 2, 1e3)
    case = mr.Case(stack, 0.0, 1.0, side_stop=False)
    assert mr.collapse_multiplier(case, None, loads=(wind,)).multiplier == pytest.approx(
        stack.weight * wide / high / 1e3
    )
    assert mr.collapse_multiplier(case, None, loads=(mr.Thrust(high / 2, -1e3),)).multiplier == (
        pytest.approx(stack.weight * wide / high / 1e3)
    )


def leaning(plumb):
    """A garden wall that tapers from 0.6 to 0.3 m, free both ways, 3 m high."""
    wall = mr.Block.from_size(0.6, 3.0, 1.0, 2000.0, profile=[(0.0, 0.6), (3.0, 0.3)], plumb=plumb)
    return mr.Case(wall, 0.0, 1.0, side_stop=False)


def test_wind_on_a_wall_that_is_free_both_ways_is_warned_of_where_the_other_way_is_weaker():
    """The centroid lies (a^2 + a b + b^2) / 3 (a + b) = 7 / 30 m from the plumb face, W = 0.45 m x 3 m rho g."""
    weight, near = 0.45 * 3.0 * 2000.0 * G, 0.63 / 2.7
    weak, strong = (weight * arm / (2e3 * 1.5) for arm in (near, 0.6 - near))
    for plumb, way in (("outer", 1.0), ("inner", -1.0)):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = mr.collapse_multiplier(leaning(plumb), None, loads=[mr.Thrust(1.5, way * 2e3)])
        assert found.multiplier == pytest.approx(weak)
        with pytest.warns(mr.Implausible, match=f"other way {weak:.4g} times do: check that way too"):
            found = mr.collapse_multiplier(leaning(plumb), None, loads=[mr.Thrust(1.5, -way * 2e3)])
        assert found.multiplier == pytest.approx(strong)
        with pytest.warns(mr.Implausible, match="other way"):
            mr.collapse_multiplier(leaning(plumb), -int(way))
    held = mr.Case(leaning("inner").block, 0.0, 1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # with a side stop there is one way
        mr.collapse_multiplier(held, None, loads=[mr.Thrust(1.5, 2e3)])


def test_a_push_over_of_a_wall_that_is_free_both_ways_is_warned_of_likewise():
    curve, z = mr.pushover(leaning("inner")), leaning("inner").wall.centroid_height
    near = 0.63 / 2.7
    with pytest.warns(mr.Implausible, match=f"inwards the wall starts at {near / z:.4g} g"):
        check = mr.load_check(curve, 0.1)
    assert check.capacity == pytest.approx((0.6 - near) / z)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mr.load_check(mr.pushover(leaning("outer")), 0.1)


def test_beside_blocks_with_ties_masses_and_an_earthquake():
    """The same wall as a block under the same forces, by limit analysis."""
    wall = mr.Block.from_size(0.6, 4.0, 1.0, 1800.0)
    effects = mr.AddedMass(500.0, 4.0, -0.1), mr.Load(5e3, 4.0, 0.1), mr.Tie(3.5, 1e7, strength=4e3, ultimate=0.05)
    case = mr.Case(wall, 0.0, 1.0, effects=effects)
    loads = mr.Thrust(2.5, 2e3), mr.Load(1e3, 4.0, -0.3)
    masonry = mr.Masonry.stack([wall], friction=5.0)
    named = (
        mr.AddedMass(500.0, 4.0, -0.1, block="block_0"), mr.Load(5e3, 4.0, 0.1, block="block_0"),
        mr.Tie(3.5, 1e7, strength=4e3, ultimate=0.05, block="block_0"),
    )  # fmt: skip
    vector = {"block_0": (2e3, -1e3, 2e3 * 0.5 + 1e3 * -0.3)}
    for direction in (None, 1):
        found = mr.collapse_multiplier(case, direction, loads=loads)
        blocks = mr.collapse_multiplier(masonry, direction, loads=vector, effects=named)
        assert found.multiplier == pytest.approx(blocks.multiplier, rel=1e-7)
    assert mr.collapse_multiplier(case, 1).multiplier == pytest.approx(
        mr.collapse_multiplier(masonry, 1, effects=named).multiplier, rel=1e-7
    )
    assert mr.collapse_multiplier(case, -1).multiplier == math.inf  # the side stop holds it


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.EarthPressure(3.0, 0.5, slope=0.6), "slope = 0.6 rad .* slides by itself"),
        (lambda: mr.EarthPressure(3.0, 0.5, k_h=0.6), "k_h = 0.6: the surface of the earth slides by itself"),
        (lambda: mr.EarthPressure(3.0, 0.5, wall_friction=0.6), "wall_friction = 0.6 rad is outside"),
        (lambda: mr.EarthPressure(3.0, 30), "friction_angle = 30 rad is outside the valid range 0.1 to 0.9 rad"),
        (lambda: mr.EarthPressure(3.0, 0.5).on(mr.Block.from_size(0.5, 2.0)), "height of the earth = 3 m is outside"),
    ],
)
def test_refused(make, complaint):
    with pytest.raises(ValueError, match=complaint):
        make()


def test_what_a_case_has_no_place_for():
    case = mr.Case(mr.Block.from_size(0.5, 2.0), 0.0, 1.0)
    for given, complaint in (
        ({"direction": 2}, "direction = 2 is not a direction"),
        ({"direction": None}, "direction = None needs loads"),
        ({"angle": 0.1}, "angle cannot be given for a Case"),
        ({"effects": mr.Load(1e3, 1.0)}, "effects cannot be given for a Case"),
        ({"loads": (mr.Thrust(3.0, 1e3),)}, r"loads\[0\], height = 3 m is outside"),
        ({"loads": (mr.Tie(1.0, 1e6),)}, r"loads\[0\] = .* is not a Thrust or Load"),
        ({"loads": {"wall": (1, 2)}}, "loads = .* is not Thrust, Load or a sequence of them"),
    ):
        with pytest.raises((TypeError, ValueError), match=complaint):
            mr.collapse_multiplier(case, **given)
