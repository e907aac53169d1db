"""Walls with setbacks inside: the outer face is plumb, and each number follows from rectangles added up in the test."""

import math
import re
import warnings

import numpy as np
import pytest

import mjrock as mr
from mjrock.scene.wall import wall_scene

T0, T1, STEP, HEIGHT = 0.60, 0.45, 3.2, 9.6
PROFILE = [(0, T0), (STEP, T0), (STEP, T1), (HEIGHT, T1)]
AREAS, LEVELS = np.array([T0 * STEP, T1 * (HEIGHT - STEP)]), np.array([STEP / 2, (STEP + HEIGHT) / 2])
BEHIND = np.array([T0 / 2, T1 / 2])  # of the centroids of both storeys, from the outer face
ALPHA_0 = (AREAS @ BEHIND) / (AREAS @ LEVELS)


def setback(**options):
    return mr.Block.from_size(T0, HEIGHT, profile=PROFILE, plumb="outer", **options)


def test_the_multiplier_is_that_of_two_storeys_about_the_outer_edge():
    assert pytest.approx(0.0569, abs=5e-5) == ALPHA_0
    wall = setback()
    assert mr.pushover(mr.Case(wall, 0.0, 1.0)).start == pytest.approx(ALPHA_0, rel=1e-12)
    assert math.tan(wall.alpha) == pytest.approx(ALPHA_0, rel=1e-12)
    assert wall.mass == pytest.approx(2000 * AREAS.sum())
    x, z = T0 / 2 - AREAS @ BEHIND / AREAS.sum(), AREAS @ LEVELS / AREAS.sum()
    about = sum(
        2000 * area * ((t**2 + h**2) / 12 + (T0 / 2 - behind - x) ** 2 + (level - z) ** 2)
        for area, t, h, behind, level in zip(AREAS, (T0, T1), (STEP, HEIGHT - STEP), BEHIND, LEVELS, strict=True)
    )
    np.testing.assert_allclose((wall.centroid_offset, wall.centroid_height, wall.inertia), (x, z, about), rtol=1e-12)
    assert mr.mechanism_check(mr.Case(wall, 0.0, 1.0), mr.code_spectrum("EC8 type 1", ag=1.0, soil="A")).alpha_0 == (
        pytest.approx(ALPHA_0, rel=1e-12)
    )


@pytest.mark.parametrize("parts", [{}, {"gable": mr.Gable(2.0), "openings": [mr.Opening(0.3, 2.0, 2.0)]}])
def test_it_is_the_mirror_image_of_a_wall_that_is_plumb_inside(parts):
    inside, outside = mr.Block.from_size(T0, HEIGHT, profile=PROFILE, **parts), setback(**parts)
    assert outside.centroid_offset == pytest.approx(-inside.centroid_offset, rel=1e-13)
    np.testing.assert_allclose(outside.restoring, inside.restoring[::-1], rtol=1e-13)
    assert outside.inertia == pytest.approx(inside.inertia, rel=1e-13)
    mirrored = inside.outline * (-1, 1)
    np.testing.assert_allclose(sorted(outside.outline.tolist()), sorted(mirrored.tolist()), atol=1e-12)
    x, z = outside.outline.T
    assert 0.5 * (x * np.roll(z, -1) - z * np.roll(x, -1)).sum() == pytest.approx(AREAS.sum())


def test_it_turns_about_the_outer_edge_until_its_centroid_stands_above_it():
    wall = setback()
    x, z, _ = wall.pose([wall.alpha])[0] + (wall.centroid_offset, wall.centroid_height, 0)
    assert (x, z) == pytest.approx((T0 / 2, wall.R))


def test_a_tie_holds_the_inner_face_where_that_is():
    """Its lever about the outer edge at rest is its height, and at a rotation that of the point that it holds."""
    tie = mr.Tie(8.0, 1e7, length=4.0)
    case = mr.Case(setback(), 0.0, 1.0, effects=tie)
    np.testing.assert_allclose(case.held_by(tie), (T0 / 2 - T1, 8.0))
    np.testing.assert_allclose(
        mr.Case(setback(), 0.0, 1.0, effects=mr.Tie(1.0, 1e7)).held_by(mr.Tie(1.0, 1e7)), (-0.3, 1)
    )
    arm = np.array([-T1, 8.0])  # from the outer edge to the point

    def elongation(theta):
        turned = (
            arm[0] * math.cos(theta) + arm[1] * math.sin(theta),
            arm[1] * math.cos(theta) - arm[0] * math.sin(theta),
        )
        return math.hypot(turned[0] - arm[0] + 4.0, turned[1] - arm[1]) - 4.0

    rate = (elongation(0.03 + 1e-5) - elongation(0.03 - 1e-5)) / 2e-5
    found = case.pulls[0].moment(np.array([0.03]))[0]
    assert found == pytest.approx(1e7 * elongation(0.03) * rate, rel=1e-8)  # by virtual work


