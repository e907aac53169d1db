"""The table of misuse: values that can be and are most often another unit warn once, with both numbers."""

import warnings

import numpy as np
import pytest

import mjrock as mr
from mjrock.problem.wall import plausibility
from mjrock.study.intensity import ida

WALL = mr.Block.from_size(0.9, 12.0, 10.0, 1900.0)
E = mr.Restitution.from_geometry(WALL)
RECORD = mr.GroundMotion.synthetic(peak=4.0, duration=12.0, seed=2)
SMALL = mr.Block.from_size(0.9, 4.0)


def case(**options):
    return mr.Case(WALL, **({"theta0": 0.0, "duration": 15.0, "motion": RECORD} | options))


def with_effect(effect):
    return case(effects=effect)


def contacts(**options):
    return mr.Contacts.from_law(WALL, E, k_base=1e9, k_side=1e9, **options)


def against(share, solve=mr.simulate, **options):
    """A wall let go against a stop that reaches up to a share of its height."""
    held = mr.Contacts.from_damping(SMALL, k_base=1e9, xi_base=0.05, k_side=1e9, xi_side=0.05, **options)
    return solve(mr.Case(SMALL, 0.02, 0.05, side_stop=mr.SideStop(share * 4.0)), held)


MISUSE = {
    "theta0 0.5 deg": (lambda: mr.Case(WALL, 0.5, 3.0), "theta0 = 0.5 rad is 6.68 alpha: .* rotations are radians"),
    "theta0 0.1 deg": (lambda: mr.Case(WALL, 0.1, 3.0), "theta0 = 0.1 rad is 1.34 alpha"),
    "omega0 in deg/s": (lambda: mr.Case(WALL, 0.0, 3.0, omega0=5.0), r"omega0 = 5 rad/s: 0\.08\d+ rad/s overturn"),
    "alpha in degrees": (lambda: mr.Restitution.from_geometry(0.9), "alpha = 0.9 rad is 51.6 degrees"),
    "record in g": (
        lambda: case(motion=RECORD.scaled(peak=0.35)),
        r"the record peaks at 0.0357 g; this wall starts to rock at 0.075 g: is the record in g\?",
    ),
    "array in g": (lambda: case(motion=mr.GroundMotion(RECORD.accel / 9.81, 0.01)), "peaks at 0.0416 g; .* at 0.075 g"),
    "array in cm/s2": (lambda: mr.GroundMotion(RECORD.accel * 100, 0.01), "peaks at 400 m/s2 = 40.8 g"),
    "thrust in kN": (lambda: with_effect(mr.Thrust(11.0, 12.0)), r"Thrust: force = 12 N, .* weighs 2.01e\+06 N: .* kN"),
    "load in kN": (lambda: with_effect(mr.Load(60.0, 11.0)), "Load: force = 60 N"),
    "strength in kN": (lambda: with_effect(mr.Tie(8.0, 12e6, strength=80.0)), "Tie: strength = 80 N"),
    "mass in t": (
        lambda: with_effect(mr.AddedMass(1.5, 12.0)),
        r"mass = 1.5 kg, .* 2.05e\+05 kg: is it in t",
    ),
    "stiffness in kN/mm": (
        lambda: with_effect(mr.Tie(8.0, 12.0, strength=80e3)),
        r"Tie yields at an elongation of 6.67e\+03 m, and the wall is 0.9 m thick",
    ),
    "stiffness in kN/m": (lambda: with_effect(mr.Tie(8.0, 12e3, strength=80e3)), "an elongation of 6.67 m"),
    "slack in mm": (
        lambda: with_effect(mr.Tie(8.0, 12e6, slack=3.0, strength=80e3)),
        r"slack = 3 m, and where it is held the wall opens by 0\.6\d* m until it overturns",
    ),
    "slack in mm, with an anchor above": (
        lambda: with_effect(mr.Tie(8.0, 12e6, slack=3.0, strength=80e3, anchor_height=9.0)),
        "slack = 3 m, and where it is held the wall opens by 0",
    ),
    "ultimate in mm": (
        lambda: with_effect(mr.Tie(8.0, 12e6, strength=80e3, ultimate=8.0)),
        r"Tie: ultimate = 8 m, and where it is held the wall opens by 0\.6\d* m until it overturns: .* in m",
    ),
    "strength in Pa": (
        lambda: mr.Case(SMALL, 0.05, 1.0, effects=mr.Tie(4.0, 5e9, strength=235e6)),
        r"strength = 2.35e\+08 N, and the wall weighs 7.06e\+04 N: is it in N, and no stress in Pa",
    ),
    "larger load in kN": (
        lambda: with_effect(mr.Load(600.0, 12.0)),
        "Load: force = 600 N, and the wall weighs .* is it in kN",
    ),
    "larger strength in kN": (
        lambda: with_effect(mr.Tie(8.0, 12e6, strength=400.0)),
        "Tie: strength = 400 N, and the wall weighs .* is it in kN",
    ),
    "larger mass in t": (lambda: with_effect(mr.AddedMass(20.0, 12.0)), "mass = 20 kg, that of the wall .* is it in t"),
    "slip force in kN": (
        lambda: with_effect(mr.FrictionDamper(8.0, 2e7, 60.0)),
        r"slip_force = 60 N, .* is it in kN\?",
    ),
    "friction damper in kN/m": (
        lambda: with_effect(mr.FrictionDamper(8.0, 2e4, 60e3)),
        "FrictionDamper yields at an elongation of 3 m, and the wall is 0.9 m thick",
    ),
    "friction damper of a modulus": (
        lambda: with_effect(mr.FrictionDamper(8.0, 2e11, 60e3)),
        "is it a modulus E in Pa",
    ),
    "damper in kN s/m": (
        lambda: with_effect(mr.Damper(8.0, 20.0)),
        r"c = 20 N s/m bears 59.4 N at 3 m/s, at which the wall falls, and it weighs 2.01e\+06 N: is it in kN s/m\?",
    ),
    "damper that holds as if rigid": (
        lambda: with_effect(mr.Damper(8.0, 1e9)),
        r"bears 2.97e\+09 N .* is it in N s/m\?",
    ),
    "load in another unit": (
        lambda: mr.Case(SMALL, 0.05, 1.0, effects=mr.Load(9e7, 4.0)),
        r"force = 9e\+07 N, and the wall weighs 7.06e\+04 N: is it in N",
    ),
    "a wall that nothing moves": (
        lambda: mr.solve_analytical(mr.Case(WALL, 0.0, 1.0), E),
        r"theta0 = 0, omega0 = 0, motion = None and vertical = None: nothing moves the wall",
    ),
    "a wall that nothing moves in MuJoCo": (lambda: mr.simulate(mr.Case(WALL, 0.0, 0.01), contacts()), "nothing moves"),
    "a wall that nothing moves in SciPy": (
        lambda: mr.solve_compliant(mr.Case(WALL, 0.0, 0.01), contacts()),
        "nothing moves the wall",
    ),
    "a wall that nothing moves in explicit steps": (
        lambda: mr.solve_explicit(mr.Case(WALL, 0.0, 0.01), contacts()),
        "nothing moves the wall",
    ),
    "E as stiffness": (lambda: with_effect(mr.Tie(8.0, 210e9, strength=80e3)), r"2.1e\+11 N/m is above 1e\+10 N/m"),
    "density in N/m3": (
        lambda: mr.Block.from_size(0.9, 12.0, 10.0, 19000.0),
        r"density = 19000 kg/m3, and stone has up to 4000 kg/m3",
    ),
    "xi in percent": (
        lambda: mr.Contacts.from_damping(WALL, k_base=1e9, xi_base=0.5),
        "xi = 0.5 is 50% of critical, and the laws end at 30%",
    ),
    "a run shorter than its record": (
        lambda: case(duration=3.0),
        r"the run of 3 s ends before the record of 12 s, and leaves out 76% of its Arias intensity",
    ),
    "e of the full face with a partial stop": (
        lambda: mr.Analysis(case(side_stop=mr.SideStop(9.0)), "analytical", e=E),
        r"a side stop up to 12 m, and this one reaches 9 m; .*stop_top=9\)",
    ),
    "contacts of the full face with a partial stop": (
        lambda: mr.wall_scene(mr.Case(WALL, 0.01, 1.0, side_stop=mr.SideStop(9.0)), contacts()),
        "the damping was chosen for a side stop up to 12 m, and that of the case reaches 9 m",
    ),
    "a tie at mid-height": (
        lambda: with_effect(mr.Tie(6.0, 12e6, strength=200e3)),
        r"the highest tie holds at 6 m of 12 m: the part above it, 0.9 m thick, starts to rock on its own weight at "
        r"0.15 g, and the wall at 0.174 g, its ties at their strength",
    ),
    "a tie at mid-height that does not yield": (
        lambda: with_effect((mr.Tie(6.0, 12e6), mr.Tie(3.0, 12e6))),
        "at 0.15 g, and the wall never, as its ties do not yield",
    ),
    "a low stop on a base that holds": (
        lambda: against(0.55),
        r"the side stop reaches 2.2 m, and one below 2.5\d+ m pushes the base outwards; .* friction 0.6",
    ),
    "a low stop in the contact law": (lambda: against(0.55, mr.solve_compliant), "the side stop reaches 2.2 m"),
    "e of another wall": (
        lambda: mr.Analysis(case(), "analytical", e=mr.Restitution.from_geometry(SMALL)),
        r"of a wall of alpha = 0.2213 rad, and this one has 0.07486 rad",
    ),
    "e of another wall in a call": (
        lambda: mr.solve_analytical(mr.Case(SMALL, 0.01, 0.5), E),
        r"of a wall of alpha = 0.07486 rad, and this one has 0.2213 rad",
    ),
    "e of another wall in an analysis that runs": (
        lambda: mr.Analysis(mr.Case(SMALL, 0.01, 0.5), "analytical", e=E).solve(),
        r"of a wall of alpha = 0.07486 rad",
    ),
    "e of another wall in the law": (
        lambda: mr.Contacts.from_law(WALL, mr.Restitution.from_geometry(mr.Block.from_size(1.0, 12.0)), 1e9, 1e9),
        r"of a wall of alpha = 0.08314 rad",
    ),
}


