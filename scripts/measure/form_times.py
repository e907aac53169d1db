"""The form in the browser: from the command to the page and to the first verdict, and from a change to the new one.

The requests are those of the page, sent over the same connection. What the browser needs to draw is not counted.
"""

from __future__ import annotations

import http.client
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from tqdm import tqdm

from scripts.shared import cli

HEADER = ["mechanism", "verdict [s]", "longest [s]", "with the sketch [s]"]
CHANGED = {"corner": ("thickness",), "bending": ("wall", "thickness")}
"""Where the thickness of a template stands, unless it is in the wall."""


@contextmanager
def served() -> Iterator[str]:
    """The address of a form that runs until the end of the block."""
    command = [sys.executable, "-m", "mjrock", "app", "--no-browser"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stderr is not None
            yield process.stderr.readline().split()[-1]
        finally:
            process.terminate()


def parts(address: str, task: str, request: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The parts of the answer to a task as they come."""
    place = urlsplit(address)
    connection = http.client.HTTPConnection(place.netloc)
    body = json.dumps(request).encode()
    connection.request("POST", f"{place.path}do/{task}", body, {"Content-Type": "application/json"})
    response = connection.getresponse()
    for line in response:
        part = json.loads(line)
        if "error" in part or "faults" in part:
            raise RuntimeError(f"{task}: {part}")
        yield part
    connection.close()


def thicker(state: dict[str, Any], name: str, by: float) -> dict[str, Any]:
    """The input of a template with another thickness [cm]."""
    made: dict[str, Any] = json.loads(json.dumps(state))
    *tables, key = CHANGED.get(name, ("wall", "thickness"))
    table = made
    for one in tables:
        table = table[one]
    table[key] = f"{float(table[key].split()[0]) + by:g} cm"
    return made


def times(address: str, state: dict[str, Any]) -> tuple[float, float]:
    """Time from a request to the verdict, and to the sketch [s]."""
    begun = time.perf_counter()
    found = {key: time.perf_counter() - begun for part in parts(address, "check", {"state": state}) for key in part}
    return found["verdict"], found.get("sketch", found["verdict"])


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print and write the table."""
    options = cli.parser(__doc__, "form_times")
    options.add_argument("--changes", type=int, default=20, help="changes of each mechanism")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    begun = time.perf_counter()
    with served() as address:
        starts = {"address": time.perf_counter() - begun}
        plan = next(parts(address, "form", {"language": "en"}))
        starts["form"] = time.perf_counter() - begun
        names = [name for name in plan["states"] if name not in ("masonry", "bending")]
        times(address, plan["states"][names[0]])
        starts["first verdict"] = time.perf_counter() - begun
        rows = []
        for name in tqdm(names[:1] if args.quick else names, desc="mechanisms", disable=None, leave=False):
            count = 2 if args.quick else args.changes
            found = [times(address, thicker(plan["states"][name], name, 0.1 * (1 + i))) for i in range(count)]
            verdicts, sketches = zip(*found, strict=True)
            usual = statistics.median(verdicts), max(verdicts), statistics.median(sketches)
            rows.append([name, *(f"{one:.2f}" for one in usual)])
    summary = ", ".join(f"{name} after {one:.1f} s" for name, one in starts.items())
    cli.report(out / "form_times", f"from the command: {summary}\n\n{cli.table(HEADER, rows)}", HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
