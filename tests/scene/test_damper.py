"""A viscous damper between a wall and the building behind it."""

import math

import numpy as np
import pytest
from everyday import among, slow
from scenes import course, fixed_steps, stock_takes

import mjrock as mr
from mjrock.engine.energy_work import ledger
from mjrock.engine.model import engine_of, released_mjcf
from mjrock.engine.stepping import fitted_steps
from mjrock.scene.dampers import damping_rate

BLOCK = mr.Block.from_size(2.0, 2.0)
WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)
C = 4e3


def sliding(c):
    """A block on ice that a damper at the height of its centroid slows down, and its course at 0.5 m/s."""
    ice = mr.Contacts.from_damping(BLOCK, k_base=5e8, xi_base=0.05, friction=0.0)
    scene = mr.wall_scene(mr.Case(BLOCK, 0.0, 1.0, side_stop=False, effects=mr.Damper(BLOCK.h, c)), ice)
    return scene, course(scene, [[0.5, 0.0, 0.0]], 1.0)


@pytest.mark.parametrize("accuracy", among([1e-2, 1e-3, 1e-4], 1e-3))
def test_a_damper_slows_a_mass_down_as_a_dashpot_does(accuracy):
    """v = v0 exp(-c t / m), and what it has taken is what the block has lost."""
    scene, slides = sliding(2 * BLOCK.mass)
    with engine_of(scene) as engine:
        engine.place(slides)
        steps = fitted_steps(engine, scene, slides, accuracy)
    exact = 0.5 * np.exp(-2 * steps.t)
    assert np.abs(steps.velocity[:, 0] - exact).max() < accuracy * 0.5
    books, given = ledger(scene, slides, steps), 0.5 * BLOCK.mass * 0.25
    assert books.dashpots["damper_0"][-1] == pytest.approx(given * (1 - math.exp(-4 * books.t[-1])), rel=4 * accuracy)
    assert np.abs(books.residual).max() < 2 * accuracy * given


def wall_case(c=C, *, side_stop=True, duration=1.0):
    return mr.Case(WALL, 0.5 * WALL.alpha, duration, side_stop=side_stop, effects=mr.Damper(3.0, c))


@pytest.mark.parametrize("side_stop", [True, False])
@pytest.mark.parametrize(
    ("options", "within"), [slow(({}, 2e-4)), ({"accuracy": 1e-4}, 4e-5), slow(({"timestep": 1e-4}, 2e-3))]
)
def test_a_damped_wall_is_that_of_scipy(side_stop, options, within):
    contacts = mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=5e8)
    case = wall_case(side_stop=side_stop, duration=1.0 if side_stop else 2.0)
    exact = mr.solve_compliant(case, contacts)
    run = mr.simulate(case, contacts, ledger=True, **options)
    assert mr.compare(exact, run).rms < within
    assert run.restitution[0] == pytest.approx(exact.restitution[0], rel=0.03 if "timestep" in options else 2e-3)
    assert np.abs(run.energy_residual).max() < 3e-3 * run.energy[0]
    assert run.ledger.dashpots["damper_0"][-1] > 0.1 * run.energy[0]


@pytest.mark.slow
def test_a_shaken_wall_is_damped_too():
    """The ground and the damper push on the same joints."""
    motion = mr.GroundMotion.sine(3.0, 0.8)
    contacts = mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=5e8)
    case = mr.Case(WALL, 0.0, 1.5, motion=motion, effects=mr.Damper(3.0, C))
    exact, run = mr.solve_compliant(case, contacts), mr.simulate(case, contacts, ledger=True)
    assert mr.compare(exact, run).rms < 1e-3
    assert run.ledger.dashpots["damper_0"][-1] > 0.1 * run.ledger.ground[-1] > 0
    assert np.abs(run.energy_residual).max() < 5e-3 * run.ledger.ground.max()


def test_the_twin_without_the_damper_is_another_motion():
    contacts = mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=5e8)
    damped, bare = mr.simulate(wall_case(), contacts), mr.simulate(wall_case(0.0), contacts)
    assert np.abs(damped.theta - bare.theta).max() > 0.02 * WALL.alpha


def test_stock_mujoco_has_the_damper_of_the_text():
    contacts = mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=5e8)
    case = wall_case(duration=0.2)
    scene = mr.scene_of(case, contacts)
    falls = course(scene, duration=0.2, pose=scene.lowered(WALL.pose(np.array([0.5 * WALL.alpha]))))
    steps = fixed_steps(scene, falls, 1e-4)
    stock_takes(steps.pose, released_mjcf(scene, falls, 1e-4), 1e-12)


def test_a_damper_on_masonry():
    """The upper of two blocks is damped; the damper takes what the pair loses more."""
    half = mr.Block.from_size(0.6, 2.1)
    masonry = mr.Masonry.stack([half, half], k_n=1e9, friction=0.7)
    kick = [[0.0, 0.0, 0.0], [0.3, 0.0, 0.1]]
    damper = mr.Damper(3.0, 2e4, block=masonry.free[1])
    bare, damped = (
        mr.simulate(mr.MasonryCase(masonry, 0.5, velocity=kick, effects=effects), ledger=True)
        for effects in ((), damper)
    )
    assert damped.energy[-1] < 0.8 * bare.energy[-1]
    assert damped.ledger.dashpots["damper_0"][-1] > 0.1 * damped.energy[0]
    assert np.abs(damped.energy_residual).max() < 3e-3 * damped.energy[0]


@pytest.mark.parametrize(
    ("requested", "complaint"),
    [
        (lambda: mr.Damper(-1.0, 1e3), "height of the damper = -1 m is outside the valid range 0 to 200 m"),
        (lambda: mr.Damper(1.0, -1e3), "coefficient c of the damper = -1000 N s/m is outside the valid range"),
        (lambda: mr.Damper(1.0, math.nan), "coefficient c of the damper = nan N s/m is outside"),
        (lambda: mr.Damper(1.0, 1e3, length=0.0), "length of the damper = 0 m is outside the valid range"),
        (lambda: mr.Case(WALL, 0.0, 1.0, effects=mr.Damper(5.0, 1e3)), "height of the Damper = 5 m is outside"),
        (lambda: mr.solve_analytical(wall_case(), E), "rocking theory has links that only pull"),
    ],
)
def test_what_is_refused(requested, complaint):
    with pytest.raises(ValueError, match=complaint):
        requested()


@pytest.mark.parametrize("rate", [0.25, 30.0])
def test_the_rate_at_which_a_damper_slows_a_mass(rate):
    """c / m, and zero without dampers."""
    scene, _ = sliding(rate * BLOCK.mass)

    def slowed(dampers):
        return damping_rate(dampers, scene.potential.unmoved, scene.bodies.principal)

    assert slowed(scene.dampers) == pytest.approx(rate)
    contacts = mr.Contacts.from_damping(BLOCK, k_base=5e8, xi_base=0.05)
    assert slowed(mr.wall_scene(mr.Case(BLOCK, 0.0, 1.0, side_stop=False), contacts).dampers) == 0.0
