"""Units of several convex parts: mass, surface, joints, limit analysis, rest, and what is refused."""

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr

L_UNIT = mr.Compound([box(0, 1, 0, 3), box(1, 2, 0, 1)], name="L")
U_UNIT = mr.Compound([box(0, 1, 0, 2), box(2, 3, 0, 2), box(0, 3, 2, 3)], name="U")


def in_space(block):
    return mr.Compound.prism(block) if isinstance(block, mr.Compound) else mr.Polyhedron.prism(block)


def test_mass_centroid_and_inertia_are_those_of_a_square_less_a_square():
    """A U is a square of 3 m less a slot of 1 m by 2 m, whose second moment is b h^3 / 12 about its middle."""
    area, z = 9 - 2, (9 * 1.5 - 2 * 1.0) / 7
    polar = 3**4 / 6 + 9 * (1.5 - z) ** 2 - (1 * 2 * (1 + 4) / 12 + 2 * (1.0 - z) ** 2)
    for unit, axes in ((U_UNIT, (1.5, z)), (in_space(U_UNIT), (1.5, 0, z))):
        assert unit.mass == pytest.approx(2000 * area)
        np.testing.assert_allclose(unit.centroid, axes, atol=1e-12)
        about_y = unit.inertia[1, 1] if unit.in_space else unit.inertia
        assert about_y == pytest.approx(2000 * polar)
    assert in_space(U_UNIT).inertia[0, 0] == pytest.approx(
        2000 * (9 * (9 + 1) / 12 + 9 * (1.5 - z) ** 2 - 2 * (4 + 1) / 12 - 2 * (1 - z) ** 2)
    )


def test_densities_of_parts_move_the_centroid():
    unit = mr.Compound([box(0, 1, 0, 1, density=3000.0), box(1, 2, 0, 1, density=1000.0)])
    np.testing.assert_allclose(unit.centroid, (0.75, 0.5))
    assert unit.inertia == pytest.approx(4000 / 6 + 3000 * 0.25**2 + 1000 * 0.75**2)


def test_the_surface_does_not_know_the_cut():
    other = mr.Compound([box(0, 1, 1, 3), box(0, 2, 0, 1)], name="L")
    third = mr.Compound([box(0, 0.4, 0, 1), box(0.4, 2, 0, 1), box(0, 1, 1, 3)], name="L")
    for unit in (L_UNIT, other, third):
        ends = {tuple(side.corners.ravel().tolist()) for side in unit.sides}
        assert ends == {(0, 0, 2, 0), (2, 0, 2, 1), (2, 1, 1, 1), (1, 1, 1, 3), (1, 3, 0, 3), (0, 3, 0, 0)}
        assert unit.corners.shape == (6, 2)
        (joint,) = mr.Masonry([GROUND, unit]).joints
        assert (joint.start, joint.end) == ((0, 0), (2, 0))
        (deep,) = mr.Masonry([in_space(GROUND), in_space(unit)]).joints
        assert deep.area == pytest.approx(2)
        assert deep.width == pytest.approx(1)


def test_a_frame_has_an_outline_that_goes_round_its_hole():
    frame = mr.Compound([box(0, 3, 0, 1), box(0, 3, 2, 3), box(0, 1, 1, 2), box(2, 3, 1, 2)])
    assert len(frame.sides) == 8
    x, z = frame.corners.T
    assert 0.5 * (x * np.roll(z, -1) - z * np.roll(x, -1)).sum() == pytest.approx(8)


@pytest.mark.parametrize("turn", [lambda block: block, in_space])
def test_an_l_on_its_foot_tilts_about_either_edge(turn):
    """Its weight acts 0.75 m from the heel and 1.25 m from the toe, 1.25 m up."""
    masonry = mr.Masonry([turn(GROUND), turn(L_UNIT)], friction=2.0)
    ways = ((1, 0), (-1, 0)) if masonry.in_space else (1, -1)
    found = [mr.collapse_multiplier(masonry, way).multiplier for way in ways]
    np.testing.assert_allclose(found, [1.25 / 1.25, 0.75 / 1.25], rtol=1e-9)


@pytest.mark.parametrize("turn", [lambda block: block, in_space])
def test_a_u_over_a_sill_stands_on_both_feet_and_the_sill_is_free_of_it(turn):
    masonry = mr.Masonry([turn(GROUND), turn(U_UNIT), turn(box(1.2, 1.8, 0, 1.5, name="sill"))], k_n=1e9)
    assert [joint.name for joint in masonry.joints] == ["ground|U", "ground|U (2)", "ground|sill"]
    case = mr.MasonryCase(masonry, 0.05)
    run = mr.solve_explicit(case, forces=True)
    np.testing.assert_allclose(run.forces.normal[0], np.array([7000, 7000, 1800]) * mr.GRAVITY, rtol=1e-6)
    assert run.outcome is mr.Outcome.AT_REST
    assert run.stats["overlap"] == 0


