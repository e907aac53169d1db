"""A stack with a side stop, and damping with which a stack that rocks as one loses what rocking theory says."""

import math
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from everyday import slow
from masonry_blocks import GROUND, box, columns

import mjrock as mr
from mjrock.problem.masonry.laws.joint_table import ByKind, ByName
from mjrock.problem.masonry.rigid_stack import RigidStack
from mjrock.study.campaign.task import fingerprint
from mjrock.study.matching.matched import DAMPING_ABOVE, damping_above, excess, peaks, rebound, restitutions
from mjrock.theory.impact import rigid_rocking

HOLDS = 10.0
WALL = mr.Block(0.3, 2.1)


def stack(blocks, k_n=1e9, **options):
    return mr.Masonry.stack([mr.Block(0.3, 2.1 / blocks)] * blocks, k_n, friction=HOLDS, **options)


def lost(masonry, amplitude=0.5, accuracy=1e-4):
    """Energy lost at the first impact over that of theory."""
    pile = RigidStack.from_masonry(masonry)
    e = rigid_rocking(pile)
    return 1 + excess(rebound(masonry, amplitude, accuracy), abs(e.lumped) if pile.sides else e.base)


def xi_of(masonry):
    return {joint.name: masonry.xi(joint) for joint in masonry.joints}


@pytest.mark.parametrize("law", ["CALIBRATED", mr.CALIBRATED_BED])
@pytest.mark.parametrize("top", [None, 3.8])
def test_one_block_with_a_side_stop_has_the_contacts_of_its_wall(law, top):
    points = 2 if law == "CALIBRATED" else 16
    e = mr.Restitution.from_geometry(WALL, top)
    contacts = mr.Contacts.from_law(WALL, e, k_base=1e9, k_side=5e8, law=law, points=points)
    side = contacts.side if top is None else contacts.side_up_to(top)
    masonry = stack(1, side_stop=True if top is None else mr.SideStop(top), k_side=5e8, law=law, points=points)
    assert [joint.name for joint in masonry.joints] == ["ground|block_0", "side|block_0"]
    assert masonry.lines.k == pytest.approx(np.append(contacts.base.stiffness, side.stiffness), rel=1e-12)
    assert masonry.retardation == pytest.approx([contacts.base.retardation, side.retardation], rel=1e-12)
    assert masonry.joint_friction.tolist() == [HOLDS, 0.0]
    assert masonry.blocks[-1].name == "side"


def test_one_block_with_a_side_stop_rebounds_as_its_wall():
    contacts = mr.Contacts.from_law(WALL, mr.Restitution.from_geometry(WALL), 5e8, 5e8)
    (wall,) = mr.simulate(mr.Case(WALL, 0.5 * WALL.alpha, 1.5), contacts, accuracy=1e-5).settled_restitution[:1]
    assert rebound(stack(1, 5e8, side_stop=True, law="CALIBRATED"), 0.5, 1e-5) == pytest.approx(wall, rel=5e-3)


def test_the_side_stop_of_a_stack():
    masonry = stack(3, side_stop=mr.SideStop(2.0), xi=0.1, side_friction=0.3)
    assert [joint.name for joint in masonry.joints if not joint.is_bed] == ["side|block_0", "side|block_1"]
    assert masonry.joints[-1].width == pytest.approx(0.6)  # the stop ends on the second block
    assert masonry.joint_friction.tolist() == [HOLDS, HOLDS, 0.3, HOLDS, 0.3]
    assert (masonry.joint_stiffness == 1e9).all()
    # xi refers to the stack without its stop
    assert masonry.retardation == pytest.approx(np.full(5, stack(3, xi=0.1).retardation[0]))
    assert stack(3, side_stop=True, xi=0.1) == stack(3, side_stop=True, xi=0.1)
    assert stack(3, side_stop=True, ground=False).free == (1, 2)


