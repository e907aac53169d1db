"""Damping that is matched to a restitution, and laws that are calibrated with it."""
