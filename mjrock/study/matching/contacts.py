"""Contacts matched to one wall: the damping that gives it the restitution asked for, found by simulating it.

A law predicts the damping of any wall in no time, for a base that holds and a smooth side. A match finds it for one
wall and any layout, friction, stiffness and amplitude, in some twenty simulations that take a fraction of a second.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Annotated

from ...bars import Bar
from ...problem.damping.contacts import Contacts, OfBase, OfSide, PointCount, Rubbing
from ...problem.damping.restitution import Restitution
from ...problem.wall.block import Block
from ...problem.wall.effects import SideStop
from ...quantities import Implausible, Within, require_flag, require_kind, require_whole, require_within, within_ranges
from .match import BASE_BOUNDS, SIDE_BOUNDS, Match, highest_branch

STIFF_AS_THEORY = 16.0
"""Rotation of the last rebound that counts, over that at which an edge lifts, of a base as stiff as theory's [-]."""
FLAT = 2e-4
"""Most rotation at which an edge of such a base lifts, over alpha [-]: the work of the weight on its springs then costs
less than 0.001 of e_2s."""
TOUCH_DOWN = 0.415
"""Damping ratio of such a base times h/b [-], about that of a plastic touch-down. With less the wall bounces on it,
with more a faint rebound loses more than a large one."""
MISS_WARNED_OF = 0.02
"""Miss of |e| that is warned of, over |e| [-]: as the scatter of |e| with the phase of a touch is."""
UNLIKE_EQ_2 = 5e-3
"""Relative difference of e_2s to Eq. 2 from which a stiff base is said not to give it [-]."""


@dataclass(frozen=True)
class GivenWall:
    """A given wall on its interfaces, in place of a `Combination` of Table 1.

    Args:
        wall: the wall.
        k_base, k_side: interface stiffness [N/m3].
        amplitude: theta_0/alpha of the release [-].
        side_stop: the side that the wall is matched against.
    """

    wall: Block
    k_base: float
    k_side: float
    amplitude: float
    side_stop: bool | SideStop = True


@within_ranges
def matched_contacts(
    wall: Block,
    e: Restitution,
    k_base: OfBase,
    k_side: OfSide = None,
    *,
    points: PointCount = 2,
    amplitude: Annotated[float, Within(0.01, 0.95)] = 0.5,
    friction: Rubbing = None,
    side_friction: Rubbing = None,
    side_stop: bool | SideStop = True,
    accuracy: Annotated[float, Within(1e-8, 0.1)] = 1e-4,
) -> Contacts:
    """Interfaces whose damping ratios give |e| of the first rebound of this wall, found by simulation.

    The base is matched two-sided to `e.base`, then the side one-sided to `e.lumped` with that base, as in the flowchart
    of the paper's Figure 2. Of several damping ratios the highest is taken.

    Args:
        wall, e: the wall, and the restitution that is asked for.
        k_base, k_side: interface stiffness of base and side [N/m3], 1e4 to 1e14; no side stop without `k_side`.
        points: contact lines a face, 2 to 1000.
        amplitude: rotation theta_0/alpha that the wall is released from [-], 0.01 to 0.95.
        friction, side_friction: coefficients as in `Interface` [-], 0 to 10.
        side_stop: True for a side over the whole face, or the `SideStop` that reaches only so high.
        accuracy: of the simulations [-], 1e-8 to 0.1, see `simulate`.

    Raises:
        ValueError: for a value outside its range.

    Warns:
        UserWarning: where no damping gives what is asked for. The damping that comes closest is returned, and the
            message says what it gives.
    """
    require_kind("wall", wall, Block)
    require_kind("e", e, Restitution)
    if k_side is not None:
        e.require_rebound()
    top = 2 * wall.h if not isinstance(side_stop, SideStop) else min(side_stop.top, 2 * wall.h)
    if doubt := e.doubt(wall, top if k_side is not None else None):
        warnings.warn(doubt, Implausible, stacklevel=3)
    standing = GivenWall(wall, k_base, k_base if k_side is None else k_side, amplitude, side_stop)
    options = {"accuracy": accuracy, "friction": friction, "side_friction": side_friction}
    base = Match(standing, e, points, **options)  # type: ignore[arg-type]
    xi_base, xi_side = _matched("base", base, BASE_BOUNDS, whole=True), 0.0
    if k_side is not None:
        side = Match(standing, e, points, xi_base, **options)  # type: ignore[arg-type]
        xi_side = _matched("side", side, SIDE_BOUNDS, whole=False)
    return Contacts.from_damping(
        wall,
        k_base=k_base,
        xi_base=xi_base,
        k_side=k_side,
        xi_side=xi_side,
        points=points,
        friction=friction,
        side_friction=side_friction,
        law="matched",
        stop_top=None if k_side is None else top,
    )


