"""What pairs of blocks have where they meet beyond their joints, on joints whose numbers are given."""

from types import SimpleNamespace

import numpy as np
import pytest

from mjrock.distinct.kinds.law import JointLaw
from mjrock.distinct.rows import kinds
from mjrock.distinct.search import pair_law
from mjrock.geometry.frames import PLANE, SPACE
from mjrock.rows import numbers, rows

WIDTHS = [0.2, 0.5, 0.4]
ENDS = [(0, 1), (1, 2), (1, 2)]
RESIDUAL = np.array([0.9, 0.5, 0.3])


def block(*sides, fixed=False, length=1.0, in_space=False):
    """With sides of some lengths, in space with square faces of these areas."""
    corners = [
        [(0, 0, 0), (a**0.5, 0, 0), (a**0.5, a**0.5, 0), (0, a**0.5, 0)] if in_space else [(1, 2), (1, 2 + a)]
        for a in sides
    ]
    of = [SimpleNamespace(corners=np.array(each, dtype=float)) for each in corners]
    ends = SimpleNamespace(corners=np.array([(0.0, -0.5 * length, 0.0), (0.0, 0.5 * length, 0.0)]))
    return SimpleNamespace(fixed=fixed, in_space=in_space, sides=of, drawn=(ends,))


def scene(blocks, ends=ENDS, widths=WIDTHS, residual=RESIDUAL, **known):
    """Blocks with joints 2 m long, as soft as each other but where something else is known."""
    joints = [
        SimpleNamespace(below=low, above=high, width=width, area=2 * width, length=2.0)
        for (low, high), width in zip(ends, widths, strict=True)
    ]
    springs = {name: np.ones(len(ends)) for name in ("k_n", "k_s", "retardation")}
    springs |= {"residual": residual, "pairs": None}
    return SimpleNamespace(
        rest_geometry=SimpleNamespace(solids=blocks, joints=joints),
        springs=SimpleNamespace(**springs | {name: np.array(each) for name, each in known.items()}),
        freedom=SPACE if blocks[0].in_space else PLANE,
    )


def law_of(scene, table, joint):
    """The law of lines of joints with these numbers."""
    scene.contacts = SimpleNamespace(joint=joint)
    return pair_law.PairLaw.of_joints(scene, table)


JOINT = np.array([0, 0, 1, 1, 2])


def lines():
    table = rows(kinds(2).line, 5, k=[1.0, 2.0, 4.0, 5.0, 6.0], friction=[0.6, 0.6, 0.7, 0.7, 0.8])
    table["c"], table["k_s"], table["c_s"] = 0.1 * table["k"], 0.4 * table["k"], 0.02 * table["k"]
    return table


def law(in_space=False, fixed=()):
    """Four blocks: 0 below 1, and 1 below 2 by two joints. The last one has no joint, and large faces."""
    blocks = [block(7.0, 9.0, in_space=in_space, fixed=i in fixed) for i in range(4)]
    return law_of(scene(blocks), lines(), JOINT)


def expected(k, share=1.0):
    return {"k": share * k, "c": 0.1 * share * k, "k_s": 0.4 * share * k, "c_s": 0.02 * share * k}


def places(pair, share=1.0, area=1e9, in_space=False, fixed=()):
    one = law(in_space, fixed).of_places(np.array([pair]), np.array([share]), np.array([area]), 4)
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
@pytest.mark.parametrize(
    ("over", "kept"), [(1e-3, 0.01), (0.025, 0.25), (0.2, 0.25), (0.5, 0.5), (1.0, 1.0), (1.5, 1.5)]
)
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
    assert places(4 + 3)["k"] == pytest.approx(9.0)  # the block without a joint has large faces, and is not the softer
    assert places(3)["k"] == pytest.approx(3.0)


def test_a_fixed_block_has_what_its_joints_have_per_area():
    """So that how many blocks stand on it plays no part: block 2 has 9 over 0.54 m, and block 0, 3 over 0.2 m, has
    8.1 over as much; or the other way round."""
    assert places(2, fixed=(0,)) == pytest.approx(expected(8.1) | {"friction": 0.3})
    assert places(2, fixed=(2,)) == pytest.approx(expected(3.0) | {"friction": 0.3})
    assert places(2, fixed=(1, 3)) == pytest.approx(expected(3.0) | {"friction": 0.3})


SOFT = {"k_n": [5.0, 4.0, 4.0, 4.0], "k_s": [1.0, 9.0, 2.0, 2.0], "retardation": [0, 0, 2.0, 1.0]}
"""Of four joints of which the last one is the softest: then the softest along its face, then the least damped."""


def loose_law(in_space=False, fixed=()):
    """Two loose blocks, of a largest face of 0.5 and 3, and two blocks with joints. Per area the softest joint has 8,
    in the plane 4 over 2 m of length; and the blocks are 1 m and 3 m long."""
    sizes = [(0.5, 0.1), (0.2, 3.0), (0.5,), (0.5,)]
    blocks = [
        block(*sides, in_space=in_space, length=3.0 if i == 1 else 1.0, fixed=i in fixed)
        for i, sides in enumerate(sizes)
    ]
    given = scene(blocks, [(2, 3)] * 4, [0.5] * 4, np.array([0.1, 0.2, 0.3, 0.4]), **SOFT)
    k = np.array([90.0, 80.0, 70.0, 8.0 if in_space else 4.0])
    table = rows(kinds(2).line, 4, k=k, c=0.1 * k, k_s=0.4 * k, c_s=0.02 * k, friction=0.9)
    return law_of(given, table, np.arange(4))


