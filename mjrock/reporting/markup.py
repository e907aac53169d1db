"""The parts that a page is made of: headings, tables, formulae and pictures, as HTML, and the page as PDF."""

from __future__ import annotations

import base64
import html
import re
import textwrap
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text

from ..contacts.files import replacing
from .texts import MINUS, Words

TOKEN = re.compile(r"\d+(?:[.,]\d+)?|[^\W\d_]+|\S")
"""A number, a name or a sign of a formula."""
BRIEF = 12
"""Most rows of a table that a page does not part."""
MARGIN = 60
"""Longest text in the margin of a page."""
GREEK = {"alpha": "\u03b1"}
"""Letters that a formula spells."""
TAGS = {"_": "msub", "^": "msup", "/": "mfrac"}
"""What a sign between two parts of a formula makes of them."""

LOOK = """
@page { size: A4; margin: 19mm 16mm 17mm;
  @top-left { content: "TITLE"; font: 8pt Helvetica, Arial, sans-serif; color: #666 }
  @top-right { content: "PROJECT"; font: 8pt Helvetica, Arial, sans-serif; color: #666 }
  @bottom-right { content: "PAGE " counter(page) " / " counter(pages); font: 8pt Helvetica, Arial, sans-serif }
  @bottom-left { content: "VERSION"; font: 8pt Helvetica, Arial, sans-serif; color: #666 } }
body { font: 10pt/1.38 "Source Serif 4", Georgia, "DejaVu Serif", serif; color: #222; max-width: 48em;
  margin: 1.5em auto; padding: 0 1em; overflow-wrap: anywhere }
h1 { font-size: 1.5em; line-height: 1.2; margin: 0 0 .4em; padding-bottom: .2em; border-bottom: 2px solid #12406b }
h2 { font-size: 1.15em; margin: 1.2em 0 .4em; color: #12406b; break-after: avoid }
h3 { font-size: 1em; margin: 1em 0 .2em; break-after: avoid }
p { margin: .4em 0 }
.wide { overflow-x: auto; margin: .4em 0 .7em }
table { border-collapse: collapse; width: 100%; font: .8em/1.3 Helvetica, Arial, "DejaVu Sans", sans-serif }
th, td { text-align: left; vertical-align: top; padding: .2em .5em; border-bottom: 1px solid #ddd;
  overflow-wrap: normal }
th { border-bottom: 1px solid #888; font-weight: 600; vertical-align: bottom }
.right { text-align: right; font-variant-numeric: tabular-nums }
td.right, table.runs td { white-space: nowrap }
thead { display: table-header-group }
tr, figure, .brief, .whole { break-inside: avoid }
tbody tr:nth-child(-n+2) { break-after: avoid } tbody tr:nth-last-child(-n+2) { break-before: avoid }
h2 + p, p.head { break-after: avoid }
td.short { white-space: nowrap } td.all { text-align: center }
table.block td:nth-child(odd) { width: 8em; color: #666 }
table.inputs th:first-child { width: 30% } table.inputs th:last-child { width: 26% }
table.beside { table-layout: fixed; min-width: 40em }
table.beside th:first-child { width: 26% } table.beside th:last-child { width: 16% }
table.block td { height: 1.3em }
.holds { color: #0b5d3b; background: #e3f2ea; font-weight: 700; white-space: nowrap }
.fails { color: #8f1d14; background: #fbe6e3; font-weight: 700; white-space: nowrap }
.part { color: #6b4a00; background: #fdf1d8; font-weight: 700; white-space: nowrap }
figure { margin: .6em 0; text-align: center }
figure img { max-width: 100%; height: auto }
figcaption { font-size: .85em; color: #444 }
math { font-size: 1.15em; math-style: normal }
ul { margin: .3em 0; padding-left: 1.3em }
.sign { height: 4.5em; border: 1px solid #888; margin: .5em 0 }
@media print { body { max-width: none; margin: 0; padding: 0; font-size: 9.3pt } .wide { overflow: visible } }
"""
FORMULAE = """
math { white-space: nowrap } mo { padding: 0 .15em }
mfrac { display: inline-block; vertical-align: middle; text-align: center }
mfrac > * { display: block; padding: 0 .15em } mfrac > :last-child { border-top: .6pt solid }
msub > :last-child { font-size: .7em; vertical-align: sub }
msup > :last-child { font-size: .7em; vertical-align: super }
msqrt { display: inline-block; vertical-align: middle; padding-left: .8em;
  background: url("data:image/svg+xml;base64,ROOT") no-repeat left top / .8em 100% }
msqrt > * { display: inline-block; border-top: .6pt solid; vertical-align: top }
"""
"""How WeasyPrint sets formulae, which has no MathML."""
ROOT = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 8 24" preserveAspectRatio="none">'
    '<path d="M0.3 15 L2 13.8 L4.6 23.6 L8 0.3" fill="none" stroke="black" stroke-width="0.7"/></svg>'
)
"""A root sign as high as what stands under it."""


