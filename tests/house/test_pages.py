"""The pages of the documentation and the README: their lines run as they stand, and print what they say."""

import importlib
import importlib.util
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from contextlib import redirect_stdout
from html import unescape
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mjrock as mr
from scripts.studies.thumbnails import THUMBNAILS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
EXAMPLES = ROOT / "mjrock" / "examples"
SMALL = DOCS / "figures" / "examples"
"""Small pictures of the examples."""
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n*```text\n(.*?)^```\n)?", re.DOTALL | re.MULTILINE)
"""Lines of Python, and what they print where the page shows it right below."""
NUMBER = re.compile(r"-?\d+(?:\.\d*)?(?:e[+-]?\d+)?")
RUNS = ["contacts_in_your_model.md", "stiffness.md", "damping.md", "solvers.md", "effects.md"]
RUNS += ["notebook.md", "own_effect.md", "own_law.md", "solved_cases.md"]
LONG = ["explicit.md", "tutorial.md", "analysis.md", "code_check.md", "masonry.md", "theory.md"]
LONG += ["assessment_file.md", "results.md", "mortar.md", "slow_loading.md", "wind_earth_axles.md", "town.md"]
LONG += ["plain_models.md", "your_files.md"]
"""Pages whose lines run."""
ELSEWHERE = ["own_code.md", "stacks_grippers_feet.md"]
"""Pages whose lines run in tests of their own, since they are parts of files."""


def blocks(page: Path) -> list[tuple[str, str | None]]:
    return [(code, text or None) for code, text in BLOCK.findall(page.read_text(encoding="utf-8"))]


def alike(printed: str, shown: str) -> bool:
    """Whether two texts differ by no more than one unit of the last digit of each number."""
    printed, shown = ("\n".join(map(str.rstrip, text.strip().splitlines())) for text in (printed, shown))
    if NUMBER.split(printed) != NUMBER.split(shown):
        return False
    for one, other in zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True):
        mantissa, _, exponent = other.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        if abs(float(one) - float(other)) > 1.001 * unit:
            return False
    return True


def run(page: Path, names: dict[str, object], most: int | None = None) -> list[tuple[str, str | None]]:
    """Run the lines of a page, or its first blocks; what each block printed, and what the page shows."""
    found = []
    for code, shown in blocks(page)[:most]:
        out = StringIO()
        with redirect_stdout(out):
            exec(compile(code, str(page), "exec"), names)
        found.append((out.getvalue(), shown))
    return found


LINK = re.compile(r"\[[^\]]*\]\(([^)#]+)[^)]*\)")


@pytest.mark.parametrize("name", [*RUNS, *(pytest.param(name, marks=pytest.mark.slow) for name in LONG)])
@pytest.mark.filterwarnings("ignore:CALIBRATED:UserWarning")
def test_the_lines_of_a_page_run_and_print_what_it_shows(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for printed, shown in run(DOCS / name, {}):
        assert (shown is None) == (printed == ""), printed
        assert alike(printed, shown or ""), f"{name} shows\n{shown}\nand its lines print\n{printed}"


def test_no_page_has_lines_that_nothing_runs():
    assert sorted(page.name for page in DOCS.glob("*.md") if blocks(page)) == sorted([*RUNS, *LONG, *ELSEWHERE])


@pytest.mark.slow
def test_the_cells_of_the_page_of_notebooks_show_what_it_says(tmp_path):
    """In a kernel of Jupyter: pictures, a table, and text where a cell ends in what has neither; no word of magic."""
    nbclient = pytest.importorskip("nbclient", reason="the extra test is not installed")
    pytest.importorskip("ipykernel", reason="the extra test is not installed")
    nbformat = pytest.importorskip("nbformat")
    page = blocks(DOCS / "notebook.md")
    cells = [nbformat.v4.new_code_cell(code) for code, _ in page]
    run_in = nbclient.NotebookClient(nbformat.v4.new_notebook(cells=cells), timeout=300)
    run_in.execute(cwd=str(tmp_path), env=os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])})
    shown = [next(one for one in cell.outputs if one.output_type == "execute_result").data for cell in cells]
    richest = [next(kind for kind in ("text/html", "image/png", "text/plain") if kind in data) for data in shown]
    table = ["image/png", "text/html", *5 * ["image/png"], "text/plain"]
    assert richest == table
    assert not [out for cell in cells for out in cell.outputs if "Warning" in str(out.get("text"))]


