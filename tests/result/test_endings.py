"""How runs end, in every solver: at rest, still moving or falling, and overturned."""

import math

import numpy as np
import pytest
from everyday import crossed
from masonry_blocks import box

import mjrock as mr
from mjrock.result.ending import describe

WALL = mr.Block.from_size(0.6, 2.4)
ON = mr.Contacts.from_damping(WALL, k_base=1e8, xi_base=0.05)
SLIDES = mr.Contacts.from_damping(WALL, k_base=1e8, xi_base=0.05, friction=0.3)
E = mr.Restitution.from_geometry(WALL)
WALL_SOLVERS = {
    "fitted": lambda case: mr.simulate(case, ON),
    "fixed": lambda case: mr.simulate(case, ON, 2e-4),
    "explicit": lambda case: mr.solve_explicit(case, ON),
    "compliant": lambda case: mr.solve_compliant(case, ON),
    "theory": lambda case: mr.solve_analytical(case, E),
}
ENDINGS = {
    "at rest": ((0.0, 0.3, 0.0), mr.Outcome.AT_REST),
    "rocking": ((0.6, 0.3, 0.0), mr.Outcome.TIME_ENDED),
    "turning back": ((0.9, 0.01, 0.0), mr.Outcome.TIME_ENDED),
    "falling": ((0.5, 0.1, 0.5), mr.Outcome.TIME_ENDED),
    "fallen": ((0.5, 2.0, 0.5), mr.Outcome.OVERTURNED),
}
"""Rotation of release over alpha, duration and velocity of release; and the ending."""


@pytest.mark.parametrize("solver", WALL_SOLVERS)
@pytest.mark.parametrize("motion", ENDINGS)
def test_a_wall(motion, solver):
    (share, duration, omega0), outcome = ENDINGS[motion]
    run = WALL_SOLVERS[solver](mr.Case(WALL, share * WALL.alpha, duration, side_stop=False, omega0=omega0))
    assert run.outcome is outcome
    assert outcome is mr.Outcome.OVERTURNED or run.t[-1] == pytest.approx(duration)


def when_at_rest_by_energy(solve, after):
    """A run that ends when its energy is that at rest, for a motion that loses energy while it goes on."""
    run = solve(after[1])
    late = np.flatnonzero(run.t > after[0])
    return solve(float(run.t[late[np.argmin(np.abs(run.energy[late]))]]))


@pytest.mark.parametrize(
    "solver", [mr.simulate, lambda *args: mr.simulate(*args, 2e-4, coulomb=True), mr.solve_explicit]
)
def test_a_wall_that_a_thrust_pushes_along(solver):
    """The base slides off under a push and keeps sliding, with less energy than at rest."""
    push, thrust = mr.GroundMotion(np.array([0, -8.0, -8.0, 0, 0]), 0.05), mr.Thrust(0.2, 0.25 * WALL.weight)
    run = solver(mr.Case(WALL, 0.0, 0.4, side_stop=False, motion=push, effects=thrust), SLIDES)
    assert run.energy[-1] < 0
    assert run.velocity[-1, 0, 0] > 0.3
    assert run.outcome is mr.Outcome.TIME_ENDED
    rest = solver(mr.Case(WALL, 0.0, 0.1, side_stop=False, effects=thrust), SLIDES)
    assert rest.outcome is mr.Outcome.AT_REST


def turned(block, angle):
    c, s = math.cos(angle), math.sin(angle)
    corners = [(x * c + z * s, z * c - x * s) for x, z in block.corners]
    return mr.Polygon(corners, fixed=block.fixed, name=block.name)


def prism(block):
    corners = [(x, y, z) for x, z in block.corners for y in (-0.5, 0.5)]
    return mr.Polyhedron(corners, block.density, fixed=block.fixed, name=block.name)


def masonry(blocks, in_space, **options):
    return mr.Masonry([prism(block) for block in blocks] if in_space else blocks, **options)


def in_axes(velocity, in_space):
    x, z, rotation = velocity
    return [(x, 0.0, z, 0.0, rotation, 0.0) if in_space else velocity]


