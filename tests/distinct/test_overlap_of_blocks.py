"""The volume that two blocks have in common: against closed forms, and however thin it is."""

import numpy as np
import pytest
from masonry_blocks import box
from scipy.spatial.transform import Rotation

import mjrock as mr
from mjrock.distinct.search.overlap import common_volume, overlap_remedy
from mjrock.distinct.search.solids import Solids


def solids_about(blocks, centroids):
    """Convex blocks as the finder has them."""
    outer = [np.zeros(len(block.faces), dtype=bool) for block in blocks]
    return Solids.about(blocks, centroids, outer, np.arange(len(blocks)))


def common(first, second, place=(0.0, 0.0, 0.0), turn=None):
    """Of a block and another at a place, both turned together."""
    about = [np.mean(block.corners, axis=0) for block in (first, second)]
    solids = solids_about([first, second], np.array(about))
    change = np.zeros((2, 3, 3)) if turn is None else np.array([turn.as_matrix() - np.eye(3)] * 2)
    apart = np.array([[0.0, 0.0, 0.0], place])
    return common_volume(solids.moved(apart if turn is None else turn.apply(apart), change), 0, 1)


BOX = mr.Polyhedron.box((0.4, 0.2, 0.2))
TURNS = [None, *Rotation.random(20, random_state=np.random.default_rng(1))]


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("deep", [1e-1, 1e-3, 2e-5, 1e-7, 1e-9])
def test_boxes_that_lie_inside_each_other_by_a_little(deep, turn):
    """Side by side, overlapping by a depth along x; and at a corner, by a depth along each axis."""
    volume = common(BOX, BOX, (0.4 - deep, 0.05, 0.0), turn)
    assert volume == pytest.approx(deep * 0.15 * 0.2, rel=1e-6, abs=1e-16)
    at_corner = common(BOX, BOX, (0.4 - deep, 0.2 - deep, 0.2 - deep), turn)
    assert at_corner == pytest.approx(deep**3, rel=1e-5, abs=1e-17)


@pytest.mark.parametrize("turn", TURNS)
def test_faces_that_lie_in_one_plane_count_once(turn):
    assert common(BOX, BOX, turn=turn) == pytest.approx(BOX.volume)
    assert common(BOX, BOX, (0.1, 0.0, 0.0), turn) == pytest.approx(0.3 * 0.2 * 0.2)
    assert common(BOX, mr.Polyhedron.box((0.2, 0.2, 0.1)), turn=turn) == pytest.approx(0.2 * 0.2 * 0.1)


@pytest.mark.parametrize("size", [0.01, 1.0, 50.0])
@pytest.mark.parametrize("by", [(0.0, 0.0, 0.0), (1e3, 0.0, 0.0), (9.1e3, -7.7e3, 5e3)])
def test_faces_that_lie_in_one_plane_count_once_wherever_the_blocks_are(size, by):
    """Coordinates round with their size: those of 9 km by 2e-12 m."""
    block = mr.Polyhedron.box((0.4 * size, 0.2 * size, 0.2 * size))
    solids = solids_about([block, block], np.zeros((2, 3)))
    for turn in TURNS[1:]:
        place = np.array(by) + turn.apply([[0.0, 0.0, 0.0], [0.1 * size, 0.0, 0.0]])
        found = common_volume(solids.moved(place, np.array([turn.as_matrix() - np.eye(3)] * 2)), 0, 1)
        assert found == pytest.approx(0.3 * 0.2 * 0.2 * size**3, rel=1e-6 + 1e-10 / size)


@pytest.mark.parametrize("turn", TURNS)
def test_blocks_that_only_touch_or_stand_apart_have_nothing_in_common(turn):
    for place in ((0.4, 0.0, 0.0), (0.4, 0.2, 0.2), (0.4 + 1e-9, 0.0, 0.0), (1.0, 1.0, 1.0)):
        assert common(BOX, BOX, place, turn) == pytest.approx(0.0, abs=1e-15)


