"""The line of thrust through an arch, a wall of many blocks, or a wall that rocks."""

from __future__ import annotations

from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from ..quantities import require_kind
from ..result.response import Response
from ..result.samples import sample_at
from . import masonry, section
from .arguments import anything, picture
from .bodies import Bodies
from .forces import forces_on, require_shown


@picture(limits=anything)
def thrust(
    ax: Axes,
    response: Response,
    at: float | None = None,
    *,
    magnified: float = 1.0,
    limits: ArrayLike | None = None,
) -> Axes:
    """The line of thrust through blocks, or through a wall, at a time, as wide as the force is large.

    It passes through each joint of the drawing where the resultant of its forces does. In a block it goes straight from
    joint to joint, and where more than two press, by way of the mean of their places in proportion to their forces. It
    begins in the centroid of a block that presses on one joint alone. In a line that leaves the blocks joints are open.

    Args:
        ax: where to draw, of three dimensions for blocks in space.
        response: a run with forces=True.
        at: time [s]; None is the end of the run.
        magnified: factor on the displacements, 0.01 to 10000.
        limits: lowest and highest coordinate that the picture shows along each axis [m], as those of `blocks`.

    Raises:
        AttributeError: if the run has kept no forces.
        ValueError: for a time outside the run, or a value outside its range.
    """
    require_kind("response", response, Response)
    if response.joints is not None:
        return masonry.blocks(ax, response, at=at, forces="thrust", magnified=magnified, limits=limits)
    require_shown("forces", "thrust", response)
    sample = sample_at(response.t, at)
    bodies = Bodies.of(response, magnified, limits).at(response.t[sample : sample + 1])
    updates = [section.blocks(ax, bodies), section.surroundings(ax, response.of_wall[0], bodies)]
    updates.append(forces_on(ax, response, bodies.of_case(response.case), "thrust"))
    section.together(updates)(0)
    for artist in ax.get_children():
        artist.set_animated(False)
    if bodies.limits is not None:
        ax.set(xlim=bodies.limits[0], ylim=bodies.limits[1])
    return ax
