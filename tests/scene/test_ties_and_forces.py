"""Ties and constant forces of a scene, against closed forms, and in stock MuJoCo."""

import math

import mujoco
import numpy as np
import pytest
from scenes import changed, course, fixed_steps, stock_takes

import mjrock as mr
from mjrock.engine.energy_work import ledger
from mjrock.engine.mjcf import scene_mjcf
from mjrock.engine.model import engine_of, released_mjcf
from mjrock.engine.stepping import fitted_steps
from mjrock.problem.wall.effect import LinkLaw
from mjrock.scene.parts import ConstantForces, Links
from mjrock.scene.wall import wall_scene


def scene_with(scene, **parts):
    """A scene with other parts, which settles anew."""
    return changed(scene, settled=None, **parts)


def tie(anchor, held, *, k=2e6, slack=0.0, strength=math.inf, name="tie"):
    """The link of a tie from the ground to a point of the first body, at rest at `held` about its centroid."""
    (point, rest), length = held, math.dist(anchor, np.add(*held))
    assert rest is not None
    return {"links": Links((name,), [0], [point], [-1], [anchor], [LinkLaw(k, length + slack, strength)])}


def with_law(scene, **numbers):
    """Fields of the one link of a scene, by another law."""
    return {"law": [LinkLaw(*scene.links.law[0])._replace(**numbers)]}


def pull(force, point, name="pull"):
    return {"forces": ConstantForces((name,), [0], [point], [force])}


def run(scene, course, accuracy=1e-3, timestep=None):
    if timestep is not None:
        return fixed_steps(scene, course, timestep)
    with engine_of(scene) as engine:
        engine.place(course)
        return fitted_steps(engine, scene, course, accuracy)


def away(scene):
    """Half a second that starts at 0.5 m/s outwards."""
    return course(scene, [[0.5, 0.0, 0.0]], 0.5)


@pytest.fixture
def standing(wall, contacts):
    """The wall on its base, without a side stop."""
    return wall_scene(mr.Case(wall, 0.0, 1.0, side_stop=False), contacts)


@pytest.fixture
def sliding(standing):
    """The wall on a base without friction, tied to an anchor 5 m behind its centroid."""
    rest = standing.bodies.rest[0]
    return scene_with(
        standing, contacts={"friction": [0.0, 0.0]}, **tie((-5.0, rest[1]), ((0.0, 0.0), rest), slack=0.02)
    )


def test_what_is_not_there_is_not_in_the_text(standing):
    text = released_mjcf(standing, course(standing), 1e-3)
    for word in ("tendon", "spatial", "actuator", "site"):
        assert word not in text
    model = mujoco.MjModel.from_xml_string(text)
    assert (model.ntendon, model.nu, model.nsite, model.nplastic) == (0, 0, 0, 0)


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-5])
def test_a_tie_stops_a_mass_as_a_spring_does(sliding, accuracy):
    """After the slack, half a sine: x = slack + v/omega sin(omega t)."""
    steps = run(sliding, away(sliding), accuracy)
    x, omega = steps.pose[:, 0], math.sqrt(2e6 / sliding.bodies.mass[0])
    inside = steps.t - 0.02 / 0.5
    pulled = (inside > 0) & (inside < math.pi / omega)
    exact = np.where(pulled, 0.02 + 0.5 / omega * np.sin(omega * inside), 0.5 * steps.t)
    exact = np.where(inside > math.pi / omega, 0.02 - 0.5 * (inside - math.pi / omega), exact)
    assert np.abs(x - exact).max() < 2 * accuracy * 0.5 / omega
    assert steps.touches >= 1
    assert steps.record.before[-1, 0] == pytest.approx(-0.5, rel=accuracy)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_a_yielding_tie_takes_its_strength_times_its_plastic_elongation(sliding, accuracy):
    """m v^2/2 = T^2/(2 k) + T u at the farthest, and T^2/(2 k) is given back."""
    strength = 2e4
    scene = changed(sliding, links=with_law(sliding, strength=strength))
    steps = run(scene, away(scene), accuracy)
    books = ledger(scene, away(scene), steps)
    given = 0.5 * scene.bodies.mass[0] * 0.5**2
    elastic = strength**2 / (2 * 2e6)
    assert books.ties["tie"][-1] == pytest.approx(given - elastic, rel=2 * accuracy)
    farthest = 0.02 + strength / 2e6 + (given - elastic) / strength
    assert steps.pose[:, 0].max() == pytest.approx(farthest, rel=accuracy)
    assert 0.5 * scene.bodies.mass[0] * steps.record.before[-1, 0] ** 2 == pytest.approx(elastic, rel=20 * accuracy)
    assert np.abs(books.residual).max() < 3 * accuracy * given


