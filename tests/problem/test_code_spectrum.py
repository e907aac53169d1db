"""Spectra of codes against values worked out by hand, continuity, and the motion of floors beside the formula."""

import math

import numpy as np
import pytest

import mjrock as mr

G = mr.GRAVITY


def ntc(soil="C", **other):
    given = {"ag": 0.261 * G, "F0": 2.36, "Tc": 0.347, "soil": soil} | other
    return mr.code_spectrum("NTC 2018", **given)


@pytest.mark.parametrize(
    ("soil", "S", "TC"),
    [  # by hand: S_S and C_C of table 3.2.IV with F_0 a_g / g = 0.61596 and T_C* = 0.347 s
        ("A", 1.0, 0.347),
        ("B", 1.4 - 0.4 * 0.61596, 1.1 * 0.347**0.8),
        ("C", 1.7 - 0.6 * 0.61596, 1.05 * 0.347**0.67),
        ("D", 2.4 - 1.5 * 0.61596, 1.25 * 0.347**0.5),
        ("E", 2.0 - 1.1 * 0.61596, 1.15 * 0.347**0.6),
    ],
)
def test_the_site_of_ntc(soil, S, TC):
    found = ntc(soil)
    assert pytest.approx(S) == found.S
    assert pytest.approx(found.TC) == TC
    assert pytest.approx(TC / 3) == found.TB
    assert pytest.approx(4 * 0.261 + 1.6) == found.TD
    assert pytest.approx(1.4 * S) == ntc(soil, topography="T4").S


def test_values_that_another_program_has_printed():
    """A worked example in the research notes of NOVA, an open program for frames by NTC 2018, section 5.3: a_g 0.25 g,
    F_0 2.5, T_C* 0.30 s, ground C, T1. It prints C_C, S, the corners and S_e [g] to six digits."""
    found = ntc("C", ag=0.25 * G, F0=2.5, Tc=0.30)
    assert pytest.approx(1.562210, abs=1e-6) == found.TC / 0.30
    assert pytest.approx((1.325, 0.156221, 0.468663, 2.6), abs=1e-6) == (found.S, found.TB, found.TC, found.TD)
    T = np.array([0.0, 0.1, 0.156221, 0.468663, 1.0, 2.0, 4.0])
    printed = [0.331250, 0.649309, 0.828125, 0.828125, 0.388111, 0.194056, 0.063068]
    np.testing.assert_allclose(found(T) / G, printed, atol=2e-6)


@pytest.mark.parametrize(
    ("soil", "ag", "S"),
    [("B", 0.05, 1.2), ("C", 0.05, 1.5), ("C", 0.6, 1.0), ("D", 0.05, 1.8), ("D", 0.6, 0.9), ("E", 0.05, 1.6)],
)
def test_bounds_of_the_soil_factor(soil, ag, S):
    assert pytest.approx(S) == ntc(soil, ag=ag * G).S


@pytest.mark.parametrize(
    ("code", "soil", "T", "over_ag"),
    [  # S_e / a_g by EN 1998-1:2004, 3.2.2.2, at the corners and between them
        ("EC8 type 1", "A", 0.0, 1.0),
        ("EC8 type 1", "A", 0.3, 2.5),
        ("EC8 type 1", "B", 0.075, 1.2 * (1 + 0.5 * 1.5)),
        ("EC8 type 1", "C", 1.2, 1.15 * 2.5 * 0.5),
        ("EC8 type 1", "D", 4.0, 1.35 * 2.5 * 0.8 * 2.0 / 16.0),
        ("EC8 type 1", "E", 0.5, 1.4 * 2.5),
        ("EC8 type 2", "A", 0.5, 2.5 * 0.5),
        ("EC8 type 2", "B", 0.05, 1.35 * 2.5),
        ("EC8 type 2", "C", 2.4, 1.5 * 2.5 * 0.25 * 1.2 / 2.4**2),
        ("EC8 type 2", "D", 0.3, 1.8 * 2.5),
        ("EC8 type 2", "E", 0.0, 1.6),
    ],
)
def test_eurocode(code, soil, T, over_ag):
    assert float(mr.code_spectrum(code, ag=2.0, soil=soil)(T)) == pytest.approx(2.0 * over_ag)


