import math
import warnings

import pytest

import mjrock as mr
from mjrock.problem.damping.law import CALIBRATED, CALIBRATED_BED, DampingLaw, Groups


def test_no_warning_inside_table_1(wall, e):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mr.PUBLISHED(wall, e, 5e8)


def test_a_warning_that_names_what_is_outside(wall, e):
    with pytest.warns(UserWarning, match=r"k_n \[N/m3\] = 1e\+10 not in 5e\+07 to 3e\+09"):
        mr.PUBLISHED(wall, e, 1e10)
    slender = mr.Block(b=0.1, h=2.0)
    with pytest.warns(UserWarning, match=r"h/b \[-\] = 20 not in 4 to 15"):
        mr.PUBLISHED(slender, e, 5e8)


def test_a_warning_points_to_the_line_that_led_to_it(wall, e):
    """Whether a law is called, contacts are made of it, or masonry asks for the damping of its joints."""
    calls = {
        "law": lambda: mr.PUBLISHED(wall, e, 1e10),
        "contacts": lambda: mr.Contacts.from_law(wall, e, 1e10, 1e10, law=mr.PUBLISHED),
        "stop": lambda: mr.Contacts.from_law(wall, mr.Restitution.from_geometry(wall), 5e8, 5e8).side_up_to(1.0),
        "masonry": lambda: mr.Masonry.stack([wall], k_n=4e6, friction=0.7, law="CALIBRATED"),
    }
    for name, call in calls.items():
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            call()
        assert caught, name
        assert {warning.filename for warning in caught} == {__file__}, name


def test_a_perfect_rebound_asks_for_no_damping(wall):
    assert mr.PUBLISHED(wall, mr.Restitution(1.0, -1.0), 5e8) == (0.0, 0.0)


def test_the_law_rises_with_loss(wall, e):
    base, side = mr.PUBLISHED(wall, e, 5e8)
    more_base, more_side = mr.PUBLISHED(wall, mr.Restitution(e.base**2, -(e.side**2)), 5e8)
    assert more_base == pytest.approx(2 * base)
    assert more_side == pytest.approx(2 * side)


def test_bad_input(wall, e):
    with pytest.raises(ValueError, match="k_n = -1 N/m3"):
        mr.PUBLISHED(wall, e, -1)
    with pytest.raises(ValueError, match="k_n = nan"):
        mr.PUBLISHED(wall, e, math.nan)
    with pytest.raises(ValueError, match="side restitution = 0"):
        mr.PUBLISHED(wall, mr.Restitution(0.9, 0.0), 5e8)


def test_a_calibrated_law_gives_the_restitution_asked_for(wall, e):
    for law, points in ((CALIBRATED, 2), (CALIBRATED_BED, 16)):
        xi_base, xi_side = law(wall, e, 5e8, 5e8)
        contacts = mr.Contacts.from_damping(
            wall, k_base=5e8, xi_base=xi_base, k_side=5e8, xi_side=xi_side, points=points
        )
        for side_stop, wanted, tolerance in ((False, e.base, 0.003), (True, abs(e.lumped), 0.03)):
            case = mr.Case(wall, 0.5 * wall.alpha, 2.5, side_stop=side_stop)
            found = mr.simulate(case, contacts, accuracy=1e-4).restitution[0]
            assert found == pytest.approx(wanted, rel=tolerance)


def test_what_a_calibrated_law_depends_on(wall, e):
    one = CALIBRATED(wall, e, 5e8)
    assert CALIBRATED(mr.Block(b=wall.b / 2, h=wall.h / 2), e, 5e8) == pytest.approx(one)
    heavy = mr.Block(b=wall.b, h=wall.h, density=4000.0)
    assert CALIBRATED(heavy, e, 1e9) == pytest.approx(one)
    assert CALIBRATED(wall, e, 5e8, 5e8) == one
    soft_side = CALIBRATED(wall, e, 5e8, 5e7)
    assert soft_side[0] == one[0]
    assert soft_side[1] == pytest.approx(10**0.5 * one[1], rel=0.01)
    assert CALIBRATED(wall, e, 5e8, amplitude=0.3) != pytest.approx(one, rel=1e-3)
    assert mr.PUBLISHED(wall, e, 5e8, 5e7, 0.3) == mr.PUBLISHED(wall, e, 5e8)