def test_the_law_of_a_side_stop_is_that_of_the_whole_stack():
    with warnings.catch_warnings(action="ignore"):
        masonry, whole = stack(3, side_stop=True, law="CALIBRATED"), stack(1, side_stop=True, law="CALIBRATED")
    sides = [i for i, joint in enumerate(masonry.joints) if not joint.is_bed]
    assert masonry.retardation[sides] == pytest.approx(np.full(3, whole.retardation[1]))
    assert masonry.retardation[0] == whole.retardation[0]


@pytest.mark.parametrize(
    ("options", "error", "complaint"),
    [
        ({"k_side": 1e9}, ValueError, "k_side and side_friction need a side stop"),
        ({"side_friction": 0.4}, ValueError, "k_side and side_friction need a side stop"),
        ({"side_stop": 3.0}, TypeError, "side_stop = 3.0 of type float is not a bool or SideStop"),
        (
            {"side_stop": mr.SideStop(5.0)},
            ValueError,
            "top of the side stop = 5 m is outside the valid range",
        ),
        ({"side_stop": True, "k_side": 1.0}, ValueError, "k_side = 1 N/m3 is outside the valid range"),
        ({"side_stop": True, "side_friction": -1.0}, ValueError, "side_friction = -1 is outside"),
    ],
)
def test_a_side_stop_that_cannot_be_is_refused(options, error, complaint):
    with pytest.raises(error, match=complaint):
        stack(2, **options)


@pytest.mark.parametrize(
    ("blocks", "k_n", "side_stop"),
    [
        *((blocks, k_n, False) for blocks, k_n in ((1, 1e11), (2, 1e9), (2, 1e11), (4, 1e11))),
        (2, 1e9, True),
        *(slow((blocks, 1e9, False)) for blocks in (1, 4, 7)),
        *(slow((blocks, k_n, True)) for blocks, k_n in ((4, 1e9), (7, 1e11))),
    ],
)
def test_a_matched_stack_loses_what_theory_says(blocks, k_n, side_stop):
    """At the rotation of the match with finer steps, and at others and a second impact that were not matched."""
    given = stack(blocks, k_n, side_stop=side_stop)
    matched = mr.matched_masonry(given)
    assert lost(matched, accuracy=1e-5) == pytest.approx(1, abs=5e-3)
    assert lost(matched, 0.35) == pytest.approx(1, abs=0.03)
    assert (matched.blocks, matched.k_n, matched.friction) == (given.blocks, given.k_n, given.friction)
    assert matched.joints == given.joints
    if not side_stop:
        pile = RigidStack.from_masonry(matched)
        velocity, swing = pile.rising(0.5)
        answer = mr.simulate(mr.MasonryCase(matched, 2.75 * swing, velocity=velocity), accuracy=1e-4)
        assert restitutions(answer, pile)[1] == pytest.approx(rigid_rocking(pile).base, rel=5e-4)
        assert len(peaks(answer, pile)) == 3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("h", "heights", "side_stop"),
    [
        (4.5, (1, 2), False),
        (1.5, (3, 1, 2), False),
        (3.0, (1, 1, 1, 2, 3), False),
        (3.0, (1, 2), True),
        (4.5, (3, 1, 2), True),
        (1.5, (1, 1, 1, 2, 3), True),
    ],
)
def test_stacks_of_unlike_blocks_are_matched_too(h, heights, side_stop):
    whole = sum(heights)
    parts, z = [], 0.0
    for i, share in enumerate(heights):
        parts.append(box(-0.3, 0.3, z, z + 2 * h * share / whole, density=1500 + 300 * i))
        z += 2 * h * share / whole
    side = [box(-1, -0.3, 0, z, fixed=True, name="side")] if side_stop else []
    masonry = mr.Masonry(
        [GROUND, *parts, *side], k_n=3e9 * (h / 2.1) ** 2, friction=lambda joint: HOLDS if joint.is_bed else 0.0
    )
    assert lost(mr.matched_masonry(masonry), accuracy=1e-5) == pytest.approx(1, abs=6e-3)


