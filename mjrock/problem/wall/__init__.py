"""A wall as a problem: its block and section, what acts on it, and the case of a run."""
