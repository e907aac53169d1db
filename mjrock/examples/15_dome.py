"""
15. How thin may a dome be?
===========================

A dome of blocks stands without mortar if it is thick enough. Its parts near the
base spread, and those near the top come down. Two domes of one radius are
released: one stands, and the other falls.
"""

# %%
# Blocks in space have six ways to move. Twelve blocks in each of six rings are
# 72 blocks.
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

answers = {}
for thickness in (0.3, 0.1):  # m
    dome = mr.Masonry.dome(
        3.0, thickness, lunes=12, hoops=6, oculus=0.25, k_n=1e9, friction=0.7
    )
    answers[thickness] = answer = mr.solve_explicit(
        mr.MasonryCase(dome, 1.0, settled=False), output_step=0.02
    )
    print(f"{thickness} m: {'falls' if answer.fallen else 'stands'}")

# %%
# Both after one second.
box = [(-3.6, 3.6), (-3.6, 3.6), (0.0, 3.2)]  # m, for one scale
figure = Figure(figsize=(7.0, 3.2), layout="constrained")
for ax, (thickness, answer) in zip(
    figure.subplots(1, 2, subplot_kw={"projection": "3d"}),
    answers.items(),
    strict=True,
):
    plotting.blocks(ax, answer, at=1.0, limits=box)
    ax.set_title(f"{thickness} m thick")
