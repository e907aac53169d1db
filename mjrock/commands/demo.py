"""`mjrock demo`: a wall that is released against its side walls, in MuJoCo beside rocking theory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..command_line import Answer, add_output, parser_of, require_free
from ..contacts.files import write_text
from ..engine.simulation import simulate
from ..engine.text import wall_mjcf
from ..plotting.histories import comparison
from ..plotting.style import save
from ..plotting.wall import section
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.wall.block import Block
from ..problem.wall.case import Case
from ..reference.compliant import solve_compliant
from ..result.compare import compare
from ..result.response import Response
from ..theory.analytical import solve_analytical

FILES = ("scene.xml", "comparison.csv", "comparison.png")
"""What is written: the model that ran, the impacts, and the picture."""
LEAST_ENERGY_STEP = 0.05
"""Least step of the energy that is marked, over the first energy [-]."""


def comparison_figure(case: Case, responses: Sequence[Response], title: str) -> Figure:
    """Rotation and energy until the wall is at rest, |e| at the steps of the energy, and the wall.

    Args:
        case: the wall.
        responses: the first is that of rocking theory.
        title: of the figure.
    """
    figure = comparison(responses, title)
    upper, lower = figure.axes
    theory = responses[0]
    assert theory.rocking is not None
    moving_samples = np.flatnonzero(np.abs(theory.theta) > 1e-3 * theory.of_wall[0].wall.alpha)
    lower.set_xlim(0, min(theory.t[-1], 1.3 * theory.t[moving_samples[-1]]))
    for impact in theory.impacts:
        if impact.energy_before > LEAST_ENERGY_STEP * theory.energy[0]:
            xy = impact.t, 0.5e-3 * (impact.energy_before + impact.energy_after)
            text = f"$|e|$ = {abs(impact.restitution):.2f}"
            lower.annotate(text, xy, (6, 0), textcoords="offset points", va="center", fontsize=8, color="0.2", zorder=6)
    inset = upper.inset_axes((0.72, 0.16, 0.28, 0.82))
    section(inset, case)
    inset.axis("off")
    return figure


class StepOptions(NamedTuple):
    """`timestep` [s] and `accuracy` [-] of `simulate`."""

    timestep: float | None = None
    accuracy: float = 1e-3


USUAL_STEPS = StepOptions()
"""Those of the README."""


def compared(
    case: Case,
    e: Restitution,
    contacts: Contacts,
    folder: Path,
    steps: StepOptions = USUAL_STEPS,
    *,
    check: bool = True,
) -> str:
    """Write the FILES of a wall in MuJoCo beside rocking theory into a folder.

    Args:
        case: the wall.
        e: what it keeps of its angular velocity at an impact.
        contacts: those of MuJoCo.
        folder: that of the files, which is there.
        steps: of MuJoCo.
        check: whether SciPy solves the law of the contacts too.

    Returns:
        The tables.

    Raises:
        ValueError, TypeError, OSError: as the solvers, and where a file cannot be written.
    """
    theory = solve_analytical(case, e)
    engine = simulate(case, contacts, steps.timestep, accuracy=steps.accuracy)
    responses = [theory, engine]  # the last is drawn on top
    if check:
        responses.append(solve_compliant(case, contacts))
    impacts, step = compare(theory, engine), engine.stats["timestep"]
    model, table, picture = (folder / name for name in FILES)
    write_text(model, wall_mjcf(case, contacts, step))
    write_text(table, impacts.csv())
    title = f"2h = {2 * case.wall.h:g} m, 2b = {2 * case.wall.b:g} m, {'one' if case.side_stop else 'two'}-sided"
    save(comparison_figure(case, responses, title), picture)
    longest = engine.stats["longest_timestep"]
    lengths = f"{step * 1e3:.3g} ms" if steps.timestep else f"{step * 1e3:.3g} to {longest * 1e3:.3g} ms"
    run_line = f"MuJoCo: {engine.stats['steps']} steps of {lengths} in {engine.stats['wall_time']:.3f} s"
    lines = [run_line, "", impacts.table()]
    if check:
        scipy_table = compare(responses[2], engine).table()
        lines += ["", "The same contact law solved by SciPy, against MuJoCo:", "", scipy_table]
    return "\n".join([*lines, "", f"written: {', '.join(str(folder / name) for name in FILES)}"])


def answer(argv: Sequence[str]) -> Answer:
    """Compare the wall of the README.

    Raises:
        OSError: if a file cannot be written, or is there and may not be replaced.
    """
    parser = parser_of("demo", "Release a wall of 0.6 x 4.2 m against its side walls, in MuJoCo and by rocking theory.")
    add_output(parser, "folder of the model, the table and the picture", "mjrock-demo")
    args = parser.parse_args(argv)
    folder = args.output or Path("mjrock-demo")
    for name in FILES:
        require_free(folder / name, args.force)
    folder.mkdir(parents=True, exist_ok=True)
    wall = Block.from_size(thickness=0.6, height=4.2)  # m
    e = Restitution.from_geometry(wall)
    contacts = Contacts.from_law(wall, e, k_base=5e8, k_side=5e8)  # N/m3
    case = Case(wall, theta0=0.5 * wall.alpha, duration=3.0)  # rad, s
    return Answer(compared(case, e, contacts, folder))
