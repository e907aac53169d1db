"""The inputs of a report: every wall, masonry, effect, contact and seismic action, by which a run can be repeated."""

from __future__ import annotations

import dataclasses
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.ground.motion import GroundMotion
from ..problem.ground.spectrum import CodeSpectrum, FloorSpectrum, PointSpectrum
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.laws.dry import Dry, requested_pair
from ..problem.masonry.limit.collapse import Collapse
from ..problem.masonry.masonry import Masonry
from ..problem.wall.bending import HorizontalBending, VerticalBending
from ..problem.wall.block import Block
from ..problem.wall.case import Case
from ..problem.wall.effect import Effect, ReportItem
from ..problem.wall.effects import constant_forces_of, named_effects
from ..problem.wall.wedge import Corner
from ..quantities import GRAVITY, Array, declared
from ..study.loading.demand import Demand
from ..study.loading.limit_analysis import LimitCurve
from ..study.loading.mechanism_curve import case_of
from .pictures import Run, by_variant
from .texts import BY_HAND, DASH, FOUND, GIVEN, LENGTH_DECIMALS, Words, effect_name, grouped, texts
from .verdicts import REVERSED, Mechanism, Subject, effect_label

LISTED = 60
"""Most blocks, and most joints, that stand in a table of the report. More of them stand in a file beside it."""
ABREAST = 3
"""Things whose inputs stand beside each other in one table."""
UNITS = {"height": "m", "anchor_height": "m", "strength": "N", "stiffness": "N/m", "damping": "N s/m"}
"""Units of fields of effects that are declared without one, or that a wall and masonry have alike."""
OF_BLOCKS = ("block", "anchor_block")
"""Fields of effects that are numbers of blocks."""
HEADS = {
    "blocks": ("block", "density", "length", "fixed", "vertices"),
    "joints": ("joint", "k_n", "k_s", "friction", "xi", "frequency", "points", "bond"),
    "pairs": ("block", "other", "friction", "xi", "frequency"),
    "histories": ("driven", "t", "d_1", "d_2", "d_3"),
}
"""What stands above the columns of each listing."""
MADE = ("EVENT_NAME", "EVENT_DATE_YYYYMMDD", "STATION_CODE", "STREAM")
"""Fields of the header of a motion that a report names as they are."""
SCALED = re.compile(r"(?P<target>.+); factor (?P<factor>[\d.e+-]+) over T = (?P<periods>.+) s")
"""The entry of a header with the spectrum that its motion was scaled to, see `scaled_by`."""
ON_A_FLOOR = " on a floor"
"""How the names of motions and spectra of floors end."""


class Input(NamedTuple):
    """An input of the report.

    Args:
        key: its name in the program, by which `basis` names it.
        name: in words.
        value: with its unit.
        rests: what it rests on where the user gives nothing: "not_given"; "computed" of what follows from others;
            "assumed" of what the program takes where nothing is given.
    """

    key: str
    name: str
    value: str
    rests: str = "not_given"


class Section(NamedTuple):
    """Inputs of one thing, under its name."""

    heading: str
    rows: list[Input]

    @property
    def numbered(self) -> dict[tuple[str, str, int], Input]:
        """The inputs by key, name, and the number among those of this key and name, such as several openings."""
        found: dict[tuple[str, str, int], Input] = {}
        for row in self.rows:
            number = sum(1 for key, name, _ in found if (key, name) == (row.key, row.name))
            found[row.key, row.name, number] = row
        return found


class Beside(NamedTuple):
    """Inputs of several things beside each other.

    Args:
        names: of the things.
        rows: an input of each thing in a row, None where it has none.
    """

    names: list[str]
    rows: list[list[Input | None]]


