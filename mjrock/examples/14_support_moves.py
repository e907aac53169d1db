"""
14. An arch whose support moves away
====================================

Foundations settle and buttresses give way. The line of thrust of an arch shows
how it goes on bearing: the hinges are where the line touches its edge. One
abutment moves outwards slowly, until the arch falls.
"""

# %%
# A support moves by a history of times and displacements. ``forces=True`` keeps
# the forces of all joints.
import mjrock as mr
from mjrock import plotting

arch = mr.Masonry.arch(
    radius=2.0, thickness=0.4, voussoirs=15, ground=True
)  # m
away = {"right_abutment": ([0.0, 2.0], [0.0, 0.8], [0.0, 0.0])}  # s, m, m
answer = mr.solve_explicit(
    mr.MasonryCase(arch, 2.0, supports=away), output_step=0.02, forces=True
)
first = min(answer.fallen.values(), default=2.0)
print(
    "the arch has fallen when its support has moved by "
    f"{1e3 * 0.4 * first:.0f} mm"
)

# %%
# The line of thrust when the support has moved by 0.12 m and by 0.48 m.
figure = plotting.panels(
    [
        (f"{0.4 * t:.2f} m", lambda ax, t=t: plotting.thrust(ax, answer, at=t))
        for t in (0.3, 1.2)
    ]
)