def test_a_dashpot_without_a_linear_part_is_doubted_by_its_force(monkeypatch):
    """3e-3 N s2/m2 times the square of 3 m/s are little beside a wall of 2 MN."""
    monkeypatch.setattr(plausibility, "resistance", lambda law, rate: 3e-3 * rate * rate)
    with pytest.warns(mr.Implausible, match=r"its dashpot bears 0.0265 N at 3 m/s, .*: is it in N and m/s\?"):
        with_effect(mr.Tie(8.0, 20e6))


@pytest.mark.parametrize("name", MISUSE)
@pytest.mark.filterwarnings("default")
def test_misuse_is_said_once_with_both_numbers(name):
    call, text = MISUSE[name]
    with pytest.warns(UserWarning, match=text) as caught:
        call()
    assert len(caught) == 1, [str(one.message) for one in caught]


def test_forces_at_rest_and_what_a_wall_can_do_are_no_doubt():
    """A run of forces at rest is meant; and devices are not doubted just within the limits of what is."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mr.simulate(mr.Case(WALL, 0.0, 0.01), contacts(), forces=True)
        mr.solve_explicit(mr.Case(WALL, 0.0, 0.01), contacts(), forces=True)
        held = mr.Tie(10.0, 2e9, slack=0.05, strength=1e6, ultimate=0.05), mr.Damper(10.0, 1e6)
        with_effect((*held, mr.FrictionDamper(10.0, 2e7, 60e3), mr.Damper(10.0, 0.0)))


def test_a_tie_above_a_strong_part_is_no_doubt():
    """A tie higher up, a weak one, and one below a part that is thick enough."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with_effect((mr.Tie(6.0, 12e6), mr.Tie(7.2, 12e6)))
        with_effect(mr.Tie(6.0, 12e6, strength=100e3))
    stepped = mr.Block.from_size(0.9, 12.0, 10.0, 1900.0, profile=[(0, 0.9), (4, 0.9), (4, 0.3), (12, 0.3)])
    with pytest.warns(mr.Implausible, match=r"the part above it, 0.3 m thick, starts .* at 0.05 g"):
        mr.Case(stepped, 0.0, 1.0, effects=mr.Tie(6.0, 12e6, strength=100e3))