def beside(sections: Sequence[Section]) -> list[Beside]:
    """Inputs of several things beside each other, some in a table."""
    found = []
    for start in range(0, len(sections), ABREAST):
        columns = [section.numbered for section in sections[start : start + ABREAST]]
        order: list[tuple[str, str, int]] = []
        for column in columns:
            at = 0
            for one in column:
                if one not in order:
                    order.insert(at, one)
                at = order.index(one) + 1
        names = [section.heading for section in sections[start : start + ABREAST]]
        found.append(Beside(names, [[column.get(one) for column in columns] for one in order]))
    return found


class Listing(NamedTuple):
    """The blocks or the joints of masonry, or another table of its inputs.

    Args:
        key: one of `HEADS`.
        heading: in words.
        columns: what stands above each.
        rows: a row for each.
    """

    key: str
    heading: str
    columns: tuple[str, ...]
    rows: list[tuple[str, ...]]


def subjects(
    own: str, case: Subject, mechanisms: Sequence[Mechanism], runs: Sequence[Run]
) -> list[tuple[str, Subject]]:
    """What a report is of, each with its name: what its checks are of, what its runs are of but for the wall that
    stands for a corner in them, and the case, whose own name is given."""
    called = [(mechanism.name, subject) for mechanism in mechanisms for subject in mechanism.subjects]
    corners = {name for name, subject in [*called, (own, case)] if isinstance(subject, Corner)}
    shaken = [(name or own, some[0].response.case) for name, some in by_variant(runs).items()]
    called += [(name, of) for name, of in shaken if name not in corners]
    return [*called, (own, case)]


def merged(sections: Iterable[Section], own: str = "") -> list[Section]:
    """Sections with the same inputs as one, with all of their names, of which `own` is left out beside others."""
    found = grouped(sections)
    return [Section("; ".join([name for name in names if name != own] or names), rows) for names, rows in found]


def of_subjects(subjects: Sequence[tuple[str, object]], own: str, words: Words) -> list[Section]:
    """What a report is of, with what acts on it, each under its names; see `merged`."""
    return merged((Section(name, INPUTS_OF[type(one)](one, words)) for name, one in subjects), own)


def of_vertical_bending(bending: VerticalBending, words: Words) -> list[Input]:
    """A wall that bends between floors."""
    given = [("load", bending.load, "N"), ("bearing", bending.lever, "m"), ("crack_height", bending.crack_height, "m")]
    return [*of_block(bending.wall, words), *_rows(given, words), *of_effects(bending.effects, words)]


def of_horizontal_bending(bending: HorizontalBending, words: Words) -> list[Input]:
    """A wall that bends between side walls."""
    crack = 0.5 * bending.wall.length if bending.crack is None else bending.crack
    return [*of_block(bending.wall, words), *_rows([("thrust", bending.thrust, "N"), ("crack", crack, "m")], words)]


def of_corner(corner: Corner, words: Words) -> list[Input]:
    """A corner that turns along its diagonal, with a rod in either wall for each tie."""
    sizes = ((key, getattr(corner, key), one.within.unit) for key, one in declared(Corner).items())
    effects = of_effects(corner.effects, words)
    ties = {f"tie_{i}" for i in range(len(corner.effects))}
    named = [one._replace(name=words("rods", name=one.name)) if one.key in ties else one for one in effects]
    return [*_rows(sizes, words), *named]


def _rows(values: Iterable[tuple[str, float, str]], words: Words, *, computed: bool = False) -> list[Input]:
    """Numbers with their keys and units as inputs; those that are computed have fewer digits."""
    digits, rests = (FOUND, "computed") if computed else (GIVEN, "not_given")
    quantities = ((key, words.quantity(value, unit, digits)) for key, value, unit in values)
    return [Input(key, words(f"in_{key}"), value, rests) for key, value in quantities]


