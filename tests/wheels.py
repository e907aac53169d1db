"""Rimless wheels on a slope, and the rate at which they roll.

A rimless wheel of n sides and radius R pivots about one corner after the other. Each impact leaves eta of its rate, and
between two of them it gains what it falls by, so that in the long run its rate before an impact is omega with
(1 - eta^2) omega^2 I_0 / 2 = m g 2 R sin(pi/n) sin(slope), I_0 about a corner (McGeer, Int. J. Robotics Research 9,
1990). It does not depend on the springs, which bend by a ten-thousandth of R.
"""

import math

import numpy as np
from masonry_blocks import box

import mjrock as mr

RADIUS = 0.3


def slope_of(sides):
    """On which a wheel passes each corner, and does not leave the ground [rad]."""
    return math.radians(15.0 if sides == 5 else 72.0 / sides)


def wheel_on(slope, sides, behind, others=()):
    """A wheel that stands on a side at x = 0, on ground from -behind to 20 m, turned to a slope; with other blocks."""
    half = math.pi / sides
    around = 2 * half * np.arange(sides)
    ring = RADIUS * np.column_stack([np.sin(around - half), math.cos(half) - np.cos(around - half)])
    turn = np.array([[math.cos(slope), math.sin(slope)], [-math.sin(slope), math.cos(slope)]])
    corners = [box(-behind, 20.0, -1.0, 0.0).corners, ring, *(box(*other).corners for other in others)]
    ground, *free = (each @ turn.T for each in corners)
    return [mr.Polygon(ground, fixed=True, name="ground"), *(mr.Polygon(each) for each in free)], turn


def rolling(sides, behind, others=(), *, falls=5.0, k_n=3e9):
    """The case of a wheel at its closed-form rate, for some times of a fall from corner to corner, and this rate."""
    slope, half = slope_of(sides), math.pi / sides
    blocks, turn = wheel_on(slope, sides, behind, others)
    about = blocks[1].inertia + blocks[1].mass * RADIUS**2
    eta = (blocks[1].inertia + blocks[1].mass * RADIUS**2 * math.cos(2 * half)) / about
    falling = 2 * blocks[1].mass * mr.GRAVITY * 2 * RADIUS * math.sin(half) * math.sin(slope)
    rate = math.sqrt(falling / about / (1 - eta**2))
    arm = turn @ (math.cos(half), math.sin(half))
    velocity = [[*(eta * rate * RADIUS * arm), eta * rate], *np.zeros((len(others), 3))]
    masonry = mr.Masonry(blocks, k_n=k_n, friction=2.0, xi=1.0, frequency=400.0)
    return mr.MasonryCase(masonry, falls * 2 * math.sin(half) / rate, velocity=velocity, settled=False), rate
