"""The store of a campaign under several writers, and after damage to its file."""

import os
import shutil
import sqlite3
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from campaign_tasks import Square

import mjrock as mr
from mjrock.study.campaign.store import Store

TAKER = """
import os, sys, time
from pathlib import Path
from mjrock.study.campaign.store import Store
folder = Path(sys.argv[1])
folder.joinpath(f"ready {os.getpid()}").touch()
while len(list(folder.glob("ready *"))) < 3:
    time.sleep(0.01)
inside, end, taken, met = folder / "inside", time.monotonic() + 30, 0, 0
while taken < 40 and time.monotonic() < end:
    try:
        store = Store(folder / "c.sqlite", writing=True)
    except OSError:
        continue
    taken += 1
    try:
        os.close(os.open(inside, os.O_CREAT | os.O_EXCL))
    except FileExistsError:
        met += 1
    time.sleep(0.0002)
    inside.unlink(missing_ok=True)
    store.close()
print(taken, met)
"""


@pytest.mark.slow
def test_the_lock_is_exclusive(tmp_path):
    """Three processes open the store forty times each; nobody ever meets another one inside."""
    command = [sys.executable, "-c", TAKER, str(tmp_path)]
    takers = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    counts = [[int(number) for number in taker.communicate()[0].split()] for taker in takers]
    assert [taken for taken, _ in counts] == [40, 40, 40]
    assert sum(met for _, met in counts) == 0
    assert not (tmp_path / "c.sqlite.lock").exists()


HOLDER = """
import sys, time
from mjrock.study.campaign.store import Store
store = Store(sys.argv[1], writing=True)
print("held", flush=True)
time.sleep(60)
"""


