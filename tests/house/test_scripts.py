"""Every script runs in its quick mode, writes what it says, and meets bad input with an error and no traceback."""

import ast
import csv
import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import mujoco
import pytest
from trees import nodes

import mjrock as mr
from mjrock import plotting
from mjrock.plotting import animation, style
from scripts.paper import compare_wall
from scripts.shared import cli
from scripts.studies import in_the_browser, town
from scripts.studies.thumbnails import THUMBNAILS
from tests import page_figures

SCRIPTS = {path.stem: path for path in Path(__file__).parents[2].glob("scripts/*/*.py") if path.parent.name != "shared"}
"""Every script by its name."""


def film(stem):
    """The files of a film: for every browser, and its poster."""
    return {f"{stem}.{ending}" for ending in ("mp4", "webm", "webp")}


WRITES = {
    "animate": film("arch") | film("figure3"),
    "compare_wall": {"scene.xml", "comparison.png", "comparison.csv"},
    "figure3": {"figure3.png", "figure3.csv"},
    "table2": {"table2.png", "table2.csv"},
    "layouts": {"layouts.txt"},
    "friction": {"friction.txt"},
    "mass_scaling": {"mass_scaling.txt"},
    "hard_cases": {"hard_cases.md"},
    "trouble": {"trouble.txt"},
    "law_range": {"law_range.txt"},
    "work_precision": {"work_precision.csv", "work_precision.png", "work_precision.txt"},
    "records_accuracy": {f"records_accuracy.{ending}" for ending in ("png", "csv", "txt")},
    "peers": {"peers.csv", "peers.png", "peers.txt"},
    "masonry_precision": {f"masonry_precision.{ending}" for ending in ("png", "csv", "txt")},
    "convergence": {"convergence.png", "convergence.txt"},
    "make_models": {"figure3_one_sided"},
    "overturning_spectrum": {f"overturning_spectrum.{ending}" for ending in ("png", "csv", "txt", "sqlite")},
    "town": {f"town.{ending}" for ending in ("png", "csv", "txt", "sqlite")} | {"town_walls.csv"},
    "ida": {f"ida.{ending}" for ending in ("png", "csv", "txt", "sqlite")},
    "fragility": {f"fragility.{ending}" for ending in ("png", "csv", "txt", "sqlite")},
    "polarity": {f"polarity.{ending}" for ending in ("png", "csv", "txt", "sqlite")},
    "agreement": {f"agreement.{ending}" for ending in ("png", "csv", "txt", "sqlite")},
    "pushover": {f"pushover.{ending}" for ending in ("png", "csv", "txt")} | {"pushover_bases.png"},
    "cracked_facade": {f"cracked_facade.{ending}" for ending in ("png", "csv", "txt")},
    "drums": {f"drums.{ending}" for ending in ("png", "csv", "txt", "sqlite")},
    "capacity_bands": {"capacity_bands.txt"},
    "low_stop": {"low_stop.txt"},
    "limit_analysis": {f"limit_analysis.{ending}" for ending in ("png", "csv", "txt")},
    "slow_push": {f"slow_push.{ending}" for ending in ("png", "csv", "txt")},
    "tilting_table": {"tilting_table.csv", "tilting_table.txt"},
    "mortar": {"mortar.csv", "mortar.txt", "mortar_lines.csv", "mortar_lines.txt"},
    "bonded_facade": {f"bonded_facade.{ending}" for ending in ("png", "csv", "txt")},
    "sliding": {"sliding.png", "sliding.txt"},
    "heap": {"heap.png", "heap.txt"},
    "thrust_lines": {"thrust_lines.png", "thrust_lines.txt"},
    "granite_variants": {"granite_variants.csv", "granite_variants.txt"},
    "granite_walls": {f"granite_walls.{ending}" for ending in ("png", "csv", "txt")},
    "many_blocks": {f"many_blocks.{ending}" for ending in ("png", "csv", "txt")},
    "many_records": {f"many_records.{ending}" for ending in ("png", "csv", "txt")},
    "joint_stiffness": {f"joint_stiffness.{ending}" for ending in ("png", "csv", "txt")},
    "collapse": {"collapse.csv", "collapse.txt"},
    "plain_masonry": {f"plain_masonry.{ending}" for ending in ("png", "csv", "txt")},
    "plain_models": {f"plain_models.{ending}" for ending in ("png", "csv", "txt")},
    "in_the_viewer": {"viewer.png"},
    "in_the_browser": {"view.png"},
    "in_the_notebook": {"notebook.png"},
    "plain_throughput": {"plain_throughput.txt"},
    "rebound_phase": {"rebound_phase.txt"},
    "warp_throughput": {"warp_throughput.txt"},
    "second_opinion": {f"second_opinion.{ending}" for ending in ("png", "csv", "txt")},
    "opened_in_vtk": {"opened_in_vtk.txt"},
    "drawn_in_space": {"drawn_in_space.png", "drawn_in_space.txt"},
    "two_storeys": {f"two_storeys.{ending}" for ending in ("png", "csv", "txt")} | film("two_storeys_falls"),
    "columns_in_space": {f"columns_in_space.{ending}" for ending in ("png", "csv", "txt")}
    | {"columns_under_records.png"},
    "solvers_of_masonry": {f"solvers_of_masonry.{ending}" for ending in ("png", "csv", "txt")},
    "four_solvers": {"four_solvers.csv", "four_solvers.txt", "shear_stiffness.csv", "shear_stiffness.png"},
    "facade_in_space": {f"facade_in_space.{ending}" for ending in ("png", "gif", "csv", "txt")}
    | film("facade_in_space"),
    "corner_block": {f"corner_block.{ending}" for ending in ("png", "csv", "txt")},
    "law_in_space": {f"law_in_space.{ending}" for ending in ("png", "csv", "txt")},
    "dome": {f"dome.{ending}" for ending in ("png", "csv", "txt")},
    "stack_losses": {f"stack_losses.{ending}" for ending in ("png", "csv", "txt")},
    "arching": {f"arching.{ending}" for ending in ("png", "csv", "txt")},
    "shear_wall": {f"shear_wall.{ending}" for ending in ("png", "csv", "txt")},
    "limestone_blocks": {f"limestone_blocks.{ending}" for ending in ("png", "csv", "txt")},
    "restitution_spread": {f"restitution_spread.{ending}" for ending in ("png", "csv", "txt")},
    "cracked_damping": {f"cracked_damping.{ending}" for ending in ("png", "csv", "txt")},
    "maxima": {f"maxima.{ending}" for ending in ("png", "csv", "txt")},
    "other_codes": {f"other_codes.{ending}" for ending in ("png", "csv", "txt", "sqlite")}
    | {"other_codes_choices.png"},
    "shaken_wall": {f"shaken_wall.{ending}" for ending in ("png", "csv", "txt")},
    "panel": {f"panel.{ending}" for ending in ("png", "csv", "txt")},
    "effect_costs": {f"effect_costs.{ending}" for ending in ("png", "csv", "txt")},
    "facade": {"facade.png", "facade.txt"},
    "vaults": {"vaults.png", "vaults.txt"},
    "thumbnails": {f"{name}.png" for name, one in THUMBNAILS.items() if not one.run},
    "which_call": {"which_call.png"},
    "check_in_one_picture": {"check_in_one_picture.png", "check_in_one_picture.txt"},
    "mechanisms": {"mechanisms.png", "mechanisms.txt", "axle.png"},
    "your_geometry": {"your_geometry.png", "your_geometry.txt"},
    "result_files": {"result_files.csv", "result_files.txt"},
    "throughput": {"throughput.txt"},
    "first_minute": {"first_minute.csv", "first_minute.txt"},
    "own_laws": {"own_laws.csv", "own_laws.txt"},
    "form_times": {"form_times.csv", "form_times.txt"},
    "stack_before_and_after": film("stack_before_and_after") | {"stack_before_and_after.txt"},
    "stacks_grippers_feet": {"stacks_grippers_feet.txt"},
    "four_masses": {f"four_masses.{ending}" for ending in ("png", "csv", "txt")},
    "rocking_by_the_guide": {"rocking_by_the_guide.csv", "rocking_by_the_guide.txt"},
    "rest_on_processors": {"rest_on_processors.txt"},
    "requested_and_found": {"requested_and_found.csv", "requested_and_found.txt"},
    "inspect_contacts": {"inspect_contacts.txt"},
    "fragility_coverage": {"fragility_coverage.txt"},
    "sensitivity": {f"sensitivity.{ending}" for ending in ("png", "txt", "sqlite")},
    "sketch": {"sketch.png"},
    "first_pictures": {"effects.png", "tutorial.png", "record.png", "design.png"},
    "speed": {"speed.txt"},
    "setup_cost": {"setup_cost.csv", "setup_cost.txt"},
    "step_cost": {f"step_cost.{ending}" for ending in ("png", "csv", "txt")},
    "thresholds": {"thresholds.txt"},
    "damping_figures": {"damping_corners.png", "damping_figures.sqlite", "damping_figures.txt"},
    "calibrate": {"calibrated.toml", "calibrated_residuals_base.png"}
    | {"calibrated_residuals_side.png", "calibration.csv", "calibration.sqlite", "calibration.txt"},
    "validate_contacts": {"validate_contacts.csv", "validate_contacts.txt"},
    "validate_law": {f"damping_validation.{ending}" for ending in ("png", "sqlite", "txt")} | {"table2_laws.csv"},
}


