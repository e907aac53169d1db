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
from ..study.loading.load_check import StaticAnswer
from ..study.loading.mechanism_curve import case_of
from ..study.loading.push import Push
from ..study.loading.pushover import PushoverCurve
from .inputs import header_inputs, value_range
from .markup import Markup, element, table
from .pictures import LEAST_TYPE, PICTURE_WIDTH, Run, by_variant, small, wall_drawing
from .texts import DASH, FOUND, GIVEN, Words, effect_name
from .verdicts import REVERSED, Subject

LONGEST_TITLE_LINE = 48
"""Longest line of a title of half a page [characters]."""
TALLEST_BLOCKS, OVER_BLOCKS = 3.6, 0.6
"""Most height of a picture of blocks, and that of its title and its axis [inch]."""
MOST_ENDS = 6
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

    def largest_displacement(self, response: Response) -> float:
        """Largest displacement of the centroid in a response [m], as in the dynamic check, infinite if it fell."""
        wall = response.of_wall[0].wall
        return displaced(wall, response.peak_over_alpha * wall.alpha)

    def displacement(self, response: Response) -> Array:
        """Displacement of the centroid at the samples of a response [m], shape (n,)."""
        return np.asarray(response.pose[:, 0, 0])

    def limit_displacement(self) -> float | None:
        """The displacement from which nothing but ties brings it back [m]; None of a wall that they alone hold."""
        return d_0_of(self.case) or None

    def result_cells(self, response: Response, words: Words) -> list[str]:
        """Cells of the table of runs: how it ended, its largest displacement, that over the limit, impacts."""
        largest = self.largest_displacement(response)
        if math.isinf(largest):
            return [words("outcome_overturned"), DASH, DASH, str(len(response.impacts))]
        limit = self.limit_displacement()
        share = words.number(largest / limit, FOUND) if limit else DASH
        cells = words.quantity(largest, "m", FOUND), share, str(len(response.impacts))
        return [words(f"outcome_{response.outcome.name.lower()}"), *cells]

    def limitations(self, runs: Sequence[Run], words: Words) -> list[str]:
        """What these results do not cover."""
        driven = [run for run in runs if run.response.case.motion is not None]
        records, reversed_records = {run.record for run in driven}, {run.record for run in driven if run.is_reversed}
        applies = {
            "limit_rigid": True,
            "limit_polarity": self.case.one_sided and records > reversed_records,
            "limit_one_record": len(records) == 1,
            "limit_release": bool(runs) and not driven,
            "limit_theory": {run.response.solver for run in runs} == {"analytical"},
        }
        sentences = [words(key) for key, holds in applies.items() if holds]
        moving_at_end = [run for run in runs if run.response.outcome is Outcome.TIME_ENDED]
        if moving_at_end:
            sentences.append(words("limit_still_moves", count=len(moving_at_end), of=len(runs)))
        for run in runs:
            for tie, plastic in run.response.plastic.items():
                effect = run.response.case.links[tie]
                if overdrawn(effect, plastic):
                    name, d = effect_name(tie, words), words.quantity(plastic.elongation, "m", FOUND)
                    share = words.share(round(100 * plastic.elongation / effect.span) / 100)
                    sentences.append(words("limit_overdrawn", run=run.label, tie=name, d=d, share=share))
        return sentences

    def hand_check_rows(self, words: Words) -> list[tuple[str, ...]]:
        """Moments about the toe by which alpha_0 can be checked by hand: what they are, in kN m."""
        case, wall = self.case, self.case.wall
        lever_arm = wall.lever
        weight = wall.mass * GRAVITY
        overturning = weight * wall.centroid_height
        stabilising = case.restoring.outer.P
        rows = [
            (words("hand_weight"), words.quantity(weight, "N", FOUND)),
            (words("hand_lever"), words.quantity(lever_arm, "m", FOUND)),
            (words("hand_height"), words.quantity(wall.centroid_height, "m", FOUND)),
            (words("hand_holding"), words.quantity(weight * lever_arm, "N m", FOUND)),
            (words("hand_effects"), words.quantity(stabilising - weight * lever_arm, "N m", FOUND)),
            (words("hand_turning"), words.quantity(overturning, "N m", FOUND)),
        ]
        return [*rows, (words("hand_alpha"), words.number(stabilising / overturning, FOUND))]

    def rest_drawing(self, words: Words, static_answers: Sequence[StaticAnswer]) -> tuple[Figure, str]:
        """Section and elevation."""
        drawing = wall_drawing(self.case, words)
        return drawing.figure, words("drawing_wall" if drawing.one_scale else "drawing_wall_scales")

    def end_drawing(self, runs: Sequence[Run], words: Words) -> None:
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

    def largest_displacement(self, response: Response) -> float:
        """Largest displacement of a block in a response [m], infinite where one fell."""
        return math.inf if response.fallen else float(self.displacement(response).max())

    def displacement(self, response: Response) -> Array:
        """Displacement of the farthest block at the samples of a response [m], shape (n,)."""
        return np.asarray(np.linalg.norm(response.pose[:, :, : 3 if response.in_space else 2], axis=2).max(axis=1))

    def limit_displacement(self) -> None:
        """None is known."""

    def result_cells(self, response: Response, words: Words) -> list[str]:
        """Cells of the table of runs: how it ended, largest motions, fallen blocks."""
        largest = float(self.displacement(response).max())
        outcome = "blocks_fell" if response.fallen else f"outcome_{response.outcome.name.lower()}"
        motions = largest, response.opening.max(), response.sliding.max()
        sizes = [words.quantity(value, "m", FOUND) for value in motions]
        times = {block: words.quantity(t, "s", FOUND) for block, t in response.fallen.items()}
        falls = [words("falls_at", block=block, t=time) for block, time in times.items()]
        return [words(outcome), *sizes, words.named(falls) or DASH]

    def limitations(self, runs: Sequence[Run], words: Words) -> list[str]:
        """What these results do not cover."""
        sentences = [words("limit_rigid_blocks"), *([words("limit_margin")] if runs else [])]
        if len({run.record for run in runs if run.response.case.motion is not None}) == 1:
            sentences.append(words("limit_one_record"))
        if runs and "explicit" not in {run.response.solver for run in runs}:
            sentences.append(words("limit_faces"))
        return sentences

    def hand_check_rows(self, words: Words) -> list[tuple[str, ...]]:
        """None."""
        return []

    def rest_drawing(self, words: Words, static_answers: Sequence[StaticAnswer]) -> tuple[Figure, str]:
        """The blocks with their loads, and the loads that grow of what bears least."""
        masonry, mechanism_panels = self.case.masonry, []
        if self.curve is not None and self.curve.start.moving:
            mechanism_panels = [(self.curve.start, words("mechanism_opens"))]
        figure = self._figure_of([(masonry, words("at_rest") if mechanism_panels else ""), *mechanism_panels])
        if not masonry.in_space:
            collapses = [answer for answer in static_answers if isinstance(answer, Collapse)]
            growing_loads = [collapse.loads for collapse in collapses if collapse.masonry == masonry]
            draw_loads(figure.axes[0], masonry, self.case.effects, *growing_loads[:1])
            fit_to_panels(figure, len(figure.axes), TALLEST_BLOCKS)
        return figure, words("drawing_masonry_mechanism" if mechanism_panels else "drawing_masonry")

    def end_drawing(self, runs: Sequence[Run], words: Words) -> Figure:
        """The blocks as the runs with the largest motion end."""
        panels = []
        for run in sorted(runs, key=lambda run: -run.largest)[:MOST_ENDS]:
            end = words.quantity(float(run.response.t[-1]), "s", FOUND)
            panels.append((run.response, words("at_time", run=_signed_label(run, words), t=end)))
        return self._figure_of(panels)

    def _figure_of(self, panels: Sequence[tuple[Masonry | Response | Collapse, str]]) -> Figure:
        """Masonry at rest, in its mechanism, or as responses of it end, in panels with titles."""
        columns = min(2, len(panels))
        rows = -(-len(panels) // columns)
        figure = Figure(figsize=(PICTURE_WIDTH, rows * TALLEST_BLOCKS), layout="constrained")
        for i, (panel, title) in enumerate(panels):
            ax = figure.add_subplot(rows, columns, i + 1, projection="3d" if self.case.in_space else None)
            mechanism(ax, panel) if isinstance(panel, Collapse) else blocks(ax, panel)
            ax.set_title(fill(title, LONGEST_TITLE_LINE), fontsize=LEAST_TYPE)
            small(ax)
        if not self.case.in_space:
            fit_to_panels(figure, columns, TALLEST_BLOCKS if columns == 1 else 2.6)
        return figure


Content = WallContent | MasonryContent
"""What a report has of a wall or of masonry."""


def fit_to_panels(figure: Figure, columns: int, most: float) -> None:
    """Make a figure of panels in the plane no higher than what is drawn in them, and a row up to a height [inch]."""
    sides = [np.ptp(ax.get_ylim()) / np.ptp(ax.get_xlim()) for ax in figure.axes]
    rows = -(-len(sides) // columns)
    figure.set_size_inches(PICTURE_WIDTH, rows * min(most, float(max(sides)) * PICTURE_WIDTH / columns + OVER_BLOCKS))


def static_answer_rows(result: StaticAnswer, words: Words) -> list[tuple[str, str]]:
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


def tie_cells(response: Response, words: Words) -> list[str]:
    """What the ties of a response did: the largest force of one, how far the most drawn out was, the first break."""
    ties, plastic = response.ties, response.plastic
    if not ties:
        return [DASH] * 3
    force = max(tie.largest_force for tie in ties.values())
    elongation = max(plastic.get(name, Plastic(0.0, 0.0)).elongation for name in ties)
    first_break = min(tie.broken for tie in ties.values())
    cells = [words.quantity(force, "N", FOUND), words.quantity(elongation, "m", FOUND)]
    return [*cells, DASH if math.isinf(first_break) else words.quantity(first_break, "s", FOUND)]


def broken_ties(runs: Sequence[Run], words: Words) -> list[str]:
    """In how many runs ties broke, by variant."""
    sentences = []
    for variant, runs_of_variant in by_variant(runs).items():
        ties_of_runs = [run.response.ties.values() for run in runs_of_variant if run.response.ties]
        first_breaks = [min(tie.broken for tie in ties) for ties in ties_of_runs]
        count = sum(math.isfinite(t) for t in first_breaks)
        if count:
            label, earliest = variant or words("all_runs"), words.quantity(min(first_breaks), "s", FOUND)
            sentences.append(words("ties_broke", name=label, count=count, of=len(first_breaks), t=earliest))
    return sentences


def kept_force_rows(runs: Sequence[Run], words: Words) -> list[tuple[str, ...]]:
    """The largest reaction and the largest normal force of a joint, of each run that has kept its forces."""
    rows = []
    for run in runs:
        if run.response.kept_forces is not None:
            forces, normal = run.response.forces, run.response.forces.normal.max(axis=0)
            joint = int(normal.argmax())
            cells = [words.quantity(float(force), "N", FOUND) for force in (forces.largest_reaction, normal[joint])]
            rows.append((_signed_label(run, words), *cells, forces.joints[joint]))
    return rows


def _signed_label(run: Run, words: Words) -> str:
    """The label of a run, and whether its record is reversed."""
    return f"{run.label} ({words('reversed')})" if run.is_reversed else run.label


def content_of(subject: Subject) -> Content:
    """What is checked or run as a report sees it."""
    curve = subject if isinstance(subject, LimitCurve) else None
    case = case_of(subject)
    return MasonryContent(case, curve) if isinstance(case, MasonryCase) else WallContent(case)


def motion_rows(
    grounds: Sequence[Mapping[str, GroundMotion]], names: Mapping[str, str], words: Words
) -> list[tuple[str, ...]]:
    """The ground motions of runs, each once, in one polarity.

    Args:
        grounds: of each run by their directions.
        names: of the records in the report, by their own names.
        words: of the report.
    """
    rows: dict[tuple[str, str], tuple[str, ...]] = {}
    for ground in grounds:
        for direction, motion in ground.items():
            peak = float(abs(motion.accel).max())
            peaks = words.quantity(peak, "m/s2", FOUND), words.quantity(peak / GRAVITY, "g", FOUND)
            name = names[motion.name.removesuffix(REVERSED)]
            times = words.quantity(motion.duration, "s"), words.quantity(motion.dt, "s")
            origin = "".join(row.value for row in header_inputs(motion, words)) or DASH
            rows.setdefault((direction, name), (name, words(f"ground_{direction}"), *peaks, *times, origin))
    return list(rows.values())


def solver_sentences(responses: Sequence[Response], words: Words) -> list[str]:
    """How the responses were solved, a sentence for each solver."""
    sentences = []
    for solver in dict.fromkeys(response.solver for response in responses):
        of_solver = [response for response in responses if response.solver == solver]
        durations = [response.case.duration for response in of_solver]
        details = [words("solved_duration", value=value_range(durations, "s", words))]
        for key, (unit, digits) in STATS.items():
            if values := [response.stats[key] for response in of_solver if response.stats.get(key)]:
                details.append(words(f"solved_{key}", value=value_range(values, unit, words, digits)))
        solver_name = words.or_else(f"solver_{solver}", solver)
        sentences.append(words("solved", solver=solver_name, count=len(of_solver), how=", ".join(details)))
    return sentences


def fragility_table(fits: dict[str, Fragility], words: Words) -> Markup:
    """Fragility curves as a table."""
    rows = []
    for name, fit in fits.items():
        intervals = (fit.median, *fit.median_interval(0.9)), (fit.dispersion, *fit.dispersion_interval(0.9))
        texts = [[words.number(value, FOUND) for value in interval] for interval in intervals]
        cells = [words("interval", value=value, low=low, high=high) for value, low, high in texts]
        groups = words("independent") if fit.groups is None else str(fit.groups)
        rows.append((name, *cells, str(fit.count), groups))
    heads = [words(f"fragility_{key}") for key in ("name", "median", "dispersion", "runs", "groups")]
    return element("div", table(heads, rows, right=(3, 4)), element("p", words("fragility_note")))


def program_chapter(analyses: Sequence[str], words: Words) -> list[tuple[str, ...]]:
    """The chapter after NTC 2018, 10.2: each item of the clause and its answer, with the analyses used, the versions of
    the programs, and the random seeds."""
    program_versions = {
        "mjrock": __version__,
        "MuJoCo": importlib.metadata.version("mujoco"),
        "NumPy": np.__version__,
        "SciPy": scipy.__version__,
        "matplotlib": matplotlib.__version__,
        "Python": platform.python_version(),
    }
    keys = "origin", "basis", "field", "validation", "results"
    rows = [(words(f"ntc_{key}"), words(f"ntc_{key}_text", version=__version__)) for key in keys]
    versions = words("versions"), ", ".join(f"{name} {version}" for name, version in program_versions.items())
    return [(words("ntc_kind"), "; ".join(analyses)), *rows, versions, (words("seed"), words("seed_text"))]
