import dataclasses
import math
from collections import OrderedDict
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

import mjrock as mr
from mjrock.engine import model
from mjrock.engine import run as engine_run
from mjrock.engine.model import Engine
from mjrock.method import METHOD
from mjrock.result.ledger import StepError
from mjrock.scene.time_step import ENERGY_GAIN
from mjrock.scene.wall import inner_friction
from scripts.shared.paper import K_N


def test_the_automatic_step_follows_the_stiffest_contact(wall, contacts):
    free = mr.automatic_timestep(wall, contacts, side_stop=False)
    stopped = mr.automatic_timestep(wall, contacts, side_stop=True)
    vertical = math.sqrt(contacts.base.stiffness.sum() / wall.mass)
    assert free == pytest.approx(2 * math.sqrt(1e-3) / vertical)
    assert stopped < free
    stiffer = mr.Contacts.from_damping(wall, k_base=4 * K_N, xi_base=0.05)
    assert mr.automatic_timestep(wall, stiffer, side_stop=False) == pytest.approx(free / 2)


def test_the_step_is_taken_as_given(two_sided, contacts):
    run = mr.simulate(two_sided, contacts, timestep=1e-3)
    assert run.stats["timestep"] == 1e-3
    assert run.t[-1] == pytest.approx(two_sided.duration)
    assert len(run.t) == run.stats["steps"]


def test_output_step_thins_the_samples_and_nothing_else(one_sided, contacts):
    every = mr.simulate(one_sided, contacts, 1e-4)
    thinned = mr.simulate(one_sided, contacts, 1e-4, output_step=1e-3)
    assert len(thinned.t) == pytest.approx(len(every.t) / 10, abs=1)
    np.testing.assert_array_equal(thinned.theta, every.theta[::10])
    np.testing.assert_array_equal(thinned.omega, every.omega[::10])
    np.testing.assert_allclose(thinned.peaks[:3], every.peaks[:3], rtol=1e-3)


def test_thinning_goes_on_across_chunks(one_sided, contacts, monkeypatch):
    options = ({"timestep": 1e-3, "output_step": 7e-3}, {})
    whole = [mr.simulate(one_sided, contacts, **chosen) for chosen in options]
    monkeypatch.setattr(model, "CHUNK", 100)
    monkeypatch.setattr(model, "_idle", OrderedDict())
    for chosen, once in zip(options, whole, strict=True):
        assert mr.simulate(one_sided, contacts, **chosen) == once


def test_velocities_are_synchronised_with_rotations(two_sided, contacts):
    run = mr.simulate(two_sided, contacts, 1e-3)
    flight = (run.t > 0.1) & (run.t < 0.6)
    np.testing.assert_allclose(np.gradient(run.theta, run.t)[flight], run.omega[flight], atol=3e-6)
    # the twin that must fail: half a step back, as the engine keeps it
    stale = np.interp(run.t - 0.5e-3, run.t, run.omega)
    assert np.abs(np.gradient(run.theta, run.t) - stale)[flight].max() > 1e-4


def test_energy_is_that_of_the_release_until_the_first_impact(two_sided, contacts):
    run = mr.simulate(two_sided, contacts, 1e-3)
    flight = run.t < 0.7
    np.testing.assert_allclose(run.energy[flight], run.energy[0], rtol=2e-4)


def test_the_same_call_gives_the_same_motion(one_sided, contacts):
    first, second = (mr.simulate(one_sided, contacts, 1e-3) for _ in range(2))
    np.testing.assert_array_equal(first.theta, second.theta)


def test_a_wall_at_rest_stays_at_rest(wall, contacts):
    run = mr.simulate(mr.Case(wall, 0.0, 5.0), contacts)
    assert np.abs(run.theta).max() < 1e-9
    assert run.outcome is mr.Outcome.AT_REST


def test_overturning_is_a_result(wall, contacts):
    for timestep in (None, 1e-3):
        run = mr.simulate(mr.Case(wall, 1.01 * wall.alpha, 10.0), contacts, timestep)
        assert run.outcome is mr.Outcome.OVERTURNED
        assert run.t[-1] < 10.0
        assert abs(run.theta[-1]) >= math.pi / 2


def test_leaning_the_other_way_is_the_mirror_image(wall, contacts):
    left, right = (mr.simulate(mr.Case(wall, s * 0.05, 2.0, side_stop=False), contacts, 1e-3) for s in (-1, 1))
    np.testing.assert_allclose(left.theta, -right.theta, atol=1e-9)


def test_a_push_at_release(wall, contacts, e):
    case = mr.Case(wall, 0.05, 1.5, omega0=0.1)
    reference, run = mr.solve_analytical(case, e), mr.simulate(case, contacts)
    assert run.omega[0] == pytest.approx(0.1, rel=1e-6)
    assert run.peaks[0] == pytest.approx(reference.peaks[0], rel=2e-3)


