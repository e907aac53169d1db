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
from numpy.typing import ArrayLike

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
from ..quantities import GRAVITY, declared
from ..study.loading.demand import Demand
from ..study.loading.limit_analysis import LimitCurve
from ..study.loading.mechanism_curve import case_of
from .pictures import Run, by_variant
from .texts import BY_HAND, DASH, FOUND, GIVEN, LENGTH_DECIMALS, Words, effect_name, grouped, texts
from .verdicts import REVERSED, Mechanism, Subject, effect_label

LONGEST_TABLE = 60
"""Most blocks, and most joints, that stand in a table of the report. More of them stand in a file beside it."""
GROUPS_ABREAST = 3
"""Things whose inputs stand beside each other in one table."""
EFFECT_UNITS = {"height": "m", "anchor_height": "m", "strength": "N", "stiffness": "N/m", "damping": "N s/m"}
"""Units of fields of effects that are declared without one, or that a wall and masonry have alike."""
BLOCK_NUMBER_FIELDS = ("block", "anchor_block")
"""Fields of effects that are numbers of blocks."""
COLUMN_KEYS = {
    "blocks": ("block", "density", "length", "fixed", "vertices"),
    "joints": ("joint", "k_n", "k_s", "friction", "xi", "frequency", "points", "bond"),
    "pairs": ("block", "other", "friction", "xi", "frequency"),
    "histories": ("driven", "t", "d_1", "d_2", "d_3"),
}
"""What stands above the columns of each listing."""
NAMED_HEADER_FIELDS = ("EVENT_NAME", "EVENT_DATE_YYYYMMDD", "STATION_CODE", "STREAM")
"""Fields of the header of a motion that a report names as they are."""
SCALED_TO = re.compile(r"(?P<target>.+); factor (?P<factor>[\d.e+-]+) over T = (?P<periods>.+) s")
"""The entry of a header with the spectrum that its motion was scaled to, see `scaled_by`."""
ON_A_FLOOR = " on a floor"
"""How the names of motions and spectra of floors end."""


class Input(NamedTuple):
    """An input of the report.

    Args:
        key: its name in the program, by which the basis in a report names it.
        name: in words.
        value: with its unit.
        basis: what it rests on where the user gives nothing: "not_given"; "computed" of what follows from others;
            "assumed" of what the program takes where nothing is given.
    """

    key: str
    name: str
    value: str
    basis: str = "not_given"


class InputGroup(NamedTuple):
    """Inputs of one thing, under its name."""

    heading: str
    rows: list[Input]

    @property
    def numbered(self) -> dict[tuple[str, str, int], Input]:
        """The inputs by key, name, and the number among those of this key and name, such as several openings."""
        numbered: dict[tuple[str, str, int], Input] = {}
        for row in self.rows:
            number = sum(1 for key, name, _ in numbered if (key, name) == (row.key, row.name))
            numbered[row.key, row.name, number] = row
        return numbered


class InputColumns(NamedTuple):
    """Inputs of several things beside each other.

    Args:
        names: of the things.
        rows: an input of each thing in a row, None where it has none.
    """

    names: list[str]
    rows: list[list[Input | None]]


def side_by_side(groups: Sequence[InputGroup]) -> list[InputColumns]:
    """Inputs of several things beside each other, some in a table."""
    tables = []
    for start in range(0, len(groups), GROUPS_ABREAST):
        columns = [group.numbered for group in groups[start : start + GROUPS_ABREAST]]
        keys: list[tuple[str, str, int]] = []
        for column in columns:
            position = 0
            for key in column:
                if key not in keys:
                    keys.insert(position, key)
                position = keys.index(key) + 1
        names = [group.heading for group in groups[start : start + GROUPS_ABREAST]]
        tables.append(InputColumns(names, [[column.get(key) for column in columns] for key in keys]))
    return tables


class Listing(NamedTuple):
    """The blocks or the joints of masonry, or another table of its inputs.

    Args:
        key: one of `COLUMN_KEYS`.
        heading: in words.
        columns: what stands above each.
        rows: a row for each.
    """

    key: str
    heading: str
    columns: tuple[str, ...]
    rows: list[tuple[str, ...]]


