"""Slow loading: pushes, push-over curves, limit analysis and the check of a mechanism."""
