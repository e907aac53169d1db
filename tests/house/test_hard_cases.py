"""Every promise of `scripts/checks/hard_cases.py`, and the scenes that once broke one."""

import pytest

import mjrock as mr
from scripts.checks import hard_cases, trouble
from scripts.checks.trouble import Scene

LONG = {"a thousand impacts", "an hour at rest"}
"""Cases that take some seconds."""


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(
    "case",
    [pytest.param(c, marks=pytest.mark.slow) if c.name in LONG else c for c in hard_cases.ALL],
    ids=lambda c: c.name.replace(" ", "-"),
)
def test_hard_case(case):
    kept, result = case.check()
    assert kept, f"{case.promise}: {result}"


ONCE_BROKEN = {
    "the pivot opened in a long step and the wall fell through it": Scene(
        3.19, 5.03, 4719.0, 1.065e11, 6.54e10, 0.0, 0.0, 2, True, 0.507, 0.0
    ),
    "a contact that opened was met with the force it had felt": Scene(
        1.70, 20.0, 1933.0, 4.29e10, 2.32e9, 3.54, 0.017, 2, False, -0.964, 0.0
    ),
    "the base plane was put at the origin instead of a micrometre below": Scene(
        0.1655, 13.48, 1769.0, 2.285e11, 2.81e9, 1.3e-4, 1.6e-4, 8, True, 1e-6, 0.0
    ),
    "a stiff dashpot threw the wall back": Scene(
        5.67, 33.3, 2274.0, 1.01e9, 1.95e10, 2.7e-4, 2.39, 2, True, 0.0257, 0.0
    ),
    "a strong dashpot was not resolved": Scene(4.91, 11.72, 2000.0, 9.8e7, 3.1e8, 0.147, 0.0998, 4, True, 0.409, 0.0),
    "a wall leaned on a soft stop with an edge that slid": Scene(
        4.0, 7.4, 2000.0, 2.4e9, 1.1e8, 0.05, 0.01, 2, True, 0.5, 0.0
    ),
    "a tie that had yielded at the release pulled with its elastic force for one step": Scene(
        *(2.79, 6.0, 2000.0, 5e7, 5e8, 0.037, 0.0056, 2, False, 0.7, 0.0),
        effects=(mr.Tie(height=1.3, stiffness=1e8, strength=12e3),),
    ),
    "friction was booked for creep that had been put back, under a thrust on a wall at rest": Scene(
        *(2.95, 4.37, 2000.0, 5.8e7, 3.6e8, 0.047, 0.028, 4, False, 0.586, 0.0),
        inset=0.144,
        effects=(mr.Thrust(height=2.7, force=3.7e3),),
    ),
    "the length of a stiff tie was rounded by more than the rest of the wall tolerated": Scene(
        *(0.107, 4.0, 2788.0, 1.6e11, 5.4e10, 0.0013, 0.1, 2, False, 0.5, 0.0),
        effects=(mr.Tie(height=0.013, stiffness=2.5e10, length=4.4), mr.Load(force=58.6, height=0.08, offset=0.0098)),
    ),
}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("name", ONCE_BROKEN)
def test_mended(name):
    assert trouble.broken_promise(ONCE_BROKEN[name], wide=True) is None


@pytest.mark.slow
@pytest.mark.parametrize("effects", [False, True], ids=["bare", "with effects"])
@pytest.mark.parametrize("wide", [False, True], ids=["Table 1", "wide"])
def test_no_trouble_in_hundreds_of_random_scenes(wide, effects):
    """Well outside Table 1, about one scene in a thousand with effects opens its ledger at the default accuracy."""
    found = trouble.search(100 if effects else 200, wide=wide, seed=21 if effects else 11, effects=effects)
    assert len(found) <= (2 if wide and effects else 0), "\n".join(f"{what}: {scene}" for scene, what in found)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_promise_can_be_broken(monkeypatch):
    """The twin that must fail: with a long fixed step, energy is lost track of."""
    scene = ONCE_BROKEN["the pivot opened in a long step and the wall fell through it"]
    fitted = mr.simulate
    monkeypatch.setattr(mr, "simulate", lambda case, contacts, **options: fitted(case, contacts, 5e-3, **options))
    assert "appeared from nowhere" in trouble.broken_promise(scene, wide=True)


def test_a_base_too_soft_to_stand_on_is_refused_with_the_least_that_holds(wall):
    with pytest.raises(ValueError, match="cannot hold the wall upright; the valid range is k_base >"):
        mr.Contacts.from_damping(wall, k_base=1e6, xi_base=0.05)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_load_that_the_springs_cannot_carry_is_refused_with_a_reason():
    scene = Scene(
        *(0.333, 10.0, 3288.0, 2e7, 1.6e9, 0.57, 0.6, 2, True, 0.1, 0.0),
        effects=(mr.Thrust(height=0.084, force=60.0),),
    )
    case, contacts = scene.make()
    with pytest.raises(ValueError, match=r"do not stand on their contacts.*valid range"):
        mr.simulate(case, contacts)
    assert trouble.broken_promise(scene, wide=True) is None
