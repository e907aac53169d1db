"""Closed forms of the literature on rocking, sliding, standing and impact, each with its source."""

import math

import numpy as np
import pytest
from everyday import among

import mjrock as mr

G = mr.GRAVITY
GROUND = mr.Polygon([(-9, -1), (9, -1), (9, 0), (-9, 0)], fixed=True, name="ground")


def box(left, right, low, high, **given):
    return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], **given)


@pytest.mark.parametrize("sides", [3, 4, 6, 8, 12, 24])
def test_a_regular_prism_lands_on_its_next_face(sides):
    """Physics Olympiad 1998, problem 1, and McDonald (2006): omega falls to (I + m r^2 cos(2 pi / n)) / (I + m r^2),
    11/17 of a hexagon, and a triangle stops dead."""
    radius = 0.5
    angles = -math.pi / 2 + (2 * np.arange(sides) + 1) * math.pi / sides
    corners = radius * np.column_stack([np.cos(angles), np.sin(angles) + math.cos(math.pi / sides)])
    prism = mr.Polygon(corners, name="prism")
    masonry = mr.Masonry([GROUND, prism])
    high, half = radius * math.cos(math.pi / sides), radius * math.sin(math.pi / sides)
    inertia, reach = float(prism.inertia), prism.mass * radius**2
    found = mr.rigid_impact(masonry, [[high, -half, 1.0]])  # about the corner on the left, on to that on the right
    left = max((inertia + reach * math.cos(2 * math.pi / sides)) / (inertia + reach), 0.0)
    assert found.velocity[0, 2] == pytest.approx(left, abs=1e-9)
    if sides == 6:
        assert left == pytest.approx(11 / 17)


@pytest.mark.parametrize(("columns", "gamma"), [(2, 0.5), (2, 2.0), (3, 1.0), (4, 1.0)])
def test_columns_that_carry_a_beam(columns, gamma):
    """Makris and Vassiliou (Earthquake Engineering and Structural Dynamics 42, 2013), gamma the mass of the beam over
    that of the columns: e = (1 - 3/2 sin^2 a + 3 gamma cos 2a) / (1 + 3 gamma)."""
    b, h, span, deep = 0.25, 2.0, 3.0, 0.5
    alpha, places = math.atan2(b, h), span * np.arange(columns)
    long = span * (columns - 1) + 1
    density = gamma * columns * 2000 * 4 * b * h / (long * deep)
    blocks = [box(-9, 29, -1, 0, fixed=True), *(box(x - b, x + b, 0, 2 * h) for x in places.tolist())]
    blocks.append(box(-0.5, long - 0.5, 2 * h, 2 * h + deep, density=density))
    before = np.array([[-h, -b, -1.0]] * columns + [[-2 * h, -2 * b, 0.0]])
    found = mr.rigid_impact(mr.Masonry(blocks, friction=5.0), before)
    e = (1 - 1.5 * math.sin(alpha) ** 2 + 3 * gamma * math.cos(2 * alpha)) / (1 + 3 * gamma)
    assert found.kept == pytest.approx(e**2, rel=1e-9)


def stands(masonry):
    """Whether limit analysis finds forces that bear the weight."""
    try:
        mr.collapse_multiplier(masonry)
    except ValueError as error:
        if "fall" in str(error) or "stand" in str(error):
            return False
        raise
    return True


@pytest.mark.parametrize("count", [1, 2, 4, 10])
def test_the_tower_of_lire(count):
    """Blocks of unit length reach 1/2 (1 + 1/2 + ... + 1/n) over the edge of a table (Hall, American Journal of Physics
    73, 2005)."""

    def tower(share):
        ends = np.cumsum(share * 0.5 / np.arange(count, 0, -1))
        blocks = [box(-5, 0, -1, 0, fixed=True)]
        return mr.Masonry(blocks + [box(x - 1, x, 0.1 * i, 0.1 * i + 0.1) for i, x in enumerate(ends.tolist())])

    assert stands(tower(0.9995))
    assert not stands(tower(1.0005))


