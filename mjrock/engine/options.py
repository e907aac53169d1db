"""Options: how a case is stepped in MuJoCo, and what is kept of the run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..method import Method
from ..quantities import Within, keep, keep_declared, require_flag, require_kind, require_sample_count, require_size
from ..result.motion import OutputStep, required_spacing, whole_steps
from ..scene.time_step import MUJOCO_STEP, required_timestep

FixedStep = Annotated[float | None, MUJOCO_STEP]
"""A step that MuJoCo keeps to; None lets the steps fit the motion."""
Accuracy = Annotated[float, Within(1e-8, 0.1)]
"""Relative tolerance of fitted steps."""
NewmarkBeta = Annotated[float, Within(0, 10)]
"""Newmark's beta of the contact rows."""

SPACING = 1e-3
"""Distance of samples by default, but for fixed steps, which are all samples [s]."""


@dataclass(frozen=True)
class Options:
    """How a case is stepped and what is kept of the run, as `simulate` explains them.

    Args:
        duration: how long the motion is followed [s].
        timestep, accuracy, newmark_beta, coulomb, output_step, ledger, forces, method: those of `simulate`.

    Raises:
        TypeError, ValueError: for a value of another type or outside its range, or more samples or steps than fit into
            memory.
    """

    duration: float
    timestep: FixedStep
    accuracy: Accuracy
    newmark_beta: NewmarkBeta
    coulomb: bool | None
    output_step: OutputStep
    ledger: bool
    forces: bool
    method: Method

    def __post_init__(self) -> None:
        require_kind("method", self.method, Method)
        keep_declared(self)
        keep(self, ledger=require_flag("ledger", self.ledger), forces=require_flag("forces", self.forces))
        if self.coulomb is not None:
            keep(self, coulomb=require_flag("coulomb", self.coulomb))
        if self.output_step is not None:
            keep(self, output_step=required_spacing(self.output_step, self.duration))
        keep(self, timestep=required_timestep(self.timestep, MUJOCO_STEP, self.duration))
        if self.timestep is None:
            samples = self.duration / (self.output_step or SPACING)
            require_sample_count(samples)
        else:
            steps = self.duration / self.timestep
            require_size("the steps of this run", steps, "take a longer timestep, or fitted steps")

    @property
    def slides(self) -> bool:
        """Whether contacts that slide obey Coulomb's law."""
        return self.timestep is None if self.coulomb is None else self.coulomb

    @property
    def spacing(self) -> float | None:
        """Distance of samples that are interpolated [s]; None at a fixed step, whose steps are the samples."""
        return (self.output_step or SPACING) if self.timestep is None else None

    @property
    def samples(self) -> float:
        """How many samples the response has, about."""
        return self.duration / (self.spacing or (self.timestep or SPACING) * self.stride)

    @property
    def stride(self) -> int:
        """How many fixed steps there are from one sample to the next."""
        return whole_steps(self.output_step, self.timestep) if self.output_step and self.timestep else 1

    @property
    def remedy(self) -> str:
        """What to change where energy is lost or gained by the steps."""
        return f"lower accuracy = {self.accuracy:g}" if self.timestep is None else "take a shorter timestep"
