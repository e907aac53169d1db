"""What writers leave at a path: files whole, with their mode; links, pipes and devices as they were; a disk that is
full is named with the path."""

import contextlib
import errno
import os
import stat
import sys
import threading
import time
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from everyday import among

import mjrock as mr
from mjrock import plotting
from mjrock.contacts.files import write_arrays, write_text

posix = pytest.mark.skipif(sys.platform == "win32", reason="pipes, links and modes are those of POSIX")
WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)
CASE = mr.Case(WALL, 0.05, 0.1)
BOX = mr.Masonry.box((0.6, 0.4, 2.0))


@cache
def answer():
    return mr.solve_analytical(CASE, E)


def saved(path):
    pytest.importorskip("h5py")
    answer().save(path)


WRITERS = {
    "Response.csv": ("a.csv", lambda path: answer().csv(path)),
    "Response.save": ("a.h5", saved),
    "Fragility.csv": ("f.csv", lambda path: mr.fit_fragility(range(1, 7), [0, 0, 1, 0, 1, 1], resamples=20).csv(path)),
    "law.save": ("a.toml", mr.CALIBRATED.save),
    "to_obj": ("a.obj", BOX.to_obj),
    "to_compas": ("a.json", BOX.to_compas),
    "report": ("a.html", lambda path: mr.report(CASE, answer(), path)),
    "save": ("a.png", lambda path: plotting.save(plotting.history(answer()), path)),
    "animate": ("a.gif", lambda path: plotting.animate(answer(), path, fps=2, dpi=30)),
    "history of a campaign": ("a.npz", lambda path: write_arrays(path, t=np.random.default_rng(0).random(1000))),
}
"""A name of a file, and what writes it, by writer."""


@contextlib.contextmanager
def smallest_disk():
    """No file grows beyond 100 bytes."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@posix
@pytest.mark.parametrize("writer", WRITERS)
def test_a_disk_that_is_full_is_named_with_the_path(tmp_path, writer):
    """And what was there stays as it was, alone in its folder."""
    name, write = WRITERS[writer]
    path = tmp_path / name
    path.write_text("old")
    with smallest_disk(), pytest.raises(OSError, match=rf"File too large: '{path}'"):
        write(path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@posix
@pytest.mark.parametrize("writer", among(list(WRITERS), "Response.csv", "save", "history of a campaign"))
def test_links_stay_and_files_keep_their_mode(tmp_path, writer):
    name, write = WRITERS[writer]
    (tmp_path / "real").mkdir()
    real, link = tmp_path / "real" / "file", tmp_path / name
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to(real)
    write(link)
    assert link.is_symlink()
    assert real.read_bytes() != b"old"
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert list(real.parent.iterdir()) == [real]


@posix
def test_a_link_to_nothing_leads_to_the_new_file(tmp_path):
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "new")
    write_text(link, "rows")
    assert link.is_symlink()
    assert (tmp_path / "new").read_text() == "rows"


def test_a_new_file_has_the_mode_of_any_other(tmp_path):
    (tmp_path / "other").touch()
    path = write_text(tmp_path / "new", "rows")
    assert path.stat().st_mode == (tmp_path / "other").stat().st_mode


@posix
def test_a_pipe_is_written_to_where_somebody_reads(tmp_path):
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    with pytest.raises(OSError, match=rf"nobody reads from it: '{pipe}'"):
        write_text(pipe, "rows")
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()), daemon=True)
    reader.start()
    text, until = "rows\n" * 100_000, time.monotonic() + 10  # more than a pipe holds at a time
    written = False
    while not written and time.monotonic() < until:
        with contextlib.suppress(OSError):  # until the thread has opened the pipe
            written = bool(write_text(pipe, text))
    reader.join(10)
    assert read == [text]
    assert stat.S_ISFIFO(pipe.lstat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


@posix
def test_a_device_is_written_to():
    ours, theirs = os.openpty()
    try:
        path = Path(os.ttyname(theirs))
        write_text(path, "a,b\n")
        assert os.read(ours, 100) == b"a,b\r\n"
        assert stat.S_ISCHR(path.lstat().st_mode)
    finally:
        os.close(ours)
        os.close(theirs)


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="open files have paths in /proc")
def test_an_open_file_is_not_replaced_under_who_writes_to_it(tmp_path):
    """As /dev/stdout is where the shell sends the output to a file."""
    with open(tmp_path / "out", "w") as file, pytest.raises(OSError, match="stands for a file that is open"):
        write_text(f"/proc/self/fd/{file.fileno()}", "rows")
    assert (tmp_path / "out").read_text() == ""


@pytest.mark.parametrize("path", ["/", ".", ".."])
def test_a_folder_is_no_file(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for writer in ("Response.csv", "law.save", "to_obj"):
        with pytest.raises(IsADirectoryError, match=rf"'{path}'"):
            WRITERS[writer][1](path)
    for writer in ("report", "save", "animate"):
        with pytest.raises(ValueError, match=rf"path = '{path}' "):
            WRITERS[writer][1](path)
    with pytest.raises(IsADirectoryError, match=rf"'{path}'"):
        mr.campaign([], path)
    assert not list(tmp_path.iterdir())


@posix
@pytest.mark.skipif(hasattr(os, "geteuid") and os.geteuid() == 0, reason="the superuser writes anywhere")
def test_a_file_that_may_not_be_written_stays(tmp_path):
    path = tmp_path / "rows"
    path.write_text("old")
    path.chmod(0o400)
    with pytest.raises(PermissionError, match=str(path)):
        write_text(path, "rows")
    assert path.read_text() == "old"


READERS = {
    "from_at2": mr.GroundMotion.from_at2,
    "from_csv": lambda path: mr.GroundMotion.from_csv(path, "g"),
    "from_sac": lambda path: mr.GroundMotion.from_sac(path, "g"),
    "from_file": mr.GroundMotion.from_file,
    "components_in": lambda path: mr.components_in(path, dt=0.01),
    "law.load": mr.DampingLaw.load,
    "from_obj": mr.Masonry.from_obj,
    "from_stl": mr.Masonry.from_stl,
    "from_ply": mr.Masonry.from_ply,
    "from_compas": mr.Masonry.from_compas,
    "from_dxf": mr.Masonry.from_dxf,
    "Store": mr.Store,
    "campaign": lambda path: mr.campaign([], path),
    "rescue": lambda path: mr.Store.rescue(path, path.with_name("new")),
}


@posix
@pytest.mark.parametrize("reader", READERS)
def test_a_pipe_is_refused_and_not_waited_for(tmp_path, reader):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises((OSError, ValueError), match=str(pipe)) as caught:
        READERS[reader](pipe)
    assert getattr(caught.value, "errno", None) in (None, errno.EINVAL)
    assert list(tmp_path.iterdir()) == [pipe]