def friction_of(thickness):
    """Friction below which a semicircle of a thickness over its radius slips at its springings while it turns about
    hinges: the largest (2 / pi) h over the place b of the hinge, with the true centroid of each part."""
    b, eta = np.linspace(0.3, 1.5, 100_001), thickness
    rises = b * (1 - eta / 2) * np.sin(b) - (1 + eta**2 / 12) * (1 - np.cos(b))
    return float(2 / math.pi * (rises / ((1 + eta / 2) - (1 - eta / 2) * np.cos(b))).max())


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "least"), [(0.7, 0.1074), (0.36, 0.1414), (0.33, 0.1740), (0.315, 0.1916)])
def test_the_least_thickness_of_a_semicircle_at_falling_friction(friction, least):
    """Cocchetti and Rizzi (Frattura ed Integrita Strutturale 51, 2020, Table 3): 0.1074 of the radius by hinges, more
    below a friction of 0.3958. Their weight lies on the centre line; here it is that of the parts."""
    if friction < 0.39:
        assert friction_of(least) == pytest.approx(friction, rel=1e-3)
    for share in (0.996, 1.004):
        arch = mr.Masonry.arch(1.0, share * least, voussoirs=61, chords=4, friction=friction)
        assert stands(arch) is (share > 1)


@pytest.mark.slow
def test_the_friction_below_which_no_semicircle_stands():
    """0.309215 in the same paper."""
    assert not stands(mr.Masonry.arch(1.0, 0.3, voussoirs=61, chords=4, friction=0.3090))
    assert stands(mr.Masonry.arch(1.0, 0.3, voussoirs=61, chords=4, friction=0.3094))


@pytest.mark.slow
@pytest.mark.parametrize(("degrees", "on_wall"), [(55, 0.3), (65, 0.0), (45, 0.5)])
def test_a_ladder_against_a_wall(degrees, on_wall):
    """Least friction of the floor by the balance of the ladder about the near end of its foot and the high end of its
    head. A thin one would need 1 / (2 tan(angle) + mu of the wall), which is up to 16 % more here."""
    angle, flat = math.radians(degrees), 0.02
    foot, head = 4 * math.cos(angle), 4 * math.sin(angle)
    corners = [(foot - flat / 2, 0), (foot + flat / 2, 0), (0, head + flat / 2), (0, head - flat / 2)]
    ladder = mr.Polygon(corners, name="ladder")
    rests = [box(0, 9, -1, 0, fixed=True, name="floor"), box(-1, 0, -1, 9, fixed=True, name="wall")]
    near, high = foot - flat / 2, head + flat / 2
    push = (near - ladder.centroid[0]) / (high + on_wall * near)
    least = push / (1 - on_wall * push)
    for share in (1.001, 0.999):
        friction = {"floor": share * least, "wall": on_wall}
        masonry = mr.Masonry(
            [*rests, ladder], friction=lambda joint, friction=friction: friction[joint.name.split("|")[0]]
        )
        assert stands(masonry) is (share > 1)


@pytest.mark.parametrize("degrees", [50, 65])
def test_a_house_of_two_cards(degrees):
    """Thin cards that lean on each other stand from a friction of 1 / (2 tan(angle)) on (a problem of statics of
    long standing). These have a level foot and an upright ridge: the least friction is (x - x of the near end of the
    foot) / (height of the ridge), x being that of the centroid, 0.40983 in place of 0.41955 at 50 degrees."""
    angle, long, flat = math.radians(degrees), 2.0, 0.02
    far, near = -long * math.cos(angle) - flat / 2, -long * math.cos(angle) + flat / 2
    ridge, below = -far * math.tan(angle), -near * math.tan(angle)
    left = mr.Polygon([(far, 0), (near, 0), (0, below), (0, ridge)], name="left")
    right = mr.Polygon([(-x, z) for x, z in left.corners], name="right")
    least = float(left.centroid[0] - near) / ridge
    assert least == pytest.approx(0.5 / math.tan(angle), rel=0.05)
    for share in (1.001, 0.999):
        friction = {"ground": share * least, "left": 10.0}
        masonry = mr.Masonry(
            [GROUND, left, right], friction=lambda joint, friction=friction: friction[joint.name.split("|")[0]]
        )
        assert stands(masonry) is (share > 1)


