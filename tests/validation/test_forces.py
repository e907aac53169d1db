"""Forces in the answer: they carry the weight, move the blocks, and are where equilibrium by hand says."""

import math

import mujoco
import numpy as np
import pytest
from masonry_blocks import GROUND, box, columns, tilted

import mjrock as mr
from mjrock.engine.model import released_mjcf
from mjrock.quantities import GRAVITY
from mjrock.scene.masonry import masonry_course
from tests.invariance.balance import turns

FLOOR = mr.Polyhedron.box((20, 20, 1), (0, 0, -0.5), fixed=True, name="ground")
STRAY = mr.Polyhedron.box((0.5, 0.4, 0.3), (0.1, 0.05, 0.75), name="upper")
BOXES = [FLOOR, mr.Polyhedron.box((0.7, 0.5, 0.6), (0, 0, 0.3), name="lower"), STRAY]
BY = {"explicit": mr.solve_explicit, "MuJoCo": mr.simulate}


def weight(masonry):
    return sum(block.mass for block in masonry.blocks if not block.fixed) * GRAVITY


def standing(masonry, solver="explicit", **options):
    """Masonry at rest for a moment."""
    return BY[solver](mr.MasonryCase(masonry, 1e-3, **options), forces=True)


def in_bond(k_s=None):
    return mr.Masonry.running_bond(1.2, 0.6, (0.4, 0.2), k_n=1e9, k_s=k_s, friction=0.6)


def in_space():
    return mr.Masonry(BOXES, k_n=1e9, friction=0.6)


def arch(slenderness, voussoirs=15, **options):
    """A semicircular arch of radius 5 m whose thickness is a share of that."""
    return mr.Masonry.arch(radius=5.0, thickness=5 * slenderness, voussoirs=voussoirs, **options)


def total(answer):
    return sum(answer.reactions.values())


@pytest.mark.parametrize(
    ("build", "solver"),
    [
        (lambda: arch(0.15, k_s=1e10), "explicit"),
        (lambda: in_bond(4e8), "explicit"),
        (lambda: columns(3), "explicit"),
        (in_space, "explicit"),
        (lambda: columns(3), "MuJoCo"),
        (in_space, "MuJoCo"),
    ],
)
def test_reactions_at_rest_sum_to_the_weight(build, solver):
    masonry = build()
    answer = standing(masonry, solver)
    assert set(answer.reactions) == {n for n, b in zip(masonry.names, masonry.blocks, strict=True) if b.fixed}
    assert total(answer)[0, -1] == pytest.approx(weight(masonry), rel=1e-9)
    assert np.abs(total(answer)[0, :-1]).max() < 1e-9 * weight(masonry)


@pytest.mark.parametrize("build", [lambda: columns(3), in_bond, in_space])
def test_both_solvers_find_the_same_forces_at_rest(build):
    masonry = build()
    one, other = (standing(masonry, solver).forces for solver in BY)
    assert one.joints == other.joints == tuple(joint.name for joint in masonry.joints)
    for name in ("normal", "shear"):
        apart = getattr(one, name)[0] - getattr(other, name)[0]
        assert np.abs(apart).max() < 1e-9 * weight(masonry), name
    presses = one.normal[0] > 1e-3 * weight(masonry)
    np.testing.assert_allclose(one.eccentricity[0][presses], other.eccentricity[0][presses], atol=1e-7)


def test_both_solvers_find_the_same_thrust_of_an_arch():
    """Rows of MuJoCo let joints creep, by which it is off by a few millionths of the weight."""
    masonry = arch(0.15)
    one, other = (BY[solver](mr.MasonryCase(masonry, 0.1), timestep=5e-5, forces=True).forces for solver in BY)
    for name in ("normal", "shear"):
        apart = getattr(one, name)[-1] - getattr(other, name)[-1]
        assert np.abs(apart).max() < 5e-6 * weight(masonry), name