def test_no_script_is_forgotten():
    assert set(SCRIPTS) == set(WRITES)


@pytest.mark.parametrize(
    "name", [name for name, files in WRITES.items() if any(file.endswith(".mp4") for file in files)]
)
def test_a_script_without_ffmpeg_refuses_films_before_it_runs(name, tmp_path, monkeypatch):
    monkeypatch.setattr(animation.MovieWriter, "isAvailable", classmethod(lambda cls: False))
    script = importlib.import_module(f"scripts.{SCRIPTS[name].parent.name}.{name}")
    with pytest.raises(RuntimeError, match=r"films need the program ffmpeg.*\[docs\]"):
        script.main(["--quick", "--out", str(tmp_path / "out")])
    assert not (tmp_path / "out").exists()


PATCHING = {"mock", "patch", "setattr", "delattr", "vars", "monkeypatch", "cache_clear", "__dict__", "__setattr__"}
"""Names by which the inside of an object or a module is replaced."""


def patches(every):
    """Lines of a script, of all nodes of its tree, that replace something inside the package."""
    imports = [node for node in every if isinstance(node, ast.Import | ast.ImportFrom)]
    ours = {"mjrock"} | {
        alias.asname or alias.name
        for node in imports
        for alias in node.names
        if (getattr(node, "module", None) or alias.name).split(".")[0] == "mjrock"
    }
    found = {node.lineno for node in imports for alias in node.names if alias.name in PATCHING}
    for node in every:
        name = node.id if isinstance(node, ast.Name) else getattr(node, "attr", None)
        if name in PATCHING:
            found.add(node.lineno)
        if isinstance(node, ast.Attribute | ast.Subscript) and not isinstance(node.ctx, ast.Load):
            while isinstance(node, ast.Attribute | ast.Subscript):
                node = node.value
            if isinstance(node, ast.Name) and node.id in ours:
                found.add(node.lineno)
    return sorted(found)