SLOPE = [turned(block, math.radians(20)) for block in (box(-2, 6, -1, 0, fixed=True), box(-0.5, 0.5, 0, 0.5))]
FACE = [box(0, 1, 0, 3, fixed=True), box(-0.5, 0, 1, 1.5, name="block")]
BLOCK = [box(-5, 5, -1, 0, fixed=True), box(-0.2, 0.2, 0, 0.4)]
SOLVERS = [mr.simulate, mr.solve_explicit]


@pytest.mark.parametrize(("solver", "in_space"), crossed(SOLVERS, [False, True]))
def test_masonry_that_slides_down(in_space, solver):
    made, down = masonry(SLOPE, in_space, k_n=1e7, friction=0.5), math.radians(-20)
    velocity = in_axes((math.cos(down), math.sin(down), 0.0), in_space)
    run = when_at_rest_by_energy(lambda T: solver(mr.MasonryCase(made, T, velocity=velocity)), (0.05, 0.2))
    assert abs(run.energy[-1]) < mr.masonry_scene(run.case).rest_energies[2]
    assert np.linalg.norm(run.velocity[-1]) > 0.7
    assert run.outcome is mr.Outcome.TIME_ENDED
    assert solver(mr.MasonryCase(made, 0.05)).outcome is mr.Outcome.AT_REST


@pytest.mark.parametrize(("solver", "in_space"), crossed(SOLVERS, [False, True]))
def test_masonry_that_falls_freely(in_space, solver):
    """A thrust presses a block on a face, and friction holds it, until the ground all but follows the thrust."""
    made, force = masonry(FACE, in_space, k_n=1e8, friction=0.7), 2 * FACE[1].mass * mr.GRAVITY
    where = {"at": (-0.25, 0.0, 1.25)} if in_space else {"height": 1.25}
    thrust, follows = (
        mr.Thrust(force=force, block=1, **where),
        mr.GroundMotion(np.full(99, 0.95 * 2 * mr.GRAVITY), 0.01),
    )
    case = mr.MasonryCase(made, 0.25, motion=follows, effects=thrust)
    run = when_at_rest_by_energy(
        lambda T: solver(mr.MasonryCase(made, T, motion=follows, effects=thrust)), (0.05, 0.25)
    )
    assert abs(run.energy[-1]) < mr.masonry_scene(run.case).rest_energies[2]
    assert np.linalg.norm(run.velocity[-1]) > 1
    assert run.outcome is mr.Outcome.TIME_ENDED
    assert solver(mr.MasonryCase(made, 0.05, effects=thrust)).outcome is mr.Outcome.AT_REST
    assert solver(mr.MasonryCase(made, 0.5, motion=case.motion, effects=thrust)).outcome is mr.Outcome.OVERTURNED


def test_masonry_whose_supports_part():
    """A lintel falls between two piers that are pulled away."""
    piers = [box(-2, -0.9, -1, 0, fixed=True, name="left"), box(0.9, 2, -1, 0, fixed=True, name="right")]
    made = mr.Masonry([*piers, box(-1, 1, 0, 0.3, name="lintel")], k_n=1e9)
    apart = {name: ([0.0, 0.01], [0.0, way], [0.0, 0.0]) for name, way in (("left", -0.2), ("right", 0.2))}
    run = mr.solve_explicit(mr.MasonryCase(made, 0.15, supports=apart))
    assert run.velocity[-1, 0, 1] < -1
    assert run.outcome is mr.Outcome.TIME_ENDED


@pytest.mark.parametrize(("solver", "in_space"), crossed(SOLVERS, [False, True]))
def test_masonry_that_rocks_and_overturns(in_space, solver):
    made = masonry(BLOCK, in_space, k_n=1e9, friction=0.7)
    for spin, duration, outcome in (
        (0.5, 0.02, mr.Outcome.TIME_ENDED),  # rocking
        (5.0, 0.05, mr.Outcome.TIME_ENDED),  # on its way to falling over
        (5.0, 1.0, mr.Outcome.OVERTURNED),
    ):
        velocity = in_axes((0.2 * spin, 0.2 * spin, spin), in_space)
        assert solver(mr.MasonryCase(made, duration, velocity=velocity)).outcome is outcome