@pytest.mark.parametrize(
    ("code", "soil", "printed"),
    [
        (1, "A", (7.355, 5.884, 2.942, 1.471, 0.6538)),
        (1, "B", (8.826, 8.826, 4.413, 2.2065, 0.9807)),
        (1, "C", (8.4582, 8.4582, 5.0749, 2.5375, 1.1278)),
        (1, "D", (9.9292, 9.9292, 7.9434, 3.9717, 1.7652)),
        (1, "E", (10.297, 10.297, 5.1485, 2.5742, 1.1441)),
        (2, "A", (7.355, 3.6775, 1.8387)),
        (2, "B", (9.9292, 4.9646, 2.4823)),
        (2, "C", (11.0325, 5.5162, 2.7581)),
        (2, "E", (11.768, 5.884, 2.942)),
    ],
)
def test_eurocode_as_another_program_prints_it(code, soil, printed):
    """Values of eurocodepy 2026.1.1, an open library for the Eurocodes, for 0.3 g and q = 1, with which the design
    spectrum is the elastic one from T_B on. Its lower bound of 0.2 a_g S, at long periods of type 2, is left out, and
    so is ground D of type 2, for which it has another S than table 3.3."""
    T = np.array([0.2, 0.5, 1.0, 2.0, 3.0])[: len(printed)]
    spectrum = mr.code_spectrum(f"EC8 type {code}", ag=2.941995, soil=soil)
    np.testing.assert_allclose(spectrum(T), printed, atol=5.1e-5)


def test_damping_lowers_it_to_a_bound():
    spectrum = ntc()
    assert spectrum(0.3, 0.10) == pytest.approx(spectrum(0.3) * math.sqrt(10 / 15))
    assert spectrum(0.3, 0.5) == pytest.approx(spectrum(0.3) * 0.55)
    assert ntc(damping=0.1)(0.3) == pytest.approx(spectrum(0.3, 0.10))


@pytest.mark.parametrize("spectrum", [ntc(), mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")], ids=["NTC", "EC8"])
def test_displacement(spectrum):
    T = np.array([0.3, 1.0, 3.0])
    np.testing.assert_allclose(spectrum.displacement(T), spectrum(T) * (T / (2 * math.pi)) ** 2)
    ground = 0.025 * spectrum.ag * spectrum.S * spectrum.TC * spectrum.TD  # d_g, equation 3.2.15
    assert spectrum.displacement(10.0) == pytest.approx(ground)
    assert spectrum.displacement(50.0) == pytest.approx(ground)
    for corner in (spectrum.TB, spectrum.TC, spectrum.TD):  # 0.025 stands for 1 / (4 pi^2), 1.3 % more, at T_E
        assert spectrum(corner - 1e-9) == pytest.approx(float(spectrum(corner + 1e-9)))
    assert spectrum.displacement(spectrum.TE - 1e-9) == pytest.approx(
        float(spectrum.displacement(spectrum.TE + 1e-9)), rel=0.014
    )


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (
            lambda: mr.code_spectrum("NTC 2008", ag=2.0, soil="A"),
            "code = 'NTC 2008' is not one of NTC 2018, EC8 type 1",
        ),
        (lambda: ntc(soil="F"), "soil = 'F' is not one of A, B, C, D, E"),
        (lambda: ntc(topography="T5"), "topography = 'T5' is not one of T1"),
        (lambda: ntc(ag=26.1), "ag = 26.1 m/s2 is outside the valid range 0.05 to 10 m/s2"),
        (lambda: ntc(Tc=347.0), "Tc = 347 s is outside"),
        (lambda: ntc(F0=None), "F0 is missing: NTC 2018 takes ag, F0 and Tc"),
        (lambda: mr.code_spectrum("EC8 type 1", ag=2.0, soil="A", F0=2.4), "F0 = 2.4 is of NTC 2018"),
        (lambda: mr.code_spectrum("EC8 type 1", ag=2.0, soil="A", topography="T2"), "topography = T2 is of NTC 2018"),
        (lambda: ntc()(-1.0), "T = -1 s is outside"),
        (lambda: ntc()(1.0, 5.0), "damping = 5 is outside"),
        (lambda: ntc().at_height([0.3, 0.1]), "period has 2 values, participation 1 and height 1"),
        (lambda: ntc().at_height(0.3, height=6.0), "height = 6 is outside the valid range -1 to 1; it .* z / H"),
    ],
)
def test_what_cannot_be(call, complaint):
    with pytest.raises(ValueError, match=complaint):
        call()


