"""What a report contains of a wall or of masonry: inputs with their units, results, limits of the results, drawings.

Effects, contacts, motions, solvers and versions are written alike for both.
"""

from __future__ import annotations

import importlib.metadata
import math
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill

import matplotlib
import numpy as np
import scipy
from matplotlib.figure import Figure

from .._version import __version__
from ..plotting.masonry import blocks, draw_loads, mechanism
from ..problem.ground.motion import GroundMotion
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.limit.collapse import Collapse
from ..problem.masonry.masonry import Masonry
from ..problem.wall.case import Case
from ..quantities import GRAVITY, Array
from ..result.ending import Outcome
from ..result.response import Response
from ..result.ties import Plastic, overdrawn
from ..study.intensity.fragility import Fragility
from ..study.loading.dynamic_check import d_0_of, displaced
from ..study.loading.limit_analysis import LimitCurve
from ..study.loading.load_check import Borne
from ..study.loading.mechanism_curve import case_of
from ..study.loading.push import Push
from ..study.loading.pushover import PushoverCurve
from .inputs import of_header
from .markup import Markup, element, table
from .pictures import SMALL, WIDE, Run, by_variant, small, wall_drawn
from .texts import DASH, FOUND, GIVEN, Words, effect_name
from .verdicts import REVERSED, Subject

TITLE = 48
"""Longest line of a title of half a page [characters]."""
TALLEST_BLOCKS, OVER_BLOCKS = 3.6, 0.6
"""Most height of a picture of blocks, and that of its title and its axis [inch]."""
ENDS = 6
"""Most responses whose blocks are drawn as they end."""
STATS = {"accuracy": ("", GIVEN), "timestep": ("s", FOUND), "rtol": ("", GIVEN), "atol": ("", GIVEN), "steps": ("", 9)}
"""Statistics of runs that a report names, with their units and numbers of digits."""


@dataclass(frozen=True)
class WallContent:
    """A wall as a report sees it.

    Args:
        case: the wall and its effects.

    Attributes:
        KIND: the end of the keys of its texts.
        COLUMNS: keys of the columns of the table of runs.
    """

    case: Case
    KIND = "wall"
    COLUMNS = "outcome", "largest", "share", "impacts"

    def largest(self, response: Response) -> float:
        """Largest displacement of the centroid in a response [m], as in the dynamic check, infinite if it fell."""
        wall = response.of_wall[0].wall
        return displaced(wall, response.peak_over_alpha * wall.alpha)

    def moved(self, response: Response) -> Array:
        """Displacement of the centroid at the samples of a response [m], shape (n,)."""
        return np.asarray(response.pose[:, 0, 0])

    def limit(self) -> float | None:
        """The displacement from which nothing but ties brings it back [m]; None of a wall that they alone hold."""
        return d_0_of(self.case) or None

    def result(self, response: Response, words: Words) -> list[str]:
        """Cells of the table of runs: how it ended, its largest displacement, that over the limit, impacts."""
        largest = self.largest(response)
        if math.isinf(largest):
            return [words("outcome_overturned"), DASH, DASH, str(len(response.impacts))]
        limit = self.limit()
        share = words.number(largest / limit, FOUND) if limit else DASH
        cells = words.quantity(largest, "m", FOUND), share, str(len(response.impacts))
        return [words(f"outcome_{response.outcome.name.lower()}"), *cells]

    def limits(self, runs: Sequence[Run], words: Words) -> list[str]:
        """What these results do not cover."""
        shaken = [run for run in runs if run.response.case.motion is not None]
        records, both = {run.record for run in shaken}, {run.record for run in shaken if run.turned}
        applies = {
            "limit_rigid": True,
            "limit_polarity": self.case.one_sided and records > both,
            "limit_one_record": len(records) == 1,
            "limit_release": bool(runs) and not shaken,
            "limit_theory": {run.response.solver for run in runs} == {"analytical"},
        }
        found = [words(key) for key, holds in applies.items() if holds]
        still = [run for run in runs if run.response.outcome is Outcome.TIME_ENDED]
        if still:
            found.append(words("limit_still_moves", count=len(still), of=len(runs)))
        for run in runs:
            for tie, drawn in run.response.plastic.items():
                effect = run.response.case.links[tie]
                if overdrawn(effect, drawn):
                    name, d = effect_name(tie, words), words.quantity(drawn.elongation, "m", FOUND)
                    share = words.share(round(100 * drawn.elongation / effect.span) / 100)
                    found.append(words("limit_overdrawn", run=run.label, tie=name, d=d, share=share))
        return found

    def by_hand(self, words: Words) -> list[tuple[str, ...]]:
        """Moments about the toe by which alpha_0 can be checked by hand: what they are, in kN m."""
        case, wall = self.case, self.case.wall
        lever = wall.lever
        weight = wall.mass * GRAVITY
        turning = weight * wall.centroid_height
        holding = case.restoring.outer.P
        rows = [
            (words("hand_weight"), words.quantity(weight, "N", FOUND)),
            (words("hand_lever"), words.quantity(lever, "m", FOUND)),
            (words("hand_height"), words.quantity(wall.centroid_height, "m", FOUND)),
            (words("hand_holding"), words.quantity(weight * lever, "N m", FOUND)),
            (words("hand_effects"), words.quantity(holding - weight * lever, "N m", FOUND)),
            (words("hand_turning"), words.quantity(turning, "N m", FOUND)),
        ]
        return [*rows, (words("hand_alpha"), words.number(holding / turning, FOUND))]

    def at_rest(self, words: Words, borne: Sequence[Borne]) -> tuple[Figure, str]:
        """Section and elevation."""
        drawn = wall_drawn(self.case, words)
        return drawn.figure, words("drawing_wall" if drawn.one_scale else "drawing_wall_scales")

    def at_end(self, runs: Sequence[Run], words: Words) -> None:
        """None: the histories show how the runs of a wall end."""


