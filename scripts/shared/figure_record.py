"""What has made the files of a folder of figures: a script as it was, with which options, when, and by which version.

A folder that holds a `made.toml` has the files that scripts write into it recorded there, see `recorded`. A file is
stale where the code of its script, or of what it uses from other modules of `scripts`, has changed since.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import datetime
import hashlib
import io
import os
import re
import shlex
import tokenize
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from filelock import FileLock

ROOT = Path(__file__).resolve().parents[2]
NAME, LOCK = "made.toml", "made.lock"
HEAD = "# Written by scripts, see scripts/shared/figure_record.py. `make figures` makes what is stale.\n"
PLAIN = {"scripts/shared/cli.py", "scripts/shared/figure_record.py"}
"""Modules by which no figure looks different: arguments, tables and this record."""
UNRECORDED = re.compile(r"\.(sqlite|lock|partial)")
"""Endings of files that a script keeps for its next run."""
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?(?![\w.])")


class Made(NamedTuple):
    """A script that has run, and what it has written."""

    command: str
    """The script, and its options without `--out`; an option that takes a folder or a file has `...` for it."""
    digest: str
    version: str
    date: datetime.date
    files: tuple[str, ...]

    @property
    def script(self) -> Path:
        """The script."""
        return ROOT / shlex.split(self.command)[0]


def parts(script: Path) -> dict[str, str]:
    """The code of a script, and of each definition in other modules of `scripts` that it uses, by their places."""
    codes, left = dict[str, str](), [(script, "")]
    while left:
        path, name = left.pop()
        module = path.relative_to(ROOT).as_posix()
        place = f"{module}:{name}"
        if place in codes or module in PLAIN or not path.is_file():
            continue
        text = path.read_text(encoding="utf-8")
        tree = parsed(text)
        imported = {
            alias.asname or alias.name: (str(node.module), alias.name)
            for node in tree.body
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "scripts"
            for alias in node.names
        }
        nodes = [node for node in tree.body if not name or name in names_of(node)]
        codes[place] = code_of("\n".join(lines_of(text, node) for node in nodes))
        for node in (inner for outer in nodes for inner in ast.walk(outer)):
            of = node.value if isinstance(node, ast.Attribute) else node
            if not isinstance(of, ast.Name):
                continue
            if of.id in imported:
                package, known = imported[of.id]
                whole = ROOT / f"{package.replace('.', '/')}/{known}.py"
                if not whole.is_file():
                    left.append((ROOT / f"{package.replace('.', '/')}.py", known))
                elif isinstance(node, ast.Attribute):
                    left.append((whole, node.attr))
            elif name and of is node:
                left.append((path, node.id))
    return {place: code for place, code in codes.items() if code}


@cache
def parsed(text: str) -> ast.Module:
    """A module by its text, which many scripts may use."""
    return ast.parse(text)


def lines_of(text: str, node: ast.stmt) -> str:
    """The lines of a statement of a module, with its decorators."""
    first = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", ()))])
    return "\n".join(text.splitlines()[first - 1 : node.end_lineno])


def names_of(node: ast.stmt) -> set[str]:
    """The names that a statement of a module defines."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return {node.name}
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return {one.id for target in targets if target for one in ast.walk(target) if isinstance(one, ast.Name)}


@cache
def code_of(text: str) -> str:
    """The text of a module without docstrings, comments and empty lines."""
    lines = text.splitlines()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)  # type: ignore[operator]
    return "\n".join(line.rstrip() for line in lines if line.strip())


def digest(script: Path) -> str:
    """The first letters of a digest of a script and of what it uses from other modules of `scripts`."""
    text = "\n".join(f"{place}\n{code}" for place, code in sorted(parts(script).items()))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def read(folder: Path) -> dict[str, Made]:
    """What has made the files of a folder, by commands."""
    rows = tomllib.loads((folder / NAME).read_text(encoding="utf-8")).get("made", [])
    return {row["command"]: Made(**row | {"files": tuple(row["files"])}) for row in rows}


def write(folder: Path, every: Mapping[str, Made]) -> None:
    """Write what has made the files of a folder. A file belongs to the last that has written it."""
    parts = [HEAD]
    for _, one in sorted(every.items()):
        files = "".join(f'    "{name}",\n' for name in sorted(one.files))
        parts.append(
            f"[[made]]\ncommand = {toml_text(one.command)}\ndigest = {toml_text(one.digest)}\n"
            f"version = {toml_text(one.version)}\ndate = {one.date}\nfiles = [\n{files}]\n"
        )
    (folder / NAME).write_text("\n".join(parts), encoding="utf-8")


