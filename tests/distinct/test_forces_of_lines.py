"""Forces that are kept at a sample, one function at a time, against sums over the lines."""

import math

import numpy as np
import pytest
from by_hand import about, books, matrix, system

from mjrock.distinct import force_record
from mjrock.distinct.contacts import faces
from mjrock.distinct.kinds.mortar import Bonds
from mjrock.distinct.system import Samples
from mjrock.result.forces import ForceCounts

BOTH = pytest.mark.parametrize("d", [2, 3])
NORMAL = {2: np.array([0.6, 0.8]), 3: np.array([0.48, 0.6, 0.64])}
ALONG = {2: np.array([0.8, -0.6]), 3: np.array([-0.8, 0.0, 0.6])}
AT = {2: np.array([0.2, -0.5]), 3: np.array([0.2, 0.3, -0.5])}
ORIGIN = {2: np.array([-0.1, 0.4]), 3: np.array([-0.1, -0.25, 0.4])}
JOINTS = 2


def along(d, size):
    """What a line keeps of friction of some size along its face: a number in the plane, a vector in space."""
    return [size] if d == 2 else size * ALONG[3]


def held(d, bonds=0):
    """Lines of body 1, closed by 2 mm but the last one: on body 0, on the ground, in no joint, and open.

    Actuators drive both bodies.
    """
    whole = system(d, 4)
    whole = whole._replace(guided=np.array([1, 0]), laws=(Bonds(whole.laws[0].rows[:bonds]),))
    for i, line in enumerate(whole.lines):
        line.body, line.face, line.fixed = 1, 0 if i == 0 else -1, [-1, 1, 0, 1][i]
        line.at, line.origin, line.normal = AT[d] + 0.1 * i, ORIGIN[d], NORMAL[d]
        line.group, line.sense = [1, 0, JOINTS, 0][i], [1.0, -1.0, 1.0, 1.0][i]
        turn = matrix(d, 0) if i == 0 else np.eye(d)
        over = whole.bodies[0].place + turn @ ORIGIN[d] - ORIGIN[d] if i == 0 else np.zeros(d)
        body = whole.bodies[1]
        own = body.place + matrix(d, 1) @ line.at - line.at
        line.between = -0.002 * turn @ NORMAL[d] - own + over
        if i < 3:
            line.push, line.depth, line.k_s = 10.0 + i, 0.002, 1e6
            line.shear_force = along(d, 2.0 + i)
    samples = Samples.room(1, whole, books(whole)).with_forces(
        ForceCounts(joints=JOINTS, fixed=2, links=0, actuators=2)
    )
    return whole, samples


def acting(whole, p, push, friction):
    """Force of a line on body 1, and its place there and on body 0, both from the centroid."""
    line, d = whole.lines[p], len(whole.axes)
    turn = matrix(d, 0) if line.face == 0 else np.eye(d)
    drag = friction * (turn @ ALONG[2] if d == 2 else ALONG[3])  # springs of space are kept in the axes of the world
    meet = faces.where_friction_rubs(faces.meeting(whole, line))
    return push * np.array(meet.normal) + drag, np.array(meet.arm), np.array(meet.face_arm)


@BOTH
def test_forces_of_lines_are_summed_by_joint_block_and_actuator(d):
    whole, samples = held(d)
    force_record.record_forces(whole, samples, 0)
    loads, blocks = np.zeros((JOINTS, len(samples.loads[0, 0]))), np.zeros((2, d))
    guided, body = np.zeros((2, loads.shape[1])), whole.bodies[1]
    for p in range(3):
        force, arm, face_arm = acting(whole, p, 10.0 + p, 2.0 + p)
        place, group = body.rest + body.place + arm, whole.lines[p].group
        if group < JOINTS:
            loads[group] += whole.lines[p].sense * np.concatenate([force, about(place, force)])
        if p > 0:
            blocks[whole.lines[p].fixed] += force
        guided[0] += np.concatenate([force, about(arm, force)])
        if p == 0:
            guided[1] -= np.concatenate([force, about(face_arm, force)])
    np.testing.assert_allclose(samples.loads[0], loads, rtol=1e-10)
    np.testing.assert_allclose(samples.contact_reactions[0], blocks, rtol=1e-10)
    np.testing.assert_allclose(samples.guided[0], guided, rtol=1e-10)
    np.testing.assert_array_equal(samples.damage[0], 0.0)


@BOTH
def test_a_bonded_line_has_the_force_of_its_bond_too(d):
    """Of three bonds the second one holds a line that is open, and the third one is that of a dry line."""
    whole, samples = held(d, bonds=3)
    for p in (0, 1):
        bond = whole.laws[0].rows[p]
        bond.k, bond.push, bond.shear_force = 0.5, -30.0 - p, along(d, 0.5)
    whole.laws[0].rows["integrity"], whole.laws[0].rows["share"] = [0.75, 0.5, 0.25], [1.0, 0.5, 0.25]
    line = whole.lines[1]
    line.push = line.depth = 0.0
    whole.lines["group"][2] = 0
    force_record.record_forces(whole, samples, 0)
    one, other, dry = acting(whole, 0, -20.0, 2.5)[0], acting(whole, 1, -31.0, 3.5)[0], acting(whole, 2, 12.0, 4.0)[0]
    np.testing.assert_allclose(samples.loads[0, 1, :d], one, rtol=1e-10)
    np.testing.assert_allclose(samples.loads[0, 0, :d], dry - other, rtol=1e-10)
    np.testing.assert_allclose(samples.contact_reactions[0], [dry, other], rtol=1e-10)
    np.testing.assert_allclose(samples.damage[0], [0.5 * 0.5 + 0.25 * 0.75, 0.25])


@BOTH
def test_without_room_nothing_is_kept(d):
    whole, samples = held(d)
    samples = samples.with_forces(ForceCounts(joints=JOINTS, fixed=0, links=0, actuators=2))
    force_record.record_forces(whole, samples, 0)
    assert not samples.loads.any()
    assert not samples.guided.any()


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
def test_friction_of_a_line_that_sticks_is_that_of_its_impulse_and_of_what_dragged_it_as_it_left(d, face):
    whole, _ = held(d)
    line = whole.lines[0]
    line.face, line.shear_force = face, along(d, 2.0)
    line.shear_state = along(d, 0.5)
    assert force_record.total_friction(whole, line) == pytest.approx(tuple(along(d, 2.0)))
    line.k_s = math.inf
    turned = matrix(3, 0) @ ALONG[3] if d == 3 and face == 0 else ALONG[d]
    expected = [2.5] if d == 2 else 2.0 * ALONG[3] + 0.5 * turned
    np.testing.assert_allclose(force_record.total_friction(whole, line), expected, rtol=1e-12)


@BOTH
def test_what_acts_on_the_blocks_of_actuators_before_any_contact_is_kept(d):
    whole, samples = held(d)
    random = np.random.default_rng(d)
    for name in ("force", "moment"):
        whole.bodies[name] = random.normal(size=whole.bodies[name].shape)
    force_record.record_guide_loads(whole, samples, 0)
    bodies = whole.bodies[[1, 0]]
    np.testing.assert_array_equal(samples.guided[0], np.hstack([bodies["force"], bodies["moment"]]))
