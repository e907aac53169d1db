"""Masonry that starts as drawn: springs that are not stretched, no friction, whether or not it stands."""

from functools import partial

import numpy as np
import pytest

import mjrock as mr
from mjrock.quantities import GRAVITY
from mjrock.study.campaign.task import fingerprint

SIDE, K_N, DENSITY = 1.0, 1e7, 2000.0
JOINTS = {"k_n": K_N, "k_s": K_N, "friction": 0.6, "xi": 0.0}


def in_plane(lean=0.0):
    """A block on the ground, to the right of its middle by `lean` [m]."""
    ground = mr.Polygon([(-2, -1), (0.5, -1), (0.5, 0), (-2, 0)], fixed=True)
    corners = np.array([(-0.5, 0), (0.5, 0), (0.5, SIDE), (-0.5, SIDE)]) * SIDE + (lean, 0)
    return mr.Masonry([ground, mr.Polygon(corners, density=DENSITY, length=SIDE)], **JOINTS)


def in_space():
    ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True)
    return mr.Masonry([ground, mr.Polyhedron.box((SIDE,) * 3, (0, 0, 0.5 * SIDE), density=DENSITY)], **JOINTS)


@pytest.mark.parametrize("masonry", [in_plane(), in_space()], ids=["plane", "space"])
@pytest.mark.parametrize("solve", [partial(mr.solve_explicit, timestep=1e-4), mr.simulate], ids=["explicit", "MuJoCo"])
@pytest.mark.filterwarnings("ignore:k_s =")
def test_a_block_drops_onto_springs_that_bear_nothing(solve, masonry):
    frequency = np.sqrt(K_N * SIDE**2 / (DENSITY * SIDE**3))
    run = solve(mr.MasonryCase(masonry, 3.0 / frequency, settled=False))
    drop = GRAVITY / frequency**2 * (1 - np.cos(frequency * run.t))
    up = 2 if masonry.in_space else 1
    assert np.abs(run.pose[:, 0, up] + drop).max() < 0.01 * drop.max()
    assert abs(run.energy[0]) < 1e-9 * DENSITY * SIDE**3 * GRAVITY * drop.max()
    settled = solve(mr.MasonryCase(masonry, 3.0 / frequency))
    assert np.abs(settled.pose[:, 0, up] + GRAVITY / frequency**2).max() < 1e-6 * drop.max()


def test_masonry_that_does_not_stand_is_followed_as_it_falls():
    leaning = in_plane(lean=0.6)
    for solve in (mr.solve_explicit, mr.simulate):
        with pytest.raises(ValueError, match=r"cannot stand: .*; settled=False in the case runs it as drawn"):
            solve(mr.MasonryCase(leaning, 0.1))
    run = mr.solve_explicit(mr.MasonryCase(leaning, 0.2, settled=False))
    assert run.theta[-1, 0] > 0.01


def test_a_block_slides_down_a_slope_as_coulomb_has_it():
    """s = (sin a - mu cos a) g t^2 / 2 on 30 degrees, from springs without load; at rest it is refused."""
    angle, mu = np.radians(30), 0.3
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    slope = mr.Polygon(np.array([(-9, -1), (9, -1), (9, 0), (-9, 0)]) @ turn, fixed=True)
    block = mr.Polygon(np.array([(0, 0), (1.4, 0), (1.4, 0.52), (0, 0.52)]) @ turn)
    masonry = mr.Masonry([slope, block], friction=mu)
    with pytest.raises(ValueError, match=r"block_1 would fall under the weight; .*settled=False in the case runs it"):
        mr.solve_explicit(mr.MasonryCase(masonry, 0.3))
    run = mr.solve_explicit(mr.MasonryCase(masonry, 0.3, settled=False))
    way = 0.5 * GRAVITY * (np.sin(angle) - mu * np.cos(angle)) * 0.3**2
    assert np.hypot(*run.pose[-1, 0, :2]) == pytest.approx(way, rel=1e-4)


def test_only_masonry_as_drawn_has_a_fingerprint_of_its_own():
    masonry = in_plane()
    plain, settled, drawn = (
        mr.MasonryCase(masonry, 1.0, **given) for given in ({}, {"settled": True}, {"settled": False})
    )
    assert plain == settled != drawn
    assert fingerprint(plain) == fingerprint(settled) != fingerprint(drawn)
    with pytest.raises(TypeError, match="settled"):
        mr.MasonryCase(masonry, 1.0, settled=1)
