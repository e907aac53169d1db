"""Fill over masonry: its weight by integration, the spread of a load and passive pressure by hand, a load test."""

import numpy as np
import pytest
from masonry_blocks import GROUND, box

import mjrock as mr

G = mr.GRAVITY
ARCH = mr.Masonry.arch(5.0, 0.5, span_angle=1.9, voussoirs=25, friction=0.6)


def test_the_weight_is_that_of_the_earth_up_to_the_ground():
    """Area and first moment between the straight outer edges of voussoirs and the ground, by thin columns."""
    fill = mr.Fill(top=5.8, density=1900.0)
    loads = fill.on(ARCH)
    joints = 5.25 * np.array([(np.sin(turn), np.cos(turn)) for turn in np.linspace(-0.95, 0.95, 26)])
    x = np.linspace(joints[0, 0], joints[-1, 0], 200001)
    depth = 5.8 - np.interp(x, *joints.T)
    force, at = np.array([load.force for load in loads]), np.array([load.at[0] for load in loads])
    assert force.sum() == pytest.approx(1900 * G * np.trapezoid(depth, x), rel=1e-7)
    inside = x > joints[13, 0]
    assert force[at > joints[13, 0]] @ at[at > joints[13, 0]] == pytest.approx(
        1900 * G * np.trapezoid((depth * x)[inside], x[inside]), rel=1e-4
    )


def test_earth_rests_on_what_no_block_covers_of_a_face():
    """A beam of 3 m with a block of 1 m on its middle: earth of 1 m beside the block, and of 0.4 m on it."""
    blocks = [box(0, 3, 0, 0.5, name="beam"), box(1, 2, 0.5, 1.1, name="block")]
    masonry = mr.Masonry([box(-2, 5, -1, 0, name="ground", fixed=True), *blocks])
    loads = mr.Fill(top=1.5, density=1800.0).on(masonry)
    assert [load.block for load in loads] == ["beam", "block", "beam"]
    assert [load.at for load in loads] == [pytest.approx(at) for at in ((0.5, 0.5), (1.5, 1.1), (2.5, 0.5))]
    assert [load.force for load in loads] == pytest.approx([1800 * G * depth for depth in (1.0, 0.4, 1.0)])


def test_a_face_below_a_block_bears_no_earth():
    """A lintel that stands out over the step of the block below it: between them there is air."""
    step = mr.Compound([box(0, 1, 0, 2), box(1, 2, 0, 1)], name="step")
    masonry = mr.Masonry([box(-2, 5, -1, 0, name="ground", fixed=True), step, box(0, 1.5, 2, 2.4, name="lintel")])
    with pytest.raises(ValueError, match="free faces of lintel and step that look upwards one above the other"):
        mr.Fill(top=3.0).on(masonry)


@pytest.mark.parametrize("at", [0.5, 1.2, 1.5, 1.8])
def test_faces_beside_a_gap_bear_the_whole_load(at):
    """Two blocks 1 m apart, 1 m below the ground, under a load that spreads over the gap between them."""
    blocks = [box(0, 1, 0, 2, name="left"), box(2, 3, 0, 2, name="right")]
    masonry = mr.Masonry([box(-2, 5, -1, 0, name="ground", fixed=True), *blocks])
    borne = {load.block: load.force for load in mr.Fill(top=3.0, spread=0.8).under(masonry, 50e3, at)}
    assert sum(borne.values()) == pytest.approx(50e3)
    low, high = max(at - 0.8, 0.0), min(at + 0.8, 3.0)
    widths = {"left": max(min(high, 1.0) - low, 0.0), "right": max(high - max(low, 2.0), 0.0)}
    for name, width in widths.items():
        assert borne.get(name, 0.0) == pytest.approx(50e3 * width / sum(widths.values()), abs=1e-3)
    for narrow in (0.0, 0.5):  # the second reaches the ends of the blocks and no more
        with pytest.raises(ValueError, match=r"at = 1.5 m lies above a gap between the faces"):
            mr.Fill(top=3.0, spread=narrow).under(masonry, 50e3, 1.5)
        with pytest.raises(ValueError, match=r"at = 1.5 m lies above a gap between the faces"):  # an axle of a train
            mr.Fill(top=3.0, spread=narrow).under(masonry, 50e3, [0.5, 1.5])


def test_a_load_spreads_two_to_one():
    """On three level blocks of 1 m, 0.6 m below the ground, a load 0.2 m wide is 0.2 + 2 x 0.5 x 0.6 m wide."""
    blocks = [box(i, i + 1, 0, 0.4, name=f"b{i}") for i in range(3)]
    masonry = mr.Masonry([box(-1, 4, -1, 0, fixed=True, name="ground"), *blocks], friction=0.7)
    fill = mr.Fill(top=1.0)
    loads = fill.under(masonry, force=8e3, at=1.0, width=0.2)
    assert [(load.block, load.force, *load.at) for load in loads] == [
        ("b0", pytest.approx(4e3), pytest.approx(0.8), 0.4),
        ("b1", pytest.approx(4e3), pytest.approx(1.2), 0.4),
    ]
    np.testing.assert_allclose(loads[0].outline, [(0.6, 0.4), (1.0, 0.4), (1.0, 1.0), (0.9, 1.0)])
    (point,) = mr.Fill(top=1.0, spread=0.0).under(masonry, force=8e3, at=1.3)
    assert (point.block, point.force, point.at) == ("b1", 8e3, (1.3, 0.4))
    at_the_end = fill.under(masonry, force=8e3, at=0.0, width=0.2)
    assert sum(load.force for load in at_the_end) == pytest.approx(8e3)
    train = fill.under(masonry, [8e3, 6e3, 9e3], at=[1.0, 2.5, 4.0], width=0.2)  # the third has left the blocks
    assert train[: len(loads)] == loads
    assert sum(load.force for load in train) == pytest.approx(14e3)
    assert fill.under(masonry, 8e3, at=[1.0, 2.5]) == fill.under(masonry, [8e3, 8e3], at=[1.0, 2.5])


