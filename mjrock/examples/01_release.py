"""
1. A wall released against its side stop
========================================

A façade has come loose from its side walls. It is held tilted outwards and let
go. It falls back on its base and against the side walls, which throw it
outwards again. Three solvers follow the motion.
"""

# %%
# The wall is that of the paper's Figure 3: 0.6 m thick and 4.2 m high. It falls
# over from a tilt of alpha, the angle between its height and its diagonal. Only
# rotations as a share of alpha mean something, so the release is given so.
import mjrock as mr
from mjrock import plotting

wall = mr.Block.from_size(thickness=0.6, height=4.2)  # m
case = mr.Case(
    wall, theta0=0.5 * wall.alpha, duration=3.0, side_stop=True
)  # rad, s
print(
    f"alpha = {wall.alpha:.4f} rad, R = {wall.R:.3f} m, p = {wall.p:.3f} rad/s"
)
figure = plotting.sketch(case)

# %%
# Rocking theory takes the loss at an impact from the geometry. e_1s is the
# angular velocity after the impact over that before it. It is negative, because
# the wall turns back.
e = mr.Restitution.from_geometry(wall)
print(
    f"base e_2s = {e.base:.3f}, side e_side = {e.side:.3f}, together e_1s = "
    f"{e.lumped:.3f}"
)
theory = mr.solve_analytical(case, e)

# %%
# A contact in MuJoCo has a stiffness and a dashpot instead. The law gives the
# damping ratios xi that lose as much.
contacts = mr.Contacts.from_law(wall, e, k_base=5e8, k_side=5e8)  # N/m3
print(
    f"xi_b = {contacts.base.xi:.2%} at the base, xi_s = {contacts.side.xi:.2%} "
    "at the side"
)
engine = mr.simulate(case, contacts)

# %%
# SciPy solves the same springs and dashpots. It shares no code with the engine,
# so that it can tell a fault of the engine from a difference between the two
# kinds of model.
checked = mr.solve_compliant(case, contacts)
for name, response in (
    ("theory", theory),
    ("MuJoCo", engine),
    ("SciPy", checked),
):
    print(
        f"{name}: |e| of the first rebounds",
        " ".join(f"{value:.3f}" for value in response.restitution[:3]),
    )
print(
    "RMS of theta/alpha, MuJoCo to SciPy: "
    f"{mr.compare(checked, engine).rms:.5f}"
)

# %%
# The rotation and the energy above the wall at rest. Energy falls in steps: an
# impact takes four fifths of it.
figure = plotting.comparison(
    [theory, engine, checked], "released at half the overturning rotation"
)
