"""Pictures of forces: rendered, and looked at where statics says that a line passes, and beside it."""

import io
from dataclasses import replace

import numpy as np
import pytest
from masonry_blocks import GROUND, box
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.proj3d import proj_transform
from PIL import Image

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import animation
from mjrock.plotting.bodies import FORCE, Bodies
from mjrock.plotting.solids import Solids

OFF = np.array([0.0, 0.1, 0.25])
"""Offsets of three blocks of 1 x 0.5 m, one on the other [m]."""
PLACES = np.column_stack([[OFF.mean(), OFF[1:].mean(), OFF[2]], [0.0, 0.5, 1.0]])
"""Where the weight of all that is above passes through each joint [m]."""
ENDS = np.array([[OFF[2], 1.25], [OFF.mean(), 0.0]])
"""Where the line of thrust begins, and where it ends [m]."""
BESIDE = np.array([0.12, 0.0])


def corbelled(in_space=False, **options):
    """The blocks at rest."""
    blocks = [GROUND, *(box(x - 0.5, x + 0.5, 0.5 * i, 0.5 * (i + 1)) for i, x in enumerate(OFF))]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    masonry = mr.Masonry(blocks, k_n=1e11, friction=0.7, xi=0.05)
    return mr.solve_explicit(mr.MasonryCase(masonry, 1e-3), forces=True, **options)


def coloured(figure, ax, places):
    """Whether the picture has the colour of forces at places [m] of an Axes of the plane or of space."""
    file = io.BytesIO()
    figure.savefig(file, dpi=200, format="png")
    pixels = np.asarray(Image.open(file).convert("RGB"))
    places = np.asarray(places)
    if places.shape[1] == 3:
        places = np.column_stack(proj_transform(*places.T, ax.M)[:2])
    columns, rows = (ax.transData.transform(places) / figure.dpi * 200).T
    centres = np.round([columns, len(pixels) - rows]).astype(int).T
    apart = [np.abs(pixels[y - 3 : y + 3, x - 2 : x + 3] - 255 * np.array(to_rgb(FORCE))) for x, y in centres]
    return [bool((near.max(axis=-1) < 40).any()) for near in apart]


def along(start, end, count=9):
    return start + np.linspace(0.1, 0.9, count)[:, None] * (end - start)


def test_a_line_of_thrust_passes_where_the_weight_does():
    figure = Figure(figsize=(4, 4))
    ax = plotting.thrust(figure.subplots(), corbelled(), at=0.0, limits=[(-1, 1.5), (-0.5, 2)])
    assert all(coloured(figure, ax, PLACES))
    assert all(coloured(figure, ax, along(PLACES[0], PLACES[1])))
    assert all(coloured(figure, ax, along(PLACES[2], ENDS[0])))
    assert not any(coloured(figure, ax, [*(PLACES + BESIDE), *(PLACES - BESIDE), ENDS[0] + [0, 0.1], [0, -0.1]]))
    (named,) = ax.get_legend().get_texts()
    assert named.get_text().endswith(" kN")
    assert ax.get_legend().get_lines()[0].get_linewidth() == max(ax.collections[-1].get_linewidths())


def test_a_line_of_thrust_is_as_wide_as_its_force():
    ax = plotting.thrust(Figure().subplots(), corbelled(), at=0.0)
    (strokes,) = (line for line in ax.collections if hasattr(line, "ends"))
    widths = {
        round(float(ends[0, 1]), 3): width for ends, width in zip(strokes.ends, strokes.get_linewidths(), strict=True)
    }
    assert [widths[z] / widths[0.0] for z in (0.5, 1.0)] == pytest.approx([2 / 3, 1 / 3], rel=1e-3)


def test_bars_are_along_the_force_and_as_long():
    figure = Figure(figsize=(4, 4))
    ax = plotting.blocks(figure.subplots(), corbelled(), forces="bars", limits=[(-1, 1.5), (-0.5, 2)])
    longest = 0.12 * 1.25
    for place, share in zip(PLACES, (1, 2 / 3, 1 / 3), strict=True):
        half = np.array([0.0, 0.5 * share * longest])
        assert all(coloured(figure, ax, [place, place + 0.8 * half, place - 0.8 * half]))
        assert not any(coloured(figure, ax, [place + half + [0, 0.05], place - half - [0, 0.05], place + BESIDE]))


@pytest.mark.slow
@pytest.mark.parametrize("in_space", [False, True])
def test_a_film_shows_the_line_where_blocks_have_gone(in_space):
    """Magnified, the picture has the line where it has the blocks."""
    run = corbelled(in_space)
    moved = run.pose.copy()
    moved[-1, :, 0] += 0.01
    of = (Solids if in_space else Bodies).of(run, 50.0, limits=[(-1, 2), *[(-1, 1)] * in_space, (-0.5, 2)])
    of = replace(of, moving=replace(of.moving, t=run.t[[0, -1]], pose=moved[[0, -1]]))
    figure, update = animation.scene(of, [], run.case, response=run, forces="thrust")
    ax = figure.axes[0]
    places = np.insert(PLACES, 1, 0.0, axis=1) if in_space else PLACES
    for frame, shift in ((0, 0.0), (1, 0.5)):
        update(frame)
        for artist in ax.get_children():
            artist.set_animated(False)
        away = np.eye(len(places[0]))[0]
        assert coloured(figure, ax, places[1:] + shift * away) == [True, True]
        assert coloured(figure, ax, places[1:] + (0.5 - shift) * away) == [False, False]


