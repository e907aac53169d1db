"""What is asked: the wall, its contacts and their damping laws, ground motions, and the case."""
