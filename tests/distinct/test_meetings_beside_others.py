"""Blocks that have left their joints, beside prisms in space, MuJoCo and what statics says."""

import mujoco
import numpy as np
import pytest
from everyday import among
from masonry_blocks import GROUND, box

import mjrock as mr

SPEEDS = np.linspace(0.4, 4.0, 20)


def in_space(blocks):
    return [mr.Polyhedron.prism(block) for block in blocks]


@pytest.mark.parametrize("number", among(range(20), 3, 8))
def test_a_block_thrown_off_a_table_moves_as_its_prism_in_space(number):
    """Until it meets the ground, where paths part. A prism is larger than its section, so that looks come at other
    times: an edge is met within 2 % of a block, which turns the block by a hundredth on its way over it."""
    speed = SPEEDS[number]
    blocks = [GROUND, box(-1, 0, 0, 0.6, fixed=True, name="table"), box(-0.6, -0.1, 0.6, 0.9)]
    flat, deep = (
        mr.solve_explicit(
            mr.MasonryCase(mr.Masonry(some, k_n=1e8, friction=0.5, xi=0.1), 1.2, velocity=[velocity]),
            output_step=2e-3,
        )
        for some, velocity in (
            (blocks, (speed, 0.0, 0.3 * speed)),
            (in_space(blocks), (speed, 0, 0, 0, 0.3 * speed, 0)),
        )
    )
    turned = np.unwrap(2 * np.arctan2(deep.pose[:, 0, 5], deep.pose[:, 0, 3]))
    there = np.column_stack([deep.pose[:, 0, [0, 2]], turned])
    before = np.maximum.accumulate(-flat.pose[:, 0, 1]) < 0.3
    assert before.sum() > 100
    assert np.abs(there - flat.pose[:, 0])[before].max() < 0.01
    assert np.abs(deep.pose[before][:, 0, [1, 4, 6]]).max() < 1e-4
    for run in (flat, deep):
        assert run.stats["overlap"] < 0.01


