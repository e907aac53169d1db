"""`mjrock compile`: compile the loops of all solvers once, and store them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from time import perf_counter

from ..background_compilation import compiles
from ..bars import Bar
from ..command_line import Answer, parser_of
from ..distinct.explicit import solve_explicit
from ..engine.simulation import simulate
from ..machine import cores
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.ground.motion import GroundMotion
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.masonry import Masonry
from ..problem.wall.block import Block
from ..problem.wall.case import Case
from ..problem.wall.effects import Damper
from ..theory.analytical import solve_analytical

WALL = Block.from_size(0.6, 4.2)
K_N = 1e9
"""Interface stiffness of what is run [N/m3]."""


def _run_in_mujoco(timestep: float | None) -> None:
    """A wall with a damper under a pulse."""
    contacts, pulse = Contacts.from_damping(WALL, k_base=K_N, xi_base=0.05), GroundMotion.half_sine(9.0, 0.5)
    case = Case(WALL, 0.01, 0.02, side_stop=False, motion=pulse, effects=(Damper(height=4.0, c=1e3),))
    simulate(case, contacts, timestep, ledger=True, forces=True)


def _pushed_case(masonry: Masonry) -> MasonryCase:
    return MasonryCase(masonry, 1.0, motion=GroundMotion.half_sine(9.0, 0.5))


def _box_in_space() -> Masonry:
    return Masonry.box((0.6, 0.4, 2.0), k_n=K_N)


RUNS: tuple[Callable[[], object], ...] = (
    lambda: _run_in_mujoco(None),
    lambda: solve_explicit(_pushed_case(Masonry.stack([WALL], K_N)), ledger=True, forces=True),
    lambda: simulate(MasonryCase(_box_in_space(), 0.02), ledger=True, forces=True),
    lambda: solve_explicit(_pushed_case(_box_in_space()), ledger=True, forces=True),
    lambda: _run_in_mujoco(1e-4),
    lambda: solve_analytical(
        Case(WALL, 0.0, 1.0, motion=GroundMotion.half_sine(9.0, 0.5)), Restitution.from_geometry(WALL)
    ),
    lambda: simulate(MasonryCase(_box_in_space(), 0.02), timestep=1e-4),
)
"""Short runs that call the loops of all solvers, in the plane and in space; MuJoCo and explicit steps in turn."""


def carry_out(number: int) -> None:
    """Make one of the `RUNS`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        RUNS[number]()


def answer(argv: Sequence[str]) -> Answer:
    """Make all `RUNS`, in as many processes as this one has cores.

    Raises:
        OSError: if no folder can be written.
        ValueError: if there is no compiler.
    """
    description = "Compile the loops of all solvers and store them; some two minutes, once for an installation."
    parser_of("compile", description).parse_args(argv)
    if not compiles():
        raise ValueError("nothing can be compiled: numba is not installed, or NUMBA_DISABLE_JIT is set")
    from ..loop_cache import folder  # which imports numba

    stored = folder().parent
    os.environ["MJROCK_INTERPRET"], begun = "0", perf_counter()
    with (
        ProcessPoolExecutor(min(cores(), len(RUNS)), get_context("spawn")) as pool,
        Bar("compiling", "runs", len(RUNS)) as bar,
    ):
        for _ in pool.map(carry_out, range(len(RUNS))):
            bar.add()
    return Answer(f"the loops are stored in {stored}; {perf_counter() - begun:.0f} s")
