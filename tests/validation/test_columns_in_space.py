"""Columns in space: MuJoCo against explicit steps, which share no kinematics and no friction."""

import numpy as np
import pytest

from scripts.studies.columns_in_space import scenes

RELEASED, SHAKEN, COLUMN = scenes()


def apart(one, other):
    """Largest difference of a displacement of a centroid [m]."""
    count = min(len(one.t), len(other.t))
    return np.abs(one.pose[:count, :, :3] - other.pose[:count, :, :3]).max()


@pytest.mark.slow
@pytest.mark.parametrize("setting", ["MuJoCo 1e-3", "MuJoCo 1e-4", "explicit 100 k_n"])
@pytest.mark.parametrize("scene", [RELEASED, SHAKEN], ids=lambda scene: scene.name)
def test_a_block_on_its_corners(scene, setting):
    exact, answer = scene.run("explicit", 2.0, 1e-5), scene.run(setting, 2.0)
    assert apart(answer, exact) < 1e-3
    assert answer.tilt.max() == pytest.approx(exact.tilt.max(), rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("setting", ["MuJoCo 1e-3", "MuJoCo 1e-4", "explicit 10 k_n"])
def test_a_column_of_drums_in_two_components(setting):
    exact, answer = COLUMN.run("explicit", 2.0, 2e-5), COLUMN.run(setting, 2.0)
    assert apart(answer, exact) < 4e-3
    assert answer.tilt.max() == pytest.approx(exact.tilt.max(), rel=1e-2)


def test_a_soft_joint_along_its_face_moves_otherwise():
    """The twin that must fail: MuJoCo has no stiffness along the face."""
    exact, answer = SHAKEN.run("explicit", 1.0, 1e-4), SHAKEN.run("explicit 0.4 k_n", 1.0)
    assert apart(answer, exact) > 5e-3
