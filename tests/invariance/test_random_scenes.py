"""Random scenes, checked and run under invariances: see docs/validation.md and `python -m tests.invariance`."""

from pathlib import Path

import numpy as np
import pytest
from everyday import among

from mjrock.problem.masonry.masonry import Masonry
from tests.invariance.__main__ import table
from tests.invariance.balance import is_stepwise, unbalanced, unbalanced_bodies
from tests.invariance.invariances import INVARIANCES, SAMPLES, Trial
from tests.invariance.judge import EQUAL, judge, overheard, tried, watched
from tests.invariance.quantities import changed, moved, scaled, turned
from tests.invariance.random_scenes import DENSITY, LATER, PLACES, draw, on_a_slope
from tests.invariance.runs import apart, extruded, measured_in_the_plane, motion_of, softened, solve

FIRST, LAST, ADDED = 1000, 1150, 50
"""Seeds from the first to the last, and as many from `LATER` on, whose kinds and actions slow scenes have."""
SLOW = (
    *(1000, 1003, 1004, 1005, 1009, 1019, 1042, 1046, 1049, 1052, 1061, 1065, 1066, 1080, 1087, 1092, 1122, 1126, 1132),
    *(1134, 1135, 1152, 1159, 1160, 1167, 1175, 1186, 1187, 1192, 1199, 1202, 1212, 1213, 1248, 1258, 1262, 1265),
    *(LATER + i for i in (10, 15, 16, 17, 18, 21, 26, 27, 28, 32, 34, 36, 42, 44, 47, 50, 52, 65, 75, 76)),
    *(LATER + i for i in (77, 83, 93, 98, 104, 109, 111, 114)),
)
"""Seeds of slow scenes. They draw twice, where two of the seeds above do, each kind of scene, device, action and
outcome in each place and by each solver, and each invariance in places that it applies to, in the shortest time. Few
of them are refused. `python -m tests.invariance` runs any others."""
CHUNK, DRAWN = 5, 3
"""How many slow scenes are one test, and how many invariances each is under."""
EVERY_DAY = (2, 5, 7, 12, 22, LATER + 21, LATER + 27)
BEFORE = 37
"""Samples before a corner of seed 51423 meets a block, at 0.137 s."""
STACK = 5
"""A plane stack on springs with a record."""
PAGE = Path(__file__).parents[2] / "docs" / "validation.md"


def broken(seed, names=None):
    """What is wrong with the scene of a seed under these invariances or all, in words."""
    row = judge(seed, names)
    unlike = [
        f"{name}: {message}" for name, (verdict, message) in row.get("apart", {}).items() if verdict == "unexplained"
    ]
    unnamed = [f"unnamed: {row['unnamed']}"] if "unnamed" in row else []
    return [
        f"seed {seed}, {row['place']}, {row['kind']}: {message}"
        for message in (*unnamed, *row.get("wrong", ()), *unlike)
    ]


@pytest.mark.parametrize("seed", EVERY_DAY)
def test_a_scene(seed):
    assert not broken(seed)


@pytest.mark.parametrize("seed", among([50243, 50543, 50803, 50941], 50243, 50803))
def test_rounding_decides_nothing(seed):
    """Joints as drawn, places that a search finds where nothing presses, and a block that falls turned by 45 degrees
    move alike 1000 m away. What is rounded there, 1e-13 m, grows by less than 1e5."""
    with overheard():
        assert INVARIANCES["elsewhere"].run(Trial(draw(seed))) < 10 * EQUAL


SAME = ("twice", "after_another", "in_threads", "from_the_middle", "mirrored", "renumbered", "in_space", "elsewhere")


@pytest.mark.parametrize("glued", among([False, True], True))
@pytest.mark.parametrize("seed", [5, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (3, 6, 9, 16, 119))])
def test_a_scene_whose_joints_have_own_laws(seed, glued):
    """Joints that stiffen, and glue with a memory, in the plane and in space, as stacks and walls and where blocks fall
    on contacts that are found."""
    scene = draw(seed)
    pressure = DENSITY * 9.81 * scene["size"]
    own = {"softness": pressure / scene["k_n"]}
    if glued:
        own["glue"] = {"tension": 3 * pressure, "opening_energy": 27 * pressure**2 / scene["k_n"]}
    with overheard():
        trial = Trial(scene | {"bond": None, "own": own})
        assert not watched(trial)
        verdicts = {name: tried(trial, name) for name in (*SAME, "larger", "heavier")}
    assert not [name for name, found in verdicts.items() if found is not None and found[0] == "unexplained"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [40031, 50586])
def test_no_constant_of_the_steps_in_mujoco_has_a_unit(seed):
    """Four times as large and twice as slow: what a joint that sticks creeps, and the gap that counts as none."""
    with overheard():
        assert INVARIANCES["larger"].run(Trial(draw(seed))) < 1e-6


