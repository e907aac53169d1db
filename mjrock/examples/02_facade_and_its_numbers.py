"""
2. A façade with openings and a gable
=====================================

Openings take mass out of a façade and move its centroid, and so does a gable.
The slenderness of the whole decides at which acceleration the façade starts to
rock and from which rotation it falls. This example draws the façade and prints
its numbers with and without them.
"""

# %%
# A façade is a ``Block``. Openings and a gable are given where it is made.
import mjrock as mr
from mjrock import plotting

size = {
    "thickness": 0.6,
    "height": 8.0,
    "length": 7.0,
    "density": 1900.0,
}  # m, kg/m3
door = mr.Opening(width=1.6, height=2.6)  # m
window = mr.Opening(width=1.4, height=1.4, sill=4.4, round=True)
walls = {
    "plain": mr.Block.from_size(**size),
    "with openings": mr.Block.from_size(**size, openings=[door, window]),
    "and a gable": mr.Block.from_size(
        **size, openings=[door, window], gable=mr.Gable(height=2.0)
    ),
}
for name, wall in walls.items():
    curve = mr.pushover(mr.Case(wall, 0.0, 1.0))
    print(
        f"{name}: {wall.mass / 1e3:.1f} t, centroid at "
        f"{wall.centroid_height:.2f} m",
        end=", ",
    )
    print(f"rocks from {curve.start:.3f} g, falls from {curve.end:.3f} rad")

# %%
# ``plotting.sketch`` draws what a case has: here a thrust and a tie besides.
roof = mr.Thrust(height=6.0, force=5e3)  # m, N
tie = mr.Tie(height=5.8, stiffness=10e6, strength=30e3)  # m, N/m, N
figure = plotting.sketch(
    mr.Case(walls["and a gable"], 0.0, 10.0, effects=(roof, tie))
)