def test_the_side_stop_lies_behind_every_storey():
    wall = setback()
    case = mr.Case(wall, 0.0, 1.0)
    side = case.rest_geometry.solids[2]
    assert [part.corners[:, 0].max() for part in side.drawn] == pytest.approx([-0.3, -0.15])
    volume = sum(part.bulk.volume for part in side.drawn)
    assert volume == pytest.approx((0.9 - 0.3) * STEP + (0.9 - 0.15) * (HEIGHT - STEP))
    assert mr.Case(wall, 0.0, 1.0, side_stop=mr.SideStop(2.0)).rest_geometry.solids[2].drawn[0].bulk.volume == (
        pytest.approx(0.6 * 2.0)
    )


def test_the_impact_on_the_stop_keeps_the_momentum_about_its_highest_point():
    """The wall comes down about its inner edge of the base with a rate of 1; the stop ends at its face at the top."""
    wall = setback()
    x, z, inertia, m = wall.centroid_offset, wall.centroid_height, wall.inertia, wall.mass
    point = np.array([T0 / 2 - T1, HEIGHT])
    arm, edge = np.array([x, z]) - point, np.array([x, z]) - (-T0 / 2, 0.0)
    velocity = np.array([edge[1], -edge[0]])  # of the centroid, turning outwards with 1 rad/s about the inner edge
    momentum = inertia + m * (velocity[0] * arm[1] - velocity[1] * arm[0])
    after = momentum / (inertia + m * arm @ arm)
    assert mr.Restitution.from_geometry(wall).side == pytest.approx(after, rel=1e-12)


def contacts_of(wall):
    with warnings.catch_warnings(action="ignore"):
        return mr.Contacts.from_law(wall, mr.Restitution(0.95, -0.45), 1e9, 1e9)


def test_the_model_has_its_points_and_ties_on_the_inner_face():
    wall = setback()
    case = mr.Case(wall, 0.3 * wall.alpha, 0.35, effects=mr.Tie(8.0, 2e5, length=4.0))
    scene = wall_scene(case, contacts_of(wall))
    rest = scene.bodies.rest[0]
    assert scene.links.at[0] + rest == pytest.approx([-0.15, 8.0])
    side = scene.contacts.joint == 1
    np.testing.assert_allclose((scene.contacts.at + rest)[side], [(-0.3, 0.0), (-0.15, HEIGHT)], atol=1e-12)
    np.testing.assert_allclose(scene.contacts.face_at[side, 0], [-0.3, -0.15])
    planes = dict(
        re.findall(r'geom name="(side\w*)" type="plane" .*?pos="(\S+) ', mr.mjcf_of(case, contacts_of(wall), 1e-3))
    )
    assert {name: round(float(x), 3) for name, x in planes.items()} == {"side": -0.3, "side_face_1": -0.15}


@pytest.mark.slow
def test_mujoco_scipy_and_plain_models_agree_on_its_rebound():
    """In plain models MuJoCo finds the contacts of the wall with the stop behind its storeys."""
    wall = setback()
    case, contacts = mr.Case(wall, 0.3 * wall.alpha, 2.0), contacts_of(wall)
    motion, second = mr.simulate(case, contacts), mr.solve_compliant(case, contacts)
    assert motion.theta.min() > -1e-2 * wall.alpha
    assert second.peaks[1] == pytest.approx(motion.peaks[1], rel=0.06)
    plain = mr.simulate(case, contacts, 1e-4, collisions=True)
    assert plain.peaks[1] == pytest.approx(motion.peaks[1], rel=0.06)


