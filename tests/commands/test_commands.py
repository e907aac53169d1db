"""`mjrock COMMAND`: the help, exit statuses, output that cannot be written, and the examples."""

import importlib
import importlib.metadata
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import mjrock as mr
from mjrock.__main__ import COMMANDS, main
from mjrock.command_line import Answer, Status
from mjrock.commands import examples as examples_command

ROOT = Path(__file__).parents[2]
START = [sys.executable, "-m", "mjrock"]


def written(capsys, *arguments, status=0):
    """The lines of the standard output of a command."""
    assert main([str(argument) for argument in arguments]) == status
    return capsys.readouterr().out.splitlines()


def refused(capsys, *arguments):
    """What a command writes to the standard error that ends with the status 2 and writes nothing else."""
    assert main([str(argument) for argument in arguments]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    return printed.err


def test_without_arguments_there_is_the_help(capsys):
    lines = written(capsys)
    assert [line.split()[0] for line in lines if line.startswith("  ") and line.split()[0] in COMMANDS] == [*COMMANDS]
    assert lines == help_of(capsys)


def help_of(capsys, *command):
    """Lines of a help text."""
    with pytest.raises(SystemExit) as end:
        main([*command, "--help"])
    assert end.value.code == 0
    return capsys.readouterr().out.splitlines()


def test_help_fits_into_100_columns(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "300")
    texts = {name: help_of(capsys, name) for name in COMMANDS} | {"": help_of(capsys)}
    assert {name: line for name, lines in texts.items() for line in lines if len(line) > 100} == {}
    assert all(lines[0].startswith(f"usage: mjrock {name}".rstrip()) for name, lines in texts.items())


def test_the_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert (end.value.code, capsys.readouterr().out) == (0, f"mjrock {mr.__version__}\n")


def test_the_console_script_is_the_same_function():
    scripts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["scripts"]
    assert importlib.metadata.EntryPoint("mjrock", scripts["mjrock"], "console_scripts").load() is main


@pytest.fixture
def probe(monkeypatch):
    """A command that answers what a test gives it."""

    def answers(with_what):
        module = importlib.import_module(COMMANDS["status"].module, "mjrock")
        monkeypatch.setattr(module, "answer", with_what)

    return answers


def failing(error):
    """An answer that raises."""

    def answer(argv):
        raise error

    return answer


@pytest.mark.parametrize(
    ("error", "status", "message"),
    [
        (ValueError("height = 7"), 2, "error: height = 7\n"),
        (OSError(28, "No space left on device", "wall.csv"), 2, "error: wall.csv: No space left on device\n"),
        (ImportError("pip install weasyprint"), 2, "error: pip install weasyprint\n"),
        (mr.SimulationError("give a shorter step"), 2, "error: give a shorter step\n"),
        (KeyboardInterrupt(), 130, "mjrock: interrupted\n"),
        (KeyboardInterrupt("3 of 7 runs are kept"), 130, "mjrock: interrupted: 3 of 7 runs are kept\n"),
    ],
)
def test_the_exit_status_says_how_it_ended(error, status, message, probe, capsys):
    probe(failing(error))
    assert main(["status"]) == status
    printed = capsys.readouterr()
    assert (printed.out, printed.err) == ("", message)


@pytest.mark.parametrize("status", [Status.HOLDS, Status.FAILS])
def test_what_does_not_hold_is_no_error(status, probe, capsys):
    probe(lambda argv: Answer("0.87", status))
    assert written(capsys, "status", status=status) == ["0.87"]


def test_a_warning_is_a_line_without_a_place_in_the_package(probe, capsys, recwarn):
    probe(lambda argv: (recwarn and None) or warning())
    assert main(["status"]) == 0
    assert capsys.readouterr().err == "warning: the wall is thin\n"


def warning():
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning("the wall is thin", UserWarning, "code_check.py", 7)
    return Answer("done")


@pytest.mark.parametrize("arguments", [[], ["examples"]])
def test_a_full_disk_is_an_error(arguments):
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    with open("/dev/full", "wb") as full:
        done = subprocess.run([*START, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, "error: standard output: No space left on device\n")


def test_nobody_reads_on():
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "wb") as pipe:
        done = subprocess.run([*START, "examples"], stdout=pipe, stderr=subprocess.PIPE, check=False)
    assert (done.returncode, done.stderr) == (0, b"")


def test_examples_are_listed_with_their_titles(capsys):
    lines = written(capsys, "examples")
    assert len(lines) == 21 + 2
    assert lines[0].split(maxsplit=1) == ["01_release", "A wall released against its side stop"]
    assert lines[20].split(maxsplit=1) == ["21_terrace", "A block of a street"]


@pytest.mark.parametrize("name", ["7", "07", "push_over", "07_push_over", "07_push_over.py"])
def test_an_example_has_a_number_and_a_name(name):
    assert examples_command.example_named(name).path.name == "07_push_over.py"


def test_an_example_that_is_not_there_is_refused_with_those_that_are(capsys):
    message = refused(capsys, "examples", "bridge")
    assert message.startswith("error: there is no example 'bridge'; give a number from 1 to 21 or one of 01_release, ")


SCRIPT = '''"""
1. Squares
==========
"""

# %%
# Two pictures of one name.
from matplotlib.figure import Figure

figure = Figure()
print(f"{3**2}")

# %%
figure = Figure()

# %%
print(figure)
'''


@pytest.fixture
def squares(tmp_path, monkeypatch):
    """The only example there is, in an empty folder of its own."""
    (tmp_path / "examples").mkdir()
    (tmp_path / "here").mkdir()
    (tmp_path / "examples" / "01_squares.py").write_text(SCRIPT, encoding="utf-8")
    monkeypatch.setattr(examples_command, "FOLDER", tmp_path / "examples")
    monkeypatch.chdir(tmp_path / "here")
    return examples_command.example_named("squares")


def test_an_example_prints_draws_and_replaces_nothing_by_itself(squares, capsys):
    """Twice in a process. The error of its last line names that line."""
    for options in ([], ["--force"]):
        with pytest.raises(NameError, match="figure") as error:
            main(["examples", "squares", "-o", "two words", *options])
        assert error.traceback[-1].lineno + 1 == SCRIPT.count("\n")
        assert capsys.readouterr().out == "9\n"
        assert sorted(Path().rglob("*.*")) == [Path("two words") / f"01_squares_{i}.png" for i in (1, 2)]
    assert "01_squares_1.png: exists already, and --force" in refused(capsys, "examples", "1", "-o", "two words")


@pytest.mark.slow
def test_an_example_of_the_site_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    *_, last = written(capsys, "examples", "push_over")
    assert last == "written: 07_push_over_1.png, 07_push_over_2.png"
    assert all(path.stat().st_size > 5000 for path in tmp_path.iterdir())


def test_a_copy_of_an_example_is_its_script(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert written(capsys, "examples", "dome", "--copy") == ["written: 15_dome.py"]
    assert Path("15_dome.py").read_text(encoding="utf-8") == examples_command.example_named("15").text
    assert "15_dome.py: exists already" in refused(capsys, "examples", "dome", "--copy")
    assert written(capsys, "examples", "dome", "-c", "-f") == ["written: 15_dome.py"]


def test_the_demo_writes_a_model_a_table_and_a_picture(tmp_path, capsys):
    folder = tmp_path / "a façade"
    lines = written(capsys, "demo", "-o", folder)
    assert any(line.split()[:3] == ["1", "|", "0.7076"] for line in lines)
    assert {path.name for path in folder.iterdir()} == {"scene.xml", "comparison.csv", "comparison.png"}
    assert "scene.xml: exists already" in refused(capsys, "demo", "-o", folder)
