"""OpenSeesPy: a wall of stiff corotational beams on zero-length contacts, in the plane."""

from __future__ import annotations

import math
import time

import numpy as np

from .question import Motion, Question

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError):  # the wheel says RuntimeError where it does not load
    import opensees as ops  # its folder is then on the path, see `peers.py`

RIGID = 1e12
"""E A [N] and E I [N m2] of the beams, four orders above the contacts."""
ALGORITHMS = (("Newton",), ("KrylovNewton",), ("NewtonLineSearch",), ("ModifiedNewton", "-initial"))
"""Of solving a step, in the order in which they are tried."""
TOLERANCE = 1e-8
"""Of a step [m]."""
CLOSED = 1e12
"""Stiffness of a gap that has closed [N/m]."""
BASE, OUTER, INNER, MIDDLE, TOP, CORNER = range(1, 7)
"""Nodes: middle of the base, its edges, the centroid, the top, its inner edge. Ground nodes add 10 or 20."""


def run(question: Question, variant: str, h: float) -> tuple[Motion, float]:
    """The motion at a step h [s] and the wall time [s], the building of the model excluded."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    _wall(question)
    _contacts(question, variant)
    _load(question, variant)
    ops.system("BandGeneral")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.test("NormDispIncr", TOLERANCE, 50, 5)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    stride, count = question.samples(h)
    found = np.full((count, 2), np.nan)
    started = time.perf_counter()
    for n in range(count):
        found[n] = question.theta0 - ops.nodeDisp(MIDDLE, 3), -ops.nodeVel(MIDDLE, 3)
        _advance((n + 1) * stride * h, h)
    seconds = time.perf_counter() - started
    return (h * stride * np.arange(count), found[:, 0], found[:, 1]), seconds


def _advance(until: float, h: float) -> None:
    """Steps to a time [s]; a step that Newton does not solve is tried with the other algorithms."""
    for algorithm in ALGORITHMS:
        ops.algorithm(*algorithm)
        if not ops.analyze(round((until - ops.getTime()) / h), h):
            return
    raise RuntimeError(f"no convergence at t = {ops.getTime():g} s")


def _wall(question: Question) -> None:
    """The wall, drawn where it is released: the middle of its base does not slide."""
    b, height, turn = question.thickness / 2, question.height, question.theta0

    def at(x: float, z: float) -> tuple[float, float]:
        return x * math.cos(turn) + z * math.sin(turn), b * math.sin(turn) - x * math.sin(turn) + z * math.cos(turn)

    places = {
        BASE: (0.0, 0.0),
        OUTER: (b, 0.0),
        INNER: (-b, 0.0),
        MIDDLE: (0.0, height / 2),
        TOP: (0.0, height),
        CORNER: (-b, height),
    }
    for node, place in places.items():
        ops.node(node, *at(*place))
    ops.mass(MIDDLE, question.mass, question.mass, question.inertia)
    ops.fix(BASE, 1, 0, 0)
    ops.geomTransf("Corotational", 1)
    for number, (i, j) in enumerate(((BASE, OUTER), (BASE, INNER), (BASE, MIDDLE), (MIDDLE, TOP), (TOP, CORNER)), 1):
        ops.element("elasticBeamColumn", number, i, j, 1.0, RIGID, 1.0, 1)


def _contacts(question: Question, variant: str) -> None:
    """Vertical contacts below both edges, and one that is horizontal at the top of the stop."""
    gaps = {
        OUTER: (2, 0.0, question.k_base, question.c_base),
        INNER: (2, ops.nodeCoord(INNER, 2), question.k_base, question.c_base),
    }
    if question.side_stop:  # the bottom of the inner face stays at the stop, for the base does not slide
        away = ops.nodeCoord(CORNER, 1) + question.thickness / 2
        gaps[CORNER] = (1, away, question.k_side, question.c_side)
    for node, (direction, gap, k, c) in gaps.items():
        ground = node + 10
        ops.node(ground, *ops.nodeCoord(node))
        ops.fix(ground, 1, 1, 1)
        closing = -gap if gap else -1e-12  # compression is negative, and the material wants a gap
        ops.uniaxialMaterial("ElasticPPGap", 10 + node, CLOSED, -1e9 * CLOSED, closing)
        if variant == "dashpot under a gap":  # a pad on spring and dashpot, and a gap that carries no tension above it
            pad = 20 + node
            ops.node(pad, *ops.nodeCoord(node))
            ops.fix(pad, direction == 2, direction == 1, 1)
            ops.uniaxialMaterial("Elastic", 20 + node, k, c)
            ops.element("zeroLength", 20 + node, ground, pad, "-mat", 20 + node, "-dir", direction)
            ops.element("zeroLength", 10 + node, pad, node, "-mat", 10 + node, "-dir", direction)
            continue
        if variant == "ViscoelasticGap":
            ops.uniaxialMaterial("ViscoelasticGap", node, k, c, closing)
        else:  # spring that takes no tension, and a dashpot that always acts
            ops.uniaxialMaterial("ElasticPPGap", 20 + node, k, -1e9 * k, closing)
            ops.uniaxialMaterial("Viscous", 30 + node, c, 1.0)
            ops.uniaxialMaterial("Parallel", node, 20 + node, 30 + node)
        ops.element("zeroLength", 10 + node, ground, node, "-mat", node, "-dir", direction)


def _load(question: Question, variant: str) -> None:
    """The weight, and the outer edge in its spring as deep as it is at the release."""
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(MIDDLE, 0.0, -question.weight, 0.0)
    sunk = question.centroid(settled=True)[1] - question.centroid(settled=False)[1]
    pads = [20 + OUTER] if variant == "dashpot under a gap" else []
    for node in (BASE, OUTER, INNER, MIDDLE, TOP, CORNER, *pads):
        ops.setNodeDisp(node, 2, sunk, "-commit")