@pytest.mark.parametrize("solver", ["analytical", "MuJoCo"])
def test_in_the_reversed_motion_it_is_the_mirror_image_of_a_wall_that_is_plumb_inside(solver):
    motion = mr.GroundMotion(-3.0 * np.sin(np.linspace(0, 2 * math.pi, 101)), 0.01)
    found = []
    for plumb, pulse in (("outer", motion), ("inner", motion.reversed())):
        wall = mr.Block.from_size(T0, HEIGHT, profile=PROFILE, plumb=plumb)
        case = mr.Case(wall, 0.0, 1.2, side_stop=False, motion=pulse)
        if solver == "MuJoCo":
            contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
            found.append(mr.simulate(case, contacts, 1e-3).theta)
        else:
            found.append(mr.solve_analytical(case, mr.Restitution(0.95, -0.4)).theta)
    assert np.abs(found[0]).max() > 0.1 * setback().alpha
    np.testing.assert_allclose(found[0], -found[1], atol=1e-9)


@pytest.mark.parametrize("plumb", ["inner", "outer"])
def test_a_stack_of_it_is_a_unit_of_rectangles(plumb):
    wall = mr.Block.from_size(T0, HEIGHT, profile=PROFILE, plumb=plumb)
    masonry = mr.Masonry.stack([wall], k_n=1e9, friction=5.0)
    unit = masonry.blocks[1]
    assert (unit.mass, unit.inertia) == pytest.approx((wall.mass, wall.inertia))
    outwards, inwards = (mr.collapse_multiplier(masonry, way).multiplier for way in (1, -1))
    x = T0 - AREAS @ BEHIND / AREAS.sum()  # from the face that is not plumb
    ways = (ALPHA_0, x / wall.centroid_height)
    assert (outwards, inwards) == pytest.approx(ways if plumb == "outer" else ways[::-1], rel=1e-9)


def test_a_storey_on_top_stands_on_what_is_there():
    top = mr.Block.from_size(0.2, 1.0)
    masonry = mr.Masonry.stack([mr.Block.from_size(T0, HEIGHT, profile=PROFILE, plumb="outer"), top], k_n=1e9)
    joint = masonry.joints[1]
    assert sorted((joint.start[0], joint.end[0])) == pytest.approx([-0.1, 0.1])
    assert joint.start[1] == pytest.approx(HEIGHT)


def test_what_is_neither_face_is_refused():
    with pytest.raises(ValueError, match="plumb = 'middle'"):
        mr.Block.from_size(T0, HEIGHT, profile=PROFILE, plumb="middle")


def test_the_stop_of_a_stack_lies_behind_every_storey_and_clear_of_the_ledge():
    """The inner end of the ledge rises to hypot(0.6, 3.2) m as the wall turns about its outer edge."""
    masonry = mr.Masonry.stack([setback()], k_n=1e9, friction=0.7, side_stop=True)
    lower, upper = masonry.blocks[-1].parts
    clear = math.hypot(T0, STEP)
    assert lower.corners.max(axis=0) == pytest.approx((-T0 / 2, clear))
    assert upper.corners.max(axis=0) == pytest.approx((T0 / 2 - T1, HEIGHT))
    assert upper.corners[:, 1].min() == pytest.approx(clear)
    sides = {joint.name: joint for joint in masonry.joints if "side" in joint.name}
    ends = [sorted((tuple(one.start), tuple(one.end))) for one in sides.values()]
    assert ends[0] == [pytest.approx((-0.15, clear)), pytest.approx((-0.15, HEIGHT))]
    assert ends[1] == [pytest.approx((-0.3, 0.0)), pytest.approx((-0.3, STEP))]
    low = mr.Masonry.stack([setback()], k_n=1e9, friction=0.7, side_stop=mr.SideStop(2.0)).blocks[-1]
    assert sorted(low.corners.tolist()) == [[-0.6, 0.0], [-0.6, 2.0], [-0.3, 0.0], [-0.3, 2.0]]