def test_numbers_are_compared_to_their_last_digit():
    assert alike("peak 0.24 alpha, 5e+08 N/m3", "peak 0.25 alpha, 5e+08 N/m3")
    assert not alike("peak 0.23 alpha", "peak 0.25 alpha")
    assert not alike("peak inf alpha", "peak 0.25 alpha")
    assert not alike("4e+08 N/m3", "6e+08 N/m3")
    assert not alike("at rest, peak 0.25", "overturned, peak 0.25")


def test_the_readme_is_short_its_six_lines_run_and_its_doors_open(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(readme.splitlines()) < 130
    ((code, shown),) = blocks(ROOT / "README.md")
    assert sum(1 for line in code.splitlines() if line and not line.startswith("import")) == 6
    ((printed, _),) = run(ROOT / "README.md", {})
    assert alike(printed, shown or "")
    start = readme[: readme.index("## Install and try it")]
    assert all(word in start for word in ("dry", "cracked", "mortared"))
    doors = {
        "Check a façade": "mjrock/examples/19_church_facade.py",
        "Model blocks": "docs/masonry.md",
        "Contacts for your MuJoCo model": "docs/contacts_in_your_model.md",
    }
    for door, page in doors.items():
        assert page in readme[readme.index(f"**{door}.**") :].split("\n\n")[0]
    named = {
        name for row in re.findall(r"^\|.*\|(.*)\|$", readme, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)
    }
    assert len(named) > 20
    assert named <= set(mr.__all__)


def test_what_the_readme_names_is_what_a_script_prints():
    """The count of blocks, the first impact, the granite walls, and the times of other codes."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (count,) = re.findall(r"façade of (\d+) blocks", readme)
    facade = (DOCS / "figures" / "facade_in_space.txt").read_text(encoding="utf-8")
    assert f"{count} blocks" in facade
    first, fallen = re.search(r"The first block falls after ([\d.]+) s; (\d+)\s", readme).groups()
    found = re.search(r"^(\d+) blocks fell, the first at ([\d.]+) s", facade, re.MULTILINE)
    assert (fallen, first) == (found[1], f"{float(found[2]):.1f}")
    theory, found = re.search(r"^ +1 \|.*?\| +(\S+) +(\S+) *\|", readme, re.MULTILINE).groups()
    output = " ".join(readme.split())
    assert f"{found} of the angular velocity is left after the first impact below, {theory} by theory" in output
    page = (DOCS / "compared_with_tests.md").read_text(encoding="utf-8")
    walls = re.findall(r"^\| WS\.\d+\D.*?\| [\d.]+ \| ([\d.]+) / ([\d.]+) \(", page, re.MULTILINE)
    assert len(walls) == 4
    for bore in zip(*walls, strict=True):
        assert "{}, {}, {} and {} kN".format(*bore) in output
    one_sided = (DOCS / "figures" / "peers.txt").read_text(encoding="utf-8").split("two-sided")[0]
    times = [
        float(row.split()[-1])
        for row in one_sided.splitlines()[3:]
        if "mjrock" not in row and row.split()[-1:] != ["reached"] and row
    ]
    low, high = min(times), max(times)
    assert f"in {low:.0f} to {high:.0f} times the time of mjrock" in output
    words = re.sub(r"```.*?```", "", readme, flags=re.DOTALL)
    assert re.findall(r"\d(?:\.\d+)? ?%|\d+ times", words) == ["1 %", f"{high:.0f} times"]


def test_the_readme_and_the_file_of_citation_say_the_same():
    readme, cited = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "CITATION.cff"))
    entry = dict(re.findall(r"^  (\w+) += \{+(.*?)\}+,?$", readme, re.MULTILINE))
    assert set(entry) - {"note"} == {"title", "author", "version", "year", "license"}
    for name in ("title", "version", "license"):
        assert re.search(rf"^{name}: \"?{re.escape(entry[name])}\"?$", cited, re.MULTILINE), name
    assert f'  - name: "{entry["author"]}"' in cited
    released = re.findall(r"^date-released: (\d+)", cited, re.MULTILINE)
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    if f"## {entry['version']} (unreleased)" in changes:
        assert (entry["note"], released) == ("not released yet", [])
    else:
        assert ("note" not in entry, released) == (True, [entry["year"]])


def test_a_film_is_there_for_every_browser_with_its_poster_and_is_light():
    films = sorted((DOCS / "figures").glob("*.mp4"))
    assert len(films) >= 5
    for film in films:
        others = [film.with_suffix(ending) for ending in (".mp4", ".webm", ".webp")]
        assert all(1e3 < one.stat().st_size < 0.9e6 for one in others), film
    assert [one.name for one in (DOCS / "figures").glob("*.gif")] == ["facade_in_space.gif"]  # GitHub plays it


def test_a_film_of_a_page_becomes_a_player_and_a_script_a_link(monkeypatch):
    pytest.importorskip("sphinx", reason="the extra docs is not installed; make docs installs it")
    monkeypatch.syspath_prepend(str(DOCS))
    made_pages = importlib.import_module("made_pages")
    film = "[![An arch](figures/arch.webp)](figures/arch.mp4)\n\n*It falls. `scripts/studies/animate.py`.*\n"
    shown = made_pages.made("any_page", film + "```text\n`scripts/studies/animate.py`\n```\n")
    attributes = re.search(r"<video ([^>]*)>", shown)[1]
    assert all(word in attributes.split() for word in ("controls", "loop", "muted", "playsinline"))
    assert 'poster="films/arch.webp"' in attributes
    assert re.findall(r'<source src="films/arch\.(\w+)" type="video/\1">', shown) == ["webm", "mp4"]
    assert '<a href="scripts/studies/animate.html"><code>scripts/studies/animate.py</code></a>' in shown
    assert "`scripts/studies/animate.py`" in shown.split("```text")[1]
    home = made_pages.made("index", (DOCS / "index.md").read_text(encoding="utf-8"))
    assert 'poster="films/facade_in_space.webp"' in home
    limits = made_pages.made("limitations", "[What it cannot do](../README.md#what-it-cannot-do)\n")
    assert "Blocks are rigid" in limits
    assert "## " not in limits


def test_a_page_reads_without_the_site():
    """In the repository no block of a page is a command to Sphinx, and the list of pages has all, by their titles."""
    texts = {page.stem: page.read_text(encoding="utf-8") for page in sorted(DOCS.glob("*.md"))}
    assert [name for name, text in texts.items() if "```{" in text] == []
    listed = dict(re.findall(r"^\* \[(.+)\]\((\w+)\.md\)$", texts.pop("index"), re.MULTILINE))
    titles = {re.match(r"# (.+)|\[(.+)\]\(", text).expand(r"\1\2"): name for name, text in texts.items()}
    assert listed == titles


def test_a_word_that_readers_look_for_leads_to_one_place(monkeypatch):
    pytest.importorskip("sphinx", reason="the extra docs is not installed; make docs installs it")
    monkeypatch.syspath_prepend(str(DOCS))
    made_pages = importlib.import_module("made_pages")
    words = [word for found in made_pages.searched().values() for word in found]
    assert len(words) == len(set(words)) > 300
    assert not [word for word in words if word != word.lower() or "," in word or ";" in word]
    for page in {place.partition("#")[0] for place in made_pages.searched()}:
        made_pages.indexed(page, (DOCS / f"{page}.md").read_text(encoding="utf-8"))
    with pytest.raises(ValueError, match=r"'faq#Which units[?]', .* no such heading"):
        made_pages.indexed("faq", "# Frequent questions\n")


def test_every_link_of_a_page_leads_somewhere():
    offenders = []
    for page in (ROOT / "README.md", *sorted(DOCS.glob("*.md"))):
        text = page.read_text(encoding="utf-8")
        for link in LINK.findall(text):
            if not link.startswith("http") and not (page.parent / link).exists():
                offenders.append(f"{page.name}: {link}")
        for script in re.findall(r"scripts/([\w/]+)\.py", text):
            if not (ROOT / "scripts" / f"{script}.py").exists():
                offenders.append(f"{page.name}: {script}")
    assert offenders == []


def test_lines_of_code_in_pages_have_80_columns():
    """But for XML, which stands as it is in a file."""
    offenders = [
        f"{page.name}: {line}"
        for page in sorted(DOCS.glob("*.md"))
        for code, _ in blocks(page)
        for line in code.splitlines()
        if len(line) > 80 and "<" not in line
    ]
    assert offenders == []


def test_every_picture_is_in_the_gallery():
    gallery = (DOCS / "gallery.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"\(figures/([\w/]+\.(?:png|mp4))\)", gallery))
    made = {
        str(one.relative_to(DOCS / "figures"))
        for one in (DOCS / "figures").rglob("*.*")
        if one.suffix in (".png", ".mp4") and one.parent != SMALL  # which the page of examples shows
    }
    assert shown >= made


def test_each_example_has_a_small_picture_of_its_own_that_is_filled_and_a_sentence_for_it():
    pictures = {}
    for name in (one.stem for one in EXAMPLES.glob("[0-9]*.py")):
        with Image.open(SMALL / f"{name}.png") as picture:
            pictures[name] = np.asarray(picture.convert("L").resize((80, 56))) < 230
    labels = [THUMBNAILS[name].label for name in pictures]
    assert {one.stem for one in SMALL.glob("*.png")} == pictures.keys()
    for drawn in pictures.values():
        rows, columns = (np.flatnonzero(drawn.any(axis=axis)) for axis in (1, 0))
        assert np.ptp(rows) > 0.5 * drawn.shape[0] or np.ptp(columns) > 0.7 * drawn.shape[1]
    for (_, one), (_, other) in itertools.combinations(pictures.items(), 2):
        assert (one & other).sum() < 0.8 * (one | other).sum()
    assert len(set(labels)) == len(labels)
    assert all(re.fullmatch(r"[A-Z][^.]*\w[^.]* [^.]*\.", label) for label in labels)


def test_a_picture_of_the_gallery_leads_to_the_page_that_explains_it(monkeypatch):
    pytest.importorskip("sphinx", reason="the extra docs is not installed; make docs installs it")
    monkeypatch.syspath_prepend(str(DOCS))
    made_pages = importlib.import_module("made_pages")
    monkeypatch.setattr(made_pages, "thumbnail", lambda figure: figure)
    text = (DOCS / "gallery.md").read_text(encoding="utf-8")
    cards = made_pages.gallery(text)
    assert cards.count("```{image}") == len(made_pages.PICTURE.findall(text))
    assert {f"{page}.md" for page in re.findall(r":target: (\w+)\.html", cards)} <= {
        page.name for page in DOCS.glob("*.md")
    }


def test_the_examples_are_a_numbered_course():
    scripts = sorted(EXAMPLES.glob("*.py"))
    texts = [script.read_text(encoding="utf-8").splitlines() for script in scripts]
    assert [int(script.name[:2]) for script in scripts] == list(range(1, 22))
    assert [int(lines[1].split(".")[0]) for lines in texts] == list(range(1, 22))
    assert not [line for lines in texts for line in lines if len(line) > 80]
    assert all(any(line.startswith("figure = ") for line in lines) for lines in texts)


def test_every_public_name_is_in_the_reference():
    reference = "\n".join(page.read_text(encoding="utf-8") for page in sorted((DOCS / "api").glob("*.md")))
    entry = r"^\.\. auto(?:class|function|data|exception):: mjrock\.(?:[a-z]+\.)*(\w+)$"
    listed = re.findall(entry, reference, re.MULTILINE)
    assert {name for name in mr.__all__ if not name.startswith("_")} <= set(listed)


@pytest.mark.slow
def test_the_church_example_goes_from_records_to_a_report(capsys):
    """Its capacities are found to a fifth, not to a twentieth: in fewer runs of the same lines."""
    text = (EXAMPLES / "19_church_facade.py").read_text(encoding="utf-8")
    assert text.count("tolerance=0.05") == 1
    names = {"__name__": "church"}
    exec(compile(text.replace("tolerance=0.05", "tolerance=0.2"), "19_church_facade.py", "exec"), names)
    assert [len(components) for components in names["records"].values()] == 8 * [2]
    T, target = names["periods"], names["spectrum"](names["periods"])
    for components in names["scaled"].values():
        means = [mr.response_spectrum(motion, T).Sa for motion in components]
        assert np.exp(np.log(np.sqrt(means[0] * means[1]) / target).mean()) == pytest.approx(1.0)
    checks, fits = names["checks"], names["fits"]
    assert checks["as it is"].linear_ratio < 1 < checks["bars, 100 mm"].linear_ratio
    assert checks["bars, 30 mm"].breaking["tie_0"] < checks["bars, 100 mm"].breaking["tie_0"]
    assert names["check_upper"].peak > names["spectrum"].peak
    assert fits["as it is"].median < fits["bars, 100 mm"].median
    page = names["report"].read_text(encoding="utf-8")
    assert all(
        f"{heading}" in page for heading in ("Answer</h2>", "Fragility", "The dynamic runs</h2>", "NTC 2018, 10.2")
    )
    assert [verdict.holds for verdict in names["dynamic"]["bars, 100 mm"].verdicts] == [True, True]
    assert not names["dynamic"]["as it is"].holds
    if importlib.util.find_spec("weasyprint"):
        from weasyprint import HTML

        assert len(HTML(names["report"]).render().pages) <= 8
    assert names["film"].stat().st_size > 1e5
    assert "capacity over that as it is" in capsys.readouterr().out


CLAIMS = {
    "01_release": "base e_2s = 0.970, side e_side = -0.470, together e_1s = -0.442",
    "02_facade_and_its_numbers": "and a gable: 49.4 t, centroid at 3.68 m, rocks from 0.081 g, falls from 0.081 rad",
    "03_soft_base": "5e+10 N/m3: |e| = 0.446 0.447 0.448 0.449",
    "04_two_polarities": "synthetic 6.5 m/s2, seed 1, reversed, analytical: at rest, peak 0.24 alpha",
    "05_ties_and_thrusts": "and a tie, analytical: at rest, peak 0.14 alpha",
    "06_friction_damper": "it slipped 586 mm in all and took 11716 J",
    "07_push_over": "as it is: starts at 0.143 g, peak 0.143 g, ends at 0.142 rad",
    "08_records_and_spectra": "synthetic 3 m/s2, seed 0 x 1.31764: peak 3.95 m/s2, Arias intensity 2.00 m/s",
    "09_fragility": "with a tie: median 0.60 g, dispersion 0.21",
    "10_column": "one cycle of 1.2 s: joints open by 205 0 0 0 0 mm, from the base upwards",
    "11_panel": "2.4 m long: 52 blocks, fails at 0.567 of its weight",
    "12_mortar": "5 of 70 joints crack, the first at 0.24 s",
    "13_arch": "1e+10 N/m3: the widest joint opens by 35 mm",
    "14_support_moves": "the arch has fallen when its support has moved by 648 mm",
    "15_dome": "0.3 m: stands",
    "16_facade_in_space": "inwards: 0.40 g",
    "17_heap": "how the wall ended: overturned",
    "18_contacts_in_mujoco": "k = 1e5 N/m, e = 0.5: rebounds to 0.118 m and rests 0.20 mm deep",
    "20_town": "soil C: 40% of the runs lean beyond 0.4 of overturning",
    "21_terrace": "tied in the middle: house by house it falls, stands, falls",
}
"""What an example prints of what its text is about, to one unit of the last digits."""
PRINTED = re.compile(r'class="sphx-glr-script-out.*?<pre>(.*?)</pre>', re.DOTALL)


def unlike_their_claims(site: Path) -> dict[str, list[str]]:
    """What the examples of a site print, of those that do not print what they claim."""
    found = {}
    for name, claim in CLAIMS.items():
        blocks = PRINTED.findall((site / "auto_examples" / f"{name}.html").read_text(encoding="utf-8"))
        lines = [line for block in blocks for line in unescape(re.sub(r"<[^>]*>", "", block)).splitlines()]
        if not any(alike(line, claim) for line in lines):
            found[name] = lines
    return found


def weight_of(site: Path, text: str) -> int:
    """Bytes that a browser loads for a page: its text, pictures, styles and scripts."""
    named = set(
        re.findall(r'<(?:img|script|link rel="(?:stylesheet|icon|preload)")[^>]*?(?:src|href)="([^"#?]+)', text)
    )
    return len(text.encode()) + sum((site / name).stat().st_size for name in named)


def not_found_first(site: Path) -> dict[str, object]:
    """Words of search.toml that are no main entry of their page in the index, which the search ranks above all else."""
    index = json.loads((site / "searchindex.js").read_text(encoding="utf-8")[len("Search.setIndex(") : -1])
    words = tomllib.loads((DOCS / "search.toml").read_text(encoding="utf-8"))
    places = {word: place.partition("#")[0] for place, found in words.items() for word in found}
    found = {
        word: [index["docnames"][page] for page, _, main in index["indexentries"].get(word, []) if main]
        for word in places
    }
    return {word: pages for word, pages in found.items() if pages != [places[word]]}


@pytest.mark.slow
def test_the_documentation_builds_without_a_warning_and_needs_no_network_to_be_read(tmp_path):
    pytest.importorskip("sphinx_gallery", reason="the extra docs is not installed; make docs installs it")
    source = tmp_path / "docs"
    shutil.copytree(DOCS, source, ignore=shutil.ignore_patterns("build", "auto_examples"))
    for name in ("README.md", "VERSIONING.md", "CITATION.cff"):  # pages of the site have their text
        shutil.copy(ROOT / name, tmp_path)
    shutil.copytree(ROOT / "scripts", tmp_path / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
    command = [sys.executable, "-m", "sphinx", "-b", "html", "-W", "--keep-going", "-q"]
    command += ["-D", r"sphinx_gallery_conf.filename_pattern=/(0|1[0-8]|2)"]  # the church has a test of its own above
    command += ["-d", str(tmp_path / "doctrees"), str(source), str(tmp_path / "html")]
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    found = subprocess.run(command, env=os.environ | {"PYTHONPATH": path}, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr[-4000:]
    pages = list((tmp_path / "html").rglob("*.html"))
    examples = {page.stem for page in EXAMPLES.glob("*.py")}
    assert examples <= {page.stem for page in pages}
    assert examples - CLAIMS.keys() == {"19_church_facade", "__init__"} & examples
    assert unlike_their_claims(tmp_path / "html") == {}
    assert not_found_first(tmp_path / "html") == {}
    course = (tmp_path / "html" / "auto_examples" / "index.html").read_text(encoding="utf-8")
    assert all(f'alt="{one.label}"' in course for one in THUMBNAILS.values())
    assert (tmp_path / "html" / "arch_view.html").stat().st_size > 5e5
    results = (tmp_path / "html" / "results.html").read_text(encoding="utf-8")
    assert '<iframe src="arch_view.html" loading="lazy"' in results
    assert (tmp_path / "html" / "theory.html").read_text(encoding="utf-8").count('display="block"') > 5
    home = (tmp_path / "html" / "index.html").read_text(encoding="utf-8")
    assert weight_of(tmp_path / "html", home) < 1.5e6
    assert 'property="og:image"' in home
    assert re.search(r'<code class="command .*><span class="pre">python</span> <span class="pre short">-m</span>', home)
    assert (tmp_path / "html" / "card.png").stat().st_size > 5e4
    gallery = (tmp_path / "html" / "gallery.html").read_text(encoding="utf-8")
    assert gallery.count("<img ") - gallery.count('<img loading="lazy"') <= 2  # the mark, and the first picture
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert not re.search(r"<(?:script|img)[^>]+src=.https?:|<link[^>]+href=.https?:", text), page
