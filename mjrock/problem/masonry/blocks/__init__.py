"""Blocks of masonry, and where they lie on each other."""