@pytest.mark.parametrize("in_space", [False, True])
def test_blocks_without_joints_have_the_softest_joint_of_the_masonry_over_their_faces(in_space):
    """And never less than a quarter of the largest face, unless they lie over less than a tenth of that."""
    found, per_area = loose_law(in_space), 8.0 if in_space else 4.0
    one = np.ones(1)
    for area, counts in ((0.5, 0.5), (0.3, 0.3), (0.1, 0.125), (0.02, 0.125), (0.0125, 0.125), (0.01, 0.1), (0.0, 0.5)):
        given = found.of_places(np.array([1]), 0.25 * one, area * one, 4)
        assert {name: float(column[0]) for name, column in given.items()} == pytest.approx(
            expected(per_area * counts, 0.25) | {"friction": 0.4}
        )
    assert found.loose.tolist() == [True, True, False, False]


@pytest.mark.parametrize("fixed", [(), (1,), (0,)])
def test_of_two_loose_blocks_the_smaller_one_rules_and_of_a_fixed_one_the_other(fixed):
    """A block of 3 m has 4 per m and m of length, three times as much as one that is 1 m long."""
    found = loose_law(fixed=fixed)
    assert found.of_block[0][:2, 0] == pytest.approx([2.0, 36.0])
    over = 2.9
    given = found.of_places(np.array([1]), np.ones(1), np.full(1, over), 4)["k"]
    assert given == pytest.approx(4.0 * over)


@pytest.mark.parametrize(("low", "high"), [(0, 2), (0, 3)])
def test_a_loose_block_that_is_softer_rules_over_one_with_joints(low, high):
    given = loose_law().of_places(np.array([4 * low + high]), np.ones(1), np.full(1, 0.2), 4)
    assert float(given["k"][0]) == pytest.approx(0.2 * 4.0)
    assert float(given["friction"][0]) == 0.1  # the least of the joints of the other one


@pytest.mark.parametrize("rounded", [-1e-12, 0.0, 1e-12])
@pytest.mark.parametrize("loose", [0, 1, 2])
def test_a_loose_block_rules_over_one_that_is_as_stiff_whichever_comes_first(loose, rounded):
    """A joint over 0.5 m has 4 N/m, as the face of the loose block. Over half of it the pair has half of them."""
    ends = [i for i in range(3) if i != loose]
    sides = [block(0.5 * (1 + rounded), length=2.0) if i == loose else block(9.0, length=2.0) for i in range(3)]
    found = law_of(
        scene(sides, [ends], [0.5], np.full(1, 0.9)), rows(kinds(2).line, 1, k=4.0, friction=0.6), np.zeros(1, int)
    )
    for other in ends:
        low, high = sorted((loose, other))
        given = found.of_places(np.array([3 * low + high]), np.ones(1), np.full(1, 0.25), 3)["k"]
        assert given == pytest.approx(0.5 * 4.0)


def test_half_of_many_joints_is_more_than_the_stiffest():
    given = scene([block(1.0)] * 5, [(0, 1), (0, 2), (0, 3)], [0.5] * 3, np.full(3, 0.9))
    table = rows(kinds(2).line, 3, k=[4.0, 5.0, 6.0], friction=0.6)
    found = law_of(given, table, np.arange(3))
    assert found.of_block[0][0, 0] == pytest.approx(7.5)


def test_the_softer_block_of_two_is_taken_whichever_comes_first():
    given = scene([block(1.0)] * 4, [(0, 1), (2, 3)], [0.5] * 2, np.full(2, 0.9))
    for stiffness in ([4.0, 5.0], [5.0, 4.0]):
        table = rows(kinds(2).line, 2, k=stiffness, friction=[0.6, 0.5])
        found = law_of(given, table, np.arange(2))
        one = found.of_places(np.array([0 * 4 + 2]), np.ones(1), np.full(1, 1e9), 4)
        assert (one["k"][0], one["friction"][0]) == (4.0, 0.5)


@pytest.mark.parametrize("damped", [(0.1, 0.2), (0.2, 0.1)])
def test_of_two_blocks_as_stiff_the_one_that_is_less_damped_is_taken(damped):
    """Whichever has the lower number."""
    given = scene([block(1.0)] * 4, [(0, 1), (2, 3)], [0.5] * 2, np.full(2, 0.9))
    table = rows(kinds(2).line, 2, k=4.0, c=np.array(damped), friction=0.6)
    found = law_of(given, table, np.arange(2))
    assert found.of_places(np.array([0 * 4 + 2]), np.ones(1), np.full(1, 1e9), 4)["c"][0] == pytest.approx(0.1)


@pytest.mark.parametrize("in_space", [False, True])
def test_faces_without_a_joint_that_hardly_lie_over_each_other_have_less(in_space):
    """In proportion below a tenth of the area of the joints of the softer block, of which edges have none."""
    whole = (2.0 if in_space else 1.0) * 0.2
    for area, share in ((0.05 * whole, 0.5), (0.1 * whole, 1.0), (0.5 * whole, 1.0), (0.0, 1.0)):
        assert places(2, area=area, in_space=in_space)["k"] == pytest.approx(3.0 * share)


def test_a_number_of_a_law_that_joints_have_already_is_named():
    class Doubled(JointLaw):
        own_fields = numbers("friction", "worn")

    with pytest.raises(TypeError, match="Doubled has friction as a number of a joint too"):
        Doubled.table(2, 1)
