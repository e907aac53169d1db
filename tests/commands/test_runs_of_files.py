"""`mjrock run`, `design`, and `report` with runs: what they write, carry on, and leave alone."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import mjrock as mr
from mjrock.__main__ import main
from mjrock.command_line import Status
from mjrock.quantities import ratio_text

WALL = """
side_stop = false
duration = 1.0
[wall]
thickness = "50 cm"
height = 4.0
"""
SITE = """
[site]
code = "EC8 type 1"
ag = "0.1 g"
soil = "A"
"""
PULSES = """
[records]
kind = "GroundMotion"
make = "half_sine"
amplitude = ["1.5 m/s2", "2 m/s2"]
duration = 0.4
"""
DESIGN = '[design]\nkey = "wall.thickness"\nvalues = ["{}", "{}"]\n'


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """A folder with a file in it, and the current folder another one."""
    (tmp_path / "walls").mkdir()
    (tmp_path / "walls" / "muro alto.toml").write_text(WALL + SITE + PULSES)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "walls"


FILE = "walls/muro alto.toml"


def printed(capsys, *arguments, status=Status.HOLDS):
    """The standard output of a command."""
    assert main([str(argument) for argument in arguments]) == status
    return capsys.readouterr().out


def refused(capsys, *arguments):
    """What a command writes to the standard error that ends with an error."""
    assert main([str(argument) for argument in arguments]) == Status.ERROR
    return capsys.readouterr().err


@pytest.mark.filterwarnings("ignore::mjrock.Implausible")
def test_a_run_writes_a_table_and_a_picture_beside_its_file(here, capsys):
    """The rows are those of the tasks in Python. Nothing is replaced by itself, and nothing is run twice."""
    message = printed(capsys, "run", FILE, "--no-film", "--workers", 1)
    assert {path.name for path in here.iterdir()} - {"muro alto_runs.sqlite.lock"} == {
        "muro alto.toml",
        "muro alto_largest.png",
        "muro alto_runs.csv",
        "muro alto_runs.sqlite",
    }
    (tasks,) = mr.from_toml(FILE).analyses().values()
    with (here / "muro alto_runs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["peak_over_alpha"]) for row in rows] == [task()["peak_over_alpha"] for task in tasks]
    assert [row["motion"] for row in rows] == [task.case.motion.name.replace(",", ";") for task in tasks]
    assert "dynamic: largest of all runs" in message
    assert "HOLDS" in message
    assert "muro alto_runs.csv: exists already" in refused(capsys, "run", FILE, "--no-film", "--workers", 1)
    assert main(["run", FILE, "--no-film", "--workers", "1", "--force"]) == Status.HOLDS
    again = capsys.readouterr()
    assert again.out == message
    assert "4 had a row before" in again.err


STACK = """
kind = "MasonryCase"
duration = 0.7
[masonry]
make = "stack"
k_n = 1e8
blocks = [{ thickness = 0.3, height = 1.2, length = 1.0 }]
"""


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mjrock.Implausible")
def test_masonry_under_records_has_the_verdict_of_its_runs(here, capsys):
    """That of the responses in Python, though a campaign has run them; a second call runs none again."""
    (here / "column.toml").write_text(STACK + SITE + PULSES.replace("1.5", "2.2").replace('"2 m', '"4 m'))
    assessment = mr.from_toml(here / "column.toml")
    ((task, *_),) = assessment.analyses().values()
    assert task.solver == "explicit"  # no solver is named
    (found,) = assessment.dynamic_check(assessment.run()).values()
    for _ in range(2):
        message = printed(
            capsys, "run", "walls/column.toml", "--no-film", "-w", 1, "--force", status=0 if found.holds else 1
        )
        table = message[message.index("mechanism ") :]
        for one in found.verdicts:
            assert f" {ratio_text(one.ratio)} " in table
        assert re.search(r"^record +ends +largest rotation \[rad\]$", message, re.MULTILINE)


@pytest.mark.filterwarnings("ignore::mjrock.Implausible")
def test_a_run_is_in_the_language_that_is_asked_for(here, capsys):
    message = printed(capsys, "run", FILE, "--no-film", "--workers", 1, "--language", "it")
    assert re.search(r"^accelerogramma +fine +rotazione massima su . \[-\]$", message, re.MULTILINE)
    assert "invertito" in message
    assert "media dei massimi" in message
    assert not re.search(r"HOLDS|FAILS|reversed|\d\.\d+ m$", message, re.MULTILINE)


@pytest.mark.slow
def test_a_film_is_that_of_the_largest_run(here, capsys):
    (here / "two.toml").write_text("theta0 = 0.05\nduration = 0.5\n" + "\n".join(
        f"[mechanisms.{name}.wall]\nthickness = {t}\nheight = 4.0" for name, t in (("thin", 0.5), ("thick", 1.0))
    ))  # fmt: skip
    message = printed(capsys, "run", "walls/two.toml", "-w", 1, "-o", "there")
    assert message.count("release") == 2
    names = {f"two_{name}_{end}" for name in ("thin", "thick") for end in ("runs.csv", "largest.png", "largest.gif")}
    assert names <= {path.name for path in Path("there").iterdir()}
    assert all((Path("there") / name).stat().st_size > 50 for name in names)


@pytest.mark.filterwarnings("ignore::mjrock.Implausible")
def test_records_are_found_beside_their_file_and_not_beside_the_caller(here, capsys):
    (here / "prove 2").mkdir()
    motion = mr.GroundMotion.synthetic(peak=1.5, duration=1.0, seed=1)
    motion.to_esm(here / "prove 2" / "IT.ST1..HNE.ASC", STATION_CODE="ST1", STREAM="HNE")
    (here / "recorded.toml").write_text(WALL + SITE + '[records]\nfolder = "prove 2"\npattern = "*.ASC"\n')
    message = printed(capsys, "run", "walls/recorded.toml", "--no-film", "-w", 1)
    assert message.count("ST1") >= 2
    (here / "elsewhere.toml").write_text(WALL + SITE + '[records]\nfolder = "walls"\n')
    assert refused(capsys, "run", "walls/elsewhere.toml").startswith("error: walls/elsewhere.toml")


def test_what_nothing_moves_is_not_run(here, capsys):
    (here / "still.toml").write_text(WALL + SITE)
    assert "still.toml has nothing to run: give it [records]" in refused(capsys, "run", "walls/still.toml")


@pytest.mark.parametrize(
    ("values", "status", "message", "italian"),
    [
        (("20 cm", "60 cm"), Status.HOLDS, "60 cm is the first of 2", "60 cm è il primo di 2 valori per cui ogni"),
        (
            ("20 cm", "21 cm"),
            Status.FAILS,
            "None of 2 values",
            "Nessuno dei 2 valori è verificato; il più vicino è",
        ),
    ],
)
def test_a_design_says_which_value_holds(values, status, message, italian, here, capsys):
    (here / "design.toml").write_text(WALL + SITE + DESIGN.format(*values))
    assert message in printed(capsys, "design", "walls/design.toml", status=status)
    assert italian in printed(capsys, "design", "walls/design.toml", "-l", "it", status=status)


def test_a_file_without_a_design_is_refused_with_the_remedy(capsys):
    assert "the file has no [design]; give it" in refused(capsys, "design", FILE)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mjrock.Implausible")
def test_a_report_has_the_runs_unless_they_are_left_out(here, capsys):
    for options, has_runs in (([], True), (["--no-runs", "--force"], False)):
        printed(capsys, "report", FILE, *options)
        page = (here / "muro alto.html").read_text(encoding="utf-8")
        assert ("Every run" in page) == has_runs


@pytest.mark.slow
def test_ctrl_c_is_one_line_and_the_same_call_carries_on(here):
    """No traceback, the status 130, and rows that are kept."""
    many = PULSES.replace('["1.5 m/s2", "2 m/s2"]', json.dumps([2 + 0.01 * i for i in range(200)]))
    run = '[contacts]\nk_base = 5e8\n[run]\nsolver = "MuJoCo"\ntimestep = 1e-5\n'
    (here / "many.toml").write_text(WALL + many + run)
    command = [sys.executable, "-m", "mjrock", "run", "walls/many.toml", "--workers", "1", "--no-film"]
    store = here / "many_runs.sqlite"
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    until = time.monotonic() + 120
    while time.monotonic() < until and not store.exists() and process.poll() is None:
        time.sleep(0.1)
    time.sleep(1.0)
    os.kill(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == Status.INTERRUPTED, err
    assert out == ""
    assert "Traceback" not in err
    assert "rows are kept, and the same call carries on from there" in err.splitlines()[-1]
    assert not (here / "many_runs.csv").exists()


ARCH = """
kind = "MasonryCase"
duration = 0.2
[masonry]
make = "arch"
radius = 2.0
thickness = 0.45
span_angle = "160 deg"
voussoirs = 5
k_n = 1e9
[supports]
right_abutment = [[0.0, 0.2], [0.0, 0.003], [0.0, 0.0]]
"""


def test_an_arch_whose_support_moves_is_a_file(here, capsys):
    """It is run and reported without a site, as what moves it says; the same as in Python."""
    (here / "arch.toml").write_text(ARCH)
    case = mr.from_toml(here / "arch.toml").mechanisms[""].problem
    assert [(one.block, one.dx) for one in case.supports] == [("right_abutment", (0.0, 0.003))]
    message = printed(capsys, "run", "walls/arch.toml", "--no-film", "-w", 1, "-l", "it")
    row = next(line for line in message.splitlines() if line.startswith("cedimento imposto"))
    found = mr.solve_explicit(case)
    assert float(row.split()[-1].replace(",", ".")) == pytest.approx(found.peak.max(), rel=1e-3)
    printed(capsys, "report", "walls/arch.toml")
    assert "right_abutment" in (here / "arch.html").read_text(encoding="utf-8")
