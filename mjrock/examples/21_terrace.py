"""
21. A block of a street
=======================

A terrace of houses stands on one street. Each façade is bonded to the party
wall on its left and only abuts its neighbour on the right. One run of explicit
steps follows the whole block under an earthquake across the street. Which
façades fall, and what do ties in some of the houses change?
"""

# %%
# The size of the block. This one is small, so that it runs in half a minute on
# one core. With 12 houses and units of 0.5 x 0.25 m it has 3,564 blocks,
# and all cores share the run (:doc:`/cost`).
import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting

HOUSES, UNIT_SIZE = 3, (0.8, 0.5)  # -, m
HOUSE_WIDTH, HOUSE_HEIGHT, HOUSE_DEPTH = 4.0, 6.0, 3.0  # m, of a house
TIED_HOUSES = (1,)  # houses with ties, from 0
LAST = HOUSES - 1


# %%
# A house is a façade with a door, a window and its party wall. The builder
# makes it about the origin, and each house is moved to its place. The last one
# has a party wall on both sides.
def house(number):
    """The blocks of a house."""
    made = mr.blocks.facade(
        HOUSE_WIDTH,
        HOUSE_HEIGHT,
        HOUSE_DEPTH,
        UNIT_SIZE,
        thickness=0.5,
        returns="both" if number == LAST else "left",
        openings=[
            (0.0, mr.Opening(width=1.2, height=2.0)),
            (0.0, mr.Opening(width=1.2, height=1.5, sill=3.5)),
        ],
        density=1800.0,
    )
    place = (0.0, HOUSE_WIDTH * number, 0.0)
    return [
        mr.Polyhedron(
            np.add(block.corners, place),
            density=block.density,
            name=f"house_{number}_{block.name}",
        )
        for block in made
        if not block.fixed
    ]


ground = mr.Polyhedron.box(
    (12 * HOUSE_HEIGHT, HOUSE_WIDTH * HOUSES + 8 * HOUSE_HEIGHT, 1.0),
    (0.0, 0.5 * HOUSE_WIDTH * LAST, -0.5),
    fixed=True,
    name="ground",
)
blocks = [ground, *(block for i in range(HOUSES) for block in house(i))]
street = mr.Masonry(blocks, k_n=5e8, k_s=2e8, friction=0.6, xi=0.02)
print(f"{len(street.free)} blocks, {len(street.joints)} joints")


# %%
# A tie runs along each party wall beside a tied house, from the top course of
# the façade to that of the end of the wall.
def nearest(place):
    """The block whose centroid is nearest to a place."""
    away = [np.linalg.norm(block.centroid - place) for block in blocks]
    return blocks[int(np.argmin(away))]


ties = []
for number in TIED_HOUSES:
    for side in (-1.0, 1.0):
        y, z = (
            HOUSE_WIDTH * (number + 0.5 * side) - 0.3 * side,
            HOUSE_HEIGHT - 0.25,
        )
        front, back = nearest((-0.25, y, z)), nearest((-HOUSE_DEPTH, y, z))
        start, end = front.centroid, back.centroid
        tie = mr.Tie(
            stiffness=2e7,
            strength=60e3,
            block=front.name,
            at=tuple(start),
            anchor=tuple(end),
            anchor_block=back.name,
        )  # N/m, N
        ties.append(tie)

# %%
# Two cycles of a sine shake across the street, and half as much along it. A
# façade has fallen where five blocks of its house or more have.
shakes = {
    name: mr.GroundMotion.sine(amplitude=peak, period=period, cycles=2)
    for name, peak, period in (("motion", 6.0, 0.8), ("transverse", 3.0, 0.5))
}  # m/s2, s
answers = {
    name: mr.solve_explicit(
        mr.MasonryCase(street, 3.0, effects=effects, **shakes),
        output_step=0.02,
    )
    for name, effects in (("no ties", ()), ("tied in the middle", ties))
}
for name, answer in answers.items():
    fallen = [
        sum(block.startswith(f"house_{i}_") for block in answer.fallen)
        for i in range(HOUSES)
    ]
    words = ["falls" if count >= 5 else "stands" for count in fallen]
    print(f"{name}: house by house it {', '.join(words)}")

# %%
# The street at the end, seen from the front.
figure = Figure(figsize=(7.4, 3.4), layout="constrained")
for ax, (name, answer) in zip(
    figure.subplots(1, 2, subplot_kw={"projection": "3d"}),
    answers.items(),
    strict=True,
):
    plotting.blocks(ax, answer, at=3.0)
    ax.set_title(name)
