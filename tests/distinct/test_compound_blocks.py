"""Units that are not convex, where they are: notches are empty, cuts are not felt, and parts of one body never meet."""

from itertools import pairwise

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.search import contact_search


def in_space(block):
    return mr.Compound.prism(block) if isinstance(block, mr.Compound) else mr.Polyhedron.prism(block)


def flying(turn, speed, k_n=1e10):
    """A block in free flight towards the notch of a U that lies on its side, open to the left, from the drawing."""
    u = mr.Compound([box(0, 2, 0, 0.5), box(0, 2, 1.5, 2), box(1.5, 2, 0.5, 1.5)], name="U")
    blocks = [GROUND, u, box(-0.6, -0.3, 1.1, 1.4, name="thrown")]
    masonry = mr.Masonry([turn(block) for block in blocks], k_n=k_n, friction=0.5, xi=0.2, frequency=60.0)
    velocity = np.zeros((2, 6 if masonry.in_space else 3))
    velocity[1, 0] = speed
    return mr.MasonryCase(masonry, 0.4, velocity=velocity, settled=False)


@pytest.mark.parametrize("turn", [lambda block: block, in_space])
def test_a_block_flies_into_a_notch_and_feels_nothing_there(turn):
    case = flying(turn, 6.0)
    run = mr.solve_explicit(case, output_step=1e-3)
    inside = run.t < 0.299  # its front reaches the end of the notch after 1.8 m
    assert run.pose[inside, 1, 0].max() > 1.78
    np.testing.assert_allclose(run.velocity[inside, 1, 0], 6.0, atol=1e-9)
    up = 2 if turn is in_space else 1
    np.testing.assert_allclose(run.velocity[inside, 1, up], -mr.GRAVITY * run.t[inside], atol=1e-3)
    assert run.velocity[-1, 1, 0] < 0  # it came back from the end
    assert run.stats["overlap"] < 0.01


def test_plane_and_space_meet_alike():
    """After they meet, convex blocks differ by 4e-5 m too: the friction of points and of lines is not the same."""
    runs = [
        mr.solve_explicit(flying(turn, 3.0, k_n=1e9), timestep=2e-5, output_step=1e-3)
        for turn in (lambda b: b, in_space)
    ]
    np.testing.assert_allclose(runs[1].pose[:, :, [0, 2]], runs[0].pose[:, :, :2], atol=1e-4)


def test_a_block_slides_over_a_cut_as_over_a_whole_block():
    poses = []
    whole = box(-2, 2, 0, 0.5, fixed=True, name="table")
    cut = mr.Compound([box(-2, 0.13, 0, 0.5), box(0.13, 2, 0, 0.5)], fixed=True, name="table")
    for table in (whole, cut):
        masonry = mr.Masonry([table, box(-1.0, -0.6, 0.5, 0.7, name="slides")], k_n=1e9, friction=0.3, frequency=100.0)
        run = mr.solve_explicit(mr.MasonryCase(masonry, 0.8, velocity=[(2.5, 0, 0)]), timestep=4e-5, output_step=0.01)
        poses.append(run.pose)
        assert run.pose[-1, 0, 0] > 0.9
    np.testing.assert_allclose(poses[1][:, 0, 0], poses[0][:, 0, 0], atol=1e-3)
    assert np.abs(poses[1][:, 0, 2]).max() < 1e-3


def drawn_at(masonry):
    """Where the finder of a masonry finds its blocks as they are drawn, in the order of the places."""
    from mjrock.distinct.setup import setup_of

    met = setup_of(mr.MasonryCase(masonry, 0.1, settled=False), None, None).search
    every = np.ones(met.count, dtype=bool)
    found = met.finder.places_near(met.limits.start, np.full(met.count, 1e-3), every, np.zeros(0, dtype=np.int64))
    columns = np.column_stack([found.place, found.normal, found.gap, found.share, found.area])
    return columns[np.lexsort(np.round(columns, 9).T[::-1])]