@pytest.mark.parametrize("way", [1, -1])
def test_passive_pressure_holds_a_block_that_moves_into_the_fill(way):
    """A trapezium whose right face slopes by 1 in 2: pushed to the right it turns about the toe, and the fill bears K
    rho g times the mean depth on 2 m of height, at the middle of the face. To the left it bears nothing."""
    block = mr.Polygon([(0, 0), (1, 0), (0.5, 2), (0, 2)], name="block")
    masonry = mr.Masonry([GROUND, block], friction=5.0)
    bare, held = mr.Fill(2.5, 2000.0), mr.Fill(2.5, 2000.0, passive=3.0)
    found = {name: mr.collapse_multiplier(masonry, way, effects=fill.on(masonry)) for name, fill in
             (("bare", bare), ("held", held))}  # fmt: skip
    W, (x, z) = block.mass * G, block.centroid
    top = 2000 * G * 0.5 * 0.5  # 0.5 m of fill on the level top, in its middle
    area, slope = 0.5 * (2.5 + 0.5) * 0.5, 2000 * G
    at = 1.0 - 0.5 * (2.5 + 2 * 0.5) / (3 * 3.0)  # centroid of the column on the face, from the deeper end
    toe = 1.0 if way > 0 else 0.0
    held_by = way * (W * (toe - x) + top * (toe - 0.25) + slope * area * (toe - at))
    assert found["bare"].multiplier == pytest.approx(held_by / (W * z), rel=1e-7)
    passive = 3.0 * 2000 * G * 1.5 * 2.0 * 1.0 if way > 0 else 0.0
    assert found["held"].multiplier == pytest.approx((held_by + passive) / (W * z), rel=1e-7)


def test_prestwood():
    """TRRL RR110: 228 kN at a quarter of the span. Span, rise, width and cover are from the literature by memory; fill
    of 37 degrees. Weight alone bears half of the test, and spread and full passive pressure nearly all of it. The worst
    place is farther out than the quarter that was tested."""
    span, rise, thick, width, cover = 6.55, 1.428, 0.22, 3.8, 0.165
    r = (span**2 / 4 + rise**2) / (2 * rise)
    arch = mr.Masonry.arch(r + thick / 2, thick, 2 * np.arcsin(span / 2 / r), 40, joints=mr.Dry(k_n=1e9, friction=0.7))
    passive = mr.EarthPressure(2.0, np.radians(37)).passive
    found = []
    for options in ({"spread": 0.0}, {"spread": 0.5}, {"spread": 0.5, "passive": passive}):
        fill = mr.Fill(r + thick + cover, 2000.0, **options)
        axle = fill.under(arch, force=1e3 / width, at=-span / 4, width=0.3)
        found.append(mr.collapse_multiplier(arch, None, loads=axle, effects=fill.on(arch)).multiplier)
    assert found == pytest.approx([108, 119, 225], abs=1.0)
    assert abs(found[2] / 228 - 1) < 0.02

    def at(x):
        axle = fill.under(arch, force=228e3 / width, at=x, width=0.3)
        return mr.collapse_multiplier(arch, None, loads=axle, effects=fill.on(arch))

    scan = mr.design(at, [-span / 4, -1.9, -2.4])
    assert scan.least.value == -1.9
    assert 228 * scan.least.ratio == pytest.approx(209, abs=1.0)
    assert scan.trials[0].ratio == pytest.approx(found[2] / 228, rel=1e-9)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.Fill(5.0).on(ARCH), "top of the fill = 5 m is not above 5.24621 m, the highest face"),
        (lambda: mr.Fill(5.8).under(ARCH, 1e3, at=6.0), "at = 6 m is outside the valid range -4.27043 to 4.27043 m"),
        (lambda: mr.Fill(5.8).under(ARCH, 1e3, at=[6.0, -9.0]), "at = 6 m is outside the valid range -4.27043 to"),
        (lambda: mr.Fill(5.8).under(ARCH, [1e3, 0.0], at=[0.0, 1.0]), r"force\[1\] = 0 N is outside the valid range"),
        (lambda: mr.Fill(5.8).under(ARCH, [1e3, 2e3], at=1.0), "force has 2 axles and at has 1"),
        (lambda: mr.Fill(5.8, spread=3.0), "spread of a load = 3 is outside the valid range 0 to 2"),
        (lambda: mr.Fill(5.8).on(3), "masonry = 3 of type int is not a Masonry"),
        (lambda: mr.Fill(5.8).on(mr.Masonry.box((1, 1, 1))), "masonry is in space"),
    ],
)
def test_refused(make, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        make()