@dataclass(frozen=True)
class MasonryContent:
    """Masonry as a report sees it, see `WallContent`.

    Args:
        case: the masonry and its effects.
        curve: of its mechanism, where it is checked by one.
    """

    case: MasonryCase
    curve: LimitCurve | None = None
    KIND = "masonry"
    COLUMNS = "outcome", "largest", "opening", "sliding", "fallen"

    def largest(self, response: Response) -> float:
        """Largest displacement of a block in a response [m], infinite where one fell."""
        return math.inf if response.fallen else float(self.moved(response).max())

    def moved(self, response: Response) -> Array:
        """Displacement of the farthest block at the samples of a response [m], shape (n,)."""
        return np.asarray(np.linalg.norm(response.pose[:, :, : 3 if response.in_space else 2], axis=2).max(axis=1))

    def limit(self) -> None:
        """None is known."""

    def result(self, response: Response, words: Words) -> list[str]:
        """Cells of the table of runs: how it ended, largest motions, fallen blocks."""
        largest = float(self.moved(response).max())
        ended = "blocks_fell" if response.fallen else f"outcome_{response.outcome.name.lower()}"
        moved = largest, response.opening.max(), response.sliding.max()
        sizes = [words.quantity(value, "m", FOUND) for value in moved]
        fell = [words("falls_at", block=block, t=words.quantity(t, "s", FOUND)) for block, t in response.fallen.items()]
        return [words(ended), *sizes, words.named(fell) or DASH]

    def limits(self, runs: Sequence[Run], words: Words) -> list[str]:
        """What these results do not cover."""
        found = [words("limit_rigid_blocks"), *([words("limit_margin")] if runs else [])]
        if len({run.record for run in runs if run.response.case.motion is not None}) == 1:
            found.append(words("limit_one_record"))
        if runs and "explicit" not in {run.response.solver for run in runs}:
            found.append(words("limit_faces"))
        return found

    def by_hand(self, words: Words) -> list[tuple[str, ...]]:
        """None."""
        return []

    def at_rest(self, words: Words, borne: Sequence[Borne]) -> tuple[Figure, str]:
        """The blocks with their loads, and the loads that grow of what bears least."""
        masonry, moved = self.case.masonry, []
        if self.curve is not None and self.curve.start.moving:
            moved = [(self.curve.start, words("mechanism_opens"))]
        figure = self._drawn([(masonry, words("at_rest") if moved else ""), *moved])
        if not masonry.in_space:
            growing = [one.loads for one in borne if isinstance(one, Collapse) and one.masonry == masonry]
            draw_loads(figure.axes[0], masonry, self.case.effects, *growing[:1])
            sized(figure, len(figure.axes), TALLEST_BLOCKS)
        return figure, words("drawing_masonry_mechanism" if moved else "drawing_masonry")

    def at_end(self, runs: Sequence[Run], words: Words) -> Figure:
        """The blocks as the runs with the largest motion end."""
        worst = sorted(runs, key=lambda run: -run.largest)[:ENDS]
        ends = [words.quantity(float(run.response.t[-1]), "s", FOUND) for run in worst]
        titles = [words("at_time", run=_polar(run, words), t=t) for run, t in zip(worst, ends, strict=True)]
        return self._drawn([(run.response, text) for run, text in zip(worst, titles, strict=True)])

    def _drawn(self, pieces: Sequence[tuple[Masonry | Response | Collapse, str]]) -> Figure:
        """Masonry at rest, in its mechanism, or as responses of it end, in panels with titles."""
        columns = min(2, len(pieces))
        rows = -(-len(pieces) // columns)
        figure = Figure(figsize=(WIDE, rows * TALLEST_BLOCKS), layout="constrained")
        for i, (piece, title) in enumerate(pieces):
            ax = figure.add_subplot(rows, columns, i + 1, projection="3d" if self.case.in_space else None)
            mechanism(ax, piece) if isinstance(piece, Collapse) else blocks(ax, piece)
            ax.set_title(fill(title, TITLE), fontsize=SMALL)
            small(ax)
        if not self.case.in_space:
            sized(figure, columns, TALLEST_BLOCKS if columns == 1 else 2.6)
        return figure


Content = WallContent | MasonryContent
"""What a report has of a wall or of masonry."""


def sized(figure: Figure, columns: int, most: float) -> None:
    """Make a figure of panels in the plane no higher than what is drawn in them, and a row up to a height [inch]."""
    sides = [np.ptp(ax.get_ylim()) / np.ptp(ax.get_xlim()) for ax in figure.axes]
    rows = -(-len(sides) // columns)
    figure.set_size_inches(WIDE, rows * min(most, float(max(sides)) * WIDE / columns + OVER_BLOCKS))


def of_borne(result: Borne, words: Words) -> list[tuple[str, str]]:
    """The numbers of a static answer, by the key of their names."""

    def length(d: float) -> str:
        return words.quantity(d, "m", FOUND) if math.isfinite(d) else DASH

    if isinstance(result, Collapse):
        moving = words.named(result.moving if result.case is None else [words("kind_wall")])
        return [("borne_factor", words.number(result.multiplier, FOUND)), ("in_moving", moving)]
    if isinstance(result, PushoverCurve):
        start, peak = (words.number(value, FOUND) for value in (result.start, result.peak))
        end = words.quantity(result.end, "rad", FOUND)
        return [("borne_start", start), ("borne_peak", peak), ("borne_end", end)]
    if isinstance(result, Push):
        unit = "N" if result.unit == "N" else ""
        end = "step_end" if unit else "centroid_end"
        return [("borne_peak", words.quantity(result.peak, unit, FOUND)), (end, length(result.d_0))]
    start = words.number(float(result.multiplier[0]), FOUND)
    moving = words.named(result.start.moving)
    return [("borne_start", start), ("centroid_end", length(result.d_0)), ("in_moving", moving)]


def tied(response: Response, words: Words) -> list[str]:
    """What the ties of a response did: the largest force of one, how far the most drawn out was, the first break."""
    ties, drawn = response.ties, response.plastic
    if not ties:
        return [DASH] * 3
    force = max(tie.largest_force for tie in ties.values())
    out = max(drawn.get(name, Plastic(0.0, 0.0)).elongation for name in ties)
    broke = min(tie.broken for tie in ties.values())
    cells = [words.quantity(force, "N", FOUND), words.quantity(out, "m", FOUND)]
    return [*cells, DASH if math.isinf(broke) else words.quantity(broke, "s", FOUND)]


def broken_ties(runs: Sequence[Run], words: Words) -> list[str]:
    """In how many runs ties broke, by variant."""
    found = []
    for variant, own in by_variant(runs).items():
        broke = [min(tie.broken for tie in run.response.ties.values()) for run in own if run.response.ties]
        count = sum(math.isfinite(t) for t in broke)
        if count:
            name, first = variant or words("all_runs"), words.quantity(min(broke), "s", FOUND)
            found.append(words("ties_broke", name=name, count=count, of=len(broke), t=first))
    return found


def forces_kept(runs: Sequence[Run], words: Words) -> list[tuple[str, ...]]:
    """The largest reaction and the largest normal force of a joint, of each run that has kept its forces."""
    rows = []
    for run in runs:
        if run.response.kept_forces is not None:
            forces, normal = run.response.forces, run.response.forces.normal.max(axis=0)
            joint = int(normal.argmax())
            cells = [words.quantity(float(force), "N", FOUND) for force in (forces.largest_reaction, normal[joint])]
            rows.append((_polar(run, words), *cells, forces.joints[joint]))
    return rows


def _polar(run: Run, words: Words) -> str:
    """The label of a run, and whether its record is reversed."""
    return f"{run.label} ({words('reversed')})" if run.turned else run.label


def content_of(subject: Subject) -> Content:
    """What is checked or run as a report sees it."""
    curve = subject if isinstance(subject, LimitCurve) else None
    case = case_of(subject)
    return MasonryContent(case, curve) if isinstance(case, MasonryCase) else WallContent(case)


def of_motions(
    grounds: Sequence[Mapping[str, GroundMotion]], called: Mapping[str, str], words: Words
) -> list[tuple[str, ...]]:
    """The ground motions of runs, each once, in one polarity.

    Args:
        grounds: of each run by their directions.
        called: what records are called in the report, by their names.
        words: of the report.
    """
    rows: dict[tuple[str, str], tuple[str, ...]] = {}
    for ground in grounds:
        for direction, motion in ground.items():
            peak = float(abs(motion.accel).max())
            sizes = words.quantity(peak, "m/s2", FOUND), words.quantity(peak / GRAVITY, "g", FOUND)
            name = called[motion.name.removesuffix(REVERSED)]
            times = words.quantity(motion.duration, "s"), words.quantity(motion.dt, "s")
            origin = "".join(row.value for row in of_header(motion, words)) or DASH
            rows.setdefault((direction, name), (name, words(f"ground_{direction}"), *sizes, *times, origin))
    return list(rows.values())


def solved_with(responses: Sequence[Response], words: Words) -> list[str]:
    """How the responses were solved, a sentence for each solver."""
    found = []
    for solver in dict.fromkeys(response.solver for response in responses):
        own = [response for response in responses if response.solver == solver]
        given = [("duration", [response.case.duration for response in own], ("s", GIVEN))]
        given += [
            (name, [run.stats[name] for run in own if run.stats.get(name)], shown) for name, shown in STATS.items()
        ]
        parts = [
            words(f"solved_{name}", value=_range(values, *shown, words)) for name, values, shown in given if values
        ]
        solved = words.or_else(f"solver_{solver}", solver)
        found.append(words("solved", solver=solved, count=len(own), how=", ".join(parts)))
    return found


def _range(values: Sequence[float], unit: str, digits: int, words: Words) -> str:
    """The lowest and the highest of values."""
    low, high = (words.quantity(value, unit, digits) for value in (min(values), max(values)))
    return low if low == high else words("range", low=low, high=high)


def of_fragility(fits: dict[str, Fragility], words: Words) -> Markup:
    """Fragility curves as a table."""
    rows = []
    for name, fit in fits.items():
        spans = (fit.median, *fit.median_interval(0.9)), (fit.dispersion, *fit.dispersion_interval(0.9))
        numbers = [[words.number(value, FOUND) for value in span] for span in spans]
        cells = [words("interval", value=value, low=low, high=high) for value, low, high in numbers]
        groups = words("independent") if fit.groups is None else str(fit.groups)
        rows.append((name, *cells, str(fit.count), groups))
    heads = [words(f"fragility_{key}") for key in ("name", "median", "dispersion", "runs", "groups")]
    return element("div", table(heads, rows, right=(3, 4)), element("p", words("fragility_note")))


def code_chapter(used: Sequence[str], words: Words) -> list[tuple[str, ...]]:
    """The chapter after NTC 2018, 10.2: each item of the clause and its answer, with the analyses used, the versions of
    the programs, and the random seeds."""
    made = {
        "mjrock": __version__,
        "MuJoCo": importlib.metadata.version("mujoco"),
        "NumPy": np.__version__,
        "SciPy": scipy.__version__,
        "matplotlib": matplotlib.__version__,
        "Python": platform.python_version(),
    }
    keys = "origin", "basis", "field", "validation", "results"
    rows = [(words(f"ntc_{key}"), words(f"ntc_{key}_text", version=__version__)) for key in keys]
    versions = words("versions"), ", ".join(f"{name} {version}" for name, version in made.items())
    return [(words("ntc_kind"), "; ".join(used)), *rows, versions, (words("seed"), words("seed_text"))]
