"""Models of MuJoCo on compliant contacts, their steps, and the responses that are read from them."""

import mujoco

if int(mujoco.__version__.split(".")[0]) < 4:  # 4.0 is the first with tendons that yield
    raise ImportError(
        f"mjrock needs MuJoCo 4.0 or newer, and {mujoco.__version__} is installed: pip install 'mujoco>=4.0'"
    )
