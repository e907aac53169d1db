"""`mjrock examples`: the examples of the documentation, which come with the package."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..command_line import Answer, add_output, parser_of, require_free
from ..contacts.files import aligned, write_text

FOLDER = Path(__file__).parents[1] / "examples"
"""Where the scripts are; the documentation is built from them too."""
CELL = "# %%\n"
"""Line between two cells of a script."""


class Example(NamedTuple):
    """An example.

    Args:
        path: of its script.
        title: what it is about.
    """

    path: Path
    title: str

    @property
    def text(self) -> str:
        """The script."""
        return self.path.read_text(encoding="utf-8")


def examples() -> list[Example]:
    """All examples in their order."""
    paths = sorted(FOLDER.glob("[0-9][0-9]_*.py"))
    titles = [path.read_text(encoding="utf-8").splitlines()[1] for path in paths]
    return [Example(path, title.partition(". ")[2]) for path, title in zip(paths, titles, strict=True)]


def example_named(name: str) -> Example:
    """The example of a number, or of a name with or without its number.

    Raises:
        ValueError: for any other, with those that there are.
    """
    known = examples()
    for example in known:
        number, _, rest = example.path.stem.partition("_")
        if name in (number, str(int(number)), rest, example.path.stem, example.path.name):
            return example
    names = ", ".join(example.path.stem for example in known)
    raise ValueError(f"there is no example {name!r}; give a number from 1 to {len(known)} or one of {names}")


def cells_of(text: str) -> Iterator[str]:
    """The cells of a script. Empty lines before each keep the numbers of its lines, which a traceback names."""
    before = 0
    for cell in text.split(CELL):
        yield "\n" * before + cell
        before += cell.count("\n") + 1


def run(example: Example, folder: Path, force: bool) -> list[Path]:
    """Run an example, which prints, and save its pictures into a folder, and a page of its `answer`, a response.

    Args:
        example: the example.
        folder: that of the files, which is made for the first of them.
        force: whether a file that is there may be replaced.

    Returns:
        The files.

    Raises:
        FileExistsError: for a file that may not be replaced.
    """
    from matplotlib.figure import Figure  # the list needs no pictures

    from ..plotting.browser import view
    from ..plotting.style import save
    from ..result.response import Response

    names: dict[str, Any] = {"__name__": "__main__", "__file__": str(example.path)}
    written: list[Path] = []
    for ending in ("_1.png", ".html"):
        require_free(folder / f"{example.path.stem}{ending}", force)
    for cell in cells_of(example.text):
        exec(compile(cell, example.path, "exec"), names)
        sys.stdout.flush()
        figure = names.pop("figure", None)
        if isinstance(figure, Figure):
            folder.mkdir(parents=True, exist_ok=True)
            path = folder / f"{example.path.stem}_{len(written) + 1}.png"
            written.append(save(figure, require_free(path, force)))
    response = names.get("answer")
    if isinstance(response, Response):
        written.append(view(response, require_free(folder / f"{example.path.stem}.html", force)))
    return written


def answer(argv: Sequence[str]) -> Answer:
    """List the examples, run one, or copy its script.

    Raises:
        ValueError: for an example that is not there.
        OSError: if a file cannot be written, or is there and may not be replaced.
    """
    parser = parser_of("examples", "List the examples, run one, which prints, draws and writes a page, or copy it.")
    parser.add_argument("name", nargs="?", help="its number or name, such as 7 or push_over; none lists them")
    parser.add_argument("-c", "--copy", action="store_true", help="write the script, to be changed, and do not run it")
    add_output(parser, "folder of the pictures and the page, or of the script", "the current one")
    args = parser.parse_args(argv)
    if args.name is None:
        lines = aligned([(example.path.stem, example.title) for example in examples()], "<")
        return Answer("\n".join([*lines, "", "mjrock examples NAME runs one."]))
    example, folder = example_named(args.name), args.output or Path()
    if args.copy:
        folder.mkdir(parents=True, exist_ok=True)
        written = write_text(require_free(folder / example.path.name, args.force), example.text)
        return Answer(f"written: {written}")
    files = run(example, folder, args.force)
    return Answer(f"written: {', '.join(map(str, files))}")
