"""Limits that the effects on a wall or on masonry share."""

HIGHEST = 200.0
"""Largest height of a wall, and so of an effect [m]."""
BLOCKS = 100_000
"""Largest number of a block."""
