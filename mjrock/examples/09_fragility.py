"""
9. At which acceleration does a façade fall?
============================================

One record gives one answer, and another record another. A fragility curve gives
the share of records that overturn a façade at each intensity. This example
finds the capacity under eight records in both polarities, with and without a
tie.
"""

# %%
# ``Capacity`` scales the motion of a case until the wall overturns.
# ``campaign`` runs all combinations and keeps them in a file, so that a run
# that was stopped goes on.
from pathlib import Path
from tempfile import mkdtemp

from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

wall = mr.Block.from_size(thickness=0.5, height=6.0, length=5.0)  # m
e = mr.Restitution.from_geometry(wall)
tie = mr.Tie(
    height=5.5, stiffness=20e6, strength=15e3, ultimate=0.1
)  # m, N/m, N, m
variants = {"as it is": (), "with a tie": (tie,)}


def build(variant, record, polarity):
    """The capacity of a variant under one polarity of a record."""
    motion = mr.GroundMotion.synthetic(
        peak=4.0, duration=10.0, seed=record
    ).polarities[polarity]
    case = mr.Case(wall, 0.0, 12.0, motion=motion, effects=variants[variant])
    return mr.Capacity(
        mr.Analysis(case, "analytical", e=e), tolerance=0.05, below=0
    )


grid = mr.Grid(build, variant=variants, record=range(8), polarity=[0, 1])
rows = mr.results(
    grid, mr.campaign(grid, Path(mkdtemp()) / "capacities.sqlite", workers=1)
)

# %%
# A lognormal curve is fitted to the capacities. Both polarities of a record are
# one group.
fits = {}
for name in variants:
    own = [row for row in rows if row["variant"] == name]
    fits[name] = mr.fit_capacities(
        [row["capacity_g"] for row in own],
        groups=[row["record"] for row in own],
    )
    print(
        f"{name}: median {fits[name].median:.2f} g, dispersion "
        f"{fits[name].dispersion:.2f}"
    )

# %%
# The tie moves the curve to the right: the same motion overturns fewer walls.
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
ax = figure.subplots()
for name, fit in fits.items():
    plotting.fragility(ax, fit, solver=name)
_ = ax.legend(frameon=False, fontsize=8)
