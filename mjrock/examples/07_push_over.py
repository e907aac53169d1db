"""
7. Push-over: what holds a wall at each rotation
================================================

A static curve answers two questions before any earthquake: which horizontal
acceleration starts the rocking, and from which rotation there is no way back.
Every effect of a case bends it.
"""

# %%
# The multiplier is the horizontal acceleration over g that holds the wall at a
# rotation. A rigid wall without effects starts at b/h and ends at alpha.
import mjrock as mr
from mjrock import plotting

wall = mr.Block.from_size(thickness=0.6, height=4.2)  # m
cases = {
    "as it is": (),
    "thrust of 1 kN": (mr.Thrust(height=3.8, force=1e3),),  # m, N
    "tie that yields at 5 kN": (
        mr.Tie(height=4.0, stiffness=10e6, slack=0.05, strength=5e3),
    ),  # m, N/m, m, N
}
figure = plotting.sketch(
    mr.Case(wall, 0.0, 1.0, effects=cases["tie that yields at 5 kN"])
)

# %%
# ``pushover`` takes a case and returns its curve.
curves = {}
for name, effects in cases.items():
    curves[name] = curve = mr.pushover(mr.Case(wall, 0.0, 1.0, effects=effects))
    print(
        f"{name}: starts at {curve.start:.3f} g, peak {curve.peak:.3f} g, ends "
        f"at {curve.end:.3f} rad"
    )

# %%
# Both effects bend the curve: the thrust shifts it down, and the tie holds the
# wall beyond its own end.
figure = plotting.pushover(curves).figure
