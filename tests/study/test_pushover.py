"""The static curve of a wall against closed forms, the independent solver, and MuJoCo driven slowly."""

import itertools
import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from everyday import among, slow

import mjrock as mr
from mjrock.reference.equations import Wall
from mjrock.study.loading.pushover import tilted

B, H, L, RHO, G = 0.3, 2.1, 1.5, 2000.0, 9.81
WEIGHT = 4 * B * H * L * RHO * G
SOFT, STIFF = 5e7, 5e10
WINDOW = mr.Opening(0.6, 1.0, 0.9)
DOOR = mr.Opening(0.5, 2.0)

EFFECTS = {
    "none": (),
    "load": (mr.Load(2e4, 4.2, -0.1),),
    "thrust": (mr.Thrust(3.9, 1.5e3),),
    "tie": (mr.Tie(3.0, 4e5),),
    "tie that yields": (mr.Tie(3.0, 2e6, slack=0.01, strength=3e3),),
    "tie to a low anchor": (mr.Tie(4.0, 1e5, strength=2e3, length=0.5, anchor_height=-3.0),),
    "added mass": (mr.AddedMass(800.0, 4.0, 0.2),),
    "all": (
        mr.Load(2e4, 4.2, 0.1), mr.Thrust(3.9, 5e2), mr.Tie(3.0, 2e6, slack=0.01, strength=3e3),
        mr.AddedMass(800.0, 4.0, -0.2),
    ),
}  # fmt: skip
WALLS = {"full": {}, "openings": {"openings": (WINDOW, DOOR)}, "inset": {"inset": 0.04}}
CASES = [(wall, "none") for wall in WALLS] + [("full", name) for name in EFFECTS if name != "none"] + [("inset", "all")]


def problem(wall, effects, **options):
    return mr.Case(mr.Block(B, H, L, RHO, **WALLS[wall]), 0.0, 1.0, effects=EFFECTS[effects], **options)


def on(case, k_n, points=2, xi=0.05):
    return mr.Contacts.from_damping(case.block, k_base=k_n, xi_base=xi, k_side=k_n, xi_side=0.01, points=points)


def closed_form(wall, effects, phi):
    """Multiplier of the rigid wall at increasing rotations, from the parts of the wall one by one."""
    inset = WALLS[wall].get("inset", 0.0)
    b = B - inset
    parts = [(WEIGHT, b, H)]
    parts += [
        (-2 * B * o.width * o.height * RHO * G, b, o.sill + o.height / 2) for o in WALLS[wall].get("openings", ())
    ]
    parts += [(a.mass * G, b - a.offset, a.height) for a in EFFECTS[effects] if isinstance(a, mr.AddedMass)]
    acting = np.array([(w * d, w * z) for w, d, z in parts]).sum(axis=0)
    P, Q = acting
    pull = np.zeros_like(phi)
    for one in EFFECTS[effects]:
        if isinstance(one, mr.Load):
            P, Q = P + one.force * (b - one.offset), Q + one.force * one.height
        elif isinstance(one, mr.Thrust):
            P, Q = P - one.force * one.height, Q + one.force * b
        elif isinstance(one, mr.Tie):

            def stretched(phi, tie=one):
                d, z = 2 * B - inset, tie.height
                rise = 0 if tie.anchor_height is None else tie.anchor_height - z
                across = tie.length + d * (1 - np.cos(phi)) + z * np.sin(phi)
                up = d * np.sin(phi) - z * (1 - np.cos(phi)) - rise
                return np.hypot(across, up) - math.hypot(tie.length, rise) - tie.slack

            elastic = np.maximum(0, stretched(phi) - np.maximum.accumulate(
                np.maximum(stretched(phi) - one.strength / one.stiffness, 0)))  # fmt: skip
            pull = pull + one.stiffness * elastic * (stretched(phi + 1e-6) - stretched(phi - 1e-6)) / 2e-6
    return (P * np.cos(phi) - Q * np.sin(phi) + pull) / (acting[1] * np.cos(phi) + acting[0] * np.sin(phi))


