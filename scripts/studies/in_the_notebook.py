"""Cells of docs/notebook.md and what Jupyter shows below them, as a browser shows it.

The cells run in a kernel of Jupyter. Those whose last value is a case or a comparison are drawn. Writes notebook.png.
Needs Chromium, which draws without a display.
"""

from __future__ import annotations

import html
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import nbclient
import nbformat
import numpy as np
from matplotlib import image
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

from scripts.shared import cli
from scripts.studies import in_the_browser

PAGE = Path(__file__).resolve().parents[2] / "docs" / "notebook.md"
SHOWN = ("case", "mr.compare(theory, run)")
"""Last lines of the cells that are drawn."""
WIDE, FINE = 740, 2
"""Width of the page, and pixels of the picture for one of it."""
STYLE = """body { margin: 0; padding: 4px 8px; font: 13px sans-serif }
pre { margin: 0; font: 12px monospace; padding: 6px }
.cell { display: grid; grid-template-columns: 64px 1fr; margin-bottom: 10px } .cell > * { min-width: 0 }
.prompt { color: #666; font: 12px monospace; padding-top: 7px }
.highlight { background: #f5f5f5; border: 1px solid #ddd }
img { max-width: 100% } table { border-collapse: collapse; font-size: 12px } td, th { padding: 3px 8px }"""


def ran(quick: bool) -> list[nbformat.NotebookNode]:
    """The cells of the page up to the last that is drawn, after they have run; the quick ones end with the first."""
    text = re.split("^## Masonry$", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[0]
    codes = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    cells = [nbformat.v4.new_code_cell(code.rstrip()) for code in codes[: 1 if quick else None]]
    notebook = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(notebook, timeout=300).execute()
    return cells


def page_of(cells: Sequence[nbformat.NotebookNode]) -> str:
    """The cells that are drawn as a page."""
    colours = HtmlFormatter(style="friendly")
    rows = [f"<meta charset='utf-8'><style>{colours.get_style_defs('.highlight')}{STYLE}</style>"]
    for cell in cells:
        if cell.source.splitlines()[-1] not in SHOWN:
            continue
        number = cell.execution_count
        rows.append(f"<div class='cell'><div class='prompt'>In [{number}]:</div>")
        rows.append(f"{highlight(cell.source, PythonLexer(), colours)}</div>")
        for output in (one for one in cell.outputs if "data" in one):
            shown = f"<pre>{html.escape(output.data['text/plain'])}</pre>"
            if "image/png" in output.data:
                shown = f"<img src='data:image/png;base64,{output.data['image/png']}'>"
            rows.append(f"<div class='cell'><div class='prompt'>Out[{number}]:</div><div>{shown}</div></div>")
    return "".join(rows)


def main(argv: Sequence[str] | None = None) -> None:
    """Run the cells and draw them."""
    args = cli.parser(__doc__, "in_the_notebook").parse_args(argv)
    out, cells = cli.folder(args.out), ran(args.quick)
    with TemporaryDirectory() as folder:
        page, drawn = Path(folder) / "notebook.html", Path(folder) / "notebook.png"
        page.write_text(page_of(cells), encoding="utf-8")
        in_the_browser.picture(page, drawn, "", (WIDE, 1600), FINE)
        pixels = image.imread(drawn)
    rows = np.flatnonzero((pixels[..., :3] < 1).any(axis=(1, 2)))
    image.imsave(out / "notebook.png", pixels[: rows[-1] + 8 * FINE])
    print(f"{len(cells)} cells have run")


if __name__ == "__main__":
    sys.exit(cli.run(main))