def test_an_acceleration_in_g_is_doubted():
    with pytest.warns(mr.Implausible, match=r"ag = 0.261 m/s2 is 0.0266 g; accelerations are in m/s2: is it in g"):
        ntc(ag=0.261)


RECORDS = [mr.GroundMotion.synthetic(3.0, 12.0, seed=seed) for seed in range(6)]
PERIOD, DAMPING, PARTICIPATION, HEIGHT = 0.4, 0.02, 1.3, 0.8


class TestFloors:
    """A floor of a building of one mode."""

    def test_the_motion_of_the_top_of_an_oscillator(self):
        """Its peak is the pseudo-acceleration of the oscillator but for its damping."""
        for record in RECORDS:
            floor = record.through_building(PERIOD, DAMPING)
            assert floor.peak == pytest.approx(float(mr.response_spectrum(record, PERIOD, DAMPING).Sa[0]), rel=4e-3)

    def test_a_base_does_not_feel_the_building(self):
        floor = RECORDS[0].through_building([0.4, 0.1], participation=[1.3, 0.4], height=0.0 * np.ones(2))
        np.testing.assert_allclose(floor(RECORDS[0].dt * np.arange(500)), RECORDS[0].accel[:500], atol=1e-12)

    def test_a_stiff_building_moves_with_the_ground(self):
        record = mr.GroundMotion.sine(2.0, 2.0, cycles=2.0)
        floor = record.through_building(0.02, 0.05, participation=1.0, height=1.0)
        assert floor.peak == pytest.approx(record.peak, rel=0.01)

    def test_the_steady_state_is_that_of_the_closed_form(self):
        """Transmissibility sqrt(1 + (2 xi r)^2) / sqrt((1 - r^2)^2 + (2 xi r)^2), r the ratio of the frequencies."""
        period, xi = 0.5, 0.1
        record = mr.GroundMotion.sine(1.0, 0.4, cycles=50.0, samples=100)
        r = period / 0.4
        closed = math.sqrt((1 + (2 * xi * r) ** 2) / ((1 - r**2) ** 2 + (2 * xi * r) ** 2))
        floor = record.through_building(period, xi, participation=1.2, height=0.5)
        late = (floor.dt * np.arange(len(floor.accel)) > 15) & (floor.dt * np.arange(len(floor.accel)) < 20)
        # 0.4 of the ground and 0.6 of the oscillator, out of phase
        phase = math.atan2(2 * xi * r**3, 1 - r**2 + (2 * xi * r) ** 2)
        both = abs(0.4 + 0.6 * closed * np.exp(-1j * phase))
        assert np.abs(floor.accel[late]).max() == pytest.approx(both, rel=2e-3)

    def test_the_formula_of_the_commentary_is_the_mean_of_floors(self):
        """Records scaled to the spectrum of the ground, through the oscillator. The formula spreads the peak over 0.8
        to 1.1 of the period of the mode: it lies below the mean at resonance, and up to twice above it beside."""
        spectrum = ntc()
        T = np.array([0.1, 0.2, 0.4, 0.6, 0.8, 1.2])
        scaled = [mr.scaled_to_spectrum(record, np.geomspace(0.1, 2.0, 20), spectrum) for record in RECORDS]
        floors = [
            record.through_building(PERIOD, 0.05, participation=PARTICIPATION, height=HEIGHT) for record in scaled
        ]
        mean = np.mean([mr.response_spectrum(floor, T).Sa for floor in floors], axis=0)
        formula = spectrum.at_height(PERIOD, 0.05, participation=PARTICIPATION, height=HEIGHT)(T)
        at_resonance = T == PERIOD
        assert 0.7 < (formula / mean)[at_resonance] < 1.0
        assert (formula / mean)[~at_resonance].min() > 1.0
        assert (formula / mean)[~at_resonance].max() < 2.2

    def test_two_modes_by_hand(self):
        """C7.2.5 to C7.2.8 with a pencil, on a spectrum of 2 m/s2 at every period, at 5 % of damping: 1.1 / 0.05^0.5 is
        4.9193, a_Z of the modes 2 x 1.2 x 1.00499 = 2.4120 and 2 x 0.24 x 1.00499 = 0.4824 m/s2.

        At 0.2 s: 1 - 0.2 / 0.24 = 0.16667, to the power 1.6 0.056874, so 4.9193 x 2.4120 / 1.22291 = 9.7026; and
        0.2 / 0.11 - 1 = 0.81818, to the power 1.2 0.78599, so 4.9193 x 0.4824 / 4.0806 = 0.5816; root 9.7200.
        """
        flat = mr.PointSpectrum([0.0, 10.0], [2.0, 2.0])
        floor = flat.at_height([0.3, 0.1], participation=[1.2, -0.4], height=[1.0, 0.6])
        assert floor.peak == pytest.approx(math.hypot(2.4120, 0.4824), rel=1e-4)
        assert floor(0.2) == pytest.approx(9.7200, rel=1e-4)
        assert floor(5.0) == 2.0  # the modes alone have 0.6 m/s2 there
        assert floor.displacement(0.2) == pytest.approx(9.7200 * (0.2 / 6.28319) ** 2, rel=1e-4)

    def test_beyond_the_first_mode_displacements_have_a_least_value(self):
        """C8.7.1.12: beyond b T_1 at least S_eZ(T_1) (b T_1 / 2 pi)^2, by hand 4.9193 x 2.4120 x (0.33 / 6.28319)^2 =
        0.032730 m of one mode. S_eZ T^2 / (4 pi^2) alone falls to 0.82 of it at twice b T_1."""
        floor = mr.PointSpectrum([0.0, 10.0], [2.0, 2.0]).at_height(0.3, participation=1.2)
        T = np.linspace(0.331, 1.0, 200)
        assert floor.displacement(T).min() == pytest.approx(0.032730, rel=1e-4)
        alone = floor(T) * (T / (2 * math.pi)) ** 2
        assert alone.min() == pytest.approx(0.816 * 0.032730, rel=2e-2)

    def test_far_from_the_mode_it_is_the_ground(self):
        spectrum = ntc()
        floor = spectrum.at_height(0.1, participation=1.2, height=0.8)
        assert floor(4.0) == spectrum(4.0)

    def test_a_floor_that_moves_less_than_the_ground_is_doubted(self):
        """As C7.2.5 has no ground in the sum, a floor near the ground stands still up to T_1."""
        with pytest.warns(mr.Implausible, match="peak of 0 m/s2 .* give more modes, or check .* on the ground too"):
            floor = ntc().at_height(0.4, height=0.0)
        assert floor(0.3) == 0.0


