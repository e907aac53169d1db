import contextlib
import dataclasses
import sqlite3

import numpy as np
import pytest

import mjrock as mr
from mjrock.study.campaign.store import Store
from mjrock.study.campaign.task import fingerprint


def row(key, position=0, **columns):
    return {"key": key, "position": position, "status": "done", **columns}


def test_rows_come_back_in_the_order_asked(tmp_path):
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        store.add_columns(["scale", "outcome"])
        store.add([row("b", 1, scale=0.5, outcome="at rest")])
        store.add([row("a", 0, scale=np.float64(2.5), outcome=None)])
        assert len(store) == 2
    with Store(tmp_path / "c.sqlite") as store:
        assert [r["scale"] for r in store.rows()] == [2.5, 0.5]
        assert [r["key"] for r in store.rows(outcome="at rest")] == ["b"]
        assert store.csv(timings=False).splitlines() == [
            "key,position,status,error,version,scale,outcome",
            "a,0,done,,,2.5,",
            "b,1,done,,,0.5,at rest",
        ]
        with pytest.raises(ValueError, match="no column moment"):
            store.rows(moment=3)
    assert [p.name for p in tmp_path.iterdir()] == ["c.sqlite"]


COLUMNS = "key, position, status, error, version, seconds, checksum"
FOREIGN = {
    "an endless view": "CREATE VIEW cases AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) "
    "SELECT x key, x position, 'done' status, NULL error, 1 version, 1.0 seconds, 'a' checksum FROM c",
    "a computed column": f"CREATE TABLE cases ({COLUMNS}, room GENERATED ALWAYS AS (zeroblob(1000000000)))",
    "a virtual table": f"CREATE VIRTUAL TABLE cases USING fts5({COLUMNS})",
}


@pytest.mark.parametrize("kind", FOREIGN)
def test_rows_that_are_computed_are_not_read(tmp_path, kind):
    """A file that others made can look like a store and have no end. A view beside the table is the user's own."""
    path = tmp_path / "c.sqlite"
    with Store(path, writing=True) as store:
        store.add([row("a")])
    with contextlib.closing(sqlite3.connect(path)) as own:
        own.execute("CREATE VIEW mine AS SELECT key FROM cases")
    assert len(Store(path)) == 1
    with contextlib.closing(sqlite3.connect(path)) as foreign:
        foreign.execute("DROP TABLE cases")
        foreign.execute(FOREIGN[kind])
    with pytest.raises(ValueError, match="its rows are computed as they are read"):
        Store(path)
    assert Store.rescue(path, tmp_path / "rescued.sqlite") == 0


def test_a_frame(tmp_path):
    pytest.importorskip("pandas")
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        store.add_columns(["scale"])
        store.add([row("a", 0, scale=2.5), row("b", 1, scale=3.5)])
        frame = store.frame()
    assert list(frame["scale"]) == [2.5, 3.5]


def test_one_writer_many_readers(tmp_path):
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        store.add([row("a")])
        with pytest.raises(OSError, match="another campaign is writing"):
            Store(tmp_path / "c.sqlite", writing=True)
        with Store(tmp_path / "c.sqlite") as reader:
            assert len(reader) == 1
        store.add([row("b")])
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        assert len(store) == 2


def test_files_that_are_no_campaign(tmp_path):
    with pytest.raises(FileNotFoundError, match="no such campaign"):
        Store(tmp_path / "absent.sqlite")
    text = tmp_path / "text.sqlite"
    text.write_text("scale,outcome\n" * 1000)
    other = tmp_path / "other.sqlite"
    connection = sqlite3.connect(other)
    connection.execute("CREATE TABLE invoices (number)")
    connection.commit()
    connection.close()
    for path, complaint in ((text, "not a database"), (other, "not the store of a campaign")):
        for writing in (True, False):
            before = path.read_bytes()
            with pytest.raises(ValueError, match=complaint):
                Store(path, writing=writing)
            assert path.read_bytes() == before
    with pytest.raises(OSError, match="unable to open"):
        Store(tmp_path / "nowhere" / "c.sqlite", writing=True)


def test_a_full_disk_keeps_what_there_is(tmp_path):
    with Store(tmp_path / "c.sqlite", writing=True) as store:
        store.add_columns(["note"])
        store.add([row("a", 0, note="kept")])
        pages = store._rows.execute("PRAGMA page_count").fetchone()[0]
        store._rows.execute(f"PRAGMA max_page_count = {pages + 1}")
        with pytest.raises(OSError, match="full; what is in it is kept"):
            store.add([row(f"b{i}", i, note="x" * 5000) for i in range(20)])
        assert [r["note"] for r in store.rows()] == ["kept"]


@pytest.mark.parametrize("name", ["key", "Status", "", 'a"b'])
def test_names_that_are_taken(tmp_path, name):
    with Store(tmp_path / "c.sqlite", writing=True) as store, pytest.raises(ValueError, match="cannot name a column"):
        store.add_columns([name])


def test_what_counts_as_content(wall, contacts):
    motion = mr.GroundMotion([0.0, 1.0, 0.0], 0.1, "one")
    case = mr.Case(wall, 0.01, 2.0, motion=motion)
    analysis = mr.Analysis(case, contacts=contacts, labels={"scale": 1})
    key = fingerprint(analysis)
    same = [
        dataclasses.replace(analysis, labels={"scale": 2}),
        mr.Analysis(mr.Case(wall, 0.01, 2, motion=mr.GroundMotion([0, 1, 0], 0.1, "two")), contacts=contacts),
    ]
    assert {fingerprint(a) for a in same} == {key}
    other = [
        dataclasses.replace(analysis, options={"accuracy": 1e-4}),
        dataclasses.replace(analysis, case=mr.Case(wall, 0.01, 2.0, motion=motion.reversed())),
        dataclasses.replace(analysis, case=mr.Case(wall, 0.01, 2.0, motion=mr.GroundMotion([0, 1, 0], 0.2))),
        dataclasses.replace(analysis, case=mr.Case(wall, 0.01, 2.0, motion=motion, side_stop=False)),
        dataclasses.replace(analysis, contacts=dataclasses.replace(contacts, law="another")),
        dataclasses.replace(analysis, solver="compliant"),
    ]
    assert len({key, *map(fingerprint, other)}) == 1 + len(other)
    with pytest.raises(TypeError, match="no type whose content"):
        fingerprint(lambda: None)


def test_contents_that_look_alike_differ():
    alike = [("ab", "c"), ("a", "bc"), ["abc"], {"a": 1}, {"a": "1"}, 1, True, None, "None", np.zeros(2), np.zeros(3)]
    assert len({fingerprint(content) for content in alike}) == len(alike)
    assert fingerprint({"a": 1, "b": 2.0}) == fingerprint({"b": 2, "a": np.float64(1)})
