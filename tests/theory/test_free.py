"""Free rocking in the analytical solver, against SciPy from one event to the next."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mjrock as mr
from mjrock.quantities import ON_ITS_FACE
from tests.everyday import among

TALL = mr.Block(b=0.3, h=3.0)
CASES = {
    "one-sided": {},
    "two-sided": {"side_stop": False},
    "pushed": {"omega0": -0.1, "side_stop": False},
    "loaded": {"effects": (mr.Load(force=2e4, height=6.0, offset=-0.05), mr.Thrust(height=5.5, force=5e2))},
    "laden, two-sided": {"side_stop": False, "effects": (mr.AddedMass(mass=1500.0, height=4.0, offset=-0.1),)},
}


def terminal(event, direction):
    event.terminal, event.direction = True, direction
    return event


def arc(case, state, s):
    """An arc about one toe from (t, theta, omega) until the wall turns, meets the upright position or falls."""
    moment, inertia = case.restoring.towards(s), case.wall.inertia_about(s)
    P, Q = moment.P / inertia, moment.Q / inertia
    i = 1 if s * state[2] > 0 else 0  # it leaves, and turns, or it comes back
    events = (terminal(lambda t, y: s * y[i], -1), terminal(lambda t, y: s * y[0] - ON_ITS_FACE, 1))
    return solve_ivp(
        lambda t, y: (y[1], -s * (P * math.cos(y[0]) - s * Q * math.sin(y[0]))),
        (state[0], case.duration),
        state[1:],
        method="DOP853",
        events=events,
        dense_output=True,
        rtol=1e-13,
        atol=1e-15,
    )


def rocked(case, e, impacts):
    """Times and velocities of the first impacts, the peaks before the last of them, and the arcs."""
    state, s, met, peaks, arcs = (0.0, case.theta0, case.omega0), case.direction, [], [], []
    while len(met) < impacts:
        leaves = s * state[2] > 0
        arcs.append(arc(case, state, s))
        t, (theta, omega) = float(arcs[-1].t[-1]), arcs[-1].y[:, -1]
        assert arcs[-1].t_events[0].size
        if leaves:
            peaks.append(abs(theta))
            state = (t, theta, 0.0)
        else:
            met.append((t, omega))
            leaving = math.copysign(1.0, e * omega)
            s, arriving = leaving, case.wall.inertia_about(s)
            state = (t, 0.0, e * omega * math.sqrt(arriving / case.wall.inertia_about(leaving)))
    return np.array(met), np.array(peaks), arcs


@pytest.mark.parametrize("of", among(list(CASES), "one-sided", "loaded", "laden, two-sided"))
def test_free_rocking_is_that_of_scipy(of):
    case = mr.Case(TALL, 0.5 * TALL.alpha, 8.0, **CASES[of])
    e = mr.Restitution(0.85, -0.7)
    met, peaks, arcs = rocked(case, e.lumped if case.side_stop else e.base, 4)
    answer = mr.solve_analytical(case, e)
    found = np.array([(impact.t, impact.omega_before) for impact in answer.impacts[:4]])
    np.testing.assert_allclose(found, met, rtol=1e-10)
    released = 0 if case.released_outwards else 1  # the release, which is a peak
    np.testing.assert_allclose(answer.peaks[released : released + len(peaks)], peaks, rtol=1e-10)
    for known in arcs:
        within = (answer.t > known.t[0]) & (answer.t < known.t[-1])
        np.testing.assert_allclose(answer.theta[within], known.sol(answer.t[within])[0], atol=2e-10 * TALL.alpha)


@pytest.mark.parametrize("side_stop", [True, False])
def test_the_tolerance_is_kept(side_stop):
    """About rtol alpha in a fall from alpha/2, and not much more after the impacts."""
    case = mr.Case(TALL, 0.5 * TALL.alpha, 4.0, side_stop=side_stop)
    e = mr.Restitution(0.85, -0.7)
    answers = [mr.solve_analytical(case, e, rtol=rtol) for rtol in (1e-14, 1e-10, 1e-6)]
    errors = [np.abs(answer.theta - answers[0].theta).max() / TALL.alpha for answer in answers[1:]]
    assert errors[0] < 3e-10
    assert 1e-8 < errors[1] < 3e-6


def test_a_fall_is_that_of_scipy():
    case = mr.Case(TALL, 1.01 * TALL.alpha, 10.0, side_stop=False)
    answer = mr.solve_analytical(case, mr.Restitution(0.85, -0.7))
    known = arc(case, (0.0, case.theta0, 0.0), 1.0)
    assert known.t_events[1].size == 1
    before = answer.t < known.t[-1]
    np.testing.assert_allclose(answer.theta[before], known.sol(answer.t[before])[0], rtol=1e-8)
    assert answer.t[-1] == pytest.approx(known.t[-1], rel=1e-9)
    assert answer.theta[-1] == ON_ITS_FACE
