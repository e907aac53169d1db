"""Links whose law is a class in a file of one's own: closed forms, an own integration, and the accounts."""

import math
from dataclasses import replace

import numpy as np
import own_links as laws
import pytest
from scipy.integrate import solve_ivp

import mjrock as mr

MASS, SPEED, LENGTH = 64.0, 0.8, 0.3
BOTH = pytest.mark.parametrize("in_space", [False, True])


def thrown(own, in_space=False, speed=-SPEED, mirrored=False, duration=0.3, **given):
    """A block of 0.4 m on smooth ground that is thrown along x, with a link to its left, or as seen in a mirror."""
    way = -1.0 if mirrored else 1.0
    if in_space:
        ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True)
        blocks = [ground, mr.Polyhedron.box((0.4, 0.4, 0.4), (0, 0, 0.2), density=1000.0)]
        ends = (-0.2 * way, 0.0, 0.2), ((-0.2 - LENGTH) * way, 0.0, 0.2)
    else:
        ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True)
        blocks = [ground, mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 0.4), (-0.2, 0.4)], density=1000.0, length=0.4)]
        ends = (-0.2 * way, 0.2), ((-0.2 - LENGTH) * way, 0.2)
    masonry = mr.Masonry(blocks, k_n=2e8, friction=0.0, frequency=150.0)
    link = mr.Link(own=own, block=1, at=ends[0], anchor=ends[1], **given)
    velocity = [[speed * way, *[0.0] * (5 if in_space else 2)]]
    return mr.MasonryCase(masonry, duration, velocity=velocity, effects=(link,))


def run(case, **options):
    options = {"output_step": 1e-3, "ledger": True, "forces": True} | options
    answer = mr.solve_explicit(case, **options)
    return answer.pose[:, 0, 0], answer.velocity[:, 0, 0], answer


def unpaid(answer):
    return float(np.abs(answer.ledger.residual).max())


@BOTH
def test_a_stop_behind_a_gap_throws_a_block_back(in_space):
    """It is free for gap / v, pressed for pi / w by v / w, and leaves as fast as it came."""
    k, gap = 2e5, 0.05
    x, v, answer = run(thrown(laws.Gap(k, gap), in_space))
    w = math.sqrt(k / MASS)
    touch, leave = gap / SPEED, gap / SPEED + math.pi / w
    t = answer.t
    pressed = -gap - SPEED / w * np.sin(w * (t - touch))
    exact = np.where(t < touch, -SPEED * t, np.where(t < leave, pressed, -gap + SPEED * (t - leave)))
    np.testing.assert_allclose(x - x[0], exact, rtol=0, atol=5e-4 * gap)
    assert v[-1] == pytest.approx(SPEED, rel=1e-4)
    assert answer.forces.links["link_0"].min() == pytest.approx(-SPEED * math.sqrt(k * MASS), rel=1e-3)
    assert unpaid(answer) < 2e-3 * 0.5 * MASS * SPEED**2


