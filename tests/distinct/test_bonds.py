"""The law of a bond on one joint that is led along paths, in the plane and in space, straight and turned."""

from dataclasses import replace

import numpy as np
import pytest
from bonded import AREA, K_N, K_S, MORTAR, Led, joint
from everyday import among, crossed, slow
from scipy.integrate import solve_ivp

import mjrock as mr
from mjrock.distinct.setup import setup_of

CRUSHED = mr.Bond(0.25e6, 0.35e6, 18.0, 125.0, 10.5e6, 5e3)
HARDENING = replace(CRUSHED, hardening=9e-5)
PLACES = [{}, {"angle": 0.6}, {"space": True}, {"points": 5}]
PEAK = MORTAR.tension / K_N


def led(bond=MORTAR, angle=0.0, **more):
    return Led(joint(bond, angle=angle, **more), angle=angle)


def path_of(one, slips, openings):
    """A path with the slip along the first way, or in space along both."""
    slips, openings = np.broadcast_arrays(slips, openings)
    ways = [slips] if len(one.at) == 2 else [0.6 * slips, 0.8 * slips]
    return np.column_stack([*ways, openings])


def along(drag):
    """Stress along the slip [Pa]."""
    return drag[:, 0] if drag.shape[1] == 1 else drag @ [0.6, 0.8]


def softening(far, count=500):
    """Ways from zero, finer at first."""
    return far * np.linspace(0, 1, count)[1:] ** 2


@pytest.mark.parametrize("place", PLACES)
def test_a_joint_that_is_pulled_apart_holds_its_strength_and_takes_its_fracture_energy(place):
    one = led(**place)
    opening = np.append(np.linspace(0, PEAK, 21)[1:], PEAK + softening(7e-4))
    push, drag = one.along(path_of(one, 0.0, opening))
    assert -push.min() == pytest.approx(MORTAR.tension, rel=1e-6)
    assert np.trapezoid(-push, opening) == pytest.approx(MORTAR.opening_energy, rel=1e-3)
    assert one.taken == pytest.approx((MORTAR.opening_energy, 0.0, 0.0, 0.0), rel=1e-3, abs=1e-9)
    assert push[-1] == pytest.approx(0.0, abs=2e-4 * MORTAR.tension)
    assert np.abs(drag).max() < 1e-9 * MORTAR.tension
    assert one.system.lines["k"].sum() == pytest.approx(K_N * AREA)
    assert not one.system.laws[0].rows["k"].any()


def test_a_brittle_joint_breaks_at_once_and_takes_what_its_spring_held():
    brittle = mr.Bond(0.25e6, 0.35e6, 0.1, 125.0)
    one = led(brittle)
    opening = np.linspace(0, 2 * PEAK, 2001)[1:]
    push, _ = one.along(path_of(one, 0.0, opening))
    assert -push.min() == pytest.approx(brittle.tension, rel=2e-3)
    assert (push[1001:] == 0).all()
    assert one.taken[0] == pytest.approx(0.5 * brittle.tension * PEAK, rel=2e-3)


@pytest.mark.parametrize(("pressure", "place"), crossed([0.0, 0.3e6, 1.2e6], PLACES))
def test_a_joint_that_is_sheared_holds_cohesion_and_friction_and_takes_its_fracture_energy(place, pressure):
    one, slip = led(**place), np.append(softening(5e-3, 3000), 5e-3)
    one.along(path_of(one, 0.0, np.linspace(0, -pressure / K_N, 5)))
    push, drag = one.along(path_of(one, slip, -pressure / K_N))
    held, rubbed = -along(drag), 0.75 * pressure
    assert push == pytest.approx(pressure, abs=1e-6 * MORTAR.tension)
    assert held.max() == pytest.approx(MORTAR.cohesion + rubbed, rel=2e-3)
    assert held[-1] == pytest.approx(rubbed, abs=2e-4 * MORTAR.cohesion)
    plastic = np.trapezoid(held, slip) - rubbed * (slip[-1] - 0.5 * rubbed / K_S)
    assert plastic == pytest.approx(MORTAR.slip_energy, rel=3e-3)
    tension, slid, crushed, _ = one.taken
    assert (tension, slid, crushed) == pytest.approx((0.0, MORTAR.slip_energy, 0.0), rel=1e-3, abs=1e-9)