@pytest.mark.parametrize("seed", among([50365, 50543, 51423, 51440], 50365, 50543))
def test_prisms_move_as_blocks_of_the_plane(seed):
    """Friction past an end of its face, of a line that leaves its face, and of one that is handed over is that of the
    plane, and so are the points beside each other: an L, a pile, and arches of two points and of four with a jack. The
    motions are at no edge: under four kernels of linear algebra both lie within 3e-13 of each other."""
    with overheard():
        assert INVARIANCES["in_space"].run(Trial(draw(seed))) < EQUAL


@pytest.mark.slow
def test_a_step_that_softens_a_contact_in_space_alone_is_no_chaos():
    """A corner falls on a block that it has no joint with. As a prism its block turns out of the plane faster than in
    it, and the step leaves the contact less of its stiffness. Half the step leaves all of it, and the motions agree."""
    scene = draw(51423)
    found = {}
    with overheard():
        trial = Trial(scene)
        for step in (trial.step, 0.5 * trial.step):
            flat = motion_of(solve(scene | {"timestep": step}, output_step=trial.spacing))
            with measured_in_the_plane(scene), softened() as shares:
                solid = motion_of(solve(extruded(scene) | {"timestep": step}, output_step=trial.spacing))
            before, after = (apart(flat.until(n), solid.in_the_plane()) / scene["size"] for n in (BEFORE, SAMPLES + 1))
            found[step] = min(shares), before, after
            print("step {:.2e} s: least share {:.2f}, apart {:.1e}, after it has met {:.1e}".format(step, *found[step]))
        print(f"nudged: {trial.nudged:.1e}")
    (softer, before, parted), (whole, _, together) = found.values()
    assert softer < 0.95
    assert before < 1e-12
    assert parted > 1e-5
    assert whole == 1.0
    assert max(together, trial.nudged) < 1e-11


def drawn_names(seed):
    """The invariances of a slow scene."""
    return np.random.default_rng(seed).choice(list(INVARIANCES), DRAWN, replace=False)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, len(SLOW), CHUNK))
def test_scenes(first):
    """Each under some of the invariances, drawn by its seed."""
    found = []
    for seed in SLOW[first : first + CHUNK]:
        found += broken(seed, drawn_names(seed))
    assert not found, "\n".join(found)


def features(seed):
    """What a scene has, in its place and by its solver, and under which invariances it is in its place."""
    scene = draw(seed)
    acts = ("bond", "record", "tilt", "kick", "supports", "settled", "pairs", "slope", "one_sided", "stop", "frequency")
    has = {scene["kind"], *(name for name in acts if scene.get(name)), f"points {scene.get('points')}"}
    has |= {name for name in ("xi", "friction") if scene.get(name) == 0}
    for device in scene["devices"]:
        has |= {device["kind"], *(name for name in ("prestress", "to") if name in device)}
    named = {(name, scene["place"]) for name in (*has, *drawn_names(seed))}
    return named | {(name, scene["solver"]) for name in has}


@pytest.mark.slow
def test_slow_scenes_have_all_that_is_drawn():
    drawn = set().union(*map(features, (*range(FIRST, LAST), *range(LATER, LATER + ADDED))))
    assert drawn - set().union(*map(features, SLOW)) == set()