def momentum(answer, masonry, h):
    """Force that the accelerations of the blocks ask for beside their weight, between the samples [N]."""
    d = 3 if answer.in_space else 2
    mass = np.array([block.mass for block in masonry.blocks if not block.fixed])
    place = answer.pose[:, :, :d]
    change = (place[2:] - 2 * place[1:-1] + place[:-2]) / h**2
    return np.einsum("b,nbd->nd", mass, change)


def kicked(solver, build, h, **effects):
    """A run of blocks that are kicked, with a sample of every step, and what is missing in the balance of momentum."""
    masonry = build()
    velocity = np.zeros((len(masonry.free), 6 if masonry.in_space else 3))
    velocity[-1, :2], velocity[-1, len(velocity[0]) // 3], velocity[:, 4 if masonry.in_space else 2] = (
        (1.0, 0.2),
        0.5,
        0.3,
    )
    case = mr.MasonryCase(masonry, 0.15, velocity=velocity, **effects)
    options = {"coulomb": True} if solver == "MuJoCo" else {}
    answer = BY[solver](case, timestep=h, output_step=h, forces=True, **options)
    missing = total(answer)[1:-1] - momentum(answer, masonry, h)
    missing[:, -1] -= weight(masonry)
    return answer, np.abs(missing).max(axis=1) / weight(masonry)


HELD = (
    mr.Tie(height=3.9, stiffness=1e6, length=1.0, strength=3e3, ultimate=0.02, block=3),
    mr.Damper(height=2.0, c=5e4, length=1.0, block=2),
    mr.FrictionDamper(height=2.0, stiffness=1e6, slip_force=2e3, length=1.0, block=2),
    mr.Tie(height=3.9, stiffness=1e6, length=5.0, strength=3e3, block=3),
)


@pytest.mark.parametrize(
    ("solver", "build", "h", "options"),
    [
        ("explicit", lambda: columns(3), 2e-5, {}),
        ("explicit", lambda: columns(3), 2e-5, {"effects": HELD[:3]}),
        ("explicit", lambda: columns(3, k_s=2e8), 2e-5, {}),
        ("explicit", in_space, 2e-5, {}),
        ("MuJoCo", lambda: columns(3), 1e-4, {}),
        ("MuJoCo", lambda: columns(3), 1e-4, {"effects": HELD[1:]}),
    ],
)
def test_reactions_move_the_blocks(solver, build, h, options):
    """In every step the reactions are mass times acceleration and weight, in impacts too.

    Where a tie turns, half of the force that it gains in a step is between the pose and the step.
    """
    answer, missing = kicked(solver, build, h, **options)
    lifted = answer.forces.normal.min(axis=0) == 0
    assert lifted.any()
    none = np.zeros(len(answer.t))
    pull = answer.forces.links.get("tie_0", none) if solver == "explicit" else none
    turning = turns(pull, HELD[0].strength)
    assert np.count_nonzero(turning) < 0.01 * len(missing)
    assert missing[~turning].max() < 1e-6
    gain = np.abs(np.diff(pull))
    between = 0.5 * np.maximum(gain[1:], gain[:-1])[turning] / weight(build())
    assert np.all(missing[turning] < 1e-6 + between)
    for pull in answer.forces.links.values():
        assert np.abs(pull).max() > 1e3
    assert len(answer.forces.links) == len(options.get("effects", ()))


def test_reactions_move_blocks_that_slide_in_space():
    """By Coulomb's law the engine looks for the direction of friction until it turns by less than 0.2 % in a look, and
    knows what presses exactly."""
    answer, _ = kicked("MuJoCo", in_space, 1e-4)
    masonry = answer.case.masonry
    missing = np.abs(total(answer)[1:-1] - momentum(answer, masonry, 1e-4) - [0, 0, weight(masonry)])
    friction = 0.6 * answer.forces.normal[1:-1].sum(axis=1)
    assert friction.max() > 2 * weight(masonry)
    assert missing[:, 2].max() < 1e-6 * weight(masonry)
    assert (missing[:, :2].max(axis=1) < 0.008 * friction + 1e-4 * weight(masonry)).all()


