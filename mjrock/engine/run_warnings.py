"""Estimates of the time that a run in MuJoCo takes, and warnings before and after it."""

from __future__ import annotations

import math

import numpy as np

from ..geometry.frames import PLANE
from ..method import METHOD
from ..problem.masonry.case import AnyCase
from ..quantities import warn_of
from ..result.ledger import warn_if_open
from ..result.response import Response
from ..scene.scene import Scene
from ..scene.time_step import STEP_TAKEN, sound_timestep, stable_step, stepping_seconds
from .energy_work import contact_work
from .record import Steps
from .rows import points_of
from .run import EngineRun

ALWAYS_FITTED = 8
"""Number of free blocks up to which fitted steps are never far behind explicit ones."""
WEAK, STRONG = 0.7e-6, 20e-6
"""Time that fitted steps take of a simulated second, over the lines and the highest frequency [s2]: where little slides
or strikes, and where much does. Columns of 16 and 64 blocks take 1.2e-6 and 0.7e-6, arches 2e-6 to 5e-6, walls of 10 to
55 blocks in running bond 0.5e-6 to 2.3e-6 under a weak sine and 7e-6 to 22e-6 under a strong one
(`scripts/studies/solvers_of_masonry.py`)."""
WEAK_IN_SPACE, STRONG_IN_SPACE = 1.5e-6, 140e-6
"""`WEAK` and `STRONG` for points in space [s2]. A column of 12 drums takes 2e-6 to 3e-6, a facade with return walls
1e-5 under a weak sine and 1.4e-4 under a strong one (`scripts/studies/columns_in_space.py`)."""
INTERPRETED = 10.0
"""Time of steps that fit the motion as plain Python over the middle of what compiled ones may take [-]. Walls take 2 to
9, stacks 15."""
INTERPRETED_BODY, INTERPRETED_LINE = 7e-5, 5e-6
"""Time that each body and each contact line add to a step of one length as plain Python [s]."""
MUCH_FASTER = 3.0
"""Time of fitted steps, the middle of its range, over that of explicit ones from which on there is a warning [-]."""

PLAIN_STEP, PLAIN_LINE = 6e-5, 2e-6
"""Time of a step of a plain model, and time that each line adds to it, and each body twice [s]: a wall takes 5.4e-5, a
column of 32 blocks 1.5e-4, ten dominoes 1.4e-4, 12 blocks that are poured 1e-4, a panel of 102 blocks 7.8e-4, a façade
of 29 that falls 6.3e-4."""
LONG_PLAIN_RUN = 60.0
"""Time of a run of a plain model from which on there is a warning [s]."""


def explicit_seconds(scene: Scene) -> float:
    """Time of a second by explicit steps [s], from the highest frequency and the strongest dashpot."""
    contacts, in_space = scene.contacts, scene.freedom != PLANE
    ratio = np.asarray(contacts.k_s) / contacts.k  # of the springs along the face and the normal
    sprung = np.isfinite(ratio)
    stiffness = float(np.max(ratio[sprung], initial=1.0)) * scene.highest_frequency**2
    step = STEP_TAKEN * stable_step(stiffness, stiffness * float((contacts.c / contacts.k).max()))
    return stepping_seconds(1 / step, len(contacts.k), sprung=bool(sprung.any()), in_space=in_space)


def fitted_seconds(scene: Scene) -> tuple[float, float]:
    """Time of a second by steps that fit the motion [s], where little slides or strikes and where much does."""
    unit = len(scene.contacts.k) * scene.highest_frequency
    weak, strong = (WEAK, STRONG) if scene.freedom == PLANE else (WEAK_IN_SPACE, STRONG_IN_SPACE)
    return weak * unit, strong * unit


def interpreted_seconds(scene: Scene, duration: float, timestep: float | None) -> float:
    """Time of a run as plain Python [s], the middle of what it may take; with a fixed step where one is given [s]."""
    if timestep is not None:
        return (
            duration / timestep * (INTERPRETED_BODY * len(scene.bodies.mass) + INTERPRETED_LINE * len(scene.contacts.k))
        )
    weak, strong = fitted_seconds(scene)
    return INTERPRETED * duration * math.sqrt(weak * strong)


def warn_if_slow(scene: Scene) -> None:
    """Warn of masonry of many blocks that explicit steps would follow in a fraction of the time."""
    blocks = len(scene.bodies.names)
    if blocks <= ALWAYS_FITTED:
        return
    explicit, (fast, slow) = explicit_seconds(scene), fitted_seconds(scene)
    if MUCH_FASTER * explicit <= math.sqrt(fast * slow):
        warn_of(
            f"explicit steps would take some {explicit:.2g} s for a simulated second of these {blocks} "
            f"blocks, and steps that fit the motion in MuJoCo {fast:.2g} to {slow:.2g} s, the more the blocks slide "
            "and strike: take mr.solve_explicit(case), or a timestep"
        )


def plain_seconds(scene: Scene, steps: float) -> float:
    """Time of some steps of a plain model [s]."""
    return steps * (PLAIN_STEP + PLAIN_LINE * (len(scene.contacts.k) + 2 * len(scene.bodies.mass)))


