"""Named scenes of every solver, and the numbers that each answers.

A scene is a function of `one`, by which it multiplies a length: 1, or 1 and a few last digits more. What the last
digits do to an answer says how far rounding goes in it.
"""

import math
from functools import partial

import numpy as np

import mjrock as mr
from mjrock.scene.masonry import scene_of_masonry

K_N = 5e8
RECORD = mr.GroundMotion.synthetic(peak=4.0, duration=1.0, seed=3)
UP = mr.GroundMotion.synthetic(peak=1.5, duration=1.0, seed=4)
JOINTS = mr.Dry(k_n=1e9, k_s=4e8, friction=0.7, xi=0.05)
EFFECTS = {
    "tie": mr.Tie(height=3.0, stiffness=2e7, slack=1e-3, strength=4e4, ultimate=0.02),
    "thrust": mr.Thrust(height=3.5, force=1e3),
    "load": mr.Load(force=5e3, height=4.0, offset=0.1),
    "mass": mr.AddedMass(mass=800.0, height=4.0),
    "damper": mr.Damper(height=3.0, c=2e4),
    "friction damper": mr.FrictionDamper(height=3.0, stiffness=1e7, slip_force=2e3),
}
WITH_THEORY = ("tie", "thrust", "load", "mass")
ELASTIC = mr.Tie(height=3.0, stiffness=2e7, slack=1e-3)


def wall(one=1.0):
    return mr.Block.from_size(0.6 * one, 4.2)


def lines(block, **more):
    return mr.Contacts.from_damping(block, k_base=K_N, xi_base=0.05, k_side=K_N, xi_side=0.012, **more)


def column(one=1.0, blocks=3):
    return mr.Masonry.stack([mr.Block.from_size(0.6 * one, 0.8)] * blocks, joints=JOINTS)


def released(one=1.0, duration=0.9, **more):
    block = wall(one)
    return mr.Case(block, 0.4 * block.alpha, duration, **more)


def shaken(one=1.0, duration=0.6, scale=2.0, **more):
    return mr.Case(wall(one), 0.0, duration, motion=RECORD.scaled(scale), **more)


def of_wall(answer):
    found = {
        "largest rotation [rad]": np.abs(answer.theta).max(),
        "rotation at the end [rad]": answer.theta[-1],
        "angular velocity at the end [rad/s]": answer.omega[-1],
    }
    if answer.impacts:
        found["first impact [s]"] = answer.impacts[0].t
        found["energy after the first impact [J]"] = answer.impacts[0].energy_after
    return found


def of_blocks(answer):
    """Where the last block ends, and how far any has moved."""
    start, end = answer.pose[0], answer.pose[-1]
    found = {
        "last block along x [m]": end[-1, 0],
        "last block upwards [m]": end[-1, 2 if end.shape[1] == 7 else 1],
        "farthest way of a block [m]": np.linalg.norm((end - start)[:, : 3 if end.shape[1] == 7 else 2], axis=1).max(),
    }
    if answer.kept_forces is not None:
        found["largest normal force [N]"] = answer.forces.normal.max()
        found["sum of normal forces at the end [N]"] = answer.forces.normal[-1].sum()
    return found


def theory(case):
    return of_wall(mr.solve_analytical(case, mr.Restitution.from_geometry(case.block)))


def fitted(case):
    return of_wall(mr.simulate(case, lines(case.block)))


def fixed(case):
    return of_wall(mr.simulate(case, lines(case.block), 2e-4))


def reference(case):
    return of_wall(mr.solve_compliant(case, lines(case.block)))


def explicit_wall(case):
    return of_wall(mr.solve_explicit(case, lines(case.block)))


def with_effect(solve, effect, one):
    return solve(released(one, 0.6, motion=RECORD, effects=effect))


def sliding(one):
    case = shaken(one, side_stop=False, vertical=UP)
    bed = mr.Contacts.from_damping(case.block, k_base=K_N, xi_base=0.05, friction=0.15, points=5)
    answer = mr.simulate(case, bed)
    return of_wall(answer) | {"slip at the end [m]": answer.pose[-1, 0, 0]}


