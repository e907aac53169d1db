"""What the site makes of pages as it reads them: tables of names, cards of the gallery, and the home page."""

from __future__ import annotations

import functools
import importlib
import inspect
import re
from pathlib import Path

from PIL import Image
from sphinx.pycode import ModuleAnalyzer

HERE = Path(__file__).parent
FIGURES = HERE / "figures"
THUMBS = HERE / "build" / "thumbs"
WIDE = 560
"""Width of a thumbnail [pixel]: twice that of a card, for screens of fine pitch."""
MARK = re.compile(r"[|*]")
"""What Markdown would take for its own."""
NAMED = re.compile(r"^\.\. auto(\w+):: (mjrock[\w.]*)$", re.MULTILINE)
PICTURE = re.compile(r"!\[([^\]]*)\]\(figures/([\w/]+\.\w+)\)\n")
CARD = re.compile(rf"^((?:{PICTURE.pattern}\n?)+)\*(.+?)\*\n$", re.MULTILINE | re.DOTALL)
"""Pictures of the gallery, and the caption below them."""


def listed(text: str) -> dict[str, str]:
    """Public names of a page of the reference and where each is; of a module, its functions."""
    found: dict[str, str] = {}
    for kind, full in NAMED.findall(text):
        if kind == "module":
            module = importlib.import_module(full)
            names = [name for name in module.__all__ if inspect.isfunction(getattr(module, name))]
            found |= {name: f"{full}.{name}" for name in names}
        else:
            found[full.rpartition(".")[2]] = full
    return found


def first_sentence(full: str) -> str:
    """The first sentence of what documents a name."""
    module, _, name = full.rpartition(".")
    thing = getattr(importlib.import_module(module), name)
    if inspect.isclass(thing) and thing.__name__ != name:
        return f"Another name of `{thing.__name__}`."
    documented = inspect.isclass(thing) or inspect.isfunction(thing)
    text = (
        inspect.getdoc(thing) if documented else "\n".join(ModuleAnalyzer.for_module(module).find_attr_docs()["", name])
    )
    return (
        re.split(r"(?<=[.:])\s(?=[A-Z`])|:\n|\n\n", (text or "").strip(), maxsplit=1)[0].replace("\n", " ").rstrip(":")
    )


def table_of(names: dict[str, str]) -> str:
    """Names and what each is, as a table whose names are links."""
    rows = [
        f"| {{py:obj}}`{name} <{full}>` | {MARK.sub(chr(92) + chr(92) + chr(92) + 'g<0>', first_sentence(full))} |"
        for name, full in names.items()
    ]
    return "\n".join(["| name | what it is |", "|---|---|", *rows])


def reference(page: str, text: str) -> str:
    """A page of the reference with its names in a table; the first page has those of all."""
    if page != "api":
        return text.replace("```{summary}\n```", table_of(listed(text)))
    tables = []
    for theme in re.findall(r"^api/\w+$", text, re.MULTILINE):
        below = (HERE / f"{theme}.md").read_text(encoding="utf-8")
        title = re.search(r"^# (.*)$", below, re.MULTILINE)
        tables.append(f"## [{title and title[1]}]({theme}.md)\n\n{table_of(listed(below))}")
    return text.replace("```{summary}\n```", "\n\n".join(tables))


def whole(figure: str, share: float = 0.5) -> Image.Image:
    """A picture on white, of a film its frame at a share of it."""
    with Image.open(FIGURES / figure) as picture:
        picture.seek(int(share * getattr(picture, "n_frames", 1)))
        shown = picture.convert("RGBA")
    return Image.alpha_composite(Image.new("RGBA", shown.size, "white"), shown).convert("RGB")


def thumbnail(figure: str) -> str:
    """A small copy of a picture; where it is, seen from the pages."""
    small = THUMBS / f"{re.sub(r'[./]', '_', figure)}.webp"
    if not small.exists():
        THUMBS.mkdir(parents=True, exist_ok=True)
        picture = whole(figure)
        picture.thumbnail((WIDE, WIDE), Image.Resampling.LANCZOS)
        picture.save(small, quality=80)
    return f"build/thumbs/{small.name}"


@functools.cache
def pages() -> dict[str, str]:
    """The pages that explain pictures, and their text."""
    written = {page.stem: page.read_text(encoding="utf-8") for page in sorted(HERE.glob("*.md"))}
    return {name: text for name, text in written.items() if name not in ("gallery", "index")}


def page_of(figure: str, caption: str) -> str:
    """The page that explains a picture: the first that shows it, else that of the caption, else that of its script."""
    showing = [name for name, text in pages().items() if f"](figures/{figure})" in text]
    (script,) = re.findall(r"scripts/[\w/]+\.py", caption)[:1] or [""]
    telling = [name for name, text in pages().items() if script and script in text]
    found = [*showing, *re.findall(r"\]\((\w+)\.md", caption), *telling]
    if not found:
        raise ValueError(f"No page explains {figure}: show it on one, or link one in its caption in gallery.md")
    return found[0]


def card(found: re.Match[str]) -> str:
    """Pictures as thumbnails that lead to the page that explains them, and the caption below."""
    caption = found.groups()[-1]
    parts = [
        f"```{{image}} {thumbnail(figure)}\n:alt: {alt}\n:target: {page_of(figure, caption)}.html\n```\n"
        for alt, figure in PICTURE.findall(found[1])
    ]
    return "````{container} card\n" + "\n".join([*parts, caption]) + "\n````\n"


def gallery(text: str) -> str:
    """The gallery as cards, side by side under each question."""
    head, *sections = re.split(r"(?m)^(?=## )", text)
    shown = []
    for section in sections:
        title, _, cards = section.partition("\n\n")
        shown.append(f"{title}\n\n`````{{container}} cards\n{CARD.sub(card, cards)}`````\n\n")
    return head + "".join(shown)


def home(text: str) -> str:
    """The home page: the README with small pictures in its table, and what the page itself has."""
    readme = (HERE.parent / "README.md").read_text(encoding="utf-8").replace("](docs/", "](")
    readme = re.sub(r"\]\(mjrock/examples/(\w+)\.py\)", r"](auto_examples/\1.rst)", readme)
    readme = re.sub(r"\[([^\]]*)\]\(CONTRIBUTING\.md[^)]*\)", r"\1", readme)
    readme = re.sub(r"\[!\[\]\(figures/([\w./]+)\)\]", lambda found: f"[![]({thumbnail(found[1])})]", readme)
    return text.replace("```{readme}\n```", readme)


def made(page: str, text: str) -> str:
    """The text of a page as the site has it."""
    if page == "index":
        return home(text)
    if page == "gallery":
        return gallery(text)
    return reference(page, text) if page == "api" or page.startswith("api/") else text


def made_of(page: str) -> list[Path]:
    """The other files that a page of the site is made of."""
    return {
        "index": [HERE.parent / "README.md"],
        "gallery": sorted(HERE.glob("*.md")),
        "api": sorted((HERE / "api").glob("*.md")),
    }.get(page, [])