@pytest.mark.parametrize(("wall", "effects"), CASES)
def test_a_rigid_wall_has_the_closed_form(wall, effects):
    case = problem(wall, effects)
    phi = np.linspace(0, 0.25, 251)
    expected = closed_form(wall, effects, phi)
    curve = mr.pushover(case, rotations=phi)
    np.testing.assert_array_equal(curve.rotation, phi)
    np.testing.assert_allclose(curve.multiplier, expected, rtol=1e-6, atol=1e-7)
    assert curve.start == pytest.approx(expected[0], rel=1e-9)
    whole = mr.pushover(case)
    assert whole.multiplier[0] == whole.start == curve.start
    assert whole.end == pytest.approx(curve.end, rel=1e-6)
    if whole.end < math.inf:
        assert closed_form(wall, effects, np.linspace(0, whole.end, 500))[-1] == pytest.approx(0, abs=1e-5)
        assert (whole.rotation[-1], whole.multiplier[-1]) == (whole.end, 0)
        assert (whole.multiplier[:-1] > 0).all()
    dense = closed_form(wall, effects, np.linspace(0, min(whole.end, math.pi / 2), 20_001))
    assert whole.peak == pytest.approx(dense.max(), rel=2e-3)


def test_known_multipliers():
    assert mr.pushover(problem("full", "none")).start == pytest.approx(B / H, rel=1e-12)
    assert mr.pushover(problem("full", "none")).end == pytest.approx(math.atan(B / H), rel=1e-9)
    # W b + N d + T z - F z over W z
    load = mr.pushover(problem("full", "load"))
    assert load.start == pytest.approx((WEIGHT * B + 2e4 * 0.4) / (WEIGHT * H), rel=1e-12)
    thrust = mr.pushover(problem("full", "thrust"))
    assert thrust.start == pytest.approx((WEIGHT * B - 1.5e3 * 3.9) / (WEIGHT * H), rel=1e-12)
    assert thrust.end == pytest.approx(math.atan2(WEIGHT * B - 1.5e3 * 3.9, WEIGHT * H + 1.5e3 * B), rel=1e-6)
    assert mr.pushover(problem("full", "tie")).end == math.inf  # it does not yield


@pytest.mark.parametrize(("wall", "effects"), among(CASES, ("full", "tie"), ("inset", "all")))
def test_a_stiff_base_gives_the_rigid_curve(wall, effects):
    case = problem(wall, effects)
    phi = np.linspace(0.002, 0.1, 99)
    rigid, stiff = closed_form(wall, effects, phi), mr.pushover(case, on(case, STIFF), rotations=phi, points=50)
    np.testing.assert_allclose(stiff.multiplier, rigid, rtol=0.01, atol=1e-5)
    whole = mr.pushover(case, on(case, STIFF), points=200)
    assert whole.end == pytest.approx(mr.pushover(case).end, rel=0.01)
    if not case.pulls:  # a tie pulls before such a base has lifted off
        assert whole.start == pytest.approx(mr.pushover(case).start, rel=0.01)
    soft = mr.pushover(case, on(case, SOFT), rotations=phi[:50], points=50)
    assert np.abs(soft.multiplier / rigid[:50] - 1).max() > 0.05


def test_corner_lines_follow_their_closed_form():
    case = problem("full", "none")
    k, height = SOFT * L * B, H
    theta_u = WEIGHT / (2 * k * B)
    elastic = mr.pushover(case, on(case, SOFT), rotations=theta_u * np.array([0.1, 0.5, 0.9, 0.999]))
    moment = (2 * k * B**2 - WEIGHT * height) * elastic.rotation
    np.testing.assert_allclose(elastic.moment, moment, rtol=0.001)
    np.testing.assert_allclose(elastic.multiplier, moment / (WEIGHT * height), rtol=0.01)
    open_ = mr.pushover(case, on(case, SOFT), rotations=np.linspace(1.001 * theta_u, 0.09, 40))
    np.testing.assert_allclose(open_.moment, WEIGHT * (B - height * open_.rotation), rtol=0.01)
    whole = mr.pushover(case, on(case, SOFT))
    assert whole.start == pytest.approx((2 * k * B**2 - WEIGHT * height) * theta_u / (WEIGHT * height), rel=0.003)
    assert whole.peak == pytest.approx(whole.start, rel=1e-4)
    assert whole.end == pytest.approx(math.atan(B / H), rel=0.002)


