"""Effects on a wall: three solvers against one another and against closed forms, and nothing where there is none."""

import math

import mujoco
import numpy as np
import pytest
from everyday import among

import mjrock as mr

WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, 5e8, 5e8)
STIFF = mr.Contacts.from_damping(WALL, k_base=2e10, xi_base=0.06, k_side=2e10, xi_side=0.02)
UP = mr.GroundMotion([0.3 * mr.GRAVITY] * 11, 1.0)

EFFECTS = {
    "load": (mr.Load(10e3, 4.2, 0.1),),
    "thrust": (mr.Thrust(4.0, 1000.0),),
    "mass": (mr.AddedMass(800.0, 4.0, 0.15),),
    "tie": (mr.Tie(3.0, 2e5, 0.01),),
    "yielding tie": (mr.Tie(3.0, 1e6, 0.01, 2e3),),
    "two ties, load, thrust, mass": (
        mr.Tie(3.0, 1e5, 0.02, 3e3, length=3.0, anchor_height=2.0),
        mr.Tie(1.5, 1e5, 0.0, 1e3),
        mr.Load(5e3, 4.2, -0.1),
        mr.Thrust(4.0, 500.0),
        mr.AddedMass(300.0, 4.2, 0.3),
    ),
}


def released(effects, **options):
    return mr.Case(WALL, 0.3 * WALL.alpha, options.pop("duration", 1.2), effects=effects, **options)


@pytest.mark.parametrize(
    "name", among([name for name in EFFECTS if "yield" not in name and "two" not in name], "thrust")
)
@pytest.mark.parametrize("side_stop", [True, False])
def test_mujoco_solves_the_contact_law_with_each_effect(name, side_stop):
    """MuJoCo against SciPy, which share no formula: the whole motion, and every peak."""
    case = released(EFFECTS[name], side_stop=side_stop)
    found, wanted = mr.simulate(case, CONTACTS, accuracy=1e-4), mr.solve_compliant(case, CONTACTS)
    np.testing.assert_allclose(found.peaks[:2], wanted.peaks[:2], rtol=1e-3)
    assert np.abs(np.interp(wanted.t, found.t, found.theta) - wanted.theta).max() < 6e-4 * WALL.alpha
    assert found.energy[0] == pytest.approx(wanted.energy[0], rel=1e-5)


@pytest.mark.parametrize("name", EFFECTS)
def test_theory_and_mujoco_fall_alike(name):
    """The first fall on a stiff base, up to the impact: the time that it takes, and the velocity."""
    case = released(EFFECTS[name])
    found, wanted = mr.simulate(case, STIFF), mr.solve_analytical(case, E)
    fall = wanted.t < wanted.impacts[0].t - 2e-3
    theta = np.interp(wanted.t[fall], found.t, found.theta)
    assert np.abs(theta - wanted.theta[fall]).max() < 2e-3 * WALL.alpha
    bare = mr.solve_analytical(released(()), E)
    assert abs(wanted.impacts[0].t / bare.impacts[0].t - 1) > 0.01  # the effect is felt


@pytest.mark.parametrize("name", EFFECTS)
def test_the_ledger_closes(name):
    run = mr.simulate(released(EFFECTS[name], motion=mr.GroundMotion.sine(2.0, 0.5, 2)), CONTACTS, ledger=True)
    assert run.ledger is not None
    put_in = run.energy[0] + np.abs(run.ledger.ground).max()
    assert np.abs(run.ledger.residual).max() < 3e-3 * put_in
    assert set(run.ledger.ties) == {f"tie_{i}" for i in range(sum(isinstance(one, mr.Tie) for one in EFFECTS[name]))}


# closed forms


@pytest.mark.parametrize("name", ["load", "thrust", "mass"])
@pytest.mark.parametrize("solver", ["theory", "MuJoCo"])
def test_the_end_of_the_softening_branch(name, solver):
    """A wall released below the rotation where its moments vanish comes back, and beyond it, it overturns."""
    case = released(EFFECTS[name])
    W, b, h = WALL.weight, 0.3, 2.1
    end = {
        "load": math.atan2(W * b + 10e3 * 0.2, W * h + 10e3 * 4.2),
        "thrust": math.atan2(W * b - 1000 * 4.0, W * h + 1000 * 0.3),
        "mass": math.atan2(W * b + 800 * mr.GRAVITY * 0.15, W * h + 800 * mr.GRAVITY * 4.0),
    }[name]
    assert case.overturning_rotation == pytest.approx(end, rel=1e-12)
    for share, outcome in ((0.98, None), (1.01, mr.Outcome.OVERTURNED)):
        tilted = mr.Case(WALL, share * end, 3.0, effects=EFFECTS[name])
        run = mr.solve_analytical(tilted, E) if solver == "theory" else mr.simulate(tilted, STIFF, accuracy=1e-2)
        assert (run.outcome is mr.Outcome.OVERTURNED) is (outcome is mr.Outcome.OVERTURNED)
        assert (run.peak_over_alpha == math.inf) is (outcome is mr.Outcome.OVERTURNED)


