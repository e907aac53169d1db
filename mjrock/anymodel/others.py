"""The other contacts of a model, which new options change: they are named, or given numbers that keep them.

With the pyramidal cone the rows of a contact with friction are as stiff as one row of the elliptic cone times
`Mixed.pyramid`, f. A contact is kept by a row that is f times as large in all three of its numbers. For K [1/s2],
B [1/s] and the impedance d these are K d / R, B / R and 1 / R with 1 / R = d / ((1 - d) W), so that

    d' = f d / (1 - d + f d),    K' = K d / d',    B' = B.

Where d grows with penetration, both of its ends become d', and K' belongs to their geometric mean.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import NamedTuple

import mujoco

from ..quantities import named
from .geoms import GeomPair, every_pair
from .row_of_model import Mixed, ModelRow

SAME = 0.05
"""Change of stiffness from which a contact is another [-]."""
KEPT_WITHIN = 0.1
"""Change of stiffness within which a contact is kept [-]; 5 % for MuJoCo's impedance of 0.9 to 0.95 and mu = 1.5."""


class Others:
    """The contacts of a compiled model but for some, as they are before its options change.

    Args:
        model: the model.
        written: numbers of the geoms of those that are left out.
    """

    def __init__(self, model: mujoco.MjModel, written: Collection[frozenset[int]]) -> None:
        pairs = (pair for pair in every_pair(model) if frozenset(pair.geoms) not in written)
        self.before = [(pair, ModelRow.of(pair)) for pair in pairs]

    def changed(self) -> Iterator[Changed]:
        """Those that are stiffer or softer now."""
        for pair, before in self.before:
            after = ModelRow.of(pair)
            if not math.isclose(before.loaded(pair.load), after.loaded(pair.load), rel_tol=SAME):
                yield Changed(pair, before, after)


class Changed(NamedTuple):
    """A contact that the options change, and its rows before and after."""

    pair: GeomPair
    before: ModelRow
    after: ModelRow

    @property
    def kept(self) -> Mixed | None:
        """Parameters of an explicit pair that keep its row as before; None where MuJoCo has no such row."""
        before, factor = self.before, self.before.scale / self.after.scale
        d, dw, *shape = before.solimp
        if before.constant:
            dw = d
        near, full = (factor * end / (1 - end + factor * end) for end in (d, dw))
        spring = before.spring * math.sqrt(d * dw / (near * full))
        made = replace(before.mixed, solref=(-spring * full**2, -before.dashpot * full), solimp=(near, full, *shape))
        load = self.pair.load
        return (
            made
            if math.isclose(
                ModelRow(self.pair.model, self.pair.inverse_weight, made).loaded(load),
                before.loaded(load),
                rel_tol=KEPT_WITHIN,
            )
            else None
        )

    @property
    def stiffness(self) -> tuple[float, float]:
        """k before and after, under the weight [N/m]."""
        return self.before.loaded(self.pair.load), self.after.loaded(self.pair.load)


def sentence(changed: Collection[Changed]) -> str:
    """What the options do to contacts, the one that changes most first."""
    told = []
    for each in sorted(changed, key=lambda one: -abs(math.log(one.stiffness[1] / one.stiffness[0]))):
        told.append("{} ({:.3g} to {:.3g} N/m)".format(" on ".join(each.pair.labels), *each.stiffness))
    return (
        f"the options that the contact needs change the stiffness of {len(told)} other contacts of the model under the "
        f"weight: {named(told)}; contacts_for gives them numbers of their own, or keep_others=True writes pairs that "
        "keep named geoms as they were"
    )
