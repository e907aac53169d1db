"""Limit analysis of rigid masonry: its stability, and its collapse load."""
