"""
16. A façade and its return walls in space
==========================================

A façade of 106 blocks with two windows is bonded to its return walls. Limit
analysis says which acceleration it bears in each direction, and explicit steps
show how it comes apart under an earthquake of three components.
"""

# %%
# ``Masonry.facade`` lays the units in bond and cuts the openings out.
# Directions are angles from outwards.
import math

from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

window = mr.Opening(width=0.4, height=0.6, sill=0.6)  # m
joints = mr.Dry(k_n=1e9, k_s=1e9, friction=0.6, xi=0.01)  # N/m3
wall = mr.Masonry.facade(
    3.2,
    1.6,
    1.2,
    unit=(0.4, 0.2),
    openings=[(-0.6, window), (0.6, window)],
    joints=joints,
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
# Three synthetic records with peaks of 6, 4 and 3 m/s2 move the ground along x,
# y and z. The motion of 7 s takes some eight seconds to compute.
peaks = {"motion": 6.0, "transverse": 4.0, "vertical": 3.0}  # m/s2
records = {
    name: mr.GroundMotion.synthetic(peak=peak, duration=6.0, seed=seed)
    for seed, (name, peak) in enumerate(peaks.items(), 1)
}
answer = mr.solve_explicit(
    mr.MasonryCase(wall, 7.0, **records), output_step=0.01
)
first, *others = answer.fallen.values()
print(f"{1 + len(others)} blocks fall, the first after {first:.1f} s")
box = [(-1.4, 3.0), (-1.7, 1.7), (0.0, 1.6)]  # m, for one scale
figure = Figure(figsize=(7.4, 2.8), layout="constrained")
for ax, t in zip(
    figure.subplots(1, 3, subplot_kw={"projection": "3d"}),
    (0.0, first, 7.0),
    strict=True,
):
    plotting.blocks(ax, answer, at=t, limits=box)
    ax.set_title(f"{t:.1f} s")

# %%
# The motion on a page, to be turned and played in any browser, is one line:
# ``mr.plotting.view(answer, "facade.html")``.