def named_subjects(
    case_name: str, case: Subject, mechanisms: Sequence[Mechanism], runs: Sequence[Run]
) -> list[tuple[str, Subject]]:
    """What a report is of, each with its name: what its checks are of, what its runs are of but for the wall that
    stands for a corner in them, and the case, whose own name is given."""
    named = [(mechanism.name, subject) for mechanism in mechanisms for subject in mechanism.subjects]
    corners = {name for name, subject in [*named, (case_name, case)] if isinstance(subject, Corner)}
    cases_run = [(variant or case_name, of_one[0].response.case) for variant, of_one in by_variant(runs).items()]
    named += [(name, case_run) for name, case_run in cases_run if name not in corners]
    return [*named, (case_name, case)]


def merged_groups(groups: Iterable[InputGroup], left_out: str = "") -> list[InputGroup]:
    """Groups with the same inputs as one, with all of their names, of which `left_out` is left out beside others."""
    merged = [([name for name in names if name != left_out] or names, rows) for names, rows in grouped(groups)]
    return [InputGroup("; ".join(names), rows) for names, rows in merged]


def subject_groups(subjects: Sequence[tuple[str, object]], left_out: str, words: Words) -> list[InputGroup]:
    """What a report is of, with what acts on it, each under its names; see `merged_groups`."""
    groups = (InputGroup(name, INPUTS_OF[type(subject)](subject, words)) for name, subject in subjects)
    return merged_groups(groups, left_out)


def vertical_bending_inputs(bending: VerticalBending, words: Words) -> list[Input]:
    """A wall that bends between floors."""
    values = [("load", bending.load, "N"), ("bearing", bending.lever, "m"), ("crack_height", bending.crack_height, "m")]
    return [*block_inputs(bending.wall, words), *_numbers(values, words), *effect_inputs(bending.effects, words)]


def horizontal_bending_inputs(bending: HorizontalBending, words: Words) -> list[Input]:
    """A wall that bends between side walls."""
    crack = 0.5 * bending.wall.length if bending.crack is None else bending.crack
    values = [("thrust", bending.thrust, "N"), ("crack", crack, "m")]
    return [*block_inputs(bending.wall, words), *_numbers(values, words)]


def corner_inputs(corner: Corner, words: Words) -> list[Input]:
    """A corner that turns along its diagonal, with a rod in either wall for each tie."""
    numbers = ((key, getattr(corner, key), field.within.unit) for key, field in declared(Corner).items())
    effects = effect_inputs(corner.effects, words)
    ties = {f"tie_{i}" for i in range(len(corner.effects))}
    renamed = [row._replace(name=words("rods", name=row.name)) if row.key in ties else row for row in effects]
    return [*_numbers(numbers, words), *renamed]


def _numbers(numbers: Iterable[tuple[str, float, str]], words: Words, *, computed: bool = False) -> list[Input]:
    """Numbers with their keys and units as inputs; those that are computed have fewer digits."""
    digits, basis = (FOUND, "computed") if computed else (GIVEN, "not_given")
    quantities = ((key, words.quantity(value, unit, digits)) for key, value, unit in numbers)
    return [Input(key, words(f"in_{key}"), value, basis) for key, value in quantities]


def block_inputs(block: Block, words: Words) -> list[Input]:
    """A wall: its sizes and parts."""
    sizes = (
        ("thickness", 2 * block.b, "m"),
        ("height", 2 * block.h, "m"),
        ("length", block.length, "m"),
        ("density", block.density, "kg/m3"),
        ("inset", block.inset, "m"),
    )
    rows = _numbers(sizes, words)
    if block.profile is not None:
        steps = [words("profile", z=words.quantity(z, "m"), t=words.quantity(t, "m")) for z, t in block.profile]
        rows.append(Input("profile", words("in_profile"), "; ".join(steps)))
        rows.append(Input("plumb", words("in_plumb"), words(f"plumb_{block.plumb}")))
    if block.gable is not None:
        texts = {"height": words.quantity(block.gable.height, "m"), "top": words.quantity(block.gable.top, "m")}
        key = "gable" if block.gable.top else "gable_pointed"
        rows.append(Input("gable", words("in_gable"), words(key, **texts)))
    for opening, count in Counter(block.openings).items():
        name = "round_opening" if opening.round else "opening"
        texts = {key: words.number(getattr(opening, key)) for key in ("width", "height", "sill")}
        parts = [words("opening", **texts)]
        parts += [words("opening_at", at=words.quantity(opening.at, "m"))] if opening.at is not None else []
        parts += [words("field_number", value=count)] if count > 1 else []
        rows.append(Input(name, words(f"in_{name}"), ", ".join(parts)))
    rows += [Input("mass", words("effect_mass"), effect_text(mass, words)) for mass in block.masses]
    return rows


