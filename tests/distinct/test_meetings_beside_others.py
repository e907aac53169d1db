"""Blocks that have left their joints, beside prisms in space, MuJoCo and what statics says."""

from copy import copy

import mujoco
import numpy as np
import pytest
from everyday import among
from masonry_blocks import GROUND, box

import mjrock as mr
from mjrock.distinct.search.constants import VALID_APPROACH
from mjrock.distinct.search.contact_search import ContactSearch

SPEEDS = np.linspace(0.4, 4.0, 20)


def in_space(blocks):
    return [mr.Polyhedron.prism(block) for block in blocks]


def thrown(speed, prisms):
    """A block that slides off a table: its run, and its place and angle in the plane."""
    blocks = [GROUND, box(-1, 0, 0, 0.6, fixed=True, name="table"), box(-0.6, -0.1, 0.6, 0.9)]
    masonry = mr.Masonry(in_space(blocks) if prisms else blocks, k_n=1e8, friction=0.5, xi=0.1)
    velocity = (speed, 0, 0, 0, 0.3 * speed, 0) if prisms else (speed, 0, 0.3 * speed)
    run = mr.solve_explicit(mr.MasonryCase(masonry, 1.2, velocity=[velocity]), timestep=1e-3, output_step=2e-3)
    assert run.stats["overlap"] < 0.01
    if not prisms:
        return run, run.pose[:, 0]
    turned = np.unwrap(2 * np.arctan2(run.pose[:, 0, 5], run.pose[:, 0, 3]))
    return run, np.column_stack([run.pose[:, 0, [0, 2]], turned])


def thrown_both(speed):
    """The block until it meets the ground, where paths part, and how far its prism in space is from it."""
    (flat, path), (deep, there) = (thrown(speed, prisms) for prisms in (False, True))
    before = np.maximum.accumulate(-path[:, 1]) < 0.3
    assert before.sum() > 100
    assert np.abs(deep.pose[before][:, 0, [1, 4, 6]]).max() < 1e-4
    return flat.t[before], path[before], flat.velocity[before][:, 0], np.abs(there - path)[before]


@pytest.mark.parametrize("number", among(range(0, 20, 3), 3))
def test_a_block_thrown_off_a_table_moves_as_its_prism_in_space(number, monkeypatch):
    """Where both are looked at in every step. What is left is rounding, which grows while an edge chatters."""
    begun = ContactSearch.begun

    def begun_to_look(self, supports):
        often = copy(self)
        often.limits = self.limits._replace(interval=1e-3)
        return begun(often, supports)

    monkeypatch.setattr(ContactSearch, "begun", begun_to_look)
    assert thrown_both(SPEEDS[number])[-1].max() < 1e-4


@pytest.mark.parametrize("number", among([3, *range(2, 20, 3)], 3, 8))
def test_a_block_and_its_prism_part_by_the_way_that_places_serve_for(number):
    """A prism is larger than its section, so that looks come at other times. A place serves while the pair moves by 2 %
    of the block. So the upward impulse, once the block hangs over the edge, acts so far off in each of the two. The
    spin that this makes turns the block, and its centroid goes by that angle times half the diagonal."""
    t, path, velocity, apart = thrown_both(SPEEDS[number])
    over = int((path[:, 0] > 0.1).argmax()) if path[:, 0].max() > 0.1 else len(t) - 1
    impulse = np.maximum(velocity[:, 1] - velocity[over, 1] + mr.GRAVITY * (t - t[over]), 0.0)
    impulse[:over] = 0.0
    half, inertia = 0.5 * np.hypot(0.5, 0.3), (0.5**2 + 0.3**2) / 12
    turned = np.cumsum(2 * VALID_APPROACH * half * impulse / inertia) * 2e-3 + 1e-4
    assert (apart[:, 2] < turned).all()
    assert (apart[:, :2] < half * turned[:, None]).all()


@pytest.mark.parametrize("prisms", among([False, True], False))
def test_a_beam_loses_a_bearing_when_its_pier_has_gone_so_far(prisms):
    """A bearing of 0.10 m on a pier that moves away by 15 mm/s, without friction: it is lost within 2 mm of 0.10 m.
    The smaller bearing yields more, and the beam slides along the tilt of 0.2 mrad that this makes."""
    blocks = [
        GROUND,
        box(-1, 0, 0, 1, fixed=True, name="pier"),
        box(2, 3, 0, 1, fixed=True),
        box(-0.10, 2.10, 1, 1.2, name="beam"),
    ]
    masonry = mr.Masonry(in_space(blocks) if prisms else blocks, k_n=1e9, friction=0.0, xi=0.1)
    t = np.array([0.0, 7.5])
    history = (t, -0.015 * t, *(0.0 * t,) * (2 if prisms else 1))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 7.5, supports={"pier": history}), output_step=5e-3)
    dropped = int((run.pose[:, 0, 2 if prisms else 1] < -2e-3).argmax())
    assert 0.015 * run.t[dropped] + run.pose[dropped, 0, 0] == pytest.approx(0.10, abs=2e-3)


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
    slab = followed([GROUND, box(-0.5, 0.5, 0, 0.5)], 1.1, ground=(t, 0 * t, sunk))
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
@pytest.mark.filterwarnings("ignore:a turn of 0.01 degrees about the normal")
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
