"""Damping: restitution, the laws that turn it into damping ratios, interfaces and their stiffness."""