def alike(one, other):
    """Whether two scenes are the same but for rounding."""
    leaves = [[], []]
    for scene, kept in zip((one, other), leaves, strict=True):
        changed(scene, lambda name, value, kept=kept: kept.append((name, value)))
    assert len(leaves[0]) == len(leaves[1]) > 10
    for (name, value), (_, there) in zip(*leaves, strict=True):
        if isinstance(value, str | bool | int):
            assert value == there
        else:
            np.testing.assert_allclose(value, there, rtol=1e-12, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("seed", range(20))
def test_a_map_and_its_inverse(seed):
    scene = draw(seed)
    alike(scene, draw(seed))
    alike(scaled(scaled(scene, 4.0, 2.0), 0.25, 0.5), scene)
    if scene["place"] != "wall":
        matrix = np.array([(0.0, -1.0), (1.0, 0.0)]) if scene["place"] == "plane" else np.eye(3)[[1, 2, 0]]
        back = turned(turned(scene, matrix), matrix.T)
        alike(moved(moved(back, np.ones(len(matrix))), -np.ones(len(matrix))), scene)


def test_all_kinds_of_scenes_are_drawn():
    scenes = [draw(seed) for seed in range(300)]
    masonry = [scene for scene in scenes if scene["place"] != "wall"]
    devices = {device["kind"] for scene in masonry for device in scene["devices"]}
    assert {scene["place"] for scene in scenes} == set(PLACES)
    assert {scene["solver"] for scene in scenes} == {"explicit", "MuJoCo", "theory"}
    assert len({scene["kind"] for scene in masonry}) == 9
    assert devices == {"tie", "damper", "friction damper", "thrust", "load", "mass", "jack"}
    for name in ("bond", "record", "tilt", "kick", "supports"):
        assert 0.05 < np.mean([bool(scene[name]) for scene in masonry]) < 0.8
    assert max(len(scene["units"]) for scene in masonry) <= 13


def test_later_seeds_draw_what_was_added_later():
    scenes = [draw(seed) for seed in range(LATER, LATER + 300)]
    ties = [device for scene in scenes for device in scene["devices"] if device["kind"] == "tie"]
    assert 0.2 < np.mean(["prestress" in tie for tie in ties]) < 0.8
    assert sum(scene["kind"] == "corner" for scene in scenes) > 4
    for name in ("pairs", "slope"):
        assert 0.15 < np.mean([bool(scene.get(name)) for scene in scenes if scene["place"] != "wall"]) < 0.6
    level = on_a_slope(on_a_slope(np.eye(3), 0.3), -0.3)
    np.testing.assert_allclose(level, np.eye(3), atol=1e-15)


def test_what_is_not_the_same_is_told():
    """Without its twin in stiffness a denser scene moves otherwise, and a nudge of k_n does not."""
    trial = Trial(draw(STACK))
    denser = changed(trial.scene, lambda name, value: 2 * value if name == "density" else value)
    assert trial.twin(denser) > 1e-4
    assert 0 < trial.nudged < 1e-9
    assert not INVARIANCES["heavier"].allows(trial, 1e-4)
    assert INVARIANCES["twice"].allows(trial, 0.0)
    assert not INVARIANCES["twice"].allows(trial, 1e-16)


def test_an_error_that_is_not_named_is_told(monkeypatch):
    def fail(self, *args, **options):
        raise IndexError("list index out of range")

    monkeypatch.setattr(Masonry, "__init__", fail)
    assert "IndexError" in judge(0)["unnamed"]


def test_a_warning_of_numpy_is_an_error():
    with overheard(), pytest.raises(RuntimeWarning, match="divide by zero"):
        np.float64(1.0) / np.float64(0.0)


def test_the_table_names_the_seeds():
    rows = [
        {"seed": 7, "place": "plane", "kind": "stack", "wrong": [], "apart": {"twice": ("unexplained", 1e-9)}},
        {"seed": 8, "place": "space", "kind": "rain", "refused": "ValueError: block_3 at 2.5 m"},
        {"seed": 9, "place": "space", "kind": "rain", "crashed": "exit code -11"},
    ]
    text = table(rows)
    assert "3 scenes, 1 answered, 1 refused, 0 unnamed, 1 crashed" in text
    assert next(line for line in text.splitlines() if line.startswith("twice")).split()[-2:] == ["1", "7"]
    assert "ValueError: # at # m" in text
    assert "crashed: space 9: exit code -11" in text


def test_the_page_has_the_table_of_the_code():
    text = PAGE.read_text(encoding="utf-8")
    for name, row in INVARIANCES.items():
        title = row.run.__doc__.splitlines()[0]
        assert f"| `{name}` | {title} | {row.bounds} | {row.reason} |" in text


def test_the_books_close_where_springs_of_a_find_press_less():
    """A block that slides while it presses hard, at joints that are handed over. What the loss of force does to the
    half of the step before it is booked with the energy; without it 1 % of the energy is missing."""
    scene = draw(10018)
    with overheard():
        ledger = solve(scene, ledger=True, output_step=scene["duration"] / 80).ledger
    assert sum(account[-1] for account in ledger.ends.values()) > 4e-3 * ledger.largest
    assert np.abs(ledger.residual).max() < 2e-3 * ledger.largest


def test_the_books_close_where_a_support_leaves_a_block():
    """A lintel whose pier goes away below it, with half the step of its own. Half a step of the work of the pier at
    joints that are handed over was 0.6 % of the energy."""
    trial = Trial(draw(40465))
    with overheard():
        ledger = solve(trial.scene | {"timestep": 0.5 * trial.step}, ledger=True).ledger
    assert np.abs(ledger.residual).max() < 1e-3 * ledger.largest


def test_a_force_that_is_left_out_is_told():
    """The balances of a stack with a damper hold to rounding, and not without the damper."""
    scene = draw(STACK)
    held = scene["units"][1]
    at = held["parts"][0]["corners"].mean(axis=0)
    damper = {"kind": "damper", "block": held["name"], "at": at, "reach": np.array([-1.0, 0.0]), "damping": 1e4}
    trial = Trial(scene | {"devices": [damper]})
    answer = solve(trial.scene | {"timestep": trial.step}, output_step=trial.step, forces=True)
    assert is_stepwise(answer)
    assert max(unbalanced(answer), unbalanced_bodies(answer)) < 1e-9
    object.__setattr__(answer.kept_forces, "links", {"damper_0": np.zeros(len(answer.t))})
    assert unbalanced_bodies(answer) > 1e-4
