"""The accounts of dashpots, friction and the ground, against MuJoCo's own forces and against closed forms."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from everyday import among
from scenes import changed, course, fixed_steps, two_blocks

import mjrock as mr
from mjrock.engine import run as engine_run
from mjrock.engine.energy_work import ledger
from mjrock.engine.model import released_mjcf
from mjrock.geometry.kinematics import gaps
from mjrock.method import METHOD
from mjrock.scene.time_step import ENERGY_GAIN
from mjrock.scene.wall import wall_scene

SQUAT = mr.Block.from_size(2.0, 2.0)
"""A block that slides before it rocks."""


def taken_by_the_engine(model, data, scene, given, start, before, after, h):
    """Work that friction and the dashpots take in a step by MuJoCo's own forces and Jacobians [J], shape (2, m).

    Friction takes the work of the tangential forces along the slip, and that of what a sliding cone presses on top of
    the normal row f = -(k r + c v + m_i a). The dashpots take the rest of the normal row but for the spring's
    k (r + beta h^2 a), and where the row does not press what its spring has `given` in the step [J], shape (m,).
    Accounts begin at the `start`, which is the release in the first step and the velocity before the step else.
    """
    width = h if start is before else 0.5 * h
    jacobian, taken = np.reshape(data.efc_J, (data.nefc, model.nv)), np.array([np.zeros_like(given), given])
    mean, acceleration = jacobian @ (0.5 * (start + after)), jacobian @ (after - before) / h
    for contact in data.contact:
        i = next(i for i in range(model.npair) if {model.pair_geom1[i], model.pair_geom2[i]} == set(contact.geom))
        row, last = contact.efc_address, contact.efc_address + contact.dim
        law = max(0.0, (data.efc_aref[row] - acceleration[row]) / data.efc_R[row])
        taken[0, i] = -(data.efc_force[row:last] @ mean[row:last] - law * mean[row]) * width
        spring = -scene.contacts.k[i] * (contact.dist + 0.25 * h**2 * acceleration[row])
        if law > 0:
            taken[1, i] = (spring - law) * mean[row] * width
    return taken


@pytest.mark.parametrize("friction", among([0.05, 0.7], 0.7))
def test_the_accounts_are_the_work_of_the_engines_forces(friction):
    """Two blocks on soft joints that slide, stick, press and open: every step of both accounts, contact by contact.

    Each contact is a group of its own. The joints are so soft that friction acts centimetres from the points.
    """
    h, blocks = 2e-4, two_blocks(k_n=5e6, friction=friction, xi=0.05)
    names = tuple(f"line {i}" for i in range(4))
    scene = changed(blocks, contacts={"joint": range(4), "joints": names})
    thrown = np.array([[0.3, -0.1, 0.2], [1.0, -0.2, -0.4]])
    thrown = course(scene, thrown, 0.2)
    steps = fixed_steps(scene, thrown, h)
    books = ledger(scene, thrown, steps)
    model = mujoco.MjModel.from_xml_string(released_mjcf(scene, thrown, h))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    springs = 0.5 * scene.contacts.k * np.minimum(gaps(scene.places, steps.windows.pose), 0) ** 2
    exact = np.zeros((len(steps.t) - 1, 2, 4))
    for n in range(len(exact)):
        before = data.qvel.copy()
        mujoco.mj_step(model, data)
        start = before if n else thrown.velocity.ravel()
        exact[n] = taken_by_the_engine(model, data, scene, springs[n] - springs[n + 1], start, before, data.qvel, h)
    largest = np.abs(exact).max(axis=(0, 2))
    np.testing.assert_allclose(np.diff(books.friction), exact[:, 0].sum(axis=1), rtol=0, atol=1e-6 * largest[0])
    for i, name in enumerate(names):
        np.testing.assert_allclose(np.diff(books.dashpots[name]), exact[:, 1, i], rtol=0, atol=1e-6 * largest[1])


@pytest.mark.filterwarnings("ignore:contacts that slide")
@pytest.mark.parametrize(("coulomb", "while_it_slides", "in_all"), [(True, 1e-3, 2e-4), (False, 6e-3, 5e-4)])
def test_a_thrown_block_stops_after_v2_over_2_mu_g(coulomb, while_it_slides, in_all):
    """Friction takes m v^2/2 = mu m g s, and at every time before mu m g (v t - mu g t^2/2).

    The rows alone lift the block as friction sets in, and the dashpots take a little of what follows.
    """
    mu, speed = 0.2, 1.0
    contacts = mr.Contacts.from_damping(SQUAT, k_base=5e8, xi_base=0.05, friction=mu)
    case = mr.Case(SQUAT, 0.0, 0.7, side_stop=False)
    start = wall_scene(case, contacts).at_rest, np.array([[speed, 0.0, 0.0]])
    run = mr.simulate(case, contacts, 1e-4, coulomb=coulomb, start=start, ledger=True)
    t = np.minimum(run.ledger.t, speed / (mu * mr.GRAVITY))
    exact = mu * SQUAT.weight * (speed * t - 0.5 * mu * mr.GRAVITY * t**2)
    assert exact[-1] == pytest.approx(0.5 * SQUAT.mass * speed**2)
    np.testing.assert_allclose(run.ledger.friction, exact, rtol=0, atol=while_it_slides * exact[-1])
    assert run.ledger.friction[-1] == pytest.approx(exact[-1], rel=in_all)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_the_ledger_closes_for_a_block_that_a_pulse_slides(accuracy):
    """Friction takes nearly all that the ground puts in, and the residual is a small share of it."""
    contacts = mr.Contacts.from_damping(SQUAT, k_base=5e8, xi_base=0.05, friction=0.3)
    motion = mr.GroundMotion.sine(-6.0, 0.5)
    run = mr.simulate(
        mr.Case(SQUAT, 0.0, 1.0, side_stop=False, motion=motion), contacts, accuracy=accuracy, ledger=True
    )
    taken = run.ledger.friction[-1]
    assert taken > 0.99 * run.ledger.ground[-1] > 1000.0
    assert np.abs(run.energy_residual).max() < 0.2 * np.sqrt(accuracy) * taken


@pytest.mark.parametrize(("timestep", "most"), [(1e-4, 1e-5), (None, 1e-3)])
@pytest.mark.parametrize("held_masses", [1e1, 1e3])
def test_the_ledger_closes_whatever_the_method(timestep, most, held_masses, wall, contacts):
    """The accounts have the rows of the run: light friction rows creep, and friction takes what that costs."""
    case, method = mr.Case(wall, 0.5 * wall.alpha, 1.0), METHOD._replace(held_masses=held_masses)
    run = mr.simulate(case, contacts, timestep, accuracy=1e-4, ledger=True, method=method)
    assert np.abs(run.energy_residual).max() < most * run.energy[0]


def test_a_fixed_step_slides_by_the_method_too():
    """With contacts that are never taken to slide it is the run of the rows."""
    contacts = mr.Contacts.from_damping(SQUAT, k_base=5e8, xi_base=0.05, friction=0.3)
    case = mr.Case(SQUAT, 0.0, 0.5, side_stop=False, motion=mr.GroundMotion.sine(-6.0, 0.5))
    coulomb = mr.simulate(case, contacts, 1e-4, coulomb=True)
    never = mr.simulate(case, contacts, 1e-4, coulomb=True, method=METHOD._replace(slides=1e9))
    with pytest.warns(UserWarning, match="contacts that slide"):
        rows = mr.simulate(case, contacts, 1e-4, coulomb=False)
    np.testing.assert_allclose(never.pose, rows.pose, rtol=0, atol=1e-9)
    assert np.abs(coulomb.pose - rows.pose).max() > 1e-6


def test_on_ice_a_pushed_block_has_the_energy_that_was_put_in(monkeypatch):
    """Under a constant push energy and work agree to rounding where a window begins.

    At the pose half the work of the window has been done. All of it would leave m a v h / 2.
    """
    h, a = 1e-3, 2.0
    contacts = mr.Contacts.from_damping(SQUAT, k_base=5e8, xi_base=0.05, friction=0.0)
    motion = mr.GroundMotion([-a, -a], 1.0)
    case = mr.Case(SQUAT, 0.0, 0.5, side_stop=False, motion=motion)
    seen, honest = [], engine_run.balance

    def noted(scene, steps, work, marks):
        seen.append((scene, steps, work))
        return honest(scene, steps, work, marks)

    monkeypatch.setattr(engine_run, "balance", noted)
    run, (scene, steps, work) = mr.simulate(case, contacts, h), seen[-1]
    assert run.energy[-1] == pytest.approx(0.5 * SQUAT.mass * (a * run.t[-1]) ** 2, rel=1e-3)
    assert len(work) == len(steps.t)
    most, everywhere = 1e-9 * run.energy[-1], np.arange(len(steps.t))
    own = scene.accounts(steps.windows.pose, steps.windows.velocity)[0].sum(axis=1)
    own -= np.append(0.0, np.cumsum(work[:-1]))
    assert np.abs(own - own[0]).max() < most
    for sign in (1, -1):  # the check finds no gain, and in the mirror image no loss
        mirrored = SimpleNamespace(
            links=scene.links, accounts=lambda q, v, sign=sign: [sign * p for p in scene.accounts(q, v)]
        )
        balance = honest(mirrored, steps, sign * work, everywhere)
        engine_run.require_no_gain(steps.windows.t, balance, most / ENERGY_GAIN)


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_how_much_energy_may_appear(share, monkeypatch, two_sided, contacts):
    """ENERGY_GAIN of the energy of release, of the springs at rest, and of the work of the ground without its sign."""
    ice = mr.Contacts.from_damping(SQUAT, k_base=5e8, xi_base=0.05, friction=0.0)
    motion = mr.GroundMotion([-2.0, -2.0, 2.0, 2.0], 0.1)
    shaken, still = mr.Case(SQUAT, 0.0, 0.2, side_stop=False, motion=motion), mr.Case(SQUAT, 0.0, 0.2, side_stop=False)
    slid = mr.simulate(shaken, ice, 1e-3).energy  # the push speeds the block up and slows it down again
    honest = engine_run.balance

    def at_rest(block, contacts):
        """Energy of springs that carry a weight: half of it times the depth, W^2 / 2 K [J]."""
        return 0.5 * block.weight**2 / contacts.base.stiffness.sum()

    for case, made_of, most in (
        (two_sided, contacts, mr.simulate(two_sided, contacts, 1e-3).energy[0]),
        (shaken, ice, 2 * slid.max() - slid[-1]),
        (still, ice, 0.0),
    ):
        most += at_rest(case.wall, made_of)
        gain = share * ENERGY_GAIN * most

        def growing(scene, steps, work, marks, gain=gain):
            """The balance of a run in which nothing changes the energy but the ground, and some more that appears."""
            stored = np.append(0.0, np.cumsum(work))[marks]
            stored[-1] += gain
            accounts = stored[:, None], np.zeros((len(marks), 0))
            made_up = SimpleNamespace(links=scene.links, accounts=lambda q, v: accounts)
            return honest(made_up, steps, work, marks)

        monkeypatch.setattr(engine_run, "balance", growing)
        if share < 1:
            mr.simulate(case, made_of, 1e-3)
        else:
            with pytest.raises(mr.SimulationError, match=f"{share * ENERGY_GAIN:.2%} of the energy"):
                mr.simulate(case, made_of, 1e-3)
