"""The reference wall in other codes: what is installed runs, what is not is skipped, what hangs is stopped."""

import math

import numpy as np
import pytest
from everyday import slow

from scripts.peers import peers


@pytest.fixture(scope="module")
def two_sided():
    return peers.Problem("two-sided", side_stop=False, quick=True)


def setup_of(label):
    return next(setup for setup in peers.SETUPS if setup.label == label)


def test_a_direct_solref_by_hand_obeys_the_contact_law(two_sided):
    point = peers.theirs(two_sided, setup_of("MuJoCo, direct, d = 1e-4, pairs"), 5e-4)
    assert point.note == ""
    assert point.law < 1e-3


def test_a_peer_that_takes_too_long_is_stopped(two_sided, monkeypatch):
    monkeypatch.setattr(peers, "LIMIT", 0.01)
    point = peers.theirs(two_sided, setup_of("MuJoCo, default"), 2e-3)
    assert point.note == "stopped after 0.01 s"
    assert math.isnan(point.seconds)


def test_a_peer_that_fails_says_why(two_sided, monkeypatch):
    monkeypatch.setitem(peers.NEEDS, "nowhere", "mjrock")
    broken = peers.replace(setup_of("MuJoCo, default"), code="nowhere")
    assert peers.theirs(two_sided, broken, 2e-3).note == "No module named 'scripts.peers.codes.nowhere'"


def test_a_peer_that_is_not_installed_is_skipped(two_sided, monkeypatch):
    absent = {code: "not installed" for code in peers.NEEDS}
    monkeypatch.setattr(peers, "NEEDS", {code: "no_such_module" for code in peers.NEEDS})
    assert peers.missing().keys() == absent.keys()
    assert "no_such_module is not installed" in peers.missing()[peers.BULLET]
    assert {point.setup.code for point in peers.points([two_sided], absent, quick=True)} == {""}


def test_numbers_of_a_peer_that_is_not_installed_are_not_written_over(tmp_path, monkeypatch):
    monkeypatch.setattr(peers, "missing", lambda: {peers.SICONOS: "siconos is not installed"})
    table = tmp_path / "peers.csv"
    table.write_text("case,setup\none-sided,mjrock\ntwo-sided,Siconos and restitution typed in\n")
    with pytest.raises(RuntimeError, match=r"peers\.csv has numbers that would be lost; .*\nsiconos is not installed"):
        peers.main(["--out", str(tmp_path)])
    peers.keep_peers(table, {peers.BULLET: "pybullet is not installed"})


def test_a_trembling_peak_counts_once_and_a_fallen_wall_does_not_rebound(two_sided):
    case = two_sided.cases[0]
    t = np.arange(0, 6, 5e-4)
    swing = case.theta0 * np.exp(-0.1 * t) * np.cos(math.pi * t)
    trembling = swing + 1e-4 * np.cos(200 * t)
    smooth, shaken = (
        two_sided.restitution(case, np.array([t, theta, np.gradient(theta, t)])) for theta in (swing, trembling)
    )
    assert len(smooth) == 6
    assert shaken == pytest.approx(smooth, abs=2e-3)
    assert two_sided.restitution(case, np.array([t, swing + 2, 0 * t])).size == 0


@pytest.mark.skipif(peers.SICONOS in peers.missing(), reason=peers.missing().get(peers.SICONOS, ""))
@pytest.mark.parametrize(("side_stop", "step", "error"), [(False, 1e-3, 6e-3), slow((True, 5e-4, 6e-3))])
def test_siconos_rebounds_as_theory_does(side_stop, step, error):
    problem = peers.Problem("wall", side_stop=side_stop, quick=True)
    point = peers.theirs(problem, setup_of("Siconos, restitution typed in"), step)
    assert point.note == ""
    assert point.theory < error
