"""A tilting table by limit analysis: tan of the angle at which masonry falls is its multiplier, and closed forms."""

import itertools
import math

import numpy as np
import pytest
from everyday import slow
from masonry_blocks import bracket, tilted

import mjrock as mr
from mjrock.problem.masonry.limit.statics import falling

ARCH = mr.Masonry.arch(radius=5.0, thickness=1.0, voussoirs=9, friction=1.5, xi=0)


def of_hinges(arch):
    """The least multiplier of all mechanisms of four hinges of an arch between two abutments, to the right.

    Hinges lie at the inner and outer ends of joints in turn. The first and the last part turn about their hinges at the
    abutments, the middle one about where the lines of the outer pairs of hinges meet. Rates turn a top to the right.
    """
    joints = sorted(arch.plane_joints, key=lambda joint: math.atan2(joint.middle[1], -joint.middle[0]))
    ends = [sorted((joint.start, joint.end), key=np.linalg.norm) for joint in joints]
    blocks = sorted((arch.blocks[i] for i in arch.free), key=lambda block: block.centroid[0])
    found = []
    for chosen in itertools.combinations(range(len(joints)), 4):
        for first in (0, 1):
            a, b, c, d = (np.array(ends[joint][(first + k) % 2]) for k, joint in enumerate(chosen))
            matrix = np.column_stack([b - a, c - d])
            if abs(np.linalg.det(matrix)) < 1e-9:
                continue
            share = np.linalg.solve(matrix, d - a)[0]
            centre = a + share * (b - a)
            # at the second hinge both parts have one velocity, and so at the third
            middle = float((b - a) @ (b - centre)) / float((b - centre) @ (b - centre))
            last = middle * float((c - centre) @ (c - d)) / float((c - d) @ (c - d))
            lift = push = 0.0
            for i, block in enumerate(blocks):
                part = sum(i >= joint for joint in chosen)
                if part in (1, 2, 3):
                    about, rate = ((a, 1.0), (centre, middle), (d, last))[part - 1]
                    x, z = block.centroid - about
                    push, lift = push + block.mass * rate * z, lift - block.mass * rate * x
            turns = math.copysign(1.0, push) * np.diff([0.0, 1.0, middle, last, 0.0])
            opens = all((turn > 0) == ((first + k) % 2 == 0) for k, turn in enumerate(turns))  # and does not overlap
            if opens and abs(push) > 1e-9:
                found.append(lift / push)
    return min(found)


CASES = {
    "a column slides": (mr.Masonry.stack([mr.Block.from_size(0.5, 0.6)] * 3, k_n=1e9, friction=0.25, xi=0), 0.25),
    "a column turns": (mr.Masonry.stack([mr.Block.from_size(0.5, 0.6)] * 3, k_n=1e9, friction=0.7, xi=0), 0.5 / 1.8),
    "a panel slides": (mr.Masonry.running_bond(1.5, 1.75, (0.5, 0.25), thickness=0.3, friction=0.45, xi=0), 0.45),
    "an arch has four hinges": (ARCH, of_hinges(ARCH)),
}


@pytest.mark.parametrize("name", [slow(name) if name == "a panel slides" else name for name in CASES])
def test_closed_forms_of_a_tilting_table(name):
    masonry, expected = CASES[name]
    for associated in (True, False):
        found = mr.collapse_multiplier(masonry, associated=associated).multiplier
        assert found == pytest.approx(expected, rel=1e-6)
    level = math.atan(expected)
    angle = bracket(lambda tilt: not falling(tilted(masonry, tilt)), 0.5 * level, 1.5 * level, 9)
    assert math.tan(angle) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize(("sides", "corner"), [(4, math.pi / 4), (6, math.pi / 6), (12, math.pi / 12)])
def test_a_column_of_drums_turns_about_its_foot(sides, corner):
    """About an edge of its section, 0.3 m from the middle, along x, and about a corner between two of these."""
    column = mr.Masonry.column(0.6, 2.4, 4, sides=sides, k_n=1e9, friction=0.7, xi=0)
    for angle, reach in ((0.0, 0.3), (corner, 0.3 / math.cos(corner))):
        assert mr.collapse_multiplier(column, angle=angle).multiplier == pytest.approx(reach / 1.2, rel=1e-6)


@pytest.mark.slow
def test_a_column_of_drums_falls_at_the_angle_of_its_foot():
    """In time, by explicit steps: most of the half per cent is the time until a block moves by 2 mm/s."""
    from scripts.checks.tilting_table import DRUMS, REACH, tangent

    assert tangent(DRUMS, REACH / 1.2) == pytest.approx(REACH / 1.2, rel=0.01)
