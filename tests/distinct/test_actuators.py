"""Actuators against closed forms: a block that rocks, one that slides to and fro, guided blocks, a run in two parts."""

import numpy as np
import pytest
from driven import WEIGHT, B, H, panel
from everyday import among

import mjrock as mr
from mjrock.result.bodies import BodyMotion


def actuator(x, z, displacement, *, in_space=False, stiffness=1e8, damping=2.7e5, **more):
    """An actuator along x at a point of the panel."""
    at, way = ((x, 0.0, z), (1.0, 0.0, 0.0)) if in_space else ((x, z), (1.0, 0.0))
    return mr.Actuator("panel", at, way, displacement, stiffness, damping, **more)


def pushed(masonry, *effects, duration, output_step=0.01, **options):
    """The answer and the force of the first actuator over the weight."""
    case = mr.MasonryCase(masonry, duration, effects=effects)
    answer = mr.solve_explicit(case, output_step=output_step, ledger=True, **options)
    assert np.abs(answer.energy_residual).max() < 1e-3 * answer.ledger.largest
    return answer, answer.actuators["actuator_0"] / WEIGHT


def rocking_force(theta):
    """Horizontal force at the left top corner over the weight, of the rigid panel on its right toe, and how far the
    corner has moved [m]."""
    sine, cosine = np.sin(theta), np.cos(theta)
    force = (B * cosine - H * sine) / (2 * H * cosine + 2 * B * sine)
    return force, 2 * B * (1 - cosine) + 2 * H * sine


