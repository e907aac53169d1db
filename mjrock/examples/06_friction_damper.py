"""
6. A façade that slips on its floors
====================================

Between a façade and the floor behind it stands an anchor that slips at a force,
both ways. It takes energy from every swing. A tie takes it once, as it yields.
"""

# %%
# A façade of 6 m, of 318 kN, and a record that overturns it.
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

wall = mr.Block.from_size(thickness=0.6, height=6.0, length=5.0, density=1800.0)
e = mr.Restitution.from_geometry(wall)
contacts = mr.Contacts.from_law(wall, e, k_base=2e9, k_side=2e9)  # N/m3
record = mr.GroundMotion.synthetic(peak=6.0, duration=10.0, seed=2)  # m/s2, s
damper = mr.FrictionDamper(
    height=5.5, stiffness=20e6, slip_force=20e3
)  # m, N/m, N
figure = plotting.sketch(
    mr.Case(wall, 0.0, 12.0, motion=record, effects=damper)
)

# %%
# Without it and with it.
panels, held = [], None
for name, effects in (("alone", ()), ("with a friction damper", damper)):
    held = mr.simulate(
        mr.Case(wall, 0.0, 12.0, motion=record, effects=effects),
        contacts,
        ledger=True,
    )
    panels.append((name, [held]))
    print(
        f"{name}: {held.outcome.value}, peak {held.peak_over_alpha:.2f} alpha"
    )
anchor = held.ties["friction_damper_0"]
spent = held.plastic["friction_damper_0"]
print(
    f"it slipped {1e3 * spent.elongation:.0f} mm in all and took "
    f"{spent.energy:.0f} J"
)
figure = plotting.grid(panels, columns=2, top=1.0)

# %%
# The force over the slip: loops whose area is what it took.
figure = Figure(figsize=(6.4, 3.2), layout="constrained")
ax = figure.subplots()
ax.plot(
    1e3 * anchor.elongation,
    1e-3 * anchor.force,
    linewidth=0.8,
    color=plotting.PALETTE[0],
)
ax.set(xlabel="elongation [mm]", ylabel="force [kN]")
