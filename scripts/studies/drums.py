"""Overturning spectrum of a column of 1, 2, 4 and 8 drums of the same total size, under a sine pulse.

The column is 6 m high and 0.75 m wide, of stone of 2500 kg/m3, two-sided, with friction of 0.7. Its drums are square
prisms. Each joint is damped by the calibrated law for the wall above it. Squat walls lie outside the fit of the law:
its warnings are printed. The column of 4 drums is run on joints of 2 and of 4 lines.
Amplitudes are in multiples of g tan(alpha), which lifts the whole column, frequencies in multiples of its p.
Prints the least amplitude that overturns for every frequency, to 10 %, with rocking theory for one drum beside it.
A column has overturned when a drum has fallen.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, GREEN, ORANGE, Look
from mjrock.study.campaign.campaign import completed
from scripts.shared import cli, suite
from scripts.shared.labels import beside

COLUMN = mr.Block.from_size(thickness=0.75, height=6.0, length=0.75, density=2500.0)
COLUMNS = ((1, 2), (2, 2), (4, 2), (4, 4), (8, 2))
"""Drums, and contact lines of a joint."""
FREQUENCIES = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0)
RATIO = 1.1
"""Of two amplitudes that follow each other [-]."""
LOWEST, HIGHEST = 0.9, 16.0
"""Amplitudes [g tan(alpha)]."""
FOLLOWED = 10.0
"""How long a column is followed after the pulse [1/p]."""
LOOKS: tuple[Look, ...] = (
    {"color": ORANGE},
    {"color": ORANGE},
    {"color": GREEN},
    {"color": GREEN, "linestyle": ":"},
    {"color": BLUE},
)
"""Colour and line of each column."""
NAMED = {(4, 2): 5.0}
"""Frequency at which a column is named at the left of its curve, where others have the same end."""


def pulse(frequency: float, amplitude: float) -> mr.GroundMotion:
    """One sine that pushes the column to the right first."""
    lifting = mr.GRAVITY * math.tan(COLUMN.alpha)
    return mr.GroundMotion.sine(-amplitude * lifting, 2 * math.pi / (frequency * COLUMN.p), samples=200)


def duration(frequency: float) -> float:
    """How long a column is followed [s]."""
    return (2 * math.pi / frequency + FOLLOWED) / COLUMN.p


def stacked(drums: int, lines: int) -> mr.Masonry:
    """The column as drums on joints of some lines."""
    drum = mr.Block.from_size(
        thickness=2 * COLUMN.b, height=2 * COLUMN.h / drums, length=COLUMN.length, density=COLUMN.density
    )
    return mr.Masonry.stack([drum] * drums, suite.STIFF, law=mr.CALIBRATED, points=lines)


def name(drums: int, lines: int) -> str:
    """A column in words."""
    return f"{drums} drum{'s' * (drums > 1)}" + (f", {lines} lines" if lines > 2 else "")


def build(column: tuple[int, int], frequency: float, amplitude: float) -> mr.MasonryAnalysis:
    """A column of drums under a pulse."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # printed once, by `main`
        masonry = stacked(*column)
    case = mr.MasonryCase(masonry, duration(frequency), motion=pulse(frequency, amplitude))
    return mr.MasonryAnalysis(case, {"output_step": 0.05})


def outside_the_fit() -> list[str]:
    """What the law warns of, column by column."""
    lines = []
    for column in COLUMNS:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            stacked(*column)
        lines += [f"{name(*column)}: {warning.message}" for warning in caught]
    return lines


def overturns_in_theory(frequency: float, amplitude: float) -> bool:
    """Whether one block overturns in rocking theory."""
    case = mr.Case(COLUMN, 0.0, duration(frequency), side_stop=False, motion=pulse(frequency, amplitude))
    answer = mr.solve_analytical(case, mr.Restitution.from_geometry(COLUMN), rtol=1e-8, output_step=0.05)
    return answer.outcome is mr.Outcome.OVERTURNED