def test_a_low_stop_is_no_doubt_on_a_base_that_slides_nor_is_a_higher_one():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        against(0.55, friction=0.6)
        against(0.7)


def test_low_scales_of_a_study_are_meant():
    def build(scale):
        return mr.Analysis(case(motion=RECORD.scaled(peak=scale)), "analytical", e=E, options={"rtol": 1e-4})

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ida.built(build, 0.3, "build").case.motion.peak == pytest.approx(0.3)
        mr.Capacity(mr.Analysis(case(), "analytical", e=E)).scaled(0.1)


def plausible(rng):
    """A façade as an engineer has it, with its effects, under a record or released."""
    thickness = rng.uniform(0.3, 1.2)
    height = thickness * rng.uniform(5, 15)
    length, density = rng.uniform(1, 12), rng.uniform(1300, 2600)
    gable = (
        mr.Gable(rng.uniform(0.1, 0.3) * height, top=rng.choice([0.0, 0.3 * length])) if rng.random() < 0.3 else None
    )
    openings = (
        [mr.Opening(rng.uniform(0.2, 0.4) * length, rng.uniform(0.2, 0.4) * height)] if rng.random() < 0.4 else []
    )
    if rng.random() < 0.3:
        wide = rng.uniform(0.15, 0.3) * min(length, height)
        openings.append(mr.Opening(wide, wide, sill=rng.uniform(0.42, 0.5) * height, round=True))
    options = {"inset": rng.choice([0.0, 0.02]), "openings": openings, "gable": gable}
    wall = mr.Block.from_size(thickness, height, length, density, **options)
    effects = []
    if rng.random() < 0.3:
        bar = (
            rng.uniform(0.4, 1.0) * height,
            rng.uniform(0.012, 0.036),
            rng.choice([235e6, 355e6, 450e6]),
            rng.uniform(1, 12),
        )
        masonry = {"shear_strength": rng.uniform(20e3, 100e3), "compressive_strength": rng.uniform(1e6, 5e6)}
        chosen = {
            "number": int(rng.integers(1, 4)),
            "ultimate": rng.choice([0.02, 0.1]),
            "slack": rng.choice([0.0, 0.005]),
        }
        effects.append(mr.Tie.of_bar(*bar, plate=rng.uniform(0.15, 0.4), thickness=thickness, **masonry, **chosen))
    elif rng.random() < 0.5:
        section, reach = np.pi / 4 * rng.uniform(0.012, 0.036) ** 2, rng.uniform(1, 12)
        effects.append(
            mr.Tie(
                rng.uniform(0.4, 1.0) * height,
                210e9 * section / reach,
                slack=rng.choice([0.0, 0.005, 0.02]),
                strength=rng.choice([np.inf, rng.uniform(100e6, 450e6) * section]),
                length=reach,
            )
        )
    if rng.random() < 0.3:
        effects.append(mr.Thrust(rng.uniform(0.5, 1) * height, rng.uniform(0.002, 0.02) * wall.weight))
    if rng.random() < 0.3:
        effects.append(mr.Load(rng.uniform(0.02, 0.5) * wall.weight, height, rng.uniform(-0.3, 0.3) * thickness))
    if rng.random() < 0.3:
        effects.append(mr.AddedMass(rng.uniform(0.005, 0.2) * wall.mass, height))
    held = rng.uniform(0.6, 1.0) * height
    if rng.random() < 0.15:
        effects.append(mr.Damper(held, rng.uniform(0.02, 0.6) * 2 * wall.mass * wall.p))
    if rng.random() < 0.15:
        effects.append(mr.FrictionDamper(held, rng.uniform(2, 50) * 1e6, rng.uniform(0.005, 0.1) * wall.weight))
    share = rng.choice([1.0, rng.uniform(0.75, 0.95)])
    stop = True if share == 1 else mr.SideStop(share * height)
    requested = {"side_stop": stop, "effects": tuple(effects)}
    if rng.random() < 0.3:
        return mr.Case(wall, rng.uniform(0.1, 0.8) * wall.alpha, rng.uniform(1, 5), **requested), stop
    duration = rng.uniform(5, 30)
    motion = mr.GroundMotion.synthetic(9.81 * rng.uniform(0.1, 0.8), duration, seed=int(rng.integers(1000)), dt=0.02)
    return mr.Case(wall, 0.0, duration * rng.uniform(0.9, 1.5), motion=motion, **requested), stop


