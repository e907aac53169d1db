"""
17. A wall that falls into a heap
=================================

Explicit steps find contacts wherever blocks meet, so that a wall can fall and
its rubble can come to rest. A freestanding wall is shaken in its plane until it
fails.
"""

# %%
# One cycle of a strong motion acts on a wall in running bond. That it falls is
# the same on every processor. When the first block falls, and where each of
# them ends, depends on the last digit of a sum.
import mjrock as mr
from mjrock import plotting

wall = mr.Masonry.running_bond(
    2.0, 2.0, unit=(0.5, 0.25), k_n=1e9, friction=0.6
)  # m, N/m3
shake = mr.GroundMotion.sine(amplitude=12.0, period=1.2)  # m/s2, s
answer = mr.solve_explicit(
    mr.MasonryCase(wall, 4.0, motion=shake), output_step=0.02
)
print(f"how the wall ended: {answer.outcome.value}")

# %%
# The wall in the middle of its fall and at rest.
figure = plotting.panels(
    [
        (f"{t} s", lambda ax, t=t: plotting.blocks(ax, answer, at=t))
        for t in (2.0, 4.0)
    ]
)
