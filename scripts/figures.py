"""Make the figures of the pages that are stale: those whose script has changed, or that are not there.

`docs/figures/made.toml` has the script of each figure. What needs a folder that is not given is named and left as it
is. A script that has changed in its words alone makes the same figure: `--unchanged` records it as it is now.
"""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from scripts.shared import cli
from scripts.shared.figure_record import ROOT, Made, digest, read, stale, write

FOLDERS = {
    "--records": "recorded ground motions",
    "--motions": "the motions of the shake table of scripts/studies/shaken_wall.py",
    "--samples": "the assemblies of compas_cra",
}
"""What scripts are given a folder of, by their options."""
FIGURES = ROOT / "docs" / "figures"


def line_of(one: Made, folder: Path, given: dict[str, Path | None]) -> list[str] | str:
    """The command line that makes files anew, or the option that has no folder."""
    words = shlex.split(one.command)
    for i, word in enumerate(words):
        if word == "...":
            place = given.get(words[i - 1])
            if place is None:
                return words[i - 1]
            words[i] = str(place)
    inside = os.path.commonpath([Path(name).parent for name in one.files])
    return [sys.executable, str(ROOT / words[0]), *words[1:], "--out", str(folder / inside)]


def chosen(every: dict[str, Made], folder: Path, names: Sequence[str], *, whole: bool) -> list[Made]:
    """What is to be made: the scripts of some names, or all, or those that are stale.

    Raises:
        ValueError: for a name that no script has.
    """
    if names:
        found = [one for one in every.values() if one.script.stem in names]
        if unknown := set(names).difference(one.script.stem for one in found):
            raise ValueError(f"{', '.join(sorted(unknown))}: no figure is made by a script of this name")
        return found
    old = {why.partition(": ")[0] for why in stale(folder)}
    return [one for one in every.values() if one.script.is_file() and (whole or one.command in old)]


def main(argv: Sequence[str] | None = None) -> None:
    """Make figures, and print what is left."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("scripts", nargs="*", help="names of scripts; else those whose figures are stale")
    parser.add_argument("--all", action="store_true", help="make all figures")
    parser.add_argument("--list", action="store_true", help="print what would be made")
    parser.add_argument("--unchanged", action="store_true", help="record these scripts as they are now, make nothing")
    parser.add_argument("--folder", type=Path, default=FIGURES, help="folder of the figures and of their record")
    for name, what in FOLDERS.items():
        parser.add_argument(name, type=Path, help=f"folder of {what}")
    args = parser.parse_args(argv)
    every = read(args.folder)
    todo = chosen(every, args.folder, args.scripts, whole=args.all)
    if args.unchanged:
        write(args.folder, every | {one.command: one._replace(digest=digest(one.script)) for one in todo})
        return
    given = {name: getattr(args, name[2:]) for name in FOLDERS}
    failed = []
    for one in todo:
        line = line_of(one, args.folder, given)
        if isinstance(line, str):
            print(
                f"left as it is: {one.command} needs {line}, a folder of {FOLDERS.get(line, 'its files')}", flush=True
            )
            continue
        print(shlex.join([Path(line[0]).name, *line[1:]]), flush=True)  # before what the script prints
        if not args.list and subprocess.run(line, cwd=ROOT, check=False).returncode:
            failed.append(one.command)
    for why, files in stale(args.folder).items():
        print(f"stale: {why}: {', '.join(files)}")
    if failed:
        raise RuntimeError(f"{', '.join(failed)} has failed")


if __name__ == "__main__":
    sys.exit(cli.run(main))
