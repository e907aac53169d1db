"""An arch that falls as its support moves away, in the page that `plotting.view` writes, as a browser shows it.

Eleven voussoirs span 2 m; the right abutment moves away by 0.5 m in 1 s. The site has the page itself below the
picture. Writes view.png. Needs Chromium, which draws without a display.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import mjrock as mr
from scripts.shared import cli

BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
SIZE = 1280, 800
"""Of the picture [pixel]."""
AT = 1.16
"""When it is drawn [s]."""


def falling_arch() -> mr.Response:
    """The arch."""
    arch = mr.Masonry.arch(radius=1.0, thickness=0.25, voussoirs=11, ground=True)
    away = {"right_abutment": ([0.0, 1.0], [0.0, 0.5], [0.0, 0.0])}
    return mr.solve_explicit(mr.MasonryCase(arch, 2.0, supports=away), output_step=0.02, forces=True)


def picture(page: Path, path: Path, fragment: str, size: tuple[int, int] = SIZE, fine: int = 1) -> None:
    """Draw a page of a size as a browser shows it, with a fragment of its address, and more pixels for one of it."""
    if BROWSER is None:
        raise RuntimeError("no Chromium is installed; install chromium, which draws the page")
    wide, high = size
    switches = ["--headless=new", "--no-sandbox", "--hide-scrollbars", f"--window-size={wide},{high}"]
    switches += [f"--force-device-scale-factor={fine}"]
    switches += ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with TemporaryDirectory() as folder:
        switches += [f"--user-data-dir={folder}", "--virtual-time-budget=10000", f"--screenshot={path.resolve()}"]
        subprocess.run(
            [BROWSER, *switches, f"{page.as_uri()}#{fragment}"], check=True, capture_output=True, timeout=120
        )


def main(argv: Sequence[str] | None = None) -> None:
    """Write the page and draw it."""
    args = cli.parser(__doc__, "in_the_browser").parse_args(argv)
    out = cli.folder(args.out)
    with TemporaryDirectory() as folder:
        page = mr.plotting.view(falling_arch(), Path(folder) / "arch.html")
        picture(page, out / "view.png", f"t={AT}")
        print(f"{page.stat().st_size / 1e6:.2f} MB of page; {out / 'view.png'} is drawn at {AT} s")


if __name__ == "__main__":
    sys.exit(cli.run(main))
