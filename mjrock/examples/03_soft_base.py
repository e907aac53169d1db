"""
3. How soft may the base be?
============================

Rocking theory has a rigid base. A real one yields under the weight, by the
interface stiffness k_n. Below the rotation theta_u at which an edge lifts, the
wall vibrates on its base and does not rock. This example looks at ``|e|``, the
restitution of each rebound, on softer and softer bases.
"""

# %%
# Each rebound is drawn at its own size over theta_u. The damping is that of the
# calibrated law, which aims at the first rebound. Theory has the same ``|e|``
# for all of them.
import matplotlib
from matplotlib.figure import Figure

import mjrock as mr
from mjrock.plotting.style import power_of_ten

wall = mr.Block.from_size(thickness=0.6, height=4.2)  # m
e = mr.Restitution.from_geometry(wall)
case = mr.Case(wall, theta0=0.5 * wall.alpha, duration=4.0)
stiffnesses = [2e8, 5e8, 2e9, 1e10, 5e10]  # N/m3
points = {}
for k_n in stiffnesses:
    contacts = mr.Contacts.from_law(wall, e, k_base=k_n, k_side=k_n)
    response = mr.simulate(case, contacts, accuracy=1e-4)
    sizes = response.peaks[1:] / contacts.uplift_rotation(wall)
    points[k_n] = sizes, response.restitution
    print(
        f"{k_n:.0e} N/m3: |e| =",
        " ".join(f"{value:.3f}" for value in response.restitution[:4]),
    )

# %%
# What decides is not k_n but the size of the rebound over theta_u. From about
# four times on ``|e|`` is that of theory.
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
ax = figure.subplots()
colors = matplotlib.colormaps["viridis"]
for i, (k_n, (sizes, values)) in enumerate(points.items()):
    ax.plot(
        sizes,
        values,
        "o-",
        color=colors(i / len(points)),
        label=f"{power_of_ten(k_n)} N/m³",
    )
ax.axhline(abs(e.lumped), color="0.4", linestyle="--", label="theory")
ax.set_xscale("log")
ax.set_xlabel("rebound over the rotation at which an edge lifts [-]")
ax.set_ylabel("|e| of the rebound [-]")
_ = ax.legend(frameon=False, fontsize=8)
