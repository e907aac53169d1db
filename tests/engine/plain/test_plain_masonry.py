"""Plain models of masonry: rest, falls, wheels, supports, symmetry, and what explicit steps find beside them."""

import math

import mujoco
import numpy as np
import pytest
from everyday import among
from masonry_blocks import GROUND, box
from wheels import rolling

import mjrock as mr
from scripts.studies.plain_masonry import closed_form, landing, lost

PLAIN = {"collisions": True, "ledger": True, "forces": True}
SLAB = mr.Polyhedron.box((4.0, 4.0, 0.5), centre=(0.0, 0.0, -0.25), fixed=True, name="slab")
TABLE = mr.Polyhedron.box((1.0, 1.0, 1.0), centre=(0.0, 0.0, 0.5), fixed=True, name="table")
DIE = mr.Polyhedron.box((0.3, 0.3, 0.3), centre=(0.3, 0.0, 1.15), name="die")
L_BLOCK = mr.Compound([box(0, 1, 0, 3), box(1, 2, 0, 1)], name="L")


def test_a_block_at_rest_sinks_by_its_weight_over_its_joint():
    block = mr.Polyhedron.box((0.4, 0.4, 0.4), centre=(0.0, 0.0, 0.2))
    run = mr.simulate(mr.MasonryCase(mr.Masonry([SLAB, block], k_n=1e8, friction=0.6), 0.1), **PLAIN)
    weight = block.mass * mr.GRAVITY
    assert run.pose[-1, 0, 2] == pytest.approx(-weight / (1e8 * 0.16), rel=1e-9)
    assert run.reactions["slab"][-1] == pytest.approx((0.0, 0.0, weight), abs=1e-6 * weight)
    assert run.forces.normal[-1] == pytest.approx(weight)
    assert np.abs(run.velocity).max() < 1e-12


def test_a_block_that_slides_off_a_table_falls_on_what_is_below():
    """Explicit steps, which find their own contacts, have it land 2 ms later with its rotation within 1 %; a block that
    has left everything keeps its energy."""
    velocity = np.zeros((1, 6))
    velocity[0, 0] = 2.5
    case = mr.MasonryCase(mr.Masonry([SLAB, TABLE, DIE], k_n=1e8, friction=0.3), 0.7, velocity=velocity)
    plain, explicit = mr.simulate(case, **PLAIN), mr.solve_explicit(case, ledger=True)
    assert plain.fallen["die"] == pytest.approx(explicit.fallen["die"], abs=4e-3)
    assert plain.ledger.friction[-1] == pytest.approx(explicit.ledger.friction[-1], rel=0.03)
    at = np.interp(plain.t, explicit.t, explicit.pose[:, 0, 2])
    np.testing.assert_allclose(plain.pose[:, 0, 2], at, atol=0.02)
    assert np.abs(plain.energy_residual).max() < 0.01 * plain.ledger.largest
    assert plain.stats["overlap"] < 0.01


@pytest.mark.parametrize("sides", among((6, 8, 12, 16), 8))
def test_a_rimless_wheel_rolls_at_its_closed_form_rate(sides):
    """Hulls on a hull, at 0.05 ms; a wheel pivots for some tenth of a second."""
    case, rate = rolling(sides, 0.5, falls=3.5, k_n=5e8)
    run = mr.simulate(case, timestep=1e-4, output_step=1e-4, collisions=True)
    turned = run.pose[:, 0, 2] / (2 * math.pi / sides)
    assert turned[-1] > 2
    assert run.velocity[turned > 1, 0, 2].max() == pytest.approx(rate, rel=5e-3)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 60.0])
def test_a_landing_takes_what_a_spring_with_a_dashpot_does(degrees):
    """Against a closed form without gravity during the landing, which brings some 1 %. The block is a box however it is
    turned, and the ground without friction does not push it along."""
    case = landing(degrees, 0.02)
    scene = mr.scene_of(case)
    answer = mr.simulate(case, timestep=0.1 / scene.highest_frequency, ledger=True, collisions=True)
    exact = closed_form(degrees, scene.contacts.k.sum(), scene.contacts.c.sum())
    assert lost(answer) == pytest.approx(exact, rel=0.03)
    np.testing.assert_allclose(answer.velocity[:, 0, 0], 0, atol=1e-9)


