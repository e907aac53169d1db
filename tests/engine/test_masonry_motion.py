"""Masonry in motion: against an explicit integration, the single wall, conservation laws and closed forms."""

import math

import mujoco
import numpy as np
import pytest
from explicit_blocks import explicit
from masonry_blocks import GROUND, box, columns
from scenes import stock_takes

import mjrock as mr
from mjrock.geometry.kinematics import gaps
from mjrock.scene.masonry import masonry_course

PULSE = mr.GroundMotion.sine(2.0, 0.7)
STRONG = mr.GroundMotion.sine(3.0, 0.9)


def follow(masonry, duration, motion=None, *, accuracy=1e-3, timestep=None, ledger=False, **options):
    case = mr.MasonryCase(masonry, duration, motion, **options)
    return mr.simulate(case, accuracy=accuracy, timestep=timestep, ledger=ledger)


def against_explicit(masonry, duration, motion, accuracy, h=2e-6, vertical=None):
    """Largest errors of peak rotation and of rotation, over the peaks of the explicit integration."""
    case = mr.MasonryCase(masonry, duration, motion, vertical=vertical)
    answer = mr.simulate(case, accuracy=accuracy)
    scene = mr.masonry_scene(case)
    t, pose = explicit(scene, masonry_course(case, scene), h, round(1e-3 / h))
    theta = pose[: len(answer.t), :, 2]
    assert t[: len(answer.t)] == pytest.approx(answer.t, abs=1e-9)
    peaks = np.abs(theta).max(axis=0)
    return np.abs(answer.peak / peaks - 1).max(), (np.abs(answer.theta - theta).max(axis=0) / peaks).max()


def test_two_blocks_against_an_explicit_integration():
    level = against_explicit(columns(2, xi=0.049), 1.5, STRONG, 1e-4)
    assert max(level) < 1e-4
    with_lift = against_explicit(columns(2, xi=0.049), 1.5, STRONG, 1e-4, vertical=mr.GroundMotion.sine(4.0, 0.3))
    assert max(with_lift) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(
    ("blocks", "accuracy", "of_peak", "of_path"), [(2, 1e-3, 1e-5, 2e-4), (4, 1e-3, 3e-4, 2e-3), (4, 1e-5, 3e-5, 3e-4)]
)
def test_stacks_against_an_explicit_integration(blocks, accuracy, of_peak, of_path):
    """Five cycles of rocking: the peak, and the whole motion, whose phase adds up."""
    peak, path = against_explicit(columns(blocks, xi=0.049), 4.0, PULSE, accuracy, h=1e-6)
    assert peak < of_peak
    assert path < of_path


@pytest.mark.slow
def test_an_arch_against_an_explicit_integration():
    """Each voussoir over its own peak, which is a small part of the largest for some."""
    peak, path = against_explicit(mr.Masonry.arch(5.0, 0.75), 1.5, PULSE, 1e-4)
    assert peak < 1e-3
    assert path < 1e-2


