"""The law of a bond: how a mortared joint opens, slips and crushes, beside `joint_law`.

With f_t, c and f_c the strengths, G_I, G_II and G_c their energies, w the opening of the crack, s the way of the slider
and v the plastic closing, what is left of tension and cohesion is

    1 - D = exp(-(f_t / G_I) w - (c / G_II) s - (f_c / G_c) v),

so that opening, slip and crushing each harm both. Friction falls with them, from mu to mu_r + (mu - mu_r) (1 - D). A
bond pulls at most f_t (1 - D). Below its largest opening it pulls
along the secant to the origin, and a joint that closes has its whole stiffness. Along the face it holds c (1 - D)
beside friction. Crushing keeps sqrt(sigma^2 + 9 tau^2) within f_c exp(-(f_c / G_c) v), and a joint that is crushed by v
is unloaded with a gap of v. With a hardening v_p it bears

    f_c (1 + 2 sqrt(2 v/v_p - (v/v_p)^2)) / 3   up to v = v_p, and f_c exp(-r (v - v_p)) beyond,

the parabola to the peak of Lourenco and Rots (Journal of Engineering Mechanics 123, 1997), with r such that the whole
area is G_c. Tension and cohesion suffer from what is crushed beyond the peak.

A row is anything with these numbers by name, see `rows`. Strengths are forces of the line there.
"""

from __future__ import annotations

import math

from ....compiled import inlined
from .joint_law import LawRow, shear_limit

PASSES = 8
"""Passes of the search for the opening of a crack, by Newton's method, and for a plastic closing."""
BRITTLE = 0.9
"""Rate at which a crack softens, over the stiffness of its spring, from which it breaks at once [-]."""
YIELDS = 1 / 3
"""Share of the crushing strength that a joint which hardens bears before it closes for good [-]."""
HARDENED = YIELDS + (1 - YIELDS) * math.pi / 4
"""Mean share of the crushing strength that it bears from there to the peak [-]."""
CLOSING_HALVINGS = 40
"""Halvings of the closing that is looked for while a joint hardens."""


@inlined
def tear(bond: LawRow, gap: float) -> None:
    """Let the crack of a bond grow until it pulls no more than is left of its strength, at a gap [m].

    The opening w of the crack solves k (u - w) = T exp(-w r), with u the largest gap, T the strength and r its rate.
    Where k is hardly above T r, the spring gives back what the crack takes, and the bond breaks at once.
    """
    largest = max(bond.largest_gap, gap)
    bond.largest_gap, crack, strength = largest, bond.crack, bond.tension * bond.integrity
    if bond.k * (largest - crack) <= strength:
        return
    if bond.opening_rate * strength >= BRITTLE * bond.k:
        bond.crack, bond.integrity, bond.secant = largest, 0.0, 0.0
        return
    for _ in range(PASSES):
        pull = strength * math.exp(-bond.opening_rate * (crack - bond.crack))
        crack = min(crack + (bond.k * (largest - crack) - pull) / (bond.k - bond.opening_rate * pull), largest)
    bond.integrity *= math.exp(-bond.opening_rate * (crack - bond.crack))
    bond.crack = crack
    bond.secant = bond.k * (largest - crack) / largest


@inlined
def hardened(bond: LawRow, closing: float) -> float:
    """What a joint that hardens bears after it has closed by a further amount, up to its peak [N]."""
    share = min((bond.crushed + closing) / bond.hardening, 1.0)
    bears: float = bond.peak * (YIELDS + (1 - YIELDS) * math.sqrt(share * (2 - share)))
    return bears


@inlined
def harden(bond: LawRow, gap: float, sheared: float) -> float:
    """Close a joint at a gap [m] for good until it bears what presses, or to its peak, see `crush`. Returns by how much
    [m]."""
    remaining: float = bond.hardening - bond.crushed
    low, high = 0.0, min(remaining, -gap)
    if math.hypot(bond.k * (gap + high), sheared) < hardened(bond, high):
        for _ in range(CLOSING_HALVINGS):
            closing = 0.5 * (low + high)
            if math.hypot(bond.k * (gap + closing), sheared) < hardened(bond, closing):
                high = closing
            else:
                low = closing
    bond.strength = hardened(bond, high)
    bond.crushed = bond.crushed + high if high < remaining else bond.hardening
    return high


@inlined
def crush(bond: LawRow, gap: float, sheared: float) -> float:
    """Crush a joint at a gap [m] under a force along the face [N]. Returns by how much it closes for good [m]."""
    sheared *= 3
    closing: float = 0.0
    pressed = bond.k * gap
    if pressed * pressed + sheared * sheared <= bond.strength * bond.strength:
        return 0.0
    if bond.crushed < bond.hardening:
        closing = harden(bond, gap, sheared)
    if bond.crushed >= bond.hardening:
        closing += soften(bond, gap + closing, sheared)
    return closing


@inlined
def soften(bond: LawRow, gap: float, sheared: float) -> float:
    """Crush a joint beyond its peak, see `crush`."""
    closing: float = 0.0
    for _ in range(PASSES):
        strength = bond.strength * math.exp(-bond.crushing_rate * closing)
        closing = max(-gap - math.sqrt(max(strength * strength - sheared * sheared, 0.0)) / bond.k, 0.0)
    bond.crushed += closing
    bond.strength *= math.exp(-bond.crushing_rate * closing)
    bond.integrity *= math.exp(-bond.crushing_rate * closing)
    return closing


@inlined
def bonded_limit(bond: LawRow, push: float) -> float:
    """Largest force along the face that a bonded joint holds under a force along the normal [N]."""
    limit: float = min(bond.cohesion * bond.integrity + shear_limit(bond, max(push, 0.0)), bond.strength / 3)
    return limit


@inlined
def wear(bond: LawRow, slid: float) -> float:
    """Wear a bond by the way of its slider [m]. Returns what its cohesion has taken [J]."""
    if bond.slip_rate == 0 or slid == 0:
        return 0.0
    share = -math.expm1(-bond.slip_rate * slid)
    dissipated: float = bond.cohesion * bond.integrity * share / bond.slip_rate
    bond.integrity *= 1 - share
    return dissipated
