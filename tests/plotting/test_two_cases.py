"""Two cases in one picture, pairs of impacts, and frames that are drawn fast."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import animation
from mjrock.plotting.bodies import Bodies
from mjrock.plotting.solids import Rendering
from mjrock.plotting.wall import tie_texts
from mjrock.result.bodies import bodies_of
from mjrock.result.compare import of_impacts, paired
from mjrock.result.rocking import Impact

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
E = mr.Restitution.from_geometry(WALL)
MOTION = mr.GroundMotion.synthetic(4.0, 3.0, seed=2)
SLAB = [(-1.0, -0.2), (1.0, -0.2), (1.0, 0.0), (-1.0, 0.0)]
TALL = [(-0.2, 0.0), (0.2, 0.0), (0.2, 1.0), (-0.2, 1.0)]
TIE = mr.Tie(height=4.0, stiffness=2e6, slack=1e-3, strength=3e3, ultimate=0.002)


def theory(motion=MOTION, effects=()):
    return mr.solve_analytical(mr.Case(WALL, 0.0, 3.5, motion=motion, effects=effects), E)


def test_a_wall_with_and_without_a_tie():
    """Their own colours and names, and a panel with the force of the tie."""
    both = [theory(effects=TIE), theory()]
    figure = plotting.history(both, labels=["tied", "bare"])
    _, rotation, ties = figure.axes
    assert len({line.get_color() for line in rotation.get_lines()[:2]}) == 2
    assert [line.get_label() for line in rotation.get_lines()[:2]] == ["tied", "bare"]
    assert ties.get_lines()[0].get_ydata().max() == pytest.approx(3.0)
    assert ties.get_legend_handles_labels()[1] == [
        f"tied, tie: drawn out by 2 mm, broke at {both[0].plastic['tie_0'].broken:.3g} s"
    ]
    unnamed = plotting.history(both).axes[1].get_legend_handles_labels()[1]
    assert unnamed == ["analytical 1", "analytical 2"]


def test_masonry_has_a_panel_with_the_force_of_its_ties():
    masonry = mr.Masonry([mr.Polygon(SLAB, fixed=True), mr.Polygon(TALL)], k_n=1e9)
    effects = mr.Tie(height=0.8, stiffness=1e6, slack=0.0, strength=3e3, block=1)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.05, velocity=[(0.3, 0.0, 0.0)], effects=effects))
    ties = plotting.history(answer).axes[-1]
    np.testing.assert_allclose(ties.get_lines()[0].get_ydata(), answer.ties["tie_0"].force / 1e3)
    assert ties.get_legend_handles_labels()[1] == [f"tie: drawn out by {1e3 * answer.ties['tie_0'].plastic[-1]:.3g} mm"]


@pytest.mark.parametrize("in_space", [False, True])
def test_blocks_with_an_added_mass_turn_about_their_common_centroid(in_space):
    """As in a film: the pose is that of the centroid of the block and its mass."""
    blocks = [mr.Polygon(corners, fixed=fixed) for corners, fixed in ((SLAB, True), (TALL, False))]
    at = {"at": (0.2, 0.0, 0.9)} if in_space else {"height": 0.9, "offset": 0.2}
    heavy = mr.AddedMass(mass=2000.0, block=1, **at)
    masonry = mr.Masonry([mr.Polyhedron.prism(one) for one in blocks] if in_space else blocks, k_n=1e9)
    case = mr.MasonryCase(masonry, 0.2, velocity=[np.eye(6)[0]] if in_space else [(1.0, 0.0, 0.0)], effects=heavy)
    answer = mr.solve_explicit(case)
    assert answer.peak[0] > 0.02
    (block,) = (body for body in bodies_of(answer.moving, answer.velocity) if not body.fixed)
    expected, ax = block.placed(block.corners)[-1], plotting.blocks(answer)
    if in_space:
        (drawn,) = (
            child.bodies.corners(0).reshape(-1, 3) for child in ax.get_children() if isinstance(child, Rendering)
        )
    else:
        expected, drawn = expected[:, [0, 2]], ax.collections[0].get_paths()[0].vertices
    assert np.linalg.norm(drawn[:, None] - expected, axis=2).min(axis=1).max() < 1e-12


@pytest.mark.parametrize(
    ("labels", "complaint"),
    [(["one"], "labels has 1 texts for 2 responses"), ("ab", "labels = 'ab'"), ([1, 2], r"labels\[0\] = 1")],
)
def test_labels_that_cannot_be(labels, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        plotting.history([theory(), theory()], labels=labels)


def test_two_ground_motions_are_no_picture():
    with pytest.raises(ValueError, match=r"responses\[1\] is that to another ground motion"):
        plotting.history([theory(), theory(MOTION.scaled(2.0))])


def test_two_polarities_are_one_picture():
    figure = plotting.history([theory(), theory(MOTION.reversed())])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["analytical", "analytical, reversed"]


def test_peaks_of_walls_that_stand_are_not_cut():
    ax = plotting.incremental(Figure().subplots(), [1.0, 2.0], [[0.5, 1.9], [0.3, np.inf]], "analytical")
    highest = [line.get_ydata().max() for line in ax.get_lines()[:2]]
    assert highest == pytest.approx([1.9, 1.15 * 1.9])
    assert ax.get_ylim()[1] > 1.15 * 1.9
    assert plotting.incremental(Figure().subplots(), [1.0], [[0.5]], "MuJoCo").get_ylim()[1] == pytest.approx(1.236)


def impacts(*times, energy=10.0):
    return [Impact(t, -1.0, 1.0, energy, 1.0) for t in times]


def test_impacts_are_paired_by_time():
    left = [*impacts(1.0, 1.5), *impacts(1.6, energy=0.1), *impacts(3.0)]
    pairs = paired(left, impacts(1.45, 2.0, 3.05), 0.1, 1.0)
    assert pairs.tolist() == [[0, -1], [1, 0], [-1, 1], [3, 2]]
    np.testing.assert_array_equal(
        of_impacts(pairs, [1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0]), [[1, np.nan], [2, 5], [np.nan, 6], [4, 7]]
    )
    assert paired([], impacts(1.0), 0.1, 1.0).tolist() == [[-1, 0]]
    assert paired([], [], 0.1, 1.0).shape == (0, 2)


def test_an_earthquake_is_compared_impact_by_impact():
    contacts = mr.Contacts.from_law(WALL, E, 3e9, 3e9)
    motion = mr.GroundMotion.synthetic(4.0, 3.0, seed=2)
    case = mr.Case(WALL, 0.0, 3.5, motion=motion)
    comparison = mr.compare(mr.solve_analytical(case, E), mr.simulate(case, contacts))
    apart = np.diff(comparison.impact_times, axis=1)
    assert np.isfinite(apart).any()
    assert np.nanmax(np.abs(apart)) <= 0.25 / WALL.p
    assert np.nanmin(comparison.rebound_peaks) > 0
    assert "paired by time" in comparison.table()


def test_ties_at_one_place_have_one_text():
    ties = [mr.Tie(8.0, 1e6, length=8.0), mr.Tie(8.1, 1e6, length=8.0), mr.Tie(3.0, 1e6, length=1.0)]
    assert tie_texts(ties, -4.0, 9.0) == ["2 x anchor 8 m behind", "", ""]
    assert tie_texts([ties[2]] * 3, -4.0, 9.0) == ["3 x tie", "", ""]


def test_a_frame_drawn_fast_is_the_frame(tmp_path):
    """What stands and what moves on top of it are the figure as matplotlib draws it."""
    response = theory(effects=TIE)
    bodies = Bodies.of(response).at(response.t[[0, 2500]])
    drawn = [lambda ax: plotting.rotation(ax, [response])]
    figure, update = animation.scene(bodies, drawn, response.case)
    stage = animation.Stage(figure, 50)
    stage.keep_colours(update, 2)
    update(1)
    fast = np.asarray(stage.picture().convert("RGB"), dtype=float)
    figure.savefig(tmp_path / "slow.png", dpi=50)
    slow = np.asarray(Image.open(tmp_path / "slow.png").convert("RGB"), dtype=float)
    assert fast.shape == slow.shape
    assert np.abs(fast - slow).mean() < 3.0  # 128 colours


def test_ties_of_masonry_are_drawn(tmp_path):
    column = mr.Masonry.stack([WALL], 5e8)
    tie = mr.Tie(4.0, 2e6, length=3.0, block=column.free[0])
    answer = mr.simulate(mr.MasonryCase(column, 0.1, effects=tie))
    figure, _ = animation.scene(Bodies.of(answer).at(answer.t[:2]), [], answer.case)
    assert "tie" in [text.get_text() for text in figure.axes[0].texts]
    assert plotting.animate(answer, tmp_path / "tied.gif", dpi=20, fps=20).exists()