class Keystone:
    """A wedge of 0.3 in 1 between two fixed faces. Depths are what it has moved down [m]."""

    def __init__(self, friction, xi):
        low, high = 0.5, 0.8
        sides = [mr.Polygon([(s * low, 0), (s * high, 1), (s * 4, 1), (s * 4, 0)], fixed=True) for s in (-1, 1)]
        key = mr.Polygon([(-low, 0), (low, 0), (high, 1), (-high, 1)])
        self.masonry = mr.Masonry([*sides, key], k_n=1e9, friction=friction, xi=xi)
        self.sine, self.cosine = math.sin(math.atan(0.3)), math.cos(math.atan(0.3))
        self.smooth = key.mass * mr.GRAVITY / (self.masonry.lines.k.sum() * self.sine**2)

    def carrying(self, friction):
        """Depth at which friction carries the weight with this share of the pressure, downwards if negative."""
        upwards = self.sine + friction * self.cosine
        return self.smooth * self.sine / upwards if upwards > 0 else math.inf

    def depth(self, duration, **options):
        return -mr.simulate(mr.MasonryCase(self.masonry, duration), **options).pose[:, 0, 1]


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.9])
def test_a_keystone_settles_between_inclined_faces_by_coulombs_law(friction):
    """Released where nothing presses yet. Overdamped it only sinks, and friction ends up carrying all it can; lightly
    damped it swings, and ends anywhere that friction can hold it. In either case it then stays."""
    touching = np.zeros((1, 3)), np.zeros((1, 3))
    overdamped, swinging = (Keystone(friction, xi).depth(1.0, start=touching) for xi in (3.0, 0.05))
    stone = Keystone(friction, 0.05)
    assert overdamped[-1] == pytest.approx(stone.carrying(friction), rel=4e-3)
    assert 1.01 * stone.carrying(friction) < swinging[-1] < stone.carrying(-friction)
    for depth in (overdamped, swinging):
        np.testing.assert_allclose(depth[len(depth) // 2 :], depth[-1], rtol=1e-4)


def test_a_keystone_begins_where_it_has_sunk_to():
    """It slips on both faces on its way down, so that friction carries all it can, and holds it there."""
    stone = Keystone(0.5, 0.05)
    depth = stone.depth(1.0)
    assert depth[0] == pytest.approx(stone.carrying(0.5), rel=1e-5)
    np.testing.assert_allclose(depth, depth[0], rtol=1e-2)


@pytest.mark.parametrize("timestep", [None, 1e-4])
def test_the_end_holds_every_block(timestep):
    """Of two blocks: pose and velocity at the end of the run, each in its place."""
    released = [[0.0, 0.0, 0.01], [0.02, 0.0, 0.03]]
    run = mr.simulate(mr.MasonryCase(columns(2, xi=0.05), 0.02, velocity=released), timestep=timestep)
    for end, samples in zip(run.end, (run.pose, run.velocity), strict=True):
        np.testing.assert_array_equal(end, samples[-1])
    assert np.abs(run.end.velocity[1] - run.end.velocity[0])[[0, 2]].min() > 1e-3


def test_one_block_is_the_single_wall():
    wall = mr.Block(0.3, 2.1)
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05, friction=0.7)
    case = mr.Case(wall, 0.0, 2.0, side_stop=False, motion=PULSE)
    response = mr.simulate(case, contacts, timestep=1e-3)
    answer = follow(mr.Masonry.stack([wall], 5e8, xi=0.05), 2.0, PULSE, timestep=1e-3)
    assert np.abs(answer.pose - response.pose).max() < 1e-9
    assert answer.energy == pytest.approx(response.energy, abs=1e-6)
    fitted = follow(mr.Masonry.stack([wall], 5e8, xi=0.05), 2.0, PULSE)
    assert np.abs(fitted.theta[:, 0] - mr.simulate(case, contacts, accuracy=1e-3).theta).max() < 1e-7


@pytest.mark.parametrize(("k_n", "share"), [(5e8, 5e-3), (5e10, 1e-3)])
def test_a_stack_that_moves_as_one_is_the_monolith(k_n, share):
    """Up to the first peak, within what the springs of one more joint take."""
    whole, two = (follow(columns(count, k_n), 1.1, PULSE, accuracy=1e-4).peak for count in (1, 2))
    assert two == pytest.approx([whole[0]] * 2, rel=share)
    assert np.abs(two / whole[0] - 1).max() > 1e-4


def test_momentum_is_conserved_without_friction_on_the_ground():
    """Two blocks that rub on each other: what one loses the other gains, and then they move together."""
    masonry = mr.Masonry([GROUND, box(-1, 1, 0, 0.4), box(-0.5, 0.5, 0.4, 0.7)], friction=lambda j: 0.4 * (j.below > 0))
    answer = follow(masonry, 0.6, velocity=[[0, 0, 0], [1.0, 0, 0]], ledger=True)
    masses = np.array([masonry.blocks[i].mass for i in masonry.free])
    momentum = answer.velocity[:, :, 0] @ masses
    assert momentum == pytest.approx(masses[1], rel=1e-6)
    together = masses[1] / masses.sum()
    assert answer.velocity[-1, :, 0] == pytest.approx([together] * 2, rel=1e-3)
    # uniform deceleration: the upper block slides by v^2 / (2 mu g (1 + m_2 / m_1))
    slip = 1 / (2 * 0.4 * mr.GRAVITY * (1 + masses[1] / masses[0]))
    assert answer.sliding[1] == pytest.approx(slip, rel=5e-3)
    lost = 0.5 * masses[1] * (1 - together)
    assert answer.ledger.friction[-1] == pytest.approx(lost, rel=0.01)


def test_the_ledger_closes_without_damping():
    answer = follow(columns(2, xi=0.0), 2.0, PULSE, accuracy=1e-4, ledger=True)
    put_in = float(np.abs(np.diff(answer.ledger.ground)).sum())
    assert np.abs(answer.energy_residual).max() < 1e-3 * put_in
    assert set(answer.ledger.dashpots) == {"ground|block_0", "block_0|block_1"}
    for work in answer.ledger.dashpots.values():
        assert np.abs(work).max() < 2e-3 * put_in  # there are none, but for steps that do not resolve the contacts


def test_a_course_slides_as_coulomb_has_it():
    """A flat block on shaken ground: a_rel = -(a_g - mu g sign v), integrated by hand."""
    masonry, motion = mr.Masonry([GROUND, box(-1, 1, 0, 0.2)], friction=0.3), mr.GroundMotion.sine(6.0, 0.7)
    answer = follow(masonry, 1.2, motion, accuracy=3e-4)
    x = v = 0.0
    h, far = 5e-5, 0.0
    for n in range(round(1.2 / h)):
        pushed = -float(np.interp(n * h, motion.dt * np.arange(len(motion.accel)), motion.accel, right=0.0))
        if v == 0 and abs(pushed) <= 0.3 * mr.GRAVITY:
            continue
        rubbed = pushed - 0.3 * mr.GRAVITY * math.copysign(1.0, v or pushed)
        v = 0.0 if v * (v + h * rubbed) < 0 else v + h * rubbed
        x += h * v
        far = max(far, abs(x))
    assert answer.sliding[0] == pytest.approx(far, rel=2e-4)
    assert answer.pose[-1, 0, 0] == pytest.approx(x, abs=1e-3 * far)
    assert answer.fallen == {}


@pytest.mark.parametrize("duration", [15.0, pytest.param(60.0, marks=pytest.mark.slow)])
def test_an_arch_at_rest_stays_and_costs_little(duration):
    """In a minute friction creeps by less than a tenth of a millimetre, and the steps are long."""
    answer = follow(mr.Masonry.arch(5.0, 0.75, voussoirs=16), duration)
    assert np.abs(answer.pose - answer.pose[0])[:, :, :2].max() < 1e-4 * duration / 60
    assert answer.sliding.max() < 1e-4 * duration / 60
    assert answer.stats["steps"] < 160 * duration
    assert answer.outcome is mr.Outcome.AT_REST


@pytest.mark.parametrize("side", [0.4, 1.0, 1.06])
def test_square_blocks_stay_where_they_settled(side):
    """Their half height is the extent of the scene; MuJoCo must not move their faces by the radius of the points."""
    blocks = [box(-side / 2, side / 2, side * i, side * (i + 1)) for i in range(3)]
    answer = follow(mr.Masonry([GROUND, *blocks]), 0.3)
    assert np.abs(answer.pose - answer.pose[0]).max() < 1e-11


def test_blocks_that_are_no_boxes_are_possible_bodies():
    """A flat trapezium has little inertia about its normal, which MuJoCo compares with the other two."""
    flat = mr.Polygon([(-1, 0), (1, 0), (0.3, 0.2), (-0.3, 0.2)], length=0.05)
    answer = follow(mr.Masonry([GROUND, flat, box(-0.2, 0.2, 0.2, 0.4)], k_n=1e9), 0.3)
    assert np.abs(answer.pose - answer.pose[0]).max() < 1e-9


def test_a_wall_in_bond_at_rest_has_head_joints_that_bear_nothing():
    answer = follow(mr.Masonry.running_bond(1.0, 1.0, (0.5, 0.25), 0.1), 5.0)
    assert np.abs(answer.pose - answer.pose[0]).max() < 1e-9
    assert answer.stats["steps"] < 2000


def test_a_column_that_falls():
    answer = follow(columns(3), 9.0, mr.GroundMotion.sine(5.0, 1.2))
    assert set(answer.fallen) == {"block_0", "block_1", "block_2"}
    assert answer.outcome is mr.Outcome.OVERTURNED
    assert answer.t[-1] < 4
    assert list(answer.fallen.values()) == sorted(answer.fallen.values())
    assert "3 blocks fell, the first at" in answer.message
    assert 0 < min(answer.fallen.values()) <= answer.t[-1]


def test_a_block_that_is_kicked_off_is_named():
    """The upper block slides off at 3 m/s and falls; the lower one stays."""
    blocks = [GROUND, box(-0.3, 0.3, 0, 1, name="lower"), box(-0.3, 0.3, 1, 1.3, name="upper")]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.2)
    answer = follow(masonry, 3.0, velocity=[[0, 0, 0], [4.0, 0, 0]])
    assert list(answer.fallen) == ["upper"]
    assert answer.sliding[1] > 0.6 or answer.opening[1] > 0.42