@pytest.mark.parametrize(("pressure", "place"), crossed([0.3e6, 1.2e6], PLACES))
def test_friction_falls_to_a_residual_with_the_bond(place, pressure):
    """c e + (mu_r + (mu - mu_r) e) sigma with e = exp(-(c / G_II) s), from mu = 0.75 to mu_r = 0.5."""
    bond = replace(MORTAR, residual_friction=0.5)
    one, slip = led(bond, **place), np.append(softening(5e-3, 2000), 5e-3)
    one.along(path_of(one, 0.0, np.linspace(0, -pressure / K_N, 5)))
    _, drag = one.along(path_of(one, slip, -pressure / K_N))
    held = -along(drag)
    assert held.max() == pytest.approx(MORTAR.cohesion + 0.75 * pressure, rel=2e-3)
    assert held[-1] == pytest.approx(0.5 * pressure, rel=2e-3)
    left = np.exp(-MORTAR.cohesion / MORTAR.slip_energy * (slip - held / K_S))
    law = MORTAR.cohesion * left + (0.5 + 0.25 * left) * pressure
    slides = np.arange(len(slip)) > held.argmax()
    np.testing.assert_allclose(held[slides], law[slides], rtol=5e-3)
    assert (one.system.lines["friction"] == 0.5).all()


def test_blocks_that_meet_anew_have_the_residual_friction():
    masonry = joint(replace(MORTAR, residual_friction=0.5))
    assert setup_of(mr.MasonryCase(masonry, 1.0, settled=False), None, None).search.law.of_pair[1] == [0.5]


def test_a_residual_friction_above_that_of_the_joint_is_refused():
    with pytest.raises(ValueError, match=r"residual_friction of a\|b = 0.8 is outside the valid range 0 to 0.75"):
        joint(replace(MORTAR, residual_friction=0.8))


@pytest.mark.parametrize("place", PLACES)
def test_a_cracked_joint_unloads_along_the_secant_and_closes_with_its_whole_stiffness(place):
    one, far = led(**place), 5e-5
    push, _ = one.along(path_of(one, 0.0, softening(far)))
    back = np.linspace(far, -far, 41)
    unloaded, _ = one.along(path_of(one, 0.0, back))
    again, _ = one.along(path_of(one, 0.0, back[::-1]))
    assert unloaded[:21] == pytest.approx(push[-1] * back[:21] / far, abs=1e-6 * MORTAR.tension)
    assert unloaded[20:] == pytest.approx(-K_N * back[20:], abs=1e-6 * MORTAR.tension)
    assert again[::-1] == pytest.approx(unloaded, abs=1e-6 * MORTAR.tension)


def combined(slip, opening, start):
    """Opening of the crack and way of the slider by the law, integrated along the straight path [m].

    k (u - w) = f_t e and k_s (q - s) = c e + mu sigma with e = exp(-b w - r s), from where both hold.
    """
    b, r = MORTAR.tension / MORTAR.opening_energy, MORTAR.cohesion / MORTAR.slip_energy

    def rates(x, state):
        w, s = state
        left = np.exp(-b * w - r * s)
        matrix = [
            [K_N - b * MORTAR.tension * left, -r * MORTAR.tension * left],
            [-b * MORTAR.cohesion * left, K_S - r * MORTAR.cohesion * left],
        ]
        return np.linalg.solve(matrix, [K_N * opening, K_S * slip])

    share = np.linspace(start, 1.0, 400)
    answer = solve_ivp(rates, (start, 1.0), [0.0, 0.0], t_eval=share, rtol=1e-10, atol=1e-16)
    left = np.exp(-b * answer.y[0] - r * answer.y[1])
    return share, MORTAR.tension * left, MORTAR.cohesion * left


