"""Rest is one pose, on any processor: the springs along faces are stretched once from the drawn pose."""

from dataclasses import replace

import numpy as np
import pytest
from everyday import among, slow
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.setup import setup_of
from mjrock.problem.masonry.limit.statics import falling
from mjrock.scene.masonry import scene_of_masonry
from scripts.checks.rest_on_processors import KERNELS, compared, rest, structure


@pytest.mark.parametrize(("thin", "count", "k_n"), [(0.1332, 49, 1.76e11), (0.1782, 80, 5.2e10), (0.1166, 46, 1e12)])
def test_stiff_arches_that_stand_are_at_rest_and_bear_what_soft_ones_do(thin, count, k_n):
    """By similarity forces do not depend on the stiffness, but for the small rotations of a stiff arch."""

    def thrusts(k_n):
        arch = mr.Masonry.arch(5.0, 5 * thin, voussoirs=count, k_n=k_n, k_s=0.5 * k_n, friction=0.7)
        scene = scene_of_masonry(arch)
        return scene.contacts.k * scene.bears

    stiff, soft = thrusts(k_n), thrusts(k_n / 100)
    np.testing.assert_allclose(stiff, soft, atol=0.02 * soft.max())


@pytest.mark.parametrize("seed", among([6, 7, 33, 34, 1356], 6, 7, 34, 1356))
def test_random_masonry_that_limit_analysis_holds_is_at_rest(seed):
    answer = rest(seed)
    assert answer is None or not answer.refused


@pytest.mark.slow
def test_rest_is_the_same_under_the_kernels_of_other_processors(tmp_path):
    """The first 30 of `scripts/checks/rest_on_processors.py`, and three of its 500 that are their own mirror images and
    lean to one side: none refused, and equal to 1e-9."""
    rows, refused = compared([*range(30), 112, 115, 193], tmp_path, KERNELS[:3])
    assert len(rows) > 1
    assert refused == []
    assert max(float(str(row[3])) for row in rows) < 1e-9


def rest_of(blocks, joints):
    """Displacements of the free blocks at rest, by name."""
    masonry = mr.Masonry(blocks, joints=joints)
    return dict(zip((masonry.names[i] for i in masonry.free), scene_of_masonry(masonry).rest_state.pose, strict=True))


def redrawn(blocks, by=0.0, sense=1):
    """The same blocks moved by a distance [m], or mirrored."""
    return [replace(block, vertices=[(sense * x + by, z) for x, z in block.vertices]) for block in blocks]


def apart(first, other, sense=1):
    """The largest difference of two poses of rest, one of them mirrored, over the largest displacement [-]."""
    pairs = [(first[name], other[name] * [sense, 1, sense]) for name in first]
    return max(np.abs(a - b).max() for a, b in pairs) / max(np.abs(a).max() for a in first.values())


def reflected(pose):
    """The mirror image of a symmetric structure in a pose: each block takes the place of the one across."""
    return dict(zip(pose, [row * [-1, 1, -1] for row in list(pose.values())[::-1]], strict=True))


@pytest.mark.parametrize(("count", "thin"), [(5, 0.11), slow((7, 0.11)), (9, 0.11), slow((57, 0.1101))])
def test_a_symmetric_arch_on_four_hinges_leans_to_positive_x(count, thin):
    """Four joints are open in the symmetric pose: nothing but geometry holds it, and it falls to a side. That side does
    not depend on where the arch is drawn, on the order of its blocks, or on which of two mirrored drawings it is."""
    joints = mr.Dry(6.4e10, friction=0.7)
    blocks = mr.Masonry.arch(2.0, 2 * thin, voussoirs=count, joints=joints).blocks
    pose = rest_of(blocks, joints)
    assert apart(pose, reflected(pose)) > 0.4
    assert sum(row[0] for row in pose.values()) > 0
    order = np.random.default_rng(1).permutation(len(blocks))
    assert apart(pose, rest_of([blocks[i] for i in order], joints)) < 1e-9
    assert apart(pose, rest_of(redrawn(blocks, by=1 / 3), joints)) < 1e-9
    assert apart(reflected(pose), rest_of(redrawn(blocks, sense=-1), joints), sense=-1) < 1e-9


@pytest.mark.parametrize("heavier", [1.3, 1.01])
def test_an_arch_that_is_not_symmetric_falls_where_its_mirror_image_does(heavier):
    joints = mr.Dry(1e10, friction=0.7)
    blocks = list(mr.Masonry.arch(2.0, 0.22, voussoirs=9, joints=joints).blocks)
    second = next(i for i, block in enumerate(blocks) if block.name == "voussoir_1")
    blocks[second] = replace(blocks[second], density=heavier * blocks[second].density)
    assert apart(rest_of(blocks, joints), rest_of(redrawn(blocks, sense=-1), joints), sense=-1) < 1e-9


