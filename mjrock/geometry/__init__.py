"""Geometry: vectors, frames of bodies, and the kinematics of contacts and ties, in the plane and in space."""
