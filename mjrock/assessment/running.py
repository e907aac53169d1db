"""Records and runs of an assessment: the motion of a mechanism, its solver, and the restitution of its impacts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import product
from typing import Annotated, Any

from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.ground.motion import GroundMotion
from ..problem.ground.record_sets import RecordSet, records_in
from ..problem.ground.spectrum import SpectrumOfCode
from ..problem.wall.block import Block
from ..quantities import OneOf
from ..study.loading.dynamic_check import dynamic_check
from .declarations import Key, Maker, Makers, maker_of, makers_of
from .reading import Reader
from .tables import Table

RECORDS: Mapping[str, Makers] = {"records_in": {"": maker_of(records_in)}, "GroundMotion": makers_of(GroundMotion)}
"""What `[records]` stands for, by the name of `kind`: the files of a folder where none is named."""
SCALED = maker_of(RecordSet.scaled_to).without("self", "spectrum")
"""What `[records.scaled_to]` stands for: the records scaled to the spectrum of the site."""
DYNAMIC = maker_of(dynamic_check).without("runs", "curve", "store", "histories", "code")
"""What `[dynamic_check]` stands for."""
SOLVERS = "analytical", "explicit", "MuJoCo", "compliant"
"""The solvers, the quickest of a wall first."""
NOT_IN_FILE = "case", "contacts", "e", "start", "method"
"""Arguments of solvers that do not come from `[run]`."""


@dataclass(frozen=True)
class Shaking:
    """What moves a mechanism, and how its motion is solved.

    Args:
        records: horizontal motions, each with the number of its record.
        solver: "analytical", "explicit", "MuJoCo" or "compliant"; where none is named, that of `usual_solver`.
        polarities: whether each record is run in both polarities.
        options: of the solver.
        e: restitution of its impacts, for "analytical".
        contacts: its interfaces, for the others.
        dynamic: further arguments of `dynamic_check`.
    """

    records: tuple[GroundMotion, ...] = ()
    solver: str = "analytical"
    polarities: bool = True
    options: Mapping[str, object] = field(default_factory=dict)
    e: Restitution | None = None
    contacts: Contacts | None = None
    dynamic: Mapping[str, Any] = field(default_factory=dict)

    @property
    def motions(self) -> tuple[GroundMotion, ...]:
        """The motion of each run, in either polarity."""
        pairs = [record.polarities if self.polarities else (record,) for record in self.records]
        return tuple(motion for pair in pairs for motion in pair)


@cache
def run_maker(solver: str) -> Maker:
    """The keys of `[run]` for a solver: its options, and those that all have."""
    from ..study.analysis import solver_named

    shared_keys = {
        "solver": Key("solver", Annotated[str, OneOf(SOLVERS)], "analytical", "by which the motion is solved"),
        "polarities": Key("polarities", bool, True, "whether each record is run in both polarities"),
    }
    call = solver_named(solver)
    return Maker(call, shared_keys | dict(maker_of(call).without(*NOT_IN_FILE).keys), "How the mechanism is run.")


def shaking_of(reader: Reader, table: Table, wall: Block | None, spectrum: object) -> Shaking:
    """What moves a mechanism.

    Args:
        reader: which keeps what is wrong.
        table: of the mechanism.
        wall: its wall, None of masonry.
        spectrum: that of the site, to which records are scaled.
    """
    values: dict[str, Any] = {"solver": usual_solver(wall)}
    if not table.values.keys() & {"restitution", "contacts", "records", "run"}:
        return Shaking(solver=usual_solver(wall))
    if "restitution" in table.values or wall is not None:
        values["e"] = _made_of_wall(reader, table, "restitution", makers_of(Restitution), wall)
    if "contacts" in table.values:
        arguments = {} if values.get("e") is None else {"e": values["e"]}
        values["contacts"] = _made_of_wall(reader, table, "contacts", makers_of(Contacts), wall, arguments)
    if "run" in table.values:
        values |= _run(reader, reader.required_table(table, "run"), wall)
    if "dynamic_check" in table.values:
        values["dynamic"] = reader.arguments(reader.required_table(table, "dynamic_check"), DYNAMIC)
    if "records" in table.values:
        values["records"] = _records(reader, table, spectrum)
    return Shaking(**values)


def _made_of_wall(
    reader: Reader, table: Table, name: str, makers: Makers, wall: Block | None, given: Mapping[str, Any] | None = None
) -> Any:
    """Restitution or contacts of a wall; the usual ones where the file has no table of them."""
    own_table = reader.required_table(table, name) if name in table.values else Table((*table.place, name))
    if wall is None:
        raise reader.refusal(own_table.place, "{place} is of a wall, and masonry has joints; leave it out")
    maker, content = reader.choose_maker(own_table, {next(iter(makers.values())).call.__name__: makers})
    arguments = {"wall": wall, **(given or {})}
    return reader.make(content, maker, {key: arguments[key] for key in maker.keys if key in arguments})


def usual_solver(wall: Block | None) -> str:
    """The solver where none is named: theory of a wall, explicit steps of masonry, which take all that it may have."""
    return "explicit" if wall is None else "analytical"


def _run(reader: Reader, table: Table, wall: Block | None) -> dict[str, object]:
    """The solver and its options."""
    solver = reader.known_name(table, "solver", SOLVERS, usual_solver(wall))
    options = reader.arguments(table, run_maker(solver))
    options.pop("solver", None)
    polarities = {"polarities": options.pop("polarities")} if "polarities" in options else {}
    return {"solver": solver, "options": options} | polarities


def _records(reader: Reader, table: Table, spectrum: object) -> tuple[GroundMotion, ...]:
    """The horizontal motions of the records, scaled to the spectrum, and on the floor where there is one."""
    value = table.values["records"]
    tables = value if isinstance(value, list) else [reader.required_table(table, "records")]
    motions: list[GroundMotion] = []
    for own_table in tables:
        if not isinstance(own_table, Table):
            raise reader.refusal(table.place_of("records"), "{place} is no table and no list of tables")
        records = _records_of_table(reader, own_table.without("scaled_to"))
        if "scaled_to" in own_table.values:
            arguments = {"spectrum": _required_spectrum(reader, own_table, spectrum)}
            maker = replace(SCALED, call=records.scaled_to)
            records = reader.make(reader.required_table(own_table, "scaled_to"), maker, arguments)
        motions += records.horizontal
    if "floor" not in table.values:
        return tuple(motions)
    floor = reader.required_table(table, "floor")
    through = maker_of(GroundMotion.through_building).without("self")
    return tuple(reader.make(floor, replace(through, call=motion.through_building)) for motion in motions)


def _required_spectrum(reader: Reader, table: Table, spectrum: object) -> SpectrumOfCode:
    """The spectrum that records are scaled to."""
    if not isinstance(spectrum, SpectrumOfCode):
        raise reader.refusal(table.place_of("scaled_to"), "{place} needs a [site], to scale to")
    return spectrum


def _records_of_table(reader: Reader, table: Table) -> RecordSet:
    """The records of a table. One that makes a single motion makes one for each value where a key that takes a number
    has a list, as of seeds."""
    maker, content = reader.choose_maker(table, RECORDS, "records_in")
    lists = {
        name: value
        for name, value in content.values.items()
        if isinstance(value, list) and name in maker.keys and set(maker.keys[name].kinds) <= {int, float}
    }
    if not lists:
        records = reader.make(content, maker)
        return records if isinstance(records, RecordSet) else RecordSet({records.name: (records,)})
    records_by_value = RecordSet()
    for values in product(*lists.values()):
        motion = reader.make(replace(content, values=content.values | dict(zip(lists, values, strict=True))), maker)
        records_by_value[f"{len(records_by_value)}: {motion.name}"] = (motion,)
    return records_by_value
