"""Blocks of masonry that is built often."""
