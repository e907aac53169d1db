"""The numbers that every solver answers in named scenes, and how far rounding moves them.

    python -m tests.digests                 # as JSON, from this process
    python -m tests.digests --write         # makes digests.json anew, under the kernels of several processors

A tolerance is 30 times the spread of an answer over the kernels, and over a length whose last digits are others, at
least 1e-12 of the answer. Write the file anew where an answer has changed on purpose, and say why in the commit.
"""

import argparse
import json
import sys

from mjrock.machine import description, kernels

from ..processors import KERNELS
from .digest_answers import NUDGED, STORED, answers, elsewhere
from .digest_scenes import SCENES

TIMES, FLOOR, GROWS, MOST = 30, 1e-12, 1e-9, 1e-3


def entry(name: str, runs: list[dict]) -> dict:
    """The answers of a scene with their tolerances, from runs of which the first counts."""
    kept, grows = {}, 0.0
    for label, value in runs[0][name].items():
        spread = max(abs(run[name][label] - value) for run in runs)
        tolerance = max(TIMES * spread, FLOOR * abs(value))
        if not tolerance <= MOST * abs(value):
            raise SystemExit(
                f"{name}, {label}: {value:g} rounds to {spread:.1e}; take what is stable, or a shorter run"
            )
        kept[label], grows = [value, float(f"{tolerance:.2g}")], max(grows, spread / abs(value) if value else 0.0)
    return ({"word": "grows"} if grows > GROWS else {}) | {"answers": kept}


def write() -> None:
    """Make the file anew, and print how far each scene differs between kernels and by last digits."""
    by_kernel, nudged = {}, {}
    for kernel in (*KERNELS, "Sandybridge"):
        found = elsewhere("--nudged", OPENBLAS_CORETYPE=kernel)
        if kernel in found["kernels"]:
            by_kernel[kernel], nudged[kernel] = found["answers"], found["nudged"]
    runs = [*by_kernel.values(), *nudged.values()]
    entries = {name: entry(name, runs) for name in SCENES}
    lines = [f" {json.dumps(name)}: {json.dumps(kept)}" for name, kept in entries.items()]
    STORED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    print(f"kernels: {', '.join(by_kernel)}; {sum(len(kept['answers']) for kept in entries.values())} answers")
    for name, kept in entries.items():
        apart = [
            max(
                abs(run[name][label] / value - 1)
                for run in ran.values()
                for label, (value, _) in kept["answers"].items()
            )
            for ran in (by_kernel, nudged)
        ]
        print(f"{name:40} by kernel {apart[0]:8.1e}  by last digits {apart[1]:8.1e}  {kept.get('word', '')}")


def main() -> None:
    """Print what this process answers, or write the file."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--write", action="store_true", help="make digests.json anew")
    parser.add_argument("--nudged", action="store_true", help="also with a length whose last digits are others")
    parser.add_argument("--backwards", action="store_true", help="take the scenes in the other order")
    parser.add_argument("--scenes", nargs="+", default=list(SCENES), help="which", metavar="NAME")
    options = parser.parse_args()
    if options.write:
        write()
        return
    names = options.scenes[::-1] if options.backwards else options.scenes
    found = {"description": description(), "kernels": [*kernels().values()], "answers": answers(names)}
    if options.nudged:
        found["nudged"] = answers(names, NUDGED)
    json.dump(found, sys.stdout, indent=1)


if __name__ == "__main__":
    main()