def test_a_run_is_continued():
    masonry = columns(2)
    whole = follow(masonry, 1.0, PULSE, timestep=2e-4)
    quiet = mr.simulate(mr.MasonryCase(masonry, 0.2), timestep=2e-4, start=whole.end)
    assert quiet.pose[0] == pytest.approx(whole.pose[-1], abs=1e-12)
    with pytest.raises(ValueError, match=r"start, pose has the shape \(1, 3\); \(2, 3\) is needed"):
        mr.simulate(mr.MasonryCase(masonry, 0.2), start=([[0, 0, 0]], [[0, 0, 0]]))


@pytest.mark.filterwarnings("ignore:contacts that slide")
def test_stock_mujoco_repeats_the_run_from_the_text():
    case = mr.MasonryCase(mr.Masonry.arch(5.0, 0.75, 2.5, 6), 0.05, velocity=np.full((6, 3), 0.02))
    answer = mr.simulate(case, timestep=1e-4)
    text = mr.masonry_mjcf(case, 1e-4)
    model = mujoco.MjModel.from_xml_string(text)
    assert model.body("voussoir_2").mass[0] == pytest.approx(case.masonry.blocks[3].mass)
    assert model.geom("left_abutment|voussoir_0_1").id >= 0
    stock_takes(answer.pose, text, 0)  # to the last bit: the same start of Newton's method


