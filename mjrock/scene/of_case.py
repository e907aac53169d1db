"""The scene and the course of a case, of a wall or of masonry."""

from __future__ import annotations

from ..method import METHOD, Method
from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import require_kind, shown
from .course import Course
from .masonry import masonry_course, masonry_scene
from .scene import Scene
from .wall import wall_course, wall_scene


def scene_of(case: Case | MasonryCase, contacts: Contacts | None = None, method: Method = METHOD) -> Scene:
    """What stands in a case: a wall on its contacts, or masonry, which has joints of its own.

    Raises:
        ValueError: if the contacts do not fit the case, or what stands in it falls under its weight.
    """
    require_case(case, contacts)
    if isinstance(case, MasonryCase):
        return masonry_scene(case)
    assert contacts is not None
    return wall_scene(case, contacts, method)


def require_case(case: Case | MasonryCase, contacts: Contacts | None) -> None:
    """Raise a TypeError unless this is a wall with its contacts, or masonry without."""
    if isinstance(case, MasonryCase):
        if contacts is not None:
            raise TypeError(f"contacts = {shown(contacts)}: masonry has its joints; leave contacts out")
        return
    if isinstance(case, Contacts) and isinstance(contacts, Case):
        raise TypeError("case and contacts are swapped: the case comes first")
    require_kind("case", case, Case, MasonryCase)
    if contacts is None:
        raise TypeError("contacts = None: a wall needs its interfaces; take Contacts.from_law(wall, e, k_base, k_side)")
    require_kind("contacts", contacts, Contacts)


def course_of(case: Case | MasonryCase, scene: Scene) -> Course:
    """What happens to the scene of a case."""
    return masonry_course(case, scene) if isinstance(case, MasonryCase) else wall_course(case, scene)