@pytest.mark.parametrize(
    ("widths", "faces"),
    [((0.6, 0.4, 0.3), (-0.3, -0.2, -0.15)), ((0.4, 0.6, 0.4), (-0.3, -0.3, -0.2)), ((0.5, 0.5, 0.5), (-0.25,))],
    ids=["thinner", "wider in the middle", "alike"],
)
def test_the_stop_of_blocks_follows_them_and_bears_none(widths, faces):
    """A block that stands out over the one below would rest on a stop beneath it."""
    masonry = mr.Masonry.stack([mr.Block.from_size(t, 1.0) for t in widths], k_n=1e9, friction=0.7, side_stop=True)
    side = masonry.blocks[-1]
    assert sorted({float(part.corners[:, 0].max()) for part in side.parts}) == sorted(set(faces))
    assert not [joint for joint in masonry.joints if "side" in joint.name and joint.is_bed]
    met = {joint.name for joint in masonry.joints if "side" in joint.name}
    wide = [-0.5 * t for t in widths]
    behind = faces if len(faces) > 1 else faces * 3
    assert met == {f"side|block_{i}" for i, (own, face) in enumerate(zip(wide, behind, strict=True)) if own == face}


def test_a_run_reports_that_both_storeys_meet_the_stop():
    """A wall that comes back from a small rotation, beside the same wall as a case in MuJoCo."""
    wall = setback()
    masonry = mr.Masonry.stack([wall], k_n=1e9, friction=5.0, xi=0.05, frequency=20.0, side_stop=True)
    case = mr.MasonryCase(masonry, 0.9, velocity=[0.03 * wall.turning(0.0, 1.0)])
    response = mr.solve_explicit(case, forces=True)
    theta, side = response.pose[:, 0, 2], [i for i, name in enumerate(response.forces.joints) if "side" in name]
    struck = response.forces.normal[:, side]
    assert len(side) == 2
    assert (struck.max(axis=0) > 1e3).all()  # and none before it has come back
    assert struck[100 : int(theta.argmax())].max() == 0.0
    np.testing.assert_allclose(struck.sum(axis=1), response.reactions["side"][:, 0], atol=1e-6)
    contacts = mr.Contacts.from_damping(wall, k_base=1e9, xi_base=0.05, k_side=1e9, xi_side=0.05, friction=5.0)
    other = mr.simulate(mr.Case(wall, 0.0, 0.9, omega0=0.03), contacts)
    assert theta.max() == pytest.approx(other.theta.max(), rel=0.02)
    assert np.abs(theta[-100:]).max() < 0.1 * theta.max()  # the impact takes most of it, as in MuJoCo
    assert np.abs(other.theta[-100:]).max() < 0.1 * theta.max()


def test_wedges_reach_up_to_the_inner_face_behind_the_ledge():
    """A triangle from the inner edge of the base and a strip of 0.15 m above the ledge, up to 8 m."""
    wall, angle, q, t = setback(length=6.0), math.radians(20), 8.0, 0.4
    parts = mr.Wedge(angle, t, q, number=2).behind(wall)
    p, deep, high = q * math.tan(angle), T0 - T1, q - STEP
    area = np.array([p * q / 2, deep * high])
    x = np.array([-T0 / 2 - p / 3, -T0 / 2 + deep / 2])
    z = np.array([2 * q / 3, STEP + high / 2])
    own = area * np.array([(p**2 + q**2) / 18, (deep**2 + high**2) / 12])
    mass = sum(part.mass for part in parts)
    assert mass == pytest.approx(2 * 2000 * t * area.sum())
    assert sum(part.mass * part.offset for part in parts) == pytest.approx(2 * 2000 * t * (area @ x))
    assert sum(part.mass * part.height for part in parts) == pytest.approx(2 * 2000 * t * (area @ z))
    about = sum(part.mass * (part.offset**2 + part.height**2) for part in parts)
    assert about == pytest.approx(2 * 2000 * t * (own + area * (x**2 + z**2)).sum())
    case = mr.Case(wall, 0.0, 1.0, effects=parts)
    facade = 2000 * 6.0 * AREAS
    lever = facade @ BEHIND + 2 * 2000 * t * (area @ (T0 / 2 - x))
    hand = lever / (facade @ LEVELS + 2 * 2000 * t * (area @ z))
    assert mr.pushover(case).start == pytest.approx(hand, rel=1e-12)
    x, z = parts[0].outline.T
    assert abs(0.5 * (x * np.roll(z, -1) - z * np.roll(x, -1)).sum()) == pytest.approx(area.sum())
    plain = mr.Wedge(angle, t, q).behind(mr.Block.from_size(T0, HEIGHT, 6.0))
    middle = -T0 / 2 - p / 3
    assert [one.offset - middle for one in plain] == pytest.approx(
        [way * math.hypot(p, q) / math.sqrt(18) for way in (-1, 1)]
    )
