"""Blocks have the same colours in every picture, film, page and file, and blocks that touch have others."""

import json
import re
import struct
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import animation
from mjrock.plotting.bodies import Bodies
from mjrock.plotting.solids import Solids
from mjrock.scene.tints import FIXED_COLOUR, TINTS, colours_of, distinct_tints

FLAT = mr.Masonry.running_bond(1.2, 0.8, (0.4, 0.2), k_n=1e9)
DEEP = mr.Masonry.facade(1.2, 0.6, 0.6, (0.4, 0.2), k_n=1e9)


def still(masonry):
    return mr.solve_explicit(mr.MasonryCase(masonry, 1e-3))


def in_gltf(run, folder):
    """By the definition of sRGB (IEC 61966-2-1), since colours of a .glb are parts of light."""
    data = run.to_gltf(folder / "a.glb").read_bytes()
    text = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])
    found = {}
    for mesh in text["meshes"]:
        material = text["materials"][mesh["primitives"][0]["material"]]
        light = np.array(material["pbrMetallicRoughness"]["baseColorFactor"][:3])
        found[mesh["name"]] = np.where(light > 0.0031308, 1.055 * light ** (1 / 2.4) - 0.055, 12.92 * light)
    return found


def in_vtk(run, folder):
    """Colours of faces, which are bytes, by the number of their block."""
    cells = ET.parse(run.to_vtk(folder).with_name("blocks_00000.vtu")).getroot().find(".//CellData")
    rows = {array.get("Name"): np.array(array.text.split(), dtype=int) for array in cells}
    assert cells.get("Scalars") == "colour"
    names, colours = run.case.blocks, rows["colour"].reshape(-1, 3) / 255
    return {names[number]: colour for number, colour in zip(rows["block"], colours, strict=True)}


def in_browser(run, folder):
    text = plotting.view(run, folder / "a.html").read_text()
    bodies = json.loads(re.search(r'<script[^>]*id="run"[^>]*>(.*?)</script>', text, re.S)[1])["bodies"]
    return {body["name"]: FIXED_COLOUR if body["colour"] is None else body["colour"] for body in bodies}


def in_model(text):
    model = mujoco.MjModel.from_xml_string(text)
    return {model.geom(i).name: model.geom_rgba[i, :3] for i in range(model.ngeom)}


def in_mujoco(run, folder):
    return in_model(mr.mjcf_of(run.case, None, 1e-4))


def in_plain_mujoco(run, folder):
    return in_model(mr.mjcf_of(run.case, None, 1e-4, collisions=True))


def in_picture(run, folder):
    """A still picture of the plane."""
    free = plotting.blocks(Figure().subplots(), run).collections[0].get_facecolor()[:, :3]
    return dict(zip(run.bodies, free, strict=True))


def in_film(run, folder):
    """A film of the plane."""
    figure, _ = animation.scene(Bodies.of(run), [], run.case)
    return dict(zip(run.bodies, figure.axes[0].collections[0].get_facecolor()[:, :3], strict=True))


def in_space(run, folder):
    """A picture of space."""
    drawn = Solids.of(run)
    numbers, colours = drawn.facets.block, drawn.stage(0)[0].colour
    return {run.case.blocks[number]: colour for number, colour in zip(numbers, colours, strict=True)}


OUTPUTS = (in_gltf, in_vtk, in_browser, in_mujoco, in_plain_mujoco)


@pytest.mark.parametrize(
    ("output", "masonry"),
    [
        *((output, FLAT) for output in (*OUTPUTS, in_picture, in_film)),
        *((output, DEEP) for output in (*OUTPUTS, in_space)),
    ],
)
def test_a_block_has_its_colour_in_every_output(output, masonry, tmp_path):
    """Bytes round a colour by half of 1/255."""
    run = still(masonry)
    wanted = dict(zip(masonry.names, colours_of(run.case.rest_geometry), strict=True))
    found = output(run, tmp_path)
    for name in run.bodies:
        np.testing.assert_allclose(found[name], wanted[name], atol=0.51 / 255, err_msg=name)
    pairs = [joint.name.split("|") for joint in masonry.joints]
    free = [(a, b) for a, b in pairs if a in run.bodies and b in run.bodies]
    assert len(free) > 10
    assert all(np.abs(np.subtract(found[a], found[b])).max() > 0.03 for a, b in free)


def test_a_body_that_touches_bodies_of_all_tints_has_one_of_theirs():
    last = len(TINTS)
    printed = distinct_tints(last + 1, [(i, j) for i in range(last + 1) for j in range(i)])
    assert sorted(printed[:last]) == list(range(last))
    assert printed[last] in range(last)
