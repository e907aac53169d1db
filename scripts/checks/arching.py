"""A cracked strip that arches between two rigid floors and crushes at its joints, beside a closed form.

Two halves of a wall of the height H and the thickness t turn about their ends as the joint between them is pushed out
by a displacement u. The halves are rigid, and joints bear f_c and no more. Both ends of a half are then pressed over
depths whose sum is t - u, since at that rate their overlap grows. The pressure at a joint falls with its shear, as
sigma^2 + 9 tau^2 stays within f_c^2, and the shear over the thrust is (t - u) / H. So the thrust is f (t - u) / 2 with

    f = f_c / sqrt(1 + 9 ((t - u) / H)^2),   and the force that pushes is P = f (t - u)^2 / H.

This is the arching of yield-line practice (McDowell, McKee and Sevin, Arching action theory of masonry walls, Journal
of the Structural Division 82, 1956) for a block of pressure that is rectangular, with the shear taken into account.
Joints are nearly rigid, and the strip nearly without weight. Prints the forces and draws the curve.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli

T, H = 0.12, 2.4
"""Thickness and height of the strip [m]; it is 1 m long."""
CRUSHING = 5e6
"""f_c [Pa]."""
K, K_S, POINTS = 1e12, 2e9, 41
"""Stiffness of the joints along the normal and the face [N/m3], and lines across each. Where they are as stiff along
the face, the slip of a joint that closes and turns, its closing times the rotation, takes up the friction."""
SHARES = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
"""Displacements at which forces are compared, over the thickness [-]."""


def closed(u: Array | float) -> Array:
    """Force of the closed form at a displacement [N]."""
    deep = np.maximum(T - np.asarray(u), 0.0)
    return np.asarray(CRUSHING / np.sqrt(1 + 9 * (deep / H) ** 2) * deep**2 / H)


def strip(k_s: float = K_S, points: int = POINTS) -> mr.Masonry:
    """Two halves between two floors."""

    def block(name: str, left: float, low: float, right: float, high: float) -> mr.Polygon:
        fixed = "floor" in name
        corners = [(left, low), (right, low), (right, high), (left, high)]
        return mr.Polygon(corners, length=1.0, density=200.0, fixed=fixed, name=name)

    blocks = [
        block("floor below", -T, -0.2, 2 * T, 0.0),
        block("lower half", 0.0, 0.0, T, 0.5 * H),
        block("upper half", 0.0, 0.5 * H, T, H),
        block("floor above", -T, H, 2 * T, H + 0.2),
    ]
    bond = mr.Bond(0.0, 0.0, 1.0, 1.0, crushing=CRUSHING, crushing_energy=1e12)
    return mr.Masonry(blocks, k_n=K, k_s=k_s, friction=0.7, xi=0.05, points=points, bond=bond)


def pushed(shares: Sequence[float] = SHARES, k_s: float = K_S, points: int = POINTS) -> mr.Push:
    """The strip, pushed at the foot of its upper half."""
    jack = mr.Actuator("upper half", (0.0, 0.5 * H), 1, None, 1e9)
    return mr.push(strip(k_s, points), jack, max(shares) * T, mass_damping=20.0)


def forces(push: mr.Push, shares: Sequence[float]) -> Array:
    """Force at displacements over the thickness [N]."""
    return np.interp(np.asarray(shares) * T, push.displacement, push.force)


def drawn(push: mr.Push) -> Figure:
    """The curve beside the closed form."""
    figure = Figure(figsize=(5.6, 3.4), layout="constrained")
    ax = figure.subplots()
    u = np.linspace(0.0, push.displacement.max(), 200)
    ax.plot(1e3 * push.displacement, 1e-3 * push.force, **plotting.STYLES["explicit"] | {"linestyle": "-"})
    ax.plot(1e3 * u, 1e-3 * closed(u), color="0.2", linestyle="--", label="closed form: rigid halves, even pressure")
    ax.set(xlabel="displacement at half height [mm]", ylabel="force [kN]", xlim=(0, None), ylim=(0, None))
    ax.legend(frameon=False, fontsize=9)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Push, print the table and draw."""
    args = cli.parser(__doc__, "arching").parse_args(argv)
    out = cli.folder(args.out)
    shares, points = ((0.1 * SHARES[0],), 5) if args.quick else (SHARES, POINTS)
    push = pushed(shares, points=points)
    stiff = push if args.quick else pushed(shares, K)
    rows: list[list[object]] = []
    for share, found, other in zip(shares, forces(push, shares), forces(stiff, shares), strict=True):
        expected = float(closed(share * T))
        errors = [f"{force / expected - 1:+.1%}" for force in (found, other)]
        rows.append([f"{share:g}", f"{expected / 1e3:.2f}", f"{found / 1e3:.2f}", *errors])
    plotting.save(drawn(push), out / "arching.png")
    header = ["u / t", "closed form [kN]", "explicit steps [kN]", "error", f"error, k_s = {K:g} N/m3"]
    cli.report(out / "arching", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