@pytest.mark.parametrize("turn", [lambda block: block, in_space])
@pytest.mark.parametrize("points", [2, 3, 5])
@pytest.mark.parametrize("cuts", [(0.13,), (-0.7, 0.13, 0.4)])
def test_places_are_those_of_a_block_that_is_not_cut(turn, points, cuts):
    """Under a block that lies over the cuts and beside both ends of one, whose bottom is cut elsewhere."""
    ends = [-2.0, *cuts, 2.0]
    cut = [box(a, b, 0, 0.5) for a, b in pairwise(ends)]
    upper = [box(-0.9, -0.2, 0.5, 0.9), box(-0.2, 0.8, 0.5, 0.9)]
    pairs = (
        [mr.Compound(cut, fixed=True, name="table"), mr.Compound(upper, name="block")],
        [box(-2, 2, 0, 0.5, fixed=True, name="table"), box(-0.9, 0.8, 0.5, 0.9, name="block")],
    )
    made = [mr.Masonry([turn(block) for block in blocks], k_n=1e9, points=points) for blocks in pairs]
    ours, whole = (drawn_at(masonry) for masonry in made)
    np.testing.assert_allclose(ours, whole, rtol=0, atol=1e-12)


@pytest.mark.parametrize("turn", [lambda block: block, in_space])
@pytest.mark.parametrize("points", [2, 3, 4])
def test_a_joint_of_an_l_that_is_handed_over_keeps_force_moment_and_energy(turn, points, monkeypatch):
    """It slides, and its parts press more at one end. Its joint has no line at the cut of its bottom."""
    unit, seen = mr.Compound([box(0, 0.2, 0, 0.8), box(0.2, 0.9, 0, 0.2)], name="L"), []
    hand_over = contact_search.hand_over

    def watched(new, found, gone, *rest):
        hand_over(new, found, gone, *rest)
        for lines in (gone, new):
            force = lines.rows["k"] * lines.depth
            seen.append((force.sum(), force @ lines.at[:, 0], 0.5 * force @ lines.depth))

    monkeypatch.setattr(contact_search, "hand_over", watched)
    masonry = mr.Masonry([turn(GROUND), turn(unit)], k_n=1e7, k_s=5e6, friction=0.1, xi=0.05, points=points)
    velocity = np.zeros((1, 6 if masonry.in_space else 3))
    velocity[0, 0] = 1.0
    mr.solve_explicit(mr.MasonryCase(masonry, 0.08, velocity=velocity), output_step=0.01)
    before, after = seen[:2]
    assert before[0] == pytest.approx(unit.mass * mr.GRAVITY, rel=0.1)
    np.testing.assert_allclose(after, before, rtol=1e-9)


def test_a_block_that_falls_into_an_l_rests_in_its_corner():
    unit = mr.Compound([box(0, 0.5, 0, 1.5), box(0.5, 1.5, 0, 0.5)], name="L")
    blocks = [GROUND, unit, box(0.6, 1.0, 0.5, 0.8, name="in")]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.2, xi=0.3, frequency=60.0)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.0, velocity=[(0, 0, 0), (-1.5, 0, 0)]))
    assert run.pose[-1, 1, 0] - run.pose[-1, 0, 0] == pytest.approx(-0.1, abs=2e-3)
    assert abs(run.pose[-1, 1, 1]) < 2e-3
    assert run.stats["overlap"] < 0.01


def test_overlap_counts_every_part():
    from mjrock.distinct.setup import setup_of

    u = mr.Compound([box(0, 1, 0, 2), box(2, 3, 0, 2), box(0, 3, 2, 3)], name="U")
    masonry = mr.Masonry([GROUND, u, box(4, 5, 0, 1, name="beside")], k_n=1e8)
    encounters = setup_of(mr.MasonryCase(masonry, 0.1, settled=False), None, None).search
    finder = encounters.finder
    assert finder.volumes[1] == pytest.approx(7 * 2 * finder._half)
    assert [list(finder.parts_of(i)) for i in range(3)] == [[0], [1, 2, 3], [4]]
