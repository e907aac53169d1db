"""What an own law of joints costs: nanoseconds of the processor for a contact line and step, beside the built-in one.

A wall in running bond rests on its joints. The built-in spring, the same spring as an own law, and one with a memory
take turns, and the least time of each counts. Prints the table, and writes own_laws.txt and .csv.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import mjrock as mr
from scripts.shared import cli

K_N, TURNS = 1e9, 5
HEADER = ["law", "ns a line and step"]


@mr.joint_law
class Linear:
    """The built-in spring."""

    def stress(self, u: float) -> float:
        """Pressure [Pa]."""
        return self.k_n * u if u > 0 else 0.0  # type: ignore[attr-defined]

    def energy(self, u: float) -> float:
        """Its integral [J/m2]."""
        return 0.5 * self.k_n * u * u if u > 0 else 0.0  # type: ignore[attr-defined]


@mr.joint_law
class Remembering:
    """The same spring, which remembers how far each line has closed."""

    memory = ("deepest",)

    def remember(self, u: float) -> None:
        """Change the memory."""
        self.deepest = max(self.deepest, u)  # type: ignore[has-type]

    def stress(self, u: float) -> float:
        """Pressure [Pa]."""
        return self.k_n * u if u > 0 else 0.0  # type: ignore[attr-defined]

    def energy(self, u: float) -> float:
        """Its integral [J/m2]."""
        return 0.5 * self.k_n * u * u if u > 0 else 0.0  # type: ignore[attr-defined]


def case_of(law: object) -> mr.MasonryCase:
    """The wall."""
    joints = mr.Dry(k_n=K_N, k_s=K_N, law=law)  # type: ignore[arg-type]
    return mr.MasonryCase(mr.Masonry.running_bond(4.0, 2.0, (0.4, 0.2), joints=joints), 0.02)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print and write own_laws.txt and .csv."""
    args = cli.parser(__doc__, "own_laws").parse_args(arguments)
    out = cli.folder(args.out)
    laws = {"built-in spring": None, "the same as an own law": Linear(), "one with a memory": Remembering()}
    best = dict.fromkeys(laws, math.inf)
    for _ in range(1 if args.quick else TURNS):
        for name, law in laws.items():
            case = case_of(law)
            answer = mr.solve_explicit(case, timestep=2e-5, output_step=0.02)
            steps = answer.stats["steps"] * len(case.masonry.lines.k)
            best[name] = min(best[name], answer.stats["stepping_processor_time"] / steps)
    rows = [[name, f"{1e9 * taken:.1f}"] for name, taken in best.items()]
    cli.report(out / "own_laws", cli.table(HEADER, rows), HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