def case_inputs(case: Case, words: Words) -> list[Input]:
    """A wall that overturns."""
    wall, top, is_whole = case.wall, case.stop_top, case.side_stop is True
    stop = words("no_stop") if top is None else words("stop_up_to", top=words.quantity(top, "m"))
    side = Input("side_stop", words("in_side_stop"), words("whole_stop") if is_whole else stop)
    derived = (
        ("mass", wall.mass, "kg"),
        ("centroid_height", wall.centroid_height, "m"),
        ("alpha", wall.alpha, "rad"),
        ("overturning_rotation", case.overturning_rotation, "rad"),
        ("p", wall.p, "rad/s"),
    )
    chosen = [*block_inputs(case.block, words), side._replace(basis="assumed") if is_whole else side]
    return [*chosen, *_numbers(derived, words, computed=True), *effect_inputs(case.effects, words)]


def masonry_inputs(masonry: Masonry, words: Words) -> list[Input]:
    """Masonry: how many blocks and joints, and the ranges of what joints have."""
    mass = float(sum(masonry.blocks[i].mass for i in masonry.free))
    free, fixed = len(masonry.free), len(masonry.blocks) - len(masonry.free)
    points = value_range(masonry.table.points.astype(float), "", words)
    return [
        Input("blocks", words("in_blocks"), words("blocks_value", free=free, fixed=fixed)),
        Input("joints", words("in_joints"), words("joints_value", count=len(masonry.joints), points=points)),
        Input("mass", words("in_mass"), words.quantity(mass, "kg", FOUND), "computed"),
        Input("k_n", words("in_k_n"), value_range(masonry.joint_stiffness, "N/m3", words)),
        Input("k_s", words("in_k_s"), value_range(masonry.joint_shear, "N/m3", words)),
        Input("friction", words("in_friction"), value_range(masonry.joint_friction, "", words)),
        Input("damping", words("in_damping"), value_range(masonry.retardation, "s", words, FOUND), "computed"),
        *([] if masonry.pairs is None else [Input("pairs", words("in_pairs"), _pair_text(masonry, words))]),
    ]


def _pair_text(masonry: Masonry, words: Words) -> str:
    """What pairs of blocks without a joint have where they meet: that of all, or that a table has it."""
    dry = masonry.pairs
    if not isinstance(dry, Dry):
        return words("pairs_listed")
    return words("pairs_value", friction=words.number(dry.friction), xi=words.share(dry.xi))


def masonry_case_inputs(case: MasonryCase, words: Words) -> list[Input]:
    """Masonry with what acts on it, and what is driven."""
    rows = [*masonry_inputs(case.masonry, words), *effect_inputs(case.effects, words, case.masonry)]
    if case.supports:
        blocks = words.named([support.block for support in case.supports])
        rows.append(Input("supports", words("in_supports"), words("driven", names=blocks)))
    if case.tilt is not None:
        rows.append(Input("tilt", words("in_tilt"), words("driven", names=words("table_of_tilt"))))
    return rows if case.settled else [*rows, Input("settled", words("in_settled"), words("as_drawn"))]


def limit_curve_inputs(curve: LimitCurve, words: Words) -> list[Input]:
    """Masonry whose mechanism goes on."""
    masonry = curve.start.masonry
    if masonry is None:
        return []
    effects = effect_inputs(curve.effects, words, masonry)
    return [*masonry_inputs(masonry, words), *effects, *_growing_load_inputs(curve.start, words)]


def collapse_inputs(collapse: Collapse, words: Words) -> list[Input]:
    """Masonry or a wall at its limit, with the loads that grow."""
    if collapse.case is not None:
        return [*case_inputs(collapse.case, words), *_growing_load_inputs(collapse, words)]
    rows = [] if collapse.masonry is None else masonry_inputs(collapse.masonry, words)
    return [*rows, *effect_inputs(collapse.effects, words, collapse.masonry), *_growing_load_inputs(collapse, words)]


