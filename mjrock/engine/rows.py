"""Rows: what MuJoCo solves for each contact in a step, from the contact law and the length of the step.

A friction row has no spring, only a dashpot, and the inertia of its normal row times impratio. With a damping rate of
1/h, solreffriction = (~0, -d/h), it stops the slip within one step, but for the share of the force that its inertia
leaves: under a load F along its face a contact that sticks creeps at F h / m_f, with m_f the inertia of its friction
row, `RowInertia.friction` times max(1, growth h). In steps longer than 1 / growth it creeps no faster. MuJoCo has one
impratio for all contacts. It is the largest with which no friction row has more inertia than it should.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..quantities import Array
from .solref import pair_values, row


class ContactLaw(NamedTuple):
    """The contact law.

    Args:
        k, c: spring [N/m] and dashpot [N s/m] of each contact, shape (m,).
        friction: coefficient of friction [-], zero for none, shape (m,).
    """

    k: Array
    c: Array
    friction: Array


class RowInertia(NamedTuple):
    """What the rows of contacts need besides the law.

    Args:
        weight: sum of MuJoCo's inverse weights of the two bodies W [1/kg], shape (m,).
        overdamped, resolved: c h W from which a dashpot is stiff for a step with ringing and for one without, see
            `solref.row` [-], shape (m,).
        friction: inertia that the friction rows should have [kg], zero where there is no friction, shape (m,).
        growth: how it grows with the step: by the factor growth h, where that is more than one [1/s].
    """

    weight: Array
    overdamped: Array
    resolved: Array
    friction: Array
    growth: float


class Step(NamedTuple):
    """A step.

    Args:
        h: its length [s].
        beta: Newmark's beta of each contact [-], shape (m,).
        ringing: an extra dashpot of each in units of h k [-], shape (m,).
    """

    h: float
    beta: Array
    ringing: Array


class ContactRows(NamedTuple):
    """The rows as MuJoCo keeps them, shapes (m, 2), (m, 2 or more) and (m, 2)."""

    solref: Array
    solimp: Array
    solreffriction: Array

    @classmethod
    def of(cls, contacts: int) -> ContactRows:
        """Room for the rows of some contacts."""
        return cls(
            np.zeros((contacts, 2)), np.tile((0.0, 0.0, 0.001, 0.5, 2.0), (contacts, 1)), np.zeros((contacts, 2))
        )


@inlined
def row_of(law: ContactLaw, inertia: RowInertia, i: int, step: Step) -> tuple[float, float]:
    """Dashpot [N s/m] and inertia [kg] of the row of contact i in a step, see `solref.row`."""
    stiff = inertia.overdamped[i] if step.ringing[i] > 0 else inertia.resolved[i]
    return row(law.k[i], law.c[i], step.h, inertia.weight[i], step.beta[i], step.ringing[i], stiff)


@inlined
def impratio_of(inertia: RowInertia, i: int, normal: float, h: float) -> float:
    """Inertia that the friction row of contact i should have in a step h, over that of its normal row [-]."""
    if inertia.friction[i] == 0:
        return math.inf
    return max(inertia.growth * h, 1.0) * inertia.friction[i] / normal


@inlined
def set_rows(law: ContactLaw, inertia: RowInertia, step: Step, rows: ContactRows) -> float:
    """Write the rows of all contacts for a step, and return the `impratio` of the model [-]."""
    impratio = math.inf
    for i in range(len(law.k)):
        dashpot, normal = row_of(law, inertia, i, step)
        W = inertia.weight[i]
        rows.solref[i, 0], rows.solref[i, 1], d = pair_values(law.k[i], dashpot, normal, W)
        rows.solimp[i, 0] = rows.solimp[i, 1] = d
        if inertia.friction[i] > 0:
            rows.solreffriction[i, 0], rows.solreffriction[i, 1] = -1e-30, -d / step.h
        impratio = min(impratio, impratio_of(inertia, i, normal, step.h))
    return impratio if impratio < math.inf else 1.0
