"""Siconos: a rigid wall with restitution and Coulomb friction, in Moreau and Jean's steps, in the plane."""

from __future__ import annotations

import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn

from .question import GRAVITY, Motion, Question

FRICTION = 30.0
"""Of a base that holds; the stop is smooth."""
TOLERANCE, SWEEPS = 1e-8, 1000
"""Of the impulses of a step, solved by Gauss-Seidel. The default, 1e-4, loses the later rebounds at a side stop."""
PLACES = {"outer": "base", "inner": "base", "foot": "stop", "head": "stop"}
"""What each corner of `siconos.c` meets."""


def run(question: Question, variant: str, h: float) -> tuple[Motion, float]:
    """The motion at a step h [s] and the wall time [s], the making of the model excluded."""
    with tempfile.TemporaryDirectory() as folder:
        steps, wall = _model(question, h, Path(folder))
        stride, count = question.samples(h)
        found = np.empty((count, 2))
        q, v = wall.q(), wall.velocity()
        started = time.perf_counter()
        for n in range(count):
            found[n] = q[2], v[2]
            for _ in range(stride):
                steps.computeOneStep()
                steps.nextStep()
        seconds = time.perf_counter() - started
    return (h * stride * np.arange(count), found[:, 0], found[:, 1]), seconds


def _model(question: Question, h: float, folder: Path) -> tuple[sk.TimeStepping, sk.LagrangianDS]:
    """The wall, released, and what makes its steps; the gaps are compiled from C into a folder."""
    sizes = [f"-DB={question.thickness / 2!r}", f"-DH={question.height / 2!r}"]
    source = Path(__file__).with_name("siconos.c")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", *sizes, "-o", f"{folder}/gaps.so", source, "-lm"], check=True)
    across, up = question.centroid(settled=False)
    mass = np.diag([question.mass, question.mass, question.inertia])
    wall = sk.LagrangianDS([across, up, question.theta0], [0.0, 0.0, 0.0], mass)
    wall.setFExtPtr([0.0, -question.mass * GRAVITY, 0.0])
    system = sk.NonSmoothDynamicalSystem(0.0, question.duration + 10 * h)
    system.insertDynamicalSystem(wall)
    laws = {
        "base": sk.NewtonImpactFrictionNSL(0.0, 0.0, FRICTION, 2),
        "stop": sk.NewtonImpactFrictionNSL(question.e, 0.0, 0.0, 2),
    }
    for corner, face in PLACES.items():
        if face == "base" or question.side_stop:
            gap = sk.LagrangianScleronomousR(*(f"{folder}/gaps:{corner}_{what}" for what in ("gap", "gradient")))
            system.link(sk.Interaction(laws[face], gap), wall)
    problem = sk.FrictionContact(2, sn.SICONOS_FRICTION_2D_NSGS)
    options = problem.numericsSolverOptions()
    options.dparam[sn.SICONOS_DPARAM_TOL], options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = TOLERANCE, SWEEPS
    steps = sk.TimeStepping(system, sk.TimeDiscretisation(0.0, h), sk.MoreauJeanOSI(0.5), problem)
    return steps, wall
