"""
11. A panel in running bond pushed in its plane
===============================================

How large a horizontal force does a dry wall bear, as a share of its weight?
Limit analysis answers without any motion: it finds the mechanism that needs the
smallest force. A longer wall bears more, and its mechanism is another.
"""

# %%
# ``collapse_multiplier`` solves a linear programme for rigid blocks with
# friction.
import mjrock as mr
from mjrock import plotting

found = {}
for length in (1.2, 2.4):  # m
    wall = mr.Masonry.running_bond(
        length, 1.6, unit=(0.4, 0.2), k_n=1e9, friction=0.65
    )
    found[length] = mr.collapse_multiplier(wall)
    print(
        f"{length} m long: {len(wall.free)} blocks, fails at "
        f"{found[length].multiplier:.3f} of its weight"
    )


# %%
# The mechanisms, with the forces of the joints.
def drawing(collapse):
    """What draws one mechanism."""
    return lambda ax: plotting.mechanism(ax, collapse)


figure = plotting.panels(
    [(f"{length} m", drawing(collapse)) for length, collapse in found.items()]
)
