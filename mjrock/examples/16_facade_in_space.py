"""
16. A façade and its return walls in space
==========================================

A façade with a window is bonded to its return walls. Limit analysis says which
acceleration it bears in each direction, and explicit steps show how it comes
apart under a strong motion out of its plane.
"""

# %%
# ``Masonry.facade`` lays the units in bond and cuts the opening out. Directions
# are angles from outwards.
import math

from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

window = mr.Opening(width=0.5, height=0.6, sill=0.5)  # m
joints = mr.Dry(k_n=5e8, k_s=2e8, friction=0.6, xi=0.02)  # N/m3
wall = mr.Masonry.facade(
    2.5, 1.75, 1.0, unit=(0.5, 0.25), openings=[(0.0, window)], joints=joints
)  # m
for name, angle in (
    ("outwards", 0.0),
    ("along", math.pi / 2),
    ("inwards", math.pi),
):
    print(
        f"{name}: {mr.collapse_multiplier(wall, angle=angle).multiplier:.2f} g"
    )

# %%
# The motion is two cycles with a peak of 10 m/s2. Ground that accelerates
# inwards throws the façade outwards.
shake = mr.GroundMotion.sine(amplitude=-10.0, period=0.6, cycles=2.0)  # m/s2, s
answer = mr.solve_explicit(
    mr.MasonryCase(wall, 1.4, motion=shake), output_step=0.02
)
print("blocks fall" if answer.fallen else "the wall stands")
figure = Figure(figsize=(7.0, 3.2), layout="constrained")
for ax, t in zip(
    figure.subplots(1, 2, subplot_kw={"projection": "3d"}),
    (0.0, 1.4),
    strict=True,
):
    plotting.blocks(ax, answer, at=t)
    ax.set_title(f"{t} s")