def test_energy_from_nowhere_is_an_error_that_names_a_sound_step(wall):
    """Central difference beyond its stability limit: the step is named, and the largest that would have been sound."""
    contacts = mr.Contacts.from_damping(wall, k_base=3e9, xi_base=0.001)
    case = mr.Case(wall, 0.5 * wall.alpha, 3.0, side_stop=False)
    sound = mr.automatic_timestep(wall, contacts, side_stop=False)
    with (
        pytest.warns(UserWarning, match="a step of 0.005 s does not resolve the contacts"),
        pytest.raises(mr.SimulationError, match=r"with a step of 0.005 s; the largest sound step is ") as caught,
    ):
        mr.simulate(case, contacts, 5e-3, newmark_beta=0.0)
    assert f"{sound:.3g} s" in str(caught.value)
    mr.simulate(case, contacts, sound, newmark_beta=0.0)  # and it is sound


@pytest.mark.parametrize(
    ("energy", "marks", "gain", "when"),
    [
        ([10.0, 11.0, 8.5], [0, 1, 2], 1.0, 2.0),
        ([10.0, 99.0, 11.0, 8.5], [0, 2, 3], 1.0, 4.0),  # a touch inside a step misplaces energy for a while
        ([10.0, 9.5, 10.25, 10.5], [0, 1, 2, 3], 1.0, 6.0),
        ([10.0, 9.0, 8.5], [0, 1, 2], 0.0, None),
        ([1.0], [0], 0.0, None),
    ],
)
def test_gain_from_peak_to_peak_is_what_counts(two_sided, contacts, energy, marks, gain, when):
    """A wall at heights in the air at which it has these energies [J], every two seconds, some of which are marked."""
    scene = mr.wall_scene(two_sided, contacts)
    pose = np.outer(energy, (0, 1 / two_sided.wall.weight, 0))
    windows = SimpleNamespace(t=2.0 * np.arange(len(energy)), pose=pose, velocity=np.zeros_like(pose))
    balance = engine_run.balance(scene, SimpleNamespace(windows=windows), np.zeros(len(energy)), np.array(marks))
    run = windows.t[marks], balance
    engine_run.require_no_gain(*run, 1.001 * gain / ENERGY_GAIN)
    if gain > 0:
        with pytest.raises(StepError, match=rf"^{gain:g} J, 0\.10% of the energy there was, appeared") as caught:
            engine_run.require_no_gain(*run, 0.999 * gain / ENERGY_GAIN)
        assert caught.value.t == when


@pytest.mark.filterwarnings("ignore")
def test_a_nan_or_a_warning_of_the_engine_is_an_error(two_sided, contacts, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)  # MuJoCo leaves MUJOCO_LOG.TXT where it warns
    released = Engine.release

    def thrown(engine, started):
        released(engine, started)
        engine.data.qvel[1] = 1e12

    monkeypatch.setattr(Engine, "release", thrown)
    with pytest.raises(
        mr.SimulationError, match=r"(MuJoCo warned|not finite).*with a step of 0.01 s; the largest sound"
    ):
        mr.simulate(two_sided, contacts, 1e-2)


def test_an_engine_that_weighs_contacts_otherwise_is_refused(two_sided, contacts, wall):
    text = mr.wall_mjcf(two_sided, contacts, 1e-3).replace(
        '<joint name="x"', '<joint name="y" type="slide" axis="0 1 0"/><joint name="x"'
    )
    text = text.replace('qpos="', 'qpos="0 ').replace('qvel="', 'qvel="0 ')
    with pytest.raises(mr.SimulationError, match="inverse weight"):
        Engine.from_model(mujoco.MjModel.from_xml_string(text), mr.wall_scene(two_sided, contacts))


@pytest.mark.parametrize("timestep", [0.0, -1e-3, math.nan, 2.0])
def test_bad_steps(two_sided, contacts, timestep):
    with pytest.raises(ValueError, match="timestep"):
        mr.simulate(two_sided, contacts, timestep)


