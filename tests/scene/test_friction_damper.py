"""A friction damper: its loop against the closed form, MuJoCo beside SciPy, its account, and what is refused."""

import math

import numpy as np
import pytest
from everyday import among, slow
from scenes import course, fixed_steps, stock_takes

import mjrock as mr
from mjrock.engine.energy_work import ledger
from mjrock.engine.model import engine_of, released_mjcf
from mjrock.engine.stepping import fitted_steps

BLOCK = mr.Block.from_size(2.0, 2.0)
WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)
K, F = 2e6, 2e4
NAME = "friction_damper_0"


def ice():
    return mr.Contacts.from_damping(BLOCK, k_base=5e8, xi_base=0.05, friction=0.0)


def sliding(speed):
    """A block on ice that a friction damper at the height of its centroid holds, and half a second of it."""
    damper = mr.FrictionDamper(BLOCK.h, K, F)
    scene = mr.wall_scene(mr.Case(BLOCK, 0.0, 1.0, side_stop=False, effects=damper), ice())
    return scene, course(scene, [[speed, 0.0, 0.0]], 0.5)


def loop(amplitude, cycles=2, samples=4001):
    """Elongations of some cycles from rest [m]."""
    return amplitude * np.sin(np.linspace(0.0, 2 * math.pi * cycles, samples))


def area(elongation, force):
    """Work that goes into a link along a path [J], by trapezoids."""
    return float((0.5 * (force[1:] + force[:-1]) * np.diff(elongation)).sum())


@pytest.mark.parametrize("amplitude", [0.5 * F / K, 2 * F / K, 7 * F / K])
def test_the_loop_has_the_area_of_the_closed_form(amplitude):
    """A cycle takes 4 F (d - F/k), and nothing where the damper does not slip: by its law and by the accounts."""
    law, path = mr.FrictionDamper(BLOCK.h, K, F).law, loop(amplitude)
    force = K * (path - law.plastic_elongation(path))
    last = slice(len(path) // 2, None)
    exact = 4 * F * max(amplitude - F / K, 0.0)
    assert area(path[last], force[last]) == pytest.approx(exact, rel=1e-3, abs=1e-6)
    assert np.abs(force).max() == pytest.approx(min(F, K * amplitude))
    scene, _ = sliding(0.5)
    pose = np.column_stack([path, np.full_like(path, scene.at_rest[0, 1]), np.zeros_like(path)])
    stored, taken = scene.accounts(pose, np.zeros_like(pose))
    assert taken[-1, 0] - taken[last.start, 0] == pytest.approx(exact, rel=1e-3, abs=1e-6)
    elastic = stored[:, 2] - scene.rest_energies[2]
    np.testing.assert_allclose(elastic, force**2 / (2 * K), rtol=0, atol=1e-6 * F**2 / K)


@pytest.mark.parametrize("speed", [0.5, -0.5])
@pytest.mark.parametrize("accuracy", among([1e-2, 1e-3, 1e-4], 1e-3))
def test_a_mass_that_is_caught_either_way(accuracy, speed):
    """m v^2/2 = F^2/(2 k) + F u at the farthest. Then it swings about the slider with F^2/(2 k), and slips no more."""
    scene, slides = sliding(speed)
    with engine_of(scene) as engine:
        engine.place(slides)
        steps = fitted_steps(engine, scene, slides, accuracy)
    books, given = ledger(scene, slides, steps), 0.5 * BLOCK.mass * speed**2
    slipped = (given - F**2 / (2 * K)) / F
    assert np.abs(steps.pose[:, 0]).max() == pytest.approx(F / K + slipped, rel=accuracy)
    assert np.sign(steps.pose[np.abs(steps.pose[:, 0]).argmax(), 0]) == np.sign(speed)
    assert books.ties[NAME][-1] == pytest.approx(F * slipped, rel=2 * accuracy)
    assert np.abs(books.residual).max() < 3 * accuracy * given
    back = steps.pose[steps.t > 0.2, 0] * np.sign(speed)
    assert back.min() < slipped < back.max()


@slow
def test_a_driven_block_takes_the_area_of_its_loop_in_every_cycle():
    """Steady motion under a sine: the account of a cycle is 4 F (d - F/k), d read from the response."""
    motion = mr.GroundMotion.sine(4.0, 0.5, cycles=12)
    case = mr.Case(BLOCK, 0.0, 6.0, side_stop=False, motion=motion, effects=mr.FrictionDamper(BLOCK.h, K, F))
    run = mr.simulate(case, ice(), accuracy=1e-4, ledger=True)
    damper, taken = run.ties[NAME], run.ledger.ties[NAME]
    cycle = (run.t >= 4.5) & (run.t <= 5.0)
    drawn = damper.elongation[cycle]
    amplitude = 0.5 * float(np.ptp(drawn))
    assert amplitude > 2 * F / K
    exact = 4 * F * (amplitude - F / K)
    assert float(np.ptp(taken[cycle])) == pytest.approx(exact, rel=5e-3)
    assert area(drawn, damper.force[cycle]) == pytest.approx(exact, rel=1e-2)
    assert np.abs(run.energy_residual).max() < 2e-3 * taken[-1]


def held_case(slip_force=1.5e3, *, side_stop=True, duration=1.0, **parts):
    effects = mr.FrictionDamper(3.0, 2e6, slip_force)
    return mr.Case(WALL, 0.5 * WALL.alpha, duration, side_stop=side_stop, effects=effects, **parts)


def contacts_of_wall():
    return mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=5e8)


