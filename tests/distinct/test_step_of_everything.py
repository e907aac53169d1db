"""The default step knows everything that is stiff or damps: one of each, against closed forms."""

import math

import numpy as np
import pytest
from by_hand import system
from everyday import among
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.kinds.law import JointLaw
from mjrock.distinct.kinds.link import INFINITE_IN_LAW, Table
from mjrock.distinct.kinds.lists import KINDS
from mjrock.distinct.stable_step import longest_step
from mjrock.scene.time_step import stable_step

FAR = box(-80, 80, -60, -59, fixed=True)
POST = box(60, 60.3, -59, -58.7)
SIDE, K_N, FREQUENCY = 0.4, 1e8, 400.0


def rebound(mass, k, c):
    """|e| of a mass that meets a spring and a dashpot which never pull."""
    omega, ratio = math.sqrt(k / mass), c / (2 * math.sqrt(k * mass))
    if ratio == 1:
        return math.exp(-2)
    root = math.sqrt(abs(1 - ratio**2))
    if ratio < 1:  # until the force ends
        return math.exp(-ratio / root * math.atan2(2 * ratio * root, 2 * ratio**2 - 1))
    fast, slow = omega * (ratio + root), omega * (ratio - root)
    end = 2 * math.log(fast / slow) / (fast - slow)
    return (slow * math.exp(-slow * end) - fast * math.exp(-fast * end)) / (fast - slow)


def thrown_at_each_other(xi, faster):
    """|e| of two blocks without a joint that meet flush, whose dashpot `pairs` gives, and the step [s]."""
    blocks = [FAR, POST, box(0, SIDE, 0, SIDE), box(0.6, 0.6 + SIDE, 0, SIDE)]
    pairs = mr.Dry(friction=0.0, xi=xi, frequency=FREQUENCY)
    masonry = mr.Masonry(blocks, k_n=K_N, friction=0.0, xi=0.01, pairs=pairs)
    case = mr.MasonryCase(masonry, 0.25, velocity=[[0, 0, 0], [1 + faster, 0, 0], [-1, 0, 0]], settled=False)
    answer = mr.solve_explicit(case)
    speed = answer.velocity[-1, 1:, 0]
    return (speed[1] - speed[0]) / (2 + faster), blocks[2].mass


@pytest.mark.parametrize("xi", among([0.05, 0.1, 0.2, 0.4, 0.8, 1.0, 2.0, 5.0, 20.0], 0.05, 20.0))
def test_dashpots_of_pairs(xi):
    """Within 1 % up to a damping ratio of 0.35, and beyond within 0.5 % of the speed, wherever the touch lies."""
    for faster in (0.0, 3e-4, 7e-4):
        e, mass = thrown_at_each_other(xi, faster)
        k = K_N * SIDE
        expected = rebound(0.5 * mass, k, 2 * xi / FREQUENCY * k)
        assert e == pytest.approx(expected, abs=0.005 if xi > 0.28 else 0.01 * expected)


@pytest.mark.parametrize("of_all", [True, False])
def test_a_block_on_dashpots_of_pairs_lies_as_deep_as_its_springs_say(of_all):
    """Its step is that of these dashpots, and they soften no contact, given for all pairs or by a function of two."""
    strong = mr.Dry(friction=0.5, xi=1.0, frequency=60.0)
    pairs = strong if of_all else lambda one, other: strong if "A" in (one, other) else None
    blocks = [GROUND, box(3, 3.3, 0, 0.3), box(0, SIDE, 0.05, 0.05 + SIDE, name="A")]
    masonry = mr.Masonry(blocks, k_n=K_N, friction=0.5, xi=0.05, pairs=pairs)
    depth = -(mr.solve_explicit(mr.MasonryCase(masonry, 0.8, settled=False)).pose[-1, 1, 1] + 0.05)
    assert depth == pytest.approx(blocks[2].mass * mr.GRAVITY / (K_N * SIDE), rel=5e-3)