def of_block(block: Block, words: Words) -> list[Input]:
    """A wall: its sizes and parts."""
    sizes = (
        ("thickness", 2 * block.b, "m"),
        ("height", 2 * block.h, "m"),
        ("length", block.length, "m"),
        ("density", block.density, "kg/m3"),
        ("inset", block.inset, "m"),
    )
    rows = _rows(sizes, words)
    if block.profile is not None:
        steps = [words("profile", z=words.quantity(z, "m"), t=words.quantity(t, "m")) for z, t in block.profile]
        rows.append(Input("profile", words("in_profile"), "; ".join(steps)))
        rows.append(Input("plumb", words("in_plumb"), words(f"plumb_{block.plumb}")))
    if block.gable is not None:
        given = {"height": words.quantity(block.gable.height, "m"), "top": words.quantity(block.gable.top, "m")}
        kind = "gable" if block.gable.top else "gable_pointed"
        rows.append(Input("gable", words("in_gable"), words(kind, **given)))
    for opening, count in Counter(block.openings).items():
        name = "round_opening" if opening.round else "opening"
        given = {key: words.number(getattr(opening, key)) for key in ("width", "height", "sill")}
        parts = [words("opening", **given)]
        parts += [words("opening_at", at=words.quantity(opening.at, "m"))] if opening.at is not None else []
        parts += [words("field_number", value=count)] if count > 1 else []
        rows.append(Input(name, words(f"in_{name}"), ", ".join(parts)))
    rows += [Input("mass", words("effect_mass"), described(mass, words)) for mass in block.masses]
    return rows


def of_case(case: Case, words: Words) -> list[Input]:
    """A wall that overturns."""
    wall, top, whole = case.wall, case.stop_top, case.side_stop is True
    stop = words("no_stop") if top is None else words("stop_up_to", top=words.quantity(top, "m"))
    side = Input("side_stop", words("in_side_stop"), words("whole_stop") if whole else stop)
    found = (
        ("mass", wall.mass, "kg"),
        ("centroid_height", wall.centroid_height, "m"),
        ("alpha", wall.alpha, "rad"),
        ("overturning_rotation", case.overturning_rotation, "rad"),
        ("p", wall.p, "rad/s"),
    )
    given = [*of_block(case.block, words), side._replace(rests="assumed") if whole else side]
    return [*given, *_rows(found, words, computed=True), *of_effects(case.effects, words)]


def of_masonry(masonry: Masonry, words: Words) -> list[Input]:
    """Masonry: how many blocks and joints, and the ranges of what joints have."""
    mass = float(sum(masonry.blocks[i].mass for i in masonry.free))
    free, fixed = len(masonry.free), len(masonry.blocks) - len(masonry.free)
    points = _span(masonry.table.points.astype(float), "", words)
    return [
        Input("blocks", words("in_blocks"), words("blocks_value", free=free, fixed=fixed)),
        Input("joints", words("in_joints"), words("joints_value", count=len(masonry.joints), points=points)),
        Input("mass", words("in_mass"), words.quantity(mass, "kg", FOUND), "computed"),
        Input("k_n", words("in_k_n"), _span(masonry.joint_stiffness, "N/m3", words)),
        Input("k_s", words("in_k_s"), _span(masonry.joint_shear, "N/m3", words)),
        Input("friction", words("in_friction"), _span(masonry.joint_friction, "", words)),
        Input("damping", words("in_damping"), _span(masonry.retardation, "s", words, FOUND), "computed"),
        *([] if masonry.pairs is None else [Input("pairs", words("in_pairs"), _of_pairs(masonry, words))]),
    ]


def _of_pairs(masonry: Masonry, words: Words) -> str:
    """What pairs of blocks without a joint have where they meet: that of all, or that a table has it."""
    dry = masonry.pairs
    if not isinstance(dry, Dry):
        return words("pairs_listed")
    return words("pairs_value", friction=words.number(dry.friction), xi=words.share(dry.xi))