@BOTH
def test_a_relief_damper_is_that_of_an_ode(in_space):
    own = laws.Relief(c=2000.0, relief=150.0)
    x, v, answer = run(thrown(own, in_space))

    def slowed(_, y):
        return [y[1], -own.force(0.0, y[1]) / MASS]

    ode = solve_ivp(slowed, (0, 0.3), [0.0, -SPEED], t_eval=answer.t, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(v, ode.y[1], rtol=0, atol=2e-5 * SPEED)
    np.testing.assert_allclose(x - x[0], ode.y[0], rtol=0, atol=2e-5 * SPEED * 0.3)
    lost = 0.5 * MASS * (SPEED**2 - v[-1] ** 2)
    assert answer.ledger.dashpots["link_0"][-1] == pytest.approx(lost, rel=1e-4)
    assert unpaid(answer) < 1e-4 * lost


@BOTH
def test_a_slider_takes_the_area_of_its_loop(in_space):
    own = laws.Slider(k=1e5, slips_at=400.0)
    x, _, answer = run(thrown(own, in_space, duration=0.4))
    slid = abs(x - x[0]).max() - own.slips_at / own.k
    assert answer.ledger.dashpots["link_0"].max() == pytest.approx(own.slips_at * slid, rel=1e-3)
    assert answer.forces.links["link_0"].min() == pytest.approx(-own.slips_at, rel=1e-6)
    assert unpaid(answer) < 2e-3 * 0.5 * MASS * SPEED**2


def test_a_prestressed_spring_begins_at_rest():
    """It shortens by prestress / k on smooth ground: the search for the pose of rest has the force of its law."""
    case = thrown(laws.Spring(k=5e5, prestress=1000.0), speed=0.0, duration=0.05)
    x, v, answer = run(case)
    assert x[0] == pytest.approx(-1000.0 / 5e5, rel=1e-6)
    assert abs(v).max() < 1e-9
    assert answer.forces.links["link_0"] == pytest.approx(0.0, abs=1e-3)


def test_a_hung_block_bears_less_on_its_joint():
    """The joint and the spring settle together by less of the weight than without it, and nothing moves."""
    k, k_n, hung = 2e4, 2e8 * 0.16, 300.0
    masonry = thrown(laws.Gap(k=1e5, gap=0.0)).masonry
    link = mr.Link(own=laws.Spring(k=k, prestress=hung), block=1, at=(0.0, 0.4), anchor=(0.0, 1.4))
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.1, effects=link), forces=True)
    settles = (MASS * 9.81 - hung) / (k + k_n)
    assert -answer.pose[0, 0, 1] == pytest.approx(settles, rel=1e-6)
    np.testing.assert_allclose(answer.forces.links["link_0"], hung + k * settles, rtol=1e-9)
    assert answer.forces.normal[-1].sum() == pytest.approx(k_n * settles, rel=1e-9)
    assert abs(answer.velocity).max() < 1e-9


@pytest.mark.parametrize("own", [laws.Spring(k=5e4, prestress=0.0), laws.Relief(c=2000.0, relief=50.0)])
def test_a_support_that_moves_does_work_on_it(own):
    """The other end is on a block that is pushed to and fro; what it puts in is in the ledger."""
    case = thrown(own, speed=0.0)
    stand = mr.Polygon([(-0.9, 0.1), (-0.5, 0.1), (-0.5, 0.3), (-0.9, 0.3)], fixed=True, name="stand")
    t = np.linspace(0.0, 0.3, 61)
    moved = {"stand": (t, 0.02 * np.sin(20 * t), 0.0 * t)}
    masonry = mr.Masonry([*case.masonry.blocks, stand], k_n=2e8, friction=0.0, frequency=150.0)
    link = replace(case.effects[0], anchor_block=2)
    answer = mr.solve_explicit(
        mr.MasonryCase(masonry, 0.3, effects=link, supports=moved), output_step=1e-3, ledger=True
    )
    assert np.ptp(answer.pose[:, 0, 0]) > 2e-3
    assert unpaid(answer) < 2e-3 * answer.ledger.largest


def test_as_seen_in_a_mirror():
    one, other = (run(thrown(laws.Slider(k=1e5, slips_at=400.0), mirrored=mirrored)) for mirrored in (False, True))
    np.testing.assert_allclose(other[0], -one[0], rtol=0, atol=1e-12)
    pulls = [each[2].forces.links["link_0"] for each in (one, other)]
    np.testing.assert_allclose(pulls[1], pulls[0], rtol=0, atol=1e-6)


def test_a_run_that_carries_on_remembers_where_the_slider_is():
    case = thrown(laws.Slider(k=1e5, slips_at=400.0), duration=0.02)
    options = {"timestep": 1e-4, "output_step": 1e-3}
    whole = mr.solve_explicit(replace(case, duration=0.04), **options)
    first = mr.solve_explicit(case, **options)
    second = mr.solve_explicit(replace(case, velocity=None), start=first.end, **options)
    np.testing.assert_allclose(second.pose[-1], whole.pose[-1], rtol=0, atol=1e-12)
    with pytest.raises(ValueError, match=r"do not say what link_0 remembers"):
        mr.solve_explicit(replace(case, velocity=None), start=(first.pose[-1], first.velocity[-1]), **options)


def law_of(**methods):
    """A law with these methods beside those of a spring."""
    texts = {name: getattr(laws.Spring, name) for name in ("force", "energy")}
    hints = {"k": float, "prestress": float}
    return mr.link_law(type("Mine", (), {"__annotations__": hints, **texts, **methods}))(k=1e5, prestress=0.0)


