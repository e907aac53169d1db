"""Supports that move are kept by the name of their block, also where a case gets another masonry."""

import dataclasses

import numpy as np
import pytest
from masonry_blocks import box

import mjrock as mr

ARCH = mr.Masonry.arch(5.0, 0.75, voussoirs=5, k_n=1e9)
CASE = mr.MasonryCase(ARCH, 0.1, supports={"right_abutment": ([0.0, 0.1], [0.0, 0.02], [0.0, 0.0])})
COLUMN = mr.Masonry([box(-1, 1, -1, 0, fixed=True, name="ground"), box(-0.2, 0.2, 0, 1, name="right_abutment")])
SPACE = mr.Masonry.box((0.6, 0.4, 1.0), k_n=1e9)


def test_another_order_of_the_blocks_moves_the_same_block():
    right = ARCH.names.index("right_abutment")
    others = (ARCH.blocks[right], *ARCH.blocks[:right], *ARCH.blocks[right + 1 :])
    other = dataclasses.replace(CASE, masonry=dataclasses.replace(ARCH, blocks=others))
    assert [support.block for support in other.supports] == ["right_abutment"]
    runs = [mr.solve_explicit(case) for case in (CASE, other)]
    far = [np.abs(run.pose[-1, :, 0]).max() for run in runs]
    assert far[0] > 0.01
    assert far[1] == pytest.approx(far[0], rel=1e-3)


@pytest.mark.parametrize(
    ("masonry", "complaint"),
    [
        (mr.Masonry.running_bond(1.0, 0.5, (0.5, 0.25), 0.3), "'right_abutment' of type str is not a fixed block"),
        (COLUMN, "'right_abutment' of type str is not a fixed block; the valid ones are ground"),
    ],
)
def test_masonry_without_the_block_is_refused(masonry, complaint):
    with pytest.raises(ValueError, match=complaint):
        dataclasses.replace(CASE, masonry=masonry)


def test_axes_that_do_not_fit_are_refused():
    flat, spatial = ([0.0, 1.0], [0.0, 0.1], [0.0, 0.0]), ([0.0, 1.0], [0.0, 0.1], [0.0, 0.0], [0.0, 0.0])
    in_plane = mr.MasonryCase(mr.Masonry(COLUMN.blocks), 1.0, supports={"ground": flat})
    in_space = mr.MasonryCase(SPACE, 1.0, supports={"ground": spatial})
    with pytest.raises(
        TypeError, match=r"supports, ground = .* is not \(t, dx, dy, dz\), which masonry in space takes"
    ):
        dataclasses.replace(in_plane, masonry=SPACE)
    with pytest.raises(TypeError, match=r"supports, ground = .* is not \(t, dx, dz\), which masonry in the plane"):
        dataclasses.replace(in_space, masonry=COLUMN)
    assert dataclasses.replace(in_space, duration=2.0).supports == in_space.supports


@pytest.mark.parametrize("far", [{"dx": 200.0}, {"dz": -200.0}])
def test_a_displacement_along_one_axis_may_be_too_large(far):
    rows = {"dx": 0.0, "dz": 0.0} | far
    histories = [0.0, 1.0], *([0.0, value] for value in rows.values())
    with pytest.raises(ValueError, match="a displacement of 200 m is outside the valid range to 100 m"):
        mr.MasonryCase(COLUMN, 1.0, supports={"ground": histories})


def test_times_lie_within_eleven_days():
    with pytest.raises(
        ValueError, match="supports, ground, t = 1e\\+300 s is outside the valid range -1e\\+06 to 1e\\+06 s"
    ):
        mr.MasonryCase(COLUMN, 1.0, supports={"ground": ([0.0, 1e300], [0.0, 0.1], [0.0, 0.0])})


def test_rows_of_different_lengths_are_refused():
    with pytest.raises(ValueError, match="supports, ground"):
        mr.MasonryCase(COLUMN, 1.0, supports={"ground": ([0.0, 1.0], [0.0, 0.1, 0.2], [0.0, 0.0])})