def test_a_turned_block_is_a_box():
    model = mujoco.MjModel.from_xml_string(mr.mjcf_of(landing(5.0, 0.02), None, 1e-4, collisions=True))
    assert [model.geom(name).type[0] for name in ("block_1", "block_2")] == [mujoco.mjtGeom.mjGEOM_BOX] * 2
    low = model.body("block_1").pos[2] - 0.02
    corners = model.geom("block_1").size * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.geom("block_1").quat)
    assert (corners @ turn.reshape(3, 3).T)[:, 2].min() == pytest.approx(-low, abs=1e-9)


def test_an_arch_of_hulls_bears_its_weight_with_the_thrust_that_explicit_steps_find():
    arch = mr.Masonry.arch(radius=2.0, thickness=0.4, voussoirs=9, k_n=1e9, friction=0.7)
    plain, explicit = (
        ask(mr.MasonryCase(arch, 0.05), forces=True, **given)
        for ask, given in ((mr.simulate, {"collisions": True}), (mr.solve_explicit, {}))
    )
    for name, force in explicit.reactions.items():
        np.testing.assert_allclose(plain.reactions[name][-1], force[-1], rtol=2e-3)
    assert not plain.fallen


def test_a_unit_of_several_parts_meets_with_each():
    """An L on the ground, both feet of which carry. Its joint has half of its stiffness against turning there, since
    its middle carries too, so that it sways a little: its mean force is its weight, and acts below its centroid."""
    masonry, weight = mr.Masonry([GROUND, L_BLOCK], k_n=1e9, friction=0.7), L_BLOCK.mass * mr.GRAVITY
    run = mr.simulate(mr.MasonryCase(masonry, 0.5), **PLAIN)
    assert run.reactions["ground"][:, 1].mean() == pytest.approx(weight, rel=5e-3)
    at = (run.forces.eccentricity[:, 0] * run.forces.normal[:, 0]).mean() / run.forces.normal.mean()
    assert at == pytest.approx(L_BLOCK.centroid[0] - 1.0, abs=0.01)
    assert run.peak[0] < 1e-3


def test_a_support_that_moves_carries_what_stands_on_it():
    """A slab that moves at 0.2 m/s after 0.05 s: the block slides until friction has given it that speed."""
    block = box(-0.3, 0.3, 0.0, 0.3)
    history = ([0.05, 0.55], [0.0, 0.1], [0.0, 0.0])
    masonry = mr.Masonry([GROUND, block], k_n=1e9, friction=0.5)
    run = mr.simulate(mr.MasonryCase(masonry, 0.2, supports={"ground": history}), **PLAIN)
    assert run.velocity[-1, 0, 0] == pytest.approx(0.2, rel=1e-3)
    slid = 0.2**2 / (2 * 0.5 * mr.GRAVITY)
    assert run.pose[-1, 0, 0] == pytest.approx(0.03 - slid, rel=0.02)
    assert run.ledger.friction[-1] == pytest.approx(block.mass * 0.2**2 / 2, rel=0.02)
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.largest


def test_a_support_that_moves_does_not_meet_what_stands_fixed():
    """A pier that goes down into the ground on which it stands takes its block along, and nothing else happens."""
    pier, block = box(-1, 1, 0, 1, fixed=True, name="pier"), box(-0.3, 0.3, 1.0, 1.3)
    masonry = mr.Masonry([GROUND, pier, block], k_n=1e9, friction=0.5)
    case = mr.MasonryCase(masonry, 0.6, supports={"pier": ([0.0, 0.3], [0.0, 0.0], [0.0, -0.1])})
    run = mr.simulate(case, **PLAIN)
    assert run.pose[-1, 0, 1] == pytest.approx(-0.1, abs=1e-4)
    assert run.ledger.largest < 2 * block.mass * mr.GRAVITY * 0.1
    assert np.abs(run.energy_residual).max() < 0.01 * run.ledger.largest


def column(**options):
    return mr.Masonry.column(width=0.5, height=2.0, drums=4, k_n=1e9, friction=0.7, **options)


def test_a_column_rocks_as_by_explicit_steps():
    """In the first half second, within 2 % of the largest displacement: friction of MuJoCo has no k_s."""
    case = mr.MasonryCase(column(k_s=1e9), 0.5, motion=mr.GroundMotion.sine(3.0, 0.6))
    with pytest.warns(UserWarning, match="k_s"):
        plain = mr.simulate(case, **PLAIN)
    explicit = mr.solve_explicit(case)
    at = np.stack([np.interp(plain.t, explicit.t, explicit.pose[:, i, 0]) for i in range(4)], axis=1)
    np.testing.assert_allclose(plain.pose[:, :, 0], at, atol=0.02 * np.abs(at).max())