@pytest.mark.slow
def test_a_symmetric_arch_leans_in_its_motion_too():
    """A damped run from the drawn pose comes near the symmetric pose, leaves it and ends in a leaning one."""
    arch = mr.Masonry.arch(2.0, 0.22, voussoirs=5, joints=mr.Dry(1e9, friction=0.7, xi=0.05))
    pose = scene_of_masonry(arch).rest_state.pose
    end = mr.solve_explicit(mr.MasonryCase(arch, 3.0, settled=False), mass_damping=5.0).pose[-1]
    mirrored = pose[::-1] * [-1, 1, -1]
    assert min(np.abs(end - pose).max(), np.abs(end - mirrored).max()) < 1e-3 * np.abs(pose).max()
    assert np.abs(pose - mirrored).max() > 0.5 * np.abs(pose).max()


@pytest.mark.slow
def test_an_arch_that_friction_keeps_stable_comes_to_the_same_rest_in_its_motion():
    """Without the stiffness that friction has as it turns with the blocks, its symmetric pose would be unstable. Points
    that slip keep some of the little push."""
    arch = structure(1356)[1]
    pose, velocity = scene_of_masonry(arch).rest_state.pose, np.tile([2e-3, 0.0, 0.0], (41, 1))
    np.testing.assert_allclose(pose, pose[::-1] * [-1, 1, -1], atol=1e-9 * np.abs(pose).max())
    case = mr.MasonryCase(arch, 5.0, settled=False, velocity=velocity)
    end = mr.solve_explicit(case, mass_damping=20.0).pose[-1]
    np.testing.assert_allclose(end, pose, atol=0.01 * np.abs(pose).max())


def test_a_tie_aslant_leaves_the_shear_springs_stretched():
    """A block under a tendon of 4 kN. The equations of its rest: k_n and k_s under the base, the tie between its ends,
    the weight. The case that starts as drawn comes to the same pose."""
    width, height, k_n, k_s, k = 0.8, 2.0, 2e8, 1e8, 3e6
    masonry = mr.Masonry([GROUND, box(-0.4, 0.4, 0, height, name="wall")], joints=mr.Dry(k_n, 1.5, 0.5, k_s, 50.0))
    tie = mr.Tie(stiffness=k, prestress=4e3, at=(-0.4, 1.8), anchor=(-2.0, 2.9), block="wall")
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 1e-3, effects=tie), forces=True)
    x, z, theta = answer.pose[0, 0]
    at, anchor = np.array([-0.4, 1.8 - 1.0]), np.array([-2.0, 2.9 - 1.0])
    sine, versine = np.sin(theta), 1 - np.cos(theta)
    held = at + np.array([x + at[1] * sine - at[0] * versine, z - at[0] * sine - at[1] * versine])
    across, drawn = anchor - held, np.linalg.norm(anchor - at)
    pull = 4e3 + k * (np.linalg.norm(across) - drawn)
    assert answer.forces.links["tie_0"][0] == pytest.approx(pull, rel=1e-6)
    assert pull == pytest.approx(3562, abs=1)
    sideways = pull * across[0] / np.linalg.norm(across)
    assert k_s * width * (x - theta) == pytest.approx(sideways, rel=1e-3)
    later = mr.solve_explicit(mr.MasonryCase(masonry, 1.0, effects=tie, settled=False), mass_damping=30.0)
    np.testing.assert_allclose(later.pose[-1], answer.pose[0], atol=1e-3 * abs(x))


def test_limit_analysis_holds_what_is_found_at_rest():
    """A thinner arch than the least is refused by both, and named as what falls."""
    thin = mr.Masonry.arch(5.0, 0.5, voussoirs=33, k_n=1e11, k_s=1e11, friction=0.7)
    assert falling(thin)
    with pytest.raises(ValueError, match="would fall under the weight"):
        mr.solve_explicit(mr.MasonryCase(thin, 1e-3))


def test_a_mass_at_the_edge_leaves_no_shear_that_cancels():
    """Nothing pulls sideways. As the block leans, its two points part by w (1 - cos theta), half of it each."""
    width, k_s = 0.8, 1e8
    masonry = mr.Masonry([GROUND, box(-0.4, 0.4, 0, 2.0, name="wall")], joints=mr.Dry(2e8, 1.5, 0.03, k_s, 50.0))
    case = mr.MasonryCase(masonry, 0.6, effects=mr.AddedMass(900.0, at=(0.3, 1.9), block="wall"))
    system = setup_of(case, None, None).system
    parted = 0.5 * width * (1 - np.cos(system.bodies["angle"].item()))
    grips = system.lines["shear_state"].ravel() * 0.5 * width * k_s
    np.testing.assert_allclose(grips, [0.5 * width * k_s * parted, -0.5 * width * k_s * parted], rtol=1e-3)
