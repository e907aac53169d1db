"""Single steps that fit the motion: a block slides on ice towards its side stop."""

import numpy as np
import pytest
from scenes import changed, course

import mjrock as mr
from mjrock.engine.loop import CLOCK, Progress, fitted_loop
from mjrock.engine.mjcf import pair_rows
from mjrock.engine.model import engine_of
from mjrock.engine.record import Record
from mjrock.engine.setting import Setting
from mjrock.engine.sliding import Sliding
from mjrock.engine.step_control import StepControl, short_step
from mjrock.engine.stepping import fitted_steps
from mjrock.engine.sticking import Joints
from mjrock.engine.touches import Openings, Touches, hardest_touch, predict_touches
from mjrock.geometry.kinematics import gaps
from mjrock.method import METHOD
from mjrock.problem.wall.effect import LinkLaw
from mjrock.rows import rows
from mjrock.scene.parts import ConstantForces, Links
from mjrock.scene.wall import wall_scene

BLOCK = mr.Block.from_size(2.0, 2.0)
ACCURACY, SPEED = 1e-3, 0.5


@pytest.fixture(scope="module")
def ice():
    """The block on a base without friction, a metre before a side stop that has none either."""
    contacts = mr.Contacts.from_damping(
        BLOCK, k_base=5e8, xi_base=0.05, k_side=3e8, xi_side=0.02, friction=0.0, side_friction=0.0
    )
    return wall_scene(mr.Case(BLOCK, 0.0, 1.0), contacts)


def one_step(scene, away, h, energy=0.5 * BLOCK.mass * SPEED**2, *, abrupt=False):
    """The clock after a step of the block, `away` from the stop and moving towards it, and the step itself.

    The control allows the step h, as long as the last. The acceleration in the last step was zero.
    """
    start = scene.at_rest + np.array([away, 0.0, 0.0])
    slides = course(scene, [[-SPEED, 0.0, 0.0]], 1.0, pose=start)
    control, setting = StepControl.from_scene(scene, slides, ACCURACY), Setting.of_run(scene, slides)
    with engine_of(scene) as engine:
        engine.set_step(h, pair_rows(scene, h, 0.25))
        engine.release(slides)
        engine.memory.velocity[:] = [-SPEED, 0.0, 0.0]
        sliding = Sliding.at_start(setting.points, coulomb=True)
        state = Progress.at_start(engine.memory, setting, Joints.of_scene(scene), sliding)
        record = Record.with_room(1, (3, 3), len(scene.contacts.k))
        state.acceleration[:], state.closed[:] = 0.0, gaps(scene.places, start)[0] < 0
        clocks = rows(CLOCK, 1, allowed=h, previous=h, energy=float(energy), unpredictable=abrupt)
        fitted_loop(engine.memory, setting, control, state, clocks, record)
    assert clocks[0].steps == 1
    return clocks[0], record


@pytest.mark.parametrize("share", [0.1, 0.9])
def test_a_step_ends_half_a_short_step_after_the_touch(ice, share):
    """The block arrives after a share of the step that is allowed; a step that does not arrive is left alone."""
    short = short_step(ice, ACCURACY)
    for h in (short, 4 * short):
        after, record = one_step(ice, share * h * SPEED, h)
        assert (after.touches, after.allowed, after.calm_steps, after.no_rate) == (1, short, 0, True)
        assert record.h[0] == after.previous == after.t == pytest.approx(share * h + 0.5 * short, rel=1e-9)
        after, record = one_step(ice, 1.1 * h * SPEED, h)
        assert (after.touches, record.h[0], after.no_rate) == (0, h, False)


@pytest.mark.parametrize("share", [0.98, 1.02])
def test_a_faint_touch_is_not_met(ice, share):
    """It is met where noticing it a step h late misplaces too much in one of the contacts.

    Too much is the share `faded` of accuracy x energy. What it misplaces is k (v h)^2 / 4 in the spring and c h v^2 in
    the dashpot.
    """
    h = 2 * short_step(ice, ACCURACY)
    misplaced = (0.25 * ice.contacts.k[-1] * h + ice.contacts.c[-1]) * h * SPEED**2
    after, _ = one_step(ice, 0.5 * h * SPEED, h, share * misplaced / (METHOD.faded * ACCURACY))
    assert after.touches == (1 if share < 1 else 0)


def test_no_touch_is_predicted_from_an_abrupt_step(ice):
    """A dashpot that has just thrown the velocity about says nothing of where the next step leads."""
    h = 2 * short_step(ice, ACCURACY)
    after, record = one_step(ice, 0.5 * h * SPEED, h, abrupt=True)
    assert (after.touches, record.h[0]) == (0, h)


