"""What set-up costs by number of blocks: processor time of its parts, memory, and a search for contacts.

Walls in running bond, and façades in space with return walls, each in a process of its own. The parts are the blocks
with their joints, their contact lines, the lowest frequency for stiffness-proportional damping, the pose of rest, and
what explicit steps need beyond. A search finds the contacts of all blocks that have no joint. Prints the table with
the estimate of memory by which masonry is refused, and writes setup_cost.txt and .csv.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock.distinct.search.constants import NEAR
from mjrock.distinct.setup import masonry_at_rest
from mjrock.scene.masonry import masonry_scene
from mjrock.scene.rest import memory_of
from scripts.shared import cli

BLOCKS = {"wall": (1000, 5000), "façade": (1000, 3000, 24_000)}
HEADER = (
    "scene",
    "blocks",
    "lines",
    "joints [s]",
    "lines [s]",
    "frequency [s]",
    "rest [s]",
    "steps [s]",
    "all [s]",
    "memory [MB]",
    "estimate [MB]",
    "search [ms]",
    "pair [ns]",
)


def masonry_of(kind: str, blocks: int) -> mr.Masonry:
    """A wall of the plane of some blocks, or a façade of one height."""
    if kind == "wall":
        rows = max(1, round(math.sqrt(blocks)))
        return mr.Masonry.running_bond(round(blocks / rows) * 0.4, rows * 0.2, (0.4, 0.2), k_n=1e10, k_s=1e10)
    length = max(0.25 * round(blocks / 24), 1.0)
    return mr.Masonry.facade(length, 3.0, 1.0, (0.25, 0.125), thickness=0.25, k_n=1e10, k_s=5e9)


def measured(kind: str, blocks: int) -> list[object]:
    """A row of the table."""
    times = [time.process_time()]

    def lap(_: object) -> None:
        times.append(time.process_time())

    masonry = masonry_of(kind, blocks)
    lap(masonry.joints)
    lap(masonry.lines)
    lap(masonry.retardation)
    scene = masonry_scene(mr.MasonryCase(masonry, 1.0))
    lap(scene.at_rest)
    at_rest = masonry_at_rest(scene)
    lap(at_rest)
    search, every = at_rest.search, np.ones(len(masonry.blocks), dtype=bool)
    begun = time.process_time()
    for _ in range(3):
        search.finder.places_near(search.limits.start, NEAR * search.sizes, every, search.finder.jointed)
    took = (time.process_time() - begun) / 3
    lines, free = len(masonry.lines.k), len(masonry.free)
    row = [kind, free, lines, *np.diff(times).round(2), round(times[-1] - times[0], 2), round(peak())]
    return [
        *row,
        round(memory_of(free, lines, in_space=masonry.in_space) / 1e6),
        took * 1e3,
        took / len(masonry.joints) * 1e9,
    ]


def peak() -> float:
    """The most memory that this process has had [MB], zero where the system does not say."""
    try:
        import resource
    except ImportError:  # Windows
        return 0.0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and write the table."""
    options = cli.parser(__doc__, "setup_cost")
    options.add_argument("--facade", type=int, nargs="+", help="numbers of blocks of façades, instead of all scenes")
    options.add_argument("--one", nargs=2, metavar=("SCENE", "BLOCKS"), help="print the row of one scene as JSON")
    args = options.parse_args(argv)
    if args.one:
        measured(args.one[0], 30)  # takes the stored loops
        print(json.dumps(measured(args.one[0], int(args.one[1]))))
        return
    out = cli.folder(args.out)
    chosen = {"façade": tuple(args.facade)} if args.facade else BLOCKS
    scenes = [(kind, blocks) for kind, sizes in chosen.items() for blocks in ((30,) if args.quick else sizes)]
    command = [sys.executable, "-m", "scripts.measure.setup_cost", "--one"]
    rows = []
    for kind, blocks in tqdm(scenes, disable=None, leave=False):
        text = subprocess.run([*command, kind, str(blocks)], check=True, capture_output=True, text=True).stdout
        rows.append([f"{value:.3g}" if isinstance(value, float) else value for value in json.loads(text)])
    cli.report(out / "setup_cost", cli.table(HEADER, rows), HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