@pytest.mark.parametrize("in_space", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_panel_pushed_at_its_top_has_the_force_of_a_rigid_block_down_to_overturning(in_space):
    far = 2 * B
    history = ([0.0, 0.5, 6.0], [0.0, 0.005, far])
    answer, force = pushed(
        panel(0.9, in_space=in_space, k_n=1e10), actuator(-B, 2 * H, history, in_space=in_space), duration=6.0
    )
    theta = np.linspace(0.0, np.arctan(B / H), 1000)
    closed, moved = rocking_force(theta)
    driven = np.interp(answer.t, *history) - force * WEIGHT / 1e8
    rocks = (driven > 0.02 * far) & (driven < moved.max())
    assert rocks.sum() > 400
    expected = np.interp(driven, moved, closed)
    assert np.abs(force - expected)[rocks].max() < 0.01 * B / (2 * H)
    assert force[40:50].max() == pytest.approx(B / (2 * H), rel=0.01)


@pytest.mark.parametrize("k_s", among([None, 1e10], None))
def test_a_panel_pushed_to_and_fro_loses_friction_times_path(k_s):
    history = ([0.0, 0.6, 1.8, 3.0], [0.0, 0.03, -0.03, 0.03])
    jack = actuator(-B, 0.1, history)
    answer, force = pushed(panel(0.3, k_s=k_s, k_n=1e10), jack, duration=3.0, output_step=1e-3)
    foot = answer.pose[:, 0, 0] - H * np.sin(answer.theta[:, 0])
    path = np.abs(np.diff(foot)).sum()
    assert path > 0.14
    assert answer.ledger.friction[-1] == pytest.approx(0.3 * WEIGHT * path, rel=0.005)
    assert answer.ledger.dashpots["actuator_0"][-1] < 0.02 * answer.ledger.friction[-1]
    work = np.trapezoid(force * WEIGHT, np.interp(answer.t, *history))
    assert answer.ledger.actuators["actuator_0"][-1] == pytest.approx(work, rel=0.002)
    moved = answer.pose[:, 0, 0] - (H - 0.1) * np.sin(answer.theta[:, 0])
    passed_on = np.trapezoid(force * WEIGHT, moved) + 0.5 * (force[-1] * WEIGHT) ** 2 / 1e8
    assert work == pytest.approx(passed_on + answer.ledger.dashpots["actuator_0"][-1], rel=0.005)
    assert np.median(force[(answer.t > 0.3) & (answer.t < 0.6)]) == pytest.approx(0.3, rel=0.01)
    assert np.median(force[(answer.t > 1.2) & (answer.t < 1.8)]) == pytest.approx(-0.3, rel=0.01)


@pytest.mark.parametrize("in_space", [False, True])
def test_each_actuator_has_an_account_of_its_own(in_space):
    """The first slides the panel to and fro, the second gives way to it: the work of each is its force times the way
    of its point, beside what is in its spring, and nothing is left for the ground."""
    first = actuator(-B, 0.1, ([0.0, 0.2, 0.6], [0.0, 0.01, -0.01]), in_space=in_space)
    second = actuator(B, 0.1, ([0.0], [0.0]), in_space=in_space, stiffness=1e5, damping=0.0)
    answer, _ = pushed(panel(0.3, in_space=in_space, k_n=1e10), first, second, duration=0.6, output_step=1e-3)
    turned = answer.tilt[:, 0] * np.sign(answer.pose[:, 0, 5]) if in_space else answer.theta[:, 0]
    moved = answer.pose[:, 0, 0] - (H - 0.1) * np.sin(turned)
    path = np.abs(np.diff(moved)).sum()
    for name, stiffness in (("actuator_0", 1e8), ("actuator_1", 1e5)):
        force = answer.actuators[name]
        work = np.trapezoid(force, moved) + 0.5 * force[-1] ** 2 / stiffness + answer.ledger.dashpots[name][-1]
        assert answer.ledger.actuators[name][-1] == pytest.approx(work, abs=0.01 * 0.3 * WEIGHT * path), name
    assert answer.ledger.actuators["actuator_0"][-1] > 0.3 * WEIGHT * path
    assert answer.ledger.actuators["actuator_1"][-1] == 0.0  # its far end rests
    np.testing.assert_array_equal(answer.ledger.ground, 0.0)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("guided", ["upright", "translation"])
def test_a_guided_block_does_not_turn(guided, in_space):
    history = ([0.0, 0.5], [0.0, 0.02])
    driven = actuator(-B, 2 * H, history, in_space=in_space, guided=guided)
    answer, force = pushed(panel(0.3, in_space=in_space), driven, duration=0.5)
    assert np.median(force[25:]) == pytest.approx(0.3, rel=0.001)  # free, it would turn at 0.125
    turned = answer.pose[:, 0, 3:] if in_space else answer.theta
    np.testing.assert_array_equal(turned, turned[:1].repeat(len(answer.t), axis=0))


def test_a_wall_under_a_beam_that_does_not_rise_bears_more_than_its_weight_gives():
    """The panel between two faces becomes a strut: as it turns, the guide presses it down."""
    beam = mr.Polygon([(-1.0, 2 * H), (1.0, 2 * H), (1.0, 2.2), (-1.0, 2.2)], density=2000.0, name="beam")
    masonry = mr.Masonry([*panel(0.9).blocks, beam], k_n=2e9, friction=0.9, xi=0.1)
    tops = {}
    for guided in ("upright", "translation"):
        jack = mr.Actuator("beam", (-1.0, 2.1), 1, ([0.0, 1.0], [0.0, 0.01]), 1e8, 2e5, guided=guided)
        answer, force = pushed(masonry, jack, duration=1.0)
        tops[guided] = force[20:].max()
        assert (np.ptp(answer.pose[:, 1, 1]) == 0) == (guided == "translation")
    # two hinges at opposite corners: the weight of the beam acts with the lever 2b, that of the panel with b
    both = (2000.0 * 0.4 * mr.GRAVITY * 2 * B + WEIGHT * B) / (2 * H) / WEIGHT
    assert tops["upright"] == pytest.approx(both, rel=0.05)
    assert tops["translation"] > 3 * both


@pytest.mark.parametrize("in_space", [False, True])
def test_an_actuator_of_all_blocks_drives_their_centroid(in_space):
    """Two panels, one of them laden, slide together: the force is friction on both, shared out by their mass."""
    d = 3 if in_space else 2
    base, one = panel(0.2, in_space=in_space).blocks
    if in_space:
        other = mr.Polyhedron.box((2 * B, 1.0, 2 * H), (1.0, 0.0, H), name="other")
    else:
        other = mr.Polygon([(x + 1.0, z) for x, z in one.vertices], density=2000.0, name="other")
    masonry = mr.Masonry([base, one, other], k_n=1e10, friction=0.2, xi=0.1)
    weight = mr.GRAVITY * one.mass
    added = mr.AddedMass(500.0, block=1, at=(0.0, 0.0, 0.5)) if in_space else mr.AddedMass(500.0, 0.5, block=1)
    whole = mr.Actuator(None, None, np.eye(d)[0], ([0.0, 0.4], [0.0, 0.02]), 1e8, 8e5)
    answer = mr.solve_explicit(
        mr.MasonryCase(masonry, 0.4, effects=(added, whole)), output_step=1e-3, ledger=True, forces=True
    )
    total = 2 * weight + 500.0 * mr.GRAVITY
    force = answer.actuators["actuator_0"]
    assert np.median(force[200:]) == pytest.approx(0.2 * total, rel=2e-3)
    np.testing.assert_allclose(answer.forces.reactions["anchors"][:, 0], force)
    assert np.abs(answer.energy_residual).max() < 1e-3 * answer.ledger.largest
    shares = np.array([weight + 500.0 * mr.GRAVITY, weight]) / total
    moved = answer.pose[:, :, 0] @ shares
    of_dashpot = answer.ledger.dashpots["actuator_0"][-1]
    work = np.trapezoid(force, moved) + 0.5 * force[-1] ** 2 / 1e8 + of_dashpot
    assert answer.ledger.actuators["actuator_0"][-1] == pytest.approx(work, rel=0.005)
    assert moved[-1] == pytest.approx(0.02 - force[-1] / 1e8, rel=0.005)


def test_a_step_knows_the_stiffness_of_an_actuator_of_all_blocks():
    """One block swings on it as on an actuator at its centroid."""
    rest = 1, ([0.0], [0.0]), 1e12
    cases = [
        mr.MasonryCase(panel(0.3), 0.01, effects=mr.Actuator(*at, *rest)) for at in ((None, None), ("panel", (0, H)))
    ]
    whole, single = (mr.solve_explicit(case).stats["stable_timestep"] for case in cases)
    assert whole == pytest.approx(single, rel=1e-9)


def test_a_run_in_two_parts_is_the_run_in_one():
    masonry, whole = panel(0.3, k_s=2e9), ([0.0, 1.0], [0.0, 0.02])
    _, force = pushed(masonry, actuator(-B, 0.1, whole), duration=1.0, timestep=2e-4)
    half = mr.MasonryCase(masonry, 0.5, effects=(actuator(-B, 0.1, ([0.0, 1.0], [0.0, 0.02])),))
    first = mr.solve_explicit(half, timestep=2e-4, output_step=0.01)
    second = mr.solve_explicit(half, timestep=2e-4, output_step=0.01, start=first.end)
    np.testing.assert_allclose(second.actuators["actuator_0"] / WEIGHT, force[50:], atol=1e-9)


def test_a_step_knows_the_stiffness_of_an_actuator():
    masonry = panel(0.3)
    still = mr.solve_explicit(mr.MasonryCase(masonry, 0.01)).stats["stable_timestep"]
    stiff = mr.MasonryCase(masonry, 0.01, effects=(actuator(-B, 0.1, ([0.0], [0.0]), stiffness=1e12),))
    assert mr.solve_explicit(stiff).stats["stable_timestep"] < 0.2 * still


def test_forces_are_columns_of_the_table():
    case = mr.MasonryCase(panel(0.3), 0.01, effects=actuator(-B, 0.1, ([0.0, 1.0], [0.0, 0.1])))
    answer = mr.solve_explicit(case)
    assert "force of actuator_0 [N]" in answer.csv()
    assert answer.actuators["actuator_0"][-1] > 0
    with pytest.raises(ValueError, match=r"effects\[0\], Actuator: MuJoCo does not know it; take solve_explicit"):
        mr.simulate(case)


@pytest.mark.parametrize("ledger", [False, True])
def test_actuators_in_tables_and_campaigns(ledger):
    case = mr.MasonryCase(panel(0.3), 0.1, effects=actuator(-B, 0.1, ([0.0, 0.1], [0.0, 1e-3])))
    analysis = mr.Analysis(case, "explicit", options={"ledger": ledger})
    row, answer = analysis(), analysis.solve()
    assert row["actuator_0_largest_force_N"] == pytest.approx(np.abs(answer.actuators["actuator_0"]).max())
    assert ("put in by actuator_0 [J]" in answer.csv()) == ("actuator_0_work_J" in row) == ledger
    if ledger:
        assert row["actuator_0_work_J"] == answer.ledger.actuators["actuator_0"][-1] > 0
        assert "put in by the ground 0, actuator_0" in repr(answer.ledger)


HISTORY = ([0.0, 1.0], [0.0, 0.1])


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"displacement": ([0.0, 1.0], [0.0, np.nan])}, "values holds a value that is not finite"),
        ({"displacement": ([0.0, 1.0], [0.01, 0.02])}, "begins at 0.01 m; the valid start is 0 m"),
        ({"displacement": ([0.5, 1.0], [0.0, 0.02])}, "t begins at 0.5 s; the valid start is 0 s"),
        ({"displacement": ([0.0, 1.0, 0.5], [0.0, 0.1, 0.2])}, "has to increase"),
        ({"displacement": ([0.0, 1.0], [0.0, 40.0])}, "= 40 m is outside"),
        ({"displacement": ([0.0, 1.0], [0.0])}, "have 2 and 1 values"),
        ({"displacement": 0.1}, "is not \\(t, values\\)"),
        ({"stiffness": 0.0}, "stiffness of the actuator"),
        ({"direction": (0.0, 0.0)}, "has no length"),
        ({"direction": 2}, "shape"),
        ({"guided": "rotation"}, "the valid ones are None, 'upright' and 'translation'"),
        ({"at": (1.0, 2.0)}, "0.75 m outside the block"),
        ({"at": (0.0, 0.0, 2.0), "direction": (1.0, 0.0, 0.0)}, "has 3 numbers; this masonry takes 2"),
        ({"block": "beam"}, "'beam' is no block; the valid ones are base, panel"),
        ({"block": "base"}, "this block is fixed"),
        ({"block": 7}, "outside the valid range"),
        ({"direction": (0.0, 1.0), "guided": "translation"}, "the valid ones are horizontal"),
        ({"block": None, "at": None, "direction": (1.0, 0.0, 0.0)}, "all blocks of this masonry take 2 numbers"),
    ],
)
def test_what_is_wrong_is_named(changed, message):
    given = {"block": "panel", "at": (-B, H), "direction": 1, "displacement": HISTORY, "stiffness": 1e8} | changed
    with pytest.raises((ValueError, TypeError), match=message):
        mr.MasonryCase(panel(0.3), 1.0, effects=mr.Actuator(**given))