def _growing_load_inputs(collapse: Collapse, words: Words) -> list[Input]:
    """The loads that grow, of a wall as effects and of masonry on its blocks."""
    if isinstance(collapse.loads, tuple):
        effects = effect_inputs(collapse.loads, words, collapse.masonry)
        return [effect._replace(name=words("in_growing_effect", name=effect.name)) for effect in effects]
    rows = []
    for block, load in collapse.loads.items():
        units = ["N"] * len(collapse.direction) + ["N m"] * len(load)
        text = "; ".join(words.quantity(value, unit) for value, unit in zip(load, units, strict=False))
        rows.append(Input(f"load_{block}", words("in_growing", block=block), text))
    return rows


def value_range(values: ArrayLike, unit: str, words: Words, digits: int = GIVEN) -> str:
    """The lowest and the highest of values, or that they stick where all are infinite."""
    low, high = float(np.min(values)), float(np.max(values))
    if math.isinf(low):
        return words("sticks")
    ends = [words.quantity(value, unit, digits) for value in (low, high)]
    return ends[0] if ends[0] == ends[1] else words("range", low=ends[0], high=ends[1])


def listings(subject: Subject, words: Words, written: Callable[[float], str]) -> list[Listing]:
    """What takes a table of its own, in SI units, as `written` writes them: of masonry its blocks with their vertices,
    its joints with what each has, and pairs of blocks that have something of their own where they meet; of a case what
    is driven, over time."""
    masonry, rows_by_key = getattr(case_of(subject), "masonry", None), dict[str, list[tuple[str, ...]]]()
    if masonry is not None:
        rows_by_key = {"blocks": _block_rows(masonry, words, written), "joints": _joint_rows(masonry, written)}
        if callable(masonry.pairs):
            rows_by_key["pairs"] = _pair_rows(masonry, written)
    rows_by_key["histories"] = _history_rows(subject, words, written)
    return [
        Listing(key, words(f"list_{key}"), tuple(words(f"col_{name}") for name in COLUMN_KEYS[key]), rows)
        for key, rows in rows_by_key.items()
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
        bond_text = DASH if bond is None else "; ".join(written(x) for x in dataclasses.astuple(bond) if x is not None)
        rows.append((joint.name, *(written(float(number)) for number in numbers), bond_text))
    return rows


def _pair_rows(masonry: Masonry, written: Callable[[float], str]) -> list[tuple[str, ...]]:
    """A row for each pair of blocks that the function of the user gives something."""
    names = combinations(masonry.names, 2)
    pairs = ((name, other, requested_pair(masonry.pairs, name, other)) for name, other in names)
    return [
        (name, other, *(DASH if x is None else written(x) for x in (dry.friction, dry.xi, dry.frequency)))
        for name, other, dry in pairs
        if dry is not None
    ]


def _history_rows(subject: Subject, words: Words, written: Callable[[float], str]) -> list[tuple[str, ...]]:
    """A row for each time of what is driven: supports, actuators and a table that tilts."""
    rows = []
    for support in getattr(subject, "supports", ()):
        rows += [(support.block, *map(written, row)) for row in zip(*support.histories, strict=True)]
    for name, actuator in getattr(subject, "actuators", {}).items():
        label = effect_name(name, words)
        rows += [(label, written(t), written(d)) for t, d in zip(*actuator.displacement, strict=True)]
    if (tilt := getattr(subject, "tilt", None)) is not None:
        rows += [(words("table_of_tilt"), written(t), written(angle)) for t, angle in zip(*tilt, strict=True)]
    return [(*row, *[DASH] * (len(COLUMN_KEYS["histories"]) - len(row))) for row in rows]


def massless_load_names(subjects: Sequence[object], words: Words) -> list[str]:
    """The names of the loads on what a report is of, whose weight acts without mass."""
    forces_of_subjects = [constant_forces_of(getattr(subject, "effects", ())) for subject in subjects]
    loads = {
        effect_label(name, effect, words): None
        for forces in forces_of_subjects
        for name, (effect, force) in forces.items()
        if not any(force[:2]) and force[2] < 0 and effect.report_item is not None
    }
    return list(loads)


def effect_inputs(effects: Sequence[Effect], words: Words, masonry: Masonry | None = None) -> list[Input]:
    """The effects, on masonry with the names of their blocks."""
    effects_by_name = named_effects(effects)
    unnamed = [effect for effect in effects if effect not in effects_by_name.values()]
    effects_by_name |= {f"{effect.label}_{i}": effect for i, effect in enumerate(unnamed)}
    return [
        Input(name, effect_label(name, effect, words), effect_text(effect.report_item, words, masonry))
        for name, effect in effects_by_name.items()
        if effect.report_item is not None
    ]


def effect_text(effect: ReportItem, words: Words, masonry: Masonry | None = None) -> str:
    """An effect in words: each of its numbers with its name; its own text where the report has no words for it."""
    if not words.or_else(f"effect_{effect.label}", ""):
        return effect.description.replace("\n", " ")
    kind: Any = type(effect)  # mypy takes a class for a thing without a hash
    units = {name: "" if one.within.whole else one.within.unit for name, one in declared(kind).items()} | EFFECT_UNITS
    left_out = [name for name in ("prestress", "damping") if not getattr(effect, name, 1.0)]
    left_out += ["height", "offset"] if getattr(effect, "at", None) is not None else []
    parts = []
    for field in dataclasses.fields(kind):
        value, keys = getattr(effect, field.name), [f"field_{effect.label}_{field.name}", f"field_{field.name}"]
        keys = [f"field_masonry_{field.name}"] * (masonry is not None) + keys
        key = next((name for name in keys if name in texts()), "")
        if not key or value is None or value == math.inf or field.name in left_out:
            continue
        if field.name in BLOCK_NUMBER_FIELDS:
            parts += [] if masonry is None else [words(key, value=masonry.names[value])]
        elif isinstance(value, str):
            parts.append(words(key, value=words(f"word_{value}".replace(" ", "_"))))
        elif isinstance(value, tuple):
            parts.append(words(key, value="; ".join(words.number(x) for x in value)))
        else:
            parts.append(words(key, value=words.quantity(value, units.get(field.name, ""))))
    return ", ".join(parts)


def contact_inputs(e: Restitution | None, contacts: Contacts | None, words: Words) -> list[Input]:
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


def demand_groups(mechanisms: Sequence[Mechanism], words: Words) -> list[InputGroup]:
    """The seismic action of each kinematic check, each once, with the limit states that it is of."""
    named_demands: list[tuple[str, Demand]] = []
    for name, check, *_ in mechanisms:
        for states, demand in grouped(check.demands.items() if check else ()):
            of_some_states = check is not None and len(states) < len(check.demands)
            named_demands.append((f"{name}, {', '.join(states)}" if of_some_states else name, demand))
    return merged_groups(InputGroup(name, demand_inputs(demand, words)) for name, demand in named_demands)


def demand_inputs(demand: Demand, words: Words) -> list[Input]:
    """A seismic action: the spectrum of a code or of points, on the ground or on a floor, a record, or a function."""
    if isinstance(demand, FloorSpectrum):
        modes = (("T_k", demand.period, "s"), ("gamma", demand.participation, ""), ("psi", demand.height, ""))
        rows = [
            Input(key, words(f"in_{key}"), "; ".join(words.quantity(float(value), unit) for value in values))
            for key, values, unit in modes
        ]
        rows.insert(1, Input("xi_k", words("in_xi_k"), words.share(demand.damping)))
        peak = _numbers((("peak", demand.peak, "m/s2"),), words, computed=True)
        return [*demand_inputs(demand.ground, words), *rows, *peak]
    if isinstance(demand, CodeSpectrum):
        return _code_spectrum_inputs(demand, words)
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
            *_numbers(sizes, words),
            *header_inputs(demand, words),
        ]
    return [Input("spectrum", words("in_spectrum"), words("own_spectrum"))]


