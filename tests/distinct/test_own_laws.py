"""Laws of joints that are classes in a file of one's own: closed forms, an own integration, and the accounts."""

import math
from dataclasses import replace

import numpy as np
import own_laws as laws
import pytest
from everyday import among, crossed, slow
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import mjrock as mr
from mjrock.study.campaign.task import fingerprint

K, A, MASS, GRAVITY = 1e9, 2e-5, 2000.0, 9.81
BED = mr.Dry(k_n=K, k_s=K, friction=0.6, points=5)
BOTH = pytest.mark.parametrize("in_space", [False, True])


def block(dry, in_space=False):
    """A cube of a metre on the ground."""
    if in_space:
        ground = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True, name="ground")
        return mr.Masonry([ground, mr.Polyhedron.box((1, 1, 1), (0, 0, 0.5))], joints=replace(dry, points=3))
    ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True, name="ground")
    return mr.Masonry([ground, mr.Polygon([(0, 0), (1, 0), (1, 1), (0, 1)])], joints=dry)


def run(dry, duration, speed=0.0, in_space=False, **options):
    """The cube, thrown up at a speed; its height over the ground, its velocity, and the answer."""
    velocity = [[0, 0, speed, 0, 0, 0]] if in_space else [[0, speed, 0]]
    settled = options.pop("settled", True)
    case = mr.MasonryCase(block(dry, in_space), duration, velocity=velocity if speed else None, settled=settled)
    answer = mr.solve_explicit(case, ledger=True, forces=True, **options)
    up = 2 if in_space else 1
    return answer.pose[:, 0, up], answer.velocity[:, 0, up], answer


def unpaid(answer):
    return float(np.abs(answer.ledger.residual).max())


CLOSING = {
    laws.Linear(): MASS * GRAVITY / K,
    laws.Stiffening(a=A): 0.5 * A * (math.sqrt(1 + 4 * MASS * GRAVITY / (K * A)) - 1),
    laws.Hertz(a=A): (MASS * GRAVITY / K * math.sqrt(A)) ** (2 / 3),
}


@pytest.mark.parametrize(("law", "in_space"), crossed(list(CLOSING), [True, False]))
def test_a_block_rests_as_deep_as_the_law_says_and_shakes_nothing(law, in_space):
    height, _, answer = run(replace(BED, law=law), 0.02, in_space=in_space, output_step=1e-3)
    assert -height[0] == pytest.approx(CLOSING[law], rel=1e-9)
    assert np.ptp(height) < 1e-9 * CLOSING[law]
    assert answer.forces.normal[-1].sum() == pytest.approx(MASS * GRAVITY, rel=1e-9)
    assert unpaid(answer) < 1e-9


def test_the_stiffening_block_closes_by_12_190_um():
    height, _, _ = run(replace(BED, law=laws.Stiffening(a=A)), 0.01)
    assert -height[0] * 1e6 == pytest.approx(12.190088, abs=1e-6)


@BOTH
def test_a_throw_is_as_deep_as_its_energy_allows(in_space):
    dry = replace(BED, xi=0.0, law=laws.Stiffening(a=A))
    height, _, answer = run(dry, 0.01, -0.05, in_space, timestep=1e-5, output_step=1e-5)

    def energy(u):
        return K * u * u * (0.5 + u / (3 * A)) - MASS * GRAVITY * u

    deepest = brentq(lambda u: energy(u) - energy(-height[0]) - 0.5 * MASS * 0.05**2, -height[0], 1e-2)
    assert -height.min() == pytest.approx(deepest, rel=1e-4)
    assert unpaid(answer) < 1e-4 * 0.5 * MASS * 0.05**2


@pytest.mark.parametrize(("push", "slides"), [(0.59, False), (0.61, True)])
def test_friction_has_the_push_of_the_law(push, slides):
    """A block of 19620 N with friction 0.6 holds up to 0.600 g; the linear part of its spring would to 0.373 g."""
    ramp = np.minimum(np.arange(1000) / 500, 1.0) * push * GRAVITY
    case = mr.MasonryCase(block(replace(BED, law=laws.Stiffening(a=A))), 0.9, motion=mr.GroundMotion(ramp, 1e-3))
    moved = abs(mr.solve_explicit(case, output_step=1e-2).pose[-1, 0, 0])
    assert (moved > 3e-3) == slides
    assert slides or moved < 2e-4