def of_masonry_case(case: MasonryCase, words: Words) -> list[Input]:
    """Masonry with what acts on it, and what is driven."""
    rows = [*of_masonry(case.masonry, words), *of_effects(case.effects, words, case.masonry)]
    if case.supports:
        blocks = words.named([support.block for support in case.supports])
        rows.append(Input("supports", words("in_supports"), words("driven", names=blocks)))
    if case.tilt is not None:
        rows.append(Input("tilt", words("in_tilt"), words("driven", names=words("table_of_tilt"))))
    return rows if case.settled else [*rows, Input("settled", words("in_settled"), words("as_drawn"))]


def of_limit_curve(curve: LimitCurve, words: Words) -> list[Input]:
    """Masonry whose mechanism goes on."""
    masonry = curve.start.masonry
    if masonry is None:
        return []
    effects = of_effects(curve.effects, words, masonry)
    return [*of_masonry(masonry, words), *effects, *_growing(curve.start, words)]


def of_collapse(found: Collapse, words: Words) -> list[Input]:
    """Masonry or a wall at its limit, with the loads that grow."""
    if found.case is not None:
        return [*of_case(found.case, words), *_growing(found, words)]
    rows = [] if found.masonry is None else of_masonry(found.masonry, words)
    return [*rows, *of_effects(found.effects, words, found.masonry), *_growing(found, words)]


def _growing(found: Collapse, words: Words) -> list[Input]:
    """The loads that grow, of a wall as effects and of masonry on its blocks."""
    if isinstance(found.loads, tuple):
        effects = of_effects(found.loads, words, found.masonry)
        return [one._replace(name=words("in_growing_effect", name=one.name)) for one in effects]
    rows = []
    for block, load in found.loads.items():
        units = ["N"] * len(found.direction) + ["N m"] * len(load)
        text = "; ".join(words.quantity(value, unit) for value, unit in zip(load, units, strict=False))
        rows.append(Input(f"load_{block}", words("in_growing", block=block), text))
    return rows


def _span(values: Array, unit: str, words: Words, digits: int = GIVEN) -> str:
    """The lowest and the highest of values."""
    low, high = (float(end) for end in (values.min(), values.max()))
    if np.isinf(low):
        return words("sticks")
    ends = [words.quantity(value, unit, digits) for value in (low, high)]
    return ends[0] if low == high else words("range", low=ends[0], high=ends[1])


def listings(subject: Subject, words: Words, written: Callable[[float], str]) -> list[Listing]:
    """What takes a table of its own, in SI units, as `written` writes them: of masonry its blocks with their vertices,
    its joints with what each has, and pairs of blocks that have something of their own where they meet; of a case what
    is driven, over time."""
    masonry, found = getattr(case_of(subject), "masonry", None), dict[str, list[tuple[str, ...]]]()
    if masonry is not None:
        found = {"blocks": _block_rows(masonry, words, written), "joints": _joint_rows(masonry, written)}
        if callable(masonry.pairs):
            found["pairs"] = _pair_rows(masonry, written)
    found["histories"] = _history_rows(subject, words, written)
    return [
        Listing(key, words(f"list_{key}"), tuple(words(f"col_{name}") for name in HEADS[key]), rows)
        for key, rows in found.items()
        if rows
    ]


def _block_rows(masonry: Masonry, words: Words, written: Callable[[float], str]) -> list[tuple[str, ...]]:
    """A row for each part of each block."""
    rows = list[tuple[str, ...]]()
    for name, block in zip(masonry.names, masonry.blocks, strict=True):
        for part in block.parts:
            corners = [[written(round(x, LENGTH_DECIMALS) + 0.0) for x in vertex] for vertex in part.vertices]
            vertices = " ".join(f"({'; '.join(corner)})" for corner in corners)
            length = written(part.length) if hasattr(part, "length") else DASH
            rows.append((name, written(part.density), length, words("fixed" if block.fixed else "free"), vertices))
    return rows