def test_the_solver_of_many_bodies():
    """Rows are sparse where they move two of many bodies, and Newton's method starts from the step before."""
    sparse = int(mujoco.mjtJacobian.mjJAC_SPARSE)
    for count, rows in ((1, False), (2, False), (3, False), (4, True), (8, True)):
        model = mujoco.MjModel.from_xml_string(mr.masonry_mjcf(mr.MasonryCase(columns(count), 0.1), 1e-3))
        assert (model.opt.jacobian == sparse) is rows
        cold = bool(model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_WARMSTART))
        assert cold is (count == 1)


def test_gaps_and_slips_are_what_the_answer_says():
    answer = follow(columns(2), 1.5, PULSE)
    scene = mr.masonry_scene(answer.case)
    largest = gaps(scene.places, answer.pose.reshape(len(answer.t), -1)).max(axis=0)
    assert answer.opening[0] == pytest.approx(largest[:2].max(), rel=1e-3)
    assert answer.opening[1] == pytest.approx(max(0, largest[2:].max()), rel=1e-3, abs=1e-7)
    assert answer == follow(columns(2), 1.5, PULSE)
    assert "2 blocks" in repr(answer)


@pytest.mark.parametrize(
    "masonry",
    [
        pytest.param(lambda: columns(5, xi=0.0), id="no damping"),
        pytest.param(lambda: columns(3, k_n=1e11), id="stiff"),
        pytest.param(lambda: mr.Masonry([GROUND, box(-0.3, 0.3, 0, 1), box(-0.5, 0.5, 1, 1.4)]), id="overhang"),
    ],
)
def test_hard_cases(masonry):
    answer = follow(masonry(), 1.0, PULSE, ledger=True)
    put_in = float(np.abs(np.diff(answer.ledger.ground)).sum())
    assert np.abs(answer.energy_residual).max() < 0.02 * put_in
    assert answer.fallen == {}


