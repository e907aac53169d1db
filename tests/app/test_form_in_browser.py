"""The form in a real browser: an engineer fills it in Italian for a gable with a tie and takes the report."""

import json
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from contextlib import contextmanager

import pytest
from chromium import BROWSER, Browser

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(BROWSER is None, reason="no Chromium on this machine"),
    pytest.mark.skipif(sys.platform == "win32", reason="the pipe to the browser needs a shell of POSIX"),
]
VERDICT = "document.querySelector('#verdict .holds, #verdict .fails, #verdict .part')"
NASTY = "<script>document.title = 'taken'</script><img src=x onerror=\"document.title = 'taken'\">"
COLUMN = """
kind = "MasonryCase"
duration = 10000
[masonry]
make = "column"
width = 1.0
height = 2.0
drums = 2
k_n = 1e9
[run]
solver = "explicit"
[motion]
make = "sine"
amplitude = 1.0
period = 1.0
cycles = 50
"""
"""A run that takes long, without a site that it is checked against."""
TIE = {
    "height": "2,3",
    "diameter": "20 mm",
    "yield_stress": "235 MPa",
    "length": "8",
    "plate": "30 cm",
    "thickness": "50 cm",
    "shear_strength": "30 kPa",
    "compressive_strength": "1,5 MPa",
}


@contextmanager
def served():
    command = [sys.executable, "-m", "mjrock", "app", "--no-browser"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process, process.stderr.readline().split()[-1]
        finally:
            process.terminate()


@pytest.fixture(scope="module")
def address():
    with served() as (_, place):
        yield place


@contextmanager
def form(address, **options):
    with Browser(**options) as page:
        page.open(address)
        page.wait("document.querySelector('#form fieldset')")
        yield page


def checked(page, change):
    """Make a change, and wait for its check."""
    change()
    page.wait("!document.getElementById('verdict').classList.contains('busy')")


def begun(page, template):
    checked(page, lambda: page.choose("template", template))


def opened(page, text):
    """Open a file in the form."""
    path = os.path.join(page.folder.name, "opened.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    page.upload("#file", path)


def choose_variant(page, place, text):
    """Choose what a table stands for by a part of its name."""
    select = f"document.getElementById({json.dumps(place)}).querySelector('select')"
    value = f"[...e.options].find(one => one.text.includes({json.dumps(text)})).value"
    page.run(f"(e => {{ e.value = {value}; e.dispatchEvent(new Event('change')); }})({select})")


def children_of(process):
    """The processes that a process has started."""
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process)], capture_output=True, text=True, check=False)
    return [int(pid) for pid in found.stdout.split()]