WRONG = {
    r"Mine has no energy\(self, u\); a law of a link has force and energy": {"energy": None},
    r"Mine.force\(self, u\) is needed as force\(self, u, rate\)": {"force": lambda self, u: 0.0},
    r"Mine.force is nan at an elongation of": {"force": lambda self, u, rate: math.nan},
    r"Mine.energy is .* J at an elongation of .*, and the integral of force from 0 is": {
        "energy": lambda self, u: self.k * u * u
    },
    r"a dashpot acts against the rate": {"force": lambda self, u, rate: self.k * u - rate},
    r"Mine: .*'b'; the law has k, prestress$": {"force": lambda self, u, rate: self.b * u},
    r"Mine fails at an elongation of .* ZeroDivisionError": {"force": lambda self, u, rate: u / 0},
}


@pytest.mark.parametrize("message", WRONG)
def test_what_is_no_law_of_a_link_is_named(message):
    methods = WRONG[message]
    with pytest.raises((TypeError, ValueError), match=message) as error:
        mr.Link(height=1.0, own=law_of(**methods))
    assert "\n" not in str(error.value)


def test_a_law_that_fails_in_a_run_is_named_with_its_link():
    """Beyond the stroke for which it was checked."""
    own = law_of(force=lambda self, u, rate: self.k * u / (abs(u) < 0.15))
    with pytest.raises(RuntimeError, match=r"the law of link_0 breaks down by t = .* s: its numbers are not finite"):
        run(thrown(own, speed=-20.0))


@pytest.mark.parametrize("given", [{"own": 7}, {"own": None}, {"own": laws.Gap}, {"stroke": 0.0}, {"stroke": math.nan}])
def test_what_a_link_is_given_is_checked(given):
    with pytest.raises((TypeError, ValueError), match=f"{next(iter(given))} of the link"):
        mr.Link(**{"height": 1.0, "own": laws.Gap(k=1e5, gap=0.01)} | given)
    with pytest.raises(TypeError, match="k of Gap"):
        laws.Gap(k="stiff", gap=0.0)


def test_other_solvers_refuse_it_by_name():
    link = mr.Link(height=3.0, own=laws.Relief(c=1e4, relief=1e3))
    wall = mr.Block.from_size(0.6, 4.2)
    case, contacts = (
        mr.Case(wall, 0.1, 0.2, effects=link, side_stop=False),
        mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05),
    )
    message = r"effects\[0\], Link: {} does not know it; take solve_explicit"
    with pytest.raises(ValueError, match=message.format("MuJoCo")):
        mr.simulate(case, contacts)
    with pytest.raises(ValueError, match=message.format("solve_compliant")):
        mr.solve_compliant(case, contacts)
    with pytest.raises(ValueError, match=message.format("rocking theory")):
        mr.solve_analytical(case, mr.Restitution.from_geometry(wall))
    with pytest.raises(ValueError, match=message.format("push-over")):
        mr.pushover(case)
    with pytest.raises(
        TypeError, match=r"effects\[0\] is a Link, whose force depends on the motion; limit analysis takes"
    ):
        mr.collapse_multiplier(thrown(laws.Gap(k=1e5, gap=0.0)).masonry, 1, effects=[mr.Link(0.2, link.own, block=1)])


def test_on_a_wall_a_dashpot_is_a_damper():
    """A relief force that is never reached: the wall moves as one with a damper of the same coefficient."""
    wall = mr.Block.from_size(0.6, 4.2)
    contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.05)
    same = mr.Link(height=3.0, own=laws.Relief(c=2e4, relief=1e9)), mr.Damper(height=3.0, c=2e4)
    one, other = (
        mr.solve_explicit(
            mr.Case(wall, 0.5 * wall.alpha, 0.5, effects=each, side_stop=False), contacts, timestep=2e-4, ledger=True
        )
        for each in same
    )
    np.testing.assert_allclose(one.theta, other.theta, rtol=0, atol=1e-12)
    assert one.ledger.dashpots["link_0"][-1] == pytest.approx(other.ledger.dashpots["damper_0"][-1], rel=1e-9)
