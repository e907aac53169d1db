"""`python -m mjrock inspect`: a page that one reads of a model with many contacts."""

import csv
import os
import subprocess
import sys

import mujoco
import numpy as np
import pytest
from pairs import BALL, FLOOR, scene

import mjrock as mr
from mjrock.__main__ import main
from scripts.models import inspect_contacts as script

FEET = "".join(
    f'<body name="leg{i}" pos="{i} 0 1"><freejoint/><geom size=".1" mass="{i + 1}"/></body>' for i in range(9)
)
STUCK = '<body name="arm" pos="0 3 1"><joint type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body>'


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "robot.xml"
    path.write_text(scene(FLOOR, FEET, STUCK, timestep=0.01, gravity=9.81))
    return path


def lines_of(capsys, *arguments):
    assert main([str(argument) for argument in arguments]) == 0
    return capsys.readouterr().out.splitlines()


def test_it_is_a_page(model, capsys):
    """55 contacts: 40 of them, the notes that are alike once, geoms by the names of their bodies, within 80 columns."""
    lines = lines_of(capsys, "inspect", model)
    assert len(lines) < 66
    assert max(map(len, lines)) <= 80
    assert "floor  leg0[1]" in lines[2] or "leg" in lines[2]
    assert any(line.startswith("and 15 more; --all shows all rows") for line in lines)
    notes = [line for line in lines if line[:1].isdigit()]
    assert len(notes) < 8
    assert any("like it]" in note for note in notes)
    assert any("mass is infinite: the geoms cannot approach" in note for note in notes)
    assert len(lines_of(capsys, "inspect", model, "--all")) > 55


def test_it_chooses(model, capsys):
    assert len(_rows(lines_of(capsys, "inspect", model, "--geom", "floor"))) == 10
    assert len(_rows(lines_of(capsys, "inspect", model, "--body", "leg1"))) == 10
    assert len(_rows(lines_of(capsys, "inspect", model, "--body", "leg1", "--geom", "floor"))) == 1
    assert len(_rows(lines_of(capsys, "inspect", model, "--pair", "leg[12]", "floor"))) == 2
    (none,) = lines_of(capsys, "inspect", model, "--pair", "leg1", "leg1")
    assert none == "No contact of this model is of these geoms, bodies or pairs."
    (none,) = lines_of(capsys, "inspect", model, "--pairs")
    assert none == "This model has no contact of two geoms that can act."


def _rows(lines):
    return lines[2 : next(i for i, line in enumerate(lines) if line.startswith(("v is", "--all")))]


def test_the_worst_are_first_and_the_immovable_last(model, capsys):
    rows = _rows(lines_of(capsys, "inspect", model, "--geom", "floor", "--all"))
    assert rows[-1].split()[6] == "inf"
    assert rows[-1].split()[10:13] == ["-", "-", "-"]


def test_contacts_that_differ_in_a_name_alone_are_one_row(tmp_path, capsys):
    """Four equal balls on a floor: one row of a page, and four of --all, which has 14 columns."""
    balls = "".join(
        f'<body name="ball{i}" pos="{i} 0 1"><freejoint/><geom contype="2" size=".1" mass="1"/></body>'
        for i in range(4)
    )
    path = tmp_path / "balls.xml"
    path.write_text(scene(FLOOR.replace("<geom", '<geom conaffinity="2"', 1), balls))
    (row,) = _rows(lines_of(capsys, "inspect", path))
    assert "and 3 like it" in row
    lines = lines_of(capsys, "inspect", path, "--all")
    assert len(_rows(lines)) == 4
    assert "row adds" in lines[0]
    assert lines[0].endswith("notes")


def test_it_writes_every_row(model, tmp_path, capsys):
    path = tmp_path / "rows.csv"
    lines_of(capsys, "inspect", model, "--csv", path, "--speed", "3", "--load", "5")
    with path.open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 55
    assert {"geom1", "k [N/m]", "k loaded", "e at v", "notes"} <= set(rows[0])