def test_one_block_gets_the_damping_of_its_wall():
    """The measures differ by what the springs store; see `Response.settled_restitution`."""
    e = mr.Restitution.from_geometry(WALL)
    contacts = mr.matched_contacts(WALL, e, 5e8, 5e8)
    xi = xi_of(mr.matched_masonry(stack(1, 5e8, side_stop=True), e))
    assert xi["side|block_0"] == pytest.approx(contacts.side.xi, rel=0.02)
    assert xi["ground|block_0"] == pytest.approx(contacts.base.xi, rel=0.05)


def test_the_law_loses_more_joint_by_joint():
    """The table of docs/masonry.md; two solvers agree on it, see tests/validation/test_stack_losses.py."""
    with warnings.catch_warnings(action="ignore"):
        found = [lost(stack(blocks, law="CALIBRATED")) for blocks in (1, 2, 4, 7)]
        stiffer = lost(stack(4, lambda joint: 1e9 if joint.below == 0 else 16e9, law="CALIBRATED"))
    assert found == pytest.approx([0.987, 1.043, 1.136, 1.240], abs=5e-3)
    assert stiffer == pytest.approx(0.990, abs=5e-3)


def test_the_joints_above_stay_closed_on_strong_dashpots():
    with warnings.catch_warnings(action="ignore"):
        law = stack(4, law="CALIBRATED")
    matched = mr.matched_masonry(law)
    opening = []
    for masonry in (law, matched):
        velocity, swing = RigidStack.from_masonry(masonry).rising(0.5)
        opening.append(mr.simulate(mr.MasonryCase(masonry, 1.75 * swing, velocity=velocity), accuracy=1e-4).opening)
    assert opening[0][0] == pytest.approx(opening[1][0], rel=1e-3)
    assert opening[0][1] > 1e-3
    assert (opening[1][1:] < 1e-5).all()


def test_the_uppermost_block_alone_loses_what_theory_says_on_strong_dashpots():
    """Half as high as wide, where the law lies outside its fit and lets it bounce."""
    given = stack(7, law=lambda wall, e, k_n: (0.05, 0.01))
    c_over_k = damping_above(RigidStack.from_masonry(given))
    one = mr.Masonry.stack([mr.Block(0.3, 0.3)], 1e9, friction=HOLDS, xi=0.5 * c_over_k, frequency=1.0)
    assert lost(one) == pytest.approx(1, abs=2e-3)
    with warnings.catch_warnings(action="ignore"):
        law = mr.Masonry.stack([mr.Block(0.3, 0.3)], 1e9, friction=HOLDS, law="CALIBRATED")
    assert lost(law) == pytest.approx(0.815, abs=0.01)


def test_the_strong_dashpots_of_two_blocks():
    """The lowest frequency of two blocks over an edge of the base, by hand.

    They move in four ways: the edge sinks by u, the blocks turn by t1 and t2, and the joint between opens by w.
    """
    k, b, h = 1e9, 0.3, 1.05
    m, line = 2000 * 4 * b * h, k * b
    turned = 2 * line * b**2  # stiffness of the joint between against turning
    x1, z1 = np.array([0, h, 0, 0]), np.array([1, b, 0, 0])
    x2, z2 = np.array([0, 2 * h, h, 0]), np.array([1, b, 0, 1])
    mass = m * sum(np.outer(way, way) for way in (x1, z1, x2, z2)) + m * (b**2 + h**2) / 3 * np.diag([0, 1, 1, 0])
    stiffness = np.diag([line, turned, turned, 2 * line])
    stiffness[1, 2] = stiffness[2, 1] = -turned
    rigid, lowest = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)[:2]
    assert abs(rigid) < 1e-9 * lowest  # it turns about the edge
    assert damping_above(RigidStack.from_masonry(stack(2))) == pytest.approx(
        2 * DAMPING_ABOVE / math.sqrt(lowest), rel=1e-9
    )


def test_a_restitution_of_ones_own():
    matched = mr.matched_masonry(stack(2), mr.Restitution(0.966, -0.4), amplitude=0.3)
    assert rebound(matched, 0.3, 1e-4) == pytest.approx(0.966, abs=1e-4)


