"""Each figure of the pages is made by a script as it is now, and its record says which."""

import re
import threading
import tomllib

import numpy as np
import pytest
from PIL import Image

from scripts import figures
from scripts.shared import cli, figure_record

FOLDER = figure_record.ROOT / "docs" / "figures"


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository of one script, which imports another, and its folder of figures."""
    monkeypatch.setattr(figure_record, "ROOT", tmp_path)
    monkeypatch.setattr(figures, "ROOT", tmp_path)
    pages, studies = tmp_path / "docs" / "figures", tmp_path / "scripts" / "studies"
    pages.mkdir(parents=True)
    studies.mkdir(parents=True)
    (pages / figure_record.NAME).write_text("")
    (studies / "common.py").write_text("SIZE = 1\n\n\ndef wide():\n    return 2 * SIZE\n\n\ndef other():\n    pass\n")
    (studies / "curve.py").write_text('"""A curve."""\nfrom scripts.studies import common\nprint(common.wide())\n')
    return tmp_path


def made(repository, text="peak 1.5 m", name="curve.txt", options=()):
    """Let the script of the repository write a file into its folder of figures."""
    folder = repository / "docs" / "figures"
    arguments = [*options, "--out", str(folder)]
    with figure_record.recorded(repository / "scripts" / "studies" / "curve.py", arguments):
        cli.write_text(folder / name, text)
    return folder


def test_a_script_records_what_it_writes(repository):
    folder = made(repository)
    (row,) = tomllib.loads((folder / figure_record.NAME).read_text())["made"]
    assert (row["command"], row["files"]) == ("scripts/studies/curve.py", ["curve.txt"])
    assert figure_record.read(folder)["scripts/studies/curve.py"].files == ("curve.txt",)
    assert figure_record.stale(folder) == {}


def test_a_second_script_waits_until_the_first_has_written(repository):
    """Else the files of the first would be recorded as those of the second."""
    folder = repository / "docs" / "figures"
    second = threading.Thread(target=made, args=(repository,))
    with figure_record.recorded(repository / "scripts" / "studies" / "common.py", ["--out", str(folder)]):
        second.start()
        second.join(0.2)
        assert second.is_alive()
        cli.write_text(folder / "common.txt", "first")
    second.join()
    found = {command: one.files for command, one in figure_record.read(folder).items()}
    assert found == {"scripts/studies/common.py": ("common.txt",), "scripts/studies/curve.py": ("curve.txt",)}


CHANGES = {"print": "curve.py", "return 2": "common.py", "SIZE = 1": "common.py"}


@pytest.mark.parametrize("changed", CHANGES)
def test_a_figure_is_stale_once_its_script_or_what_it_uses_has_changed(repository, changed):
    folder, path = made(repository), repository / "scripts" / "studies" / CHANGES[changed]
    path.write_text(path.read_text().replace(changed, f"{changed}3"))
    assert figure_record.stale(folder) == {"scripts/studies/curve.py: the script has changed": ["curve.txt"]}
    figures.main(["curve", "--unchanged", "--folder", str(folder)])
    assert figure_record.stale(folder) == {}


def test_a_figure_does_not_depend_on_words_and_on_what_its_script_does_not_use(repository):
    folder, script = made(repository), repository / "scripts" / "studies" / "curve.py"
    text = script.read_text().replace("A curve.", "Another description,\n\nof two lines.")
    script.write_text(f"# A note\n\n{text}  # why\n")
    common = script.with_name("common.py")
    common.write_text(common.read_text().replace("pass", "return 3"))
    assert figure_record.stale(folder) == {}


def test_a_figure_without_a_script_or_a_file_is_named(repository):
    folder = made(repository)
    (folder / "drawn_by_hand.png").write_text("")
    (folder / "study.sqlite").write_text("")
    assert figure_record.stale(folder) == {"no script that is known": ["drawn_by_hand.png"]}
    (folder / "drawn_by_hand.png").unlink()
    (folder / "curve.txt").unlink()
    assert figure_record.stale(folder) == {"scripts/studies/curve.py: has written what is not here": ["curve.txt"]}
    (repository / "scripts" / "studies" / "curve.py").unlink()
    assert figure_record.stale(folder) == {"scripts/studies/curve.py: there is no such script": ["curve.txt"]}


def test_what_needs_a_folder_is_named_and_left(repository, capsys):
    folder = made(repository, options=("--records", str(repository)))
    assert str(repository) not in (folder / figure_record.NAME).read_text()
    figures.main(["--all", "--list", "--folder", str(folder)])
    assert "curve.py --records ... needs --records, a folder of recorded ground motions" in capsys.readouterr().out
    figures.main(["--all", "--list", "--folder", str(folder), "--records", str(repository)])
    assert f"scripts/studies/curve.py --records {repository} --out {folder}" in capsys.readouterr().out


def test_numbers_that_have_moved_are_printed(repository, capsys):
    made(repository, "peak 1.5 m, 30 of 40, 2e-3")
    made(repository, "peak 1.8 m, 30 of 40, 1e-3")
    printed = capsys.readouterr().out
    assert "curve.txt: 2 of 4 numbers have changed, most of all 0.002 to 0.001" in printed
    assert "last made on " in printed
    made(repository, "peak -0.0 m", name="zero.txt")
    made(repository, "peak +0.0 m", name="zero.txt")
    assert "zero.txt: the words alone have changed" in capsys.readouterr().out


def test_a_quick_study_is_not_a_figure(repository):
    with pytest.raises(ValueError, match=r"--quick: .* holds the figures of the pages; .* another --out"):
        made(repository, options=("--quick",))


def test_a_file_belongs_to_the_command_that_wrote_it_last(repository):
    made(repository)
    folder = made(repository, "again", options=("--whole",))
    assert list(figure_record.read(folder)) == ["scripts/studies/curve.py --whole"]


def test_every_figure_is_that_of_its_script():
    stale = figure_record.stale(FOLDER)
    names = sorted({re.findall(r"(\w+)\.py", why)[0] for why in stale if ".py" in why})
    remedy = f"look at: python scripts/figures.py {' '.join(names)}\nwhere the words of a script alone have changed: "
    assert not stale, "\n".join(
        [*(f"{why}: {', '.join(files)}" for why, files in stale.items()), f"{remedy}the same with --unchanged"]
    )


SCREENS = {"view.png", "viewer.png", "notebook.png"}
"""Pictures of a screen, which go on beyond their edges."""


def test_no_word_of_a_picture_is_cut_off_by_its_edge_and_none_is_half_empty():
    """At the edges nothing is dark. Rows and columns are empty in which nothing is darker than the ground of a view in
    space."""
    cut, empty = [], {}
    for path in sorted(FOLDER.glob("*.png")):
        with Image.open(path) as picture:
            grey = np.asarray(picture.convert("L"))
        rim = np.concatenate([grey[:2].ravel(), grey[-2:].ravel(), grey[:, :2].ravel(), grey[:, -2:].ravel()])
        cut += [path.name] if (rim < 150).any() and path.name not in SCREENS else []
        shares = [1 - (grey < 225).any(axis=axis).mean() for axis in (0, 1)]
        empty |= {path.name: shares} if max(shares) > 0.45 else {}
    assert cut == []
    assert empty == {}


def test_the_record_names_no_place_of_a_machine():
    text = (FOLDER / figure_record.NAME).read_text(encoding="utf-8")
    assert not re.search(r"/(?:home|tmp|root|work|Users)\b", text)
