"""
20. A town of façades
=====================

Which façades of a town lean far or fall in one earthquake? A table has a row
for each façade, and a campaign runs all of them. This one has 60 façades on
three soils; :doc:`/town` explains each step for a town of 200.
"""

# %%
# The walls: they get higher and thinner towards the river, where the soil is
# soft.
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr

rng = np.random.default_rng(1)
x, y = rng.uniform(0.0, 600.0, 60), rng.uniform(0.0, 300.0, 60)  # m
heights, thicknesses = (
    rng.uniform(5.0, 11.0, 60),
    rng.uniform(0.45, 0.8, 60),
)  # m
soils = ["C" if east < 150 else "B" if east < 400 else "A" for east in x]


def build(wall, record):
    """A wall under a record that fits the spectrum of its soil."""
    spectrum = mr.code_spectrum(
        "NTC 2018", ag=0.3 * mr.GRAVITY, F0=2.45, Tc=0.33, soil=soils[wall]
    )
    made = mr.GroundMotion.synthetic(peak=3.0, duration=12.0, seed=record)
    motion = mr.scaled_to_spectrum(made, [0.3, 0.5, 1.0, 2.0], spectrum)
    block = mr.Block.from_size(thicknesses[wall], heights[wall])
    case = mr.Case(block, 0.0, 15.0, motion=motion)
    return mr.Analysis(
        case, "analytical", e=mr.Restitution.from_geometry(block)
    )


grid = mr.Grid(build, wall=range(60), record=range(4))
rows = mr.results(
    grid, mr.campaign(grid, Path(mkdtemp()) / "town.sqlite", workers=1)
)
far = np.array([row["peak_over_overturning"] > 0.4 for row in rows])
share = np.array(
    [far[[row["wall"] == wall for row in rows]].mean() for wall in range(60)]
)
for soil in "ABC":
    print(
        f"soil {soil}: {np.mean(share[[one == soil for one in soils]]):.0%} of "
        "the runs lean beyond 0.4 of overturning"
    )

# %%
# The map.
figure = Figure(figsize=(6.4, 3.6), layout="constrained")
ax = figure.subplots()
marks = ax.scatter(
    x,
    y,
    s=60 * thicknesses * heights / 3,
    c=share,
    cmap="YlOrRd",
    edgecolor="0.3",
    marker="s",
)
ax.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
_ = figure.colorbar(marks, label="share of runs that lean far", shrink=0.8)
