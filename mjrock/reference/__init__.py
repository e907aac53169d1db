"""The contact law in SciPy, the independent check of the engine. This package uses neither restitution nor MuJoCo."""