def test_stock_mujoco_yields_as_the_ledger_says(sliding):
    """The text alone has the tie, its slack and its strength: MuJoCo's own plastic state is the ledger's."""
    scene = changed(sliding, links=with_law(sliding, strength=2e4))
    steps = run(scene, away(scene), timestep=1e-4)
    data = stock_takes(steps.pose, released_mjcf(scene, away(scene), 1e-4), 1e-12)
    elongation = float(np.ravel(data.plastic)[1]) - scene.links.sprung.law["reach"][0]
    assert ledger(scene, away(scene), steps).ties["tie"][-1] == pytest.approx(2e4 * elongation, rel=1e-6)
    assert elongation > 0.02


def test_a_force_keeps_its_direction_and_follows_its_point(standing, wall):
    """Pushed below the threshold of uplift, the wall leans as its springs let it: M = 2 k b^2 theta - m g h theta."""
    share = 0.5
    top = (0.0, wall.h)
    force = share * wall.weight * wall.b / (2 * wall.h)
    pushed = scene_with(standing, **pull((force, 0.0), top))
    lean = pushed.at_rest[0, 2]
    k, weight = standing.contacts.k[0], wall.weight
    stiffness = 2 * k * wall.b**2 - weight * wall.h
    assert lean == pytest.approx(force * 2 * wall.h / stiffness, rel=1e-4)
    steps = run(pushed, course(pushed))
    # long steps hold the edges with dashpots, and each correction of their creep stirs the wall a little
    assert np.abs(steps.pose[:, 2] / lean - 1).max() < 3e-4
    assert np.abs(steps.pose[:, 0] - pushed.at_rest[0, 0]).max() < 1e-5


@pytest.mark.parametrize(("share", "rocks"), [(0.98, False), (1.02, True)])
def test_the_multiplier_at_which_rocking_starts(standing, wall, share, rocks):
    """lambda_0: a force at the top overturns where F 2h = m g b."""
    force = share * wall.weight * wall.b / (2 * wall.h)
    pushed = scene_with(standing, **pull((force, 0.0), (0.0, wall.h)))
    if rocks:
        with pytest.raises(ValueError, match="do not stand"):
            _ = pushed.at_rest
    else:
        assert 0 < pushed.at_rest[0, 2] < 10 * wall.alpha * wall.weight / (2 * standing.contacts.k[0] * wall.b)


def test_energy_of_forces_and_ties_adds_up(standing, wall):
    """A wall tilted, pushed and tied, in free rocking: what dashpots and friction do not take is still there."""
    parts = pull((-4e2, -5e3), (0.1, wall.h)) | tie(
        (-4.0, 3.0), ((wall.b, wall.h - 1.0), standing.bodies.rest[0]), k=5e6, slack=0.01
    )
    scene = scene_with(standing, **parts)
    tilted = scene.lowered(wall.pose(np.array([-0.4 * wall.alpha])))
    released = course(scene, duration=3.0, pose=tilted)
    energy = released.energy(scene)
    for accuracy in (1e-3, 1e-5):
        steps = run(scene, released, accuracy)
        books = ledger(scene, released, steps)
        assert np.abs(books.residual).max() < 5 * accuracy * energy + 2e-4 * energy
    assert steps.touches > 5
    assert books.elastic.max() > 0.1 * energy  # the tie was taut


