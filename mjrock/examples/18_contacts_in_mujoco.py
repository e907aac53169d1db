"""
18. A contact of given stiffness in a MuJoCo model
==================================================

MuJoCo's default contact has a stiffness that grows with the mass of its bodies.
``contact_for`` writes one of a given stiffness in N/m and a given restitution.
A ball of 2 kg falls on a floor, with both.
"""

# %%
# The default bounces little and sinks in. The other returns half of the speed.
import mujoco
import numpy as np
from matplotlib.figure import Figure

import mjrock as mr

MODEL = """<mujoco><option timestep="2e-4"/><worldbody>
<geom name="floor" type="plane" size="1 1 1"/>
<body pos="0 0 .6"><freejoint/><geom name="ball" size=".1" mass="2"/></body>
</worldbody></mujoco>"""
heights = {}
for name in ("default contact", "k = 1e5 N/m, e = 0.5"):
    spec = mujoco.MjSpec.from_string(MODEL)
    if name != "default contact":
        mr.contact_for(spec, "ball", "floor", k=1e5, restitution=0.5).apply(
            spec
        )
    model = spec.compile()
    data, path = mujoco.MjData(model), []
    for _ in range(5000):
        mujoco.mj_step(model, data)
        path.append(data.qpos[2] - 0.1)
    heights[name] = np.array(path)
    print(
        f"{name}: rebounds to {max(path[1700:]):.3f} m and rests "
        f"{-1e3 * path[-1]:.2f} mm deep"
    )

# %%
# The height of the ball over its floor.
figure = Figure(figsize=(6.4, 3.4), layout="constrained")
ax = figure.subplots()
for (name, path), colour in zip(
    heights.items(), mr.plotting.PALETTE, strict=False
):
    ax.plot(2e-4 * np.arange(len(path)), path, label=name, color=colour)
ax.set(xlabel="time [s]", ylabel="height [m]")
_ = ax.legend(frameon=False)
