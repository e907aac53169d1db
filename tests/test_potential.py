"""The pose of rest: first and second derivatives of the energy that is minimised, and which equilibria are none."""

import dataclasses
from functools import partial

import numpy as np
import pytest
from mjrock.engine.rest import curvature, gap_rates, load, openings, potential
from scenes import two_blocks

import mjrock as mr


@pytest.fixture
def held():
    """Two blocks with a tie between them and a force on the upper one, away from its centroid."""
    scene = two_blocks()
    changed = {
        "tie_names": ("tie",), "tie_body": [1], "tie_point": [(0.3, 0.7)], "anchor_body": [0], "anchor": [(-0.3, 0.2)],
        "tie_k": [3e6], "tie_length": [0.5], "tie_strength": [np.inf],
        "force_names": ("pull",), "force_body": [1], "force_point": [(0.1, 0.9)], "force": [(3e4, -1e4)],
    }  # fmt: skip
    fields = {one.name: getattr(scene, one.name) for one in dataclasses.fields(scene)}
    return mr.Scene(**fields | changed)


def test_derivatives_of_the_energy(held):
    """Central differences of the potential give its gradient and its second derivatives, turned bodies and all."""
    parts = held._points, held.ties, held.forces
    energy = partial(potential, *parts, held.masses)
    pose = np.array([0.01, -2e-3, 0.02, 0.04, -6e-3, 0.05])
    assert (openings(*parts[:2], pose) < 0).sum() >= 3  # springs of both kinds are pressed, and one contact is open
    assert (openings(*parts[:2], pose) > 0).any()
    k = np.append(held.k, held.tie_k)
    pressed = np.maximum(-openings(*parts[:2], pose), 0) * k
    rates = gap_rates(*parts[:2], pose)
    ways, h = np.eye(6), 1e-5
    gradient = [(energy(pose + h * way) - energy(pose - h * way)) / (2 * h) for way in ways]
    force = load(held.forces, held.masses, pose) + rates.T @ pressed
    assert -force == pytest.approx(gradient, rel=1e-6, abs=1e-6 * np.abs(force).max())

    def gradient_at(at):
        closed = np.maximum(-openings(*parts[:2], at), 0) * k
        return -load(held.forces, held.masses, at) - gap_rates(*parts[:2], at).T @ closed

    second = np.array([(gradient_at(pose + h * way) - gradient_at(pose - h * way)) / (2 * h) for way in ways])
    found = (rates.T * np.where(pressed > 0, k, 0)) @ rates + curvature(*parts, pose)
    np.testing.assert_allclose(found, second, rtol=1e-6, atol=1e-8 * np.abs(second).max())
    bent = np.abs(curvature(*parts, pose)).max()
    assert bent > 1e4  # what the check of the second derivatives is about is no trifle


def test_an_equilibrium_that_is_not_stable_is_no_rest():
    """Two blocks upright on springs too soft for their height: every force balances, and they fall all the same."""
    assert np.abs(two_blocks(k_n=5e7).at_rest[:, 2]).max() < 1e-9
    with pytest.raises(ValueError, match="do not stand on their contacts"):
        _ = two_blocks(k_n=1e6).at_rest