def test_a_hook_hangs_on_a_wall_and_leans_against_it_below():
    """Its weight acts beside the wall that it hangs on, and turns it against the wall. The push against the wall and
    the friction on its top, 4 m up, make the couple that balances this."""
    wall = box(-1, 0, 0, 4, fixed=True, name="wall")
    hook = mr.Compound([box(-0.5, 0, 4, 4.5), box(0, 0.5, 2, 4.5)], name="hook")
    masonry = mr.Masonry([wall, hook], k_n=1e9, friction=lambda joint: 0.7 if joint.is_bed else 0.0, points=2)
    assert [joint.name for joint in masonry.joints] == ["wall|hook", "wall|hook (2)"]
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.05), forces=True)
    vertical = [j for j, joint in enumerate(masonry.joints) if joint.is_bed]
    assert run.forces.normal[0, vertical[0]] == pytest.approx(hook.mass * mr.GRAVITY, rel=1e-6)
    beside = 1 - vertical[0]
    assert run.forces.normal[0, beside] > 100
    assert abs(run.forces.shear[0, vertical[0]]) == pytest.approx(run.forces.normal[0, beside], rel=1e-4)
    assert run.outcome is mr.Outcome.AT_REST
    (x, _), (_, z) = (
        masonry.joints[j].middle + run.forces.eccentricity[0, j] * masonry.joints[j].along
        for j in (vertical[0], beside)
    )
    couple = run.forces.normal[0, beside] * (4 - z)
    assert couple == pytest.approx(hook.mass * mr.GRAVITY * (hook.centroid[0] - x), rel=1e-4)


@pytest.mark.parametrize("turn", [lambda block: block, in_space])
def test_mujoco_and_explicit_steps_rest_alike(turn):
    masonry = mr.Masonry([turn(GROUND), turn(L_UNIT), turn(box(1, 2, 1, 2, name="on"))], k_n=1e9)
    case = mr.MasonryCase(masonry, 0.05)
    rest = [solve(case).pose[-1] for solve in (mr.simulate, mr.solve_explicit)]
    np.testing.assert_allclose(rest[0], rest[1], atol=1e-9)
    assert {joint.name for joint in masonry.joints} == {"ground|L", "L|on"} | {j.name for j in masonry.joints}


def test_what_a_compound_refuses():
    for parts, error, match in (
        ([box(0, 1, 0, 1)], ValueError, "2 to 1000"),
        ([box(0, 1, 0, 1), box(2, 3, 0, 1)], ValueError, "part 1 hangs together with part 0 along no edge"),
        ([box(0, 1, 0, 1), box(1, 2, 1, 2)], ValueError, "along no edge"),
        ([box(0, 1, 0, 1), box(0.5, 2, 0, 1)], ValueError, "part_0 and part_1 overlap by 0.5 m"),
        ([box(0, 1, 0, 1), box(1, 2, 0, 1, fixed=True)], ValueError, r"parts\[1\] is fixed"),
        ([box(0, 1, 0, 1), mr.Polyhedron.prism(box(1, 2, 0, 1))], TypeError, "parts of one kind"),
        ([box(0, 1, 0, 1), 3], TypeError, r"parts\[1\] = 3"),
        ("ab", TypeError, "not a list of blocks"),
    ):
        with pytest.raises(error, match=match):
            mr.Compound(parts)
    with pytest.raises(TypeError, match="give blocks of one kind"):
        mr.Masonry([GROUND, in_space(L_UNIT)])
    with pytest.raises(ValueError, match="blocks L and block_2 overlap"):
        mr.Masonry([GROUND, L_UNIT, box(1.5, 2.5, 0.5, 1.5)])


def test_files_of_convex_blocks_refuse_it_by_name(tmp_path):
    masonry = mr.Masonry([in_space(GROUND), in_space(L_UNIT)], k_n=1e9)
    for write in (masonry.to_obj, masonry.to_compas):
        with pytest.raises(ValueError, match="takes convex blocks, and L has several parts"):
            write(tmp_path / "file")


