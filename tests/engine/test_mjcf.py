import dataclasses
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest

import mjrock as mr
from scripts.shared.paper import K_N


@pytest.fixture
def text(one_sided, contacts):
    return mr.wall_mjcf(one_sided, contacts, 1e-3)


def test_same_case_same_bytes(one_sided, contacts, wall, e, text):
    again = mr.Contacts.from_law(wall, e, k_base=K_N, k_side=K_N, law="PUBLISHED")
    assert mr.wall_mjcf(dataclasses.replace(one_sided), again, timestep=1e-3) == text


def test_stock_mujoco_loads_the_names(text):
    model = mujoco.MjModel.from_xml_string(text)
    for name in ("wall", "base", "side", "base_0", "base_1", "side_0", "side_1"):
        assert model.geom(name).id >= 0
    assert model.body("wall").mass[0] == 5040
    assert [model.joint(i).name for i in range(model.njnt)] == ["x", "z", "theta"]
    np.testing.assert_allclose(model.geom("wall").size, [0.3, 0.5, 2.1])
    assert model.key("release").qpos[2] == 0.5 * np.arctan2(0.3, 2.1)


def test_numbers_survive_the_text_to_the_last_digit(text, contacts, wall):
    model = mujoco.MjModel.from_xml_string(text)
    p = mr.contact_parameters(
        float(contacts.base.stiffness[0]),
        float(contacts.base.damping[0]),
        timestep=1e-3,
        inverse_weight=2 / (3 * wall.mass),
    )
    assert tuple(model.pair("base_0").solref) == p.solref
    assert tuple(model.pair("base_0").solimp) == p.solimp


def test_the_engine_weighs_the_wall_as_the_text_presumes(text, wall):
    model = mujoco.MjModel.from_xml_string(text)
    assert model.body_invweight0[model.body("wall").id, 0] == pytest.approx(2 / (3 * wall.mass), rel=1e-12)


def test_k_and_c_come_back_out_of_the_compiled_pairs(text, contacts, wall):
    model = mujoco.MjModel.from_xml_string(text)
    for name, interface in (("base_1", contacts.base), ("side_1", contacts.side)):
        pair = model.pair(name)
        found = mr.contact_stiffness(tuple(pair.solref), tuple(pair.solimp), inverse_weight=2 / (3 * wall.mass))
        assert found == pytest.approx((interface.stiffness[-1], interface.damping[-1]), rel=1e-12)


def test_a_case_without_a_side_stop_has_nothing_of_one(two_sided, contacts):
    text = mr.wall_mjcf(two_sided, contacts, 1e-3)
    assert "side" not in text
    model = mujoco.MjModel.from_xml_string(text)
    assert model.npair == 2


def test_only_explicit_pairs_collide(text):
    model = mujoco.MjModel.from_xml_string(text)
    assert not model.geom_contype.any()
    assert not model.geom_conaffinity.any()
    assert model.npair == 4


def test_friction_holds_the_edges_of_a_bed_alone(wall, e, one_sided):
    contacts = mr.Contacts.from_law(wall, e, k_base=K_N, k_side=K_N, law="PUBLISHED", points=7)
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(one_sided, contacts, 1e-3))
    condim = {model.pair(i).name: int(model.pair_dim[i]) for i in range(model.npair)}
    assert {name for name, dim in condim.items() if dim == 3} == {"base_0", "base_6"}


def test_what_made_the_model_is_recorded_in_it(text, contacts):
    model = mujoco.MjModel.from_xml_string(text)
    assert model.numeric("k_n_base").data[0] == K_N
    assert model.numeric("xi_base").data[0] == contacts.base.xi
    assert model.numeric("xi_side").data[0] == contacts.side.xi
    recorded = {node.get("name"): node.get("data") for node in ET.fromstring(text).iter("text")}
    assert recorded == {"law": "PUBLISHED", "mjrock": mr.__version__}


def test_a_law_with_a_name_that_xml_has_to_escape(wall, two_sided, contacts):
    odd = dataclasses.replace(contacts, law='my "law" <2 & --more')
    text = mr.wall_mjcf(two_sided, odd, 1e-3)
    assert mujoco.MjModel.from_xml_string(text).npair == 2
    assert 'my "law" <2 & --more' in {node.get("data") for node in ET.fromstring(text).iter("text")}


@pytest.mark.parametrize("timestep", [0.0, -1e-3, float("nan"), 10.0])
def test_bad_steps(one_sided, contacts, timestep):
    with pytest.raises(ValueError, match="timestep"):
        mr.wall_mjcf(one_sided, contacts, timestep)


def test_a_row_that_mujoco_would_clamp_takes_the_smallest_inertia_it_represents(wall, two_sided):
    undamped = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.0)
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(two_sided, undamped, 1e-6))
    pair = model.pair("base_0")
    assert pair.solimp[0] == pytest.approx(1e-4, rel=1e-6)
    k, c = mr.contact_stiffness(tuple(pair.solref), tuple(pair.solimp), inverse_weight=2 / (3 * wall.mass))
    assert (k, c) == (pytest.approx(undamped.base.stiffness[0], rel=1e-12), 0.0)


def test_every_contact_point_sits_where_the_wall_touches(one_sided, contacts, wall):
    """Gap and normal are those of the corner at every rotation, whatever the radius of the sphere."""
    from mjrock.geometry.kinematics import gaps

    scene = mr.wall_scene(one_sided, contacts)
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(one_sided, contacts, 1e-3))
    data = mujoco.MjData(model)
    for theta in (-0.002, 0.001, 0.1):
        data.qpos[:] = 0.0, -0.002 - 0.3 * abs(np.sin(theta)), theta
        mujoco.mj_forward(model, data)
        found = {model.geom(c.geom[1]).name: c.dist for c in data.contact} | {
            model.geom(c.geom[0]).name: c.dist for c in data.contact
        }
        for name, gap in zip(scene.contacts.point_names, gaps(scene.places, data.qpos[None].copy())[0], strict=True):
            assert (name in found) == (gap < 0)
            if gap < 0:
                assert found[name] == pytest.approx(gap, abs=1e-14)
