"""Facades in space settle where limit analysis says that they stand, and are refused where it says that they fall."""

from dataclasses import replace

import numpy as np
import pytest
from everyday import among, slow
from space_blocks import block

import mjrock as mr
from mjrock.problem.masonry.limit.statics import falling
from mjrock.quantities import named
from mjrock.scene.masonry import masonry_scene

UNIT = (0.4, 0.2)
JOINTS = {"k_n": 1e9, "k_s": 1e9, "friction": 0.6, "xi": 0.0}
WINDOW = (0.0, mr.Opening(width=0.8, height=0.6, sill=0.6))


def random_facade(seed):
    """A facade of random extents, gable, openings and joints; what does not fit is left out."""
    rng = np.random.default_rng(seed)
    units, courses, deep, gable = (int(rng.integers(low, high)) for low, high in ((3, 7), (2, 8), (1, 4), (0, 4)))
    openings = [
        (0.2 * int(rng.integers(-units, units)), mr.Opening(0.4, 0.2 * h, sill=0.2 * sill))
        for h, sill in rng.integers(1, courses + 1, (int(rng.integers(0, 3)), 2))
    ]
    k_n = 10 ** rng.uniform(8, 10.5)
    joints = {"k_n": k_n, "k_s": (None, k_n, 0.4 * k_n)[seed % 3], "friction": rng.choice([0.4, 0.6, 0.8]), "xi": 0.0}
    while True:
        try:
            return mr.Masonry.facade(
                0.4 * units, 0.2 * courses, 0.4 * deep, UNIT, openings=openings, gable=gable, **joints
            )
        except ValueError:
            openings, gable = (openings[:-1], gable) if openings else (openings, gable - 1)


@pytest.mark.parametrize("shape", [{"gable": 2}, slow({"openings": [WINDOW]})])
def test_facades_whose_points_slip_settle(shape):
    size = (2.4, 1.6, 1.2) if "openings" in shape else (1.2, 0.4, 0.4)
    run = mr.solve_explicit(mr.MasonryCase(mr.Masonry.facade(*size, UNIT, **shape, **JOINTS), 0.02))
    assert np.abs(run.velocity).max() < 1e-8


def assert_settles(masonry, ways):
    assert min(mr.collapse_multiplier(masonry, angle=angle).multiplier for angle in ways) > 0.05
    assert np.abs(mr.solve_explicit(mr.MasonryCase(masonry, 0.01)).velocity).max() < 1e-8


@pytest.mark.parametrize("seed", among([2, 3, 8, 11], 2))
def test_random_facades_that_limit_analysis_says_stand_settle(seed):
    assert_settles(random_facade(seed), [0.0])


@pytest.mark.slow
@pytest.mark.parametrize("seed", [12, 14, 15, 18])
def test_many_random_facades_settle(seed):
    assert_settles(random_facade(seed), 0.5 * np.pi * np.arange(4))


@pytest.mark.parametrize("friction", among([0.1, 0.15], 0.15))
def test_a_facade_on_slippery_joints_settles(friction):
    assert_settles(replace(random_facade(2), friction=friction), [0.0])


@pytest.mark.parametrize("first", [1, 6, 9])
def test_a_facade_that_falls_is_refused_by_the_names_of_the_blocks_that_fall(first):
    """Three blocks in a row are left out."""
    facade = mr.Masonry.facade(1.2, 0.4, 0.4, UNIT, gable=2, **JOINTS)
    masonry = replace(facade, blocks=facade.blocks[:first] + facade.blocks[first + 3 :])
    falls = falling(masonry)
    assert falls
    with pytest.raises(ValueError, match=f"cannot stand: {named(falls)} would fall under the weight"):
        masonry_scene(mr.MasonryCase(masonry, 1.0))


def test_a_block_that_only_springs_let_fall_is_named():
    """The centroid of the leaning block lies just within the edge below it, which yields."""
    leaning = mr.Polyhedron.box((0.4, 0.4, 0.4), (0.399, 0, 1.2), name="leaning")
    masonry = mr.Masonry([*block((0.8, 0.4, 1.0)).blocks, leaning], k_n=1e6, friction=0.5)
    assert not falling(masonry)
    with pytest.raises(ValueError, match="rigid blocks would, but on joints of this stiffness leaning would fall"):
        masonry_scene(mr.MasonryCase(masonry, 1.0))