def test_an_effect_acts_on_the_unit_and_not_in_its_notch():
    masonry = mr.Masonry([in_space(GROUND), in_space(L_UNIT)], k_n=1e9)
    mr.MasonryCase(masonry, 0.1, effects=[mr.Load(force=1e3, at=(0.5, 0, 3), block="L")])
    with pytest.raises(ValueError, match="outside the block"):
        mr.MasonryCase(masonry, 0.1, effects=[mr.Load(force=1e3, at=(1.8, 0, 2.8), block="L")])


def test_the_left_end_is_that_of_the_parts_that_reach_so_high():
    """An L turned round: its foot lies to the left, and only low down."""
    turned = mr.Compound([box(0, 1, 0, 3), box(-1, 0, 0, 1)])
    assert [turned.left_at(z) for z in (0.5, 2.0, 2.9)] == [-1.0, 0.0, 0.0]


BAY, THICK, HIGH, DEEP, WIDE, UP = 3.0, 0.25, 2.4, 0.40, 0.40, 2.0
"""A bay of a garden wall, its thickness and height, and depth, width and height of its buttress [m]."""


def with_buttress():
    wall = box(0, THICK, 0, HIGH, length=BAY, density=1800.0)
    return mr.Compound([box(-DEEP, 0, 0, UP, length=WIDE, density=1800.0), wall], name="wall")


def test_parts_of_the_plane_have_their_own_lengths():
    """By volumes: 3 x 0.25 x 2.4 m3 of the wall and 0.4 x 0.4 x 2.0 m3 of the buttress."""
    unit = with_buttress()
    volumes = np.array([BAY * THICK * HIGH, WIDE * DEEP * UP])
    assert unit.mass == pytest.approx(1800 * volumes.sum())
    x, z = volumes @ (THICK / 2, -DEEP / 2) / volumes.sum(), volumes @ (HIGH / 2, UP / 2) / volumes.sum()
    np.testing.assert_allclose(unit.centroid, (x, z))
    about = volumes @ (
        (THICK**2 + HIGH**2) / 12 + (THICK / 2 - x) ** 2 + (HIGH / 2 - z) ** 2,
        (DEEP**2 + UP**2) / 12 + (-DEEP / 2 - x) ** 2 + (UP / 2 - z) ** 2,
    )
    assert unit.inertia == pytest.approx(1800 * about)
    ground = box(-3, 3, -0.5, 0, fixed=True, name="ground", length=BAY)
    masonry = mr.Masonry([ground, unit], k_n=1e9, friction=0.7)
    lengths = {(round(joint.width, 3), joint.length) for joint in masonry.joints}
    assert lengths == {(THICK, BAY), (DEEP, WIDE)}
    assert masonry.lines.k.sum() == pytest.approx(1e9 * (BAY * THICK + WIDE * DEEP))
    for way, arm in ((1, THICK - x), (-1, DEEP + x)):
        assert mr.collapse_multiplier(masonry, way).multiplier == pytest.approx(arm / z, rel=1e-9)


def test_in_space_they_are_as_long():
    unit = in_space(with_buttress())
    assert unit.mass == pytest.approx(with_buttress().mass)
    ground = in_space(box(-3, 3, -0.5, 0, fixed=True, name="ground", length=2 * BAY))
    masonry = mr.Masonry([ground, unit], k_n=1e9, friction=0.7)
    flat = mr.Masonry([box(-3, 3, -0.5, 0, fixed=True, name="ground", length=BAY), with_buttress()], friction=0.7)
    for way in (1, -1):
        found = mr.collapse_multiplier(masonry, (way, 0)).multiplier
        assert found == pytest.approx(mr.collapse_multiplier(flat, way).multiplier, rel=1e-6)


def test_a_wall_with_buttresses_rocks_alike_in_mujoco_and_explicit_steps():
    ground = box(-3, 3, -0.5, 0, fixed=True, name="ground", length=BAY)
    masonry = mr.Masonry([ground, with_buttress()], k_n=1e9, friction=0.7)
    t = np.arange(0, 0.6, 0.005)
    pulse = mr.GroundMotion(-3.0 * np.sin(np.pi * t / 0.3) * (t < 0.3), 0.005)
    case = mr.MasonryCase(masonry, 0.6, motion=pulse)
    one, other = mr.solve_explicit(case), mr.simulate(case)
    np.testing.assert_allclose(
        np.interp(one.t, other.t, other.pose[:, 0, 2]), one.pose[:, 0, 2], atol=0.02 * np.abs(one.pose[:, 0, 2]).max()
    )
    assert np.abs(one.pose[:, 0, 2]).max() > 5e-3
