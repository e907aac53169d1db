"""Properties by type of masonry, the range of k_n that data leave open, and the toe that crushes."""

import math
from pathlib import Path

import pytest

import mjrock as mr
from mjrock.problem.damping.stiffness import lines_over_bed

WALL = mr.Block.from_size(0.9, 12.0, 10.0, 1900.0)


def rotational(k_n, points):
    return mr.Contacts.from_damping(WALL, k_base=k_n, xi_base=0.0, points=points).base.K_rot


@pytest.mark.parametrize("points", [2, 3, 16, 1000])
def test_the_base_of_a_wall_has_the_rotational_stiffness_of_a_cantilever(points):
    inertia = WALL.length * (2 * WALL.b) ** 3 / 12
    expected = 3 * 1e9 * inertia / (2 * WALL.h)
    assert rotational(mr.wall_stiffness(1e9, WALL, points), points) == pytest.approx(expected)
    assert mr.wall_stiffness(1e9, WALL) == pytest.approx(1e9 / 12.0)


def test_two_lines_need_a_third_of_a_bed():
    assert lines_over_bed(WALL, 2) == pytest.approx(1 / 3)
    assert lines_over_bed(WALL, 1000) == pytest.approx(1.0, rel=3e-6)


def test_the_range_of_a_modulus():
    found = mr.stiffness_range(WALL, E=(1e9, 2e9))
    assert found.low == pytest.approx(mr.wall_stiffness(1e9, WALL))
    assert found.high == pytest.approx(2e9 / 0.9 / 3)
    assert found.best == pytest.approx(math.sqrt(found.low * found.high))
    assert found.ends == [found.low, found.high]
    bed = mr.stiffness_range(WALL, E=(1e9, 2e9), points=16)
    assert rotational(bed.low, 16) == pytest.approx(rotational(found.low, 2))
    assert str(found) == "k_n = 2.5e+08 N/m3 (8.3e+07 to 7.4e+08), from E = 1e+09 to 2e+09 Pa"


def test_a_joint_lies_in_series():
    bed = mr.joint_stiffness(E=1e8, thickness=0.03)
    found = mr.stiffness_range(WALL, E=1e9, joint=(1e8, 0.03), points=1000)
    assert found.low == pytest.approx(mr.layered_stiffness(bed, 3e9 / 12.0), rel=1e-4)
    assert found.high == pytest.approx(mr.layered_stiffness(bed, 1e9 / 0.9), rel=1e-4)


def test_a_frequency_takes_the_place_of_the_estimates():
    found = mr.stiffness_range(WALL, frequency=1.2)
    assert found.best == pytest.approx(mr.measured_stiffness(WALL, 1.2), rel=0.02)
    assert found.low == pytest.approx(mr.measured_stiffness(WALL, 1.08))
    known = mr.stiffness_range(WALL, E=1e9, frequency=(1.2, 1.2))
    assert known.low == known.high == pytest.approx(mr.measured_stiffness(WALL, 1.2))
    with pytest.warns(UserWarning, match=r"the measured frequency gives k_n = .* is the wall detached, and .* in Hz\?"):
        mr.stiffness_range(WALL, E=1e9, frequency=12.5)


def test_the_types_are_those_of_the_table():
    """Every row of Table C8.5.I: E and f_c in MPa, unit weight in kN/m3."""
    rows = {
        "irregular rubble": (690, 1050, 1.0, 2.0, 19, 19),
        "roughly cut stone": (1020, 1440, 2.0, 2.0, 20, 20),
        "split stone, well laid": (1500, 1980, 2.6, 3.8, 21, 21),
        "irregular soft stone": (900, 1260, 1.4, 2.2, 13, 16),
        "regular soft stone": (1200, 1620, 2.0, 3.2, 13, 16),
        "squared stone blocks": (2400, 3300, 5.8, 8.2, 22, 22),
        "solid brick, lime mortar": (1200, 1800, 2.6, 4.3, 18, 18),
        "hollow brick, cement mortar": (3500, 5600, 5.0, 8.0, 15, 15),
    }
    assert list(mr.MASONRY_TYPES) == list(rows)
    for name, (*EF, low, high) in rows.items():
        kind = mr.MASONRY_TYPES[name]
        assert [value / 1e6 for value in (*kind.E, *kind.f_c)] == pytest.approx(EF)
        assert kind.unit_weight == (1e3 * low, 1e3 * high)
        assert "C8.5.I" in kind.source
    assert mr.MASONRY_TYPES["irregular rubble"].density == pytest.approx(1937, abs=1)


def test_the_crushed_toe_carries_the_weight():
    inset = mr.crushed_inset(WALL, 2e6)
    assert 0.5 * 2e6 * 3 * inset * WALL.length == pytest.approx(WALL.weight)
    assert mr.crushed_inset(WALL, 2e6, load=WALL.weight) == pytest.approx(2 * inset)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: mr.stiffness_range(WALL), "E and frequency are None: a joint alone is an upper bound"),
        (lambda: mr.stiffness_range(WALL, frequency=2.0, joint=(1e9, 0.01)), "joint needs E of the wall beside it"),
        (lambda: mr.stiffness_range(WALL, E=(2e9, 1e9)), "modulus E = .* is not a low end and a high end"),
        (lambda: mr.stiffness_range(WALL, E=(1e9,)), "modulus E = .* is neither a number nor its low and high end"),
        (lambda: mr.stiffness_range(WALL, E=1000), "modulus E = 1000 Pa is outside the valid range"),
        (lambda: mr.stiffness_range(WALL, E=1e9, joint=3), "joint = 3 of type int is not a modulus"),
        (
            lambda: mr.stiffness_range(WALL, E=1e9, joint=(1e9, 30)),
            "joint, thickness = 30 m is outside the valid range",
        ),
        (lambda: mr.stiffness_range(WALL, E=1e9, points=1), "contact points = 1 is outside"),
        (lambda: mr.crushed_inset(WALL, 2.0), "compressive strength f_c = 2 Pa is outside the valid range"),
        (lambda: mr.crushed_inset(WALL, 1e5), r"f_c = 100000 Pa cannot carry .* the valid range is above 2.98e\+05 Pa"),
        (
            lambda: mr.StiffnessRange(2e8, 1e8, 3e8, ""),
            r"best = 1e\+08 N/m3 is outside the valid range 2e\+08 to 3e\+08",
        ),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        call()


def test_the_page_names_the_types_as_the_table_does():
    page = (Path(__file__).parents[2] / "docs" / "stiffness.md").read_text(encoding="utf-8")
    rows = page.split("| masonry, mortar poor |")[1].split("\n\n")[0].splitlines()[2:]
    assert [row.split("|")[1].strip() for row in rows] == list(mr.MASONRY_TYPES)