class Markup(str):
    """Text that is markup already. Any other text is escaped where it enters a page."""


def escaped(text: str) -> Markup:
    """Text as markup."""
    return text if isinstance(text, Markup) else Markup(html.escape(text))


def element(tag: str, *parts: str, **attributes: str) -> Markup:
    """An element with its parts, which are escaped unless they are markup; `kind` is its class."""
    given = "".join(f' {name.replace("kind", "class")}="{html.escape(value)}"' for name, value in attributes.items())
    return Markup(f"<{tag}{given}>{''.join(escaped(part) for part in parts)}</{tag}>")


def listed(texts: Sequence[str]) -> Markup:
    """Texts as a list."""
    return element("ul", *(element("li", text) for text in texts))


def table(columns: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[int] = (), kind: str = "") -> Markup:
    """A table, which can be moved sideways on a narrow screen.

    Args:
        columns: what stands above each; none for a table without a head.
        rows: of as many cells.
        right: numbers of the columns that hold numbers.
        kind: its class.
    """

    def line(tag: str, cells: Sequence[str]) -> Markup:
        made = []
        for i, cell in enumerate(cells):
            ready = isinstance(cell, Markup) and cell.startswith("<td")
            made.append(cell if ready else element(tag, cell, **({"kind": "right"} if i in right else {})))
        return element("tr", *made)

    head = [element("thead", line("th", columns))] if columns else []
    body = element("tbody", *(line("td", row) for row in rows))
    kinds = " ".join(filter(None, (kind, "brief" * (len(rows) <= BRIEF))))
    whole = element("table", *head, body, **({"kind": kinds} if kinds else {}))
    return element("div", whole, kind="wide")


def formula(text: str) -> Markup:
    """A formula as MathML. `_` and `^` set what follows low and high, `/` makes a fraction, √ a root, braces group."""
    tokens = TOKEN.findall(text)
    return element("math", *_row(tokens)) if text else Markup("")


def _row(tokens: list[str]) -> list[Markup]:
    """Parts of a formula up to the end of its group."""
    made = []
    while tokens and tokens[0] != "}":
        part = _item(tokens)
        while tokens and tokens[0] in TAGS:
            part = element(TAGS[tokens.pop(0)], part, _item(tokens))
        made.append(part)
    return made


def _item(tokens: list[str]) -> Markup:
    """One part of a formula."""
    token = tokens.pop(0)
    if token == "{":
        row = element("mrow", *_row(tokens))
        tokens.pop(0)
        return row
    if token == "√":
        return element("msqrt", _item(tokens))
    return element("mn" if token[0].isdigit() else "mi" if token[0].isalpha() else "mo", GREEK.get(token, token))


def picture(figure: Figure, caption: str, words: Words, *, own: bool = False) -> Markup:
    """A figure inside the page, see `image_of`."""
    return framed(image_of(figure, words, own=own), caption)