def test_effects_of_masonry_take_the_name_of_their_block():
    named = mr.MasonryCase(panel(0.3), 1.0, effects=mr.Load(1e3, 2.0, block="panel"))
    assert named.effects == (mr.Load(1e3, 2.0, block=1),)
    with pytest.raises(ValueError, match="'roof' is no block; the valid ones are base, panel"):
        mr.MasonryCase(panel(0.3), 1.0, effects=mr.Load(1e3, 2.0, block="roof"))


def test_a_wall_of_one_block_takes_no_actuator():
    wall = mr.Block.from_size(0.5, 2.0)
    with pytest.raises(TypeError, match="Actuator"):
        mr.Case(wall, 0.0, 1.0, effects=(mr.Actuator(0, (0.0, 1.0), 1, HISTORY, 1e8),))


@pytest.mark.parametrize("in_space", [False, True])
def test_a_guide_holds_the_moment_of_the_push_and_its_friction(in_space):
    """The panel slides without turning: its guide balances the couple of jack and base, of the lever 2h."""
    driven = actuator(-B, 2 * H, ([0.0, 0.5], [0.0, 0.02]), in_space=in_space, guided="upright")
    answer, _ = pushed(panel(0.3, in_space=in_space, k_n=1e10), driven, duration=0.5, forces=True)
    guide = answer.forces.guides["panel"]
    about, name = (2, " about y") if in_space else (1, "")
    assert guide.shape == (51, 4 if in_space else 2)
    np.testing.assert_allclose(guide[40:, about], -answer.actuators["actuator_0"][40:] * 2 * H, rtol=1e-3)
    assert np.median(guide[40:, about]) == pytest.approx(-0.3 * WEIGHT * 2 * H, rel=2e-3)
    rest = np.delete(guide, about, axis=1)
    np.testing.assert_allclose(rest, 0.0, atol=1e-9 * WEIGHT)
    assert f"moment{name} of the guide of panel [N m]" in answer.csv().splitlines()[0]


