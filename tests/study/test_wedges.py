"""Composite overturning: a facade with wedges of its side walls, by hand, by limit analysis and by every solver."""

import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.patches import Polygon

import mjrock as mr

FACADE = mr.Block.from_size(0.8, 9.0, 8.0, 1900.0)
WEDGES = {math.radians(20): "within the base", math.radians(35): "behind it"}
"""Angle of the crack, and where the centroid of facade and wedges lies."""


def wedged(angle, **changed):
    return mr.Case(
        FACADE, **{"theta0": 0.0, "duration": 3.0} | changed, effects=mr.Wedge(angle, 0.5, 9.0).behind(FACADE)
    )


def by_hand(angle):
    """Weights [N], heights and distances from the toe [m] of facade and both wedges."""
    p = 9.0 * math.tan(angle)
    weights = 1900 * mr.GRAVITY * np.array([0.8 * 9.0 * 8.0, 2 * 0.5 * p * 9.0 / 2])
    return weights, np.array([4.5, 6.0]), np.array([0.4, 0.8 + p / 3])


def as_blocks(angle):
    """The same as blocks in the plane: facade and wedges are one body on the ground and on the crack.

    The crack is smooth, as that of a `Wedge`. Blocks have one length, that of the facade: the wedges, of 1 m together,
    are lighter instead.
    """
    p = 9.0 * math.tan(angle)
    front = [(-0.4, 0.0), (0.4, 0.0), (0.4, 9.0), (-0.4, 9.0)]
    crack = [(-0.4, 0.0), (-0.4, 9.0), (-0.4 - p, 9.0)]
    parts = [mr.Polygon(front, density=1900.0, length=8.0), mr.Polygon(crack, density=1900.0 / 8, length=8.0)]
    body = mr.Compound(parts, name="facade")
    ground = mr.Polygon([(-0.4, -2.0), (20.0, -2.0), (20.0, 0.0), (-0.4, 0.0)], length=8.0, fixed=True, name="ground")
    side = mr.Polygon([(-0.4, 0.0), (-0.4 - p, 9.0), (-0.4 - p, 0.0)], length=8.0, fixed=True, name="side")

    def friction(joint):
        return 0.0 if "side" in joint.name else 0.8

    return mr.Masonry([ground, side, body], k_n=1e10, friction=friction, xi=0.1)


@pytest.mark.parametrize("angle", WEDGES)
def test_the_check_by_hand(angle):
    case = wedged(angle)
    weights, heights, levers = by_hand(angle)
    found = mr.mechanism_check(case, lambda T, xi: 0.1, confidence_factor=1.2)
    multiplier = weights @ levers / (weights @ heights)
    assert found.alpha_0 == pytest.approx(multiplier, rel=1e-12)
    assert found.alpha_0 > 1.3 * FACADE.b / FACADE.h
    assert found.participation == pytest.approx((weights @ heights) ** 2 / (weights.sum() * (weights @ heights**2)))
    # it stands over the toe, and the centroid has moved by its lever: C8.7.1.4 with the heights as displacements
    lever = weights @ levers / weights.sum()
    share = (weights @ heights**2) * weights.sum() / (weights @ heights) ** 2
    assert found.d_0 == pytest.approx(lever * share, rel=1e-3)


@pytest.mark.parametrize(("angle", "where"), WEDGES.items())
def test_two_masses_are_the_wedges(angle, where):
    """Mass, centroid and moment of inertia of facade and right triangles, m (p^2 + q^2) / 18 about their centroid."""
    wall = wedged(angle).wall
    weights, heights, levers = by_hand(angle)
    p = 9.0 * math.tan(angle)
    assert wall.weight == pytest.approx(weights.sum())
    assert wall.lever == pytest.approx(weights @ levers / weights.sum())
    assert (wall.lever > 0.8) == (where == "behind it")
    own = np.array([(0.8**2 + 9.0**2) / 12, (p**2 + 9.0**2) / 18])
    assert wall.toe_inertia == pytest.approx(float(weights @ (own + heights**2 + levers**2)) / mr.GRAVITY)
    body = as_blocks(angle).blocks[2]
    assert wall.mass == pytest.approx(body.mass)
    assert wall.inertia == pytest.approx(body.inertia)