def test_no_script_patches_the_package():
    paths = sorted(Path(__file__).parents[2].glob("scripts/**/*.py"))
    assert len(paths) > 70
    assert {path.stem: found for path in paths if (found := patches(nodes(path)))} == {}


PATCHES = [
    "mr.GRAVITY = 1.6",
    "explicit.time = None",
    "mr.plotting.style.COLOURS['wall'] = 'red'",
    "del explicit.time",
    "setattr(explicit, 'time', None)",
    "vars(scene)['found'] = None",
    "scene.__dict__['found'] = None",
    "object.__setattr__(scene, 'title', '')",
    "with mock.patch.object(explicit, 'time', None): pass",
    "from unittest import mock",
    "standing.cache_clear()",
]


def nodes_of(text):
    """All nodes of a text."""
    return [*ast.walk(ast.parse(text))]


def test_a_patch_is_found():
    start = "import mjrock as mr\nfrom mjrock.distinct import explicit\n"
    assert [patch for patch in PATCHES if patches(nodes_of(start + patch)) != [3]] == []
    assert patches(nodes_of(start + "model.opt.gravity[2] = 0.0\nspec.time = 1.0")) == []


def unreadable(every):
    """Lines of a script, of all nodes of its tree, that draw too wide, too small or in Matplotlib's colours, or that
    save in another way."""
    found = set()
    for node in every:
        if isinstance(node, ast.keyword) and isinstance(node.value, ast.Tuple) and node.arg == "figsize":
            wide = node.value.elts[0]
            found |= {wide.lineno} if isinstance(wide, ast.Constant) and wide.value > style.WIDEST else set()
        if isinstance(node, ast.keyword) and node.arg in ("fontsize", "title_fontsize", "labelsize"):
            size = node.value
            found |= {size.lineno} if isinstance(size, ast.Constant) and size.value < page_figures.SMALLEST else set()
        if isinstance(node, ast.JoinedStr) and isinstance(node.values[0], ast.Constant) and node.values[0].value == "C":
            found.add(node.lineno)
        if isinstance(node, ast.Constant) and re.fullmatch(r"C\d\W*\w?\W*|tab:\w+", str(node.value)):
            found.add(node.lineno)
        if isinstance(node, ast.Attribute) and node.attr == "savefig":
            found.add(node.lineno)
    return sorted(found)