def test_a_mirrored_record_moves_masonry_the_other_way():
    pushes = (mr.GroundMotion.sine(sign * 3.0, 0.6) for sign in (1.0, -1.0))
    one, other = (mr.simulate(mr.MasonryCase(column(), 0.3, motion=push), collisions=True) for push in pushes)
    np.testing.assert_allclose(one.pose[:, :, 0], -other.pose[:, :, 0], atol=2e-3 * np.abs(one.pose[:, :, 0]).max())


def test_the_same_run_twice_is_the_same_to_the_bit():
    case = mr.MasonryCase(column(), 0.1, motion=mr.GroundMotion.sine(3.0, 0.6))
    assert mr.simulate(case, collisions=True) == mr.simulate(case, collisions=True)


def test_the_text_grows_with_the_blocks():
    """Four lines a block and one a joint: neighbours are pairs, and all others meet by default."""
    lines, parts = [], []
    for drums in (4, 8, 16):
        case = mr.MasonryCase(mr.Masonry.column(width=0.5, height=2.0, drums=drums, k_n=1e9, friction=0.7), 0.1)
        lines.append(len(mr.mjcf_of(case, None, 1e-3, collisions=True).splitlines()))
        parts.append(drums + len(case.masonry.joints))
    assert (lines[2] - lines[1]) / (parts[2] - parts[1]) == (lines[1] - lines[0]) / (parts[1] - parts[0]) < 3


def test_edges_and_shadows_are_seen_by_whoever_opens_the_text():
    """Each box has dark borders, and what may fall lies within the square that casts shadows."""
    corner = mr.Polyhedron.box((0.3, 0.3, 0.3), centre=(-1.8, 1.8, 0.15), name="corner")
    case = mr.MasonryCase(mr.Masonry([SLAB, TABLE, DIE, corner], k_n=1e8, friction=0.3), 0.5)
    model = mujoco.MjModel.from_xml_string(mr.mjcf_of(case, None, 1e-3, collisions=True))
    assert (model.geom_matid[model.geom_type == mujoco.mjtGeom.mjGEOM_BOX] == 0).all()
    side = model.tex_width[1]
    face = model.tex_data[model.tex_adr[1] :][: 3 * side**2].reshape(side, side, 3)
    assert (face[[0, -1]] < 60).all()
    assert (face[:, [0, -1]] < 60).all()
    assert (face[1:-1, 1:-1] == 255).all()
    away = case.rests - model.stat.center
    light = model.light_dir[0] / np.linalg.norm(model.light_dir[0])
    across = np.linalg.norm(away - np.outer(away @ light, light), axis=1)
    assert 0.2 < across.max() / model.stat.extent < 0.5 * model.vis.map.shadowclip


def test_blocks_turn_freely_in_flight():
    """A block that has left everything keeps its spin about a principal axis, and its ledger closes."""
    velocity = np.zeros((1, 6))
    velocity[0] = (0.5, 0.2, 6.0, 0.0, 0.0, 8.0)
    run = mr.simulate(
        mr.MasonryCase(mr.Masonry([SLAB, TABLE, DIE], k_n=1e8, friction=0.3), 0.5, velocity=velocity), **PLAIN
    )
    assert run.velocity[-1, 0, 5] == pytest.approx(8.0, abs=1e-9)
    assert run.pose[-1, 0, 2] == pytest.approx(6.0 * 0.5 - mr.GRAVITY * 0.5**2 / 2, abs=1e-3)
    assert np.abs(run.energy_residual).max() < 1e-6 * run.ledger.largest


def test_what_a_plain_model_has_not_is_refused_by_name():
    bond = mr.Bond(tension=1e5, cohesion=2e5, opening_energy=10.0, slip_energy=50.0)
    mortared = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 1)], k_n=1e9, k_s=1e9, friction=0.6, bond=bond, points=5)
    with pytest.raises(ValueError, match="MuJoCo"):
        mr.simulate(mr.MasonryCase(mortared, 0.1), collisions=True)
    jack = mr.Actuator(block=1, at=(0.3, 0.9), direction=(-1.0, 0.0), displacement=([0, 1], [0, 0.1]), stiffness=1e6)
    dry = mr.Masonry([GROUND, box(-0.3, 0.3, 0, 1)], k_n=1e9, friction=0.6)
    with pytest.raises(ValueError, match="Actuator"):
        mr.simulate(mr.MasonryCase(dry, 0.1, effects=(jack,)), collisions=True)