def test_a_mechanism_on_a_floor():
    """The check of a wall with the spectrum of the ground, of a floor, and by the function that both stand for."""
    wall = mr.Block.from_size(0.5, 4.0, 5.0, 1800.0)
    case, spectrum = mr.Case(wall, 0.0, 1.0), ntc()
    floor = spectrum.at_height(0.25, participation=1.3, height=0.7)
    for demand in (spectrum, floor):
        found = mr.mechanism_check(case, demand)
        by_hand = mr.mechanism_check(case, lambda T, xi, demand=demand: float(demand.displacement(T, xi)))
        assert found.states["SLV"].demand == by_hand.states["SLV"].demand
        assert found.linear_ratio == pytest.approx(found.linear / demand.peak)
        assert by_hand.linear_ratio is None
        assert "capacity over demand SLV, linear" in found.table()
    assert mr.mechanism_check(case, floor).linear_ratio < mr.mechanism_check(case, spectrum).linear_ratio


def test_a_record_through_a_building_is_a_demand_and_a_motion():
    record = RECORDS[0].through_building(0.25, participation=1.3, height=0.7)
    wall = mr.Block.from_size(0.5, 4.0, 5.0, 1800.0)
    case = mr.Case(wall, 0.0, 2.0, motion=record)
    assert mr.mechanism_check(case, record).peak == record.peak
    assert mr.solve_analytical(case, e=mr.Restitution.from_geometry(wall)).t[-1] == pytest.approx(2.0)