def framed(image: str, caption: str) -> Markup:
    """An image of `image_of` inside the page."""
    shown = Markup(f'<img alt="{html.escape(caption)}" src="data:image/png;base64,{image}">')
    return element("figure", shown, element("figcaption", caption))


def image_of(figure: Figure, words: Words, *, own: bool = False) -> str:
    """A figure as PNG in base 64, its texts in the language of the report with its decimal mark.

    One of the user, `own`, keeps its decimal points and is left as it was.
    """
    texts = figure.findobj(Text)
    was = [text.get_text() for text in texts]
    for text, content in zip(texts, was, strict=True):
        text.set_text(words.drawn(content))
    if words.mark != "." and not own:
        _marked(figure, words)
    file = BytesIO()
    figure.savefig(file, format="png", dpi=170, metadata={"Software": None})
    if own:
        for text, content in zip(texts, was, strict=True):
            text.set_text(content)
    return base64.b64encode(file.getvalue()).decode("ascii")


def _marked(figure: Figure, words: Words) -> None:
    """Write the decimal mark of the language at the ticks and in the texts of a figure."""
    figure.draw_without_rendering()
    for ax in figure.axes:
        for text in ax.texts:
            text.set_text(re.sub(r"(?<=\d)\.(?=\d)", words.mark, text.get_text()))
        for axis in (ax.xaxis, ax.yaxis):
            _mark_ticks(axis, words)


def _mark_ticks(axis: Axis, words: Words) -> None:
    """The same of the ticks of an axis that are numbers."""
    low, high = sorted(axis.get_view_interval())
    ticks = [tick for tick in axis.get_majorticklocs() if low <= tick <= high]
    labels = axis.get_major_formatter().format_ticks(ticks)
    if any("." in one for one in labels) and all(re.fullmatch(rf"[\d.{MINUS}]*", one) for one in labels):
        axis.set_ticks(ticks, labels=[words.marked(one) for one in labels])


def page(words: Words, title: str, project: str, version: str, parts: Sequence[Markup]) -> str:
    """The whole page. Title, project and version stand in the margins of paper."""
    margins = {"TITLE": title, "PROJECT": project, "VERSION": version, "PAGE": words("page")}
    look = re.sub(f'"({"|".join(margins)})', lambda found: f'"{_in_style(margins[found[1]])}', LOOK)
    size = '<meta name="viewport" content="width=device-width, initial-scale=1">'
    head = f'<meta charset="utf-8">{size}<title>{html.escape(title)}</title><style>{look}</style>'
    body = "\n".join(parts)
    return f'<!DOCTYPE html>\n<html lang="{words.language}"><head>{head}</head>\n<body>\n{body}\n</body></html>\n'


def _in_style(text: str) -> str:
    """Text within the quotes of a style sheet, in which nothing ends it."""
    short = textwrap.shorten(text, MARGIN, placeholder=" ...")
    return "".join(c if c.isalnum() or c == " " else f"\\{ord(c):x} " for c in short)


def pdf_writer() -> Any:
    """WeasyPrint.

    Raises:
        ImportError: if it, or a library that it needs, is missing.
    """
    try:
        import weasyprint
    except (ImportError, OSError) as error:
        raise ImportError(
            f"{error}; WeasyPrint makes a PDF: pip install weasyprint. Or give a path that ends in .html, and print "
            "the page from a browser"
        ) from error
    return weasyprint


def write_pdf(path: Path, text: str) -> None:
    """Write a page as PDF; ImportError as `pdf_writer`."""
    weasyprint = pdf_writer()
    sheet = FORMULAE.replace("ROOT", base64.b64encode(ROOT.encode()).decode())
    with replacing(path) as partial:
        weasyprint.HTML(string=text).write_pdf(partial, stylesheets=[weasyprint.CSS(string=sheet)])