@pytest.mark.parametrize("side_stop", [True, False])
@pytest.mark.parametrize(
    ("options", "within"), [slow(({}, 2e-3)), ({"accuracy": 1e-4}, 3e-4), slow(({"timestep": 1e-4}, 2e-3))]
)
def test_a_wall_that_slips_is_that_of_scipy(side_stop, options, within):
    case = held_case(side_stop=side_stop, duration=1.0 if side_stop else 2.0)
    exact, run = (
        mr.solve_compliant(case, contacts_of_wall()),
        mr.simulate(case, contacts_of_wall(), ledger=True, **options),
    )
    assert mr.compare(exact, run).rms < within
    assert np.abs(run.energy_residual).max() < 3e-3 * run.energy[0]
    spent = exact.plastic[NAME].energy
    assert spent > 0.3 * run.energy[0]
    assert run.plastic[NAME].energy == pytest.approx(spent, rel=5e-3)
    assert run.ties[NAME].largest_force == pytest.approx(1.5e3)
    assert run.ties[NAME].force.min() < -1.4e3  # it pushes too


@pytest.mark.parametrize("side_stop", [True, slow(False)])
def test_explicit_steps_slip_as_mujoco_does(side_stop):
    case = held_case(side_stop=side_stop, duration=0.8)
    run, steps = (
        mr.simulate(case, contacts_of_wall(), accuracy=1e-4),
        mr.solve_explicit(case, contacts_of_wall(), ledger=True),
    )
    assert mr.compare(run, steps).rms < 5e-3
    assert steps.plastic[NAME].energy == pytest.approx(run.plastic[NAME].energy, rel=0.01)
    assert steps.ties[NAME].force.min() < -1.4e3
    assert np.abs(steps.energy_residual).max() < 5e-3 * steps.energy[0]


@pytest.mark.slow
def test_a_shaken_wall_slips_as_that_of_scipy():
    case = mr.Case(WALL, 0.0, 1.5, motion=mr.GroundMotion.sine(3.0, 0.8), effects=mr.FrictionDamper(3.0, 2e6, 1.5e3))
    exact, run = mr.solve_compliant(case, contacts_of_wall()), mr.simulate(case, contacts_of_wall(), ledger=True)
    assert mr.compare(exact, run).rms < 2e-3
    assert run.ledger.ties[NAME][-1] > 0.1 * run.ledger.ground[-1] > 0
    assert np.abs(run.energy_residual).max() < 5e-3 * run.ledger.ground.max()


def test_the_twin_without_the_damper_is_another_motion():
    bare, held = (mr.simulate(held_case(force), contacts_of_wall()) for force in (1e-3, 1.5e3))
    assert np.abs(held.theta - bare.theta).max() > 0.02 * WALL.alpha