def test_the_thrust_of_a_wall():
    """A wall that leans on its outer toe has its thrust from its centroid to there."""
    wall = mr.Block.from_size(thickness=0.8, height=6.0, length=6.0, density=1600.0)
    contacts = mr.Contacts.from_law(wall, mr.Restitution(base=0.97, side=-0.5), k_base=5e8, k_side=5e8)
    run = mr.simulate(mr.Case(wall, 0.02, 0.2, side_stop=True), contacts, forces=True)
    figure = Figure(figsize=(4, 6))
    ax = plotting.thrust(figure.subplots(), run, at=0.0)
    centroid = np.array([0.4 + np.hypot(0.4, 3) * np.sin(0.02 - np.arctan(0.4 / 3)), 3.0])
    assert all(coloured(figure, ax, along(np.array([0.4, 0.0]), centroid)))
    assert not any(coloured(figure, ax, along(np.array([0.6, 0.5]), centroid + np.array([0.3, 1.0]))))


def test_a_film_is_written_with_forces(tmp_path):
    run = corbelled()
    assert plotting.animate(run, tmp_path / "a.gif", forces="bars", speed=1e-3, fps=2, dpi=40).exists()


@pytest.mark.parametrize("in_space", [False, True])
def test_cracks_are_where_joints_have_lost_their_bond(in_space):
    """A block that is pulled off loses its joint, which is drawn where it was; the joint above it holds."""
    blocks = [GROUND, box(-0.5, 0.5, 0.0, 0.5), box(-0.5, 0.5, 0.5, 1.0), box(-0.5, 0.5, 1.0, 1.5, fixed=True)]
    bonds = {"weak": mr.Bond(1e4, 1e4, 1.0, 10.0), "strong": mr.Bond(1e6, 1e6, 1e3, 1e4)}
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    masonry = mr.Masonry(
        blocks,
        k_n=1e10,
        k_s=1e10,
        xi=0.05,
        points=3,
        bond=lambda joint: bonds["weak" if joint.middle[-1] < 0.1 else "strong"],
    )
    up = ((0.0, 0.01, 0.02), *[(0.0, 0.0, 0.0)] * (2 if in_space else 1), (0.0, 0.001, 0.001))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.02, supports={masonry.names[3]: up}, settled=False), forces=True)
    assert run.forces.damage[-1] == pytest.approx(
        [1.0, 0.0, 0.0], abs=np.exp(-9)
    )  # what is left of a bond that has gone
    ax = Figure().add_subplot(projection="3d" if in_space else None)
    (strokes,) = (line for line in plotting.blocks(ax, run, forces="cracks").collections if hasattr(line, "ends"))
    assert strokes.ends[..., -1] == pytest.approx(0.0)
    assert np.ptp(strokes.ends[..., 0]) == pytest.approx(1.0)
    assert list(strokes.get_linewidths()) == pytest.approx([4.0] * len(strokes.ends), rel=1e-3)
    (named,) = ax.get_legend().get_texts()
    assert named.get_text() == f"cracked, {1e3 * run.crack_widths[-1, 0]:.2g} mm open"


def test_a_crack_is_as_wide_as_its_block_has_been_lifted():
    """The block above the joint that is lost moves with its support; columns of the table say so too."""
    masonry = mr.Masonry(
        [GROUND, box(-0.5, 0.5, 0.0, 0.5), box(-0.5, 0.5, 0.5, 1.0, fixed=True)],
        k_n=1e10, k_s=1e10, xi=0.05, points=3,
        bond=lambda joint: mr.Bond(1e4, 1e4, 1.0, 10.0) if joint.middle[-1] < 0.1 else mr.Bond(1e6, 1e6, 1e3, 1e4),
    )  # fmt: skip
    up = ((0.0, 0.01, 0.04), (0.0, 0.0, 0.0), (0.0, 0.001, 0.001))
    case = mr.MasonryCase(masonry, 0.04, supports={masonry.names[-1]: up}, settled=False)
    run = mr.solve_explicit(case, forces=True)
    first, second = run.forces.joints
    assert run.crack_widths[-1] == pytest.approx([0.001, 0.0], abs=2e-6)
    assert (run.crack_widths.max(axis=0) <= run.opening + 1e-12).all()  # between samples joints open farther
    table = [line for line in run.csv().splitlines() if not line.startswith("#")]
    row = dict(zip(table[0].split(","), map(float, table[-1].split(",")), strict=True))
    assert row[f"crack width of {first} [m]"] == run.crack_widths[-1, 0]
    assert row[f"damage of {second} [-]"] == run.forces.damage[-1, 1]


def test_what_cannot_be_drawn():
    ax, run = Figure().subplots(), corbelled()
    without = mr.solve_explicit(run.case)
    for draw in (
        lambda: plotting.thrust(ax, without),
        lambda: plotting.blocks(ax, without, forces="bars"),
        lambda: plotting.animate(without, "film.gif", forces="bars"),
    ):
        with pytest.raises(AttributeError, match="pass forces=True"):
            draw()
    with pytest.raises(ValueError, match=r"forces = 'arrows' is not one of thrust, bars"):
        plotting.blocks(ax, run, forces="arrows")
    with pytest.raises(ValueError, match="forces = 'cracks' needs joints with a bond, and all joints are dry"):
        plotting.blocks(ax, run, forces="cracks")
    with pytest.raises(ValueError, match=r"at = 1 s is outside the valid range 0 to 0.001 s"):
        plotting.thrust(ax, run, at=1.0)
    with pytest.raises(ValueError, match="at and forces are for a response"):
        plotting.blocks(ax, run.case.masonry, forces="bars")