def lowest(falls: NDArray[np.bool_], amplitudes: NDArray[np.float64]) -> NDArray[np.float64]:
    """The least amplitude that overturns at each frequency, or NaN; `falls` has the shape (..., amplitudes)."""
    between = amplitudes / math.sqrt(RATIO)  # half a rung below is what is known best
    return np.where(falls.any(axis=-1), between[falls.argmax(axis=-1)], math.nan)


def drawn(frequencies: Sequence[float], least: NDArray[np.float64], theory: NDArray[np.float64]) -> Figure:
    """A curve for each number of drums, and rocking theory for one."""
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    ax = figure.subplots()
    ax.plot(frequencies, theory, **plotting.STYLES["analytical"] | {"label": None})
    beside(ax, (frequencies[-1], theory[-1]), "rocking theory, 1 block", BLACK, (8, -4))
    for column, look, marker, curve in zip(COLUMNS, LOOKS, "osD^v", least, strict=True):
        if column == (1, 2):
            continue  # it falls together with two drums
        ax.plot(frequencies, curve, marker=marker, markersize=4, linewidth=1.4, **look)
        label = "1 and 2 drums" if column == (2, 2) else name(*column)
        at = min(NAMED.get(column, math.inf), frequencies[-1])
        place = at, float(np.interp(at, frequencies, curve))
        beside(ax, place, label, look["color"], (-8 if column in NAMED else 8, 0))
    ax.text(frequencies[0], 1.7, "below $\\omega_p/p = 4$ all are alike,\nbut for joints of four lines", fontsize=8)
    ax.set_yscale("log")
    ax.set_xlim(0.3, frequencies[-1] + 0.1)
    ticks = [1, 2, 3, 5, 10, 15]
    ax.set_yticks(ticks, [f"{tick}" for tick in ticks])
    ax.set_yticks([], minor=True)
    ax.set_xlabel(r"frequency of the pulse $\omega_p / p$ [-]")
    ax.set_ylabel(r"least $a_p / (g \tan\alpha)$ that overturns [-]")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the columns, draw their spectra, and print."""
    args = suite.parser(__doc__, "drums", records=False).parse_args(argv)
    out = cli.folder(args.out)
    frequencies = FREQUENCIES[1::6] if args.quick else FREQUENCIES
    count = math.ceil(math.log(HIGHEST / LOWEST) / math.log(RATIO))
    amplitudes = np.array([LOWEST * RATIO**i for i in range(count + 1)])
    if args.quick:
        amplitudes = amplitudes[::15]
    grid = mr.Grid(build, column=COLUMNS, frequency=frequencies, amplitude=amplitudes.tolist())
    found = completed(grid, out / "drums.sqlite", workers=args.workers)
    shape = (len(COLUMNS), len(frequencies), len(amplitudes))
    over = [row["outcome"] == mr.Outcome.OVERTURNED.value or row["end_s"] < duration(row["frequency"]) for row in found]
    falls = np.reshape(over, shape)
    least = lowest(falls, amplitudes)
    theory = lowest(np.array([[overturns_in_theory(f, a) for a in amplitudes] for f in frequencies]), amplitudes)
    slid = np.reshape([row["largest_sliding_m"] for row in found], shape)
    islands = (~falls & (np.cumsum(falls, axis=-1) > 0)).mean(axis=(1, 2))
    rows = []
    for i, frequency in enumerate(frequencies):
        rows.append([f"{frequency:g}", *(f"{a:.2f}" for a in (theory[i], *least[:, i]))])
    plotting.save(drawn(frequencies, least, theory), out / "drums.png")
    header = ["omega_p/p [-]", "theory 1 block", *(name(*column) for column in COLUMNS)]
    rows.append(["safe islands", "-", *(f"{share:.3f}" for share in islands)])
    stood = np.where(falls, 0.0, slid).max(axis=(1, 2))
    rows.append(["most slid and stood [m]", "-", *(f"{most:.3f}" for most in stood)])
    text = "\n".join([cli.table(header, rows), "", *outside_the_fit()])
    cli.report(out / "drums", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