def test_a_wall_at_rest_does_not_feel_it():
    """Under a thrust that leans it, the wall stands as it does without: the damper is put in when it stands."""
    thrust = mr.Thrust(4.0, 1e3)
    bare, held = (
        mr.scene_of(mr.Case(WALL, 0.0, 1.0, effects=effects), contacts_of_wall())
        for effects in (thrust, (thrust, mr.FrictionDamper(3.0, 2e8, 1e5)))
    )
    np.testing.assert_array_equal(bare.at_rest, held.at_rest)
    np.testing.assert_array_equal(bare.rest_energies, held.rest_energies)
    run = mr.simulate(mr.Case(WALL, 0.0, 0.2, effects=(thrust, mr.FrictionDamper(3.0, 2e8, 1e5))), contacts_of_wall())
    assert np.abs(run.pose - held.at_rest).max() < 1e-7
    assert np.abs(run.ties[NAME].force).max() < 30.0


def test_stock_mujoco_has_the_damper_of_the_text():
    """The text alone slips: MuJoCo's own plastic state."""
    case = held_case(duration=0.6, side_stop=False)
    scene = mr.scene_of(case, contacts_of_wall())
    falls = course(scene, duration=0.6, pose=scene.lowered(WALL.pose(np.array([0.5 * WALL.alpha]))))
    steps = fixed_steps(scene, falls, 1e-4)
    data = stock_takes(steps.pose, released_mjcf(scene, falls, 1e-4), 1e-12)
    assert data.plastic[0] == data.plastic[1] < scene.ties.reach[0] + 0.9 * (0.5 * WALL.alpha * 3.0)


def test_push_over_is_that_of_a_tie_without_slack():
    tie, damper = mr.Tie(3.0, 2e6, strength=1.5e3), mr.FrictionDamper(3.0, 2e6, 1.5e3)
    for contacts in (None, contacts_of_wall()):
        tied, held = (mr.pushover(mr.Case(WALL, 0.0, 1.0, effects=one), contacts) for one in (tie, damper))
        at = np.linspace(1e-3, 0.9 * WALL.alpha, 50)
        curves = (np.interp(at, curve.rotation, curve.multiplier) for curve in (tied, held))
        np.testing.assert_allclose(*curves, rtol=2e-3)
    # but friction brings no wall back
    held, bare = (mr.Case(WALL, 0.0, 1.0, effects=effects) for effects in (damper, ()))
    assert held.overturning_rotation == bare.overturning_rotation


@pytest.mark.parametrize(
    ("solve", "options"), [(mr.simulate, {"accuracy": 1e-4}), (mr.solve_explicit, {})], ids=["MuJoCo", "explicit"]
)
def test_blocks_in_space_slip_as_those_of_the_plane(solve, options):
    """A block on a stiff bed, kicked against a damper to the ground: prism and polygon."""
    kick, damper = 0.4, {"stiffness": 2e6, "slip_force": 3e3}
    plane = mr.Masonry(
        [
            mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True),
            mr.Polygon([(-0.5, 0), (0.5, 0), (0.5, 1), (-0.5, 1)]),
        ],
        k_n=1e9, friction=0.2, xi=0.05,
    )  # fmt: skip
    space = mr.Masonry(
        [mr.Polyhedron.box((4, 1, 1), (0, 0, -0.5), fixed=True), mr.Polyhedron.box((1, 1, 1), (0, 0, 0.5))],
        k_n=1e9, friction=0.2, xi=0.05,
    )  # fmt: skip
    flat = mr.MasonryCase(plane, 0.3, velocity=[[kick, 0, 0]], effects=mr.FrictionDamper(0.5, block=1, **damper))
    deep = mr.MasonryCase(
        space, 0.3, velocity=[[kick, 0, 0, 0, 0, 0]], effects=mr.FrictionDamper(at=(-0.5, 0, 0.5), block=1, **damper)
    )
    flat, deep = (solve(case, **options, ledger=True) for case in (flat, deep))
    assert flat.plastic[NAME].energy > 0.2 * flat.energy[0]
    assert deep.plastic[NAME].energy == pytest.approx(flat.plastic[NAME].energy, rel=0.02)
    assert np.abs(flat.ties[NAME].force - deep.ties[NAME].force[: len(flat.t)]).max() < 0.05 * 3e3
    for run in (flat, deep):
        assert np.abs(run.energy_residual).max() < 3e-3 * run.energy[0]
        assert run.ledger.ties[NAME][-1] == pytest.approx(run.plastic[NAME].energy, rel=1e-3)


