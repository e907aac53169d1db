"""
12. A wall that cracks: mortar under shear
==========================================

Mortar gives a joint tension and cohesion until it cracks. A small shear wall
stands between a base and a beam. The beam presses it and then moves sideways,
and the joints crack one after the other.
"""

# %%
# A ``Bond`` has strengths and the energies that its cracks take. The beam comes
# down by 0.03 mm and moves by 1.5 mm.
import mjrock as mr
from mjrock import plotting

bond = mr.Bond(
    tension=0.15e6, cohesion=0.2e6, opening_energy=15.0, slip_energy=100.0
)  # Pa, J/m2
mortar = mr.Mortar(
    mr.Dry(k_n=2e10, k_s=8e9, friction=0.7, points=3), bond
)  # N/m3
wall = mr.Masonry.shear_wall(
    0.8, 0.6, unit=(0.2, 0.1), thickness=0.1, joints=mortar
)  # m
beam = ([0.0, 0.1, 0.5], [0.0, 0.0, 1.5e-3], [0.0, -3e-5, -3e-5])  # s, m, m
answer = mr.solve_explicit(
    mr.MasonryCase(wall, 0.5, supports={"beam": beam}),
    output_step=5e-3,
    forces=True,
)
times = sorted(answer.cracked.values())
print(
    f"{len(times)} of {len(wall.joints)} joints crack, the first at "
    f"{times[0]:.2f} s"
)

# %%
# Joints that have lost their bond, thicker where they are open, with
# displacements 20 times as large.
figure = plotting.single(
    lambda ax: plotting.blocks(
        ax, answer, at=0.5, forces="cracks", magnified=20.0
    )
)