@pytest.mark.parametrize("place", among(PLACES, PLACES[1], PLACES[2]))
def test_opening_and_slip_together_follow_the_integrated_law_to_first_order_of_the_step(place):
    opening = 2e-4  # both strengths are reached at once
    slip = opening * (MORTAR.cohesion / K_S) / PEAK
    start = PEAK / opening
    share, pull, held = combined(slip, opening, start)
    errors = []
    for count in (1000, 2000):
        one, steps = led(**place), np.linspace(0, 1, count + 1)[1:]
        push, drag = one.along(path_of(one, slip * steps, opening * steps))
        wrong = np.abs(-push - np.interp(steps, share, pull))[steps > 1.1 * start] / MORTAR.tension
        also = np.abs(-along(drag) - np.interp(steps, share, held))[steps > 1.1 * start] / MORTAR.cohesion
        errors.append((wrong.max(), also.max()))
    assert np.max(errors[1]) < 3e-3
    assert np.divide(*errors) == pytest.approx(2.0, abs=0.3)


@pytest.mark.parametrize("place", among(PLACES, PLACES[1], PLACES[2]))
def test_a_crushed_joint_softens_and_is_unloaded_with_a_gap(place):
    one, first = led(CRUSHED, **place), CRUSHED.crushing / K_N
    closing = np.append(np.linspace(0, first, 21)[1:], first + softening(1e-3, 2000))
    push, _ = one.along(path_of(one, 0.0, -closing))
    assert push.max() == pytest.approx(CRUSHED.crushing, rel=1e-3)
    gap = closing - push / K_N  # plastic closing by the law
    expected = CRUSHED.crushing * np.exp(-CRUSHED.crushing / CRUSHED.crushing_energy * gap)
    assert push[20:] == pytest.approx(expected[20:], rel=3e-3)
    back = np.linspace(closing[-1], gap[-1], 11)
    unloaded, _ = one.along(path_of(one, 0.0, -back))
    assert unloaded == pytest.approx(K_N * (back - gap[-1]), abs=1e-5 * CRUSHED.crushing)
    again, _ = one.along(path_of(one, 0.0, -back[::-1]))
    assert again == pytest.approx(unloaded[::-1], abs=1e-5 * CRUSHED.crushing)
    whole = np.append(closing, back[1:])
    taken = np.trapezoid(np.append(push, unloaded[1:]), whole)
    assert one.taken[2] == pytest.approx(taken, rel=1e-3)
    assert one.taken[2] == pytest.approx(5e3 * (1 - np.exp(-2.1e3 * gap[-1])), rel=3e-3)


@pytest.mark.parametrize("place", among(PLACES, PLACES[1], PLACES[2]))
def test_a_joint_that_hardens_reaches_its_strength_and_takes_its_energy(place):
    """The parabola of Lourenco and Rots up to a plastic closing of 0.09 mm, and softening so that the area is G_c."""
    one = led(HARDENING, **place)
    peak = HARDENING.crushing / K_N + HARDENING.hardening
    closing = np.append(np.linspace(0, peak, 401)[1:], peak + softening(5e-3, 3000))
    push, _ = one.along(path_of(one, 0.0, -closing))
    assert push.max() == pytest.approx(HARDENING.crushing, rel=1e-6)
    plastic = closing - push / K_N
    share = np.clip(plastic / HARDENING.hardening, 0.0, 1.0)
    expected = HARDENING.crushing / 3 * (1 + 2 * np.sqrt(share * (2 - share)))
    rising = (plastic > 1e-12) & (share < 1)
    assert rising.sum() > 100
    assert push[rising] == pytest.approx(expected[rising], rel=1e-6)
    assert push[plastic < 1e-12] == pytest.approx(K_N * closing[plastic < 1e-12])
    taken = np.trapezoid(np.append(0.0, push), np.append(0.0, plastic))
    assert taken == pytest.approx(HARDENING.crushing_energy, rel=1e-3)
    assert one.taken[2] == pytest.approx(HARDENING.crushing_energy, rel=1e-3)
    unloaded, _ = one.along(path_of(one, 0.0, -np.linspace(closing[-1], plastic[-1], 5)))
    assert unloaded[-1] == pytest.approx(0.0, abs=1e-5 * HARDENING.crushing)