@pytest.mark.parametrize("law", [CALIBRATED, CALIBRATED_BED])
def test_the_formula_of_the_base_and_its_inverse(law, wall, e):
    groups = Groups.from_wall(wall, e, 5e8)
    for loss in (0.02, 0.03, 0.035):
        assert law.base.loss(groups, law.base.xi(groups, loss)) == pytest.approx(loss)
    low, high = law.reach(wall, 5e8)
    assert 0 < low < e.base < high <= 1
    assert mr.PUBLISHED.reach(wall, 5e8) == (0.0, 1.0)


def test_what_is_out_of_reach_gets_the_closest_damping_and_a_warning(wall, e):
    low, high = CALIBRATED.reach(wall, 5e8)
    with pytest.warns(UserWarning, match=r"no damping of this base makes e_2s = 0.9; it reaches 0.96\d* to 0.98\d*"):
        assert CALIBRATED(wall, mr.Restitution(0.9, -0.47), 5e8)[0] == 0.3
    with pytest.warns(UserWarning, match="no damping of this base"):
        assert CALIBRATED(wall, mr.Restitution((1 + high) / 2, -0.47), 5e8)[0] == 0.001
    assert low > 0.9


def test_a_calibrated_law_warns_outside_its_own_range(wall, e):
    with pytest.warns(UserWarning, match=r"k_side \[N/m3\] = 1e\+12 not in 5e\+07 to 1e\+11"):
        CALIBRATED(wall, e, 5e8, 1e12)
    with pytest.warns(UserWarning, match=r"\|e_side\| \[-\] = 0.9 not in 0.2 to 0.6"):
        CALIBRATED(wall, mr.Restitution(e.base, -0.9), 5e8)
    with pytest.raises(ValueError, match="amplitude theta_0/alpha = 0 is outside"):
        CALIBRATED(wall, e, 5e8, amplitude=0)


def test_a_warning_names_the_value_that_was_given_beside_the_rescaled_one(e):
    light = mr.Block(0.3, 2.1, density=1000.0)
    given = r"k_n \[N/m3\] = 6e\+10, for a full wall of 2000 kg/m3 1.2e\+11, not in 5e\+07 to 1e\+11"
    with pytest.warns(UserWarning, match=given):
        CALIBRATED(light, e, 6e10)
    with pytest.warns(UserWarning, match=r"k_n \[N/m3\] = 1.2e\+11 not in 5e\+07 to 1e\+11"):
        CALIBRATED(mr.Block(0.3, 2.1, density=2000.0), e, 1.2e11)


@pytest.mark.parametrize("name", ["calibrated", "Calibrated", "CALIBRATED", " calibrated "])
def test_a_law_is_named_in_any_case_of_letters(name, wall, e):
    assert mr.Contacts.from_law(wall, e, 5e8, 5e8, law=name).law == "CALIBRATED"


@pytest.mark.parametrize("name", ["calibrated-bed", "Calibrated_Bed", "calibrated bed"])
def test_an_underscore_of_a_law_may_be_a_hyphen(name, wall, e):
    assert mr.Contacts.from_law(wall, e, 5e8, 5e8, law=name, points=16).law == "CALIBRATED_BED"


@pytest.mark.parametrize("law", [mr.PUBLISHED, CALIBRATED, CALIBRATED_BED])
def test_a_law_is_the_same_after_save_and_load(law, tmp_path):
    again = DampingLaw.load(law.save(tmp_path / "law.toml"))
    assert again == law
    assert again.errors == law.errors


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ('form = "CornerLaw"', 'form = "Circle"', "form = 'Circle' is not one of PowerLaw, CornerLaw"),
        ("bounce = ", "bonce = ", "unexpected keyword argument 'bonce'"),
        ("[base]", "[bas]", "'base' is missing"),
        ("[base]", "[base", "not a damping law"),
    ],
)
def test_a_file_that_is_no_law(old, new, complaint, tmp_path):
    path = CALIBRATED.save(tmp_path / "law.toml")
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(ValueError, match="is not a damping law") as error:
        DampingLaw.load(path)
    assert complaint in str(error.value)
