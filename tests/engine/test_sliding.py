"""Contacts that slide obey Coulomb's law: against closed forms, and against an integration with rigid friction."""

import functools

import numpy as np
import pytest
from explicit_blocks import explicit
from masonry_blocks import box

import mjrock as mr
from mjrock.engine import model as engine_model
from mjrock.scene.wall import wall_course

WALL = mr.Block.from_size(0.6, 4.2)
LEVEL = mr.Polygon([(-19, -1), (19, -1), (19, 0), (-19, 0)], fixed=True)
SPEED, MU = 4.0, 0.5
CUBE = mr.Masonry((LEVEL, box(-0.25, 0.25, 0, 0.5)), k_n=1e9, friction=MU, xi=0.05)


def thrown(**options):
    """A cube that is thrown along level ground: rise [m], rotation [rad], and where it comes to rest [m]."""
    case = mr.MasonryCase(CUBE, 1.2, velocity=[[SPEED, 0, 0]])
    answer = mr.simulate(case, **options)
    x, z, theta = np.moveaxis(answer.pose[:, 0], 1, 0)
    return z.max() - z[0], np.abs(theta).max(), x[-1]


@pytest.mark.parametrize(("options", "rise"), [({}, 1e-5), ({"accuracy": 1e-4}, 1e-6), ({"accuracy": 1e-5}, 1e-6)])
def test_a_thrown_cube_stays_on_the_ground(options, rise):
    """It stops after v^2 / (2 mu g). The springs under it tilt it by less than a tenth of a milliradian."""
    risen, turned, place = thrown(**options)
    assert risen < rise
    assert turned < 1e-4
    assert place == pytest.approx(SPEED**2 / (2 * MU * mr.GRAVITY), rel=2e-4)


@pytest.mark.parametrize("options", [{}, {"accuracy": 1e-5}, {"timestep": 1e-4}])
@pytest.mark.filterwarnings("ignore:contacts that slide")
def test_the_rows_alone_lift_it(options):
    """The twin that must fail, by a hundred times what the law may lift it."""
    assert thrown(coulomb=False, **options)[0] > 100 * 1e-5


def test_fixed_steps_slide_when_they_are_asked_to():
    risen, turned, place = thrown(timestep=1e-4, coulomb=True)
    assert (risen < 1e-6, turned < 1e-4) == (True, True)
    assert place == pytest.approx(SPEED**2 / (2 * MU * mr.GRAVITY), rel=2e-4)
    with pytest.warns(UserWarning, match=r"pressed apart by \d+% of their normal force .* Pass coulomb=True"):
        thrown(timestep=1e-4)


def test_a_flag_that_is_none_is_refused():
    with pytest.raises(TypeError, match="coulomb = 1 of type int is neither True nor False"):
        thrown(coulomb=1)


def rebounds(wall, theta):
    """|e| of the rebounds, from the maxima of the rotation."""
    inner = theta[1:-1]
    peaks = inner[(inner > theta[:-2]) & (inner >= theta[2:]) & (inner > 2e-3 * wall.alpha)]
    energy = wall.potential_energy(np.append(0.5 * wall.alpha, peaks))
    return np.sqrt(energy[1:] / energy[:-1])


def rubbing(friction, side_friction):
    contacts = mr.Contacts.from_damping(
        WALL, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.012, friction=friction, side_friction=side_friction
    )
    return mr.Case(WALL, 0.5 * WALL.alpha, 1.3), contacts


@functools.cache
def exact(friction, side_friction):
    case, contacts = rubbing(friction, side_friction)
    scene = mr.wall_scene(case, contacts)
    return rebounds(WALL, explicit(scene, wall_course(case, scene), 2e-6, 100)[1][:, 0, 2])


@pytest.mark.parametrize(("friction", "side_friction"), [(0.8, 0.6), (0.8, 0.0), (3.0, 0.6), (0.5, 0.3)])
@pytest.mark.parametrize(("accuracy", "within"), [(1e-3, 5e-3), (1e-4, 1e-3)])
def test_restitution_against_a_side_that_rubs(friction, side_friction, accuracy, within):
    found = mr.simulate(*rubbing(friction, side_friction), accuracy=accuracy)
    assert found.restitution[0] == pytest.approx(exact(friction, side_friction)[0], rel=within)


