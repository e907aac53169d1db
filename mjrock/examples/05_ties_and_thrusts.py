"""
5. A façade with a thrust, and a tie that saves it
==================================================

A façade of 6 m carries a floor, and a vault pushes it outwards. A tie near the
top holds it back. Its anchorage gives way at 60 kN and then yields. Effects are
objects in the case; what is not there costs nothing.
"""

# %%
# Heights are measured from the base and offsets outwards from its middle. A
# thrust is positive outwards.
import mjrock as mr
from mjrock import plotting

door = mr.Opening(width=1.2, height=2.2)  # m
wall = mr.Block.from_size(
    thickness=0.6, height=6.0, length=5.0, density=1800.0, openings=[door]
)
floor = mr.Load(force=40e3, height=3.0, offset=-0.2)  # N, m
vault = mr.Thrust(height=5.0, force=3e3)  # m, N
tie = mr.Tie(
    height=5.5, stiffness=20e6, slack=0.005, strength=60e3, length=4.0
)  # m, N/m, m, N, m
still = mr.Case(wall, 0.0, 1.0, effects=(floor, vault))
print(
    f"overturns from {wall.alpha:.4f} rad alone, from "
    f"{still.overturning_rotation:.4f} rad with floor and vault"
)
figure = plotting.sketch(mr.Case(wall, 0.0, 1.0, effects=(floor, vault, tie)))

# %%
# The same ground motion without the tie and with it.
e = mr.Restitution.from_geometry(wall)
contacts = mr.Contacts.from_law(wall, e, k_base=2e9, k_side=2e9)  # N/m3
record = mr.GroundMotion.synthetic(peak=6.0, duration=10.0, seed=3)  # m/s2, s
panels = []
for name, effects in (
    ("floor and vault", (floor, vault)),
    ("and a tie", (floor, vault, tie)),
):
    case = mr.Case(wall, 0.0, 12.0, motion=record, effects=effects)
    answers = [
        mr.solve_analytical(case, e),
        mr.simulate(case, contacts, ledger=True),
    ]
    panels.append((name, answers))
    for response in answers:
        print(
            f"{name}, {response.solver}: {response.outcome.value}, peak "
            f"{response.peak_over_alpha:.2f} alpha"
        )
        for tied in response.plastic.values():
            print(
                f"  the tie yielded by {1e3 * tied.elongation:.1f} mm and took "
                f"{tied.energy:.0f} J"
            )

# %%
# The wall without the tie leaves the picture when it falls. This tie yields
# without end. Give it the elongation that its anchorage follows,
# `ultimate=0.03` for 30 mm, and it breaks there.
figure = plotting.grid(panels, columns=2, top=1.0)