def test_contacts_that_dashpots_soften_are_named():
    """With a step that is given, too long for them."""
    pairs = mr.Dry(friction=0.5, xi=1.0, frequency=60.0)
    blocks = [GROUND, box(3, 3.3, 0, 0.3), box(0, SIDE, 0.05, 0.05 + SIDE, name="A")]
    masonry = mr.Masonry(blocks, k_n=K_N, friction=0.5, xi=0.05, pairs=pairs)
    with pytest.warns(UserWarning, match=r"dashpots, c/k = 0\.033 s, .* contacts of A have 16% of their stiffness"):
        answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.8, settled=False), timestep=1e-3)
    depth = -(answer.pose[-1, 1, 1] + 0.05)
    assert depth > 5 * blocks[2].mass * mr.GRAVITY / (K_N * SIDE)


@pytest.mark.parametrize("in_space", [False, True])
def test_a_block_of_pairs_with_a_joint_counts_too(in_space):
    """A column on its joint, whose pairs have dashpots that it lands on when it falls: the step is theirs."""
    blocks = [GROUND, box(-0.2, 0.2, 0, 1.0)]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]

    def step(xi):
        pairs = mr.Dry(xi=xi, frequency=60.0)
        other = [*blocks, *([mr.Polyhedron.prism(box(4, 5, 0, 1))] if in_space else [box(4, 5, 0, 1)])]
        masonry = mr.Masonry(other, k_n=1e8, xi=0.01, frequency=60.0, pairs=pairs)
        return mr.solve_explicit(mr.MasonryCase(masonry, 0.01)).stats["timestep"]

    assert step(0.01) == step(0.001)
    assert step(2.0) < 0.1 * step(0.01)


class Stiff(JointLaw, Table):
    """A law of a joint that is four times as stiff as its dry line, and nine times as damped."""

    def springs(self):
        dry = super().springs()
        return {"k": 4 * dry["k"], "c": 9 * dry["c"]}


def test_laws_of_joints():
    """A law tells its largest springs and dashpots."""
    whole = system(2, 1, still=True)
    line = whole.lines[0]
    line.normal, line.k, line.c, line.face = [0.0, 1.0], 2e4, 30.0, -1
    mass = whole.bodies["mass"][0]
    assert longest_step(whole) == pytest.approx(stable_step(2e4 / mass, 30.0 / mass))
    law = Stiff(Stiff.table(2, 1))
    law.rows["k"], law.rows["c"] = 2e4, 30.0
    stiffer = whole._replace(laws=(law,))
    assert longest_step(stiffer) == pytest.approx(stable_step(8e4 / mass, 270.0 / mass))
    assert whole.lines["k"] == [2e4]


def sliding(effect, speed, duration, k_n=1e9, **options):
    """A block on smooth ground that is thrown, with something at its centroid, and its mass."""
    masonry = mr.Masonry([GROUND, box(-0.2, 0.2, 0, 0.4)], k_n=k_n, friction=0.0, xi=0.05, frequency=60.0)
    case = mr.MasonryCase(masonry, duration, velocity=[[speed, 0, 0]], effects=effect, settled=False)
    return mr.solve_explicit(case, **options), masonry.blocks[1].mass


@pytest.mark.parametrize("c", [1e3, 1e4, 1e5, 1e6])
@pytest.mark.parametrize("k_n", [1e7, 1e9])
def test_dampers(c, k_n):
    """The way of a block that a damper stops, at any time within 1 % of all of it."""
    damper = mr.Damper(c=c, at=(0.0, 0.2), anchor=(-1.2, 0.2), block=1)
    answer, mass = sliding(damper, 0.5, 0.05, k_n, ledger=True)
    way = 0.5 * mass / c * (1 - np.exp(-c * answer.t / mass))
    np.testing.assert_allclose(answer.pose[:, 0, 0], way, atol=0.01 * way[-1])
    assert abs(answer.energy_residual[-1]) < 1e-3 * answer.energy[0]


@pytest.mark.parametrize("stiffness", [1e7, 1e8, 1e9, 1e10])
def test_ties_that_go_taut_within_a_step(stiffness):
    """They throw a block back as fast as it comes, wherever inside a step they go taut and slack."""
    for slack in (0.0, 0.01, 0.0107, 0.0112):
        tie = mr.Tie(stiffness=stiffness, slack=slack, at=(0.0, 0.2), anchor=(-1.2, 0.2), block=1)
        answer, mass = sliding(tie, 0.5, 0.06, ledger=True)
        back = math.pi * math.sqrt(mass / stiffness)
        assert answer.t[-1] > slack / 0.5 + back
        assert answer.velocity[-1, 0, 0] == pytest.approx(-0.5, rel=2e-4)
        assert np.abs(answer.energy_residual).max() < 1e-3 * answer.energy[0]


