"""Results as compas_dem keeps them: read by its own classes where it is installed, and by their definition."""

import json

import numpy as np
import pytest

import mjrock as mr
from mjrock.result.files import at_corners
from mjrock.result.motion import sample_at


@pytest.fixture(scope="module")
def answer():
    """A column of three drums that rocks."""
    masonry = mr.Masonry.column(0.5, 1.5, 3, k_n=1e8, k_s=5e7)
    case = mr.MasonryCase(masonry, 0.4, motion=mr.GroundMotion.half_sine(-4.0, 0.3), transverse=None)
    return mr.solve_explicit(case, forces=True, output_step=5e-3)


def contacts(path):
    return json.loads(path.read_text())["data"]


@pytest.mark.parametrize("at", [0.0, 0.2, None])
def test_forces_at_corners_add_up_to_those_of_the_joint_and_act_where_they_do(answer, tmp_path, at):
    k = sample_at(answer.t, at)
    data = contacts(answer.to_compas(tmp_path / "results.json", at))
    forces, joints = answer.forces, answer.case.masonry.joints
    assert len(data["edge_data"]) == len(joints) == 3
    for i, joint in enumerate(joints):
        edge = data["edge_data"][f"{joint.above},{joint.below}"]
        normal = np.array(edge["force_normal"])
        assert normal.sum() == pytest.approx(forces.normal[k, i], rel=1e-12)
        assert (normal >= 0).all()
        assert np.sum(edge["force_tangent1"]) == pytest.approx(forces.shear[k, i, 0], rel=1e-9, abs=1e-6)
        frame = edge["contact_frame"]["data"]
        way = np.array(edge["force_point"]) - frame["point"]
        at_axes = [way @ frame["xaxis"], way @ frame["yaxis"]]
        within = np.clip(forces.eccentricity[k, i], -0.25, 0.25)  # the edge has moved by shear over k_s
        np.testing.assert_allclose(at_axes, within, atol=1e-9)
        assert abs(within - forces.eccentricity[k, i]).max() < 4e-4
        weights = normal / normal.sum() @ np.array(edge["contact_points"])
        np.testing.assert_allclose(weights, edge["force_point"], atol=1e-9)


def test_the_lowest_joint_carries_the_reaction_and_blocks_are_where_they_are(answer, tmp_path):
    data = contacts(answer.to_compas(tmp_path / "results.json"))
    total = data["edge_data"]["1,0"]["resultant_global"]
    np.testing.assert_allclose(total, answer.reactions["ground"][-1], rtol=1e-6, atol=1e-3)
    masonry = answer.case.masonry
    for i in range(4):
        matrix = np.array(data["node_data"][str(i)]["transformation"]["data"]["matrix"])
        moved = matrix[:3, :3] @ masonry.centroids[i] + matrix[:3, 3] - masonry.centroids[i]
        np.testing.assert_allclose(moved, answer.pose[-1, i - 1, :3] if i else 0.0, atol=1e-12)


def test_open_corners_have_a_gap_and_what_slides_is_said(tmp_path):
    ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True)
    masonry = mr.Masonry([ground, mr.Polyhedron.box((0.4, 0.4, 0.2), (0, 0, 0.1))], k_n=1e8, k_s=5e7, friction=0.1)
    slid = mr.solve_explicit(mr.MasonryCase(masonry, 0.1, motion=mr.GroundMotion.half_sine(-4.0, 0.3)), forces=True)
    edge = contacts(slid.to_compas(tmp_path / "slid.json"))["edge_data"]["1,0"]
    assert edge["status"] == ["slide"] * 4
    masonry = mr.Masonry([ground, mr.Polyhedron.box((0.2, 0.2, 2.0), (0, 0, 1.0))], k_n=1e8, k_s=5e7)
    rocked = mr.solve_explicit(mr.MasonryCase(masonry, 0.3, motion=mr.GroundMotion.half_sine(-4.0, 0.3)), forces=True)
    edge = contacts(rocked.to_compas(tmp_path / "rocked.json"))["edge_data"]["1,0"]
    turn = rocked.tilt[-1, 0]
    assert np.ptp(edge["gap"]) == pytest.approx(0.2 * np.sin(turn), rel=1e-6)
    assert np.count_nonzero(np.array(edge["force_normal"]) > 1.0) == 2  # those of the toe
    assert edge["status"] == ["stick"] * 4


def test_shares_of_a_force_on_a_corner_and_outside_the_core():
    square = np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)])
    np.testing.assert_allclose(at_corners(square, np.zeros(2)), 0.25)
    np.testing.assert_allclose(at_corners(square, np.array([1.0, 1.0])), [0, 0, 1, 0], atol=1e-12)
    shares = at_corners(square, np.array([0.9, 0.3]))
    assert shares.min() >= 0
    np.testing.assert_allclose(shares @ square, [0.9, 0.3], atol=1e-12)


def test_without_forces_there_are_no_contacts_and_a_wall_has_no_file(answer, one_sided, e, tmp_path):
    bare = mr.solve_explicit(answer.case, output_step=0.1)
    assert contacts(bare.to_compas(tmp_path / "bare.json"))["edge_data"] == {}
    with pytest.raises(ValueError, match="of a wall, or of blocks in the plane"):
        mr.solve_analytical(one_sided, e).to_compas(tmp_path / "wall.json")
    with pytest.raises(ValueError, match="at = 9"):
        answer.to_compas(tmp_path / "late.json", at=9.0)


def test_compas_dem_reads_model_and_results(answer, tmp_path):
    pytest.importorskip("compas_dem", reason="needs compas_dem")
    import compas

    model = compas.json_load(answer.case.masonry.to_compas(tmp_path / "model.json"))
    results = compas.json_load(answer.to_compas(tmp_path / "results.json", at=0.2))
    assert results.model_id == str(model.guid)
    assert sorted(results.nodes()) == [block.graphnode for block in model.elements()]
    k = sample_at(answer.t, 0.2)
    masonry = answer.case.masonry
    for block in model.elements():
        moved = block.modelgeometry.transformed(results.transformation(block.graphnode)).centroid()
        place = masonry.centroids[block.graphnode]
        if block.graphnode:
            place = place + answer.pose[k, block.graphnode - 1, :3]
        np.testing.assert_allclose(moved, place, atol=1e-9)
    for i, joint in enumerate(masonry.joints):
        edge = joint.above, joint.below
        contact = results.contact_data(edge)
        assert len(contact.points) == 4
        line = contact.resultantforce[0]
        np.testing.assert_allclose(line.length, results.force_magnitude(edge), rtol=1e-9)
        np.testing.assert_allclose(line.midpoint, results.edge_attribute(edge, "force_point"), atol=1e-6)
        assert sum(results.force_normal(edge)) == pytest.approx(answer.forces.normal[k, i])
