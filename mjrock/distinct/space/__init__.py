"""Explicit steps in space: rows, kinematics and loop for bodies with six velocities."""