MULTIPLIER = {
    "none": ((), 0.3 / 2.1),
    "load": (EFFECTS["load"], (WALL.weight * 0.3 + 10e3 * 0.2) / (WALL.weight * 2.1)),
    "thrust": (EFFECTS["thrust"], (WALL.weight * 0.3 - 1000 * 4.0) / (WALL.weight * 2.1)),
    "mass": (
        EFFECTS["mass"],
        (WALL.weight * 0.3 + 800 * mr.GRAVITY * 0.15) / (WALL.weight * 2.1 + 800 * mr.GRAVITY * 4.0),
    ),
    "tie": (EFFECTS["tie"], 0.3 / 2.1),
}


@pytest.mark.parametrize("name", MULTIPLIER)
def test_the_multiplier_at_which_rocking_starts(name):
    """Theory lifts the wall when a growing push passes it. MuJoCo lifts it under 1.01, and not under 0.99 of it."""
    effects, multiplier = MULTIPLIER[name]
    ramp = mr.GroundMotion([0.0, -1.2 * multiplier * mr.GRAVITY], 1.0)
    lifted = mr.solve_analytical(mr.Case(WALL, 0.0, 1.0, motion=ramp, effects=effects), E)
    start = lifted.t[np.flatnonzero(lifted.theta > 0)[0] - 1]
    assert 1.2 * start == pytest.approx(1.0, abs=1.3e-3)
    for share in (0.99, 1.01):
        push = -share * multiplier * mr.GRAVITY
        slow = mr.GroundMotion([0.0, push, push, push], 1.0)
        run = mr.simulate(mr.Case(WALL, 0.0, 2.0, motion=slow, effects=effects), STIFF, accuracy=1e-2)
        assert bool(run.theta[-1] > 0.01 * WALL.alpha) is (share > 1)


def test_the_force_of_a_tie_its_plateau_and_its_plastic_work():
    """Elastic energy, force and plastic work follow from the elongation, and the elongation from the rotation."""
    case = mr.Case(WALL, 0.0, 0.6, omega0=0.2, effects=EFFECTS["yielding tie"])
    for run in (mr.simulate(case, STIFF, ledger=True), mr.solve_analytical(case, E)):
        peak = run.theta.max()
        d, z, length = 0.6, 3.0, 5.0
        x = length + d * (1 - math.cos(peak)) + z * math.sin(peak)
        up = d * math.sin(peak) - z * (1 - math.cos(peak))
        yielded = math.hypot(x, up) - length - 0.01 - 2e3 / 1e6
        assert yielded > 0.005
        assert run.plastic["tie_0"].elongation == pytest.approx(yielded, rel=3e-3)
        assert run.plastic["tie_0"].energy == pytest.approx(2e3 * yielded, rel=3e-3)
        if run.ledger is not None:
            assert run.ledger.ties["tie_0"][-1] == pytest.approx(2e3 * yielded, rel=3e-3)
            turned = np.argmax(run.theta)
            bare = case.restoring.energy(peak) + 0.5 * 2e3**2 / 1e6
            assert run.energy[turned] == pytest.approx(bare, rel=5e-3)


def test_a_tie_carries_no_impulse():
    case = released(EFFECTS["tie"], duration=1.5)
    theory = mr.solve_analytical(case, E)
    np.testing.assert_allclose(theory.restitution[:3], abs(E.lumped), rtol=1e-6)
    for run in (mr.simulate(case, CONTACTS), mr.simulate(released((), duration=1.5), CONTACTS)):
        assert run.restitution[0] == pytest.approx(abs(E.lumped), rel=0.02)