def test_the_rows_alone_lose_a_quarter_too_much_there():
    """The twin that must fail."""
    found = mr.simulate(*rubbing(0.8, 0.6), accuracy=1e-5, coulomb=False)
    assert found.restitution[0] < 0.8 * exact(0.8, 0.6)[0]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_facade_that_rubs_under_a_record(seed):
    """Peaks of a façade whose side rubs, within half a percent at an accuracy of 1e-4."""
    wall = mr.Block.from_size(0.65, 9.0, 6.0, 1600.0)
    contacts = mr.Contacts.from_damping(
        wall, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.012, friction=0.7, side_friction=0.4
    )
    motion = mr.GroundMotion.synthetic(peak=3.4, duration=6.0, seed=seed)
    case = mr.Case(wall, 0.0, 6.0, motion=motion)
    scene = mr.wall_scene(case, contacts)
    _, pose = explicit(scene, wall_course(case, scene), 2e-6, 500)
    peak = np.abs(pose[:, 0, 2]).max()
    assert 0.1 * wall.alpha < peak < wall.alpha
    assert np.abs(mr.simulate(case, contacts, accuracy=1e-4).theta).max() == pytest.approx(peak, rel=5e-3)


def scenes(count, seed):
    """Stacks, arches and bonded walls on random joints, released with random velocities."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        joints = {"k_n": 10 ** rng.uniform(8, 11), "friction": rng.uniform(0.3, 1.0), "xi": rng.uniform(0.01, 0.5)}
        match rng.integers(3):
            case 0:
                blocks = [mr.Block(0.5 * rng.uniform(0.5, 1.2), 0.5 * rng.uniform(1.2, 2.0))] * int(rng.integers(1, 6))
                masonry = mr.Masonry.stack(blocks, **joints)
            case 1:
                radius = rng.uniform(1, 6)
                masonry = mr.Masonry.arch(
                    radius, radius * rng.uniform(0.18, 0.3), 2.5, int(rng.integers(4, 12)), **joints
                )
            case _:
                masonry = mr.Masonry.running_bond(
                    1.0, 0.25 * int(rng.integers(1, 4)), (0.5, 0.25), thickness=0.3, **joints
                )
        velocity = rng.normal(0, 0.1, (len(masonry.free), 3)) * (1, 0, 1)
        yield mr.MasonryCase(masonry, 0.12, velocity=velocity)


def closure(case):
    """Largest residual of the ledger, and the most that the account of friction runs back, over the energy put in."""
    run = mr.simulate(case, accuracy=1e-4, ledger=True)
    scale = float(run.energy[0]) + float(run.ledger.elastic.max())
    return np.abs(run.energy_residual).max() / scale, -np.diff(run.ledger.friction).min() / scale


@pytest.mark.parametrize("case", list(scenes(12, 3)), ids=range(12))
def test_the_ledger_closes_after_a_kick(case):
    residual, back = closure(case)
    assert residual < 1e-3
    assert back < 1e-5


@pytest.mark.slow
def test_the_ledger_closes_after_seventy_kicks():
    residuals, back = np.array([closure(case) for case in scenes(70, 4)]).T
    assert residuals.max() < 1e-3
    assert np.quantile(residuals, 0.9) < 3e-4
    assert back.max() < 1e-5


def test_joints_that_slide_at_too_long_a_step_are_named():
    bond = mr.Masonry.running_bond(1.5, 1.25, (0.5, 0.25), thickness=0.3, k_n=1e9, friction=0.4, xi=0.05)
    case = mr.MasonryCase(bond, 0.6, mr.GroundMotion.sine(9.0, 0.3))
    omega = mr.masonry_scene(case).highest_frequency
    with (
        pytest.warns(UserWarning, match="does not resolve the contacts"),
        pytest.raises(
            mr.SimulationError, match=r"joints that slide are unstable at a fixed step beyond .* s \(omega h = 4"
        ),
    ):
        mr.simulate(case, timestep=8 / omega)


def test_memory_that_is_too_small_is_an_error_and_not_the_end(monkeypatch):
    """The engine's own fatal error in a compiled loop would end the process."""
    whole = engine_model.scene_mjcf

    def tight(*arguments):
        return whole(*arguments).replace("<statistic", '<size memory="9000"/>\n  <statistic', 1)

    monkeypatch.setattr(engine_model, "scene_mjcf", tight)
    arch = mr.Masonry.arch(5.0, 0.9, voussoirs=11, k_n=3e9)
    with pytest.raises(mr.SimulationError, match="does not hold the 24 contact lines of this scene at once"):
        mr.simulate(mr.MasonryCase(arch, 0.1))