def _joint_rows(masonry: Masonry, written: Callable[[float], str]) -> list[tuple[str, ...]]:
    """A row for each joint."""
    table, rows = masonry.table, list[tuple[str, ...]]()
    for i, joint in enumerate(masonry.joints):
        bond = table.bonds[i]
        numbers = (table.k_n[i], table.k_s[i], table.friction[i], table.xi[i], table.frequency[i], table.points[i])
        held = DASH if bond is None else "; ".join(written(x) for x in dataclasses.astuple(bond) if x is not None)
        rows.append((joint.name, *(written(float(x)) for x in numbers), held))
    return rows


def _pair_rows(masonry: Masonry, written: Callable[[float], str]) -> list[tuple[str, ...]]:
    """A row for each pair of blocks that the function of the user gives something."""
    named = combinations(masonry.names, 2)
    given = ((one, other, requested_pair(masonry.pairs, one, other)) for one, other in named)
    return [
        (one, other, *(DASH if x is None else written(x) for x in (dry.friction, dry.xi, dry.frequency)))
        for one, other, dry in given
        if dry is not None
    ]


def _history_rows(subject: Subject, words: Words, written: Callable[[float], str]) -> list[tuple[str, ...]]:
    """A row for each time of what is driven: supports, actuators and a table that tilts."""
    rows = []
    for support in getattr(subject, "supports", ()):
        rows += [(support.block, *map(written, row)) for row in zip(*support.histories, strict=True)]
    for name, jack in getattr(subject, "actuators", {}).items():
        rows += [(effect_name(name, words), written(t), written(d)) for t, d in zip(*jack.displacement, strict=True)]
    if (tilt := getattr(subject, "tilt", None)) is not None:
        rows += [(words("table_of_tilt"), written(t), written(angle)) for t, angle in zip(*tilt, strict=True)]
    return [(*row, *[DASH] * (len(HEADS["histories"]) - len(row))) for row in rows]


def loads_in(subjects: Sequence[object], words: Words) -> list[str]:
    """The names of the loads on what a report is of, whose weight acts without mass."""
    found = [constant_forces_of(getattr(one, "effects", ())) for one in subjects]
    loads = {
        effect_label(name, effect, words): None
        for named in found
        for name, (effect, force) in named.items()
        if not any(force[:2]) and force[2] < 0 and effect.report_item is not None
    }
    return list(loads)


def of_effects(effects: Sequence[Effect], words: Words, masonry: Masonry | None = None) -> list[Input]:
    """The effects, on masonry with the names of their blocks."""
    named = named_effects(effects)
    others = [effect for effect in effects if effect not in named.values()]
    named |= {f"{effect.label}_{i}": effect for i, effect in enumerate(others)}
    return [
        Input(name, effect_label(name, one, words), described(one.report_item, words, masonry))
        for name, one in named.items()
        if one.report_item is not None
    ]


def described(effect: ReportItem, words: Words, masonry: Masonry | None = None) -> str:
    """An effect in words: each of its numbers with its name; its own text where the report has no words for it."""
    if not words.or_else(f"effect_{effect.label}", ""):
        return effect.description.replace("\n", " ")
    kind: Any = type(effect)  # mypy takes a class for a thing without a hash
    units = {name: "" if one.within.whole else one.within.unit for name, one in declared(kind).items()} | UNITS
    left_out = [name for name in ("prestress", "damping") if not getattr(effect, name, 1.0)]
    left_out += ["height", "offset"] if getattr(effect, "at", None) is not None else []
    parts = []
    for field in dataclasses.fields(kind):
        value, names = getattr(effect, field.name), [f"field_{effect.label}_{field.name}", f"field_{field.name}"]
        names = [f"field_masonry_{field.name}"] * (masonry is not None) + names
        key = next((name for name in names if name in texts()), "")
        if not key or value is None or value == math.inf or field.name in left_out:
            continue
        if field.name in OF_BLOCKS:
            parts += [] if masonry is None else [words(key, value=masonry.names[value])]
        elif isinstance(value, str):
            parts.append(words(key, value=words(f"word_{value}".replace(" ", "_"))))
        elif isinstance(value, tuple):
            parts.append(words(key, value="; ".join(words.number(x) for x in value)))
        else:
            parts.append(words(key, value=words.quantity(value, units.get(field.name, ""))))
    return ", ".join(parts)


