"""The mechanisms of a file, and the demand of each check."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, get_args

from ..problem.damping.restitution import Restitution
from ..problem.ground.spectrum import CodeSpectrum, FloorSpectrum, PointSpectrum, code_spectrum
from ..problem.masonry.case import MasonryCase
from ..problem.wall.bending import HorizontalBending, VerticalBending
from ..problem.wall.case import Case
from ..quantities import Implausible, Message, reason, warn_of
from ..result.response import Response
from ..study.loading.code import USUAL_CODE, code_of
from ..study.loading.demand import Demand, required_demands
from ..study.loading.dynamic_check import DynamicCheck, dynamic_check
from ..study.loading.limit_analysis import LimitCurve, limit_curve
from ..study.loading.mechanism_check import MechanismCheck, mechanism_check
from ..study.loading.mechanism_curve import Checked, case_of
from .declarations import Maker, Makers, key_named, maker_of, makers_of
from .reading import OWN_KEYS, Reader, RefusedError, caused
from .running import Shaking, shaking_of
from .tables import Place, Table

if TYPE_CHECKING:  # tasks bring MuJoCo, which a kinematic check does not need
    from ..study.analysis import Analysis

Problem = Checked | MasonryCase
MECHANISMS: Mapping[str, Makers] = {
    kind.__name__: makers_of(kind) for kind in (*get_args(Checked), MasonryCase) if kind is not LimitCurve
}
"""What a mechanism may be, by the name of `kind`."""
SITES: Mapping[str, Makers] = {
    "code_spectrum": {"": maker_of(code_spectrum)},
    **{kind.__name__: makers_of(kind) for kind in (PointSpectrum, CodeSpectrum)},
}
"""What `[site]` stands for, by the name of `kind`: the first where none is named."""
FLOOR = maker_of(CodeSpectrum.at_height).without("self")
"""What `[floor]` stands for: the spectrum of the site at a height of a building."""
CHECK = maker_of(mechanism_check).without("case", "demand")
"""What `[check]` stands for."""
CURVE = maker_of(limit_curve).without("masonry", "effects")
"""What `[limit_curve]` stands for, of masonry of blocks."""
SECTIONS = ("site", "floor", "check", "limit_curve", "restitution", "contacts", "records", "run", "dynamic_check")
"""Tables beside those of the mechanism itself."""


@dataclass(frozen=True)
class Mechanism:
    """One mechanism of an assessment.

    Args:
        problem: the wall and its effects, or what else is checked.
        demand: what it is checked against: a spectrum, or one for each limit state by name; None where the file has no
            site.
        options: further arguments of `mechanism_check`.
        curve: further arguments of `limit_curve`, of masonry of blocks.
        shaking: its records and runs.
        place: its table in the file.
    """

    problem: Problem
    demand: Demand | Mapping[str, Demand] | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    curve: Mapping[str, Any] = field(default_factory=dict)
    shaking: Shaking = field(default_factory=Shaking)
    place: Place = field(default=(), compare=False)

    @property
    def case(self) -> Case | MasonryCase:
        """The case that is run, see `case_of`."""
        return case_of(self.problem)

    def check(self) -> MechanismCheck:
        """Its kinematic check, see `mechanism_check`.

        Raises:
            ValueError: as `mechanism_check` and `limit_curve` do, and without a demand.
        """
        if self.demand is None:
            raise ValueError(Message("has no site, which a check is against; give it a table [site] with ag and soil"))
        subject: Any = self.problem if self.limit_curve is None else self.limit_curve
        return mechanism_check(subject, self.demand, **self.options)

    @cached_property
    def limit_curve(self) -> LimitCurve | None:
        """The curve of masonry of blocks that is checked; None of a wall."""
        if isinstance(self.problem, Checked):
            return None
        return limit_curve(self.problem.masonry, effects=self.problem.effects, **self.curve)

    @property
    def is_wall(self) -> bool:
        """Whether it is of a wall or a corner, and not of masonry of blocks."""
        return isinstance(self.problem, Checked)

    @property
    def is_moved(self) -> bool:
        """Whether there is a motion to run: records, another motion of the ground, or a release."""
        is_run = not isinstance(self.problem, VerticalBending | HorizontalBending)
        return is_run and (bool(self.shaking.records) or self.case.is_moved)

    def analyses(self) -> list[Analysis]:
        """One task for each record and polarity, for `campaign`, or one of the release where there are no records.

        Raises:
            ValueError: for a wall that bends, which is checked and not run, or where the solver needs what is missing.
        """
        from ..study.analysis import Analysis, MasonryAnalysis

        if isinstance(self.problem, VerticalBending | HorizontalBending):
            message = Message("a wall that bends is checked and not run; give its blocks as a MasonryCase to run it")
            raise ValueError(message)
        shaking, case = self.shaking, self.case
        cases: list[Any] = [replace(case, motion=motion) for motion in shaking.motions] or [case]
        if not isinstance(self.problem, Checked):
            return [MasonryAnalysis(case, solver=shaking.solver, options=shaking.options) for case in cases]
        wall = cast(Case, case)
        e = shaking.e or Restitution.from_geometry(wall.wall, wall.stop_top)
        impact_options = {"e": e} if shaking.solver == "analytical" else {"contacts": shaking.contacts}
        return [Analysis(case, shaking.solver, options=shaking.options, **impact_options) for case in cases]

    def dynamic(self, runs: Sequence[Response] | Sequence[Analysis], **kept: Path) -> DynamicCheck:
        """The check of its runs, see `dynamic_check`.

        Args:
            runs: responses, or the tasks of a campaign.
            kept: `store` and `histories` of the campaign.
        """
        options = dict(self.shaking.dynamic) | {name: option for name, option in self.options.items() if name == "code"}
        return dynamic_check(runs, curve=self.limit_curve, **options | kept)

    def verdict_on(self, runs: Sequence[Response] | Sequence[Analysis], **kept: Path) -> DynamicCheck | None:
        """The check of its runs, see `dynamic`; None where no records move it, and of masonry whose limit curve has no
        d_0, of which a warning says why.

        Warns:
            Implausible: for masonry without a verdict.
        """
        if not self.shaking.records:
            return None
        try:
            return self.dynamic(runs, **kept)
        except ValueError as error:
            if self.is_wall:
                raise
            warn_of(f"runs of masonry have no verdict: {error}", Implausible)
            return None


def mechanisms_of(reader: Reader, top: Table) -> dict[str, Mechanism]:
    """The mechanisms of a file by name: those under `mechanisms`, or the one at the top, whose name is empty."""
    tables = top.values.get("mechanisms")
    if tables is None:
        return _without_faulty({"": _mechanism(reader, top, set(top.values), set())})
    if not isinstance(tables, Table) or not all(isinstance(value, Table) for value in tables.values.values()):
        reader.refusal(("mechanisms",), "{place} is no table of tables; write [mechanisms.NAME] for each")
        return {}
    shared, taken = top.without("mechanisms"), set[str]()
    mechanisms = dict[str, Mechanism | None]()
    for name, table in tables.values.items():
        mechanisms[name] = _mechanism(reader, table.over(shared), set(table.values), taken)
    for key in shared.values.keys() - taken:
        reader.refusal((key,), "{place} is not known here: no mechanism takes it")
    return _without_faulty(mechanisms)


def _without_faulty(mechanisms: Mapping[str, Mechanism | None]) -> dict[str, Mechanism]:
    return {name: mechanism for name, mechanism in mechanisms.items() if mechanism is not None}


def _mechanism(reader: Reader, table: Table, own: set[str], taken: set[str]) -> Mechanism | None:
    """The mechanism of a table; None where something is wrong with it.

    Args:
        reader: the reader, which keeps what is wrong.
        table: its table, with what it shares with others.
        own: the keys of its own table. A shared key that is none of its arguments is left to the others.
        taken: the keys that any mechanism takes, to which this one adds its own.
    """
    try:
        maker, content = reader.choose_maker(table, MECHANISMS, "Case")
    except RefusedError:
        taken |= set(table.values)
        return None
    arguments = {key_named(key) for key in maker.keys.values()} | set(SECTIONS)
    taken |= (arguments | set(OWN_KEYS)) & set(table.values)
    content = content.without(*(set(content.values) - arguments - own))
    options = _options(reader, content, "check", CHECK)
    curve = _options(reader, content, "limit_curve", CURVE)
    demand = reader.attempt(lambda: _demand(reader, content, options))
    problem = reader.attempt(lambda: reader.make(content.without(*SECTIONS), maker))
    if problem is None:
        return None
    spectrum = next(iter(demand.values())) if isinstance(demand, Mapping) else demand
    ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    wall = getattr(case_of(problem), "block", None)
    shaking = reader.attempt(lambda: shaking_of(reader, content, wall, ground))
    return Mechanism(problem, demand, options, curve, shaking or Shaking(), table.place)


def _options(reader: Reader, table: Table, name: str, maker: Maker) -> dict[str, Any]:
    """The arguments that a table in another has, those of a function; none where something is wrong with them."""
    if name not in table.values:
        return {}
    return reader.attempt(lambda: reader.arguments(reader.required_table(table, name), maker)) or {}


def _demand(reader: Reader, table: Table, options: Mapping[str, Any]) -> Demand | Mapping[str, Demand] | None:
    """What a mechanism is checked against, that of the site or of a floor above it, one for each limit state that the
    table of the site has a table of."""
    if "site" not in table.values:
        if "floor" in table.values:
            reader.refusal(table.place_of("floor"), "{place} is a floor of no [site]")
        return None
    site, code = reader.required_table(table, "site"), options.get("code", USUAL_CODE)
    rule = code_of(code)
    try:
        rule.confidence.checked(options.get("confidence_factor"))
    except ValueError as error:
        place = reader.required_table(table, "check").place_of("confidence_factor")
        raise reader.refusal(place, "{place}: {cause} by {code}", cause=reason(error), code=rule.name) from None
    names = [*rule.states, *([] if rule.damage is None else [rule.damage.state])]
    states = [name for name in dict.fromkeys(names) if isinstance(site.values.get(name), Table)]
    for name in [key for key, value in site.values.items() if isinstance(value, Table) and key not in states]:
        known = ", ".join(dict.fromkeys(names))
        unknown = "{place} is no limit state of {code}; those are {known}"
        raise reader.refusal(site.place_of(name), unknown, code=rule.name, known=known)
    common = site.without(*states)
    if not states:
        return _spectrum(reader, common, table)
    demands = {name: _spectrum(reader, site.values[name].over(common), table) for name in states}
    try:
        return required_demands(demands, rule)
    except ValueError as error:
        reader.refuse(site.place, caused(site.place, error))
        raise RefusedError from None


def _spectrum(reader: Reader, site: Table, table: Table) -> CodeSpectrum | PointSpectrum | FloorSpectrum:
    """The spectrum of a site, or of the floor above it that a mechanism stands on."""
    maker, content = reader.choose_maker(site, SITES, "code_spectrum")
    ground = reader.make(content, maker)
    if "floor" not in table.values:
        return ground  # type: ignore[no-any-return]
    return reader.make(reader.required_table(table, "floor"), replace(FLOOR, call=ground.at_height))  # type: ignore[no-any-return]
