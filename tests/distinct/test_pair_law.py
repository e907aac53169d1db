"""What pairs of blocks have where they meet beyond their joints, on joints whose numbers are given."""

from types import SimpleNamespace

import numpy as np
import pytest

from mjrock.distinct import pair_law
from mjrock.distinct.rows import kinds, rows

WIDTHS = [0.2, 0.5, 0.4]
ENDS = [(0, 1), (1, 2), (1, 2)]
RESIDUAL = np.array([0.9, 0.5, 0.3])


def masonry(in_space=False):
    """Four blocks: 0 below 1, and 1 below 2 by two joints. The last one has no joint."""
    joints = [
        SimpleNamespace(below=low, above=high, width=width, area=2 * width)
        for (low, high), width in zip(ENDS, WIDTHS, strict=True)
    ]
    return SimpleNamespace(blocks=range(4), joints=joints, in_space=in_space, residual_friction=RESIDUAL)


JOINT = np.array([0, 0, 1, 1, 2])


def lines():
    table = rows(kinds(2).line, 5, k=[1.0, 2.0, 4.0, 5.0, 6.0], friction=[0.6, 0.6, 0.7, 0.7, 0.8])
    table["c"], table["k_s"], table["c_s"] = 0.1 * table["k"], 0.4 * table["k"], 0.02 * table["k"]
    return table


def law(in_space=False):
    return pair_law.PairLaw.of_joints(masonry(in_space), lines(), JOINT)


def expected(k, share=1.0):
    return {"k": share * k, "c": 0.1 * share * k, "k_s": 0.4 * share * k, "c_s": 0.02 * share * k}


def places(pair, share=1.0, area=1e9, in_space=False):
    one = law(in_space).of_places(np.array([pair]), np.array([share]), np.array([area]), 4)
    return {name: float(value[0]) for name, value in one.items()}


def test_the_number_of_a_pair_is_the_same_for_both_orders_and_of_no_other():
    a, b = np.divmod(np.arange(49), 7)
    numbers = pair_law.pair_number(a, b, 7)
    np.testing.assert_array_equal(numbers, pair_law.pair_number(b, a, 7))
    assert len(set(numbers.tolist())) == 7 * 8 / 2
    first, second = np.divmod(numbers, 7)
    assert ((first == np.minimum(a, b)) & (second == np.maximum(a, b))).all()


def test_numbers_are_found_among_others():
    others = np.array([2, 5, 9])
    np.testing.assert_array_equal(
        pair_law.are_among(np.array([1, 2, 3, 5, 9, 10]), others), [False, True, False, True, True, False]
    )
    assert not pair_law.are_among(np.array([1, 2]), np.zeros(0, dtype=int)).any()


def test_least_shares_of_pairs():
    least = pair_law.least_among(np.array([7, 3, 7, 5, 9]), np.array([3, 7, 7]), np.array([0.9, 0.4, 0.6]))
    np.testing.assert_array_equal(least, [0.4, 0.9, 0.4, 1.0, 1.0])


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize(("over", "kept"), [(1e-3, 0.01), (0.01, 0.1), (0.1, 0.1), (0.2, 0.2), (1.0, 1.0), (1.5, 1.5)])
def test_a_pair_that_had_joints_keeps_their_law_per_area(in_space, over, kept):
    """Two joints add up, with the least friction; that of a joint without its bond is the residual one."""
    scale = 2.0 if in_space else 1.0
    one, two = places(1, 1.0, over * scale * 0.2, in_space), places(4 + 2, 1.0, over * scale * 0.9, in_space)
    assert one == pytest.approx(expected(3.0, kept) | {"friction": 0.6})
    assert two == pytest.approx(expected(15.0, kept) | {"friction": 0.3})
    assert places(4 + 2, 0.25, 0.9) == pytest.approx(expected(15.0, 0.25) | {"friction": 0.3})
    assert places(4 + 2, 0.25, 0.0) == pytest.approx(expected(15.0, 0.25) | {"friction": 0.3})  # edges


def test_a_pair_that_had_none_takes_the_softer_block():
    """The stiffest joint of a block, or half of all its joints where that is more; the least friction of both."""
    assert places(2) == pytest.approx(expected(3.0) | {"friction": 0.3})
    assert places(4 + 3)["k"] == pytest.approx(9.0)  # the block without a joint is not the softer one
    assert places(3)["k"] == pytest.approx(3.0)


def test_half_of_many_joints_is_more_than_the_stiffest():
    joints = [SimpleNamespace(below=0, above=1 + i, width=0.5, area=0.5) for i in range(3)]
    given = SimpleNamespace(blocks=range(5), joints=joints, in_space=False, residual_friction=np.full(3, 0.9))
    table = rows(kinds(2).line, 3, k=[4.0, 5.0, 6.0], friction=0.6)
    found = pair_law.PairLaw.of_joints(given, table, np.arange(3))
    one = found.of_places(np.array([0 * 5 + 4]), np.ones(1), np.full(1, 1e9), 5)
    assert one["k"][0] == pytest.approx(7.5)


def test_the_softer_block_of_two_is_taken_whichever_comes_first():
    joints = [
        SimpleNamespace(below=0, above=1, width=0.5, area=0.5),
        SimpleNamespace(below=2, above=3, width=0.5, area=0.5),
    ]
    given = SimpleNamespace(blocks=range(4), joints=joints, in_space=False, residual_friction=np.full(2, 0.9))
    for stiffness in ([4.0, 5.0], [5.0, 4.0]):
        table = rows(kinds(2).line, 2, k=stiffness, friction=[0.6, 0.5])
        found = pair_law.PairLaw.of_joints(given, table, np.arange(2))
        one = found.of_places(np.array([0 * 4 + 2]), np.ones(1), np.full(1, 1e9), 4)
        assert (one["k"][0], one["friction"][0]) == (4.0, 0.5)


@pytest.mark.parametrize("in_space", [False, True])
def test_faces_without_a_joint_that_hardly_lie_over_each_other_have_less(in_space):
    """In proportion below a tenth of the area of the joints of the softer block, of which edges have none."""
    whole = (2.0 if in_space else 1.0) * 0.2
    for area, share in ((0.05 * whole, 0.5), (0.1 * whole, 1.0), (0.5 * whole, 1.0), (0.0, 1.0)):
        assert places(2, area=area, in_space=in_space)["k"] == pytest.approx(3.0 * share)
