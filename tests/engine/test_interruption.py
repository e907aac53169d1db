"""Ctrl-C in a run: it ends the run, and the next run is the same to the last bit. Each in a process of its own."""

import subprocess
import sys

import numba
import pytest
from everyday import slow

import mjrock as mr
from mjrock.engine import loop
from mjrock.theory import arcs

SCRIPT = """
import hashlib, os, signal, sys, threading, time, warnings
import numpy as np
import mjrock as mr

warnings.simplefilter("ignore")
signal.signal(signal.SIGINT, signal.default_int_handler)  # also where the tests run in the background
wall = mr.Block.from_size(0.6, 4.2)
e = mr.Restitution.from_geometry(wall)
contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.012)
record = mr.GroundMotion.synthetic(peak=4.0, duration=100.0, seed=1)
arch, stack = mr.Masonry.arch(5.0, 0.75), mr.Masonry.stack([wall] * 3, 1e9)
runs = {
    "wall": lambda T: mr.simulate(mr.Case(wall, 0.0, T, motion=record), contacts),
    "fixed": lambda T: mr.simulate(mr.Case(wall, 0.0, T, motion=record), contacts, 1e-4),
    "theory": lambda T: mr.solve_analytical(mr.Case(wall, 0.0, T, motion=record), e),
    "arch": lambda T: mr.simulate(mr.MasonryCase(arch, T, motion=record.scaled(0.3))),
    "stack": lambda T: mr.simulate(mr.MasonryCase(stack, T, motion=record.scaled(0.3))),
}
run = runs[sys.argv[1]]


def digest(answer):
    return hashlib.sha256(b"".join(np.ascontiguousarray(a).tobytes() for a in (answer.t, answer.pose))).hexdigest()


wanted, interrupted = digest(run(1.0)), 0
trials = int(sys.argv[2])
for trial in range(trials):
    after = 0.02 + 0.13 * trial / trials
    timer = threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    try:
        while timer.is_alive() or interrupted == trial:
            run(100.0)
    except KeyboardInterrupt:
        interrupted += 1
    assert digest(run(1.0)) == wanted
print(interrupted)
"""


@pytest.mark.parametrize(
    ("solver", "count"), [("wall", "5"), *(slow((name, "10")) for name in ("wall", "fixed", "theory", "arch", "stack"))]
)
def test_interruptions_end_the_run_and_nothing_else(solver, count):
    run = subprocess.run([sys.executable, "-c", SCRIPT, solver, count], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout.strip()) == (0, count), run.stderr[-2000:]


def test_compiled_loops_return_no_named_tuples():
    """For a NamedTuple numba calls its class, and a signal in this call ends the interpreter."""
    wall = mr.Block.from_size(0.6, 4.2)
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
    case = mr.Case(wall, 0.0, 0.2, side_stop=False, motion=mr.GroundMotion.sine(3.0, 0.1))
    mr.simulate(case, contacts)
    mr.simulate(case, contacts, 1e-3)
    mr.solve_analytical(case, mr.Restitution.from_geometry(wall))
    for compiled in (loop.fitted_loop, loop.fixed_loop, arcs.rocking_loop):
        assert compiled.nopython_signatures
        for signature in compiled.nopython_signatures:
            kind = signature.return_type
            parts = [kind, *kind] if isinstance(kind, numba.types.BaseTuple) else [kind]
            assert not any(isinstance(part, numba.types.BaseNamedTuple) for part in parts)