@pytest.mark.parametrize("angle", WEDGES)
def test_limit_analysis_of_blocks(angle):
    weights, heights, levers = by_hand(angle)
    found = mr.collapse_multiplier(as_blocks(angle))
    assert found.multiplier == pytest.approx(weights @ levers / (weights @ heights), rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("angle", WEDGES)
def test_the_first_fall_is_the_same_by_every_solver(angle):
    """Released at 0.5 alpha, up to 0.2 alpha, where nothing has met the base or the crack.

    Interfaces of 1e10 N/m3 move it by 2e-5 alpha.
    """
    alpha = wedged(angle).wall.alpha
    case = wedged(angle, theta0=0.5 * alpha, duration=1.6)
    rigid = mr.solve_analytical(case, mr.Restitution(0.9, -0.8))
    contacts = mr.Contacts.from_damping(case.wall, k_base=1e10, k_side=1e10, xi_base=0.1, xi_side=0.1)
    end = int(np.argmax(rigid.theta < 0.2 * alpha))
    for solve in (mr.simulate, mr.solve_explicit, mr.solve_compliant):
        found = solve(case, contacts)
        theta = np.interp(rigid.t[:end], found.t, found.theta)
        assert np.abs(theta - rigid.theta[:end]).max() < 1e-4 * alpha


@pytest.mark.parametrize("solve", [mr.simulate, pytest.param(mr.solve_explicit, marks=pytest.mark.slow)])
def test_it_stands_a_slow_push_below_the_multiplier_and_falls_above(solve):
    """The push grows over 2 s and stays, at 0.95 and 1.05 times the multiplier of rigid bodies."""
    angle = math.radians(35)
    weights, heights, levers = by_hand(angle)
    grown = -mr.GRAVITY * weights @ levers / (weights @ heights) * np.minimum(np.linspace(0.0, 4.0, 801), 1.0)
    below, above = (
        solve(mr.MasonryCase(as_blocks(angle), 8.0, motion=mr.GroundMotion(share * grown, 0.01)))
        for share in (0.95, 1.05)
    )
    assert np.abs(below.theta).max() < 0.01
    assert above.theta.max() > 1.0


def test_a_centroid_behind_the_inner_edge_needs_a_side_stop():
    with pytest.raises(ValueError, match=r"overturn the wall inwards as it stands: .* give a side stop"):
        wedged(math.radians(35), side_stop=False)
    wall = wedged(math.radians(35)).wall
    with pytest.raises(ValueError, match=r"behind its inner edge: .* give Restitution\(base, side\)"):
        mr.Restitution.from_geometry(wall)
    assert mr.Case(FACADE, 0.0, 1.0, side_stop=False).wall == FACADE


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.Wedge(25.0, 0.5, 9.0), "angle of the wedge = 25 rad is outside the valid range 1e-06 to 1.2 rad"),
        (lambda: mr.Wedge(0.4, 0.5, 9.5).behind(FACADE), "height of the wedge = 9.5 m is outside the valid range"),
        (lambda: mr.Wedge(0.4, 0.5, 9.0, number=0), "number = 0"),
        (lambda: mr.Wedge(0.4, 0.5, 9.0).behind(3), "facade = 3 of type int is not a Block"),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises((TypeError, ValueError), match=complaint):
        call()


def test_a_gable_alone_overturns_as_a_triangle():
    gable = mr.Block.from_size(0.4, 3.0, 6.0, gable=mr.Gable(3.0))
    found = mr.mechanism_check(mr.Case(gable, 0.0, 1.0), lambda T, xi: 0.1)
    assert found.alpha_0 == pytest.approx(1.5 * 0.4 / 3.0)


def test_sketch_film_and_report_show_the_wedges_once_and_not_the_masses_that_stand_for_them(tmp_path):
    """The drawing reaches as far back as the wedges do."""
    wedge = mr.Wedge(math.radians(35), 0.5, 7.0)
    case = mr.Case(FACADE, 0.0, 3.0, effects=(*wedge.behind(FACADE), mr.AddedMass(1500.0, 9.0)))
    section = mr.plotting.sketch(case).axes[0]
    texts = [text.get_text() for text in section.texts]
    assert sorted(text.partition(":")[0] for text in texts if ": " in text) == ["mass", "wedges"]
    assert any("2 of 0.5 m, 7 m high,\ncrack at 35°" in text for text in texts)
    back = -0.4 - 7.0 * math.tan(math.radians(35))
    drawn = [patch.get_xy() for patch in section.patches if isinstance(patch, Polygon)]
    assert [True for corners in drawn if corners.min(axis=0) == pytest.approx([back, 0.0])] == [True]
    assert section.get_xlim()[0] < back
    answer = mr.solve_analytical(replace(case, theta0=0.01), mr.Restitution(0.95, -0.5))
    for language, message in (("en", "wedges of side walls"), ("it", "cunei delle pareti laterali")):
        text = mr.report(case, answer, tmp_path / "a.html", language=language).read_text(encoding="utf-8")
        assert text.count(message) == 1
        assert "wedge" not in text.replace("wedges of side walls", "")


def test_a_load_may_rest_on_the_wedges():
    """By moments about the toe; beyond the wedge nothing carries it."""
    facade = mr.Block.from_size(thickness=0.8, height=9.0, length=8.0)
    wedge = mr.Wedge(0.4, 0.5, 9.0)
    masses = wedge.behind(facade)
    alone = mr.pushover(mr.Case(facade, effects=masses))
    at = -0.4 - 0.7 * wedge.depth
    loaded = mr.pushover(mr.Case(facade, effects=(*masses, mr.Load(50e3, 9.0, at))))
    moment = alone.case.wall.weight * alone.case.wall.centroid_height
    assert loaded.start == pytest.approx(alone.start + 50e3 * (0.4 - at) / moment, rel=1e-12)
    with pytest.raises(ValueError, match=r"offset of the Load = -4\.3 m is outside the valid range -4.20"):
        mr.Case(facade, effects=(*masses, mr.Load(50e3, 9.0, -4.3)))
