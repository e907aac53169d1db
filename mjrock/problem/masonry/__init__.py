"""Masonry as a problem: blocks, joints, contact lines, builders, and the case of a run."""