@pytest.mark.parametrize("law", among([laws.Linear(), laws.Stiffening(a=A), laws.Hertz(a=A)], laws.Hertz(a=A)))
def test_a_block_that_slides_off_its_joint_stays_at_its_height(law):
    """It slides by Coulomb's friction over contacts that are found, as deep as it was at rest."""
    stone = mr.Polygon([(-2, -1), (3, -1), (3, 0), (-2, 0)], fixed=True)
    cube = mr.Polygon([(-0.5, 0), (0.5, 0), (0.5, 1), (-0.5, 1)], density=2000.0)
    masonry = mr.Masonry([stone, cube], joints=mr.Dry(K, k_s=K, friction=0.1, law=law))
    case = mr.MasonryCase(masonry, 0.8, velocity=[[2.0, 0, 0]])
    answer = mr.solve_explicit(case, output_step=0.1, ledger=True)
    x, z = answer.pose[:, 0, :2].T
    assert x[-1] == pytest.approx(2.0 * 0.8 - 0.05 * GRAVITY * 0.8**2, rel=1e-3)
    assert z[-1] == pytest.approx(z[0], rel=2e-3)
    assert unpaid(answer) < 1e-6 * 0.5 * MASS * 2.0**2


@pytest.mark.parametrize(("speed", "resistance"), [(0.5, 0.4), slow((0.5, 2.0)), (1.0, 2.0), slow((2.0, 0.5))])
def test_hunt_and_crossley_rebounds_as_an_ode_does(speed, resistance):
    """Thrown by a metre a second and more the block has left its joint, and lands on contacts that are found."""
    dry = replace(BED, xi=0.0, law=laws.HuntCrossley(resistance=resistance))
    duration = 2 * speed / GRAVITY + 0.05
    _, rate, answer = run(dry, duration, speed, timestep=2e-5, output_step=1e-4, settled=False)
    lands = int(np.argmin(rate))

    def landing(_, y):
        return [y[1], GRAVITY - K / MASS * max(y[0], 0.0) * max(1 + resistance * y[1], 0.0)]

    ode = solve_ivp(landing, (0, 0.03), [0.0, speed], rtol=1e-10, atol=1e-14, max_step=1e-4)
    assert rate[lands:].max() == pytest.approx(-ode.y[1].min(), rel=1e-3)
    assert unpaid(answer) < 1e-9 * 0.5 * MASS * speed**2
    taken = answer.ledger.dashpots
    assert sum(each[-1] for each in taken.values()) == pytest.approx(
        0.5 * MASS * (speed**2 - rate[lands:].max() ** 2), rel=5e-3
    )


@pytest.mark.parametrize("k_s", [K, None])
def test_a_law_that_is_that_of_a_dry_joint_is_a_dry_joint(k_s):
    """A column that rocks, opens and strikes: touches, friction, ends of faces and accounts are those of dry lines."""
    ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True)
    drums = [mr.Polygon([(0, z), (0.4, z), (0.4, z + 0.5), (0, z + 0.5)]) for z in (0.0, 0.5, 1.0)]
    answers = []
    for law in (None, laws.Linear()):
        masonry = mr.Masonry([ground, *drums], joints=mr.Dry(k_n=K, k_s=k_s, friction=0.5, points=4, law=law))
        case = mr.MasonryCase(masonry, 0.5, velocity=[[0.15, 0, 0]] * 3)
        answers.append(mr.solve_explicit(case, output_step=1e-2, ledger=True, forces=True))
    dry, own = answers
    assert own.stats["timestep"] == dry.stats["timestep"]
    assert np.ptp(dry.pose[..., 0]) > 5e-3
    np.testing.assert_allclose(own.pose, dry.pose, rtol=0, atol=1e-13)
    np.testing.assert_allclose(own.forces.normal, dry.forces.normal, rtol=1e-9, atol=1e-6)
    for name in ("elastic", "friction", "kinetic"):
        np.testing.assert_allclose(getattr(own.ledger, name), getattr(dry.ledger, name), rtol=0, atol=1e-9)


GLUE = laws.Cohesive(strength=1e5, toughness=20.0)