def test_a_tie_that_yields_as_it_goes_taut():
    """Its force is that of its strength from the moment at which its spring has that force, wherever inside a step."""
    strength, stiffness = 5e3, 1e9
    for slack in (0.01, 0.01001, 0.01002):
        tie = mr.Tie(stiffness=stiffness, strength=strength, slack=slack, at=(0, 0.2), anchor=(-1.2, 0.2), block=1)
        answer, mass = sliding(tie, 0.5, 0.035)
        rising = strength / (stiffness * 0.5)
        left = 0.5 - strength * (0.035 - slack / 0.5 - 0.5 * rising) / mass
        assert answer.velocity[-1, 0, 0] == pytest.approx(left, abs=2e-5)


def test_a_tower_on_a_tie_that_goes_taut():
    """Its largest rotation beside steps a sixteenth as long."""
    blocks = [GROUND, box(-0.3, 0.3, 0, 1.2), box(-0.3, 0.3, 1.2, 2.4)]
    masonry = mr.Masonry(blocks, joints=mr.Dry(k_n=1e9, friction=0.6, xi=0.05, frequency=60.0))
    for stiffness, amplitude, share in ((1e8, 6.0, 1.5e-3), (1e9, 5.88, 1.5e-3), (1e10, 6.12, 2.5e-3)):
        tie = mr.Tie(stiffness=stiffness, at=(-0.3, 2.0), anchor=(-2.0, 2.0), block=2)
        case = mr.MasonryCase(masonry, 1.0, motion=mr.GroundMotion.sine(amplitude, 0.5), effects=tie)
        answer = mr.solve_explicit(case, ledger=True)
        fine = mr.solve_explicit(case, timestep=answer.stats["timestep"] / 16)
        peaks = [np.abs(run.pose[:, :, 2]).max() for run in (answer, fine)]
        assert peaks[0] == pytest.approx(peaks[1], rel=share)
        assert np.abs(answer.ledger.residual).max() < 1e-3 * answer.ledger.largest


def test_jacks():
    """One that is stiffer than the joint, and damps."""
    k, c = 1e9, 2e5
    jack = mr.Actuator(1, (-0.2, 0.2), (1.0, 0.0), ([0.0, 1.0], [0.0, 0.0]), k, c)
    masonry = mr.Masonry([GROUND, box(-0.2, 0.2, 0, 0.4)], k_n=1e7, friction=0.0, xi=0.0)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.01, effects=jack))
    mass = masonry.blocks[1].mass
    assert answer.stats["stable_timestep"] == pytest.approx(stable_step(k / mass, c / mass), rel=1e-3)


def test_masonry_without_such_things_keeps_its_step():
    """A tie that is soft beside the joints, a weak damper and pairs like the joints shorten nothing."""
    blocks = [GROUND, box(-0.3, 0.3, 0, 1.2), box(-0.3, 0.3, 1.2, 2.4)]
    soft = mr.Tie(stiffness=1e6, at=(-0.3, 2.0), anchor=(-2.0, 2.0), block=2)
    weak = mr.Damper(c=1e3, at=(-0.3, 2.0), anchor=(-2.0, 2.0), block=2)
    joint = mr.Dry(k_n=1e9, xi=0.02, frequency=60.0)

    def step(pairs=None, effects=()):
        masonry = mr.Masonry(blocks, joints=joint, pairs=pairs)
        return mr.solve_explicit(mr.MasonryCase(masonry, 0.01, effects=effects)).stats["timestep"]

    bare = step()
    assert step(mr.Dry(xi=0.02, frequency=60.0)) == bare
    assert step(effects=(soft, weak)) == pytest.approx(bare, rel=1e-3)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_numbers_of_a_law_that_may_be_infinite_may_be_so_in_every_kind(kind):
    """A device of one's own with such a number, left at its default by all others, breaks no plain one."""
    assert INFINITE_IN_LAW == ("reach", "strength", "ultimate")
    assert set(INFINITE_IN_LAW) <= set(kind.endless)
