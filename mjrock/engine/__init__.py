"""The contact law in MuJoCo. This package knows no restitution but that of the law itself."""

import re

import mujoco

OLDEST = (4, 0)
"""The oldest MuJoCo whose step the engine follows, as pyproject.toml asks for."""

_found = tuple(map(int, re.findall(r"\d+", mujoco.__version__)[:2]))
if _found < OLDEST:
    raise ImportError(
        f"mjrock needs MuJoCo {'.'.join(map(str, OLDEST))} or newer, and {mujoco.__version__} is installed: "
        f"pip install 'mujoco>={'.'.join(map(str, OLDEST))}'"
    )