@BOTH
def test_glue_takes_its_energy_and_lets_go(in_space):
    """A block that is torn off has lost the toughness of its area; the ledger has it under tension."""
    dry = replace(BED, xi=0.0, law=GLUE)
    height, rate, answer = run(dry, 0.01, 0.2, in_space, timestep=5e-6, output_step=1e-4)
    left = 0.5 * MASS * rate[-1] ** 2 + MASS * GRAVITY * (height[-1] - height[0])
    assert 0.5 * MASS * 0.2**2 + 0.5 * K * height[0] ** 2 - left == pytest.approx(20.0, rel=2e-3)
    assert answer.ledger.bonds["tension"][-1] == pytest.approx(20.0, rel=2e-3)
    assert answer.forces.damage[-1, 0] == pytest.approx(1.0, abs=1e-3)
    assert answer.forces.normal.min() > -1.001e5
    assert unpaid(answer) < 1e-3


def test_glue_holds_a_block_that_is_thrown_less():
    """It swings about its pose of rest, and comes back."""
    dry = replace(BED, xi=0.0, law=GLUE)
    height, _, answer = run(dry, 0.02, 0.02, timestep=1e-5, output_step=1e-4)
    swing = 0.02 * math.sqrt(MASS / K)
    assert height.max() - height[0] == pytest.approx(swing, rel=1e-3)
    assert height[0] - height.min() == pytest.approx(swing, rel=1e-3)
    assert answer.forces.damage.max() == 0.0
    assert unpaid(answer) < 1e-6


def test_a_run_that_carries_on_remembers_its_cracks():
    dry = replace(BED, law=GLUE)
    case = mr.MasonryCase(block(dry), 0.002, velocity=[[0.03, 0.12, 0.1]])
    whole = mr.solve_explicit(replace(case, duration=0.004), timestep=1e-5, output_step=1e-4, forces=True)
    first = mr.solve_explicit(case, timestep=1e-5, output_step=1e-4)
    second = mr.solve_explicit(
        replace(case, velocity=None), timestep=1e-5, output_step=1e-4, forces=True, start=first.end
    )
    assert 0.05 < whole.forces.damage[-1].max() < 0.99
    np.testing.assert_allclose(second.pose[-1], whole.pose[-1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(second.forces.damage[-1], whole.forces.damage[-1], rtol=1e-9)


@pytest.mark.parametrize(
    "dry",
    [
        replace(BED, law=replace(GLUE, strength=1.2e5)),
        replace(BED, law=None),
        mr.Mortar(BED, mr.Bond(2e5, 3e5, 13.0, 130.0)),
    ],
)
def test_a_run_that_carries_on_with_another_law_does_not_drop_the_memory_silently(dry):
    """Nor does mortar, by which a crack would heal. A pose and a velocity alone begin without a memory."""
    case = mr.MasonryCase(block(replace(BED, law=GLUE)), 0.002, velocity=[[0.03, 0.12, 0.1]])
    cracked = mr.solve_explicit(case, timestep=1e-5, output_step=1e-4).end
    other = mr.MasonryCase(block(dry), 0.0005)
    with pytest.raises(ValueError, match=r"another structure.*the laws of ground\|block_1 remember something"):
        mr.solve_explicit(other, timestep=1e-5, start=cracked)
    again = mr.solve_explicit(other, timestep=1e-5, start=(cracked.pose, cracked.velocity), forces=True)
    assert np.nan_to_num(again.forces.damage[0]).max() < 0.5


def test_a_law_without_a_memory_goes_on_as_another_one():
    case = mr.MasonryCase(block(replace(BED, law=laws.Stiffening(a=A))), 0.001, velocity=[[0, 0.02, 0]])
    end = mr.solve_explicit(case, timestep=1e-5).end
    softer = mr.MasonryCase(block(replace(BED, law=laws.Stiffening(a=2 * A))), 0.001)
    assert mr.solve_explicit(softer, timestep=1e-5, start=end).t[-1] == 0.001


def test_the_energy_of_an_undamped_throw_is_of_second_order_in_the_step():
    """The kinetic energy of a sample is that which the steps keep with a linear spring. A spring that stiffens changes
    within a step, and what is missing falls with the square of it; the block leaves as fast as it came."""
    dry, missing = replace(BED, xi=0.0, law=laws.Stiffening(a=A)), []
    for step in (2e-5, 1e-5, 5e-6):
        _, velocity, answer = run(dry, 0.01, -0.1, timestep=step, output_step=step)
        missing.append(unpaid(answer) / (0.5 * MASS * 0.1**2))
        assert velocity.max() == pytest.approx(0.1, rel=1e-4)
    assert missing[0] < 2e-4
    assert np.log2(missing[:-1]) - np.log2(missing[1:]) == pytest.approx(2.0, abs=0.05)


def test_the_step_that_a_message_names_is_not_far_too_short():
    """A block is thrown at a joint that gets much stiffer than at rest. A message names a tenth of the step at least:
    the step that is short enough is found within a factor of ten."""
    dry, step, named = replace(BED, xi=0.0, law=laws.Stiffening(a=1e-8)), 8e-5, []
    while step not in named:
        try:
            answer = run(dry, 0.005, -2.0, timestep=step)[2]
            break
        except RuntimeError as error:
            named.append(step)
            shorter = float(str(error).split("timestep = ")[1].split(" s")[0])
            assert shorter >= 0.099 * step
            step = shorter
    assert named
    assert answer.stats["timestep"] == step


def test_each_joint_may_have_a_law_of_its_own_beside_dry_ones_and_mortar():
    """Each cube of a tower closes its joint as its own law says under what stands on it."""
    ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True, name="ground")
    cubes = [mr.Polygon([(0, z), (1, z), (1, z + 1), (0, z + 1)], name=f"cube_{z}") for z in range(4)]
    mortar = mr.Mortar(BED, mr.Bond(2e5, 3e5, 13.0, 130.0))
    of = [replace(BED, law=laws.Stiffening(a=A)), BED, replace(BED, law=laws.Hertz(a=A)), mortar]
    masonry = mr.Masonry([ground, *cubes], joints=lambda joint: of[joint.above - 1])
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.01), forces=True, output_step=1e-3)
    closings = -np.diff(answer.pose[0, :, 1], prepend=0.0)
    p = MASS * GRAVITY * np.array([4, 3, 2, 1])
    exact = [0.5 * A * (math.sqrt(1 + 4 * p[0] / (K * A)) - 1), p[1] / K, (p[2] / K * A**0.5) ** (2 / 3), p[3] / K]
    np.testing.assert_allclose(closings, exact, rtol=1e-8)
    np.testing.assert_allclose(answer.forces.normal[-1], p, rtol=1e-6)
    assert np.ptp(answer.pose[..., 1], axis=0).max() < 1e-9


