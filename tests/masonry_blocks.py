"""Masonry that several tests use."""

import math

import numpy as np

import mjrock as mr


def box(left, right, low, high, **options):
    return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], **options)


GROUND = box(-5, 5, -1, 0, fixed=True, name="ground")


def columns(blocks, k_n=5e8, **options):
    """A column of 0.6 x 4.2 m in equal blocks."""
    if blocks <= 7:
        return mr.Masonry.stack([mr.Block(0.3, 2.1 / blocks)] * blocks, k_n, **options)
    flat = [box(-0.3, 0.3, 4.2 * i / blocks, 4.2 * (i + 1) / blocks) for i in range(blocks)]
    return mr.Masonry([GROUND, *flat], k_n=k_n, **options)


def tilted(masonry, angle):
    """Masonry turned to the right by an angle [rad] with its ground."""
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    blocks = [
        mr.Polygon(block.corners @ turn.T, density=block.density, length=block.length, fixed=block.fixed, name=name)
        for block, name in zip(masonry.blocks, masonry.names, strict=True)
    ]
    return mr.Masonry(blocks, k_n=masonry.k_n, friction=masonry.friction, xi=0.0, points=masonry.points)


def bracket(holds, low, high, count=12):
    """Where `holds` ceases between two numbers, within (high - low) / 2^count."""
    assert holds(low)
    assert not holds(high)
    for _ in range(count):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return 0.5 * (low + high)