def test_the_least_and_the_largest_thrust_of_an_arch():
    """Heyman (The Stone Skeleton, 1966): the thrust of an arch that stands lies between that of the line that is
    steepest in it, through the extrados above and the intrados below, and that of the flattest one, through the
    intrados above. A foot on smooth ground is pulled outwards and pushed inwards until the arch moves."""
    radius, thickness, count, push = 5.0, 0.75, 20, 45e3
    arch = mr.Masonry.arch(radius, thickness, voussoirs=count, friction=5.0)
    stones = [block for block in arch.blocks if not block.fixed]
    inner, outer = radius - thickness / 2, radius + thickness / 2
    foot = box(inner - 1, outer + 1, -0.5, 0, name="foot")
    rests = [box(-outer, -inner, -0.5, 0, fixed=True, name="left"), box(2, 9, -1, -0.5, fixed=True, name="floor")]
    masonry = mr.Masonry([*rests, foot, *stones], friction=lambda joint: 0.0 if "floor" in joint.name else 5.0)
    right = sorted((stone for stone in stones if stone.centroid[0] > 0), key=lambda stone: -stone.centroid[1])
    mass = np.cumsum([0.0, *(stone.mass for stone in right)])
    middle = np.cumsum([0.0, *(stone.mass * stone.centroid[0] for stone in right)])
    angles = np.pi / count * np.arange(count // 2 + 1)

    def thrusts(upper, lower):
        """Of the lines through a joint at the radius `upper` and one below it at the radius `lower` [N]."""
        arms = {face: mass * face * np.sin(angles) - middle for face in (upper, lower)}
        for i in range(count // 2):
            down = upper * np.cos(angles[i]) - lower * np.cos(angles[i + 1 :])
            turns = arms[lower][i + 1 :] - arms[upper][i]
            yield from G * turns[down > 0] / down[down > 0]

    held = mr.Thrust(0.0, -push, block="foot")
    pulled, pushed = (
        mr.collapse_multiplier(masonry, None, loads={"foot": (way, 0.0)}, effects=held).multiplier for way in (1, -1)
    )
    assert push - pulled == pytest.approx(max(thrusts(outer, inner)), rel=1e-6)
    assert push + pushed == pytest.approx(min(thrusts(inner, outer)), rel=1e-6)


@pytest.mark.parametrize("degrees", among([0, 20, 40, 58, 75, 90, 135], 20))
def test_a_block_that_is_pushed_any_way(degrees):
    """Livesley (Meccanica 27, 1992): it topples over the edge that it reaches first, or slides at mu."""
    angle = math.radians(degrees)
    over = min(half / 0.75 / max(abs(part), 1e-12) for half, part in ((0.25, math.cos(angle)), (0.4, math.sin(angle))))
    tall, flat = mr.Masonry.box((0.5, 0.8, 1.5), friction=5.0), mr.Masonry.box((0.5, 0.8, 0.3), friction=0.37)
    for associated in (True, False):
        found = (mr.collapse_multiplier(one, angle=angle, associated=associated).multiplier for one in (tall, flat))
        assert list(found) == pytest.approx([over, 0.37], rel=1e-6)


@pytest.mark.parametrize("solve", [mr.solve_explicit, mr.simulate])
@pytest.mark.parametrize(("friction", "pulse", "time"), [(0.3, 5.0, 0.3), (0.1, 3.0, 0.2), (0.4, 4.5, 0.5)])
def test_newmarks_sliding_block(solve, friction, pulse, time):
    """Newmark (Geotechnique 15, 1965): a rectangular pulse A of a time T moves it by (A - mu g) A T^2 / (2 mu g). The
    rows of MuJoCo creep while friction holds, by up to 0.5 % of it."""
    masonry = mr.Masonry([GROUND, box(-1, 1, 0, 0.6)], k_n=1e10, friction=friction, points=5)
    motion = mr.GroundMotion.rectangular(-pulse, time)
    answer = solve(mr.MasonryCase(masonry, pulse * time / (friction * G) + 0.3, motion=motion))
    expected = (pulse - friction * G) * pulse * time**2 / (2 * friction * G)
    assert answer.pose[-1, 0, 0] == pytest.approx(expected, rel=1e-3 if solve is mr.solve_explicit else 6e-3)


@pytest.mark.parametrize("friction", [0.97, 1.03])
def test_a_block_that_rocks_slips_below_one_friction(friction):
    """Shenton (Journal of Engineering Mechanics 122, 1996): pushed by a, a block turns without slip from
    mu = (a - h q) / (g + b q) on, with q = 3 (a h - g b) / (4 (b^2 + h^2))."""
    b, h, push = 0.5, 1.0, 1.2 * G
    q = 0.75 * (push * h - G * b) / (b * b + h * h)
    least = (push - h * q) / (G + b * q)
    masonry = mr.Masonry([GROUND, box(-b, b, 0, 2 * h)], k_n=1e11, friction=friction * least)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.15, motion=mr.GroundMotion.rectangular(-push, 1.0)))
    x, _, turn = answer.pose[-1, 0]
    toe = x + b * math.cos(turn) - h * math.sin(turn) - b
    assert turn > 0.04
    assert bool(toe > 1e-3) is (friction < 1)
    assert toe > -1e-4