def test_a_joint_that_hardens_keeps_its_bond_up_to_the_peak_and_is_unloaded_on_the_way_with_its_whole_stiffness():
    one = led(HARDENING)
    closing = np.linspace(0, 2e-4, 201)[1:]
    push, _ = one.along(path_of(one, 0.0, -closing))
    gap = closing[-1] - push[-1] / K_N
    assert 0 < gap < HARDENING.hardening
    assert (one.system.laws[0].rows["integrity"] == 1).all()
    way = np.linspace(closing[-1], gap, 11)
    unloaded, _ = one.along(path_of(one, 0.0, -way))
    assert unloaded == pytest.approx(K_N * (way - gap), abs=1e-6 * HARDENING.crushing)
    again, _ = one.along(path_of(one, 0.0, -way[::-1]))
    assert again == pytest.approx(unloaded[::-1], abs=1e-6 * HARDENING.crushing)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"hardening": 0.0}, "1e-09"),
        ({"hardening": 1e-3}, r"hardening = 0.001 m would take 8997.79 J/m2.*1e-9 to 0.00055"),
        ({"hardening": 1e-5, "crushing": None, "crushing_energy": None}, "needs crushing"),
    ],
)
def test_a_hardening_that_the_energy_does_not_hold_is_refused(more, message):
    with pytest.raises(ValueError, match=message):
        replace(HARDENING, **more)


def test_masonry_that_presses_beyond_what_hardening_bears_elastically_is_refused():
    heavy = mr.Bond(0.25e6, 0.35e6, 18.0, 125.0, 1e3, 1e3)
    assert heavy.elastic_limit == 1e3
    with pytest.raises(ValueError, match=r"2\.9.* times their strength"):
        mr.solve_explicit(mr.MasonryCase(joint(replace(heavy, crushing=2e3, hardening=1e-4)), 1e-3))
    mr.solve_explicit(mr.MasonryCase(joint(replace(heavy, crushing=2e3)), 1e-3))


def test_shear_lowers_what_a_joint_bears():
    one = led(mr.Bond(2e6, 2.5e6, 500.0, 5e3, 10.5e6, 5e3))
    slip = 2e6 / K_S
    one.along(path_of(one, np.linspace(0, slip, 50), 0.0))
    push, drag = one.along(path_of(one, slip, -np.linspace(0, 3e-4, 2000)))
    sheared = -along(drag)[np.argmax(push)]
    assert sheared == pytest.approx(2e6, rel=1e-6)
    assert push.max() == pytest.approx(np.sqrt(10.5e6**2 - 9 * 2e6**2), rel=2e-3)


def wandering(seed, count, *, in_space):
    """A random path that passes zero opening at a pose of its own."""
    random = np.random.default_rng(seed)
    ways = 2 if in_space else 1
    steps = random.normal(size=(count, ways + 1)) * np.array([4e-7] * ways + [3e-7])
    turns = np.repeat(random.choice([-1.0, 1.0], size=(count // 100 + 1, ways + 1)), 100, axis=0)[:count]
    path = np.cumsum(np.abs(steps) * turns, axis=0)
    crosses = np.flatnonzero(path[1:, -1] * path[:-1, -1] < 0)
    share = (path[crosses, -1] / (path[crosses, -1] - path[crosses + 1, -1]))[:, None]
    there = path[crosses] + share * (path[crosses + 1] - path[crosses])
    there[:, -1] = 0.0
    return np.insert(path, crosses + 1, there, axis=0)


@pytest.mark.parametrize(
    ("place", "count", "seed"),
    [
        ({}, 3000, 0),
        *(slow(({}, 3000, seed)) for seed in (1, 2)),
        *(slow((place, 10_000, seed)) for place in ({}, {"space": True}) for seed in range(3)),
    ],
)
def test_random_paths_put_no_energy_in_and_damage_never_heals(place, count, seed):
    one = led(CRUSHED, **place)
    path = wandering(seed, count, in_space="space" in place)
    work, elastic, left = [], [], []
    last, before = np.zeros(len(one.at)), np.zeros(len(one.at))
    for place_ in path:
        push, drag = one.along(place_[None])
        force = np.append(-drag[0], -push[0])
        work.append(0.5 * (force + last) @ (place_ - before))
        elastic.append(one.elastic / AREA)
        left.append(one.system.laws[0].rows["integrity"].copy())
        last, before = force, place_
    absorbed, scale = np.cumsum(work), np.abs(work).sum()
    taken = absorbed - elastic
    assert (taken - np.maximum.accumulate(taken)).min() > -1e-4 * scale
    assert (np.diff(left, axis=0) <= 0).all()
    assert left[-1].min() < 0.9
    assert taken[-1] == pytest.approx(sum(one.taken), abs=2e-3 * scale)