def lives(process, seconds=10):
    """Whether a process still runs after some time; one that has ended and waits for its parent does not."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, check=False)
        if found.stdout.strip() in ("", "Z", "Z+"):
            return False
        time.sleep(0.1)
    return True


def test_a_gable_with_a_tie_in_italian_ends_in_a_pdf(address, tmp_path):
    pytest.importorskip("weasyprint")
    with form(address, language="it") as page:
        assert page.run("document.documentElement.lang") == "it"
        begun(page, "gable")
        message = page.run("document.getElementById('at/wall/thickness/help').innerText")
        assert message == "da 0,002 a 20 m; spessore 2b alla base"
        before = page.run("document.getElementById('to-results').textContent")
        count = page.run("document.querySelectorAll('#form fieldset').length")
        page.click("document.getElementById('at/effects')")
        assert page.run("document.querySelectorAll('#form fieldset').length") == count + 1
        last = page.run("[...document.querySelectorAll('[id^=\"at/effects/\"]')].map(e => e.id.split('/')[2]).at(-1)")
        choose_variant(page, f"at/effects/{last}", "catena: di barra con capochiave")
        for key, text in TIE.items():
            page.fill(f"at/effects/{last}/{key}", text)
        checked(page, lambda: page.fill(f"at/effects/{last}/height", TIE["height"]))
        assert page.run("[...document.querySelectorAll('.fault')].map(e => e.innerText)") == []
        words = page.run("document.getElementById('verdict').innerText")
        assert "VERIFICATO" in words
        assert "C8.7.1.2.1" in words
        assert page.run("document.getElementById('to-results').textContent") != before
        assert page.wait("document.querySelector('#sketches img').naturalWidth") > 300
        page.click("document.getElementById('report')")
        name, content = page.downloaded(120)
        assert (name, content[:5]) == ("mjrock.pdf", b"%PDF-")
        page.click("document.getElementById('save')")
        name, text = page.downloaded()
        tables = tomllib.loads(text.decode())
        assert tables["effects"][-1] == {"kind": "Tie", "make": "of_bar", "height": 2.3, "length": 8} | {
            key: value.replace(",", ".") for key, value in TIE.items() if key not in ("height", "length")
        }
        assert tables["language"] == "it"
        assert page.errors == []
        assert {one for one in page.requested if not one.startswith((address, "data:", "blob:"))} == set()
    if shutil.which("pdftotext"):
        path = tmp_path / "report.pdf"
        path.write_bytes(content)
        printed = subprocess.run(["pdftotext", path, "-"], capture_output=True, text=True, check=True).stdout
        assert "Esito" in printed
        assert "catena" in printed


def test_what_is_wrong_is_said_at_its_field_and_in_the_list(address):
    with form(address) as page:
        begun(page, "gable")
        checked(page, lambda: page.fill("at/wall/thickness", "-3"))
        message = page.run(
            "document.getElementById('at/wall/thickness').closest('.field').querySelector('.fault').innerText"
        )
        assert "0.002 to 20 m" in message
        assert page.run("document.getElementById('at/wall/thickness').getAttribute('aria-invalid')") == "true"
        page.click("document.querySelector('#verdict a')")
        assert page.run("document.activeElement.id") == "at/wall/thickness"
        checked(page, lambda: page.fill("at/wall/thickness", "50 cm"))
        assert page.run("document.querySelectorAll('.fault, [aria-invalid]').length") == 0


def test_a_refusal_is_italian_in_the_italian_form(address):
    with form(address, language="it") as page:
        begun(page, "gable")
        checked(page, lambda: page.fill("at/wall/thickness", "-3"))
        message = "wall.thickness = -3 m è fuori dall'intervallo valido da 0,002 a 20 m"
        assert page.run("[...document.querySelectorAll('.fault, #verdict a')].map(e => e.innerText)") == [
            message,
            message,
        ]
        checked(page, lambda: page.fill("at/wall/thickness", "30 kg"))
        assert "ha l'unità kg, mentre è richiesto un numero in m" in page.run(
            "document.querySelector('.fault').innerText"
        )


def test_a_corner_on_a_phone_in_italian_and_in_the_dark(address):
    with form(address, size=(390, 844), dark=True, language="it") as page:
        begun(page, "corner")
        page.wait("document.querySelector('#sketches img')?.naturalWidth")
        assert page.run("document.querySelector('#form legend + .row select').selectedOptions[0].text") == (
            "cantonata che ribalta"
        )
        bar = page.run("document.getElementById('to-results').textContent")
        assert page.run("document.querySelector('#verdict p span').textContent") in bar  # one word in both
        box = page.run("JSON.stringify(document.getElementById('to-results').getBoundingClientRect())")
        assert json.loads(box)["bottom"] == 844
        page.click("document.getElementById('to-results')")
        assert page.run("document.getElementById('verdict').getBoundingClientRect().top") < 844
        assert page.run("document.documentElement.scrollWidth") <= 390
        names = page.run(
            "[...document.querySelectorAll('[id^=\"at/project/\"]')].map(e => e.closest('.field').innerText)"
        )
        assert [name.partition("\n")[0] for name in names[::2]] == [
            "Opera",
            "Committente",
            "Progettista",
            "Data",
            "Luogo",
        ]
        image = "document.querySelector('#sketches img')"
        assert "invert" in page.run(f"getComputedStyle({image}).filter")
        checked(page, lambda: page.fill("at/project/client", "Parrocchia"))
        page.click("document.getElementById('save')")
        assert tomllib.loads(page.downloaded()[1].decode())["project"]["client"] == "Parrocchia"


def test_a_truth_is_listed_once_and_every_mechanism_is_drawn(address):
    with form(address, language="it") as page:
        begun(page, "bending")
        page.wait("document.querySelectorAll('#sketches img').length === 2")
        names = page.run("[...document.querySelectorAll('#sketches figcaption')].map(e => e.innerText)")
        assert len(set(names)) == 2
        begun(page, "gable")
        page.wait("document.querySelectorAll('#sketches img').length === 1")
        stop = "[...document.getElementById('at/side_stop').options].map(one => one.text)"
        assert page.run(stop) == ["sì", "no", "pareti laterali fino a una quota"]


def test_the_form_is_filled_by_the_keyboard_alone(address):
    with form(address) as page:
        page.tab_to("template")
        page.press("ArrowDown", 2)
        page.wait("document.getElementById('at/wall/thickness')")
        page.wait(VERDICT)
        before = page.run("document.getElementById('to-results').textContent")
        page.tab_to("at/wall/thickness")
        page.call("Input.insertText", text="80 cm")
        page.wait(f"document.getElementById('to-results').textContent !== {json.dumps(before)}")
        outline = page.run("getComputedStyle(document.activeElement).outlineStyle")
        assert outline != "none"
        page.run("document.activeElement.blur(); document.querySelector('header').querySelector('select').focus()")
        page.tab_to("to-results")
        assert page.run("document.activeElement.getBoundingClientRect().width") > 20
        page.press("Enter")
        page.tab_to("run", 10)
        page.tab_to("report", 5)


def test_a_file_with_a_key_that_is_not_known_opens_and_says_so(address):
    with form(address) as page:
        opened(
            page,
            "[wall]\nthickness = 0.3\nheight = 3.0\nbreadth = 5\n[site]\ncode = 'EC8 type 1'\nag = 1.0\nsoil = 'A'\n",
        )
        page.wait("document.querySelector('.fault')")
        assert "wall.breadth is not known" in page.run("document.querySelector('.fault').innerText")
        page.click("document.getElementById('save')")
        assert tomllib.loads(page.downloaded()[1].decode())["wall"]["breadth"] == 5
        opened(page, "[wall")
        page.wait("document.getElementById('verdict').innerText.includes('is not TOML')")
        assert page.run("document.getElementById('at/wall/thickness').value") == "0.3"  # what was there stays


def test_files_of_50_mb_are_refused_before_they_are_read(address, tmp_path):
    large = tmp_path / "large.toml"
    large.write_bytes(b"#" * (50 * 2**20))
    with form(address) as page:
        begun(page, "parapet")
        page.upload("#file", large)
        page.wait("document.querySelector('#verdict .fault')?.innerText.includes('at most 30 MB')")
        begun(page, "gable")
        page.wait(VERDICT)
        page.click("document.getElementById('at/records')")
        choose_variant(page, "at/records/0", "of a table")
        page.upload("input[type=file][id='at/records/0/path']", large)
        help = "document.getElementById('at/records/0/path/help').innerText"
        page.wait(f"{help}.includes('at most 30 MB')")
        assert page.errors == []


def test_the_input_outlives_a_reload_in_the_middle_of_a_run():
    with served() as (process, place), form(place) as page:
        opened(page, COLUMN)
        page.wait("document.getElementById('at/duration')?.value === '10000'")
        page.click("document.getElementById('run')")
        page.wait("!document.getElementById('stop').hidden")
        time.sleep(1)
        before = set(children_of(process.pid))
        page.open(place)
        page.wait("document.getElementById('at/duration')?.value === '10000'")
        end = time.monotonic() + 20
        while before <= set(children_of(process.pid)):
            assert time.monotonic() < end, "the process of the run goes on"
            time.sleep(0.1)
        assert not page.run("document.getElementById('run').disabled")
        begun(page, "corner")
        page.wait(VERDICT)


def test_input_stays_in_its_window_and_goes_to_another_by_its_file(address, tmp_path):
    with form(address) as one, form(address) as other:
        begun(one, "corner")
        checked(one, lambda: one.fill("at/thickness", "61 cm"))
        assert other.run("document.getElementById('at/thickness')") is None
        one.click("document.getElementById('save')")
        path = tmp_path / "other.toml"
        path.write_bytes(one.downloaded()[1])
        other.upload("#file", path)
        assert other.wait("document.getElementById('at/thickness')?.value") == "61 cm"
        ratio = "document.getElementById('to-results').textContent"
        other.wait(f"{ratio} === {json.dumps(one.run(ratio))}")
        one.open(address)
        assert one.wait("document.getElementById('at/thickness')?.value") == "61 cm"
        one.wait(VERDICT)


def test_names_are_texts(address):
    name = json.dumps(NASTY)
    corner = f"[mechanisms.{name}]\nkind = 'Corner'\nthickness = 0.5\nheight = 3.5\n[project]\nproject = {name}\n"
    with form(address) as page:
        opened(page, f"{corner}[site]\ncode = 'EC8 type 1'\nag = '0.1 g'\nsoil = 'A'\n")
        page.wait("document.getElementById('form').innerText.includes('<script>')")
        page.wait("document.querySelector('#verdict table')")
        assert NASTY in page.run("document.getElementById('verdict').innerText")
        assert NASTY in page.run("document.getElementById('form').innerText")
        assert page.run("document.title") == "mjrock: assessment of a wall"
        assert page.run("document.querySelectorAll('main script, main [onerror]').length") == 0


def pulse(page):
    """Add half a sine."""
    page.click("document.getElementById('at/motion')")
    choose_variant(page, "at/motion", "half a sine")
    page.fill("at/motion/amplitude", "-4")
    checked(page, lambda: page.fill("at/motion/duration", "0.5"))


def test_a_run_has_a_bar_a_table_and_a_film(address):
    with form(address) as page:
        begun(page, "gable")
        pulse(page)
        page.click("document.getElementById('run')")
        film = page.wait("document.getElementById('film').src", 120)
        assert re.fullmatch(rf"{re.escape(address)}film/[\w-]+", film)
        assert "half sine" in page.run("document.getElementById('answers').innerText")
        page.wait("!document.getElementById('run').disabled")
        page.open(film)
        assert page.wait("document.body.dataset.state ?? document.querySelector('#clock')?.innerText")


def test_a_run_that_is_stopped_or_left_ends_its_process():
    with served() as (process, place), form(place) as page:
        opened(page, COLUMN)
        page.wait("document.getElementById('at/duration')?.value === '10000'")
        for leave in (lambda: page.click("document.getElementById('stop')"), lambda: page.open("about:blank")):
            page.click("document.getElementById('run')")
            page.wait("document.getElementById('progress').value > 0", 120)
            before = set(children_of(process.pid))
            leave()
            end = time.monotonic() + 10
            while before <= set(children_of(process.pid)):
                assert time.monotonic() < end, "the process of the run goes on"
                time.sleep(0.1)
        assert process.poll() is None


def test_ctrl_c_ends_the_form_with_all_its_processes():
    with served() as (process, place), form(place) as page:
        begun(page, "corner")
        children = children_of(process.pid)
        assert children
        process.send_signal(2)
        assert process.wait(20) == 0
        assert process.stdout.read() == "the form is closed\n"
        assert not any(map(lives, children))


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
@pytest.mark.parametrize("size", [(390, 844), (1280, 900)], ids=["phone", "desktop"])
def test_nothing_is_cut_off_and_everything_has_a_name(address, size, dark):
    with form(address, size=size, dark=dark) as page:
        begun(page, "gable")
        page.run("for (const fold of document.querySelectorAll('details')) fold.open = true")
        assert page.run("document.documentElement.scrollWidth") <= size[0]
        tree = page.call("Accessibility.getFullAXTree")["nodes"]
        roles = {"textbox", "combobox", "button", "link", "spinbutton"}
        nodes = [one for one in tree if one.get("role", {}).get("value") in roles and not one["ignored"]]
        assert len(nodes) > 30
        nameless = [one for one in nodes if not one.get("name", {}).get("value", "").strip()]
        numbers = [one["backendDOMNodeId"] for one in nameless]
        assert [page.call("DOM.describeNode", backendNodeId=number)["node"] for number in numbers] == []
        small = (
            "[...document.querySelectorAll('button, select, input')].filter(e => e.offsetParent && e.offsetHeight < 36)"
        )
        assert page.run(f"{small}.map(e => e.id || e.outerHTML)") == []
        backgrounds = page.run("getComputedStyle(document.body).backgroundColor")
        assert (sum(map(int, re.findall(r"\d+", backgrounds))) < 200) == dark