@pytest.mark.parametrize("side_stop", [True, False])
def test_a_constant_vertical_acceleration_is_another_gravity(side_stop):
    """1.3 g makes every motion faster by the root of 1.3."""
    heavy = mr.Case(WALL, 0.3 * WALL.alpha, 1.0, side_stop=side_stop, vertical=UP)
    plain = mr.Case(WALL, 0.3 * WALL.alpha, 1.2, side_stop=side_stop)
    quick, slow = mr.solve_analytical(heavy, E), mr.solve_analytical(plain, E)
    assert quick.impacts[0].t * math.sqrt(1.3) == pytest.approx(slow.impacts[0].t, rel=1e-7)
    np.testing.assert_allclose(quick.peaks[:2], slow.peaks[:2], rtol=1e-7)
    run = mr.simulate(heavy, STIFF, ledger=True)
    hit = quick.t < quick.impacts[0].t - 2e-3
    assert np.abs(np.interp(quick.t[hit], run.t, run.theta) - quick.theta[hit]).max() < 2e-3 * WALL.alpha
    assert run.ledger is not None
    before = run.ledger.t < quick.impacts[0].t - 2e-3
    fallen = run.pose[0, 0, 1] - np.interp(run.ledger.t, run.t, run.pose[:, 0, 1])
    np.testing.assert_allclose(
        run.ledger.ground[before], 0.3 * WALL.weight * fallen[before], atol=2e-3 * run.ledger.ground.max()
    )


@pytest.mark.parametrize(("friction", "slides"), [(0.13, True), (0.2, False)])
def test_slide_or_rock(friction, slides):
    """Under a growing push a wall slides first where mu < b/h = 0.143, and rocks first where it is larger."""
    contacts = mr.Contacts.from_damping(WALL, k_base=5e9, xi_base=0.2, friction=friction)
    ramp = mr.GroundMotion([0.0, -0.1 * mr.GRAVITY, -0.2 * mr.GRAVITY], 1.0)
    run = mr.simulate(mr.Case(WALL, 0.0, 1.9, side_stop=False, motion=ramp), contacts)
    slid = abs(run.stats["base_displacement"])
    assert bool(slid > 5e-3) is slides
    assert bool(run.theta.max() > 0.02 * WALL.alpha) is not slides


def test_sliding_distance_against_rigid_coulomb():
    """A squat block on one sine of 6 m/s2 slides as far as a rigid one."""
    squat = mr.Block.from_size(1.0, 1.0)
    contacts = mr.Contacts.from_damping(squat, k_base=5e9, xi_base=0.3, friction=0.4)
    motion = mr.GroundMotion.half_sine(6.0, 0.3)
    run = mr.simulate(mr.Case(squat, 0.0, 1.0, side_stop=False, motion=motion), contacts)
    x = v = 0.0
    dt = 1e-4
    for t in np.arange(0, 1.0, dt):
        push, most = -float(motion(t)), 0.4 * mr.GRAVITY
        if v == 0 and abs(push) <= most:
            continue
        new = v + dt * (push - most * math.copysign(1.0, v if v else push))
        v = 0.0 if v * new < 0 else new
        x += dt * v
    assert abs(x) > 0.01
    assert run.stats["base_displacement"] == pytest.approx(x, rel=0.01)


# walls with openings and partial stops lose what momentum asks for


def test_a_wall_with_openings_loses_what_momentum_asks_for():
    wall = mr.Block.from_size(0.9, 3.6, 5.0, openings=[mr.Opening(3.5, 2.4), mr.Opening(1.0, 0.8, 2.6)])
    e = mr.Restitution.from_geometry(wall)
    assert e.base / mr.Restitution.from_geometry(mr.Block.from_size(0.9, 3.6)).base > 1.02
    contacts = mr.as_theory(wall, e, side_stop=False)
    run = mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 6.0, side_stop=False), contacts)
    np.testing.assert_allclose(run.restitution[:2], e.base, rtol=2e-3)


def test_a_partial_stop_is_matched_to_what_momentum_asks_for():
    stop = mr.SideStop(3.4)
    e = mr.Restitution.from_geometry(WALL, stop.top)
    assert abs(e.lumped) < 0.75 * abs(E.lumped)
    contacts = mr.matched_contacts(WALL, e, 5e8, 5e8, side_stop=stop, accuracy=1e-3)
    case = mr.Case(WALL, 0.5 * WALL.alpha, 1.2, side_stop=stop)
    assert mr.simulate(case, contacts).restitution[0] == pytest.approx(abs(e.lumped), rel=0.01)
    whole = mr.simulate(mr.Case(WALL, 0.5 * WALL.alpha, 1.2), contacts).restitution[0]
    assert abs(abs(whole / e.lumped) - 1) > 0.03  # another stop with the same damping loses something else
    assert mr.solve_analytical(case, e).restitution[0] == pytest.approx(abs(e.lumped))


# nothing paid when absent

