"""What is public prints in a line, with units."""

import numpy as np
import pytest

import mjrock as mr

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
E = mr.Restitution(0.97, -0.47)
CONTACTS = mr.Contacts.from_damping(WALL, k_base=5e8, xi_base=0.05, k_side=4e8, xi_side=0.01, side_friction=0.6)
CASE = mr.Case(WALL, 0.5 * WALL.alpha, 3.0)
RICH = mr.Case(
    mr.Block.from_size(
        0.6, 4.2, 3.0, inset=0.02, openings=[mr.Opening(1.0, 2.0)], profile=[(0, 0.6), (4.2, 0.4)],
        masses=[mr.AddedMass(50.0, 4.0)] * 2,
    ),
    0.0,
    2.0,
    side_stop=mr.SideStop(3.0),
    omega0=0.1,
    motion=mr.GroundMotion([0.0, 1.0], 0.1, "a"),
    vertical=mr.GroundMotion([0.0, 1.0], 0.1, "b"),
    effects=(mr.Tie(4.0, 1e6), mr.Load(1e3, 4.2)),
)  # fmt: skip
BLOCK = "<Block 0.6 x 4.2 m, 1 m long, 2000 kg/m3: 5040 kg, alpha = 0.1419 rad, p = 1.862 rad/s>"
HELD = "<Contacts, law given, 2 lines a face: base k_n = 5e+08 N/m3, xi = 0.05; side k_n = 4e+08 N/m3, xi = 0.01, friction 0.6>"  # noqa: E501


@pytest.mark.parametrize(
    ("shown", "text"),
    [
        (WALL, BLOCK),
        (E, "Restitution(base=0.97, side=-0.47)"),
        (CONTACTS, HELD),
        (CONTACTS.side, "<Interface k_n = 4e+08 N/m3, xi = 0.01, friction 0.6: 4.2 x 1 m, 2 lines, 30.11 rad/s>"),
        (CASE, f"<Case of {BLOCK}: theta0 = 0.07095 rad = 0.5 alpha, 3 s, side stop>"),
        (mr.Case(WALL, 0.0, 1.0, side_stop=False), f"<Case of {BLOCK}: theta0 = 0 rad = 0 alpha, 1 s, no side stop>"),
        (mr.PUBLISHED, "<DampingLaw PUBLISHED: h/b 4 to 15, k_n 5e+07 to 3e+09 N/m3>"),
        (mr.CALIBRATED, "<DampingLaw CALIBRATED: h/b 4 to 15, k_n 5e+07 to 1e+11 N/m3, 2 lines a face>"),
        (mr.Grid(dict, slenderness=[5, 7], scale=[1, 2, 3]), "<Grid of 6 cases: slenderness (2), scale (3)>"),
        (mr.wall_scene(CASE, CONTACTS), "<Scene of 1 bodies, 4 contacts, 0 links>"),
        (
            mr.Masonry.running_bond(2.0, 1.5, (0.5, 0.25), k_n=1e10, friction=lambda joint: 0.6),
            "<Masonry of 27 blocks, 2 x 1.5 m: k_n = 1e+10, friction of the joint, xi = 0.05, points = 2>",
        ),
        (
            mr.Masonry.stack([mr.Block.from_size(0.5, 2.0)], k_n=1e9, law="CALIBRATED"),
            "<Masonry of 1 blocks, 0.5 x 2 m: k_n = 1e+09, friction = 0.7, law CALIBRATED, points = 2>",
        ),
        (
            mr.Masonry.box((0.4, 0.6, 2.0), k_n=1e9, k_s=4e8),
            "<Masonry of 1 blocks, 0.4 x 0.6 x 2 m: k_n = 1e+09, k_s = 4e+08, friction = 0.7, xi = 0.05, points = 2>",
        ),
        (
            mr.Analysis(CASE, contacts=CONTACTS, options={"accuracy": 1e-4}),
            f"<Analysis by MuJoCo of {CASE!r}, {HELD}, accuracy = 0.0001>",
        ),
    ],
    ids=lambda value: type(value).__name__,
)
def test_it_prints_in_a_line_with_units(shown, text):
    assert repr(shown) == str(shown) == text


def test_what_a_wall_and_a_case_carry_is_named():
    message = repr(RICH)
    for part in (
        "inset 0.02 m, 0.4 m thick at the top, 1 opening, 2 added masses",
        "side stop up to 3 m",
        "omega0 = 0.1 rad/s, motion 'a', vertical 'b', Tie, Load>",
    ):
        assert part in message


def test_a_comparison_and_a_store_say_what_they_hold(tmp_path):
    theory = mr.solve_analytical(CASE, E)
    message = repr(mr.compare(theory, theory))
    assert (
        message
        == "<Comparison of analytical with analytical: |e| of rebound 1 0.4422 for 0.4422, RMS of theta/alpha 0>"
    )
    with mr.Store(tmp_path / "walls.sqlite", writing=True) as store:
        assert repr(store) == f"<Store {tmp_path / 'walls.sqlite'}>"


def test_no_public_object_prints_an_address():
    public = {name: getattr(mr, name) for name in sorted(set(mr.__all__) - {"GroundMotion", "BONDS"})}
    shown = {name: repr(each) for name, each in public.items() if not callable(each) or isinstance(each, mr.DampingLaw)}
    assert len(shown) > 4
    assert {name: text for name, text in shown.items() if " at 0x" in text or len(text) >= 120} == {}


def test_every_public_class_prints_in_a_form_of_its_own():
    """None has the form that a dataclass makes, with sixteen digits and all defaults."""
    public = {name: getattr(mr, name) for name in mr.__all__ if isinstance(getattr(mr, name), type)}
    made = [name for name, kind in public.items() if hasattr(kind.__repr__, "__wrapped__")]
    assert len(public) > 40
    assert made == []


def test_numbers_are_short_and_defaults_are_left_out():
    tie = mr.Tie(10.0, 1e8 / 3, strength=float(np.float64(1e5) / 7))
    assert repr(tie) == "Tie(height=10, stiffness=3.33333e+07, strength=14285.7)"
    assert repr(mr.Polyhedron([*np.ndindex(2, 2, 2)])) == "Polyhedron(vertices=<8 values>)"
    assert repr(mr.Restitution.from_geometry(WALL)) == "Restitution(base=0.97, side=-0.47)"
    masonry = mr.Masonry.box((0.5, 0.5, 1.0))
    case = mr.MasonryCase(masonry, 2.0, velocity=np.zeros((1, 6)), transverse=mr.GroundMotion([0.0, 1.0], 0.1, "NS"))
    assert repr(case) == f"<MasonryCase of {masonry!r}: 2 s, transverse 'NS', velocity>"
    assert repr(mr.collapse_multiplier(masonry)) == "<Collapse at 0.5 times the forces that grow: block move>"
    fit = mr.fit_capacities([0.3, 0.4, 0.5, 0.45, 0.35])
    assert repr(fit) == "<Fragility: median 0.3936, dispersion 0.202, of 5 values in 5 groups>"
    spectrum = mr.code_spectrum("EC8 type 1", ag=2.5, soil="B")
    corners = "T_B, T_C, T_D, T_E = 0.15, 0.5, 2, 5 s"
    assert repr(spectrum) == f"<CodeSpectrum EC8 type 1: a_g = 2.5 m/s2, S = 1.2, F_0 = 2.5, {corners}>"
    impact = mr.Impact(1.14032328, -0.0726032, 0.0351669, 16081.09, 3772.87)
    assert repr(impact) == "<Impact at 1.14 s: -0.0726 to 0.03517 rad/s, 1.608e+04 to 3773 J>"