def of_contacts(e: Restitution | None, contacts: Contacts | None, words: Words) -> list[Input]:
    """Restitution, stiffness and damping."""
    rows = []
    if e is not None:
        for name in ("base", "side", "lumped"):
            rows.append(Input(f"e_{name}", words(f"in_e_{name}"), words.number(getattr(e, name), FOUND)))
    if contacts is not None:
        law = words.or_else(f"law_{contacts.law.lower()}", contacts.law)
        rows.append(Input("law", words("in_law"), law))
        for name, face in (("base", contacts.base), ("side", contacts.side)):
            if face is not None:
                friction = words("sticks") if face.friction is None else words.number(face.friction)
                values = {"k": words.quantity(face.k_n, "N/m3"), "xi": words.share(face.xi), "points": face.points}
                rows.append(Input(f"k_{name}", words(f"in_k_{name}"), words("face", friction=friction, **values)))
    return rows


def of_demands(mechanisms: Sequence[Mechanism], words: Words) -> list[Section]:
    """The seismic action of each kinematic check, each once, with the limit states that it is of."""
    called: list[tuple[str, Demand]] = []
    for name, check, *_ in mechanisms:
        for states, demand in grouped(check.demands.items() if check else ()):
            alone = check is not None and len(states) < len(check.demands)
            called.append((f"{name}, {', '.join(states)}" if alone else name, demand))
    return merged(Section(name, of_demand(demand, words)) for name, demand in called)


def of_demand(demand: Demand, words: Words) -> list[Input]:
    """A seismic action: the spectrum of a code or of points, on the ground or on a floor, a record, or a function."""
    if isinstance(demand, FloorSpectrum):
        modes = (("T_k", demand.period, "s"), ("gamma", demand.participation, ""), ("psi", demand.height, ""))
        rows = [
            Input(key, words(f"in_{key}"), "; ".join(words.quantity(float(value), unit) for value in values))
            for key, values, unit in modes
        ]
        rows.insert(1, Input("xi_k", words("in_xi_k"), words.share(demand.damping)))
        return [*of_demand(demand.ground, words), *rows, *_rows((("peak", demand.peak, "m/s2"),), words, computed=True)]
    if isinstance(demand, CodeSpectrum):
        return _of_code(demand, words)
    if isinstance(demand, PointSpectrum):
        points = zip(demand.period.tolist(), demand.acceleration.tolist(), strict=True)
        text = "; ".join(f"{words.quantity(T, 's')}: {words.quantity(a, 'm/s2')}" for T, a in points)
        return [
            Input("points", words("in_points"), text),
            Input("spectrum_damping", words("in_spectrum_damping"), words.share(demand.damping)),
        ]
    if isinstance(demand, GroundMotion):
        sizes = (("peak", demand.peak, "m/s2"), ("duration", demand.duration, "s"), ("step", demand.dt, "s"))
        return [
            Input("record", words("in_record"), record_name(demand, words)),
            *_rows(sizes, words),
            *of_header(demand, words),
        ]
    return [Input("spectrum", words("in_spectrum"), words("own_spectrum"))]


