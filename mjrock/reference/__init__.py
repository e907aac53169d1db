"""The contact law in SciPy, the independent check of the engine. This package knows no restitution and no MuJoCo."""