def test_the_rows_of_the_wall_are_the_law(one_sided, contacts, wall):
    """During the side impact every solved normal force is max(0, -(k r + c v + m_i a)), friction and all."""
    h = 1e-4
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(one_sided, contacts, h))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    seen, sliding = set(), 0
    while data.time < 0.72:
        mujoco.mj_step1(model, data)
        mujoco.mj_step2(model, data)
        if data.time < 0.70:
            continue
        jacobian = np.reshape(data.efc_J, (data.nefc, model.nv))
        # the velocity that the rows saw is the one before this step's
        seen |= {model.pair(i).name for i in range(model.npair) if any(_is(model, c, i) for c in data.contact)}
        velocity = jacobian @ (data.qvel - h * data.qacc)
        acceleration = jacobian @ data.qacc
        for contact in data.contact:
            row = contact.efc_address
            name = next(n for n in (model.geom(g).name for g in contact.geom) if n[-1].isdigit())
            interface = contacts.base if name.startswith("base") else contacts.side
            i = int(name[-1])
            k, c = interface.stiffness[i], interface.damping[i]
            inertia = 1 / data.efc_R[row]
            force = -(k * contact.dist + c * velocity[row] + inertia * acceleration[row])
            # while an edge slides, the elliptic cone adds some of its friction to the normal force
            along = np.hypot(*data.efc_force[row + 1 : row + 3]) if contact.dim == 3 else 0.0
            mu = METHOD.held_friction if name == "base_1" else inner_friction(wall, contacts)
            slides = along > 0.999 * mu * data.efc_force[row]
            allowed = 1e-2 if slides else 1e-6
            sliding += slides and name == "base_1"
            assert data.efc_force[row] == pytest.approx(max(0.0, force), abs=allowed * wall.weight)
    assert {"base_0", "base_1", "side_1"} <= seen
    assert sliding < 20  # of 200 steps: the outer edge holds, the inner one gives way


def _is(model, contact, pair):
    return {model.pair_geom1[pair], model.pair_geom2[pair]} == set(contact.geom.tolist())


def test_contacts_in_place_of_a_case_without_them(two_sided, contacts):
    no_side = dataclasses.replace(contacts, side=None)
    assert mr.simulate(two_sided, no_side, 1e-3).outcome is mr.Outcome.TIME_ENDED


@pytest.mark.filterwarnings("ignore")
def test_a_run_that_breaks_down_leaves_the_next_one_alone(wall, contacts, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wild = mr.GroundMotion([0.0, 1e13, 0.0], 0.1)
    case, shaken = (mr.Case(wall, 0.3 * wall.alpha, 0.5, motion=m) for m in (None, wild))
    before = mr.simulate(case, contacts, 1e-3)
    with pytest.raises(mr.SimulationError):
        mr.simulate(shaken, contacts, 1e-3)
    np.testing.assert_array_equal(before.theta, mr.simulate(case, contacts, 1e-3).theta)


def test_energy_from_nowhere_is_noticed_on_a_shaken_base(wall, contacts, monkeypatch):
    """What the ground puts in is accounted for; the twin forgets a tenth of it."""
    case = mr.Case(wall, 0.0, 3.0, motion=mr.GroundMotion.sine(-3.0, 1.2))
    mr.simulate(case, contacts)
    work = engine_run.ground_work
    monkeypatch.setattr(engine_run, "ground_work", lambda *run: 0.9 * work(*run))
    with pytest.raises(mr.SimulationError, match="appeared from nowhere"):
        mr.simulate(case, contacts)


@pytest.mark.parametrize("points", [16, pytest.param(64, marks=pytest.mark.slow)])
def test_friction_holds_a_two_sided_bed(points):
    """However many lines share the load of an edge, the base stays where it is."""
    soft = mr.Block.from_slenderness(4.0, 2.1)
    contacts = mr.Contacts.from_damping(soft, k_base=5e7, xi_base=0.03, points=points)
    case = mr.Case(soft, 0.5 * soft.alpha, 2.5, side_stop=False)
    run, law = mr.simulate(case, contacts), mr.solve_compliant(case, contacts)
    assert run.restitution[0] == pytest.approx(law.restitution[0], rel=1e-3)
    assert abs(run.stats["base_displacement"]) < 0.005


SLIPPERY_ARCH = mr.MasonryCase(mr.Masonry.arch(5.0, 0.7, voussoirs=5, friction=0.0), 1.0)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({}, "cannot stand"),
        ({"accuracy": 1.0}, "accuracy = 1 is outside"),
        ({"newmark_beta": -1.0}, "newmark_beta = -1 is outside"),
        ({"timestep": 2.0}, "timestep = 2 s is outside"),
        ({"timestep": 1e-9}, "the steps of this run would be"),
        ({"output_step": 3.0}, "output_step = 3 s is outside"),
        ({"output_step": 1e-9}, "the samples of this answer would be"),
        ({"coulomb": 1}, "coulomb = 1 of type int"),
        ({"ledger": 1}, "ledger = 1 of type int"),
        ({"start": 0}, "start = 0 of type int"),
        ({"method": 0}, "method = 0 of type int"),
    ],
)
def test_options_are_refused_before_the_rest_of_masonry_is_sought(options, complaint):
    """The arch has no friction and cannot stand: who looks for its rest finds that."""
    with pytest.raises((TypeError, ValueError), match=complaint):
        mr.simulate(SLIPPERY_ARCH, **options)