def test_slightly_turned_blocks_that_overlap_by_some_hundredths_of_a_millimetre():
    """Half of a wedge: one end of the upper block lies 0.1 mm inside the lower one."""
    angle = 1e-4 / 0.4
    tilted = mr.Polyhedron([(x, y, z + angle * (x - 0.2)) for x, y, z in BOX.corners])
    lower = mr.Polyhedron(BOX.corners - (0.0, 0.0, 0.2))
    solids = solids_about([lower, tilted], np.zeros((2, 3)))
    assert common_volume(solids, 0, 1) == pytest.approx(0.5 * 0.4 * 1e-4 * 0.2, rel=1e-3)


def test_blocks_are_held_against_a_support_where_it_is():
    """Of two supports one sinks by 5 m at once. What stood on it falls into the air, and overlaps nothing."""
    still, sinks = box(-2, 0, -1, 0, fixed=True, name="still"), box(1, 3, -1, 0, fixed=True, name="sinks")
    masonry = mr.Masonry((still, sinks, box(1.5, 2, 0, 1), box(-1, -0.5, 0, 1)), k_n=1e8, xi=0.3)
    supports = {"still": ([0.0, 1.0], [0.0] * 2, [0.0] * 2), "sinks": ([0.0, 0.01], [0.0] * 2, [0.0, -5.0])}
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.25, supports=supports), output_step=0.01)
    assert answer.pose[-1, 0, 1] < -0.25
    assert answer.stats["overlap"] < 1e-3


@pytest.mark.parametrize(
    ("share", "left", "complaint"),
    [
        (0.03, 1.0, "joints 9 times as stiff keep blocks apart"),
        (0.03, 0.5, "this step leaves their contact 50% of its stiffness; timestep = 1e-05 s and joints 4.5 times as "),
        (0.03, 0.1, "this step leaves their contact 10% of its stiffness; timestep = 1e-05 s keeps blocks apart"),
    ],
)
def test_what_keeps_blocks_apart_names_the_step_where_that_is_the_cause(share, left, complaint):
    """The overlap of a block that is stopped falls as the root of the stiffness, and is to fall to 1 %."""
    assert overlap_remedy(share, left, 1e-5).startswith(complaint)


def lands(**options):
    """A light box that is thrown onto a heavy one, neither of which has a joint."""
    solid = mr.Polyhedron.box
    blocks = [
        solid((9.0, 1.0, 1.0), (0.0, 0.0, -0.5), fixed=True, name="ground"),
        solid((0.2, 0.2, 0.2), (3.0, 0.0, 0.1)),
        solid((1.0, 1.0, 1.0), (0.0, 0.0, 0.5 + 1e-3), name="heavy"),
        solid((0.05, 0.05, 0.05), (0.1, 0.0, 1.05), name="light"),
    ]
    masonry = mr.Masonry(blocks, k_n=options.pop("k_n", 1e10), friction=0.5, xi=0.0)
    velocity = [[0.0] * 6, [0.0] * 6, [0.0, 0.0, -3.0, 0.0, 0.0, 0.0]]
    return mr.solve_explicit(mr.MasonryCase(masonry, 0.03, velocity=velocity, settled=False), **options)


def test_a_light_block_that_sinks_into_another_is_told_by_the_step_or_the_joints():
    """With the default step it keeps its stiffness, and with what each warning names the overlap is below 1 %."""
    free = lands(output_step=2e-4)
    assert free.stats["overlap"] < 0.01
    with pytest.warns(UserWarning, match=r"heavy and light lie .*: this step leaves their contact") as caught:
        coarse = lands(timestep=0.8 * free.stats["stable_timestep"], output_step=4e-4)
    named = float(str(caught[0].message).split("timestep = ")[1].split(" s")[0])
    assert free.stats["timestep"] < named < coarse.stats["timestep"]
    assert coarse.stats["overlap"] > 0.01 > lands(timestep=named, output_step=2e-4).stats["overlap"]
    with pytest.warns(
        UserWarning, match=r"heavy and light .* s: joints [\d.]+ times as stiff keep blocks apart"
    ) as caught:
        soft = lands(k_n=5e8, output_step=2e-4)
    stiffer = float(str(caught[0].message).split("joints ")[1].split(" times")[0])
    assert soft.stats["overlap"] > 0.01 > lands(k_n=1.02 * stiffer * 5e8, output_step=2e-4).stats["overlap"]
