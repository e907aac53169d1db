"""The parts that a page is made of: headings, tables, formulae and pictures, as HTML, and the page as PDF."""

from __future__ import annotations

import base64
import html
import re
import textwrap
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from types import ModuleType

from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import Formatter

from ..contacts.files import replacing
from .texts import MINUS, Words

TOKEN = re.compile(r"\d+(?:[.,]\d+)?|[^\W\d_]+|\S")
"""A number, a name or a sign of a formula."""
MOST_UNBROKEN_ROWS = 12
"""Most rows of a table that a page does not part."""
LONGEST_MARGIN_TEXT = 60
"""Longest text in the margin of a page."""
GREEK = {"alpha": "\u03b1"}
"""Letters that a formula spells."""
TAGS = {"_": "msub", "^": "msup", "/": "mfrac"}
"""What a sign between two parts of a formula makes of them."""

DOTS_PER_INCH = 170
"""Dots of a picture in a page [1/inch]."""

STYLE_SHEET = Path(__file__).with_name("page.css")
"""The style sheet of a page."""
FORMULAE = STYLE_SHEET.with_name("formulae.css")
"""How WeasyPrint sets formulae, which has no MathML."""
ROOT = STYLE_SHEET.with_name("root.svg")
"""A root sign as high as what stands under it."""


class Markup(str):
    """Text that is markup already. Any other text is escaped where it enters a page."""


def escaped(text: str) -> Markup:
    """Text as markup."""
    return text if isinstance(text, Markup) else Markup(html.escape(text))


def element(tag: str, *parts: str, **attributes: str) -> Markup:
    """An element with its parts, which are escaped unless they are markup; `kind` is its class."""
    pairs = "".join(f' {name.replace("kind", "class")}="{html.escape(value)}"' for name, value in attributes.items())
    return Markup(f"<{tag}{pairs}>{''.join(escaped(part) for part in parts)}</{tag}>")


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
        cell_elements = []
        for i, cell in enumerate(cells):
            ready = isinstance(cell, Markup) and cell.startswith("<td")
            cell_elements.append(cell if ready else element(tag, cell, **({"kind": "right"} if i in right else {})))
        return element("tr", *cell_elements)

    head = [element("thead", line("th", columns))] if columns else []
    body = element("tbody", *(line("td", row) for row in rows))
    kinds = " ".join(filter(None, (kind, "brief" * (len(rows) <= MOST_UNBROKEN_ROWS))))
    table_element = element("table", *head, body, **({"kind": kinds} if kinds else {}))
    return element("div", table_element, kind="wide")


def formula(text: str) -> Markup:
    """A formula as MathML. `_` and `^` set what follows low and high, `/` makes a fraction, √ a root, braces group."""
    tokens = TOKEN.findall(text)
    return element("math", *_row(tokens)) if text else Markup("")


def _row(tokens: list[str]) -> list[Markup]:
    """Parts of a formula up to the end of its group."""
    parts = []
    while tokens and tokens[0] != "}":
        part = _item(tokens)
        while tokens and tokens[0] in TAGS:
            part = element(TAGS[tokens.pop(0)], part, _item(tokens))
        parts.append(part)
    return parts


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


def picture(figure: Figure, caption: str, words: Words, *, of_user: bool = False) -> Markup:
    """A figure inside the page, see `image_of`."""
    return framed(image_of(figure, words, of_user=of_user), caption)


def framed(image: str, caption: str) -> Markup:
    """An image of `image_of` inside the page."""
    image_element = Markup(f'<img alt="{html.escape(caption)}" src="data:image/png;base64,{image}">')
    return element("figure", image_element, element("figcaption", caption))


def image_of(figure: Figure, words: Words, *, of_user: bool = False) -> str:
    """A figure as PNG in base 64, its texts in the language of the report with its decimal mark.

    One of the user keeps its decimal points and is left as it was.
    """
    texts = figure.findobj(Text)
    was = [text.get_text() for text in texts]
    for text, content in zip(texts, was, strict=True):
        text.set_text(words.drawn(content))
    if words.mark != "." and not of_user:
        _write_marks(figure, words)
    file = BytesIO()
    figure.savefig(file, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    if of_user:
        for text, content in zip(texts, was, strict=True):
            text.set_text(content)
    return base64.b64encode(file.getvalue()).decode("ascii")


class MarkedTicks(Formatter):
    """Numbers at the ticks of an axis with the decimal mark of a language; where one is no number, as they were.

    Args:
        written: what writes them with points.
        words: the language.
    """

    def __init__(self, written: Formatter, words: Words) -> None:
        self.written, self.words = written, words

    def format_ticks(self, values: list[float]) -> list[str]:
        """The texts of all ticks."""
        labels = self.written.format_ticks(values)
        numbers = all(re.fullmatch(rf"[\d.{MINUS}]*", label) for label in labels)
        return [self.words.marked(label) for label in labels] if numbers else labels

    def get_offset(self) -> str:
        """The factor of all numbers, and what is to be added to them."""
        return self.words.marked(self.written.get_offset())


def _write_marks(figure: Figure, words: Words) -> None:
    """Write the decimal mark of the language at the ticks and in the texts of a figure."""
    for ax in figure.axes:
        for text in ax.texts:
            text.set_text(re.sub(r"(?<=\d)\.(?=\d)", words.mark, text.get_text()))
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_formatter(MarkedTicks(axis.get_major_formatter(), words))


def page(words: Words, title: str, project: str, version: str, parts: Sequence[Markup]) -> str:
    """The whole page. Title, project and version stand in the margins of paper."""
    margins = {"TITLE": title, "PROJECT": project, "VERSION": version, "PAGE": words("page")}
    look = re.sub(
        f'"({"|".join(margins)})',
        lambda match: f'"{_in_style(margins[match[1]])}',
        STYLE_SHEET.read_text(encoding="utf-8"),
    )
    size = '<meta name="viewport" content="width=device-width, initial-scale=1">'
    head = f'<meta charset="utf-8">{size}<title>{html.escape(title)}</title><style>{look}</style>'
    body = "\n".join(parts)
    return f'<!DOCTYPE html>\n<html lang="{words.language}"><head>{head}</head>\n<body>\n{body}\n</body></html>\n'


def _in_style(text: str) -> str:
    """Text within the quotes of a style sheet, in which nothing ends it."""
    short = textwrap.shorten(text, LONGEST_MARGIN_TEXT, placeholder=" ...")
    return "".join(c if c.isalnum() or c == " " else f"\\{ord(c):x} " for c in short)


def pdf_writer() -> ModuleType:
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
    return weasyprint  # type: ignore[no-any-return]


def write_pdf(path: Path, text: str) -> None:
    """Write a page as PDF.

    Raises:
        ImportError: as `pdf_writer`.
    """
    weasyprint = pdf_writer()
    sheet = FORMULAE.read_text(encoding="utf-8").replace('ROOT"', f'{base64.b64encode(ROOT.read_bytes()).decode()}"')
    with replacing(path) as partial:
        weasyprint.HTML(string=text).write_pdf(partial, stylesheets=[weasyprint.CSS(string=sheet)])