@pytest.mark.parametrize(
    ("parts", "complaint"),
    [
        ({"k": -1.0}, "k of the links = -1 is outside the valid range, which starts at 0"),
        ({"strength": -1.0}, "strength of the links = -1 is outside"),
        ({"strength": math.nan}, "strength of the links holds a value that is not finite"),
        ({"reach": math.inf}, "reach of the links is infinite for a link with a spring"),
        ({"push": math.inf}, "push of the links holds a value that is not finite"),
        ({"anchor_body": [0]}, "anchor_body of the links is another body"),
        ({"body": [1]}, "body of the links is outside the valid range 0 to 0"),
        ({"at": [(0.0,)]}, r"anchor_at of the links has the shape \(1, 2\); \(1, 1\) is needed"),
        ({"names": ("wall",)}, "wall names two things"),
    ],
)
def test_links_that_cannot_be_are_refused(sliding, parts, complaint):
    with pytest.raises(ValueError, match=complaint):
        changed(sliding, links=with_law(sliding, **parts) if parts.keys() <= set(LinkLaw._fields) else parts)


@pytest.mark.parametrize("laws", [[2e6], ["k"], [LinkLaw("k")], [(1.0,) * 9], 2e6])
def test_links_without_laws_are_refused(laws):
    with pytest.raises(TypeError, match=r"law of the links = .* does not hold a LinkLaw for each"):
        Links(("tie",), [0], [(0.0, 0.0)], [-1], [(-5.0, 1.0)], laws)


def test_forces_that_cannot_be_are_refused(sliding):
    with pytest.raises(ValueError, match="force of the forces holds a value that is not finite"):
        pull((math.nan, 0.0), (0.0, 0.0))
    with pytest.raises(ValueError, match="tie names two things"):
        changed(sliding, **pull((1.0, 0.0), (0.0, 0.0), "tie"))


def test_names_of_ties_and_forces_in_the_text(standing, wall):
    held = tie((-5.0, 1.0), ((0.0, 0.0), standing.bodies.rest[0]), strength=1e4)
    scene = scene_with(standing, **held, **pull((1.0, 2.0), (0.0, wall.h)))
    model = mujoco.MjModel.from_xml_string(scene_mjcf(scene, 1e-3))
    assert model.tendon_lengthspring[0].tolist() == [0.0, scene.links.sprung.law["reach"][0]]
    assert model.actuator_gear[0, :3].tolist() == [1.0, 0.0, 2.0]
    assert (model.tendon(0).name, model.actuator(0).name) == ("tie", "pull")
    assert (model.ntendon, model.nu, model.nplastic) == (1, 1, 2)


def test_a_tie_that_the_release_has_stretched_too_far_has_yielded_by_then(wall, contacts):
    """MuJoCo lets a tie yield at the end of a step. The first step had its elastic force, a thousand times too much."""
    held = mr.Tie(height=wall.h, stiffness=1e8, strength=5e3)
    case = mr.Case(wall, 0.5 * wall.alpha, 0.02, effects=(held,))
    step = 1e-4
    run = mr.simulate(case, contacts, step)
    lever = wall.h * math.cos(case.theta0) + 2 * wall.b * math.sin(case.theta0)  # of a level pull, about the toe
    free = mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 0.02), contacts, step)
    slowed = (run.omega[5] - free.omega[5]) / run.t[5] * wall.toe_inertia
    assert slowed == pytest.approx(-held.strength * lever, rel=0.05)
    stock_takes(run.pose, mr.wall_mjcf(case, contacts, step), 1e-9 * wall.alpha)