def bed_moment(k_n, theta):
    """Moment of a no-tension bed, without that of the weight."""
    theta_1 = 2 * WEIGHT / (k_n * L * (2 * B) ** 2)
    contact = np.sqrt(2 * WEIGHT / (k_n * L * theta))
    return np.where(theta < theta_1, k_n * L * (2 * B) ** 3 / 12 * theta, WEIGHT * (B - contact / 3))


@pytest.mark.slow
def test_many_lines_approach_the_bed():
    case = problem("full", "none")
    theta_1 = 2 * WEIGHT / (SOFT * L * (2 * B) ** 2)
    theta = np.concatenate([theta_1 * np.array([0.3, 0.7, 0.95]), np.linspace(1.05 * theta_1, 0.1, 60)])
    expected = bed_moment(SOFT, theta)
    found = {
        points: mr.pushover(case, on(case, SOFT, points), rotations=theta, points=20).moment + WEIGHT * H * theta
        for points in (8, 16, 32, 64, 256)
    }
    np.testing.assert_allclose(found[256], expected, rtol=0.005)  # what is left is of second order in the rotation
    assert np.abs(found[8] / expected - 1).max() > 0.03
    errors = [float(np.abs(found[points] / found[256] - 1).max()) for points in (8, 16, 32, 64)]
    assert all(coarse > 3 * fine for coarse, fine in itertools.pairwise(errors))  # of second order
    whole = mr.pushover(case, on(case, SOFT, 128))
    assert whole.start * H * WEIGHT == pytest.approx(WEIGHT * (B / 3 - H * theta_1), rel=0.01)
    contact = math.sqrt(2 * WEIGHT / (SOFT * L * whole.end))
    assert whole.end == pytest.approx((B - contact / 3) / H, rel=0.01)


@pytest.mark.parametrize("effects", among(["load", "added mass", "thrust"], "load"))
def test_a_lopsided_wall_starts_where_it_leans(effects):
    case = problem("full", effects, side_stop=False)
    base = on(case, SOFT)
    restoring = case.restoring
    leaning = (restoring.inner.P - restoring.outer.P) / 2
    stiffness = 2 * SOFT * L * B * B**2 - (restoring.inner.Q + restoring.outer.Q) / 2
    curve = mr.pushover(case, base)
    assert curve.rotation[0] == pytest.approx(leaning / stiffness, rel=0.01)
    assert curve.multiplier[0] == pytest.approx(0, abs=1e-5)
    theta = curve.rotation[0] + np.array([5e-4, 1e-3])
    pushed = mr.pushover(case, base, rotations=theta[theta > 0]).multiplier
    wall = case.wall
    expected = (stiffness * theta - leaning) / (wall.weight * wall.centroid_height)
    np.testing.assert_allclose(pushed, expected[theta > 0], rtol=0.01)


@pytest.mark.parametrize(("effects", "points"), [("tie", 2), ("all", 9), slow(("all", 2)), slow(("none", 9))])
def test_the_independent_solver_stands_still_on_the_curve(effects, points):
    chosen = tuple(e for e in EFFECTS[effects] if not isinstance(e, mr.Tie) or e.strength == math.inf)
    block = mr.Block(B, H, L, RHO, inset=0.02)
    case = mr.Case(block, 0.0, 1.0, effects=chosen)
    base = on(case, SOFT, points)
    rotations = np.array([0.001, 0.004, 0.02, 0.08])
    held = tilted(mr.wall_scene(case, base), np.linspace(0.0, 0.08, 161))
    for theta in rotations:
        n = int(np.argmin(np.abs(held.pose[:, 2] - theta)))
        push = float(held.force[n]) / case.wall.mass
        shaken = mr.Case(block, 0.0, 1.0, effects=chosen, motion=mr.GroundMotion(np.full(3, -push), 1.0))
        rates = Wall(shaken, base).sticking(0.5, np.append(held.pose[n], np.zeros(3)))
        assert np.abs(rates[3:] * (1, 1, H)).max() < 2e-5 * G
    # the twin that must fail: another acceleration moves it
    shaken = mr.Case(block, 0.0, 1.0, effects=chosen, motion=mr.GroundMotion(np.full(3, -1.02 * push), 1.0))
    rates = Wall(shaken, base).sticking(0.5, np.append(held.pose[n], np.zeros(3)))
    assert np.abs(rates[3:] * (1, 1, H)).max() > 1e-4 * G