def _code_spectrum_inputs(spectrum: CodeSpectrum, words: Words) -> list[Input]:
    """The spectrum of a code on the ground: site, limit state and corner periods."""
    ag = f"{words.quantity(spectrum.ag, 'm/s2')} = {words.quantity(spectrum.ag / GRAVITY, 'g', 4)}"
    rows = [Input("spectrum", words("in_spectrum"), spectrum.code), Input("ag", words("in_ag"), ag)]
    rows.append(Input("F0", words("in_F0"), words.number(spectrum.amplification)))
    if spectrum.Tc is not None:
        rows += _numbers((("Tc", spectrum.Tc, "s"),), words)
    for key in ("soil", "topography"):
        if value := getattr(spectrum, key):
            rows.append(Input(key, words(f"in_{key}"), value))
    digits, basis = (GIVEN, "not_given") if spectrum.Tc is None else (BY_HAND, "computed")
    rows.append(Input("S", words("in_S"), words.number(spectrum.S, digits), basis))
    corners = (spectrum.TB, spectrum.TC, spectrum.TD, spectrum.TE)
    text = "; ".join(words.quantity(T, "s", digits) for T in corners)
    rows.append(Input("corners", words("in_corners"), text, basis))
    return [*rows, Input("spectrum_damping", words("in_spectrum_damping"), words.share(spectrum.damping))]


