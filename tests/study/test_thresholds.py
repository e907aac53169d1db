"""Ranges of intensity in which a wall or masonry falls, against ranges that are known."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
import pytest

import mjrock as mr
from mjrock import plotting

WALL = mr.Block.from_size(0.6, 4.2)
E = mr.Restitution.from_geometry(WALL)


@dataclass(frozen=True, repr=False)
class Known(mr.Analysis):
    """A wall that falls where a function of the peak of its motion [m/s2] says so."""

    rule: object = field(default=None, compare=False)
    number: int = 0

    def __call__(self, history=None):
        return {self.PEAK: math.inf if self.rule(self.case.motion.peak) else 0.5}


def of(rule, number=0):
    def build(scale):
        motion = mr.GroundMotion([0.0, -scale, 0.0], 0.1)
        return Known(mr.Case(WALL, 0.01, 1.0, motion=motion), "analytical", e=E, rule=rule, number=number)

    return build


def found_by(build, scales, tmp_path, **options):
    return mr.thresholds(build, scales, tmp_path / "t.sqlite", executor=ThreadPoolExecutor(1), **options)


SCALES = np.linspace(0.5, 8.0, 16)
"""Half apart."""


def test_every_range_is_found_with_its_edges(tmp_path):
    builds = {
        "two": of(lambda a: 2.2 <= a < 3.3 or a >= 5.7),
        "none": of(lambda a: False, 1),
        "one": of(lambda a: a >= 4.1, 2),
        "all": of(lambda a: True, 3),
    }
    found = found_by(builds, SCALES, tmp_path, tolerance=1e-3)
    two, none, one, every = found.islands
    assert [island.falls_from for island in two] == pytest.approx([2.2, 5.7], rel=1e-3)
    assert two[0].falls_to < 3.3 <= two[0].stands_above
    assert two[0].stands_above - two[0].falls_to < 1e-3 * 3.3
    assert math.isnan(two[1].stands_above)
    assert two[1].falls_to == 8.0
    assert none == ()
    assert one[0].stands_below < 4.1 <= one[0].falls_from
    assert math.isnan(every[0].stands_below)
    np.testing.assert_allclose(found.lowest, [2.2, math.nan, 4.1, 0.5], rtol=1e-3)
    assert found.sentences[0].startswith("falls from 2.2")
    assert " and from 5.70" in found.sentences[0]
    assert found.sentences[0].endswith("stands at all 4 lower scales that were tried")
    assert found.sentences[1] == "stands at all 16 scales that were tried, up to 8"
    assert found.sentences[3] == "falls from 0.5 on; no lower scale was tried"
    assert repr(found) == "<Thresholds of 4 records at 16 scales from 0.5 to 8: 3 make it fall, 1 not monotonically>"
    assert all(island.seen == 1 for own in found.islands for island in own)


def test_what_a_nudge_changes_is_seen(tmp_path):
    """The edge of an answer that depends on the last digits: from 3 to 4 every repeat falls or not by itself."""

    def rule(a):
        return a >= 4 or (a >= 3 and round(1e7 * a) % 2 == 1)

    found = found_by(of(rule), [1.0, 2.0, 3.2, 3.4, 3.6, 3.8, 5.0, 6.0], tmp_path, nudges=(1e-7, -1e-7, 3e-7))
    assert found.shares[0, :2].tolist() == [0.0, 0.0]
    assert found.shares[0, -2:].tolist() == [1.0, 1.0]
    chance = found.shares[0, 2:6]
    assert ((chance > 0) & (chance < 1)).any()
    low, high = found.islands[0][-1].lower
    assert 2.0 <= low < high <= 4.0 * 1.01
    assert high - low > 0.1  # where an edge is sharp it is 0.01


def test_the_same_call_runs_nothing_again(tmp_path, monkeypatch):
    build = of(lambda a: a >= 4.1)
    first = found_by(build, SCALES, tmp_path)
    monkeypatch.setattr(Known, "__call__", lambda self, history=None: 1 / 0)
    again = found_by(build, SCALES, tmp_path)
    assert again.table() == first.table()
    assert again.runs == first.runs


@pytest.mark.slow
def test_walls_and_masonry_of_many_blocks(tmp_path):
    """The first edge of a block under a half sine, in theory and as a stack of one by explicit steps, is that which a
    search by halving finds."""
    block = mr.Block.from_size(0.5, 2.0)
    stack = mr.Masonry.stack([block], k_n=1e7, xi=0.02)

    def theory(scale):
        motion = mr.GroundMotion.half_sine(-scale, 0.4)
        case = mr.Case(block, 0.0, 2.0, motion=motion, side_stop=False)
        return mr.Analysis(case, "analytical", e=mr.Restitution.from_geometry(block))

    def steps(scale):
        motion = mr.GroundMotion.half_sine(-scale, 0.4)
        return mr.MasonryAnalysis(mr.MasonryCase(stack, 1.0, motion=motion), solver="explicit")

    scales = np.linspace(3.0, 9.0, 5)
    found = found_by({"theory": theory, "steps": steps}, scales, tmp_path, nudges=())
    for lowest, build in zip(found.lowest, (theory, steps), strict=True):
        assert lowest == pytest.approx(mr.overturning_intensity(build, 3.0, 9.0, tolerance=0.01), rel=0.01)


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        ({"tolerance": 0.0}, "tolerance = 0 is outside the valid range 1e-06 to 0.5"),
        ({"nudges": (0.5,)}, r"nudges\[0\] = 0.5 is outside the valid range -0.01 to 0.01"),
        ({"scales": [2.0, 1.0]}, "scales"),
        ({"build": {}}, "build holds no records"),
    ],
)
def test_what_is_wrong_is_named(options, complaint, tmp_path):
    given = {"build": of(lambda a: True), "scales": [1.0, 2.0]} | options
    with pytest.raises(ValueError, match=complaint):
        mr.thresholds(store=tmp_path / "t.sqlite", **given)


def test_the_picture_has_a_bar_for_every_range(tmp_path):
    builds = {"two": of(lambda a: 2.2 <= a < 3.3 or a >= 5.7), "none": of(lambda a: False, 1)}
    found = found_by(builds, SCALES, tmp_path)
    ax = plotting.thresholds(found, "m/s2")
    wide = [patch for patch in ax.patches if patch.get_height() == 0.5]
    assert [patch.get_x() for patch in wide] == [one.falls_from for one in found.islands[0]]
    assert [text.get_text() for text in ax.get_yticklabels()] == ["two", "none"]
    assert ax.get_xlabel() == "scale [m/s2]"