def falling_wall(solve, one):
    """The wall is released beyond the rotation at which it falls."""
    block = wall(one)
    return solve(mr.Case(block, 1.1 * block.alpha, 0.8, side_stop=False))


def plates(one):
    impact = mr.rigid_impact(column(one), [[0.1, 0.0, 0.5], [0.2, 0.0, 0.5], [0.3, 0.0, 0.5]])
    return {"energy kept [-]": impact.kept, "rotation of the top after it [rad/s]": impact.velocity[-1, 2]}


def masonry_in_mujoco(masonry, timestep, one, duration=0.2, **more):
    return of_blocks(
        mr.simulate(mr.MasonryCase(masonry(one), duration, motion=RECORD.scaled(2.0)), None, timestep, **more)
    )


def masonry_explicit(masonry, one, duration=0.3, scale=2.0, **more):
    case = mr.MasonryCase(masonry(one), duration, motion=RECORD.scaled(scale), **more)
    return of_blocks(mr.solve_explicit(case, forces=True))


def arch(one, radius=3.0, thickness=0.5, voussoirs=9, **more):
    return mr.Masonry.arch(radius * one, thickness, voussoirs=voussoirs, joints=mr.Dry(1e10, 0.7, k_s=4e9), **more)


def dome(one):
    return mr.Masonry.dome(3.0 * one, 0.5, 6, 3, joints=mr.Dry(1e9, 0.8, k_s=4e8))


def vault(one):
    return mr.Masonry.barrel_vault(3.0 * one, 0.5, 1.2, 0.6, courses=7, joints=mr.Dry(1e9, 0.7, k_s=4e8))


def box(one):
    return mr.Masonry.box((0.6 * one, 0.4, 2.0), joints=JOINTS)


def drums(one):
    return mr.Masonry.column(width=0.6 * one, height=2.4, drums=3, sides=8, joints=JOINTS)


def mortared(one):
    block = mr.Block.from_size(0.3 * one, 0.4)
    bond = mr.Bond(tension=2e5, cohesion=3e5, opening_energy=10.0, slip_energy=50.0)
    return mr.Masonry.stack([block] * 3, joints=mr.Mortar(mr.Dry(1e10, 0.7, k_s=4e9, points=5), bond))


def mortar_pulled(one):
    """The top of a bonded column is driven sideways until its joints crack."""
    masonry = mortared(one)
    drive = mr.Actuator(masonry.names[-1], (0.0, 1.1), 1, ([0.0, 0.05], [0.0, 2e-3]), 1e8)
    answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.05, effects=drive), forces=True)
    pulled = next(iter(answer.actuators.values()))
    return of_blocks(answer) | {
        "largest force of the actuator [N]": np.abs(pulled).max(),
        "damage at the end [-]": answer.forces.damage[-1].sum(),
    }


def supports_part(one):
    masonry = arch(one)
    away = {"right_abutment": ([0.0, 0.3], [0.0, 0.02], [0.0, 0.0])}
    return of_blocks(mr.solve_explicit(mr.MasonryCase(masonry, 0.3, supports=away), forces=True))


def on_a_block(one):
    """A block on the ground."""
    ground = mr.Polygon([(-2, -0.3), (2, -0.3), (2, 0), (-2, 0)], fixed=True, name="ground")
    block = mr.Polygon([(0, 0), (0.8 * one, 0), (0.8 * one, 2), (0, 2)], 2000.0, name="block")
    return mr.Masonry([ground, block], joints=mr.Dry(2e8, 1.5, 0.05, 1e8, 50.0))


def tied_block(effect, one):
    case = mr.MasonryCase(on_a_block(one), 0.4, motion=RECORD.scaled(1.5), effects=effect)
    answer = mr.solve_explicit(case, forces=True)
    pulls = next(iter(answer.forces.links.values()))
    return of_blocks(answer) | {"largest force of the link [N]": np.abs(pulls).max()}


ASLANT = mr.Tie(stiffness=3e6, prestress=4e3, at=(0.0, 1.8), anchor=(-1.6, 2.9), block="block")
YIELDS = mr.Tie(stiffness=3e6, strength=3e3, at=(0.0, 1.8), anchor=(-1.6, 1.8), block="block")
SLIPS = mr.FrictionDamper(stiffness=3e6, slip_force=1e3, at=(0.0, 1.8), anchor=(-1.6, 1.8), block="block")
DAMPS = mr.Damper(c=2e4, at=(0.0, 1.8), anchor=(-1.6, 1.8), block="block")


