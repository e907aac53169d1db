"""What a report says and shows of a wall or of masonry: inputs with their units, results, what to be careful of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from matplotlib.figure import Figure

from ..plotting.masonry import blocks
from ..plotting.sketch import sketch
from ..problem.ground.motion import GroundMotion
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.masonry.masonry import Masonry
from ..problem.wall.case import Case
from ..quantities import named
from ..result.ending import Outcome
from ..result.response import Response
from ..result.ties import overdrawn
from .content import TableRows, broken_ties

Captioned = tuple[Figure, str]
"""A picture and what stands below it."""


class Reported(Protocol):
    """A wall or masonry as a report sees it.

    Attributes:
        NAME: what it is.
        RIGID: what is assumed of it.
        COLUMNS: of the table of results.
    """

    NAME: ClassVar[str]
    RIGID: ClassVar[str]
    COLUMNS: ClassVar[tuple[str, ...]]

    def inputs(self) -> TableRows:
        """What it is: quantity, value with unit."""

    def results(self, responses: Sequence[Response], names: Sequence[str]) -> TableRows:
        """The row of each response."""

    def cautions(self, responses: Sequence[Response], names: Sequence[str]) -> list[str]:
        """What to be careful of in these results."""

    def at_rest(self) -> Captioned:
        """It as it stands."""

    def at_end(self, response: Response, name: str) -> list[Captioned]:
        """It as a response ends."""


@dataclass(frozen=True)
class ReportedWall(Reported):
    """A wall, see `Reported`."""

    case: Case
    NAME = "Wall"
    RIGID = "The wall is rigid and moves in one vertical plane."
    COLUMNS = "response", "outcome", "peak/alpha", "peak/overturning_rotation", "top moves by", "impacts"

    def inputs(self) -> TableRows:
        """The wall: quantity, value with unit."""
        case = self.case
        block, wall = case.block, case.wall
        rows: TableRows = [
            ("thickness", f"{2 * block.b:.4g} m"),
            ("height", f"{2 * block.h:.4g} m"),
            ("length", f"{block.length:.4g} m"),
            ("density", f"{block.density:.4g} kg/m³"),
            ("inset", f"{block.inset:.4g} m"),
            ("mass, with added masses", f"{wall.mass:.5g} kg"),
            ("centroid_height", f"{wall.centroid_height:.4g} m"),
            ("alpha, rotation at which it falls alone", f"{wall.alpha:.4g} rad"),
            ("overturning_rotation, with effects", f"{case.overturning_rotation:.4g} rad"),
            ("p, frequency parameter", f"{wall.p:.4g} rad/s"),
        ]
        if block.gable is not None:
            rows.append(("gable", f"{block.gable.height:.4g} m high, {block.gable.top:.4g} m long at its top"))
        for opening in block.openings:
            rows.append(
                (
                    "round opening" if opening.round else "opening",
                    f"{opening.width:.4g} x {opening.height:.4g} m, sill {opening.sill:.4g} m",
                )
            )
        stop = "none: the wall rocks to both sides" if case.stop_top is None else f"up to {case.stop_top:.4g} m"
        return [*rows, ("side_stop", stop)]

    def results(self, responses: Sequence[Response], names: Sequence[str]) -> TableRows:
        """Outcome, peak and impacts of each response."""
        rows: TableRows = []
        for response, name in zip(responses, names, strict=True):
            over, case = response.peak_over_alpha, response.of_wall[0]
            top = "-" if over == float("inf") else f"{1e3 * over * case.wall.alpha * 2 * case.block.h:.0f} mm"
            peak = "overturned" if over == float("inf") else f"{over:.3f}"
            share = "-" if over == float("inf") else f"{response.peak_over_overturning:.3f}"
            rows.append((name, response.outcome.value, peak, share, top, str(len(response.impacts))))
        return rows

    def cautions(self, responses: Sequence[Response], names: Sequence[str]) -> list[str]:
        """What to be careful of in these results."""
        said = []
        outcomes = {response.outcome for response in responses}
        if Outcome.OVERTURNED in outcomes and len(outcomes) > 1:
            said.append("The responses do not agree on whether the wall overturns.")
        motions = [response.case.motion for response in responses if response.case.motion is not None]
        if self.case.one_sided and motions and all(motion.reversed() not in motions for motion in motions):
            said.append(
                "The wall opens to one side, and no motion is here in both polarities: run the reversed motion too."
            )
        said += of_one_motion(motions)
        if not any(response.solver == "MuJoCo" for response in responses):
            said.append(
                "Rocking theory has no stiffness of the base, and is more often the upper bound of the capacity."
            )
        if self.case.motion is None and not motions:
            said.append("There is no ground motion: this is the motion after a release.")
        for response, name in zip(responses, names, strict=True):
            if response.outcome is Outcome.TIME_ENDED:
                share = abs(float(response.theta[-1])) / float(self.case.wall.alpha)
                said.append(f"{name}: the wall still moves at the end of the run, at {share:.3g} alpha.")
            for tie, drawn in response.plastic.items():
                effect = response.case.links[tie]
                if overdrawn(effect, drawn):
                    said.append(
                        f"{name}: {tie}, which never breaks here, was drawn out by {1e3 * drawn.elongation:.3g} mm, "
                        f"{drawn.elongation / effect.span:.1%} of its length."
                    )
        return said + broken_ties(responses, names)

    def at_rest(self) -> Captioned:
        """The sketch."""
        return sketch(self.case), "Section and elevation, true to scale [m]."

    def at_end(self, response: Response, name: str) -> list[Captioned]:
        """Nothing: the histories show it."""
        return []


@dataclass(frozen=True)
class ReportedMasonry(Reported):
    """Masonry, see `Reported`."""

    case: MasonryCase
    NAME = "Masonry"
    RIGID = "The blocks are rigid."
    COLUMNS = "response", "outcome", "fallen", "largest rotation", "opening", "sliding"

    def inputs(self) -> TableRows:
        """Masonry: quantity, value with unit."""
        masonry = self.case.masonry
        mass = float(sum(masonry.blocks[i].mass for i in masonry.free))
        fewest, most = int(masonry.table.points.min()), int(masonry.table.points.max())
        rows: TableRows = [
            ("blocks", f"{len(masonry.free)} free, {len(masonry.blocks) - len(masonry.free)} fixed"),
            ("joints", f"{len(masonry.joints)}, points = {fewest if fewest == most else f'{fewest} to {most}'}"),
            ("mass of the free blocks", f"{mass:.5g} kg"),
        ]
        values = {"k_n": masonry.joint_stiffness, "k_s": masonry.joint_shear, "friction": masonry.joint_friction}
        for name, unit in (("k_n", " N/m³"), ("k_s", " N/m³"), ("friction", "")):
            low, high = values[name].min(), values[name].max()
            said = f"{low:.4g}{unit}" if low == high else f"{low:.4g} to {high:.4g}{unit}"
            rows.append((name, "sticks rigidly" if np.isinf(low) else said))
        retardation = masonry.retardation
        rows.append(("damping, c/k", f"{retardation.min():.3g} to {retardation.max():.3g} s"))
        return rows

    def results(self, responses: Sequence[Response], names: Sequence[str]) -> TableRows:
        """Outcome, fallen blocks and largest motions of each response of masonry."""
        rows: TableRows = []
        for response, name in zip(responses, names, strict=True):
            fell = [f"{block} at {t:.3g} s" for block, t in response.fallen.items()]
            said = named(fell) if fell else "none"
            moved = f"{response.peak.max():.3g} rad", f"{1e3 * response.opening.max():.3g} mm"
            slid = f"{1e3 * response.sliding.max():.3g} mm"
            rows.append((name, response.outcome.value, said, *moved, slid))
        return rows

    def cautions(self, responses: Sequence[Response], names: Sequence[str]) -> list[str]:
        """What to be careful of in the results of masonry."""
        said = []
        if len({bool(response.fallen) for response in responses}) > 1:
            said.append("The responses do not agree on whether blocks fall.")
        motions = [response.case.motion for response in responses if response.case.motion is not None]
        said += of_one_motion(motions)
        if not any(response.solver == "explicit" for response in responses):
            said.append("In MuJoCo faces have no end, and blocks that fall meet no others. Explicit steps have both.")
        said.append("A margin depends on k_n and the points of the joints: repeat it with others.")
        return said + broken_ties(responses, names)

    def at_rest(self) -> Captioned:
        """The blocks."""
        return drawn(self.case.masonry), "The blocks at rest, fixed ones in grey."

    def at_end(self, response: Response, name: str) -> list[Captioned]:
        """The blocks where they are then."""
        return [(drawn(response), f"{name}: the blocks at {response.t[-1]:.4g} s.")]


def of_one_motion(motions: Sequence[GroundMotion]) -> list[str]:
    """What to be careful of where all motions are one, in both polarities or not."""
    if motions and all(motion in (motions[0], motions[0].reversed()) for motion in motions):
        return ["There is one ground motion: rocking is sensitive, and one record proves little."]
    return []


def drawn(masonry: Masonry | Response) -> Figure:
    """Masonry at rest, or as a response of it ends."""
    figure = Figure(figsize=(6.3, 4.2), layout="constrained")
    blocks(figure.add_subplot(projection="3d") if masonry.in_space else figure.subplots(), masonry)
    return figure


def reported(case: AnyCase) -> Reported:
    """A case as a report sees it."""
    return ReportedMasonry(case) if isinstance(case, MasonryCase) else ReportedWall(case)