@pytest.mark.slow
@pytest.mark.parametrize(
    "masonry",
    [
        pytest.param(lambda: columns(20), id="twenty blocks"),
        pytest.param(lambda: columns(20, k_n=1e11), id="twenty stiff blocks"),
        pytest.param(lambda: columns(8, xi=0.0), id="no damping"),
        pytest.param(lambda: mr.Masonry.arch(5.0, 0.75, k_n=1e11), id="stiff arch"),
        pytest.param(lambda: mr.Masonry.arch(5.0, 0.75, points=5), id="five lines"),
        pytest.param(lambda: mr.Masonry.arch(5.0, 0.75, xi=5.0), id="overdamped arch"),
        pytest.param(lambda: mr.Masonry.running_bond(2.0, 1.0, (0.5, 0.25), 0.1), id="bond"),
    ],
)
def test_longer_hard_cases(masonry):
    answer = follow(masonry(), 5.0, PULSE, ledger=True)
    put_in = float(np.abs(np.diff(answer.ledger.ground)).sum())
    assert np.abs(answer.energy_residual).max() < 0.01 * put_in
    assert answer.fallen == {}


@pytest.mark.slow
def test_an_arch_that_collapses():
    answer = follow(mr.Masonry.arch(5.0, 0.75), 5.0, mr.GroundMotion.sine(5.0, 0.7))
    assert len(answer.fallen) > 5
    assert answer.t[-1] < 3


def test_a_cracked_facade_that_falls_away_from_a_side_wall_has_fallen():
    """Both halves turn about the toe. The joint with the tall wall behind them opens far before the base has let go."""

    def block(left, right, low, high, fixed=False, name=None):
        return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], fixed=fixed, name=name)

    ground, behind = block(-1, 2, -1, 0, True, "ground"), block(-1, 0, 0, 6, True, "behind")
    facade = block(0, 0.5, 0, 3, name="low"), block(0, 0.5, 3, 6, name="high")
    masonry = mr.Masonry((ground, behind, *facade), k_n=1e9, friction=lambda joint: 0.7 if joint.is_bed else 0.0)
    pushed = [(0.8 * z, -0.8 * -0.25, 0.8) for z in (1.5, 4.5)]
    times = []
    for step in (None, 2e-4):
        run = mr.simulate(mr.MasonryCase(masonry, 10.0, velocity=pushed), timestep=step, coulomb=True)
        assert (run.outcome, set(run.fallen)) == (mr.Outcome.OVERTURNED, {"low", "high"})
        times.append(run.fallen["low"])
    assert times[0] == pytest.approx(times[1], rel=0.01)


@pytest.mark.parametrize("length", [0.01, 50.0])
def test_masonry_moves_alike_whatever_its_length_out_of_the_plane(length):
    """Also where joints are so soft that blocks sink into one another by more than this length."""

    def soft(length):
        sizes = ((-2, -1, 4, 1, True), (0, 0, 1, 1, False), (0, 1, 1, 1, False))
        blocks = [
            mr.Polygon([(x, z), (x + w, z), (x + w, z + h), (x, z + h)], length=length, fixed=fixed)
            for x, z, w, h, fixed in sizes
        ]
        return mr.Masonry(blocks, k_n=1e6, friction=0.7, xi=0.05)

    runs = [follow(soft(of), 0.5, PULSE, timestep=1e-3) for of in (1.0, length)]
    np.testing.assert_allclose(runs[1].pose, runs[0].pose, atol=1e-9)


def test_small_blocks_sink_as_deep_as_their_joints_let_them():
    """Deeper than they are large: how deep a run follows goes by the largest block."""
    pads = [box(x - 0.02, x + 0.02, 0, 0.002, name=name) for x, name in ((-0.48, "left"), (0.48, "right"))]
    masonry = mr.Masonry([GROUND, *pads, box(-0.5, 0.5, 0.002, 1.002)], k_n=5e6, friction=0.7)
    run = follow(masonry, 0.01)
    assert run.t[-1] == 0.01
    assert run.pose[:, 2, 1] == pytest.approx(-2 * 0.5 * 2000 * mr.GRAVITY / (5e6 * 0.04), rel=0.01)
    assert run.outcome is mr.Outcome.AT_REST
