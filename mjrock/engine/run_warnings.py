"""What a run warns of: a fixed step that scatters, a base that slides, a ledger that does not close."""

from __future__ import annotations

import warnings

import numpy as np

from ..method import METHOD
from ..problem.masonry.case import AnyCase
from ..result.ledger import warn_if_open
from ..result.response import Response
from ..scene.fixed_step import sound_timestep
from ..scene.scene import Scene
from .energy_work import contact_work
from .record import Steps
from .rows import points_of
from .run import EngineRun

SCATTER = 0.1
"""Standard deviation of |e| at a fixed step against a side stop, over omega h, relative [-]: a touch lies anywhere in a
step. It is measured on 24 walls of Table 1 from omega h = 0.06 to 0.8 (`scripts/measure/convergence.py`). Without a
side stop |e| scatters by less than 0.002 omega h."""
WORTH_SAYING = 0.02
"""Scatter of |e| that is warned of [-]."""
ENDLESS = "faces have no end in MuJoCo, where a block that has left one may meet it again; solve_explicit follows it"
LIFTED = 0.02
"""Share of the normal force that the rows of sliding contacts may add to it before that is warned of [-]."""
SLID = 0.01
"""Sliding of a base that should hold that is warned of, over b [-]."""


def require_known(case: AnyCase) -> None:
    """Raise a ValueError where joints have bonds, or effects are for explicit steps only: contacts of MuJoCo push
    only."""
    case.require_dry("MuJoCo")
    for i, effect in enumerate(case.effects):
        if effect.only:
            name = f"effects[{i}], {type(effect).__name__}"
            raise ValueError(f"{name}: MuJoCo has no row for it; take {effect.only}")


def require_still(case: AnyCase) -> None:
    """Raise a ValueError for what `require_known` refuses, and where supports move: in models of contact points fixed
    blocks belong to the world."""
    require_known(case)
    if case.supports:
        names = ", ".join(support.block for support in case.supports)
        raise ValueError(
            f"supports = {names}: fixed blocks do not move in MuJoCo but with collisions=True; take that, or "
            "solve_explicit"
        )


def warn_if_sheared(scene: Scene) -> None:
    """Warn where joints have a shear stiffness, which MuJoCo's friction does not have."""
    contacts = scene.contacts
    sprung = np.isfinite(contacts.k_s)
    if sprung.any():
        least = (np.asarray(contacts.k_s) / contacts.area)[sprung].min()
        warnings.warn(
            f"k_s = {least:.3g} N/m3 is taken by solve_explicit alone; in MuJoCo the joints stick rigidly up to their "
            "friction",
            stacklevel=3,
        )


def warn_if_coarse(scene: Scene, h: float) -> None:
    """Warn of a fixed step h [s] with which |e| depends on the phase of the touch."""
    resolved = h * scene.highest_frequency
    scatter = SCATTER * resolved if (scene.bears == 0).any() else 0.0
    if scatter > WORTH_SAYING and resolved <= METHOD.smooth:
        warnings.warn(
            f"with a fixed step of {h:.3g} s |e| scatters by {scatter:.0%} (standard deviation) with the phase of the "
            f"touch; below {WORTH_SAYING / SCATTER / scene.highest_frequency:.3g} s it is less than "
            f"{WORTH_SAYING:.0%}, and fitted steps have no such scatter",
            stacklevel=3,
        )
    if resolved > METHOD.smooth:
        warnings.warn(
            f"a step of {h:.3g} s does not resolve the contacts: impacts lose what the step makes of them; "
            f"the largest sound step is {sound_timestep(scene.highest_frequency):.3g} s",
            stacklevel=3,
        )


def warn_if_lifted(scene: Scene, steps: Steps) -> None:
    """Warn of contacts that slide on the rows of a fixed step, which press them apart."""
    if not points_of(scene).rubs.any():
        return
    lift = contact_work(scene, steps).lift
    if lift > LIFTED:
        warnings.warn(
            f"contacts that slide are pressed apart by {lift:.0%} of their normal force on top of it: the rows of a "
            "fixed step, which are those of the model text, do not slide as Coulomb has it. Pass coulomb=True, or take "
            "steps that fit the motion",
            stacklevel=3,
        )


def warn_if_slid(run: EngineRun) -> None:
    """Warn of a base that has slid although it should hold, while the wall can still come back."""
    slip = run.reading.slip
    slid = float(np.abs(slip[: run.reading.count] - slip[0]).max())
    holds = np.asarray(run.scene.contacts.holds)
    if holds.any() and slid > SLID:
        half_base = 0.5 * float(np.ptp(run.scene.contacts.at[holds, 0]))
        warnings.warn(
            f"the base slid by up to {slid * half_base:.3g} m, {slid:.1%} of b, although it should hold: no "
            "edge was loaded enough to hold it. Give the base the friction that it has",
            stacklevel=3,
        )


def warn_of_gain(response: Response, run: EngineRun, advice: str) -> None:
    """Warn of energy that has appeared from nowhere after blocks of masonry fell, and of a ledger that does not close
    as long as a wall can still come back, with advice."""
    if run.gain is not None:
        warnings.warn(f"{run.gain} by t = {run.gain.t:.4g} s, after blocks fell: {ENDLESS}", stacklevel=3)
    elif response.ledger is not None:
        fell = response.joints is not None and bool(response.joints.fallen)
        unpaid = run.problem.unpaid(response.ledger, response.motion, run.scale)
        said = ENDLESS if fell else advice
        warn_if_open(unpaid.energy, unpaid.whole, unpaid.share, unpaid.said, lambda share: said)
