"""What plays no part in a motion by explicit steps: sides, the order of the blocks, directions in plan, and size."""

import math

import numpy as np
import pytest
from everyday import among
from masonry_blocks import box

import mjrock as mr

K_N = 1e8
MIRROR = np.diag([-1.0, 1.0])


def loose(scale=1.0):
    """A small wall in running bond on ground, and two blocks that fall on it, one of five sides."""
    ground = [(-3.0, -0.5), (4.0, -0.5), (4.0, 0.0), (-3.0, 0.0)]
    units = [[(x, z), (x + 0.4, z), (x + 0.4, z + 0.2), (x, z + 0.2)] for x, z in
             ((0.0, 0.0), (0.4, 0.0), (0.8, 0.0), (0.2, 0.2), (0.6, 0.2))]  # fmt: skip
    flying = [[(0.1, 0.5), (0.3, 0.45), (0.42, 0.6), (0.3, 0.75), (0.12, 0.7)], [(0.7, 0.6), (0.9, 0.65), (0.8, 0.85)]]
    return [scale * np.array(corners) for corners in (ground, *units, *flying)]


def followed(shapes, order=None, change=None, scale=1.0):
    """Displacements of all free blocks at samples [m], by the first numbering."""
    order = list(range(len(shapes))) if order is None else order
    turn = np.eye(2) if change is None else change
    blocks = []
    for i in order:
        corners = shapes[i] @ turn.T
        corners = corners[::-1] if np.linalg.det(turn) < 0 else corners
        blocks.append(mr.Polygon(corners, fixed=i == 0, name=f"b{i}", length=scale))
    masonry = mr.Masonry(blocks, k_n=K_N, k_s=K_N, friction=0.5, xi=0.1, frequency=200.0 / math.sqrt(scale), points=3)
    pushed = np.array([3.0, 0.0]) @ turn.T * np.sin(np.linspace(0, 2 * np.pi, 101))[:, None]
    motion = mr.GroundMotion(pushed[:, 0], 4e-3 * math.sqrt(scale))
    thrown = {6: (0.6, -1.0), 7: (-0.3, 0.2)}
    velocity = [(*(math.sqrt(scale) * np.array(thrown.get(i, (0.0, 0.0))) @ turn.T), 0.0) for i in order if i != 0]
    case = mr.MasonryCase(masonry, 0.4 * math.sqrt(scale), motion=motion, velocity=velocity, settled=False)
    run = mr.solve_explicit(case, timestep=2e-5 * math.sqrt(scale), output_step=0.02 * math.sqrt(scale))
    at = {i: j for j, i in enumerate(each for each in order if each != 0)}
    moved = np.stack([run.pose[:, at[i], :2] for i in range(1, len(shapes))], axis=1)
    return moved @ turn / scale


FIRST = loose()


@pytest.fixture(scope="module")
def drawn():
    moved = followed(FIRST)
    assert np.abs(moved[-1]).max() > 0.1
    return moved


def test_mirrored_masonry_moves_alike(drawn):
    """A mirror turns the order of the lines, which rounding alone feels."""
    np.testing.assert_allclose(followed(FIRST, change=MIRROR), drawn, atol=1e-8)


@pytest.mark.parametrize("order", among([[7, 3, 0, 5, 1, 6, 4, 2], [0, 7, 6, 5, 4, 3, 2, 1]], [7, 3, 0, 5, 1, 6, 4, 2]))
def test_the_order_of_the_blocks_plays_no_part(drawn, order):
    np.testing.assert_allclose(followed(FIRST, order=order), drawn, atol=1e-8)


def test_a_model_moves_as_what_it_is_a_model_of(drawn):
    """Lengths times 4 and times times 2, at the same k_n and density: after Froude, to the last digit."""
    np.testing.assert_allclose(followed(loose(4.0), scale=4.0), drawn, rtol=0.0, atol=1e-13)


def asymmetry(voussoirs, k_s):
    """How far an arch is from its mirror image, and how far it moves [m]. Its abutments part, its ground moves up and
    down."""
    arch = mr.Masonry.arch(2.0, 0.5, 2.4, voussoirs, k_n=K_N, k_s=k_s, friction=0.7)
    t, way = np.array([0.0, 0.2, 0.4]), np.array([0.0, 0.01, 0.03])
    supports = {"left_abutment": (t, -way, 0 * way), "right_abutment": (t, way, 0 * way)}
    shaken = mr.GroundMotion.sine(4.0, 0.3, 2)
    run = mr.solve_explicit(mr.MasonryCase(arch, 0.4, supports=supports, vertical=shaken), output_step=0.02)
    place = run.pose[:, :, :2]
    return float(np.abs(place[:, ::-1] * (-1.0, 1.0) - place).max()), float(np.ptp(place, axis=0).max())


@pytest.mark.parametrize("voussoirs", [2, 3, 6])
def test_a_symmetric_arch_on_springs_stays_symmetric(voussoirs):
    """Whether a voussoir or a joint is at its crown."""
    off, moved = asymmetry(voussoirs, 0.5 * K_N)
    assert moved > 5e-3
    assert off < 1e-12


def test_a_symmetric_arch_with_rigid_friction_is_symmetric_as_far_as_its_sweeps():
    """Impulses of friction are found to 1e-3 of the largest, one line after the other."""
    found = {voussoirs: asymmetry(voussoirs, None) for voussoirs in (2, 3, 6, 7)}
    for voussoirs, (off, moved) in found.items():
        print(f"{voussoirs} voussoirs: {off:.1e} m of {moved:.1e} m")
        assert off < 2e-3 * moved


def test_lines_of_blocks_beside_each_other_go_by_the_middle_of_the_masonry():
    """Points are on the outer block; in the middle they are on both, and together as stiff."""
    units = [box(x, x + 0.4, 0.0, 0.2) for x in (-0.8, -0.4, 0.0, 0.4)]
    masonry = mr.Masonry([box(-2, 2, -1, 0, fixed=True), *units], k_n=K_N)
    lines = masonry.lines
    for joint, points in (("block_1|block_2", {1}), ("block_2|block_3", {2, 3}), ("block_3|block_4", {4})):
        own = lines.joint == [each.name for each in masonry.joints].index(joint)
        assert set(lines.body[own].tolist()) == points
        assert lines.k[own].sum() == pytest.approx(K_N * 0.2)
        np.testing.assert_allclose(lines.k[own] @ lines.at[own] / lines.k[own].sum(), lines.at[own].mean(axis=0))