ALONE = {
    "none": (WALL, {}, {"ntendon": 0, "nu": 0, "npair": 4}),
    "load": (WALL, {"effects": EFFECTS["load"]}, {"ntendon": 0, "nu": 1, "npair": 4}),
    "thrust": (WALL, {"effects": EFFECTS["thrust"]}, {"ntendon": 0, "nu": 1, "npair": 4}),
    "mass": (WALL, {"effects": EFFECTS["mass"]}, {"ntendon": 0, "nu": 0, "npair": 4}),
    "tie": (WALL, {"effects": EFFECTS["tie"]}, {"ntendon": 1, "nu": 0, "npair": 4}),
    "stop": (WALL, {"side_stop": mr.SideStop(3.0)}, {"ntendon": 0, "nu": 0, "npair": 4}),
    "no stop": (WALL, {"side_stop": False}, {"ntendon": 0, "nu": 0, "npair": 2}),
    "vertical": (WALL, {"vertical": UP}, {"ntendon": 0, "nu": 0, "npair": 4}),
    "openings": (
        mr.Block.from_size(0.6, 4.2, openings=[mr.Opening(0.5, 1.0)]),
        {},
        {"ntendon": 0, "nu": 0, "npair": 4},
    ),
}
SECTIONS = ("tendon", "actuator", "sensor", "equality")


@pytest.mark.parametrize("name", ALONE)
def test_a_scene_has_what_it_calls_for_and_nothing_else(name):
    block, options, sizes = ALONE[name]
    contacts = mr.Contacts.from_damping(block, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.01)
    text = mr.wall_mjcf(mr.Case(block, 0.05, 1.0, **options), contacts, 1e-3)
    model = mujoco.MjModel.from_xml_string(text)
    assert {size: getattr(model, size) for size in sizes} == sizes
    assert (model.nv, model.neq, model.nsensor) == (3, 0, 0)
    bare = mr.wall_mjcf(mr.Case(WALL, 0.05, 1.0), contacts, 1e-3) if block is WALL else None
    plain = mujoco.MjModel.from_xml_string(mr.wall_mjcf(mr.Case(WALL, 0.05, 1.0), CONTACTS, 1e-3))
    assert (model.opt.disableflags, model.opt.enableflags) == (plain.opt.disableflags, plain.opt.enableflags)
    present = {section for section in SECTIONS if f"<{section}>" in text}
    assert present == {section for section, key in zip(SECTIONS, ("ntendon", "nu"), strict=False) if sizes[key]}
    if name in ("vertical", "none"):
        assert text == bare  # a ground motion is not in the text


def test_effects_that_are_zero_change_nothing():
    nothing = (mr.Load(0.0, 4.2), mr.Thrust(4.0, 0.0), mr.AddedMass(0.0, 4.0))
    case, with_them = released(()), released(nothing)
    assert mr.solve_analytical(case, E).peaks == pytest.approx(mr.solve_analytical(with_them, E).peaks)
    np.testing.assert_allclose(mr.simulate(case, CONTACTS).theta, mr.simulate(with_them, CONTACTS).theta, atol=1e-6)


# refusals