def test_what_cannot_be_is_said(model, tmp_path, capsys):
    assert main(["inspect", str(tmp_path / "none.xml")]) == 2
    assert "is not a file" in capsys.readouterr().err
    assert main(["inspect", str(model), "--keyframe", "home"]) == 2
    assert "keyframe = 'home' of type str is not a keyframe of this model; it has: none" in capsys.readouterr().err
    for choice in (["--pair", "foo", "floor"], ["--geom", "foo"], ["--body", "foo"]):
        assert main(["inspect", str(model), *choice]) == 2
        assert "the model has no geom or body foo; geoms are: floor, leg0[1]" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["inspect"])


SOFT = """<mujoco><option timestep="1e-3" integrator="Euler"/><worldbody>
<geom name="floor" {}/><flexcomp name="soft" type="grid" count="4 4 3" spacing=".05 .05 .05" pos="0 0 .1" dim="3"
mass="1" radius=".005"><contact selfcollide="none" {}/><elasticity young="2e4" poisson=".2" damping=".01"/></flexcomp>
</worldbody></mujoco>"""


@pytest.mark.parametrize("floor", ['type="plane" size="1 1 1"', 'type="box" size="1 1 .1" pos="0 0 -.1"'])
@pytest.mark.parametrize(
    "soft", ["", 'solref="-1e3 -5" solimp=".5 .8 .01" priority="1"', 'solref=".05 .5" solmix="3" condim="1"']
)
def test_contacts_of_flexes_are_those_of_the_engine(tmp_path, capsys, floor, soft):
    """k = K d / R and c = B / R of the rows that MuJoCo makes of the vertices at a touch."""
    path = tmp_path / "soft.xml"
    path.write_text(SOFT.format(floor, soft))
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    deep = np.array(data.qpos)
    deep.reshape(-1, 3)[:, 2] -= 0.045 + 1e-9
    data.qpos[:] = deep
    mujoco.mj_forward(model, data)
    assert data.ncon >= 16
    rows = [int(address) for address in data.contact.efc_address]
    edges = 1 if data.contact[0].dim == 1 else 4
    K, B, d, _ = data.efc_KBIP[rows].T
    k, c = edges * K * d / data.efc_R[rows], edges * B / data.efc_R[rows]
    (found,) = mr.inspect_flexes(model)
    for each, (low, high) in ((k, found.k), (c, found.c)):
        assert low * (1 - 1e-4) <= each.min()
        assert each.max() <= high * (1 + 1e-4)
        assert "box" in floor or each.min() == pytest.approx(low, rel=1e-4)
    message = lines_of(capsys, "inspect", path)
    assert message[0] == "This model has no contact of two geoms that can act."
    assert message[2].startswith(f"soft on floor: k = {found.k[0]:.4g}")
    path.write_text(path.read_text().replace("Euler", "discrete"))
    assert lines_of(capsys, "inspect", path)[3].startswith("For all of them: the integrator `discrete` takes energy")


def test_nobody_reads_on(model):
    """As where its output goes to `head`."""
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "mjrock", "inspect", str(model)]
    with os.fdopen(write, "wb") as pipe:
        done = subprocess.run(command, stdout=pipe, stderr=subprocess.PIPE, check=False)
    assert (done.returncode, done.stderr) == (0, b"")


def test_the_script_prints_the_table(tmp_path, capsys):
    path = tmp_path / "model.xml"
    path.write_text(scene(FLOOR, BALL, timestep=1e-5, options='cone="pyramidal" impratio="1"'))
    script.main([str(path), "--out", str(tmp_path / "out")])
    printed = capsys.readouterr().out
    assert printed == (tmp_path / "out" / "inspect_contacts.txt").read_text()
    assert "floor  ball  geoms  4.488e+04  4.488e+04       1895          2" in printed
    assert "2: the cone is pyramidal" in printed
    path.write_text(path.read_text().replace('size=".1" mass', 'type="box" size=".1 .1 .1" mass'))
    script.main([str(path), "--contacts", "1", "--out", str(tmp_path / "out")])
    assert "xi and e are those of a single one" in capsys.readouterr().out
    path.write_text("<mujoco/>")
    script.main([str(path), "--out", str(tmp_path / "out")])
    assert "no contact" in capsys.readouterr().out
    with pytest.raises(FileNotFoundError, match="is not a file"):
        script.main([str(tmp_path / "none.xml")])