@pytest.mark.parametrize("points", [2, 16])
def test_a_law_is_that_of_an_area(points):
    height, _, _ = run(replace(BED, points=points, law=laws.Stiffening(a=A)), 0.001)
    assert -height[0] * 1e6 == pytest.approx(12.190088, abs=1e-6)


def law_of(**methods):
    """A law with these methods beside those of a dry joint."""
    texts = {name: getattr(laws.Linear, name) for name in ("stress", "energy")}
    return mr.joint_law(type("Mine", (), {"__annotations__": {}, **texts, **methods}))


WRONG = {
    r"Mine has no energy\(self, u\); a law of a joint has stress and energy": {"energy": None},
    r"Mine.stress\(self\) is needed as stress\(self, u\)": {"stress": lambda self: 0.0},
    r"Mine.damping\(self, u\) is needed as damping\(self, u, rate\)": {"damping": lambda self, u: 0.0},
    r"Mine.stress is nan at a closing of": {"stress": lambda self, u: math.nan if u > 0 else 0.0},
    r"Mine.energy is .* at a closing of .*, and the integral of stress from 0 is": {
        "energy": lambda self, u: self.k_n * u * u if u > 0 else 0.0
    },
    r"Mine.stress is 7 where a joint is neither closed nor open; 0 is needed": {
        "stress": lambda self, u: 7.0 + max(self.k_n * u, 0.0)
    },
    r"Mine.stress is -.* the law pulls where it is closed": {"stress": lambda self, u: -self.k_n * u},
    r"a dashpot acts against the rate of closing": {"damping": lambda self, u, rate: -u * rate if u > 0 else 0.0},
    r"Mine: .*'b'; the law and its lines have k_n, friction$": {"stress": lambda self, u: self.b * u},
    r"Mine.dampening is never called; a law of a joint has stress, energy, damping": {"dampening": lambda self, u: 0.0},
    r"Mine has a memory and no remember\(self, u\)": {"memory": ("widest",)},
    r"Mine.memory = 'deepest' is no tuple of names; give memory = \(\"deepest\",\)": {
        "memory": "deepest",
        "remember": lambda self, u: None,
    },
    r"Mine fails at a closing of .* ZeroDivisionError": {"stress": lambda self, u: u / 0},
}


