"""The wheel: what it holds, and that the README's Python runs from it, away from the checkout."""

import importlib.util
import re
import shutil
import site
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

import mjrock as mr

ROOT = Path(__file__).parents[2]
OFFLINE = ("No matching distribution", "Could not find a version", "Connection", "Temporary failure")
CHECKS = """

mr.plotting.animate(answer, "rock.gif", speed=0.5)
mr.plotting.save(mr.plotting.history(answer), "rock.png")


def build(scale):
    return mr.Analysis(mr.Case(wall, scale * wall.alpha, 1.0), "analytical", e=e)


if __name__ == "__main__":
    import sys
    from pathlib import Path

    import mjrock.engine.loop
    import mjrock.theory.arcs
    from mjrock.study.intensity.fragility import fit_fragility

    installed = Path(mr.__file__).resolve()
    mr.campaign(mr.Grid(build, scale=[0.2, 0.4]), "walls.sqlite")
    assert installed.is_relative_to(Path(sys.prefix).resolve()), installed
    assert mr.__version__ == {version!r}, mr.__version__
    assert {{law.name for law in (mr.CALIBRATED, mr.CALIBRATED_BED)}} == {{"CALIBRATED", "CALIBRATED_BED"}}
    assert (installed.parent / "py.typed").is_file()
    compiled = [value for value in vars(mjrock.theory.arcs).values() if hasattr(value, "signatures")]
    assert any(one.signatures for one in compiled), "no loop was compiled"
    assert Path("rock.gif").stat().st_size and Path("rock.png").stat().st_size and Path("walls.sqlite").stat().st_size
    print("all of it ran")
"""


def test_the_version_stands_in_one_place():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert "version" in project["dynamic"]
    assert "version" not in project
    assert (ROOT / "mjrock/_version.py").read_text().count(f'"{mr.__version__}"') == 1
    assert f"\nversion: {mr.__version__}\n" in (ROOT / "CITATION.cff").read_text()
    release = mr.__version__.split(".dev")[0]
    assert f"\n## {release}" in (ROOT / "CHANGELOG.md").read_text()


def run(*command, **options):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, **options)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built here where hatchling is installed, otherwise in an environment of pip's."""
    folder = tmp_path_factory.mktemp("wheel")
    here = ["--no-build-isolation"] if importlib.util.find_spec("hatchling") else []
    done = run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", *here, "--wheel-dir", folder, ROOT)
    if done.returncode and any(sign in done.stderr for sign in OFFLINE):
        pytest.skip("neither hatchling nor a registry to take it from")
    assert done.returncode == 0, done.stderr
    (made,) = folder.glob("*.whl")
    return made


def readme():
    """The Python of the README as one program."""
    return "\n\n".join(re.findall(r"(?s)```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8")))


def copy_loops(target):
    """Copy the compiled loops of this package to one that is installed in a folder."""
    for stored in (ROOT / "mjrock").rglob("__pycache__/*.nb?"):
        copy = target / stored.relative_to(ROOT)
        copy.parent.mkdir(exist_ok=True)
        shutil.copy(stored, copy)


def installed_here(folder):
    """The Python of an environment that sees the packages of this one, but for mjrock."""
    venv.create(folder, with_pip=False)
    python = folder / "bin" / "python"
    found = run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").stdout.strip()
    seen = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib"), *site.getsitepackages()}
    seen |= {path for path in sys.path if path.endswith("site-packages")}
    (Path(found) / "others.pth").write_text("\n".join(sorted(seen)))
    return python


@pytest.mark.slow
def test_the_wheel_holds_the_package_alone(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    tracked = {path.relative_to(ROOT).as_posix() for path in (ROOT / "mjrock").rglob("*") if path.is_file()}
    assert {name for name in names if name.startswith("mjrock/")} == {n for n in tracked if "__pycache__" not in n}
    rest = {name.split("/")[0] for name in names} - {"mjrock"}
    assert rest == {f"mjrock-{mr.__version__}.dist-info"}
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert {"mjrock/examples/07_push_over.py", "mjrock/assessment/templates.toml"} <= set(names)
    scripts = zipfile.ZipFile(wheel).read(f"mjrock-{mr.__version__}.dist-info/entry_points.txt").decode()
    assert "mjrock = mjrock.__main__:main" in scripts


@pytest.mark.slow
def test_the_readme_runs_from_the_wheel(wheel, tmp_path):
    """With packages of the registry, or with those of this environment where there is none.

    It takes along the loops that the checkout has stored, for their sources are the same. That loops are compiled where
    none are stored is a matter of test_compiled.
    """
    venv.create(tmp_path / "env", with_pip=False)
    python = tmp_path / "env" / "bin" / "python"
    pip = sys.executable, "-m", "pip", "--python", python  # of this environment, into the other one
    done = run(*pip, "install", "--quiet", "--no-compile", f"{wheel}[frames]")
    if done.returncode and any(sign in done.stderr for sign in OFFLINE):
        python = installed_here(tmp_path / "here")
        target = run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").stdout.strip()
        done = run(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", target, wheel)
    assert done.returncode == 0, done.stderr
    copy_loops(Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").stdout.strip()))
    (tmp_path / "away").mkdir()
    program = tmp_path / "away" / "readme.py"
    program.write_text(readme() + CHECKS.format(version=mr.__version__), encoding="utf-8")
    done = run(python, "-I", program, cwd=tmp_path / "away")
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("all of it ran\n")