def test_reactions_of_fitted_steps_make_the_momentum():
    """Summed over time, from sample to sample, in a run whose steps are longer and shorter than these."""
    masonry, velocity = columns(3), np.full((3, 3), 0.3)
    answer = mr.simulate(mr.MasonryCase(masonry, 0.3, velocity=velocity), output_step=1e-4, forces=True)
    mass = np.array([block.mass for block in masonry.blocks if not block.fixed])
    momentum = np.einsum("b,nbd->nd", mass, answer.velocity[:, :, :2])
    mean = 0.5 * (total(answer)[1:] + total(answer)[:-1]) - [0, weight(masonry)]
    given = np.cumsum(mean * np.diff(answer.t)[:, None], axis=0)
    assert np.abs(given - momentum[1:] + momentum[0]).max() < 5e-3 * np.abs(momentum).max()


@pytest.mark.parametrize("build", [lambda: columns(3), in_space])
def test_the_engine_has_the_same_forces(build):
    """The contact forces that stock MuJoCo reports in each step of the text, where blocks slide and strike too.

    Its search for them leaves up to 4e-4 of the weight of momentum unaccounted for where blocks of space slide.
    """
    h, masonry = 1e-4, build()
    velocity = np.zeros((len(masonry.free), 6 if masonry.in_space else 3))
    velocity[-1, 0] = 1.0
    case = mr.MasonryCase(masonry, 0.05, velocity=velocity)
    with pytest.warns(UserWarning, match="contacts that slide are pressed apart"):
        answer = mr.simulate(case, timestep=h, output_step=h, forces=True)
    scene = mr.scene_of(case, None)
    model = mujoco.MjModel.from_xml_string(released_mjcf(scene, masonry_course(case, scene), h))
    data, force = mujoco.MjData(model), np.zeros(6)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for reaction in total(answer)[:-1]:
        mujoco.mj_step(model, data)
        held = np.zeros(3)
        for i, contact in enumerate(data.contact):
            first, second = model.geom_bodyid[contact.geom]
            mujoco.mj_contactForce(model, data, i, force)
            held += (float(first == 0) - float(second == 0)) * (contact.frame.reshape(3, 3).T @ force[:3])
        held = held if masonry.in_space else held[[0, 2]]
        assert np.abs(held - reaction).max() < 1e-8 * weight(masonry)


def test_what_falls_off_presses_where_it_lands():
    """A block that has left its joint meets the ground without one, and the reaction counts that."""
    masonry = mr.Masonry([GROUND, box(0, 1, 0, 0.3), box(0, 1, 0.3, 0.5)], k_n=1e8, friction=0.1, xi=0.3)
    case = mr.MasonryCase(masonry, 2.0, velocity=[[0, 0, 0], [3.0, 0, 0]])
    answer = mr.solve_explicit(case, forces=True)
    assert answer.forces.normal[-1, 1] == 0
    assert answer.forces.normal[-1, 0] == pytest.approx(masonry.blocks[1].mass * GRAVITY, rel=1e-3)
    assert answer.reactions["ground"][-1, 1] == pytest.approx(weight(masonry), rel=0.02)


@pytest.mark.parametrize("solver", BY)
def test_eccentricity_on_a_slope(solver):
    """The weight of what is above passes through each joint downhill of its middle, by the height of its centroid."""
    angle = 0.1
    masonry = tilted(columns(2, k_n=1e11), angle)
    forces, half = standing(masonry, solver).forces, 0.5 * weight(masonry)
    above, height = np.array([2, 1]), np.array([2.1, 1.05])
    np.testing.assert_allclose(forces.normal[0], above * half * math.cos(angle), rtol=1e-3)
    np.testing.assert_allclose(forces.shear[0], -above * half * math.sin(angle), rtol=1e-3)
    np.testing.assert_allclose(forces.eccentricity[0], height * math.tan(angle), rtol=1e-3)


def test_eccentricity_in_space():
    """A block whose centroid is off the middle of its joint, along both axes."""
    masonry = mr.Masonry(
        [FLOOR, mr.Polyhedron([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.3, 0.2, 1.0)], name="pyramid")], k_n=1e10
    )
    (joint,), block = masonry.joints, masonry.blocks[1]
    forces = standing(masonry).forces
    off = (block.centroid - joint.middle) @ joint.axes.T
    assert np.abs(off).min() > 0.01
    np.testing.assert_allclose(forces.eccentricity[0, 0], off, atol=1e-5)
    assert forces.shear.shape == forces.eccentricity.shape == (*forces.normal.shape, 2)