def falls_apart(one):
    """A column is struck so that it falls over; it is compared while its blocks still fly."""
    masonry = column(one)
    case = mr.MasonryCase(masonry, 0.8, velocity=[[0.0, 0.0, 0.0], [1.5, 0.0, 0.5], [3.0, 0.0, 1.0]])
    answer = mr.solve_explicit(case)
    return of_blocks(answer) | {"first block that leaves [s]": min(answer.fallen.values(), default=math.nan)}


def plain(one):
    return masonry_in_mujoco(column, 3e-4, one, collisions=True)


def at_rest(masonry, effects, one):
    case = mr.MasonryCase(masonry(one), 1.0, effects=effects)
    scene = scene_of_masonry(case.masonry, case.effects)
    pose, friction = scene.rest_state
    normal = scene.contacts.k * scene.bears
    return {
        "farthest way [m]": np.abs(pose - np.round(pose)).max(),
        "largest normal force [N]": normal.max(),
        "sum of normal forces [N]": normal.sum(),
        "largest friction [N]": np.abs(friction).max(),
    }


def collapse(masonry, one, **more):
    """Forces in the plane alone: in space many states bear the same, and rounding decides which is found."""
    pushed = masonry(one)
    found = mr.collapse_multiplier(pushed, 1, **more)
    answers = {"multiplier [-]": found.multiplier}
    if found.forces is not None and not pushed.in_space:
        answers["sum of normal forces [N]"] = found.forces.normal.sum()
    return answers


def curve(masonry, one):
    found = mr.limit_curve(masonry(one), 1, to=0.05, poses=6)
    return {"first multiplier [-]": found.multiplier[0], "last multiplier [-]": found.multiplier[-1]}


def pushed_over(name, one):
    case = mr.Case(wall(one), 0.0, 1.0, effects=EFFECTS[name] if name else ())
    found = mr.pushover(case, lines(case.block), points=50)
    return {
        "peak [-]": found.multiplier.max(),
        "half way [-]": found.multiplier[25],
        "rotation [rad]": found.rotation[-1],
    }


def pushed(one):
    drive = mr.Actuator("block", (0.0, 2.0), 1, None, 1e8)
    found = mr.push(on_a_block(one), drive, 0.02)
    return {"peak [N]": found.peak, "force at the end [N]": found.force[-1]}


def mechanism(code, effects, one):
    site = mr.code_spectrum("EC8 type 1", ag=2.5, soil="B")
    check = mr.mechanism_check(mr.Case(wall(one), 0.0, 1.0, side_stop=False, effects=effects), site, code=code)
    found = {}
    for name, state in check.states.items():
        found |= {f"capacity at {name} [m]": state.capacity, f"demand at {name} [m]": state.demand}
    return found


def dynamic(one):
    runs = [mr.solve_analytical(case, mr.Restitution.from_geometry(case.block)) for case in both_ways(one)]
    found = mr.dynamic_check(runs, "SLV", natural=True)
    return {"mean displacement [m]": found.mean, "d_0 [m]": found.d_0}


def both_ways(one):
    motions = [mr.GroundMotion.synthetic(2.5, 2.0, seed=seed) for seed in range(7)]
    return [mr.Case(wall(one), 0.0, 2.0, motion=way) for motion in motions for way in motion.polarities]


def spectra(one):
    found = mr.response_spectrum(RECORD, [0.2 * one, 1.0 * one], 0.05)
    ntc = mr.code_spectrum("NTC 2018", ag=2.0, F0=2.5, Tc=0.35 * one, soil="C")
    return {
        "of a record at 0.2 s [m/s2]": found.Sa[0],
        "of a record at 1 s [m/s2]": found.Sa[1],
        "NTC at 0.8 s [m/s2]": float(ntc(0.8, 0.05)),
    }


def matched(one):
    block = wall(one)
    found = mr.matched_contacts(block, mr.Restitution.from_geometry(block), K_N)
    return {"damping of the base [-]": found.base.xi}