def warn_if_plain_is_slow(scene: Scene, duration: float, h: float) -> None:
    """Warn of a run of a plain model that takes minutes, with what sets its step h [s]."""
    seconds = plain_seconds(scene, duration / h)
    if seconds > LONG_PLAIN_RUN:
        warn_of(
            f"this plain model would take some {seconds / 60:.2g} minutes, {duration / h:.2g} steps of {h:.2g} s, whose"
            f" length the stiffest joint sets (omega h = {h * scene.highest_frequency:.2g}); explicit steps would take "
            f"some {explicit_seconds(scene) * duration / 60:.2g}: take mr.solve_explicit(case), or softer joints"
        )


SCATTER = 0.1
"""Standard deviation of |e| at a fixed step against a side stop, over omega h, relative [-]: a touch lies anywhere in a
step. It is measured on 24 walls of Table 1 from omega h = 0.06 to 0.8 (`scripts/measure/convergence.py`). Without a
side stop |e| scatters by less than 0.002 omega h."""
NOTABLE_SCATTER = 0.02
"""Scatter of |e| above which there is a warning [-]."""
FACES_WITHOUT_END = (
    "faces have no end in MuJoCo, where a block that has left one may meet it again; solve_explicit follows it"
)
NOTABLE_LIFT = 0.02
"""Share of the normal force that the rows of sliding contacts add to it, above which there is a warning [-]."""
NOTABLE_SLIP = 0.01
"""Sliding of a base that should hold, over b, above which there is a warning [-]."""


def require_for_mujoco(case: AnyCase) -> None:
    """Raise a ValueError where joints have bonds, or effects are for explicit steps only: contacts of MuJoCo push
    only."""
    case.require_dry("MuJoCo")
    case.require_for("MuJoCo")


def require_for_contact_points(case: AnyCase) -> None:
    """Raise a ValueError as `require_for_mujoco` does, and where supports move: in models of contact points fixed
    blocks belong to the world."""
    require_for_mujoco(case)
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
        k_s = (np.asarray(contacts.k_s) / contacts.area)[sprung].min()
        warn_of(
            f"k_s = {k_s:.3g} N/m3 is taken by solve_explicit alone; in MuJoCo the joints stick rigidly up to their "
            "friction"
        )


def warn_if_coarse(scene: Scene, h: float) -> None:
    """Warn of a fixed step h [s] with which |e| depends on the phase of the touch."""
    resolved = h * scene.highest_frequency
    scatter = SCATTER * resolved if (scene.bears == 0).any() else 0.0
    if scatter > NOTABLE_SCATTER and resolved <= METHOD.smooth:
        warn_of(
            f"with a fixed step of {h:.3g} s |e| scatters by {scatter:.0%} (standard deviation) with the phase of the "
            f"touch; below {NOTABLE_SCATTER / SCATTER / scene.highest_frequency:.3g} s it is less than "
            f"{NOTABLE_SCATTER:.0%}, and fitted steps have no such scatter"
        )
    if resolved > METHOD.smooth:
        warn_of(
            f"a step of {h:.3g} s does not resolve the contacts: impacts lose what the step makes of them; "
            f"the largest sound step is {sound_timestep(scene.highest_frequency):.3g} s"
        )


def warn_if_lifted(scene: Scene, steps: Steps) -> None:
    """Warn of contacts that slide on the rows of a fixed step, which press them apart."""
    if not points_of(scene).rubs.any():
        return
    lift = contact_work(scene, steps).lift
    if lift > NOTABLE_LIFT:
        warn_of(
            f"contacts that slide are pressed apart by {lift:.0%} of their normal force on top of it: the rows of a "
            "fixed step, which are those of the model text, do not slide as Coulomb has it. Pass coulomb=True, or take "
            "steps that fit the motion"
        )


def warn_if_slid(run: EngineRun) -> None:
    """Warn of a base that has slid although it should hold, while the wall can still come back."""
    slip = run.reading.slip
    slid = float(np.abs(slip[: run.reading.count] - slip[0]).max())
    holds = np.asarray(run.scene.contacts.holds)
    if holds.any() and slid > NOTABLE_SLIP:
        half_base = 0.5 * float(np.ptp(run.scene.contacts.at[holds, 0]))
        warn_of(
            f"the base slid by up to {slid * half_base:.3g} m, {slid:.1%} of b, although it should hold: no "
            "edge was loaded enough to hold it. Give the base the friction that it has"
        )


def warn_of_gain(response: Response, run: EngineRun, advice: str) -> None:
    """Warn of energy that has appeared from nowhere after blocks of masonry fell, and of a ledger that does not close
    as long as a wall can still come back, with advice."""
    if run.gain is not None:
        warn_of(f"{run.gain} by t = {run.gain.t:.4g} s, after blocks fell: {FACES_WITHOUT_END}")
    elif response.ledger is not None:
        fell = response.joints is not None and bool(response.joints.fallen)
        unpaid = run.problem.unpaid(response.ledger, response.motion, run.scale)
        remedy = FACES_WITHOUT_END if fell else advice
        warn_if_open(unpaid.energy, unpaid.whole, unpaid.share, unpaid.label, lambda share: remedy)