def toml_text(text: str) -> str:
    """A text as TOML has it."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def stale(folder: Path) -> dict[str, list[str]]:
    """Files of a folder that are not those of their script as it is now, by why, and by the command that makes them."""
    every, found = read(folder), dict[str, list[str]]()
    present = set(files_of(folder))
    for one in every.values():
        if not one.script.is_file():
            found[f"{one.command}: there is no such script"] = [*one.files]
        elif one.digest != digest(one.script):
            found[f"{one.command}: the script has changed"] = [*one.files]
        elif gone := sorted(set(one.files) - present):
            found[f"{one.command}: has written what is not here"] = gone
    if unknown := sorted(present.difference(*(one.files for one in every.values()))):
        found["no script that is known"] = unknown
    return found


def files_of(folder: Path) -> dict[str, int]:
    """Files that scripts write, by their names, and when each was written [ns]."""
    paths = [path for path in folder.rglob("*.*") if path.is_file() and path.name != NAME]
    kept = [path for path in paths if not path.name.startswith(".") and not UNRECORDED.search(path.name)]
    return {path.relative_to(folder).as_posix(): path.stat().st_mtime_ns for path in kept}


def recorded_folder(arguments: Sequence[str]) -> Path | None:
    """The folder of `--out` or the nearest above it that has a record, or None.

    Raises:
        ValueError: for a quick run into such a folder.
    """
    parser = argparse.ArgumentParser(add_help=False, exit_on_error=False)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--quick", action="store_true")
    known, _ = parser.parse_known_args(arguments)
    if known.out is None:
        return None
    out = known.out.resolve()
    folder = next((one for one in (out, *out.parents) if (one / NAME).is_file()), None)
    if folder is not None and known.quick:
        raise ValueError(f"--quick: {known.out} holds the figures of the pages; a shorter study needs another --out")
    return folder


def command_of(script: Path, arguments: Sequence[str]) -> str:
    """A script with its options, without `--out` and without the paths that it was given."""
    words, left = [script.resolve().relative_to(ROOT).as_posix()], [*arguments]
    while left:
        word = left.pop(0)
        if word == "--out":
            left.pop(0)
        elif not word.startswith("--out="):
            words.append("..." if os.sep in word or Path(word).exists() else word)
    return shlex.join(words)


@contextlib.contextmanager
def recorded(script: Path, arguments: Sequence[str]) -> Iterator[None]:
    """Record the files that a script writes, where `--out` is a folder with a record, and print what has changed. One
    script at a time writes into such a folder: another one waits."""
    if (folder := recorded_folder(arguments)) is None:
        yield
        return
    with FileLock(folder / LOCK):
        before, texts = files_of(folder), tables_of(folder)
        yield
        record(folder, command_of(script, arguments), script, before, texts)


def record(folder: Path, command: str, script: Path, before: Mapping[str, int], texts: Mapping[str, str]) -> None:
    """Record the files of a folder that are not as before as those of a command, and print which numbers have moved."""
    from mjrock import __version__

    files = [name for name, when in files_of(folder).items() if before.get(name) != when]
    every = {
        key: one._replace(files=tuple(name for name in one.files if name not in files))
        for key, one in read(folder).items()
        if one.script.is_file()
    }
    last = every.get(command)
    if last is not None:
        print(f"{command}: last made on {last.date} by version {last.version}, now by {__version__}")
    every[command] = Made(command, digest(script), __version__, datetime.date.today(), tuple(files))
    write(folder, {key: one for key, one in every.items() if one.files})
    for name, text in tables_of(folder).items():
        if name in files and name in texts and text != texts[name]:
            print(f"{name}: {moved(texts[name], text)}")


def tables_of(folder: Path) -> dict[str, str]:
    """The texts of tables in a folder, by their names."""
    names = [name for name in files_of(folder) if name.endswith((".txt", ".md"))]
    return {name: (folder / name).read_text(encoding="utf-8") for name in names}


def moved(before: str, after: str) -> str:
    """How many numbers of a table have changed, and that which has changed most, in words."""
    old, new = NUMBER.findall(before), NUMBER.findall(after)
    if len(old) != len(new):
        return f"{len(old)} numbers before, {len(new)} now"
    pairs = [(a, b) for a, b in zip(map(float, old), map(float, new), strict=True) if a != b]
    if not pairs:
        return "the words alone have changed"
    a, b = max(pairs, key=lambda pair: abs(pair[1] - pair[0]) / max(map(abs, pair)))
    return f"{len(pairs)} of {len(new)} numbers have changed, most of all {a:g} to {b:g}"
