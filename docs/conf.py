"""How Sphinx builds this documentation: `make docs` writes docs/build/html/index.html and needs no network."""

from __future__ import annotations

import functools
import html
import inspect
import os
import re
import shutil
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
from docutils import nodes
from latex2mathml.converter import convert
from matplotlib.figure import Figure
from sphinx.util.inspect import TypeAliasForwardRef

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

import made_pages  # noqa: E402

import mjrock  # noqa: E402
from scripts.studies.in_the_browser import falling_arch  # noqa: E402
from scripts.studies.thumbnails import THUMBNAILS  # noqa: E402

matplotlib.use("agg")

project = "mjrock"
author = "The mjrock developers"
SENTENCE = "Rigid blocks of masonry under earthquakes, in MuJoCo, by explicit steps and by rocking theory."
copyright = "the mjrock developers, Apache-2.0"
release = version = mjrock.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
extensions += ["sphinx.ext.viewcode", "sphinx_gallery.gen_gallery"]
exclude_patterns = ["build", "figures"]
default_role = "literal"  # docstrings and examples name things in single backticks
nitpicky = True  # a name that leads nowhere is an error
# The site is built without a network, so that names of other packages lead nowhere; nor do types that are not in the
# reference, such as parts of a public class.
nitpick_ignore_regex = [
    ("py:class", r"(numpy|matplotlib|collections|concurrent|pathlib|os|typing|mujoco|pandas|xarray)\b.*"),
    ("py:class", r"mjrock\.[\w.]+"),
    ("py:class", r"Array|ArrayLike|Flags|Integers|Path"),
]

myst_heading_anchors = 3
myst_enable_extensions = ["attrs_inline", "dollarmath"]
html_math_renderer = "mathml"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {name: name for name in ("Array", "ArrayLike", "Flags", "Integers")}
TypeAliasForwardRef.__repr__ = lambda alias: alias.name  # type: ignore[method-assign]  # inside a tuple too
autodoc_default_options = {"members": True}
python_maximum_signature_line_length = 88
napoleon_numpy_docstring = False
napoleon_custom_sections = [("Warns", "returns_style")]

sphinx_gallery_conf = {
    "examples_dirs": str(Path(mjrock.__file__).parent / "examples"),
    "gallery_dirs": "auto_examples",
    "filename_pattern": r"/\d\d_",
    "ignore_pattern": r"__init__\.py",
    "image_scrapers": ("figure_scraper",),
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "notebook_extensions": (),
    "remove_config_comments": True,
    "show_memory": False,
    "show_signature": False,
    "matplotlib_animations": False,
    "write_computation_times": False,
    "reset_modules": (),
}

html_theme = "furo"
html_title = "mjrock"
html_static_path = ["static"]
LIVE = HERE / "build" / "live"
html_extra_path = ["build/live"]
html_css_files = ["mjrock.css"]
html_js_files = ["films.js"]
html_search_scorer = str(HERE / "static" / "scorer.js")
html_favicon = html_logo = "static/mark.svg"
html_theme_options = {"sidebar_hide_name": False}
html_baseurl = os.environ.get(
    "READTHEDOCS_CANONICAL_URL", ""
)  # where a card of the site is found, if it is put on the web
html_copy_source = False
html_show_sourcelink = False
templates_path: list[str] = []

PUBLIC = {
    full.rpartition(".")[2]: full
    for page in sorted((HERE / "api").glob("*.md"))
    for _, full in made_pages.NAMED.findall(page.read_text("utf-8"))
}
"""Where the reference has each public name."""
MARKS = re.compile(r"(``[^`]*``)|`([^`]*)`|([|*])")
"""Text between backticks, or a mark that reStructuredText would take for its own."""


DESCRIBED = (types.FunctionType, classmethod, staticmethod, property, functools.cached_property)
"""Members of a class that the reference has; its fields stand in the text of the class."""


def linked(text: str) -> str:
    """Code of a docstring: a link where it is a public name or a method of one, and else as it is written."""
    name, _, member = text.partition(".")
    full = PUBLIC.get(name)
    thing = functools.reduce(getattr, full.split(".")[1:], mjrock) if full else None
    if full is None or (member and not isinstance(inspect.getattr_static(thing, member, None), DESCRIBED)):
        return f"``{text}``"
    return f":py:obj:`{text} <{full}{'.' * bool(member)}{member}>`"


