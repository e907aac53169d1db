"""A bonded joint that is led along a path, for tests: what it pushes and drags at each pose."""

import numpy as np
from by_hand import alone

import mjrock as mr
from mjrock.distinct.loop import Clock, advance
from mjrock.distinct.setup import setup_of
from mjrock.distinct.system import Books, Samples

K_N, K_S = 62.7e9, 27.5e9
MORTAR = mr.Bond(0.25e6, 0.35e6, 18.0, 125.0)
AREA = 0.02


def joint(bond=MORTAR, *, space=False, angle=0.0, friction=0.75, points=3, **more):
    """Two blocks on one joint of 0.02 m2, turned by an angle in the plane."""
    cos, sin = np.cos(angle), np.sin(angle)
    more = {"xi": 0.0, "k_n": K_N, "k_s": K_S, "friction": friction, "points": points, "bond": bond} | more
    if space:
        sizes = (0.2, 0.1, 0.1)
        blocks = [
            mr.Polyhedron.box(sizes, (0, 0, -0.05), fixed=True, name="a"),
            mr.Polyhedron.box(sizes, (0, 0, 0.05), name="b"),
        ]
        return mr.Masonry(blocks, **more)
    blocks = []
    for name, low in (("a", -0.1), ("b", 0.0)):
        corners = [(-0.1, low), (0.1, low), (0.1, low + 0.1), (-0.1, low + 0.1)]
        turned = [(cos * x + sin * z, -sin * x + cos * z) for x, z in corners]
        blocks.append(mr.Polygon(turned, length=0.1, fixed=name == "a", name=name))
    return mr.Masonry(blocks, **more)


class Led:
    """A joint whose upper block is led along a path: displacements along the face and opening [m].

    After each call `push` and `drag` are the stresses along the normal and the face at each pose [Pa], `system` and
    `books` what is left.
    """

    def __init__(self, masonry, angle=0.0, h=1e-5):
        setup = setup_of(mr.MasonryCase(masonry, 1.0, settled=False), None, None)
        self.system, self.h, self.at, self.step = setup.system, h, np.zeros(len(setup.system.axes)), 0
        self.system.bodies["inverse_mass"], self.system.bodies["inverse_inertia"] = 0.0, 0.0
        self.books = Books.empty(self.system, 2)
        self.samples = Samples.room(2, self.system, self.books, ledger=True)
        self.body, self.threads = np.asarray(self.system.bodies), alone(self.system)
        self.tables = [np.asarray(table) for table in (self.system.lines, self.system.laws[0].rows)]
        d = len(self.at)
        along, normal = ((np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle)))
        self.directions = np.array([along, normal] if d == 2 else np.eye(3))

    def along(self, path):
        """Follow a path, shape (n, d): displacements along the face, then the opening. Returns push and drag."""
        pushes, drags = [], []
        for place in np.asarray(path) @ self.directions:
            self.body["velocity"][0] = (place - self.at) / self.h
            self.at = place
            self.move()
            push, drag = self.forces()
            pushes.append(push)
            drags.append(drag)
        return np.array(pushes), np.array(drags)

    def move(self):
        """One step, at the end of which the forces are those of the new pose."""
        self.body["place"][0] = self.at
        clock = Clock(
            h=self.h,
            steps_per_sample=1,
            stop=2,
            last=10**9,
            ground_acceleration_before=(0.0,) * len(self.at),
            step=1,
            h_before=self.h,
        )
        advance(self.system, self.books, self.samples, clock, self.threads)

    def forces(self):
        push = sum(table["push"].sum() for table in self.tables)
        drag = sum(table["shear_force"].sum(axis=0) for table in self.tables)
        return push / AREA, drag[: len(self.at) - 1] / AREA

    @property
    def elastic(self):
        """Energy in the springs at the last pose [J]."""
        return float(self.samples.energy["elastic"][0])

    @property
    def taken(self):
        """What bonds have taken in tension, slip and crushing, and friction [J/m2]."""
        taken = (float(self.books.totals[0][name]) / AREA for name in ("tension", "slip", "crushing"))
        return *taken, float(self.samples.energy["friction"][0]) / AREA