@pytest.mark.filterwarnings("ignore:ground motion peaks at")
@pytest.mark.parametrize(("b", "h"), [(0.2, 1.0), (0.5, 1.0)])
def test_the_jerk_that_overturns_a_block(b, h):
    """West's formula in Ishiyama (Earthquake Engineering and Structural Dynamics 10, 1982): the ground takes up the
    velocity v at once, v^2 = 8 g R (1 - cos a) / (3 cos^2 a). It takes a millisecond here, which is worth 0.15 %."""
    alpha, reach = math.atan2(b, h), math.hypot(b, h)
    least = math.sqrt(8 * G * reach * (1 - math.cos(alpha)) / 3) / math.cos(alpha)
    wall = mr.Block(b, h)
    e = mr.Restitution.from_geometry(wall)
    for share in (0.999, 1.003):
        motion = mr.GroundMotion(np.full(11, -share * least / 1e-3), 1e-4)
        answer = mr.solve_analytical(mr.Case(wall, 0.0, 8.0, side_stop=False, motion=motion), e)
        assert (answer.outcome is mr.Outcome.OVERTURNED) is (share > 1)


def test_a_wall_on_a_bed_of_springs():
    """Psycharis and Jennings (Earthquake Engineering and Structural Dynamics 11, 1983): a base that has lifted by its
    edge bears W b (1 - 2/3 sqrt(theta_u / theta)), theta_u = W / (2 k b^2 l)."""
    wall, k = mr.Block.from_size(thickness=0.6, height=4.2), 2e8
    weight, b, h = wall.mass * G, wall.b, wall.h
    lifts = weight / (2 * k * b * b * wall.length)
    theta = lifts * np.array([1.5, 2, 4, 8, 20])
    bed = mr.Contacts.from_damping(wall, k_base=k, xi_base=0.05, points=200)
    found = mr.pushover(mr.Case(wall, 0.0, 1.0, side_stop=False), bed, rotations=theta)
    moment = weight * b * (1 - 2 / 3 * np.sqrt(lifts / theta))
    assert found.multiplier == pytest.approx((moment / (weight * h) - np.sin(theta)) / np.cos(theta), rel=4e-3)


def test_a_row_of_three_blocks_that_touch():
    """Herrmann and Schmaelzle (American Journal of Physics 49, 1981): on linear springs that never pull, the first one
    comes back and the last does not take all. Their masses and springs are followed beside it."""
    h, v = 1e-3, np.array([1.0, 0.0, 0.0])
    x = 0.5 * h * v
    for _ in range(20_000):
        pressed = np.maximum(0, -np.diff(x))
        v += h * (np.append(0.0, pressed) - np.append(pressed, 0.0))
        x += h * v
    assert v == pytest.approx([-0.130, 0.149, 0.981], abs=1.5e-3)
    row = [box(0.3 * i, 0.3 * i + 0.3, 0, 0.3) for i in range(3)]
    masonry = mr.Masonry([GROUND, *row], k_n=1e8, friction=0.0, xi=0.0, frequency=1e3)
    velocity = [[1.0, 0, 0], [0, 0, 0], [0, 0, 0]]
    for solve in (mr.solve_explicit, mr.simulate):
        found = solve(mr.MasonryCase(masonry, 0.08, velocity=velocity)).velocity[-1, :, 0]
        assert found == pytest.approx(v, abs=5e-3)


PANELS = {
    11.92: [(x, z, wide, 1) for z in range(4) for x, wide in (((0, 1), (1, 2), (3, 1)) if z % 2 else ((0, 2), (2, 2)))],
    11.72: [
        (0, 0, 2, 1),
        (2, 0, 2, 1),
        (0, 1, 1, 2),
        (3, 1, 1, 2),
        (1, 1, 2, 1),
        (1, 2, 2, 1),
        (0, 3, 2, 1),
        (2, 3, 2, 1),
    ],
}


@pytest.mark.parametrize(("published", "units"), PANELS.items())
def test_panels_under_a_beam_beside_another_programme(published, units):
    """The repository qianqing-wanggg/mosek_optim solves the linear programme of associated friction of 4 m by 4 m under
    a beam of six times the weight, pushed at the beam, with smooth head joints; printed to two places."""
    blocks = [box(x, x + wide, z, z + high, density=1000.0) for x, z, wide, high in units]
    beam = box(0, 4, 4, 5, density=24000.0, name="beam")
    masonry = mr.Masonry([GROUND, *blocks, beam], friction=lambda joint: 0.58 if joint.is_bed else 0.0)
    found = mr.collapse_multiplier(masonry, None, loads={"beam": (4 * 1000 * G, 0.0)})
    assert found.multiplier == pytest.approx(published, abs=0.006)