def test_the_thrust_line_of_an_arch_of_least_thickness():
    """It touches the extrados at the crown and at the springings, and the intrados 54.5 degrees from the crown.

    A semicircle of t/R = 0.1075 has these hinges (Milankovitch 1907).
    """
    forces = standing(arch(0.11, 60, k_n=1e11, k_s=1e11)).forces
    frames = forces.frames
    place = frames.middle + forces.eccentricity[0][:, None] * frames.axes[:, 1]
    from_crown, share = np.degrees(np.arctan2(place[:, 0], place[:, 1])), (np.hypot(*place.T) - 5.0) / 0.55
    crown, springings = np.abs(from_crown) < 1, np.abs(from_crown) > 89
    np.testing.assert_allclose(share[crown], 0.5, atol=0.02)
    np.testing.assert_allclose(share[springings], 0.5, atol=0.02)
    for side in (from_crown > 0, from_crown < 0):
        lowest = np.argmin(np.where(side, share, np.inf))
        assert abs(from_crown[lowest]) == pytest.approx(54.5, abs=3)
        assert share[lowest] == pytest.approx(-0.5, abs=0.03)
    assert np.abs(share).max() <= 0.5 + 1e-5


def test_the_frame_of_a_joint_goes_with_the_support_below_it():
    """A column that is carried along stays in the middle of its joint, and its support bears it."""
    t = np.linspace(0, 0.5, 2001)
    smooth = (2 * t) ** 3 * (10 - 15 * (2 * t) + 6 * (2 * t) ** 2)
    bent = 4 * (60 * (2 * t) - 180 * (2 * t) ** 2 + 120 * (2 * t) ** 3)
    masonry = mr.Masonry([GROUND, box(-0.5, 0.5, 0, 0.5)], k_n=1e9, friction=0.7, xi=0.1)
    case = mr.MasonryCase(masonry, 0.6, supports={"ground": (t, 0.05 * smooth, 0.02 * smooth)})
    answer = mr.solve_explicit(case, forces=True)
    expected = masonry.blocks[1].mass * (GRAVITY + 0.02 * np.interp(answer.t, t, bent))
    np.testing.assert_allclose(answer.reactions["ground"][:, 1], expected, rtol=2e-3)
    pushed = answer.reactions["ground"][:, 0] / answer.reactions["ground"][:, 1]
    np.testing.assert_allclose(answer.forces.eccentricity[:, 0], -0.25 * pushed, atol=2e-3)
    assert np.abs(answer.forces.eccentricity[-1]).max() < 1e-3


def test_a_spreading_arch_thrusts_less():
    t = np.linspace(0, 1, 101)
    smooth = 0.5 - 0.5 * np.cos(math.pi * t)
    case = mr.MasonryCase(arch(0.15), 1.2, supports={"right_abutment": (t, 0.02 * smooth, 0 * t)})
    answer = mr.solve_explicit(case, forces=True)
    left, right = answer.reactions["left_abutment"], answer.reactions["right_abutment"]
    assert left[0, 0] == pytest.approx(-right[0, 0], rel=1e-6)
    np.testing.assert_allclose(left[-1] * [-1, 1], right[-1], rtol=0.02)
    assert 0.5 * left[0, 0] < left[-1, 0] < 0.95 * left[0, 0]