def header_inputs(motion: GroundMotion, words: Words) -> list[Input]:
    """Where a motion comes from and what was made of it, as its header has it."""
    parts = [motion.header[key].replace("_", "") for key in NAMED_HEADER_FIELDS if motion.header.get(key)]
    if scaled := SCALED_TO.fullmatch(motion.header.get("SCALED_TO", "")):
        parts.append(_scaling_text(scaled, words))
    if modes := motion.header.get("FLOOR"):
        shorter = re.sub(r"\d+\.\d+", lambda number: words.number(float(number[0])), modes)
        parts.append(shorter.replace("_", ""))
    return [Input("origin", words("in_origin"), "; ".join(parts))] if parts else []


def _scaling_text(scaled: re.Match[str], words: Words) -> str:
    """To which spectrum a record was scaled, and over which periods."""
    periods = [words.number(float(T)) for T in scaled["periods"].split(", ")]
    over = words("periods_of", low=periods[0], high=periods[-1], count=len(periods))
    if len(periods) <= GROUPS_ABREAST:
        over = ("; " if words.mark == "," else ", ").join(periods) + " s"
    target = scaled["target"].removesuffix(ON_A_FLOOR)
    text = words("points_spectrum") if target == "spectrum of points" else words.marked(target.replace("m/s2", "m/s²"))
    text = words("on_a_floor", name=text) if target != scaled["target"] else text
    return words("scaled_to", target=text, factor=words.number(float(scaled["factor"])), periods=over)


def record_name(motion: GroundMotion, words: Words) -> str:
    """What a record is called in a report: its station and component, or its own name, with what was made of it."""
    return _record_text(motion.name.removesuffix(REVERSED), motion.header, words)


def _record_text(name: str, header: Mapping[str, str], words: Words) -> str:
    """The name of a record of a header in words."""
    if name.endswith(ON_A_FLOOR):
        return words("on_a_floor", name=_record_text(name.removesuffix(ON_A_FLOOR), header, words))
    if scaled := re.fullmatch(r"(.+) x ([\d.e+-]+)", name):
        factor = words.number(float(scaled[2]), FOUND)
        return words("scaled_record", name=_record_text(scaled[1], header, words), factor=factor)
    if header.get("STATION_CODE") and header.get("STREAM"):
        return words("station", code=header["STATION_CODE"], component=header["STREAM"][-1])
    if synthetic := re.fullmatch(r"synthetic ([\d.e+-]+) m/s2, seed (\d+)", name):
        return words("artificial", peak=words.quantity(float(synthetic[1]), "m/s2"), seed=synthetic[2])
    return name


INPUTS_OF: dict[type, Callable[[Any, Words], list[Input]]] = {
    Case: case_inputs,
    MasonryCase: masonry_case_inputs,
    Masonry: masonry_inputs,
    VerticalBending: vertical_bending_inputs,
    HorizontalBending: horizontal_bending_inputs,
    Corner: corner_inputs,
    LimitCurve: limit_curve_inputs,
    Collapse: collapse_inputs,
}
"""The inputs of what a mechanism may be of."""