@pytest.mark.slow
def test_a_killed_process_frees_the_lock(tmp_path):
    path = tmp_path / "c.sqlite"
    holder = subprocess.Popen([sys.executable, "-c", HOLDER, str(path)], stdout=subprocess.PIPE, text=True)
    with holder.stdout:
        assert holder.stdout.readline() == "held\n"
    with pytest.raises(OSError, match=r"c\.sqlite: another campaign is writing to it"):
        Store(path, writing=True)
    holder.kill()
    holder.wait()
    assert (tmp_path / "c.sqlite.lock").exists()
    Store(path, writing=True).close()
    assert [file.name for file in tmp_path.iterdir()] == ["c.sqlite"]


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the superuser writes anywhere")
def test_a_read_only_folder_is_named(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(OSError, match=r"c\.sqlite: unable to open .*c\.sqlite\.lock: Permission denied"):
        Store(tmp_path / "c.sqlite", writing=True)
    tmp_path.chmod(0o700)


def test_a_missing_folder_is_named_and_not_made(tmp_path):
    with pytest.raises(OSError, match=r"c\.sqlite: unable to open .*c\.sqlite\.lock: No such file or directory"):
        Store(tmp_path / "nowhere" / "c.sqlite", writing=True)
    assert not (tmp_path / "nowhere").exists()


def test_a_symbolic_link_is_the_same_store(tmp_path):
    (tmp_path / "link.sqlite").symlink_to(tmp_path / "c.sqlite")
    with Store(tmp_path / "c.sqlite", writing=True), pytest.raises(OSError, match="another campaign is writing"):
        Store(tmp_path / "link.sqlite", writing=True)
    with Store(tmp_path / "link.sqlite", writing=True), pytest.raises(OSError, match="another campaign is writing"):
        Store(tmp_path / "c.sqlite", writing=True)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A store of 150 rows with labels, and its table."""
    path = tmp_path_factory.mktemp("whole") / "c.sqlite"
    tasks = [Square(i, labels={"name": f"wall {i}", "scale": i / 7}) for i in range(150)]
    mr.campaign(tasks, path, workers=1)
    with Store(path) as store:
        return path, store.rows()


def damaged(content, rng):
    """The content after a bit flip, a truncation or garbage."""
    changed, kind = bytearray(content), rng.integers(4)
    place = int(rng.integers(len(content)))
    if kind == 0:
        return bytes(changed[:place])
    if kind == 1:
        length = min(int(rng.integers(1, 3000)), len(content) - place)
        changed[place : place + length] = rng.bytes(length)
    else:
        changed[place if kind == 2 else place % 200] ^= 1 << int(rng.integers(8))
    return bytes(changed)


@pytest.mark.slow
@pytest.mark.parametrize("writing", [False, True])
def test_damage_is_never_another_table(tmp_path, whole, writing):
    """Of 300 damaged copies each has the same content, or ends in one error that names the file."""
    path, rows = whole
    content, rng = path.read_bytes(), np.random.default_rng(5)
    copy, errors = tmp_path / "copy.sqlite", []
    for i in range(300):
        for old in tmp_path.glob("copy.sqlite*"):
            old.unlink()
        copy.write_bytes(damaged(content, rng))
        try:
            with Store(copy, writing=writing) as store:
                found = [store.rows(), store.rows(name="wall 3"), store.statuses()]
        except (ValueError, OSError) as error:
            errors.append(str(error))
        else:
            assert found == [rows, rows[3:4], {row["key"]: "done" for row in rows}], i
    assert 150 < len(errors) < 300
    assert all(error.count(str(copy)) for error in errors)


@pytest.mark.slow
def test_rows_are_rescued(tmp_path, whole):
    path, rows = whole
    content = bytearray(path.read_bytes())
    place = content.index(b"wall 70")
    content[place] ^= 1
    copy = tmp_path / "copy.sqlite"
    copy.write_bytes(content)
    with (
        Store(copy) as store,
        pytest.raises(ValueError, match=r"copy.sqlite is damaged .*149 of its rows are readable"),
    ):
        store.rows()
    assert Store.rescue(copy, tmp_path / "new.sqlite") == 149
    with Store(tmp_path / "new.sqlite") as store:
        assert store.rows() == rows[:70] + rows[71:]
    with pytest.raises(FileExistsError, match=r"new.sqlite exists already"):
        Store.rescue(copy, tmp_path / "new.sqlite")
    with pytest.raises(ValueError, match=r"copy.sqlite is damaged .*149 of its rows"):
        mr.campaign([Square(1)], copy, workers=1)


@pytest.mark.slow
def test_a_damaged_page_leaves_the_rows_around_it(tmp_path, whole):
    path, rows = whole
    content = bytearray(path.read_bytes())
    page = content.index(b"wall 70") // 4096 * 4096
    content[page : page + 8] = b"\xff" * 8
    copy = tmp_path / "copy.sqlite"
    copy.write_bytes(content)
    with pytest.raises(ValueError, match=r"copy.sqlite is damaged"):
        Store(copy)
    count = Store.rescue(copy, tmp_path / "new.sqlite")
    assert 75 < count < 150
    with Store(tmp_path / "new.sqlite") as store:
        assert all(row in rows for row in store.rows())


@pytest.mark.slow
def test_an_error_of_the_system_is_no_damage(tmp_path, whole):
    copy = tmp_path / "copy.sqlite"
    shutil.copy(whole[0], copy)
    with Store(copy, writing=True) as store:
        blocker = sqlite3.connect(copy, isolation_level=None)
        blocker.execute("BEGIN IMMEDIATE")
        store._rows.execute("PRAGMA busy_timeout = 1")
        with pytest.raises(OSError, match="database is locked; what is in it is kept"):
            store.add([{"key": "z", "position": 1, "status": "done"}])
        blocker.close()
        store.add([{"key": "z", "position": 1, "status": "done"}])
        assert len(store) == 151


def test_the_lock_is_released(tmp_path):
    first = Store(tmp_path / "c.sqlite", writing=True)
    with ThreadPoolExecutor(1) as other:
        other.submit(first.close).result()
    first.close()
    Store(tmp_path / "c.sqlite", writing=True).close()


@pytest.mark.parametrize("value", [10**30, [1, 2], "\ud800", 1j])
def test_values_that_no_table_holds(tmp_path, value):
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        store.add_columns(["note"])
        with pytest.raises(ValueError, match=r"outside the valid range|a table holds text|UTF-8"):
            store.add([{"key": "a", "position": 0, "status": "done", "note": value}])
        with pytest.raises(ValueError, match="no column moment"):
            store.add([{"key": "a", "position": 0, "status": "done", "moment": 1}])
        kept = {"true": True, "nan": float("nan"), "zero": -0.0, "inf": np.inf, "text": "ü", "numpy": np.int64(3)}
        store.add_columns(kept)
        store.add([{"key": "b", "position": 0, "status": "done", **kept}])
        assert [store.rows()[0][name] for name in kept] == [1, None, 0.0, np.inf, "ü", 3]
        assert store.rows(numpy=np.float64(3)) == store.rows()


@pytest.mark.parametrize(
    ("names", "complaint"),
    [
        (["Law", "law"], "'law' cannot name a column beside 'Law'"),
        (["law", "law"], "'law' cannot name a column beside 'law'"),
        (["Scale"], "'Scale' cannot name a column beside 'scale'"),
        ([3], "3 cannot name a column"),
        (["a\0"], "cannot name a column"),
        (["Checksum"], "cannot name a column; reserved are key"),
    ],
)
def test_names_that_clash(tmp_path, names, complaint):
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        store.add_columns(["scale"])
        with pytest.raises(ValueError, match=complaint):
            store.add_columns(["other", *names])
        assert "other" not in store.columns