def as_theory(
    wall: Block, e: Restitution, *, side_stop: bool = True, rebounds: int = 4, amplitude: float = 0.5
) -> Contacts:
    """Interfaces on which a wall rocks as classical theory has it: the same |e| at every one of the first rebounds.

    A soft base makes |e| depend on the size of the rebound. Here the stiffness is chosen so that the rotation after
    `rebounds` rebounds is still RIGID times that at which an edge lifts off the base, and this at most FLAT alpha. On
    such a base e_2s is that of Eq. 2 whatever the damping. The side is matched.

    Args:
        wall, e: the wall, and the restitution of theory.
        side_stop: whether there is a side; its stiffness is that of the base.
        rebounds: how many rebounds count, 1 to 6.
        amplitude: rotation theta_0/alpha of the release [-], in (0, 0.95].

    Raises:
        ValueError: for a value outside its range, or rebounds so faint that no stiffness up to 1e14 N/m3 would do.

    Warns:
        UserWarning: where e.base is not that of Eq. 2, or no damping of the side gives e.lumped.
    """
    require_kind("wall", wall, Block)
    require_kind("e", e, Restitution)
    require_flag("side_stop", side_stop)
    amplitude = require_within("amplitude", amplitude, 0.01, 0.95)
    rebounds = require_whole("rebounds", rebounds, 1, 6)
    theory = Restitution.from_geometry(wall).base
    if abs(e.base / theory - 1) > UNLIKE_EQ_2:
        warnings.warn(f"a stiff base gives e_2s = {theory:.4g} of Eq. 2, and not {e.base:.4g}", stacklevel=2)
    left = (e.lumped if side_stop else e.base) ** (2 * rebounds)
    last = wall.rotation_at(left * float(wall.potential_energy(amplitude * wall.alpha)))
    uplift = min(last / STIFF_AS_THEORY, FLAT * wall.alpha)
    k_n = wall.weight / (2 * wall.base_length * wall.half_base**2 * uplift)
    xi_base, xi_side = TOUCH_DOWN / wall.slenderness, 0.0
    if side_stop:
        side = Match(GivenWall(wall, k_n, k_n, amplitude), e, 2, xi_base)  # type: ignore[arg-type]
        xi_side = _matched("side", side, SIDE_BOUNDS, whole=False)
    return Contacts.from_damping(
        wall, k_base=k_n, xi_base=xi_base, k_side=k_n if side_stop else None, xi_side=xi_side, law="as theory"
    )


def _matched(name: str, match: Match, bounds: tuple[float, float], *, whole: bool) -> float:
    """The damping ratio that is matched, with a warning where the match is missed."""
    with Bar(f"matching the {name}", "runs") as bar:

        def measured(xi: float) -> float:
            bar.add()
            return match.restitution(xi)

        closest = highest_branch(measured, match.target, bounds, whole=whole)
    if not closest.reached and abs(closest.value - match.target) > MISS_WARNED_OF * match.target:
        warnings.warn(
            f"no damping of the {name} gives |e| = {match.target:.4g}; the closest, xi = {closest.xi:.3g}, gives "
            f"{closest.value:.4g}",
            stacklevel=3,
        )
    return closest.xi
