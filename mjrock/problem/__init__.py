"""The problem: the wall, its contacts and their damping laws, ground motions, and the case."""