@pytest.mark.parametrize("share", [0.98, 1.02])
def test_a_step_is_abrupt_that_takes_a_tenth_of_the_speed(ice, share):
    """The stop takes a share of `abrupt` of the speed of the last touch in one step. Speeds weigh with the masses."""
    h = short_step(ice, ACCURACY)
    _, record = one_step(ice, -1e-3, h)
    change = ice.bodies.masses @ (record.after[0] - record.before[0]) ** 2
    after, _ = one_step(ice, -1e-3, h, change / (share * METHOD.abrupt) ** 2)
    assert bool(after.unpredictable) is (share > 1)


@pytest.mark.parametrize("curve", [-30.0, 0.0, 4.0])
def test_when_a_gap_closes(curve):
    """The first root of g + g1 t + g2 t^2/2, and the closing speed there, whichever part of g2 has the curvature."""
    g, g1 = 0.01, -0.3
    t = min(root.real for root in np.roots([0.5 * curve, g1, g]) if root.real > 0)
    for parts in ((curve, 0.0), (3.0, curve - 3.0)):
        openings, touches = Openings.with_room(2), Touches(np.ones(2), *np.zeros((3, 2)))
        for i, opening in enumerate([(1.0, -0.3, 0.0, 0.0), (g, g1, *parts)]):
            openings.value[i], openings.rate[i], openings.linear[i], openings.swept[i] = opening
        assert predict_touches(touches, openings, 1.01 * t, 1.0, 0.0) == pytest.approx(t)
        assert (touches.time[1], touches.speed[1]) == pytest.approx((t, -(g1 + curve * t)))
        assert touches.time[0] == np.inf
        assert predict_touches(touches, openings, 0.99 * t, 1.0, 0.0) == np.inf
        openings.value[1] = -1e-9  # it is closed already
        assert predict_touches(touches, openings, 1.0, 1.0, 0.0) == np.inf


def test_the_hardest_of_the_touches_in_a_short_window_is_met():
    times, speeds = np.array([0.3, 0.2, 0.25, 0.31, np.inf]), np.array([0.1, 0.5, 0.9, 2.0, 9.0])
    touches = Touches(*np.zeros((2, 5)), times, speeds)
    assert [hardest_touch(touches, latest) for latest in (0.2, 0.24, 0.3, 0.31)] == [0.2, 0.2, 0.25, 0.31]


def test_a_tie_that_has_yielded_is_met_where_it_now_goes_taut():
    """A block on ice is pulled against a tie, stretches it for good, springs back, and is pulled against it again."""
    contacts = mr.Contacts.from_damping(BLOCK, k_base=5e8, xi_base=0.05, friction=0.0)
    standing = wall_scene(mr.Case(BLOCK, 0.0, 1.0, side_stop=False), contacts)
    tie = Links(("tie",), [0], [(0.0, 0.0)], [-1], [(-5.0, BLOCK.h)], [LinkLaw(2e6, 5.02, 2e4)])
    scene = changed(standing, links=tie, forces=ConstantForces(("pull",), [0], [(0.0, 0.0)], [(4e3, 0.0)]))
    pulled = course(scene, [[SPEED, 0.0, 0.0]], 1.0)
    with engine_of(scene) as engine:
        engine.place(pulled)
        steps = fitted_steps(engine, scene, pulled, ACCURACY)
    elongation = scene.accounts(steps.pose, steps.velocity)[1][-1, 0] / 2e4
    assert elongation > 0.04
    beyond = steps.pose[:, 0] - 0.02 - elongation
    again = np.flatnonzero((beyond[:-1] <= 0) & (beyond[1:] > 0) & (steps.t[1:] > steps.t[beyond.argmax()]))[0] + 1
    assert steps.h[again] == short_step(scene, ACCURACY)
    assert beyond[again] / steps.record.before[again, 0] == pytest.approx(0.5 * steps.h[again], rel=0.02)


def test_changes_are_measured_by_a_share_of_the_present_energy_at_least(ice):
    """A change that is abrupt for what touched last is none for a block that is much faster now."""
    h = short_step(ice, ACCURACY)
    _, record = one_step(ice, -1e-5, h)
    now = METHOD.faster * ice.bodies.masses @ record.after[0] ** 2
    change = ice.bodies.masses @ (record.after[0] - record.before[0]) ** 2
    assert change < 0.5 * METHOD.abrupt**2 * now
    assert not one_step(ice, -1e-5, h, 0.5 * change / METHOD.abrupt**2)[0].unpredictable