def written(found: re.Match[str]) -> str:
    """Code as a link or as it is, and a mark as a letter."""
    literal, code, mark = found.groups()
    return literal or (f"\\{mark}" if mark else linked(" ".join(code.split())))


def plain(app: object, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Make links of public names, and keep |e| and 2**53 in docstrings as they are written."""
    text = MARKS.sub(written, "\n".join(lines))
    if what in ("attribute", "property", "data"):
        text = re.sub(r"\A([^\n`]*):[ ]", r"\1:\n", text)  # napoleon would take what is before it for a type
    lines[:] = text.split("\n")


ANNOTATED = re.compile(r"(?:\w+\.)*Annotated\[")


def plain_types(text: str) -> str:
    """A signature without what is declared beside a type, such as the range of a number, which its text has."""
    while found := ANNOTATED.search(text):
        depth, end, at = 1, 0, found.end()
        while depth:
            depth += (text[at] in "[({") - (text[at] in "])}")
            end = end or (at if depth == 0 or (depth == 1 and text[at] == ",") else 0)
            at += 1
        text = text[: found.start()] + text[found.end() : end] + text[at:]
    return text


def without_ranges(
    app: object, what: str, name: str, obj: object, options: object, signature: str | None, returns: str | None
) -> tuple[str | None, str | None]:
    """A signature without the declared ranges of numbers, and `...` for what a factory makes."""
    return signature and plain_types(signature.replace("<factory>", "...")), returns


def compile_loops() -> None:
    """Simulate a wall once, so that no example shows the line that is printed while loops are compiled."""
    wall = mjrock.Block.from_size(thickness=0.6, height=4.2)
    contacts = mjrock.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
    motion = mjrock.GroundMotion.sine(1.0, 0.1)
    tie = mjrock.Tie(height=4.0, stiffness=1e6, strength=1e3)
    case = mjrock.Case(wall, 0.0, 0.1, side_stop=False, motion=motion, effects=(tie,))
    mjrock.simulate(case, contacts)
    mjrock.solve_analytical(case, mjrock.Restitution.from_geometry(wall))


def write_live_view() -> None:
    """Write the page that results.md shows: an arch whose support moves away, to be turned and played."""
    LIVE.mkdir(parents=True, exist_ok=True)
    mjrock.plotting.view(falling_arch(), LIVE / "arch_view.html")


def copy_films() -> None:
    """Copy films and their posters to where pages play them."""
    (LIVE / "films").mkdir(parents=True, exist_ok=True)
    for film in sorted(made_pages.FIGURES.glob("*.mp4")):
        for ending in (".mp4", ".webm", ".webp"):
            shutil.copy(film.with_suffix(ending), LIVE / "films")


def write_card() -> None:
    """Write the picture that a message shows which links to the site: a façade as it falls, and the name."""
    film = made_pages.whole("facade_in_space.webp")
    figure = Figure(figsize=(12.0, 6.3), dpi=100)
    ax = figure.add_axes((0.0, 0.2, 1.0, 0.8))
    ax.imshow(film.crop((0, film.height // 9, film.width, 8 * film.height // 9)), aspect="equal")
    ax.axis("off")
    figure.text(0.04, 0.09, "mjrock", fontsize=44, weight="bold", va="center")
    figure.text(0.96, 0.09, "rocking masonry in MuJoCo and by theory", fontsize=24, va="center", ha="right")
    figure.savefig(LIVE / "card.png")


compile_loops()
write_live_view()
copy_films()
shutil.copy(HERE.parent / "CITATION.cff", LIVE)
write_card()


def as_mathml(display: str) -> Callable[[Any, nodes.math | nodes.math_block], None]:
    """What writes a formula as MathML, which a browser draws without a script."""

    def visit(page: Any, node: nodes.math | nodes.math_block) -> None:
        page.body.append(convert(node.astext(), display=display))
        raise nodes.SkipNode

    return visit


def made(app: Any, page: str, source: list[str]) -> None:
    """The text of a page as the site has it, which is made anew when what it is made of changes."""
    source[0] = made_pages.made(page, source[0])
    for other in made_pages.made_of(page):
        app.env.note_dependency(other)


TREES: dict[int, str] = {}
"""The tree of pages as a listing of source shows it, by how many folders it lies in."""


def one_tree(app: Any, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Make the tree of pages once for all listings of source in as many folders, which it does not name: .1 s each."""
    if page.startswith(("_modules/", "scripts/")):
        depth, tree = page.count("/"), context["toctree"]
        context["toctree"] = lambda **options: TREES.get(depth) or TREES.setdefault(depth, tree(**options))


THUMBNAIL = re.compile(r'<img alt="" (?=src="[^"]*sphx_glr_(\w+)_thumb)')
"""The small picture of an example, whose file is named after it."""


def small_pictures(app: Any) -> None:
    """Put the small pictures of buildings in the place of those that are cut from the figures of the examples."""
    for name in THUMBNAILS:
        picture = made_pages.whole(f"examples/{name}.png")
        picture.thumbnail((400, 280))
        picture.save(HERE / "auto_examples" / "images" / "thumb" / f"sphx_glr_{name}_thumb.png")


COMMAND = re.compile(r'<code class="(?=[^>]*><span class="pre">(?:python|mjrock|pip|make)</span> )')
"""Code within a sentence that is a command, which goes on the next line as a whole where it does not fit."""
SHOWN = PUBLIC | {name: f"mjrock.blocks.{name}" for name in mjrock.blocks.__all__}
BACK = re.compile(r"(?<=#)mjrock(?!\.plotting\.)(?:\.[a-z_]+)*\.(\w+)(?=\">\[docs\])")
"""From the source of a function or class back to its text. Sphinx takes one module for all names of a file."""


def finished(app: Any, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Load pictures of the gallery below the first as they come into sight, and say what a link to a page shows."""
    body = THUMBNAIL.sub(lambda found: f'<img alt="{THUMBNAILS[found[1]].label}" ', context.get("body") or "")
    body = re.sub(r"<td>(?=<p>[^\s<]{1,12}</p>)", '<td class="short">', body)  # 5.8e-04 is not broken at its hyphen
    body = COMMAND.sub('<code class="command ', body)
    body = re.sub(r'<span class="pre">(?=[^<-]{0,12}-[^<]{0,12}</span>)', '<span class="pre short">', body)  # nor is -m
    body = BACK.sub(lambda found: SHOWN.get(found[1], found[0]), body)
    first, *others = re.split(r"(?=<img )", body)
    above, others = "".join([first, *others[:1]]), others[1:]
    late = '<img loading="lazy" ' if page == "gallery" else "<img "  # elsewhere headings would move
    context["body"] = above + "".join(part.replace("<img ", late, 1) for part in others)
    title = re.sub(r"<[^>]*>", "", context.get("title", project))
    said = {"og:title": title, "og:site_name": project, "og:image": f"{app.config.html_baseurl}card.png"}
    said |= {"og:description": SENTENCE, "twitter:card": "summary_large_image"}
    tags = "".join(f'<meta property="{name}" content="{html.escape(text)}">' for name, text in said.items())
    context["metatags"] = context.get("metatags", "") + tags


def setup(app: object) -> None:
    """Write formulas, and read docstrings as plain text, before napoleon does, and signatures without ranges."""
    app.add_html_math_renderer("mathml", (as_mathml("inline"), None), (as_mathml("block"), None))  # type: ignore[attr-defined]
    app.connect("autodoc-process-docstring", plain, priority=100)  # type: ignore[attr-defined]
    app.connect("autodoc-process-signature", without_ranges)  # type: ignore[attr-defined]
    app.connect("source-read", made)  # type: ignore[attr-defined]
    app.connect("html-collect-pages", lambda app: made_pages.listings())  # type: ignore[attr-defined]
    app.connect("html-page-context", one_tree, priority=100)  # type: ignore[attr-defined]  # before the theme takes it
    app.connect("builder-inited", small_pictures, priority=900)  # type: ignore[attr-defined]  # once examples have run
    app.connect("html-page-context", finished)  # type: ignore[attr-defined]