@pytest.mark.parametrize("complaint", WRONG)
def test_what_is_no_law_is_named(complaint):
    methods = WRONG[complaint]
    with pytest.raises((TypeError, ValueError), match=complaint) as error:
        mr.Dry(law=law_of(**methods)())
    assert "\n" not in str(error.value)


def test_a_law_that_turns_within_a_small_part_of_the_closing_has_the_integral_as_its_energy():
    """k u exp(-u / s) with s of 50 um, beside closings of up to millimetres."""
    scale = 5e-5
    law = law_of(
        stress=lambda self, u: self.k_n * u * math.exp(-u / scale) if u > 0 else 0.0,
        energy=lambda self, u: self.k_n * scale**2 * (1 - (1 + u / scale) * math.exp(-u / scale)) if u > 0 else 0.0,
    )
    assert mr.Dry(k_n=1e10, law=law()).law == law()


def test_runs_that_are_stored_know_a_law_whose_formula_has_been_changed():
    first, same, other = (
        law_of(stress=lambda self, u: 1.0 * self.k_n * u if u > 0 else 0.0),
        law_of(stress=lambda self, u: 1.0 * self.k_n * u if u > 0 else 0.0),
        law_of(stress=lambda self, u: 2.0 * self.k_n * u if u > 0 else 0.0),
    )
    assert fingerprint(first()) == fingerprint(same()) != fingerprint(other())


def test_a_law_that_fails_in_a_run_is_named_with_its_joint():
    """Beyond the closings for which it was checked."""
    law = law_of(stress=lambda self, u: self.k_n * u / (u < 2e-3) if u > 0 else 0.0)
    with pytest.raises(RuntimeError, match=r"the law Mine of .*ground.* breaks down by t = .* s: its numbers are not"):
        run(replace(BED, law=law()), 0.02, -5.0)


def test_what_a_law_as_plain_python_raises_is_in_the_error_of_the_run(monkeypatch):
    """Beyond the closings for which it was checked."""
    monkeypatch.setenv("MJROCK_INTERPRET", "laws")
    law = law_of(stress=lambda self, u: self.k_n * u * (1 // int(u < 2e-3)) if u > 0 else 0.0)
    with pytest.raises(RuntimeError, match=r"the law Mine of .*ground.* a law raised ZeroDivisionError"):
        run(replace(BED, law=law()), 0.02, -5.0)


def test_a_law_that_pulls_needs_a_shear_stiffness():
    with pytest.raises(ValueError, match=r"law of the joint: Cohesive pulls, and k_s = None; give k_s in N/m3"):
        mr.Dry(law=GLUE)


def test_a_law_and_a_bond_are_one_too_many():
    with pytest.raises(ValueError, match=r"bond = .* on a joint whose law is Stiffening\(a=2e-05\): give one of both"):
        mr.Mortar(replace(BED, law=laws.Stiffening(a=A)), mr.Bond(2e5, 3e5, 13.0, 130.0))


@pytest.mark.parametrize("law", [laws.Stiffening, "Stiffening", 3.0])
def test_a_law_is_an_object_of_a_class_under_joint_law(law):
    with pytest.raises(TypeError, match=r"law = .* is no object of a class under mr.joint_law, such as Law\(a=1.0\)"):
        mr.Dry(law=law)


def test_numbers_of_a_law_are_checked():
    with pytest.raises(TypeError, match="a of Stiffening"):
        laws.Stiffening(a="thin")


def test_solvers_that_do_not_know_it_refuse_it_by_name():
    case = mr.MasonryCase(block(replace(BED, law=laws.Stiffening(a=A))), 0.1)
    with pytest.raises(ValueError, match=r"law of .*ground.*: MuJoCo knows .* no Stiffening; solve_explicit takes"):
        mr.simulate(case)
    assert mr.collapse_multiplier(case.masonry, 1).multiplier == pytest.approx(0.6, abs=1e-6)  # it knows friction
    with pytest.raises(ValueError, match=r"law of .*ground.* pulls: limit analysis knows .*; solve_explicit takes it"):
        mr.collapse_multiplier(block(replace(BED, law=GLUE)), 1)