def _of_code(spectrum: CodeSpectrum, words: Words) -> list[Input]:
    """The spectrum of a code on the ground: site, limit state and corner periods."""
    ag = f"{words.quantity(spectrum.ag, 'm/s2')} = {words.quantity(spectrum.ag / GRAVITY, 'g', 4)}"
    rows = [Input("spectrum", words("in_spectrum"), spectrum.code), Input("ag", words("in_ag"), ag)]
    rows.append(Input("F0", words("in_F0"), words.number(spectrum.amplification)))
    if spectrum.Tc is not None:
        rows += _rows((("Tc", spectrum.Tc, "s"),), words)
    for key in ("soil", "topography"):
        if value := getattr(spectrum, key):
            rows.append(Input(key, words(f"in_{key}"), value))
    digits, rests = (GIVEN, "not_given") if spectrum.Tc is None else (BY_HAND, "computed")
    rows.append(Input("S", words("in_S"), words.number(spectrum.S, digits), rests))
    corners = (spectrum.TB, spectrum.TC, spectrum.TD, spectrum.TE)
    text = "; ".join(words.quantity(T, "s", digits) for T in corners)
    rows.append(Input("corners", words("in_corners"), text, rests))
    return [*rows, Input("spectrum_damping", words("in_spectrum_damping"), words.share(spectrum.damping))]


def of_header(motion: GroundMotion, words: Words) -> list[Input]:
    """Where a motion comes from and what was made of it, as its header has it."""
    parts = [motion.header[key].replace("_", "") for key in MADE if motion.header.get(key)]
    if scaled := SCALED.fullmatch(motion.header.get("SCALED_TO", "")):
        parts.append(_scaled(scaled, words))
    if modes := motion.header.get("FLOOR"):
        shorter = re.sub(r"\d+\.\d+", lambda found: words.number(float(found[0])), modes)
        parts.append(shorter.replace("_", ""))
    return [Input("origin", words("in_origin"), "; ".join(parts))] if parts else []


def _scaled(scaled: re.Match[str], words: Words) -> str:
    """To which spectrum a record was scaled, and over which periods."""
    periods = [words.number(float(T)) for T in scaled["periods"].split(", ")]
    over = words("periods_of", low=periods[0], high=periods[-1], count=len(periods))
    if len(periods) <= ABREAST:
        over = ("; " if words.mark == "," else ", ").join(periods) + " s"
    target = scaled["target"].removesuffix(ON_A_FLOOR)
    text = words("points_spectrum") if target == "spectrum of points" else words.marked(target.replace("m/s2", "m/s²"))
    text = words("on_a_floor", name=text) if target != scaled["target"] else text
    return words("scaled_to", target=text, factor=words.number(float(scaled["factor"])), periods=over)


def record_name(motion: GroundMotion, words: Words) -> str:
    """What a record is called in a report: its station and component, or its own name, with what was made of it."""
    return _called(motion.name.removesuffix(REVERSED), motion.header, words)


def _called(name: str, header: Mapping[str, str], words: Words) -> str:
    """The name of a record of a header in words."""
    if name.endswith(ON_A_FLOOR):
        return words("on_a_floor", name=_called(name.removesuffix(ON_A_FLOOR), header, words))
    if scaled := re.fullmatch(r"(.+) x ([\d.e+-]+)", name):
        factor = words.number(float(scaled[2]), FOUND)
        return words("scaled_record", name=_called(scaled[1], header, words), factor=factor)
    if header.get("STATION_CODE") and header.get("STREAM"):
        return words("station", code=header["STATION_CODE"], component=header["STREAM"][-1])
    if drawn := re.fullmatch(r"synthetic ([\d.e+-]+) m/s2, seed (\d+)", name):
        return words("artificial", peak=words.quantity(float(drawn[1]), "m/s2"), seed=drawn[2])
    return name


INPUTS_OF: dict[type, Callable[[Any, Words], list[Input]]] = {
    Case: of_case,
    MasonryCase: of_masonry_case,
    Masonry: of_masonry,
    VerticalBending: of_vertical_bending,
    HorizontalBending: of_horizontal_bending,
    Corner: of_corner,
    LimitCurve: of_limit_curve,
    Collapse: of_collapse,
}
"""The inputs of what a mechanism may be of."""