def test_two_blocks_hold_each_other():
    """A damper between two blocks in space pushes both: their momentum stays, but for the friction of the ground."""
    ground = mr.Polyhedron.box((9, 9, 1), (0, 0, -0.5), fixed=True)
    boxes = [mr.Polyhedron.box((1, 1, 1), (x, 0, 0.5)) for x in (-1.5, 1.5)]
    masonry = mr.Masonry([ground, *boxes], k_n=1e9, friction=1e-4, xi=0.05)
    damper = mr.FrictionDamper(
        stiffness=2e6, slip_force=3e3, block=2, at=(1.0, 0, 0.5), anchor=(-1.0, 0, 0.5), anchor_block=1
    )
    kick = [[0, 0, 0, 0, 0, 0], [0.5, 0, 0, 0, 0, 0]]
    run = mr.simulate(mr.MasonryCase(masonry, 0.5, velocity=kick, effects=damper), accuracy=1e-4, ledger=True)
    assert run.velocity[-1, :, 0].sum() == pytest.approx(0.5, rel=0.01)
    lost = 0.25 * 2000.0 * 0.5**2 - 0.5 * 3e3**2 / 2e6  # all but the motion of both, and the spring
    assert run.ledger.ties[NAME][-1] == pytest.approx(lost, rel=0.03)


def test_what_is_drawn_and_reported():
    case = held_case()
    texts = [text.get_text() for ax in mr.plotting.sketch(case).axes for text in ax.texts]
    assert "friction damper: z = 3 m,\nk = 2 kN/mm, slips at 1.5 kN" in texts
    requested = [text.get_text() for ax in mr.plotting.sketch(case, arguments=True).axes for text in ax.texts]
    assert "FrictionDamper(height, stiffness,\nslip_force, length)" in requested


@pytest.mark.parametrize(
    ("requested", "complaint"),
    [
        (lambda: mr.FrictionDamper(-1.0, K, F), "height of the friction damper = -1 m is outside the valid range 0 to"),
        (lambda: mr.FrictionDamper(1.0, 0.0, F), "stiffness of the friction damper = 0 N/m is outside the valid range"),
        (lambda: mr.FrictionDamper(1.0, K, 0.0), "slip_force of the friction damper = 0 N is outside the valid range"),
        (lambda: mr.FrictionDamper(1.0, K, math.inf), "slip_force of the friction damper = inf N is"),
        (lambda: mr.FrictionDamper(1.0, K, F, length=0.0), "length of the friction damper = 0 m is outside"),
        (lambda: mr.Case(WALL, 0.0, 1.0, effects=mr.FrictionDamper(5.0, K, F)), "height of the FrictionDamper = 5 m"),
        (lambda: mr.solve_analytical(held_case(), E), f"rocking theory has links that only pull, and {NAME} is none"),
        (
            lambda: mr.simulate(held_case(), contacts_of_wall(), start=(np.zeros((1, 3)), np.zeros((1, 3)))),
            "do not say how far .* has yielded",
        ),
    ],
)
def test_what_is_refused(requested, complaint):
    with pytest.raises(ValueError, match=complaint):
        requested()


def test_a_model_is_shared_by_what_a_damper_bears_nothing_at():
    """The stiffness of contacts is set with each step, and a damper bears nothing at rest, which goes by it."""
    stiffnesses = [mr.Contacts.from_damping(WALL, k_base=k, xi_base=0.05) for k in (5e7, 5e8)]
    for effects, shared in (((), True), (mr.FrictionDamper(3.0, K, F), False)):
        case = mr.Case(WALL, 0.0, 1.0, side_stop=False, effects=effects)
        soft, stiff = (mr.wall_scene(case, contacts).key for contacts in stiffnesses)
        assert (soft == stiff) == shared