@pytest.mark.slow
def test_the_held_edge_does_not_slip():
    case = problem("full", "none")
    scene = mr.wall_scene(case, on(case, SOFT))
    coarse, fine = (tilted(scene, np.linspace(0, 0.1, n)).pose[-1] for n in (51, 401))
    np.testing.assert_allclose(coarse, fine, atol=1e-6)
    # about the outer edge of a rigid wall the centroid moves out by z sin + d (1 - cos)
    stiff = tilted(mr.wall_scene(case, on(case, STIFF)), np.linspace(0, 0.1, 101)).pose[-1]
    assert stiff[0] == pytest.approx(H * math.sin(0.1) + B * (1 - math.cos(0.1)), rel=1e-4)


@pytest.mark.parametrize(("effects", "points"), [("none", 2), slow(("none", 16)), slow(("all", 2))])
def test_mujoco_driven_slowly_follows_the_curve(effects, points):
    """A position actuator turns the wall, and its moment over W z' is the multiplier.

    It starts exponentially. The share of the dashpots is then the rate of growth times their retardation.
    """
    case = problem("full", effects)
    base = on(case, SOFT, points)
    step, growth, fast, duration = 2e-3, 0.25, 0.004, 26.0
    assert base.base.retardation * growth < 0.006
    spec = mujoco.MjSpec.from_string(mr.wall_mjcf(case, base, step))
    push = spec.add_actuator(name="push", trntype=mujoco.mjtTrn.mjTRN_JOINT, target="theta")
    kp = 1e3 * case.wall.weight * H
    push.gainprm[0], push.biastype = kp, mujoco.mjtBias.mjBIAS_AFFINE
    push.biasprm[:3] = 0.0, -kp, -2 * math.sqrt(kp * case.wall.toe_inertia)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    at, which = float(data.qpos[2]), model.actuator("push").id
    seen, target = [], 0.0
    for n in range(int(duration / step)):
        t = n * step
        if growth * target < fast:
            target = 4e-4 * math.exp(growth * t)
        else:
            target += fast * step
        data.ctrl[which] = at + target - 4e-4
        mujoco.mj_step(model, data)
        seen.append((float(data.qpos[2]), float(data.actuator_force[which])))
    theta, moment = np.array(seen).reshape(-1, 50, 2).mean(axis=1).T
    picked = np.arange(19, len(theta), 10)
    curve = mr.pushover(case, base, rotations=theta[picked])
    wall = case.wall
    height = wall.centroid_height * np.cos(theta[picked]) + wall.lever * np.sin(theta[picked])
    np.testing.assert_allclose(
        curve.multiplier, moment[picked] / (wall.weight * height), rtol=0.01, atol=0.002 * curve.peak
    )


@pytest.mark.parametrize("points", [40, 400])
def test_a_curve_has_about_as_many_points_as_asked(points):
    case = problem("full", "none")
    for contacts in (None, on(case, SOFT)):
        assert len(mr.pushover(case, contacts, points=points).rotation) == pytest.approx(points, rel=0.16)