@pytest.mark.parametrize("k_s", [None, 2e9])
def test_what_a_guide_presses_down_is_part_of_the_reactions(k_s):
    """The panel becomes a strut between floor and guided beam: vertical forces balance in every step, with the guide's,
    and its moment balances all that the strut and the jack do to the beam."""
    beam = mr.Polygon([(-1.0, 2 * H), (1.0, 2 * H), (1.0, 2.2), (-1.0, 2.2)], density=2000.0, name="beam")
    masonry = mr.Masonry([*panel(0.9).blocks, beam], k_n=2e9, k_s=k_s, friction=0.9, xi=0.1)
    jack = mr.Actuator("beam", (-1.0, 2.15), 1, ([0.0, 0.1], [0.0, 2e-3]), 1e8, 2e5, guided="translation")
    case, h = mr.MasonryCase(masonry, 0.1, effects=(jack, mr.Load(1e4, 2.2, block="beam"))), 2e-5
    answer = mr.solve_explicit(case, timestep=h, output_step=h, forces=True)
    guide = answer.forces.guides["beam"]
    mass = np.array([block.mass for block in masonry.blocks if not block.fixed])
    place = answer.pose[:, :, :2]
    change = np.einsum("b,nbd->nd", mass, place[2:] - 2 * place[1:-1] + place[:-2]) / h**2
    total = sum(answer.reactions.values())[1:-1] - [0.0, mass.sum() * mr.GRAVITY + 1e4]
    assert np.abs(total - change).max() < 1e-6 * WEIGHT
    assert guide[:, 0].min() < -WEIGHT  # it presses down
    forces = answer.forces
    top = forces.joints.index("panel|beam")
    middle, axes = BodyMotion(case, answer.t, answer.pose).joints(forces.frames)
    where = middle[:, top] + forces.eccentricity[:, top, None] * axes[:, top, 1]
    push = forces.normal[:, top, None] * axes[:, top, 0] + forces.shear[:, top, None] * axes[:, top, 1]
    arm = where - [0.0, 2.1] - answer.pose[:, 1, :2]
    moment = arm[:, 1] * push[:, 0] - arm[:, 0] * push[:, 1] + answer.actuators["actuator_0"] * 0.05
    np.testing.assert_allclose(guide[:, 1], -moment, atol=1e-6 * WEIGHT)