REFUSED = [
    (lambda: mr.Tie(-1.0, 1e6), "height of the tie = -1 m is outside the valid range 0 to 200 m"),
    (lambda: mr.Tie(1.0, -1e6), r"stiffness of the tie = -1e\+06 N/m is outside"),
    (
        lambda: mr.Tie(1.0, 1e6, strength=-5.0),
        "strength of the tie = -5 N is outside the valid range 0 to 1e\\+12 N, or inf",
    ),
    (lambda: mr.Tie(1.0, 1e6, strength=math.nan), "strength of the tie = nan N is outside"),
    (lambda: mr.Tie(1.0, 1e6, slack=-0.01), "slack of the tie = -0.01 m is outside"),
    (lambda: mr.Thrust(1.0, math.inf), "force of the thrust = inf N is outside"),
    (lambda: mr.Load(-1.0, 1.0), "force of the load = -1 N is outside"),
    (lambda: mr.AddedMass(-1.0, 1.0), "added mass = -1 kg is outside"),
    (lambda: mr.SideStop(0.0), "top of the side stop = 0 m is outside"),
    (
        lambda: released((mr.Tie(5.0, 1e6),)),
        r"effects\[0\], height of the Tie = 5 m is outside the valid range 0 to 4.2 m",
    ),
    (
        lambda: released((mr.Load(1e3, 4.0, 0.4),)),
        r"effects\[0\], offset of the Load = 0.4 m is outside .* -0.3 to 0.3 m",
    ),
    (
        lambda: released((), side_stop=mr.SideStop(5.0)),
        "top of the side stop = 5 m is outside the valid range 0.01 to 4.2 m",
    ),
    (lambda: released((mr.SideStop(2.0),)), r"effects\[0\] = .* give it as side_stop"),
    (lambda: released((3.0,)), r"effects\[0\] = 3.0 of type float is not a Tie or Load or Thrust or Damper or"),
    (lambda: released("tie"), "effects = 'tie' of type str is not a sequence"),
    (lambda: released((mr.Tie(1.0, 1e6, block=2),)), r"effects\[0\], block = 2, is outside the valid range"),
    (
        lambda: released((mr.Thrust(4.0, 4000.0), mr.Load(1e3, 4.0, 0.2))),
        r"the loads and thrusts overturn the wall outwards as it stands: .* is -106\d N m, and no tie makes up for it;",
    ),
    (lambda: released((mr.Thrust(4.0, -4000.0),), side_stop=False), "overturn the wall inwards"),
    (lambda: released((), vertical=3), "vertical = 3 of type int is not a GroundMotion"),
    (
        lambda: mr.simulate(released(EFFECTS["yielding tie"]), CONTACTS, start=(np.zeros((1, 3)), np.zeros((1, 3)))),
        "do not say how far .* has yielded",
    ),
    (
        lambda: mr.solve_compliant(released(EFFECTS["yielding tie"]), CONTACTS),
        "solve_compliant has no ties that yield, and tie_0 has strength = 2000 N; .* take simulate or solve_analytical",
    ),
    (
        lambda: mr.solve_analytical(released((), vertical=mr.GroundMotion([-10.0, 0.0], 0.1)), E),
        "the vertical ground motion reaches -10 m/s2, which lifts the wall off its base; .* simulate has none",
    ),
    (
        lambda: mr.simulate(
            released((mr.Load(1e7, 4.2),)),
            mr.Contacts.from_damping(WALL, k_base=5e7, xi_base=0.05, k_side=5e7),
        ),
        r"base stiffness k_n = 5e\+07 N/m3 cannot hold the wall upright with its masses and loads; the valid range is",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("make", "complaint"), REFUSED)
def test_effects_that_cannot_be(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()


def test_a_wall_that_only_a_tie_holds_leans_on_it():
    """By hand: the moment of the thrust less that of the weight is the pull of the tie times its height."""
    wall = mr.Block.from_size(0.6, 9.0, 5.0, 1800.0)
    contacts = mr.Contacts.from_damping(wall, k_base=2e9, xi_base=0.02, k_side=2e9, xi_side=0.005)
    case = mr.Case(wall, 0.0, 0.3, effects=(mr.Thrust(8.8, 25e3), mr.Tie(6.0, 15e6, 0.01)))
    at = case.pulls[0]
    theta = 0.01 / 6.0
    for _ in range(20):  # (slack + pull / stiffness) / height
        lacking = 25e3 * (8.8 + 0.3 * theta) - wall.weight * (0.3 - 4.5 * theta)
        theta = (0.01 + lacking / 6.0 / at.stiffness) / 6.0
    for run in (mr.simulate(case, contacts), mr.solve_compliant(case, contacts)):
        assert run.theta[0] == pytest.approx(theta, rel=0.02)
        assert np.abs(run.theta - run.theta[0]).max() < 1e-4 * wall.alpha
    with pytest.raises(ValueError, match="rocking theory knows no rest but upright; simulate and solve_compliant do"):
        mr.solve_analytical(case, mr.Restitution.from_geometry(wall))


def test_a_wall_that_leans_rests_where_its_springs_carry_it():
    """A thrust tilts the base springs by its moment over their rotational stiffness; released there, nothing moves."""
    case = mr.Case(WALL, 0.0, 0.3, effects=(mr.Thrust(4.0, 1000.0),))
    stiffness = CONTACTS.base.K_rot - (WALL.weight * 2.1 + 1000 * 0.0)
    for run in (mr.simulate(case, CONTACTS), mr.solve_compliant(case, CONTACTS)):
        assert run.theta[0] == pytest.approx(4000.0 / stiffness, rel=2e-3)
        assert np.abs(run.theta - run.theta[0]).max() < 1e-4 * WALL.alpha
        assert run.outcome is mr.Outcome.AT_REST


def test_a_tie_says_where_it_is_and_what_it_bears():
    tie = mr.Tie(6.0, 22e6, 0.02, 110e3, 4.0, ultimate=0.05)
    assert tie.description == "z = 6 m, 4 m long,\nk = 22 kN/mm, slack 20 mm,\nyields at 110 kN, breaks at 50 mm"