@pytest.mark.slow
def test_a_side_stop_drawn_by_hand_on_the_right():
    parts = [box(-0.3, 0.3, 0, 2.1), box(-0.3, 0.3, 2.1, 4.2)]
    masonry = mr.Masonry(
        [box(0.3, 1, 0, 4.2, fixed=True), GROUND, *parts], k_n=1e9, friction=lambda j: HOLDS if j.is_bed else 0.0
    )
    mirrored = xi_of(mr.matched_masonry(stack(2, side_stop=True)))
    assert list(xi_of(mr.matched_masonry(masonry)).values()) == pytest.approx(
        [mirrored[name] for name in ("side|block_0", "side|block_1", "ground|block_0", "block_0|block_1")], rel=1e-3
    )


def test_where_no_damping_is_enough_the_closest_is_given():
    soft = mr.Masonry.stack([mr.Block(0.3, 1.5)] * 3, 1e8, friction=HOLDS)
    with pytest.warns(
        UserWarning, match=r"no damping of the base gives \|e\| = 0.993.* the closest, xi = 0.001, gives"
    ):
        matched = mr.matched_masonry(soft)
    assert xi_of(matched)["ground|block_0"] == pytest.approx(1e-3)


@pytest.mark.parametrize(
    ("arguments", "error", "complaint"),
    [
        ((mr.Masonry.arch(5, 0.75),), ValueError, "masonry is not a stack"),
        ((WALL,), TypeError, "masonry = .* is not a Masonry"),
        ((columns(2), 0.9), TypeError, "e = 0.9 of type float is not a Restitution or None"),
        ((stack(2, side_stop=True), mr.Restitution(0.9, 0.1)), ValueError, "side restitution = 0.1 is not a rebound"),
        ((stack(2, side_stop=mr.SideStop(1.0)),), ValueError, "side restitution"),
    ],
)
def test_what_cannot_be_matched_is_refused(arguments, error, complaint):
    with pytest.raises(error, match=complaint):
        mr.matched_masonry(*arguments)


@pytest.mark.parametrize("options", [{"amplitude": 0.0}, {"amplitude": 1.0}, {"accuracy": 1.0}])
def test_values_outside_their_range(options):
    with pytest.raises(ValueError, match="outside the valid range"):
        mr.matched_masonry(stack(2), **options)


@pytest.mark.slow
def test_matched_masonry_is_a_task_of_a_campaign():
    one, other = (mr.matched_masonry(stack(2, side_stop=True)) for _ in range(2))
    assert one == other
    assert fingerprint(mr.MasonryAnalysis(mr.MasonryCase(one, 1.0))) == fingerprint(
        mr.MasonryAnalysis(mr.MasonryCase(other, 1.0))
    )


def test_properties_by_kind_and_by_name():
    bed, side = stack(1, side_stop=True).joints
    assert [ByKind(1.0, lambda joint: joint.width)(joint) for joint in (bed, side)] == pytest.approx([1.0, 4.2])
    named = ByName(((bed.name, 3.0),))
    assert named(bed) == 3.0
    with pytest.raises(ValueError, match=r"the joint side\|block_0 has no value among those of ground\|block_0"):
        named(side)


@pytest.mark.parametrize("towards", [1.0, -1.0])
def test_rebounds_count_from_the_release_to_either_side(towards):
    """The last sample is on its way to a maximum and is not one; the one before it may be one."""
    theta = towards * np.array([0.8, 1.0, 0.5, -0.5, -0.6, -0.3, 0.001, 0.2, 0.4, 0.3])
    released = SimpleNamespace(theta=np.column_stack([theta, theta]), energy=np.arange(10.0, 0.0, -1.0))
    pile = SimpleNamespace(masses=np.array([1.0, 3.0]))
    assert peaks(released, pile) == [1, 4, 8]
    np.testing.assert_allclose(restitutions(released, pile), np.sqrt([6 / 9, 2 / 6]))
    rising = SimpleNamespace(theta=released.theta[:9], energy=released.energy[:9])
    assert peaks(rising, pile) == [1, 4]
