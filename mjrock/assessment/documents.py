"""Objects as the plain tables of a file: the inverse of `reading`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass
from os import PathLike, fspath
from typing import Any

import numpy as np

from ..problem.ground.spectrum import CodeSpectrum, FloorSpectrum, PointSpectrum
from ..problem.masonry.histories import Support
from ..problem.wall.block import Block
from ..problem.wall.effect import CombinedEffect
from ..quantities import shown
from .declarations import USUAL_MAKE, Hint, Key, classes_of, is_public, items_of, key_named, kinds_of, maker_of
from .mechanisms import CHECK, CURVE, FLOOR, MECHANISMS, Mechanism
from .running import DYNAMIC, run_maker, usual_solver
from .tables import Place, spelt_place

Tables = dict[str, Any]
"""Tables of a file that are made."""
DERIVED = "joints"
"""The attribute that is not the argument of its name: the joints of masonry are those that its blocks have."""


class UnwrittenError(ValueError):
    """A value for which a file has no words.

    Args:
        place: the key that it would have.
        why: what it is, and the remedy.
    """

    def __init__(self, place: Place, why: str) -> None:
        self.place = place
        super().__init__(f"{spelt_place(place)} {why}")


def table_of(value: Any, kinds: Sequence[Hint], place: Place) -> Tables:
    """The table of a dataclass, with what is not its default.

    Args:
        value: of a public class.
        kinds: the types that the key may be of.
        place: the key.
    """
    kind: Any = type(value)
    table: Tables = {} if list(classes_of(kinds)) == [kind.__name__] else {"kind": kind.__name__}
    keys = {name: key for name, key in maker_of(kind, kind).keys.items() if name != DERIVED and hasattr(value, name)}
    if kind is Block:  # in whole sizes, as one writes it
        table |= {"thickness": 2 * value.b, "height": 2 * value.h}
        keys = {name: key for name, key in keys.items() if name not in ("b", "h")}
    elif kind.__name__ in USUAL_MAKE:
        table["make"] = kind.__name__
    values = {name: getattr(value, name) for name in keys}
    return table | values_of(
        {name: field for name, field in values.items() if not _is_default(field, keys[name].default)},
        keys,
        place,
    )


def values_of(values: Mapping[str, object], keys: Mapping[str, Key], place: Place) -> Tables:
    """Arguments by name as the keys of a table. None is left out."""
    table: Tables = {}
    for name, value in values.items():
        if name not in keys:
            raise UnwrittenError((*place, name), f"= {shown(value)} is no key of a file; leave it out")
        key = keys[name]
        if value is not None:
            table[key_named(key)] = file_value(value, key.kinds, (*place, key_named(key)))
    return table


def file_value(value: object, kinds: Sequence[Hint], place: Place) -> object:
    """A value as a file has it: a number, a text, a truth, a list or a table.

    Raises:
        UnwrittenError: for a function, and for what else a file has no words for.
    """
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, PathLike):
        return fspath(value)
    if is_dataclass(value) and not isinstance(value, type) and is_public(type(value)):
        name = getattr(value, "name", None)
        return name if str in kinds and isinstance(name, str) else table_of(value, kinds, place)
    if isinstance(value, Mapping):
        return {str(name): file_value(item, (), (*place, str(name))) for name, item in value.items()}
    if isinstance(value, Sequence) and all(isinstance(support, Support) for support in value) and value:
        return {support.block: file_value(support.histories, (), (*place, support.block)) for support in value}
    if isinstance(value, Sequence):
        wholes = [getattr(item, "report_item", item) for item in value]  # the wedges in the place of their masses
        pairs = [(combined, item) for combined, item in zip(wholes, value, strict=True) if combined is not None]
        items = [combined if isinstance(combined, CombinedEffect) else item for combined, item in pairs]
        hints = [hint for kind in kinds for hint in items_of(kind) or () if hint is not ...]
        item_kinds = [kind for hint in hints for kind in kinds_of(hint)]
        return [file_value(item, item_kinds, (*place, i)) for i, item in enumerate(items)]
    reason = "is a function" if callable(value) else f"= {shown(value)} is no number, text or table"
    raise UnwrittenError(place, f"{reason}, for which a file has no words; give a number, a text or a table")


def _is_default(value: object, default: object) -> bool:
    """Whether a value is the default of its argument."""
    return value is default or (isinstance(value, bool | int | float | str | tuple) and value == default)


def mechanism_table(mechanism: Mechanism, place: Place = ()) -> Tables:
    """A mechanism with what it is checked against, and its runs, as one table."""
    problem, shaking = mechanism.problem, mechanism.shaking
    if type(problem).__name__ not in MECHANISMS:
        raise UnwrittenError((*place, "problem"), f"= {shown(problem)} is not one of {', '.join(MECHANISMS)}")
    table: Tables = {"kind": type(problem).__name__} | table_of(problem, (type(problem),), place)
    table |= _demand(mechanism.demand, place)
    sections: dict[str, Any] = {"check": (mechanism.options, CHECK), "limit_curve": (mechanism.curve, CURVE)}
    for name, (values, maker) in (sections | {"dynamic_check": (shaking.dynamic, DYNAMIC)}).items():
        table |= {name: values_of(values, maker.keys, (*place, name))} if values else {}
    if shaking.records and "floor" in table:
        raise UnwrittenError((*place, "records"), "are those of the floor, and a file has those of the ground")
    for name, value in (("restitution", shaking.e), ("contacts", shaking.contacts)):
        table |= {} if value is None else {name: table_of(value, (type(value),), (*place, name))}
    if shaking.records:
        table["records"] = [
            {"kind": "GroundMotion"} | table_of(one, (type(one),), (*place, "records", i))
            for i, one in enumerate(shaking.records)
        ]
    options = values_of(shaking.options, run_maker(shaking.solver).keys, (*place, "run"))
    usual = {"solver": usual_solver(getattr(mechanism.case, "block", None)), "polarities": True}
    run = {name: getattr(shaking, name) for name, one in usual.items() if getattr(shaking, name) != one} | options
    return table | ({"run": run} if run else {})


def _demand(demand: object, place: Place) -> Tables:
    """The tables of what a mechanism is checked against: the site, and a floor that all limit states share."""
    if demand is None:
        return {}
    states = demand if isinstance(demand, Mapping) else {"": demand}
    site, floors = Tables(), list[Tables]()
    for name, spectrum in states.items():
        ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
        if not isinstance(ground, CodeSpectrum | PointSpectrum):
            raise UnwrittenError((*place, "site"), f"= {shown(ground)} is no spectrum of a code and no PointSpectrum")
        table = {"kind": type(ground).__name__} | table_of(ground, (type(ground),), (*place, "site"))
        site |= {name: table} if name else table
        floors.append(
            {key: file_value(getattr(spectrum, key), (), (*place, "floor", key)) for key in FLOOR.keys}
            if isinstance(spectrum, FloorSpectrum)
            else {}
        )
    if any(floor != floors[0] for floor in floors):
        raise UnwrittenError((*place, "floor"), "differs between limit states, and a file has one for all")
    return {"site": site} | ({"floor": floors[0]} if floors[0] else {})
