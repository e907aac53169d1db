"""What the form asks for: verdicts are those of the file, and files are only those that come with the request."""

import base64
import pickle
import tomllib

import pytest

import mjrock as mr
from mjrock.app import tasks
from mjrock.app.form import state_of
from mjrock.assessment.templates import seeds
from mjrock.toml_text import toml_text

RECORD = "0.0 0.0\n" + "\n".join(f"{0.01 * i:.2f} {2.0 * (-1) ** (i // 30):.1f}" for i in range(1, 200))
NASTY = "<script>alert(1)</script>"


def answer(task, **request):
    """All parts of an answer as one."""
    found = []
    tasks.TASKS[task](request, found.append)
    return {key: one for part in found for key, one in part.items()}


def state(name, **more):
    return state_of(tasks.templates_of()[name] | more)


def encoded(text):
    return base64.b64encode(text.encode()).decode()


@pytest.mark.parametrize("name", sorted(set(seeds()) - {"masonry"}))
def test_a_verdict_is_that_of_the_file(name):
    found = answer("check", state=state(name))
    checks = mr.from_toml(text=toml_text(tasks.templates_of()[name])).check()
    first = min(checks.values(), key=lambda check: min(one.ratio for one in check.verdicts))
    least, held = min(one.ratio for one in first.verdicts), [one.holds for one in first.verdicts]
    word = "✓ HOLDS" if all(held) else "✓✗ HOLDS IN PART" if any(held) else "✗ FAILS"
    assert found["ratio"] == f"{word} {mr.quantities.ratio_text(least)}"
    assert word in found["verdict"]
    assert found["sketch"].startswith("data:image/svg+xml;base64,")
    assert "C8.7.1.2.1" in found["verdict"]
    assert "<math>" in found["steps"]


def test_an_answer_is_in_the_language_of_the_input():
    assert "VERIFICATO" in answer("check", state=state("corner", language="it"))["verdict"]
    assert "HOLDS" in answer("check", state=state("corner"))["verdict"]


def test_every_fault_has_its_place():
    wall = {"thickness": "-1", "height": "30 kg", "breadth": "2"}
    found = answer("check", state={"wall": wall})["faults"]
    assert [one["place"] for one in found] == [["wall", "thickness"], ["wall", "height"], ["wall", "breadth"]]
    assert "0.002 to 20 m" in found[0]["message"]


def test_without_a_site_there_is_a_sketch():
    found = answer("check", state={"wall": {"thickness": "30 cm", "height": "3"}})
    assert "site" in found["faults"][0]["message"]
    assert "verdict" not in found
    assert "sketch" in found


def test_doubts_are_shown():
    wall = {"thickness": "0.5", "height": "2", "length": "4"}
    site = state("corner")["site"]
    found = answer("check", state={"kind": "HorizontalBending", "wall": wall, "thrust": "80 kN", "site": site})
    assert '<p class="note">the strip slides before it bends' in found["verdict"]


@pytest.mark.parametrize(
    "path", ["/etc/passwd", "../../../etc/passwd", "a/b.csv", "", "other.csv", "./record.csv", ".."]
)
@pytest.mark.parametrize("where", ["motion", "records", "folder", "mechanisms"])
def test_no_path_leads_out_of_the_files_of_the_request(path, where):
    motion = {"kind": "GroundMotion", "make": "from_csv", "path": path, "unit": "m/s2"}
    own = {
        "motion": {"motion": motion},
        "records": {"records": [motion]},
        "folder": {"records": {"folder": path}},
        "mechanisms": {"mechanisms": {"a": {"motion": motion}}},
    }[where]
    for files in ({}, {"record.csv": encoded(RECORD)}):
        found = answer("check", state=state("facade") | own, files=files)
        if path:  # an empty one is left out
            assert "is no file that is uploaded" in found["faults"][0]["message"]
            assert "verdict" not in found


def test_the_reader_refuses_such_paths_too(monkeypatch):
    """It alone knows all paths; the form looks for them first, for its message."""
    monkeypatch.setattr(tasks.Plan, "files_in", lambda *given: ())
    for path in ("/etc/passwd", "../../../etc/passwd", ".."):
        found = answer("check", state=state("facade", motion={"make": "from_at2", "path": path}))
        assert "leads out of the folder" in found["faults"][0]["message"]


@pytest.mark.parametrize("name", ["../a", "a/b", "/a", "a\\b", "..", "", "a\0b", "x" * 300])
def test_a_name_of_a_file_has_no_folder(name):
    with pytest.raises(ValueError, match="no plain name"):
        answer("check", state=state("facade"), files={name: encoded("x")})


def test_files_are_few_and_base64():
    with pytest.raises(ValueError, match="has 51 files; the valid range is 0 to 50"):
        answer("check", state=state("facade"), files={f"{i}": "" for i in range(51)})
    with pytest.raises(ValueError, match="no base64"):
        answer("check", state=state("facade"), files={"a": "%"})
    with pytest.raises(TypeError, match="files"):
        answer("check", state=state("facade"), files=["a"])


@pytest.mark.slow
def test_a_run_under_a_record_that_is_uploaded_has_a_table_and_a_film():
    records = {"kind": "GroundMotion", "make": "from_csv", "path": "record.csv", "unit": "m/s2"}
    parts = []
    request = {"state": state("gable", duration=3.0, records=[records]), "files": {"record.csv": encoded(RECORD)}}
    tasks.TASKS["run"](request, parts.append)
    whole = {key: one for part in parts for key, one in part.items()}
    assert "record" in whole["answers"]
    assert "C8.7.1.2.1.9" in whole["answers"]
    assert whole["keep"]["film"].startswith(b"<!doctype html>")
    kept = pickle.loads(whole["keep"]["responses"])
    assert [one.case.motion.name for one in kept[""]] == ["record on a floor", "record on a floor, reversed"]
    made = answer("report", state=request["state"], files=request["files"], responses=whole["keep"]["responses"])
    assert [one["name"] for one in made["documents"]] in (["mjrock.pdf"], ["mjrock.html"])


def test_a_report_escapes_names_and_is_in_its_language(monkeypatch):
    def without(*given):
        raise ImportError("no WeasyPrint")

    monkeypatch.setattr("mjrock.reporting.page.write_pdf", without)
    corner = {key: state("corner")[key] for key in ("kind", "thickness", "height", "angle")}
    tables = {"mechanisms": {NASTY: corner}, "site": state("corner")["site"], "project": {"project": NASTY}}
    found = answer("report", state=tables, language="it")
    (made,) = found["documents"]
    assert (made["name"], made["type"]) == ("mjrock.html", "text/html")
    assert "WeasyPrint" in found["note"]
    page = base64.b64decode(made["data"]).decode()
    assert NASTY not in page
    assert "&lt;script&gt;" in page
    assert "Esito" in page
    assert "cantonata in pianta" in page  # and not the wall that stands for it


def test_a_file_opens_and_is_saved_as_it_was():
    text = "language = 'it'\n[wall]\nthickness = '50 cm'\nheight = 5.25\n"
    opened = answer("open", text=text)["state"]
    assert opened == {"language": "it", "wall": {"thickness": "50 cm", "height": "5.25"}}
    saved = answer("save", state=opened)
    assert saved["name"] == "mjrock.toml"
    assert tomllib.loads(saved["text"]) == tomllib.loads(text)


@pytest.mark.parametrize("text", ["[wall", "a = ", "[" * 10_000, 7, None])
def test_what_is_no_toml_is_refused(text):
    assert answer("open", text=text)["faults"][0]["message"]
