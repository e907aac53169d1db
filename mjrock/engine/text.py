"""The model text of a case."""

from __future__ import annotations

from typing import Annotated

from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import require_flag, require_kind, within_ranges
from ..result.problem import problem_of
from ..scene.time_step import MUJOCO_STEP
from .model import released_mjcf
from .options import NewmarkBeta
from .plain.run import PlainModel, require_plain


@within_ranges
def mjcf_of(
    case: AnyCase,
    contacts: Contacts | None,
    timestep: Annotated[float, MUJOCO_STEP],
    *,
    newmark_beta: NewmarkBeta = 0.25,
    collisions: bool = False,
) -> str:
    """The model of a case as MJCF text; the same arguments give the same bytes.

    Reset to the keyframe `release` and stepped, stock MuJoCo repeats `simulate(case, contacts, timestep)` where the
    ground does not move. Without collisions, a structure a kilometre or more from the origin is written nearer to it by
    whole kilometres. The camera is `front`. See `wall_mjcf` and `masonry_mjcf` for the other names in the text.

    What slides in this text is pressed apart: a contact with the slip v adds mu (c / 2 + newmark_beta h k) |v| to its
    normal force, as `simulate` at a fixed step does and warns of. Steps of the package that fit the motion, or
    `simulate(..., coulomb=True)`, slide by Coulomb's law, and no text can say so.

    Args:
        case: the wall or the masonry, and its release.
        contacts: the interfaces of a wall; None for masonry.
        timestep: MuJoCo's step, on which the contact rows depend [s], 1e-9 to 1.
        newmark_beta: Newmark's beta of the contact rows [-], 0 to 10, see `mjrock.contacts.solref`. Rows that MuJoCo
            would clamp, or whose dashpot is stiff for the step, get more inertia, see `mjrock.contacts.solref.row`.
        collisions: whether the model is a plain one, of boxes and hulls whose contacts MuJoCo finds, as that of
            `simulate(..., collisions=True)`.

    Raises:
        ValueError: if the contacts do not fit the case, if the masonry does not stand, or for a value outside its
            range.
    """
    problem = problem_of(case, contacts)
    if require_flag("collisions", collisions):
        require_plain(case)
        scene = problem.scene()
        return PlainModel(problem, scene, problem.course(scene)).released_text(timestep)
    case.require_dry("MuJoCo")
    scene = problem.scene()
    return released_mjcf(scene, problem.course(scene), timestep, newmark_beta)


def wall_mjcf(case: Case, contacts: Contacts, timestep: float, *, newmark_beta: float = 0.25) -> str:
    """The model of a wall as MJCF text, see `mjcf_of`.

    Names: bodies and geoms `wall`, `base`, `side`; contact points `base_0`, `base_1`, ... from the inner to the outer
    edge and `side_0`, ... from the bottom to the top; joints `x`, `z`, `theta`. Without a side stop there is no side
    geom and no side pair.
    """
    require_kind("case", case, Case)
    return mjcf_of(case, contacts, timestep, newmark_beta=newmark_beta)


def masonry_mjcf(case: MasonryCase, timestep: float, *, newmark_beta: float = 0.25) -> str:
    """The model of masonry as MJCF text, see `mjcf_of`.

    Names: bodies and geoms as the blocks that are not fixed; contact points `a|b_0`, `a|b_1`, ... of the joint between
    the blocks a and b; joints `a_x`, `a_z`, `a_theta`, and in space `a_x`, `a_y`, `a_z` and the ball `a_turn`.
    """
    require_kind("case", case, MasonryCase)
    return mjcf_of(case, None, timestep, newmark_beta=newmark_beta)
