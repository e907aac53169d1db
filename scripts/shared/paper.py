"""The numbers of the source paper, as printed.

"Dynamic simulation of one-sided rocking masonry facades using an energy-consistent viscous damping model":
section 3.2 and Figure 3; Table 2, whose experiments are those of its reference [16] (Sorrentino et al.).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from mjrock import Block, Restitution

K_N = 5e8
"""Interface stiffness of base and side in Figure 3 and Table 2 [N/m3]."""
DENSITY = 2000.0
"""Density [kg/m3]. The paper prints none."""

FIGURE_3 = Block.from_size(thickness=0.6, height=4.2, length=1.0, density=DENSITY)
"""The wall of Figure 3, 2h = 4.2 m, 2b = 0.6 m; released at theta_0 / alpha = 0.5, the reference value of Table 1."""
FIGURE_3_XI = (0.053, 0.0074)
"""xi_b and xi_s as printed below Figure 3."""


@dataclass(frozen=True)
class Specimen:
    """A row of Table 2: height [m], alpha_exp [rad], e_1s,exp [-], xi_b and xi_s as fractions."""

    name: str
    height: float
    alpha: float
    lumped: float
    xi_base: float
    xi_side: float

    @property
    def slug(self) -> str:
        """The name as a folder name."""
        return self.name.replace(", ", "_")

    @property
    def block(self) -> Block:
        """The wall with the measured slenderness, 1 m long."""
        return Block.from_size(self.height * math.tan(self.alpha), self.height, density=DENSITY)

    @property
    def restitution(self) -> Restitution:
        """e_2s by Eq. 2 from alpha_exp, e_side from the measured e_1s."""
        return Restitution.from_lumped(self.lumped, self.alpha)


TABLE_2 = (
    Specimen("brick, h80, cd12, t01", 0.80, 0.1184, -0.328, 0.0435, 0.0115),
    Specimen("brick, h82, cd06, t03", 0.82, 0.1157, -0.441, 0.0424, 0.0084),
    Specimen("brick, h136, cd06, t01", 1.36, 0.0420, -0.458, 0.0144, 0.0109),
    Specimen("brick, h163, cd06, t01", 1.63, 0.0371, -0.273, 0.0126, 0.0187),
    Specimen("tuff, h128, cd12, t02", 1.28, 0.0699, -0.403, 0.0248, 0.0110),
    Specimen("tuff, h163, cd12, t02", 1.63, 0.0546, -0.309, 0.0190, 0.0152),
)
