"""Joint forces and moments beside the motion of each block: free bodies close, also where bonds pull."""

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.bodies import BodyMotion

BOND = mr.Bond(tension=0.05e6, cohesion=0.07e6, opening_energy=0.5, slip_energy=5.0)


def column(bond):
    """Three blocks on the ground, of which the last one stands out."""
    sides = [(-1.0, 1.0, -0.5, 0.0), (-0.15, 0.15, 0.0, 0.5), (-0.15, 0.15, 0.5, 0.9), (-0.12, 0.2, 0.9, 1.3)]
    blocks = [
        mr.Polygon([(a, c), (b, c), (b, d), (a, d)], fixed=c < 0, name=name)
        for (a, b, c, d), name in zip(sides, ("ground", "low", "mid", "top"), strict=True)
    ]
    return mr.Masonry(blocks, k_n=5e9, k_s=2e9, friction=0.6, xi=0.05, points=3, bond=bond)


SHAKEN = mr.GroundMotion.sine(8.0, 0.4, cycles=1)
LIFTED = mr.GroundMotion.sine(13.0, 0.1, cycles=2)
"""Up and down by more than the weight, so that bonds pull."""


def free_body(masonry, answer, accel, rise):
    """Largest force and moment that the joints of a block lack, over its mass times acceleration and its weight."""
    forces, pose, h = answer.forces, answer.pose, answer.t[1]
    middle, axes = BodyMotion(answer.case, answer.t, pose).joints(forces.frames)
    local = np.concatenate([forces.normal[..., None], forces.shear[..., None]], axis=2)
    force = (local[..., None] * axes).sum(axis=2)
    turned = (pose[2:] - 2 * pose[1:-1] + pose[:-2]) / h**2
    lacking = []
    for row, i in enumerate(masonry.free):
        block, total = masonry.blocks[i], np.zeros((len(answer.t), 3))
        place = masonry.centroids[i] + pose[:, row, :2]
        for j, joint in enumerate(masonry.joints):
            if i in (joint.below, joint.above):
                arm, sense = middle[:, j] - place, 1.0 if i == joint.above else -1.0
                about = arm[:, 1] * force[:, j, 0] - arm[:, 0] * force[:, j, 1] + forces.moment[:, j]
                total += sense * np.column_stack([force[:, j], about])
        total -= block.mass * np.column_stack([accel, mr.GRAVITY + rise, 0 * accel])
        total[1:-1] -= turned[:, row] * [block.mass, block.mass, block.inertia]
        lacking.append(np.abs(total[1:-1]).max(axis=0) / (block.mass * mr.GRAVITY * np.array([1, 1, block.size])))
    return np.max(lacking, axis=0)


@pytest.mark.parametrize("bond", [None, BOND], ids=["dry", "bonded"])
def test_joints_of_a_column_in_motion_move_each_block(bond):
    """Of every step. Second differences of the pose round off at 1e-16 / h^2, that is 1e-5 of the weight."""
    masonry = column(bond)
    h, lifted = 4e-5, LIFTED if bond else LIFTED.scaled(0.2)
    case = mr.MasonryCase(masonry, 0.2, SHAKEN, vertical=lifted)
    answer = mr.solve_explicit(case, timestep=h, output_step=h, forces=True)
    assert (answer.forces.normal.min() < -1000.0) == (bond is not None)
    assert np.nanmax(answer.forces.damage) > 0.3 if bond else answer.opening.max() > 1e-4
    assert free_body(masonry, answer, SHAKEN(answer.t), lifted(answer.t)).max() < 1e-5


def test_where_a_bond_pulls_is_said_and_moment_is_force_times_eccentricity():
    answer = mr.solve_explicit(mr.MasonryCase(column(BOND), 0.1, SHAKEN, vertical=LIFTED), forces=True)
    forces = answer.forces
    assert (forces.normal < 0).any()
    assert np.isfinite(forces.eccentricity).all()
    np.testing.assert_allclose(forces.moment, -forces.normal * forces.eccentricity, rtol=1e-12)
    dry = mr.solve_explicit(mr.MasonryCase(column(None), 0.1, SHAKEN), forces=True)
    np.testing.assert_array_equal(np.isnan(dry.forces.eccentricity), dry.forces.normal == 0)


def test_torsion_and_bending_of_a_bonded_cantilever_in_space():
    """A block that hangs on a wall beside it, held off its middle: torsion W e about the normal, bending W a."""
    wall = mr.Polyhedron.box((0.5, 1.0, 1.0), (-0.25, 0.0, 0.5), fixed=True, name="wall")
    block = mr.Polyhedron.box((0.4, 0.6, 0.2), (0.2, 0.4, 0.5), name="block")  # 0.1 to 0.7 beside a wall to 0.5
    masonry = mr.Masonry([wall, block], k_n=1e10, k_s=5e9, points=3, bond=mr.Bond(1e6, 1e6, 10.0, 100.0))
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.01), forces=True)
    (joint,), forces = masonry.joints, answer.forces
    weight = block.mass * mr.GRAVITY
    about = np.array([forces.moment[0, 0, 0], *forces.moment[0, 0, 1:]]) @ np.vstack([joint.normal, joint.axes])
    arm = np.array(block.centroid) - joint.middle
    assert about == pytest.approx(-np.cross(arm, [0.0, 0.0, -weight]), abs=1e-6 * weight)
    assert abs(about @ joint.normal) == pytest.approx(0.1 * weight, rel=1e-5)
    assert "torsion of wall|block [N m]" in forces.columns()
