"""The page for the browser: what it holds, and where there is a browser, what it shows."""

import base64
import dataclasses
import re
import shutil
import sys
import zlib

import numpy as np
import pytest

import mjrock as mr
from mjrock import plotting
from mjrock.result.motion import SampledMotion

pytest.importorskip("k3d")
msgpack = pytest.importorskip("msgpack")
BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
SWITCHES = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@pytest.fixture(scope="module")
def fallen():
    """Two blocks on a ground, the upper one thrown off; it is held by a tie."""
    blocks = [
        mr.Polygon([(-2, -0.5), (2, -0.5), (2, 0), (-2, 0)], fixed=True, name="ground"),
        mr.Polygon([(-0.3, 0), (0.3, 0), (0.3, 1), (-0.3, 1)], name="lower"),
        mr.Polygon([(-0.3, 1), (0.3, 1), (0.3, 1.5), (-0.3, 1.5)], name="upper"),
    ]
    masonry = mr.Masonry(blocks, k_n=1e9, friction=0.3, xi=0.1)
    tie = mr.Tie(block="upper", height=1.25, stiffness=1e5, strength=1e3, ultimate=0.05)
    push = mr.GroundMotion(np.where(np.arange(0, 1.0, 0.01) < 0.3, -9.0, 0.0), 0.01)
    case = mr.MasonryCase(masonry, 1.0, motion=push, effects=(tie,))
    return mr.solve_explicit(case, forces=True)


def objects_of(path):
    """The objects of a page, by their names."""
    packed = re.search(r"var data = '([^']*)'", path.read_text())[1]
    tree = msgpack.unpackb(zlib.decompress(base64.b64decode(packed)), strict_map_key=False)
    return {each["name"]: each for each in tree["objects"]}


def array_of(entry):
    data = zlib.decompress(entry["compressed_data"]) if "compressed_data" in entry else entry["data"]
    return np.frombuffer(data, entry["dtype"]).reshape(entry["shape"])


def test_a_page_has_the_blocks_where_they_are(fallen, tmp_path):
    objects = objects_of(plotting.view(fallen, tmp_path / "page.html"))
    groups = {name: each["group"] for name, each in objects.items()}
    (tie,) = fallen.ties
    assert groups == {"ground": "ground", "lower": "blocks", "upper": "blocks", tie: "ties", "forces": "forces"}
    matrices = objects["upper"]["model_matrix"]
    times = np.array(sorted(map(float, matrices)))
    assert len(times) == pytest.approx(26, abs=1)
    for time in times[[0, 12, -1]]:
        matrix = array_of(matrices[repr(float(time))])
        x, z, theta = fallen.pose[np.argmin(np.abs(fallen.t - time)), 1]
        np.testing.assert_allclose(matrix[:3, 3], [x, 0, 1.25 + z], atol=1e-6)
        np.testing.assert_allclose(matrix[0, [0, 2]], [np.cos(theta), np.sin(theta)], atol=1e-6)


def test_a_page_asks_for_nothing_from_elsewhere(fallen, tmp_path):
    text = plotting.view(fallen, tmp_path / "page.html").read_text()
    assert not re.search(r"<(script|link|img|iframe)[^>]*(src|href)=", text)
    assert "unpkg" not in text.split("window.k3dCompressed")[0]


@pytest.mark.slow
def test_a_page_of_150_blocks_and_10_seconds_is_small(tmp_path):
    masonry = mr.Masonry.running_bond(3.0, 3.0, (0.3, 0.2), k_n=1e9, friction=0.6)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.01), forces=True)
    number, t = len(masonry.free), np.arange(0, 10, 0.01)
    assert number >= 150
    anywhere = np.random.default_rng(0).normal(size=(len(t), number, 3))  # packs worse than any motion
    forces = {
        name: np.resize(getattr(answer.forces, name), (len(t), len(masonry.joints)))
        for name in ("normal", "shear", "eccentricity", "damage")
    }
    long = dataclasses.replace(
        answer,
        t=t,
        motion=SampledMotion(anywhere, anywhere, np.zeros(len(t))),
        kept_forces=dataclasses.replace(answer.forces, **forces),
    )
    assert plotting.view(long, tmp_path / "page.html").stat().st_size < 15e6


def test_a_wall_of_one_block_has_a_page(tmp_path):
    wall = mr.Block.from_size(thickness=0.6, height=4.2)
    e = mr.Restitution.from_geometry(wall)
    objects = objects_of(
        plotting.view(mr.solve_analytical(mr.Case(wall, 0.5 * wall.alpha, 1.0), e), tmp_path / "w.html")
    )
    assert {name: each["group"] for name, each in objects.items()} == {
        "wall": "blocks",
        "base": "ground",
        "side": "ground",
    }


def test_what_is_missing_or_wrong_is_named(fallen, tmp_path, monkeypatch):
    with pytest.raises(ValueError, match=r"does not end with \.html"):
        plotting.view(fallen, tmp_path / "page.htm")
    monkeypatch.setitem(sys.modules, "k3d", None)
    with pytest.raises(ImportError, match=r"pip install 'mjrock\[view\]'"):
        plotting.view(fallen, tmp_path / "page.html")


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason="no Chromium on this machine")
def test_a_browser_shows_the_blocks_and_its_slider_moves_them(fallen, tmp_path):
    driver = pytest.importorskip("playwright.sync_api")
    path, asked = plotting.view(fallen, tmp_path / "page.html"), []
    with driver.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=BROWSER, args=SWITCHES)
        page = browser.new_page(viewport={"width": 640, "height": 480})
        page.on("request", lambda request: asked.append(request.url))
        page.goto(path.as_uri())
        page.wait_for_selector("#clock")
        page.wait_for_timeout(2000)
        pictures = [page.screenshot()]
        for script in (
            "() => { const s = document.querySelector('#time'); s.value = 0.8; s.oninput(); }",
            "() => document.querySelector('input[name=ground]').click()",
        ):
            page.evaluate(script)
            page.wait_for_timeout(1500)
            pictures.append(page.screenshot())
        page.mouse.move(320, 300)
        page.mouse.down()
        page.mouse.move(450, 300, steps=5)
        page.mouse.up()
        page.wait_for_timeout(1500)
        pictures.append(page.screenshot())
        browser.close()
    assert len(set(pictures)) == 4  # at rest, later, without the ground, turned
    assert not [url for url in asked if not url.startswith(("file:", "blob:", "data:"))]