def test_scripts_draw_what_a_page_shows_well():
    """The quick runs below find the rest, as figures are saved."""
    paths = sorted(Path(__file__).parents[2].glob("scripts/**/*.py"))
    assert {path.stem: lines for path in paths if (lines := unreadable(nodes(path)))} == {}


def test_what_a_page_does_not_show_well_is_found():
    lines = ["Figure(figsize=(9, 3))", "ax.legend(fontsize=7)", 'ax.plot(x, "C0--")', 'ax.plot(x, color=f"C{i}")']
    lines += ['ax.plot(x, color="tab:red")', "figure.savefig(path)", 'ax.plot(x, "C3o")']
    assert [line for line in lines if unreadable(nodes_of(line)) != [1]] == []
    assert unreadable(nodes_of('Figure(figsize=(7.4, 9))\nax.legend(fontsize=8)\nax.set_title("C30 concrete")')) == []


def main_of(name):
    return importlib.import_module(f"scripts.{SCRIPTS[name].parent.name}.{name}").main


LONG = {
    "speed",
    "step_cost",
    "thresholds",
    "throughput",
    "calibrate",
    "damping_figures",
    "work_precision",
    "records_accuracy",
    "validate_law",
    "fragility",
} | {
    "sensitivity",
    "step_cost",
    "capacity_bands",
    "low_stop",
    "limit_analysis",
    "fragility_coverage",
    "agreement",
    "polarity",
    "town",
    "overturning_spectrum",
    "ida",
    "effect_costs",
    "peers",
    "other_codes",
    "cracked_facade",
    "granite_walls",
    "granite_variants",
    "drums",
    "panel",
    "masonry_precision",
    "stack_losses",
    "convergence",
    "validate_contacts",
    "pushover",
    "layouts",
    "friction",
    "figure3",
    "trouble",
    "animate",
    "sliding",
    "solvers_of_masonry",
    "four_solvers",
    "facade_in_space",
    "corner_block",
    "law_in_space",
    "dome",
    "many_blocks",
    "many_records",
    "joint_stiffness",
    "two_storeys",
    "columns_in_space",
    "arching",
    "slow_push",
    "opened_in_vtk",
    "drawn_in_space",
    "limestone_blocks",
    "cracked_damping",
    "restitution_spread",
    "shaken_wall",
    "vaults",
    "mechanisms",
    "bonded_facade",
    "first_pictures",
    "stack_before_and_after",
    "heap",
    "mortar",
    "tilting_table",
    "table2",
    "thrust_lines",
    "facade",
    "shear_wall",
    "first_minute",
    "collapse",
    "plain_masonry",
    "plain_models",
    "second_opinion",
    "in_the_viewer",
    "in_the_browser",
    "in_the_notebook",
    "plain_throughput",
    "rebound_phase",
    "rest_on_processors",
    "form_times",
    "stacks_grippers_feet",
    "rocking_by_the_guide",
    "make_models",
    "own_laws",
    "result_files",
    "maxima",
}
"""Scripts that take a while even with --quick."""


