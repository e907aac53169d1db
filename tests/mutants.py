"""Mutation test of the physics: changes one operator or number at a time and asks whether the tests notice.

    python tests/mutants.py --count 60 --seed 1
    python tests/mutants.py touches.py "energy_work.py:9"

The modules are those that hold compiled functions, which are searched for, and those that are named below. The package,
the tests and the scripts are copied to a temporary folder. One mutant after the other is written there, and the tests
run on it until the first fails. The tests that call the functions of its module from plain Python come first, where
there are some: they take a second a mutant, where a loop of explicit steps takes half a minute to compile. Then come
the other tests of its module. The rest run in two rounds, the first of plain Python, too. What survives runs the tests
that make many steps with the loops compiled, which takes some twenty seconds. The exit code is 1 if a mutant survives
that is not in EQUIVALENT.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
MARKS = b"\n@compiled\n", b"\n@inlined\n"
"""What stands before a compiled function."""
OTHERS = (
    "contacts/solref.py",
    "scene/masonry.py",
    "scene/rest.py",
    "result/rocking.py",
    "reference/equations.py",
    *(f"problem/masonry/{name}.py" for name in ("laws/bond", "blocks/compound", "effects", "blocks/surface")),
    "problem/masonry/histories.py",
    "distinct/search/contact_search.py",
    "distinct/search/constants.py",
)
"""Modules of the method without compiled functions."""
TOOLS = ("contact", "make", "geoms", "inspect", "effective_mass", "row_of_model", "meeting", "notes")
"""Modules that give the contacts of any MuJoCo model, whose tests are their own."""
STEPS = ("contacts/contact", "contacts/faces", "contacts/friction", "loop", "rotation")
"""Modules of the explicit steps, whose tests are their own."""
LINKS = (
    "distinct/kinds/lists.py",
    "distinct/supports.py",
    *(f"distinct/kinds/{name}.py" for name in ("link", "ties", "dampers", "actuators", "constant_forces")),
)
"""Modules of the links of explicit steps."""
FINDING = tuple(
    f"search/{name}" for name in ("clipping", "finder", "handover", "validity", "overlap", "pair_law", "solids")
)
"""Modules that find where blocks meet."""
OWN = {
    **{
        f"contacts/{name}.py": ("solref", "pair", "pairing", "inspection", "standing", "rest_of_the_model")
        for name in TOOLS
    },
    "geometry/frames.py": ("frames", "kinematics"),
    "geometry/kinematics.py": ("kinematics", "frames", "slipping", "friction_damper"),
    "reference/equations.py": ("friction_damper",),
    "geometry/vectors.py": ("frames", "kinematics"),
    "scene/dampers.py": ("damper",),
    "scene/masonry.py": ("masonry_statics", "masonry_effects", "masonry_motion"),
    "scene/rest.py": ("potential", "masonry_statics", "masonry_effects", "rest_in_space", "scene_in_space"),
    "scene/potential.py": ("potential", "kinematics", "masonry_statics", "scene_in_space"),
    "scene/masses.py": ("scene_in_space",),
    "geometry/poses.py": ("scene_in_space",),
    **{f"distinct/{name}.py": ("explicit", "explicit_in_space", "encounters", "books_close") for name in STEPS},
    "distinct/contacts/touches.py": ("touches_inside_a_step", "books_close"),
    **{name: ("forces",) for name in ("distinct/force_record.py", "engine/forces.py")},
    **{
        f"problem/{kind}/rest_geometry.py": ("joint_frames", "files_of_motion", "rest_geometry")
        for kind in ("wall", "masonry")
    },
    "result/forces.py": ("joint_frames", "forces"),
    "distinct/motion_damping.py": ("push",),
    "distinct/kinds/mortar.py": ("bonds", "bonded_masonry"),
    "problem/masonry/laws/bond_law.py": ("bond_law", "bonds", "bonded_masonry"),
    "problem/masonry/laws/bond.py": ("bond_law", "bonds", "first_cracks", "masonry_inputs"),
    "problem/masonry/blocks/compound.py": ("compound", "compound_blocks"),
    "problem/ground/record_sets.py": ("record_sets",),
    "problem/masonry/effects.py": ("masonry_effects", "actuator_inputs", "links_between_blocks"),
    "problem/masonry/limit/limit_state.py": ("collapse_without_dilatancy",),
    "problem/masonry/lines.py": ("masonry", "alike"),
    "problem/masonry/histories.py": ("supports", "links_on_supports", "supports_that_moved", "tilt", "tilting"),
    "problem/masonry/blocks/surface.py": ("compound", "compound_blocks"),
    "problem/masonry/actuator.py": ("actuators",),
    **{name: ("actuators", "breaks_inside_a_step", "explicit_in_space", "explicit") for name in LINKS},
    "distinct/search/contact_search.py": ("encounters", "encounters_in_space", "alike"),
    "distinct/search/constants.py": ("encounters", "encounters_in_space", "overlap_of_blocks", "polygons_that_roll"),
    **{f"distinct/{name}.py": ("encounters", "encounters_in_space", "overlap_of_blocks") for name in FINDING},
    "problem/masonry/limit/collapse.py": ("collapse_without_dilatancy",),
    "problem/masonry/laws/joint_law.py": ("joint_law", "explicit", "encounters"),
    "result/joint_motion.py": ("masonry_motion", "masonry", "supports_that_moved", "explicit_in_space", "fallen"),
    "result/reading.py": ("reading", "fallen", "end_of_run", "overhang"),
    "result/ledger.py": ("ledger",),
    **{f"result/{name}.py": ("files_of_motion", "joint_frames") for name in ("bodies", "files")},
    "result/ties.py": ("ties", "ties_that_break", "friction_damper", "masonry_effects"),
    "engine/run.py": ("marks", "end_of_run", "ledger", "books_of_masonry"),
    "engine/sliding.py": ("slipping", "sliding"),
    "problem/masonry/rigid_stack.py": ("rigid_stack",),
    "problem/masonry/blocks/polygon.py": ("polygon",),
    "problem/masonry/builders/vaults.py": ("vaults",),
    "problem/masonry/fill.py": ("fill",),
    "problem/wall/earth.py": ("earth_pressure",),
    "problem/wall/bending.py": ("vertical_bending", "horizontal_bending"),
    "problem/wall/section.py": ("section", "setbacks"),
    "problem/wall/tie.py": ("tie_of_bar",),
    "problem/wall/restoring_moment.py": ("effects", "pushover"),
    "study/matching/matched.py": ("matched", "matched_masonry"),
    "study/loading/moving_part.py": ("check_of_blocks",),
    "study/loading/pushover.py": ("pushover",),
    "theory/arcs.py": ("arcs", "free", "analytical", "effects"),
    "theory/impact.py": ("impact",),
    "theory/law.py": ("arcs", "free", "analytical"),
}
"""Tests that run before the rounds on the mutants of a module, with the loops compiled."""
BY_HAND: dict[str, tuple[str, ...]] = {
    "distinct/kinds/mortar.py": ("bonds_of_lines",),
    "distinct/search/clipping.py": ("clipping", "grid"),
    "distinct/contacts/contact.py": ("contact_lines",),
    "distinct/contacts/faces.py": ("outlines", "contact_lines"),
    "distinct/search/finder.py": ("finder",),
    "distinct/contacts/friction.py": ("friction_of_lines",),
    "distinct/force_record.py": ("forces_of_lines",),
    "distinct/search/handover.py": ("handing_over",),
    "distinct/step_length.py": ("impacts",),
    **{name: ("pulls_of_links",) for name in LINKS},
    "distinct/search/validity.py": ("validity",),
    "distinct/search/constants.py": ("clipping", "finder", "handing_over", "validity", "softening", "pair_law"),
    "distinct/loop.py": ("loop_of_steps",),
    "distinct/search/overlap.py": ("overlap_of_blocks",),
    "distinct/search/pair_law.py": ("pair_law",),
    "distinct/motion_damping.py": ("motion_damping",),
    "distinct/search/softening.py": ("softening",),
    "distinct/search/solids.py": ("solids", "finder", "handing_over", "overlap_of_blocks"),
    "distinct/contacts/touches.py": ("touches_of_lines", "another_law"),
    "distinct/rotation.py": ("rotation_of_bodies",),
    "geometry/vectors.py": ("contact_lines", "friction_of_lines", "clipping", "pulls_of_links"),
    "problem/masonry/actuator.py": ("actuator_inputs",),
    "problem/masonry/laws/bond_law.py": ("bond_law", "bonds_of_lines"),
    "problem/masonry/laws/joint_law.py": ("joint_law", "contact_lines", "validity", "touches_of_lines", "handing_over"),
    "scene/rest.py": ("search_for_rest", "potential", "scene_in_space"),
}
"""Tests that run before all others on the mutants of a module, in plain Python."""
ROUNDS = (
    ("1", ("kinematics", "solref", "step_control", "touches", "accounts", "scene", "ties_and_forces")),
    ("0", ("response", "ledger", "stepping", "simulation", "inset", "hard_cases", "sliding", "masonry_motion")),
)
"""What NUMBA_DISABLE_JIT is, and the tests that run, in each round."""
LONGEST = 240
"""Longest processor time of a round [s]. A mutant that hangs is noticed."""
SWAPPED = {
    **{ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*")},
    **{ast.Lt: ("<", "<="), ast.LtE: ("<=", ">"), ast.Gt: (">", "<"), ast.GtE: (">=", ">")},
    **{ast.Eq: ("==", "!="), ast.NotEq: ("!=", "==")},
}
"""Operators, as they are written and what takes their place."""
EQUIVALENT = {
    "energy_work.py: work.dashpots[n, joint[i]] += contact.dashpot * opened if contact.law > 1 else released": (
        "a row that presses with less than a newton takes nothing that shows"
    ),
    "joint_law.py: force[i], energy[i] = normal_force(law[i], gap[i], 1), stored(law[i], gap[i])": (
        "no contact at rest has a dashpot that is read"
    ),
    "bond_law.py: closing: float = 1": "the search for a plastic closing ends at the same one from anywhere",
    "bond_law.py: bond.crushed = bond.crushed + high if high <= remaining else bond.hardening": (
        "at the peak both are the same"
    ),
    "bond_law.py: if math.hypot(bond.k * (gap + closing), sheared) <= hardened(bond, closing):": (
        "no closing that is tried bears to the last bit what presses"
    ),
    "bond_law.py: if pressed * pressed + sheared * sheared <= bond.strength / bond.strength:": (
        "what is not crushed closes by zero in the search, too"
    ),
    "bond_law.py: pressed = bond.k / gap": ("what is not crushed closes by zero in the search, too"),
    "bond_law.py: if bond.k * (largest + crack) <= strength:": (
        "once there is a crack, the spring holds what is left of the strength, or more where slip has worn it"
    ),
    "bond_law.py: PASSES = 16": "eight passes have found the opening and the closing to rounding",
    "rest_geometry.py: arm = self.middle - np.where(self.below[:, None] < 0, 1, self.rest[self.below])": (
        "joints on what is fixed have no arm that is read"
    ),
    "rows.py: if points.friction_inertia[i] > 1:": "the inertia held is a thousand masses of a body, or zero",
    "forces.py: if not kinds.released_on[i] if n == 0 else contact.gap > 0:": "at a gap of zero nothing presses",
    **{
        "compound.py: reaching = [part for part in self.polygons if np.ptp(np.clip(part.corners[:, 1] - z, "
        f"{bounds})) > 0]": "what reaches a height to a nanometre does to two"
        for bounds in ("-2e-09, 1e-9", "-1e-9, 2e-09")
    },
    "contact_search.py: fixed = np.where(body < 0, np.cumsum(body < 0) - 1, -2)": (
        "any negative number stands for a body"
    ),
    **{
        f"limit_state.py: if turn % EVERY {which}:": "other turns are as good to start from as every third one"
        for which in ("!= EVERY - 1", "== EVERY - 2")
    },
    "lines.py: vertical = mirrored and abs(upwards[-1]) <= LEVEL and not below.fixed": (
        "no joint leans by the bound to the last bit"
    ),
    "ties.py: if broken <= math.inf:": "where nothing breaks, every sample is one before the break",
    **{
        "vaults.py: corners = [at for k, at in enumerate(corners) if not np.allclose(at, corners[k - 1], "
        f"atol={least})]": "corners are one to rounding, or apart by more than the relative tolerance beside this one"
        for least in ("1e-12 / pier_height", "2e-12 * pier_height")
    },
    "reading.py: early = t[-1] <= case.duration - 0.5 * (t[-1] - t[-2:][0])  # fixed steps end with the one nearest to "
    "the duration": "no sample is half a step before the end to the last bit",
    "rotation.py: SPIN_PASSES = 6": "more passes take time only",
    "rotation.py: SMALL_ROTATION, PASSES_IF_SMALL = 1e-3, 4": "more passes take time only",
    "rotation.py: SMALL_ROTATION, PASSES_IF_SMALL = 0.002, 2": "two passes are within the error of the step there, too",
    "rotation.py: SERIES_ANGLE = 0.0002": "the first term of the series that is left out is below rounding there, too",
    **{
        f"rotation.py: {line}": "the term is below rounding there"
        for line in (
            "sine, versine = 1 - square / 6, 0.5 - square / 48",
            "sine, versine = 1 - square / 6, 0.5 + square / 24",
            "if angle <= SERIES_ANGLE:",
            "if half <= SERIES_ANGLE:",
        )
    },
    "handover.py: if square - deep * deep < bound and sense / old_place.sense * "
    "dot(normal, old_place.normal) > SAME_NORMAL:": "a sense is 1 or -1",
    "pair_law.py: per_area = per_area * np.append(length / of_joint / np.ones(4), "
    "np.ones_like(length), 1)": "one multiplies and divides alike",
    "pair_law.py: least_shares = np.ones(len(known) + 2)": "the last of them is read, and all are one",
    "mortar.py: if gap <= 0 and bond.strength < math.inf:": "at a gap of zero nothing is crushed",
    "mortar.py: if gap < 1 and bond.strength < math.inf:": "what is open is not crushed by the law, either",
    "faces.py: if gap <= 0 and line.margin < math.inf:": "at a gap of zero nothing presses",
    "contact.py: if push <= 0 and line.push > 0:": "a push of zero has no friction in this way, too",
    "contact.py: if push < 1 and line.push > 0:": "a push of zero has no friction in this way, too",
    **{
        f"rest.py: {line}": "the search ends at the same pose"
        for line in (
            "share: float = 2.0",
            "POSES = 600",
            "SOFT_STARTS = 200.0, 0.01, 0.1",
            "SOFT_STARTS = 100.0, 0.02, 0.1",
            "SOFT_STARTS = 100.0, 0.01, 0.2",
            "loose, share = max(0.5 * self.loose, LEAST_LOOSE), max(0.25 * self.share, self.least_share)",
            "return LentStiffness(2 * self.loose, 1.0, min(RAISED / self.least_share, 1.0), missing)",
            "LOOSE, LEAST_LOOSE, MOST_LOOSE = 1e-9, 2e-12, 1.0",
            "LOOSE, LEAST_LOOSE, MOST_LOOSE = 2e-09, 1e-12, 1.0",
            "LOOSE, LEAST_LOOSE, MOST_LOOSE = 1e-9, 1e-12, 2.0",
        )
    },
    "rest.py: RIGID, RIGID_WITHOUT_LIMIT = 2000.0, 1e4": "faces are as good as rigid along themselves with either",
    "rest.py: RIGID, RIGID_WITHOUT_LIMIT = 1e3, 20000.0": "faces are as good as rigid along themselves with either",
    "rest.py: NEGLIGIBLE_STIFFNESS = 2e-12": "what is put down to rounding is far below what lets bodies fall",
    "rest.py: return pose.reshape(-2, potential.structure.places.freedom.nq)": "numpy takes any negative number so",
    "handover.py: sense = old.sense / new.sense": "a sense is 1 or -1",
    "handover.py: of_force, of_energy = (min(REGAINED, force_before / force), energy_before / energy) if force > 0 "
    "else (1, 0.0)": "where no place presses, none has an overlap that a share is taken of",
    "constants.py: AS_NEAR = 1 + 2e-06": "far above rounding, and far below how places differ",
    "contact.py: TOUCH_PASSES = 6": "more passes take time only",
    "contact.py: line.dashpot_force = push - spring_force if meet.gap <= 0 or push < 0 else 0.0": (
        "at a gap of zero nothing presses"
    ),
    "faces.py: GAP_OF_OPEN = 2.0": "at no gap above zero is anything left of a line",
    "faces.py: TURNED_OVER = 4 * GAP_OF_OPEN": "it is a number that no gap is",
    "clipping.py: best, largest = -2, -math.inf": "every block has a face",
    "clipping.py: normal, edge, from_edge = normal_of(solids, face), -2, math.inf": "every face has an edge",
    "clipping.py: crossed, from_crossed, one_place = -2, math.inf, ONE_PLACE * longest_edge(solids, face)": (
        "every face has an edge"
    ),
    **{
        f"clipping.py: {line}": "no place is so far from a corner to the last bit"
        for line in (
            "if norm(minus(at, corner)) <= one_place:",
            "if norm(off) <= one_place:",
        )
    },
    **{
        f"clipping.py: {line}": "what is no corner lies on one edge alone"
        for line in ("if distance <= from_edge:", "if distance <= from_crossed:")
    },
    "clipping.py: distance = distance_from(off, scaled(1, edge_below), edge_below)": (
        "both ends of an edge lie on its line"
    ),
    "clipping.py: faces = face, face_towards(solids, blocks[1], scaled(-2.0, normal_of(solids, face)))": (
        "a direction may have any length"
    ),
    **{
        f"finder.py: {line}": "there is more room than is taken"
        for line in (
            "self._work = Workspace(rows(PLACE, 512), np.empty((4 * most_corners + 4, 3)))",
            "self._work = Workspace(rows(PLACE, 256), np.empty((8 * most_corners + 4, 3)))",
            "self._work = Workspace(rows(PLACE, 256), np.empty((4 * most_corners + 8, 3)))",
            "self._work = Workspace(rows(PLACE, 256), np.empty((4 * most_corners + 4, 6)))",
            "self._work = self._work._replace(places=rows(PLACE, 4 * count))",
        )
    },
    **{
        f"finder.py: {line}": "the two ends of a prism are alike, and no place is between them"
        for line in (
            'at_end = table["at"][order, 1] < 0.5 * self._half',
            'at_end = table["at"][order, 1] > 0.25 * self._half',
        )
    },
    "finder.py: normal = normal * np.hypot(normal[:, 0], normal[:, 1])[:, None]": (
        "sides of prisms have normals in the plane, of unit length but for rounding"
    ),
    "finder.py: share = places.share * np.where(over, places.area / np.where(over, in_pair, 2.0), 1.0)": (
        "what an edge is divided by is not taken"
    ),
    "finder.py: other_face, other_distance = (-2, -math.inf) if distance > reach else separating_face(solids, b, a, "
    "reach)": "blocks beyond the reach are not searched further",
    **{
        f"finder.py: {line}": "a direction may have any length"
        for line in (
            "over = face_towards(solids, blocks[1], scaled(-2.0, normal_of(solids, face)))",
            "other_start, other_edge = edge_towards(solids, blocks[1], scaled(-2.0, normal))",
        )
    },
    **{
        f"finder.py: best: Vector = {way}": "where no direction is across both, none is taken"
        for way in ("(1, 0.0, 0.0)", "(0.0, 1, 0.0)", "(0.0, 0.0, 1)")
    },
    "finder.py: if size <= NOT_PARALLEL:": "no sine is the bound to the last bit",
    "faces.py: ROUNDS = 6": "more rounds take time only",
    "friction.py: SWEEPS = 100": "the sweeps have ended before",
    "friction.py: SETTLED = 0.002": "how near the impulses come, within what tests allow",
    "friction.py: STRIDE = 6": "another order of the lines ends at the same impulses",
    "friction.py: COMPLIANCE_OF_GUIDED = 2e-09": "any small number serves to divide by",
    "touches.py: if line.push <= 0:": "a line that does not push has nothing that is still to act",
    "touches.py: met: float = gap / rate if line.depth == 0 and h * rate <= gap else h": (
        "a line that met its face a step ago was closed for the step, in both ways"
    ),
    "supports.py: share = (t - supports.t[low]) / (supports.t[high] - supports.t[low]) if high > low else 1": (
        "a history of one sample has one place"
    ),
    "softening.py: nv, share = 3 * sides.normals.shape[1] - 3, np.ones(len(bodies) + 2)": (
        "the last share is read, and more of them are one"
    ),
    "step_length.py: return bool((self.lag(h) > LAGGED).any()) and self.step(h) > (1 - 2e-09) * h": (
        "any share of rounding serves"
    ),
    "softening.py: trace = 1": "the trace of the last square is taken",
    "softening.py: stiffness, powers = np.zeros((len(bodies), nv, nv)), np.empty((4, nv, nv))": (
        "the first two are used"
    ),
    "validity.py: for turn in range(4):": "the passes after the second one find the same",
    "validity.py: valid = max(VALID_APPROACH * size, 0.5 * places.gap[i]) / max(speed, 2e-09)": (
        "any small speed serves to divide by"
    ),
    "validity.py: may_touch[i] = places.gap[i] <= REACH * (speed * until + 2 * fall_within(interval) + NEAR * size)": (
        "no gap is the bound to the last bit"
    ),
    **{
        f"validity.py: {line}": "no time is the bound to the last bit"
        for line in (
            "outdated = (moved and valid_for <= SEARCHED_TOGETHER * interval) or speed * valid_for > kept",
            "validity.valid_for[block] = valid_for if valid_for > SEARCHED_TOGETHER * interval else interval",
        )
    },
    "validity.py: AXES = np.eye(6)": "the first three numbers of the first three rows are read",
    "loop.py: if len(system.tangents) > 1:": "in space, where inertias turn, a line has two tangential directions",
    "step_control.py: return 0 if h * control.frequency <= control.method.smooth else 1": "no step is at the limit",
}
"""Mutants that no test can notice, by module and changed line, and why."""


def modules() -> tuple[str, ...]:
    """Every module that holds compiled functions, the others of the method, and those that have tests of their own."""
    package = ROOT / "mjrock"
    hold = [path for path in package.rglob("*.py") if any(mark in path.read_bytes() for mark in MARKS)]
    found = {*OTHERS, *OWN, *BY_HAND, *(path.relative_to(package).as_posix() for path in hold)}
    return tuple(sorted(found))


@cache
def text_of(module: str) -> bytes:
    """The text of a module as it is."""
    return (ROOT / "mjrock" / module).read_bytes()


class Mutant(NamedTuple):
    """A change of a module: bytes `start` to `stop` of its text are replaced."""

    module: str
    start: int
    stop: int
    replacement: bytes

    def applied(self) -> bytes:
        """The text of the module with the change."""
        text = text_of(self.module)
        return text[: self.start] + self.replacement + text[self.stop :]

    def lines(self) -> tuple[int, str, str]:
        """Number of the line, and the line before and after the change."""
        text, changed = text_of(self.module), self.applied()
        number, begin = text.count(b"\n", 0, self.start), text.rfind(b"\n", 0, self.start) + 1
        return number + 1, *(source[begin:].partition(b"\n")[0].decode().strip() for source in (text, changed))

    def __str__(self) -> str:
        number, before, after = self.lines()
        return f"mjrock/{self.module}:{number}: {before}  ->  {after}"

    @property
    def known(self) -> str | None:
        """Why no test can notice it, or None."""
        return EQUIVALENT.get(f"{Path(self.module).name}: {self.lines()[2]}")


def doubled(value: float) -> float:
    """Another number: twice it, a half of a half, one for zero."""
    return {0: 1, 0.5: 0.25}.get(value, 2 * value)


def mutants_of(module: str) -> Iterator[Mutant]:
    """Every mutant of a module, but for indices, annotations and what an error says."""
    text = text_of(module)
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def begin(node: ast.AST) -> int:
        return starts[node.lineno - 1] + node.col_offset

    def end(node: ast.AST) -> int:
        return starts[node.end_lineno - 1] + node.end_col_offset

    def operator(kind: ast.AST, left: ast.AST, right: ast.AST) -> Iterator[Mutant]:
        if type(kind) in SWAPPED:
            before, after = SWAPPED[type(kind)]
            at = text.index(before.encode(), end(left), begin(right))
            yield Mutant(module, at, at + len(before), after.encode())

    def visit(node: ast.AST) -> Iterator[Mutant]:
        match node:
            case ast.BinOp(left=left, op=op, right=right):
                yield from operator(op, left, right)
            case ast.Compare(left=left, ops=ops, comparators=others):
                for kind, one, other in zip(ops, [left, *others], others, strict=False):
                    yield from operator(kind, one, other)
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                yield Mutant(module, begin(node), end(node), repr(doubled(value)).encode())
            case ast.Call(func=ast.Name(id="min" | "max" as name) as func):
                yield Mutant(module, begin(func), end(func), b"max" if name == "min" else b"min")
            case ast.UnaryOp(op=ast.Not()):
                yield Mutant(module, begin(node), begin(node) + len("not "), b"")
            case ast.AugAssign():
                yield Mutant(module, begin(node), end(node), b"pass")
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "slice", "decorator_list") or isinstance(node, ast.Raise):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from visit(child)

    return visit(ast.parse(text))


def survives(folder: Path, mutant: Mutant | None) -> bool:
    """Whether all tests pass on a mutant, or on the package as it is."""
    if mutant is not None:
        target = folder / "mjrock" / mutant.module
        target.write_bytes(mutant.applied())
    try:
        own = [] if mutant is None else [(jit, of.get(mutant.module, ())) for jit, of in (("1", BY_HAND), ("0", OWN))]
        return all(passes(folder, jit, names) for jit, names in (*own, *ROUNDS) if names)
    finally:
        if mutant is not None:
            target.write_bytes(text_of(mutant.module))


def passes(folder: Path, no_jit: str, names: tuple[str, ...]) -> bool:
    """Whether the tests of a round pass in a folder."""
    tests = [str(path) for name in names for path in (folder / "tests").rglob(f"test_{name}.py")]
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", *tests]
    setting = os.environ | {"NUMBA_DISABLE_JIT": no_jit, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(folder)}
    done = subprocess.run(command, cwd=folder, env=setting, capture_output=True, preexec_fn=limit_time, check=False)
    return done.returncode == 0


def limit_time() -> None:
    """End this process once it has taken the longest processor time, however busy the machine is."""
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))


def gone() -> list[str]:
    """What this script names that is no longer there: modules, tests, and mutants that no test can notice."""
    package, tests = ROOT / "mjrock", ROOT / "tests"
    named = {*OTHERS, *OWN, *BY_HAND}
    missing = sorted(f"mjrock/{name}" for name in named if not (package / name).exists())
    wanted = {name for names in (*BY_HAND.values(), *OWN.values(), *(names for _, names in ROUNDS)) for name in names}
    missing += sorted(f"test_{name}.py" for name in wanted if not any(tests.rglob(f"test_{name}.py")))
    suspects = [name for name in modules() if any(key.startswith(f"{Path(name).name}: ") for key in EQUIVALENT)]
    changes = [mutant for name in suspects if (package / name).exists() for mutant in mutants_of(name)]
    known = {f"{Path(mutant.module).name}: {mutant.lines()[2]}" for mutant in changes}
    return missing + [f"EQUIVALENT, {key}" for key in EQUIVALENT if key not in known]


def main() -> int:
    """Run the mutants that are asked for, and name the survivors."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("match", nargs="*", help="only mutants whose description holds one of these texts")
    parser.add_argument("--count", type=int, default=40, help="how many are drawn (0 for all)")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    if lost := gone():
        sys.exit("no longer there: " + "; ".join(lost))
    every = [mutant for module in modules() for mutant in mutants_of(module)]
    chosen = [one for one in every if any(text in str(one) for text in options.match or [""])]
    if 0 < options.count < len(chosen):
        chosen = random.Random(options.seed).sample(chosen, options.count)
    drawn = [one for one in chosen if one.known is None]
    if options.match and not chosen:
        sys.exit(f"no mutant holds any of {', '.join(options.match)}")
    print(f"{len(every)} mutants, {len(chosen)} drawn, {len(chosen) - len(drawn)} of them known to change nothing")
    survivors = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("mjrock", "tests", "scripts", "models"):
            shutil.copytree(ROOT / part, folder / part)
        shutil.copy(ROOT / "pyproject.toml", folder)
        if not survives(folder, None):
            sys.exit("the tests fail without any change")
        for number, mutant in enumerate(drawn, 1):
            if survives(folder, mutant):
                survivors += 1
                print(f"{number} survived: {mutant}", flush=True)
    print(f"{survivors} of {len(drawn)} survived")
    return int(survivors > 0)


if __name__ == "__main__":
    sys.exit(main())
