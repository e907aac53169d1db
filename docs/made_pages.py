"""What the site makes of pages as it reads them: tables of names, cards of the gallery, and the home page."""

from __future__ import annotations

import functools
import importlib
import inspect
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

from PIL import Image
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer
from sphinx.pycode import ModuleAnalyzer

HERE = Path(__file__).parent
FIGURES = HERE / "figures"
THUMBS = HERE / "build" / "thumbs"
WIDE = 560
"""Width of a thumbnail [pixel]: twice that of a card, for screens of fine pitch."""
MARK = re.compile(r"[|*]")
"""What Markdown would take for its own."""
NAMED = re.compile(r"^\.\. auto(\w+):: (mjrock[\w.]*)$", re.MULTILINE)
FILM = re.compile(r"\[!\[([^\]]*)\]\(figures/(\w+)\.webp\)\]\(figures/\2\.mp4\)")
"""A film of a page: its poster, which leads to it where no page plays it."""
LOOPED = re.compile(r"!\[([^\]]*)\]\(figures/(\w+)\.gif\)")
"""A film of the README, which GitHub plays as a GIF."""
SECTION = re.compile(r"^\[([^\]]+)\]\((\.\./\w+\.md|figures/\w+\.md)(#[\w-]+)?\)$", re.MULTILINE)
"""A link that stands alone on a line. The site has the text that it leads to: a file, or the section of this title."""
EXAMPLE = re.compile(r"\]\(\.\./mjrock/examples(?:/(\w+)\.py)?\)")
CONTENTS = re.compile(r"(?:^## (.+)\n\n)?((?:^\* \[.+\]\([\w./]+\)\n)+)", re.MULTILINE)
"""A list of pages, and its title."""
NAMES = "<!-- names -->"
"""Where a page of the reference has the table of its names."""
SCRIPT = re.compile(r"`(scripts/[\w/]+)\.py([^`]*)`")
PICTURE = re.compile(r"\[?!\[([^\]]*)\]\(figures/([\w/]+\.\w+)\)(?:\]\(figures/\w+\.mp4\))?\n")
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
        return text.replace(NAMES, table_of(listed(text)))
    tables = [
        f"## {link}\n\n{table_of(listed((HERE / name).read_text(encoding='utf-8')))}"
        for link, name in re.findall(r"^\* (\[.+\]\((api/\w+\.md)\))$", text, re.MULTILINE)
    ]
    return CONTENTS.sub(contents, text).replace(NAMES, "\n\n".join(tables))


def contents(found: re.Match[str]) -> str:
    """A list of pages as the tree that Sphinx makes the sidebar of."""
    title, listed = found.groups()
    pages = "\n".join(re.findall(r"\(([\w/]+)\.\w+\)", listed))
    options = f":caption: {title}\n:hidden:" if title else ":maxdepth: 1"
    return f"```{{toctree}}\n{options}\n\n{pages}\n```\n"


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


def player(found: re.Match[str]) -> str:
    """A film with its controls. `static/films.js` plays it while it is in sight, but for readers who want no motion."""
    alt, name = found.groups()
    with Image.open(FIGURES / f"{name}.webp") as poster:
        size = 'width="{}" height="{}"'.format(*poster.size)
    sources = "".join(f'<source src="films/{name}.{kind}" type="video/{kind}">' for kind in ("webm", "mp4"))
    film = (
        f'<video {size} poster="films/{name}.webp" preload="none" controls loop muted playsinline aria-label="{alt}">'
    )
    return f"```{{raw}} html\n{film}{sources}{alt}</video>\n```"


def section(found: re.Match[str]) -> str:
    """A section of a file of the repository, or all of it, with its links as the site has them."""
    title, name, part = found.groups()
    text = (HERE / name).read_text(encoding="utf-8")
    if part:
        _, _, text = text.partition(f"\n## {title}\n")
        text = text.partition("\n## ")[0]
    text = text.replace("](docs/", "](").replace("](VERSIONING.md)", "](versions.md)")
    text = text.replace("](mjrock/examples/", "](../mjrock/examples/")
    text = re.sub(r"\[([^\]]*)\]\((CITATION\.cff)\)", r'<a href="\2">\1</a>', text)
    text = re.sub(r"(\| \[!\[[^\]]*\]\()figures/([\w./]+)", lambda found: found[1] + thumbnail(found[2]), text)
    return LOOPED.sub(player, text)


def linked_scripts(page: str, text: str) -> str:
    """Names of scripts in the prose of a page as links to their text, of which `listings` makes pages."""
    up = "../" * page.count("/")
    parts = re.split(r"(?ms)(^`{3,}\{?.*?^`{3,}$)", text)
    parts[::2] = [SCRIPT.sub(rf'<a href="{up}\1.html"><code>\1.py\2</code></a>', part) for part in parts[::2]]
    return "".join(parts)


def listings() -> Iterator[tuple[str, dict[str, str], str]]:
    """Each script as a page of the site: its name, its title and listing, and the template."""
    form = HtmlFormatter(linespans="line")
    for script in sorted((HERE.parent / "scripts").glob("*/**/*.py")):
        name = script.relative_to(HERE.parent)
        listing = highlight(script.read_text(encoding="utf-8"), PythonLexer(), form)
        body = f'<h1>{name}</h1><div class="listing">{listing}</div>'
        yield name.with_suffix("").as_posix(), {"title": str(name), "body": body}, "page.html"


@functools.cache
def searched() -> dict[str, list[str]]:
    """Words that readers look for, by the page, or page#heading, that the search shows first."""
    return tomllib.loads((HERE / "search.toml").read_text(encoding="utf-8"))


def indexed(page: str, text: str) -> str:
    """A page whose headings have the words that the search finds them by, as entries of the index."""
    for place, words in searched().items():
        name, _, heading = place.partition("#")
        if name == page:
            entries = "```{index} " + ", ".join(f"! {word}" for word in words) + "\n```\n"
            found = re.search(rf"^#+ {re.escape(heading)}$" if heading else r"\A", text, re.MULTILINE)
            if found is None:
                raise ValueError(f"search.toml names {place!r}, and the page has no such heading")
            text = f"{text[: found.start()]}{entries}\n{text[found.start() :]}"
    return text


def made(page: str, text: str) -> str:
    """The text of a page as the site has it."""
    text = indexed(page, text)
    text = SECTION.sub(section, text)
    text = EXAMPLE.sub(lambda found: f"](auto_examples/{found[1] or 'index'}.rst)", text)
    if page == "index":
        text = CONTENTS.sub(contents, text)
    elif page == "gallery":
        text = gallery(text)
    elif page == "api" or page.startswith("api/"):
        text = reference(page, text)
    text = FILM.sub(player, text)
    return text if page.startswith("auto_examples") else linked_scripts(page, text)


def made_of(page: str) -> list[Path]:
    """The other files that a page of the site is made of."""
    return {
        "index": [HERE.parent / "README.md"],
        "limitations": [HERE.parent / "README.md"],
        "install": [HERE.parent / "README.md"],
        "versions": [HERE.parent / "VERSIONING.md"],
        "gallery": sorted(HERE.glob("*.md")),
        "api": sorted((HERE / "api").glob("*.md")),
    }.get(page, [])