def test_it_can_be_read():
    case = problem("full", "none")
    assert "rigid" in repr(mr.pushover(case))
    assert "2 lines" in repr(mr.pushover(case, on(case, SOFT)))
    assert len(mr.pushover(case, points=50).rotation) == pytest.approx(50, abs=5)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"rotations": []}, "rotations has the shape"),
        ({"rotations": 0.1}, "rotations has the shape"),
        ({"rotations": [0.1, 0.1]}, "rotations = .* has to increase within the valid range 0 to pi/2 rad"),
        ({"rotations": [-0.1, 0.1]}, "rotations = .* has to increase"),
        ({"rotations": [0.1, 1.6]}, "rotations = .* has to increase"),
        ({"rotations": [0.1, math.nan]}, "rotations holds a value that is not finite"),
        ({"rotations": ["a"]}, "rotations = .* does not hold real numbers alone"),
        ({"points": 3}, "points = 3 is outside the valid range 20 to 100000"),
        ({"contacts": 3}, "contacts = 3 of type int is not a Contacts or None"),
        ({"case": None}, "case = None is not a Case"),
    ],
)
def test_what_cannot_be_is_refused(options, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        mr.pushover(**{"case": problem("full", "none")} | options)


@pytest.mark.slow
def test_a_tie_that_lifts_the_wall_off_its_base():
    case = problem("full", "tie")
    curve = mr.pushover(case, on(case, SOFT))
    assert curve.end == math.inf
    assert 0.5 < curve.rotation[-1] < 1.2
    with pytest.raises(ValueError, match=r"rotations reach 1.5 rad, and the ties lift the wall off its base at 0\."):
        mr.pushover(case, on(case, SOFT), rotations=[0.1, 1.5])


def test_a_yielded_tie_slackens_where_the_wall_comes_nearer_to_its_anchor():
    case = problem("full", "tie to a low anchor")
    phi = np.linspace(0.1, 0.9, 33)  # it is longest at 0.5 rad
    rigid = mr.pushover(case, rotations=phi).multiplier
    expected = closed_form("full", "tie to a low anchor", np.linspace(0, 0.9, 9001))[1000::250]
    np.testing.assert_allclose(rigid, expected, atol=1e-3)
    held = mr.pushover(case, on(case, STIFF), rotations=phi, points=50).multiplier
    np.testing.assert_allclose(held, rigid, atol=1e-3)
    # the twin that must fail: at 0.9 rad it is 0.14 m shorter again, and slack
    assert rigid[-1] == pytest.approx(float(case.restoring.outer.at(0.9)) / lever(case, 0.9), rel=1e-6)
    assert abs(case.pulls[0].moment(np.array([0.9]))[0]) / lever(case, 0.9) > 0.01


def lever(case, phi):
    """W z' [N m]."""
    return case.wall.weight * (case.wall.centroid_height * math.cos(phi) + case.wall.lever * math.sin(phi))


def test_rotations_at_which_a_tie_yields_and_breaks():
    """Of a tie whose anchor is far, the elongation is the horizontal motion of the point that it holds."""
    wall = mr.Block.from_size(0.6, 4.2)
    tie = mr.Tie(height=4.0, stiffness=1e6, slack=0.01, strength=5e3, ultimate=0.05, length=1000.0)
    curve = mr.pushover(mr.Case(wall, 0.0, 1.0, effects=(tie,)))
    yields, breaks = (at["tie_0"] for at in curve.ties)
    for found, elongation in ((yields, 0.015), (breaks, 0.065)):
        moved = 4.0 * np.sin(found) + 2 * 0.3 * (1 - np.cos(found))
        assert moved == pytest.approx(elongation, abs=2e-4)
    ax = mr.plotting.pushover({"tied": curve})
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["tied", "tie yields", "tie breaks"]
    marks = [line.get_xdata()[0] for line in ax.get_lines() if line.get_marker() in "vx" and len(line.get_xdata())]
    np.testing.assert_array_equal(marks, [yields, breaks])
    weaker = mr.pushover(mr.Case(wall, 0.0, 1.0, effects=replace(tie, strength=3e3)))
    texts = [text.get_text() for text in mr.plotting.pushover({"a": curve, "b": weaker}).get_legend().get_texts()]
    assert texts == ["a", "b", "tie yields", "tie breaks"]
    assert mr.pushover(mr.Case(wall, 0.0, 1.0)).ties == ({}, {})