@pytest.mark.parametrize("prisms", among([False, True], False))
def test_a_beam_loses_a_bearing_when_its_pier_has_gone_so_far(prisms):
    """A bearing of 0.10 m on a pier that moves away by 7.5 mm/s, without friction: it is lost within 2 mm of 0.10 m.
    The smaller bearing yields more, and the beam slides along the tilt of 0.2 mrad that this makes."""
    blocks = [
        GROUND,
        box(-1, 0, 0, 1, fixed=True, name="pier"),
        box(2, 3, 0, 1, fixed=True),
        box(-0.10, 2.10, 1, 1.2, name="beam"),
    ]
    masonry = mr.Masonry(in_space(blocks) if prisms else blocks, k_n=1e9, friction=0.0, xi=0.1)
    t = np.array([0.0, 15.0])
    history = (t, -0.0075 * t, *(0.0 * t,) * (2 if prisms else 1))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 15.0, supports={"pier": history}), output_step=5e-3)
    dropped = int((run.pose[:, 0, 2 if prisms else 1] < -2e-3).argmax())
    assert 0.0075 * run.t[dropped] + run.pose[dropped, 0, 0] == pytest.approx(0.10, abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("prisms", [False, True])
@pytest.mark.parametrize("length", [1.5, 10.0])
def test_a_block_falls_when_its_centroid_has_passed_an_edge_by_2_mm(length, prisms):
    """Its step is drawn away below it, however long the face of the step is. 20 mm before the edge it stands."""
    step = mr.Polygon([(-length, 0), (0, 0), (0, 1), (-length, 1)], fixed=True, name="step")
    blocks = [box(-12, 6, -1, 0, fixed=True, name="ground"), step, box(-1.0, 0.0, 1, 1.5, name="block")]
    masonry = mr.Masonry(in_space(blocks) if prisms else blocks, k_n=1e9, friction=0.0, xi=0.2)
    t = np.linspace(0, 4, 81)
    for beyond, falls in ((0.002, True), (-0.02, False)):
        drawn = -(0.5 + beyond) * 0.5 * (1 - np.cos(np.pi * t / 4))
        history = (t, drawn, *(0.0 * t,) * (2 if prisms else 1))
        run = mr.solve_explicit(mr.MasonryCase(masonry, 6.0, supports={"step": history}), output_step=5e-3)
        assert bool(run.fallen) == falls


@pytest.mark.parametrize("prisms", among([False, True], True))
def test_a_slab_and_a_lintel_are_met_where_their_supports_have_gone(prisms):
    """The ground sinks by 0.5 m faster than a slab can fall; piers part until a lintel falls between them."""

    def followed(blocks, duration, **histories):
        masonry = mr.Masonry(in_space(blocks) if prisms else blocks, k_n=1e9, friction=0.5, xi=0.3)
        supports = {name: (t, dx, *(0.0 * dx,) * prisms, dz) for name, (t, dx, dz) in histories.items()}
        return mr.solve_explicit(mr.MasonryCase(masonry, duration, supports=supports), output_step=5e-3)

    t = np.linspace(0, 0.2, 61)
    sunk = -0.25 * (1 - np.cos(np.pi * t / 0.2))
    slab = followed([GROUND, box(-0.5, 0.5, 0, 0.5)], 1.5, ground=(t, 0 * t, sunk))
    up = 2 if prisms else 1
    assert slab.pose[-1, 0, up] == pytest.approx(-0.5, abs=1e-3)
    assert slab.stats["overlap"] < 0.01
    t = np.linspace(0, 1, 101)
    way = 0.5 * (1 - np.cos(np.pi * t))
    piers = [box(-1.5, -0.5, 0, 1, fixed=True, name="left"), box(0.5, 1.5, 0, 1, fixed=True, name="right")]
    lintel = followed(
        [GROUND, *piers, box(-0.7, 0.7, 1, 1.6)], 3.0, left=(t, -0.4 * way, 0 * t), right=(t, 0.4 * way, 0 * t)
    )
    assert lintel.pose[-1, 0, up] == pytest.approx(-1.0, abs=2e-3)
    assert lintel.stats["overlap"] < 0.01


CUBES = """<mujoco><option gravity="0 0 0" timestep="1e-5" cone="elliptic"><flag island="disable"/></option>
<worldbody><body pos="-.501 0 .5"><freejoint/><geom name="a" type="box" size=".5 .5 .5" density="2000"/></body>
<body pos=".501 0 .5"><freejoint/><geom name="b" type="box" size=".5 .5 .5" density="2000"/></body>
</worldbody></mujoco>"""


@pytest.mark.parametrize(("spin", "within"), [(0.0, 2e-4), (1.0, 0.01), (-2.0, 0.015)])
def test_two_blocks_that_collide_in_flight_leave_each_other_as_in_mujoco(spin, within):
    """MuJoCo finds the places by its own collision of boxes, with stiffness and dashpot of the pair on its four places.
    Where a block is turned by a thousandth the two take normals of different blocks."""
    blocks = [GROUND, box(-1.001, -0.001, 0, 1), box(0.001, 1.001, 0, 1)]
    masonry = mr.Masonry(blocks, k_n=1e8, friction=0.0, xi=0.1)
    case = mr.MasonryCase(masonry, 0.06, velocity=[(2.0, 3.0, spin), (0.0, 3.0, 0.0)])
    run = mr.solve_explicit(case, timestep=1e-5, output_step=1e-3)
    explicit = run.velocity[-1] - (0.0, 3.0 - mr.GRAVITY * 0.06, 0.0)
    model = mujoco.MjModel.from_xml_string(CUBES)
    k, c = 1e8, float(masonry.retardation[0]) * 1e8
    mr.contact_for(model, "a", "b", k=k / 4, c=c / 4, friction=0.0, contacts=4).apply(
        spec := mujoco.MjSpec.from_string(CUBES)
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[[0, 4]] = 2.0, spin
    for _ in range(6000):
        mujoco.mj_step(model, data)
    other = data.qvel.reshape(2, 6)[:, [0, 2, 4]]
    np.testing.assert_allclose(explicit[:, [0, 2]], other[:, [0, 2]], atol=within * (2.0 + abs(spin)))
    lost = [
        4000.0 - float(2000 * (v[:, :2] ** 2).sum() / 2 + 2000 / 6 * (v[:, 2] ** 2).sum() / 2)
        for v in (explicit, other)
    ]
    assert lost[0] == pytest.approx(lost[1], rel=0.02)
