"""What is read off the motion of a stack that rocks as one: its peaks, and the energy that is left at each."""

from __future__ import annotations

import numpy as np

from ..problem.masonry.pile import Pile
from ..quantities import Array
from .response import Response

LEAST = 0.01
"""Smallest rotation that counts as a rebound, over the largest [-]."""


def restitutions(answer: Response, pile: Pile) -> Array:
    """|e| of each rebound of a stack: the root of the energy at a peak over that at the peak before, shape (rebounds,).

    It is the whole energy above the stack at rest, as in `Response.settled_restitution`.
    """
    energy = answer.energy[peaks(answer, pile)]
    return np.asarray(np.sqrt(np.maximum(energy[1:], 0.0) / energy[:-1]))


def peaks(answer: Response, pile: Pile) -> list[int]:
    """The samples at which the rotation of a stack, the mean over its mass, has a maximum to either side."""
    theta = answer.theta @ pile.masses / pile.masses.sum()
    beyond = np.sign(theta) * (np.abs(theta) > LEAST * np.abs(theta).max())
    starts = np.flatnonzero(np.diff(beyond, prepend=0)).tolist()
    tops = []
    for start, end in zip(starts, [*starts[1:], len(theta)], strict=True):
        top = start + int(np.abs(theta[start:end]).argmax())
        if beyond[start] and top < len(theta) - 1:
            tops.append(top)
    return tops
