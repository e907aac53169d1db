"""Newton's law of every body in every step, from poses and the forces that an answer has kept.

Mass times the change of the velocity in a step is the force in it. Velocities are differences of poses, so that nothing
is taken from the solver but poses and forces. Samples are steps of one length.
"""

from __future__ import annotations

import numpy as np

import mjrock as mr
from mjrock.problem.masonry.effects import with_added_masses
from mjrock.problem.masonry.histories import motions_of_tilt
from mjrock.result.bodies import BodyMotion
from mjrock.result.ties import link_vector


def is_stepwise(answer: mr.Response) -> bool:
    """Whether the samples of an answer are its steps, all of one length."""
    h = answer.stats["timestep"]
    return len(answer.t) > 3 and bool(np.abs(np.diff(answer.t) - h).max() < 1e-9 * h + 1e-15)


def unbalanced(answer: mr.Response) -> float:
    """Largest force missing in the balance of all bodies, over their weight and the largest reaction [-].

    The forces are the reactions of what is fixed, the weight, constant forces, and what the ground's acceleration
    brings.
    """
    missing = sum(answer.reactions.values())[1:-1] + (outer_forces(answer) - inertia_forces(answer)).sum(axis=1)
    return float(np.abs(missing[~at_turns(answer)]).max(initial=0.0)) / scale_of(answer)


def unbalanced_bodies(answer: mr.Response) -> float:
    """The same for every single body of masonry, with the forces of joints, links and jacks on it.

    It holds where no block meets another one that it has no joint with.
    """
    missing = outer_forces(answer) + (joint_forces(answer) + device_forces(answer))[1:-1] - inertia_forces(answer)
    return float(np.abs(missing[~at_turns(answer)]).max(initial=0.0)) / scale_of(answer)


def turns(pull: np.ndarray, strength: float) -> np.ndarray:
    """Inner samples beside a step in which a tie goes taut or slack, or begins to yield, shape (n - 2,).

    In that step it pulls for the time that it is taut, and its force at a sample is that of the pose.
    """
    changes = np.diff((pull > 0).astype(int) + (pull >= strength * (1 - 1e-9))) != 0
    return changes[1:] | changes[:-1]


def at_turns(answer: mr.Response) -> np.ndarray:
    """Inner samples at which some tie turns, shape (n - 2,)."""
    ties = {name: link for name, link in answer.case.links.items() if isinstance(link, mr.Tie)}
    found = [turns(answer.forces.links[name], tie.law.strength) for name, tie in ties.items()]
    return np.any([np.zeros(len(answer.t) - 2, dtype=bool), *found], axis=0)


def masses(case: mr.Case | mr.MasonryCase) -> np.ndarray:
    """Mass of each body with what is added to it [kg]."""
    if isinstance(case, mr.Case):
        return np.array([case.wall.mass])
    return np.asarray(with_added_masses(case.masonry, case.passive).mass[list(case.masonry.free)])


def scale_of(answer: mr.Response) -> float:
    """The weight and the largest reaction [N]."""
    largest = max(float(np.abs(force).max()) for force in answer.reactions.values())
    return mr.GRAVITY * float(masses(answer.case).sum()) + largest


def inertia_forces(answer: mr.Response) -> np.ndarray:
    """Mass times acceleration of each body in the steps but the first and the last [N], shape (n - 2, bodies, d)."""
    place = answer.pose[:, :, : 3 if answer.in_space else 2]
    change = place[2:] - 2 * place[1:-1] + place[:-2]
    return masses(answer.case)[:, None] * change / answer.stats["timestep"] ** 2


def outer_forces(answer: mr.Response) -> np.ndarray:
    """Weight, constant forces, and inertia against the mean acceleration of the ground in each of these steps [N]."""
    case, d, h, t = answer.case, 3 if answer.in_space else 2, answer.stats["timestep"], answer.t[1:-1]
    mass = masses(case)
    force = np.zeros((len(t), len(mass), d))
    force[..., -1] -= mr.GRAVITY * mass
    motions = {0: case.motion, d - 1: case.vertical}
    if isinstance(case, mr.MasonryCase):
        if case.tilt is not None:
            motions = dict(zip(motions, motions_of_tilt(case.tilt, case.duration), strict=True))
        if d == 3:
            motions[1] = case.transverse
    for axis, motion in motions.items():
        if motion is not None:
            mean = (motion.velocity(t + 0.5 * h) - motion.velocity(t - 0.5 * h)) / h
            force[..., axis] -= mean[:, None] * mass
    for effect in case.effects:
        if effect.force_vector is not None:
            body = 0 if isinstance(case, mr.Case) else case.masonry.free.index(effect.block)
            force[:, body] += np.array(effect.force_vector)[[0, 2] if d == 2 else [0, 1, 2]]
    return force


def joint_forces(answer: mr.Response) -> np.ndarray:
    """What the joints do to each body at all samples [N], shape (n, bodies, d)."""
    kept, d = answer.forces, 3 if answer.in_space else 2
    axes = BodyMotion(answer.case, answer.t, answer.pose).joints(kept.frames)[1]
    shear = kept.shear.reshape(*kept.normal.shape, d - 1)
    force = np.einsum("njk,njkd->njd", np.concatenate([kept.normal[..., None], shear], axis=2), axes)
    total = np.zeros((len(answer.t), len(masses(answer.case)), d))
    for joint, (below, above) in enumerate(zip(kept.frames.below, kept.frames.above, strict=True)):
        for body, sense in ((above, 1), (below, -1)):
            if body >= 0:
                total[:, body] += sense * force[:, joint]
    return total


def device_forces(answer: mr.Response) -> np.ndarray:
    """What links, jacks and their guides do to each body at all samples [N], shape (n, bodies, d)."""
    case, kept = answer.case, answer.forces
    row = {number: i for i, number in enumerate(case.masonry.free)}
    total = np.zeros((len(answer.t), len(row), 3 if answer.in_space else 2))
    for name, pull in kept.links.items():
        link = case.links[name]
        way = link_vector(BodyMotion(case, answer.t, answer.pose), link)
        force = -pull[:, None] * way / np.linalg.norm(way, axis=1)[:, None]
        total[:, row[link.block]] += force
        if link.anchor_block in row:
            total[:, row[link.anchor_block]] -= force
    for name, push in answer.actuators.items():
        total[:, row[case.actuators[name].block]] += push[:, None] * np.array(case.actuators[name].direction)
    for block, guide in kept.guides.items():
        total[:, row[case.masonry.names.index(block)], -1] += guide[:, 0]
    return total