SCENES = {
    "theory, released": lambda one: theory(released(one, 1.1)),
    "theory, both ways": lambda one: theory(released(one, 3.0, side_stop=False)),
    "theory, shaken": lambda one: theory(shaken(one, 0.9, 2.0, vertical=UP)),
    **{f"theory, {name}": partial(with_effect, theory, EFFECTS[name]) for name in WITH_THEORY},
    "theory, falls": partial(falling_wall, theory),
    "theory, plastic impact": plates,
    "MuJoCo fitted, released": lambda one: fitted(released(one)),
    "MuJoCo fitted, shaken": lambda one: fitted(shaken(one, vertical=UP, side_stop=False)),
    "MuJoCo fitted, slides": sliding,
    "MuJoCo fitted, falls": partial(falling_wall, fitted),
    **{f"MuJoCo fitted, {name}": partial(with_effect, fitted, effect) for name, effect in EFFECTS.items()},
    "MuJoCo fixed, released": lambda one: fixed(released(one)),
    "MuJoCo fixed, shaken": lambda one: fixed(shaken(one, side_stop=False)),
    "MuJoCo fixed, tie": partial(with_effect, fixed, ELASTIC),
    "MuJoCo fixed, friction damper": partial(with_effect, fixed, EFFECTS["friction damper"]),
    "MuJoCo fitted, column": partial(masonry_in_mujoco, column, None),
    "MuJoCo fitted, box": partial(masonry_in_mujoco, box, None),
    "MuJoCo fixed, column": partial(masonry_in_mujoco, column, 2e-4),
    "MuJoCo fixed, drums": partial(masonry_in_mujoco, drums, 2e-4),
    "plain model, column": plain,
    "SciPy, released": lambda one: reference(released(one)),
    "SciPy, shaken": lambda one: reference(shaken(one, side_stop=False)),
    "SciPy, thrust": partial(with_effect, reference, EFFECTS["thrust"]),
    "explicit, wall released": lambda one: explicit_wall(released(one)),
    "explicit, column": partial(masonry_explicit, column),
    "explicit, arch": partial(masonry_explicit, arch),
    "explicit, supports part": supports_part,
    "explicit, column falls": falls_apart,
    "explicit, box": partial(masonry_explicit, box),
    "explicit, drums": partial(masonry_explicit, drums),
    "explicit, dome": partial(masonry_explicit, dome, duration=0.05),
    "explicit, mortar shaken": partial(masonry_explicit, mortared, duration=0.1),
    "explicit, mortar cracks": mortar_pulled,
    "explicit, tie aslant": partial(tied_block, ASLANT),
    "explicit, tie yields": partial(tied_block, YIELDS),
    "explicit, friction damper": partial(tied_block, SLIPS),
    "explicit, damper": partial(tied_block, DAMPS),
    "rest, arch": partial(at_rest, arch, ()),
    "rest, stiff arch": partial(at_rest, partial(arch, voussoirs=33), ()),
    "rest, dome": partial(at_rest, dome, ()),
    "rest, vault": partial(at_rest, vault, ()),
    "rest, tie aslant": partial(at_rest, on_a_block, (ASLANT,)),
    "limit analysis, column": partial(collapse, column),
    "limit analysis, arch": partial(collapse, partial(arch, voussoirs=17)),
    "limit analysis, arch without dilatancy": partial(collapse, arch, associated=False),
    "limit analysis, vault": partial(collapse, vault),
    "limit analysis, dome": partial(collapse, dome),
    "limit analysis, tie": partial(collapse, on_a_block, effects=(YIELDS,)),
    "limit curve, column": partial(curve, column),
    "limit curve, arch": partial(curve, arch),
    "push-over": partial(pushed_over, ""),
    **{f"push-over, {name}": partial(pushed_over, name) for name in WITH_THEORY},
    "push": pushed,
    "check, NTC 2018": partial(mechanism, "NTC 2018", ()),
    "check, tie": partial(mechanism, "NTC 2018", (EFFECTS["tie"],)),
    "check by runs": dynamic,
    "spectra": spectra,
    "matched contacts": matched,
}
