"""Friction and damping of blocks without a joint, by function: two blocks that meet slide and rebound as it says."""

import math

import numpy as np
import pytest
from everyday import slow

import mjrock as mr

SLOPE = 0.5
"""Angle of the ramp [rad], tan = 0.546."""


def on_a_ramp(pairs, in_space=False):
    """A block that stands on a ramp with friction 0.9, and another that is let go 1 mm above it."""
    cosine, sine = math.cos(SLOPE), math.sin(SLOPE)
    outlines = {
        "ramp": [(-1.0, -0.3), (4.0, -0.3), (4.0, 0.0), (-1.0, 0.0)],
        "stands": [(-0.9, 0.0), (-0.5, 0.0), (-0.5, 0.2), (-0.9, 0.2)],
        "falls": [(0.0, 1e-3), (0.5, 1e-3), (0.5, 0.2), (0.0, 0.2)],
    }
    blocks = [
        mr.Polygon(
            [(cosine * x + sine * z, cosine * z - sine * x) for x, z in outline], fixed=name == "ramp", name=name
        )
        for name, outline in outlines.items()
    ]
    if in_space:
        blocks = [mr.Polyhedron.prism(block) for block in blocks]
    return mr.Masonry(blocks, friction=0.9, k_n=1e8, xi=1.0, pairs=pairs)


def moved(run):
    """Velocity of both blocks down the ramp [m/s], shape (n, 2)."""
    return run.velocity[..., [0, 2] if run.in_space else [0, 1]] @ [math.cos(SLOPE), -math.sin(SLOPE)]


def plain(case):
    return mr.simulate(case, collisions=True, timestep=1e-4)


def explicit(case):
    return mr.solve_explicit(case, output_step=0.01)


@pytest.mark.parametrize("in_space", [False, slow(True)], ids=["plane", "space"])
@pytest.mark.parametrize("solve", [explicit, slow(plain)])
@pytest.mark.parametrize("friction", [0.5, 0.6])
def test_a_block_that_falls_on_a_ramp_slides_at_tan_phi_of_the_pair(friction, solve, in_space):
    """The block that stands has the friction of its joint. MuJoCo lifts what slides by 2 % of its normal force."""
    requested = []

    def pairs(one, other):
        requested.append((one, other))
        return mr.Dry(friction=friction, xi=1.0) if (one, other) == ("ramp", "falls") else None

    run = solve(mr.MasonryCase(on_a_ramp(pairs, in_space), 0.7, settled=False))
    first, last = np.searchsorted(run.t, [0.4, 0.69])
    grown = (moved(run)[last] - moved(run)[first]) / (run.t[last] - run.t[first])
    slides = max(0.0, mr.GRAVITY * (math.sin(SLOPE) - friction * math.cos(SLOPE)))
    assert grown == pytest.approx([0.0, slides], abs=0.005 if solve is explicit else 0.02)
    assert ("ramp", "falls") in requested
    assert ("ramp", "stands") not in requested
    assert len(requested) == len(set(requested))


def drop(pairs):
    """A block falls flat on a floor with 2 m/s; one that stands far off makes the masonry."""
    floor = mr.Polygon([(-3, -1), (6, -1), (6, 0), (-3, 0)], fixed=True, name="floor")
    stands = mr.Polygon([(-3, 0), (-2, 0), (-2, 0.5), (-3, 0.5)], name="stands")
    falls = mr.Polygon([(0, 0.01), (1, 0.01), (1, 0.51), (0, 0.51)], name="falls")
    masonry = mr.Masonry([floor, stands, falls], k_n=1e9, xi=0.5, pairs=pairs)
    return mr.MasonryCase(masonry, 0.06, velocity=[[0, 0, 0], [0, -2.0, 0]], settled=False)


@pytest.mark.parametrize("xi", [0.0, 0.1, 0.3])
def test_a_block_rebounds_with_the_damping_of_the_pair(xi):
    """A mass on a spring and a dashpot that push only leaves where their force ends. Its weight, left out here, is 1 %
    of the largest force."""
    omega = math.sqrt(1e9 / 1000.0)  # of the block on its whole face
    run = mr.solve_explicit(drop(mr.Dry(xi=xi, frequency=omega)), output_step=1e-4)
    before, after = np.hypot(2.0, math.sqrt(2 * mr.GRAVITY * 0.01)), run.velocity[:, 1, 1].max()
    root = math.sqrt(1 - xi**2)
    until = math.pi - math.atan2(2 * xi * root, 1 - 2 * xi**2)
    assert after / before == pytest.approx(math.exp(-xi / root * until), rel=0.01)


@pytest.mark.slow
def test_without_damping_a_plain_model_gives_the_velocity_back():
    run = mr.simulate(drop(mr.Dry(xi=0.0)), collisions=True, timestep=2e-5, output_step=1e-4)
    assert run.velocity[:, 1, 1].max() == pytest.approx(np.hypot(2.0, math.sqrt(2 * mr.GRAVITY * 0.01)), rel=0.01)


@pytest.mark.parametrize("solve", [mr.solve_explicit, slow(plain)])
def test_a_function_that_gives_nothing_changes_nothing(solve):
    one, other = (solve(mr.MasonryCase(on_a_ramp(pairs), 0.1, settled=False)) for pairs in (None, lambda *_: None))
    assert np.array_equal(one.pose, other.pose)


@pytest.mark.parametrize(
    ("pairs", "error", "message"),
    [
        (0.3, TypeError, "pairs"),
        (mr.Dry(k_n=1e9), ValueError, r"pairs has k_n; friction, xi, frequency are taken"),
        (lambda one: mr.Dry(), TypeError, r"is not called as pairs\(one, other\)"),
        (lambda one, other: 0.3, TypeError, "pairs of ramp and falls"),
        (lambda one, other: mr.Dry(points=3), ValueError, "pairs of ramp and falls has points"),
    ],
)
def test_what_is_not_friction_and_damping_is_refused(pairs, error, message):
    with pytest.raises(error, match=message):
        on_a_ramp(pairs).of_pair(2, 0)