def test_the_message_has_the_rotation_over_alpha():
    case = mr.Case(WALL, 0.0, 1.0, side_stop=False)
    complaint = describe(mr.Outcome.TIME_ENDED, case, 1.0, -0.5 * WALL.alpha)
    assert complaint == "The wall still rocks at the end of the run (1 s), at 0.5 alpha."
    assert "1.2 alpha" in describe(mr.Outcome.OVERTURNED, case, 1.0, 1.2 * WALL.alpha)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_light_block_that_slides_on_heavy_ones(solver):
    """Its energy is small beside that of all springs at rest, and it moves."""
    blocks = [BLOCK[0], box(-2, 2, 0, 4), box(-0.05, 0.05, 4, 4.1)]
    case = mr.MasonryCase(mr.Masonry(blocks, k_n=1e9, friction=0.1), 0.02, velocity=[[0, 0, 0], [0.3, 0, 0]])
    run = solver(case)
    assert 0 < run.energy[-1] < 0.2 * mr.masonry_scene(case).rest_energies[2]
    assert run.outcome is mr.Outcome.TIME_ENDED


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("density", [1e3, 3e4])
def test_masonry_that_moves_too_slowly_to_open_a_joint(in_space, solver, density):
    """The kinetic energy of a block at rest is below that in its springs, (m g)^2 / (2 k)."""
    blocks = [BLOCK[0], box(-0.2, 0.2, 0, 0.4, density=density)]
    made = masonry(blocks, in_space, k_n=1e9, friction=0.0)
    opens = mr.GRAVITY * math.sqrt(0.4 * density / 1e9)
    for share, outcome in ((0.9, mr.Outcome.AT_REST), (1.1, mr.Outcome.TIME_ENDED)):
        velocity = in_axes((share * opens, 0.0, 0.0), in_space)
        assert solver(mr.MasonryCase(made, 1e-3, velocity=velocity)).outcome is outcome


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(("speed", "outcome"), [(0.3, mr.Outcome.TIME_ENDED), (1e-3, mr.Outcome.AT_REST)])
def test_a_tower_on_soft_joints_that_swings_is_not_at_rest(solver, speed, outcome):
    """Its energy opens no joint. The message says how far its top has moved in the last second."""
    tower = mr.Masonry.stack([mr.Block.from_size(1.0, 1.0)] * 2, joints=mr.Dry(k_n=1e7, friction=0.7, xi=0.0))
    velocity = [[speed * (i + 0.5) / 2, 0, 0] for i in range(2)]
    run = solver(mr.MasonryCase(tower, 1.5, velocity=velocity), output_step=0.01)
    assert run.opening.max() < 2e-3
    assert run.outcome is outcome
    last = run.pose[run.t >= 0.5, 1]
    far = np.hypot(*np.ptp(last[:, :2], axis=0)) + math.sqrt(0.5) * np.ptp(last[:, 2])
    assert f"In the last second {tower.names[2]} moved by {1e3 * far:.2g} mm" in run.message


@pytest.mark.parametrize("in_space", [False, True])
def test_masonry_that_creeps_is_not_at_rest(in_space):
    """It slides on smooth ground, with a thousandth of the energy that opens a joint, by 2 mm in the last second."""
    made = masonry(BLOCK, in_space, k_n=1e7, friction=0.0)
    for speed, outcome in ((2e-3, mr.Outcome.TIME_ENDED), (1e-4, mr.Outcome.AT_REST)):
        run = mr.solve_explicit(mr.MasonryCase(made, 1.2, velocity=in_axes((speed, 0.0, 0.0), in_space)))
        assert run.outcome is outcome
        assert f"moved by {1e3 * speed:.2g} mm" in run.message


def test_a_wall_that_swings_on_soft_contacts_is_not_at_rest():
    """One rule for walls and masonry."""
    soft = mr.Contacts.from_damping(WALL, k_base=3e6, xi_base=0.0)
    for share, outcome in ((0.5, mr.Outcome.TIME_ENDED), (0.001, mr.Outcome.AT_REST)):
        case = mr.Case(WALL, share * soft.uplift_rotation(WALL), 1.5, side_stop=False)
        for run in (mr.solve_explicit(case, soft), mr.simulate(case, soft)):
            assert run.outcome is outcome
            assert "In the last second it moved by" in run.message