@pytest.mark.slow
def test_two_thousand_plausible_cases_raise_no_false_alarm():
    """Peaks of 0.1 to 0.8 g, walls of 0.3 to 1.2 m and a slenderness of 5 to 15; less than 0.5 % warn.

    A tie as low as 0.4 of the height is warned of rightly where the part above it is the weaker: that is not an alarm.
    """
    rng = np.random.default_rng(0)
    alarms, made, low = [], 0, []
    while made < 2000:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                requested, stop = plausible(rng)
                e = mr.Restitution.from_geometry(requested.wall, stop_top=None if stop is True else stop.top)
                mr.Analysis(requested, "analytical", e=e)
            except ValueError:
                continue  # effects that overturn the wall as it stands
        made += 1
        complaint = [str(one.message) for one in caught if issubclass(one.category, mr.Implausible)]
        alarms += [text for text in complaint if not text.startswith("the highest tie holds at ")]
        low += [requested for text in complaint if text.startswith("the highest tie holds at ")]
    print(f"{len(alarms)} alarms in {made} cases, and {len(low)} whose tie is too low")
    assert all(requested.each(mr.Tie)[0].height < 1.2 * requested.wall.h for requested in low)
    assert len(alarms) < 0.005 * made, alarms[:5]


@pytest.mark.parametrize(("kept", "complaint"), [(0.05, ">99%"), (0.5, "80%"), (0.0, "100%")])
def test_all_of_a_record_is_only_what_is_all_of_it(kept, complaint):
    """Accelerations of 1 and 2 with the kept sample: the share of the sum of their squares that is left out."""
    accel = np.zeros(200)
    accel[10], accel[150] = kept, 1.0
    with pytest.warns(mr.Implausible, match=f"leaves out {complaint} of its Arias"):
        mr.Case(WALL, 0.01, 1.0, motion=mr.GroundMotion(accel, 0.01))
