"""The structure as every solver of many bodies takes it: the scene, its equilibrium, and the course of a run."""