def test_without_a_guide_there_is_none():
    driven = actuator(-B, 0.1, ([0.0, 0.1], [0.0, 0.01]))
    answer, _ = pushed(panel(0.3), driven, duration=0.1, forces=True)
    assert answer.forces.guides == {}


def held(guided, in_space):
    """An actuator that rests at the top of the panel, on a soft spring."""
    at = (0.0, 0.0, 2 * H) if in_space else (0.0, 2 * H)
    return mr.Actuator("panel", at, 1, None, 1e6, 1e3, guided=guided)


MAY = {
    ("upright", False): ("x and z", [0, 1]),
    ("translation", False): ("x", [0]),
    ("upright", True): ("x and y and z", [0, 1, 2]),
    ("translation", True): ("x and y", [0, 1]),
}
"""Along which axes a guided block may move, in the plane and in space, and which of its velocities these are."""


@pytest.mark.parametrize(("guided", "in_space"), MAY)
def test_a_start_that_the_guide_does_not_allow_is_refused(guided, in_space):
    masonry, jack = panel(0.5, in_space=in_space), held(guided, in_space)
    message, free = MAY[guided, in_space]
    pose = mr.solve_explicit(mr.MasonryCase(masonry, 0.01)).pose[-1]
    for velocity in 0.2 * np.eye(6 if in_space else 3)[:, None]:
        if velocity[0, free].any():
            answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.05, effects=jack, velocity=velocity), ledger=True)
            assert np.abs(answer.energy_residual).max() < 1e-3 * answer.ledger.largest
            continue
        refused = rf"velocity of panel = \[.*: its actuator guides it, which lets it move along {message} alone"
        with pytest.raises(ValueError, match=f"^{refused}"):
            mr.MasonryCase(masonry, 0.05, effects=jack, velocity=velocity)
        with pytest.raises(ValueError, match=f"^start, {refused}"):
            mr.solve_explicit(mr.MasonryCase(masonry, 0.05, effects=jack), start=(pose, velocity))


@pytest.mark.parametrize("in_space", [False, True])
def test_a_run_that_carries_on_has_the_guides_of_its_own_case(in_space):
    """Not those of the run before, whose steps it knows; what little speed that run has left is taken."""
    masonry = panel(0.5, in_space=in_space)
    shaken = mr.GroundMotion.sine(6.0, 0.4, 1)

    def rocked(effects, start=None):
        case = mr.MasonryCase(masonry, 0.3, motion=shaken, effects=effects)
        return mr.solve_explicit(case, start=start, output_step=0.01)

    for effects in ((), held("upright", in_space)):
        still = mr.solve_explicit(mr.MasonryCase(masonry, 0.02, effects=effects)).end
        assert still.memory is not None
        assert np.abs(rocked(held("upright", in_space), still).tilt).max() < 1e-6
        free, alone = rocked((), still), rocked(())
        assert alone.tilt.max() > 0.01
        np.testing.assert_allclose(free.tilt, alone.tilt, atol=1e-4)