WITHIN = {
    *("agreement", "calibrate", "drums", "fragility", "ida", "other_codes", "overturning_spectrum", "polarity"),
    *("sensitivity", "town", "validate_law"),
}
"""Scripts whose campaigns start no workers here; those of throughput do, and kill one."""


def require_pictures_of_mujoco():
    """Skip where MuJoCo cannot draw without a display."""
    try:
        mujoco.Renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8).close()
    except Exception as error:
        pytest.skip(f"MuJoCo does not draw here: {error}")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in LONG else name for name in WRITES]
)
def test_quick(name, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(plotting, "save", page_figures.save)
    if name in ("opened_in_vtk", "drawn_in_space"):
        pytest.importorskip("pyvista", reason="the extra docs is not installed")
    if name in ("in_the_browser", "in_the_notebook") and in_the_browser.BROWSER is None:
        pytest.skip("no Chromium on this machine")
    if name == "in_the_viewer":
        require_pictures_of_mujoco()
    workers = ["--workers", "1"] if name in WITHIN else []
    main_of(name)(["--quick", *workers, "--out", str(tmp_path / "deep" / "er")])
    written = {p.name for p in (tmp_path / "deep" / "er").iterdir() if p.suffix != ".lock"}
    assert written == WRITES[name]
    if name != "make_models":
        assert capsys.readouterr().out.strip()


def test_help(capsys):
    offenders = []
    for name in WRITES:
        with pytest.raises(SystemExit) as stop:
            main_of(name)(["--help"])
        printed = capsys.readouterr().out
        message = all(part in printed for part in ("--out", "(default:")) and not re.search("None|False", printed)
        if stop.value.code != 0 or not message:
            offenders.append(name)
    assert offenders == []


def test_the_saved_scene_is_the_one_that_ran(tmp_path, one_sided, contacts):
    compare_wall.main(["--law", "published", "--out", str(tmp_path)])
    step = mr.simulate(one_sided, contacts).stats["timestep"]
    assert (tmp_path / "scene.xml").read_text() == mr.wall_mjcf(one_sided, contacts, step)
    with open(tmp_path / "comparison.csv") as file:
        assert float(next(csv.DictReader(file))["restitution analytical [-]"]) == pytest.approx(0.442223)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--thickness", "600"], "thickness = 600 m is outside the valid range"),
        (["--k-base", "500"], "k_base = 500 N/m3"),
        (["--release", "30"], "theta0 = 4.25691 rad is outside the valid range"),
        (["--lumped", "0.4"], "lumped restitution = 0.4"),
        (["--timestep", "-1"], "timestep = -1 s"),
        (["--law", "mine.toml"], "mine.toml"),
        (["--law", "nope"], "law = 'nope' is not one of published, calibrated, calibrated-bed"),
        (["--out", "/dev/null/here"], "Not a directory"),
    ],
)
def test_bad_input_is_an_error_without_a_traceback(options, complaint, tmp_path, monkeypatch, capsys):
    out = [] if "--out" in options else ["--out", str(tmp_path / "out")]
    monkeypatch.setattr(sys, "argv", ["compare_wall.py", *options, *out])
    assert cli.run(compare_wall.main) == 2
    printed = capsys.readouterr()
    assert complaint in printed.err
    assert printed.out == ""


@pytest.mark.slow
def test_an_error_ends_the_process_with_its_code(tmp_path):
    command = [sys.executable, str(SCRIPTS["compare_wall"]), "--timestep", "-1", "--out", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout) == (2, "")
    assert run.stderr.startswith("error: timestep = -1 s")
    assert "Traceback" not in run.stderr


def test_a_full_disk_leaves_the_old_file_whole(tmp_path, monkeypatch):
    target = cli.write_text(tmp_path / "table.csv", "old")

    def full(descriptor):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        cli.write_text(target, "new")
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_the_table_of_the_town_is_drawn_by_its_seed():
    """Lines of the table in docs/figures, and those of the first walls of any number."""
    table = (Path(mr.__file__).parents[1] / "docs" / "figures" / "town_walls.csv").read_text(encoding="utf-8")
    assert cli.csv_text(town.COLUMNS, town.drawn()) == table
    assert town.drawn(count=20) == town.drawn()[:20]