def test_a_jack_bears_the_pull_of_its_tie():
    """What a link pulls belongs to the reaction of the fixed block that it is anchored on, and to no other."""
    jack = box(-2.5, -2.0, 0, 1, fixed=True, name="jack")
    masonry = mr.Masonry([GROUND, jack, box(-0.5, 0.5, 0, 1)], k_n=1e9, k_s=1e9, friction=0.9, xi=0.3)
    t = np.linspace(0, 0.5, 251)
    tie = mr.Tie(height=0.1, length=1.5, stiffness=1e5, block=2, anchor_block=1)
    case = mr.MasonryCase(masonry, 0.6, effects=(tie,), supports={"jack": (t, -0.05 * (2 * t) ** 3, 0 * t)})
    answer = mr.solve_explicit(case, forces=True)
    assert answer.forces.links["tie_0"][-1] == pytest.approx(5e3, rel=1e-3)
    np.testing.assert_allclose(answer.reactions["jack"][-1], [-5e3, 0], rtol=1e-3, atol=1)
    np.testing.assert_allclose(answer.reactions["ground"][-1], [5e3, weight(masonry)], rtol=0.01)
    np.testing.assert_allclose(answer.forces.shear[-1], 5e3, rtol=0.01)


@pytest.mark.parametrize("solver", BY)
def test_a_tie_pulls_a_wall_back(solver):
    """A wall that leans against a tie: base, side and anchors bear it, and the tie has its own force."""
    wall = mr.Block.from_size(thickness=0.8, height=9.0, length=6.0, density=1600.0)
    contacts = mr.Contacts.from_law(wall, mr.Restitution(base=0.97, side=-0.5), k_base=5e8, k_side=5e8)
    tie = mr.Tie(height=8.0, stiffness=2e6, strength=1e5)
    case = mr.Case(wall, theta0=0.0, duration=0.2, side_stop=True, effects=(tie, mr.Thrust(height=8.0, force=2e4)))
    answer = BY[solver](case, contacts, forces=True)
    pull = answer.forces.links["tie_0"]
    np.testing.assert_allclose(pull, answer.ties["tie_0"].force, atol=2.0)
    assert pull[0] > 1e3
    np.testing.assert_allclose(answer.reactions["anchors"][:, 0], -pull, rtol=1e-4)
    assert total(answer)[0] == pytest.approx([-2e4, wall.weight], abs=10)
    assert answer.forces.joints == ("base", "side")
    np.testing.assert_allclose(answer.reactions["base"][:, 1], answer.forces.normal[:, 0], rtol=1e-6)
    np.testing.assert_allclose(answer.reactions["side"][:, 0], answer.forces.normal[:, 1], rtol=1e-6)


def test_forces_that_were_not_kept():
    answer = mr.solve_explicit(mr.MasonryCase(columns(2), 1e-3))
    for name in ("forces", "reactions"):
        with pytest.raises(AttributeError, match="pass forces=True"):
            getattr(answer, name)


@pytest.mark.parametrize("solver", BY)
def test_more_forces_than_fit_into_memory(solver):
    with pytest.raises(ValueError, match=r"the forces of this answer would be .*leave the forces out"):
        BY[solver](mr.MasonryCase(columns(8), 2e3), forces=True)


def test_forces_in_a_table():
    answer = standing(columns(3), effects=HELD[:1])
    header, first = (line.split(",") for line in answer.csv().splitlines()[:2])
    row = dict(zip(header, map(float, first), strict=True))
    assert row["reaction z of ground [N]"] == pytest.approx(weight(answer.case.masonry))
    assert row["normal force of block_0|block_1 [N]"] == pytest.approx(2 / 3 * weight(answer.case.masonry))
    assert {"shear of ground|block_0 [N]", "eccentricity of ground|block_0 [m]", "pull of tie_0 [N]"} <= row.keys()


def test_the_largest_reaction_in_a_campaign(tmp_path):
    case = mr.MasonryCase(columns(2), 1e-3)
    row = mr.Analysis(case, "explicit", options={"forces": True})(tmp_path / "history.npz")
    with np.load(tmp_path / "history.npz") as kept:
        np.testing.assert_allclose(kept["reaction of ground"][0], [0, weight(case.masonry)], atol=1e-6)
        assert kept["normal"].shape == kept["shear"].shape == kept["eccentricity"].shape == (len(kept["t"]), 2)
    assert row["largest_reaction_N"] == pytest.approx(weight(case.masonry))
    assert "largest_reaction_N" not in mr.Analysis(case, "explicit")()
