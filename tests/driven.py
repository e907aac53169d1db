"""A panel that actuators drive and a table tilts."""

import mjrock as mr

B, H = 0.25, 1.0
WEIGHT = 2000.0 * 4 * B * H * mr.GRAVITY
BASE = [(-4.0, -0.5), (4.0, -0.5), (4.0, 0.0), (-4.0, 0.0)]
PANEL = [(-B, 0.0), (B, 0.0), (B, 2 * H), (-B, 2 * H)]


def panel(friction, *, in_space=False, k_n=2e9, **more):
    """A panel of 0.5 x 2 x 1 m on a base, of 2000 kg/m3."""
    if in_space:
        base = mr.Polyhedron.box((8.0, 3.0, 0.5), (0.0, 0.0, -0.25), fixed=True, name="base")
        blocks = [base, mr.Polyhedron.box((2 * B, 1.0, 2 * H), (0.0, 0.0, H), name="panel")]
    else:
        blocks = [mr.Polygon(BASE, fixed=True, name="base"), mr.Polygon(PANEL, density=2000.0, name="panel")]
    return mr.Masonry(blocks, k_n=k_n, friction=friction, xi=0.1, **more)
