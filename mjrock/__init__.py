"""One-sided rocking masonry walls in MuJoCo, and the energy lost at every impact.

Units are SI, angles radians, damping ratios fractions. `Block` is the wall, `Case` the problem, `Contacts` the
compliant interfaces. `simulate` solves the contact law in MuJoCo, `solve_compliant` the same law in SciPy,
`solve_analytical` is classical rocking theory, and `compare` sets two answers side by side.
"""

import importlib
from typing import TYPE_CHECKING

from ._version import __version__
from .anymodel.contact import PairContact
from .anymodel.inspect import InspectedContact, inspect_contacts
from .anymodel.make import contact_for
from .engine.contact import ContactParameters, contact_parameters, contact_stiffness
from .engine.model import SimulationError
from .engine.simulation import automatic_timestep, simulate
from .engine.text import masonry_mjcf, mjcf_of, wall_mjcf
from .problem.damping.contacts import Contacts
from .problem.damping.forms import PowerLaw
from .problem.damping.interface import Interface, reference_frequency
from .problem.damping.law import CALIBRATED, CALIBRATED_BED, PUBLISHED, DampingLaw
from .problem.damping.restitution import Restitution
from .problem.damping.stiffness import joint_stiffness, layered_stiffness, measured_stiffness, wall_stiffness
from .problem.ground.motion import GroundMotion
from .problem.masonry.case import MasonryCase
from .problem.masonry.joints import Joint
from .problem.masonry.masonry import Masonry
from .problem.masonry.polygon import Polygon
from .problem.wall.block import Block
from .problem.wall.case import Case
from .problem.wall.damper import Damper
from .problem.wall.effects import AddedMass, Load, SideStop, Thrust, Tie
from .problem.wall.section import Opening
from .quantities import GRAVITY
from .reference.compliant import solve_compliant
from .result.compare import Comparison, compare
from .result.ledger import Ledger
from .result.response import MasonryResponse, Outcome, Response
from .result.rocking import Impact
from .scene.masonry import masonry_scene
from .scene.of_case import scene_of
from .scene.scene import Scene
from .scene.wall import wall_scene
from .study.analysis import Analysis, MasonryAnalysis
from .study.calibration import Plan, calibrate
from .study.campaign import campaign, results
from .study.contacts_by_matching import as_theory, matched_contacts
from .study.fragility import fit_fragility
from .study.grid import Grid
from .study.ida import ida, overturning_intensity
from .study.masonry_by_matching import matched_masonry
from .study.pushover import pushover
from .study.store import Store
from .theory.analytical import solve_analytical
from .theory.impact import RigidImpact, rigid_impact

__all__ = [
    "CALIBRATED",
    "CALIBRATED_BED",
    "GRAVITY",
    "PUBLISHED",
    "AddedMass",
    "Analysis",
    "Block",
    "Case",
    "Comparison",
    "ContactParameters",
    "Contacts",
    "Damper",
    "DampingLaw",
    "Grid",
    "GroundMotion",
    "Impact",
    "InspectedContact",
    "Interface",
    "Joint",
    "Ledger",
    "Load",
    "Masonry",
    "MasonryAnalysis",
    "MasonryCase",
    "MasonryResponse",
    "Opening",
    "Outcome",
    "PairContact",
    "Plan",
    "Polygon",
    "PowerLaw",
    "Response",
    "Restitution",
    "RigidImpact",
    "Scene",
    "SideStop",
    "SimulationError",
    "Store",
    "Thrust",
    "Tie",
    "__version__",
    "as_theory",
    "automatic_timestep",
    "calibrate",
    "campaign",
    "compare",
    "contact_for",
    "contact_parameters",
    "contact_stiffness",
    "fit_fragility",
    "ida",
    "inspect_contacts",
    "joint_stiffness",
    "layered_stiffness",
    "masonry_mjcf",
    "masonry_scene",
    "matched_contacts",
    "matched_masonry",
    "measured_stiffness",
    "mjcf_of",
    "overturning_intensity",
    "pushover",
    "reference_frequency",
    "report",
    "results",
    "rigid_impact",
    "scene_of",
    "simulate",
    "solve_analytical",
    "solve_compliant",
    "wall_mjcf",
    "wall_scene",
    "wall_stiffness",
]

if TYPE_CHECKING:
    from . import plotting as plotting
    from .reporting.page import report as report
else:

    def __getattr__(name: str) -> object:
        """`mjrock.plotting` and `mjrock.report`, imported when first asked for, since they take matplotlib."""
        if name == "plotting":
            return importlib.import_module(".plotting", __name__)
        if name == "report":
            return importlib.import_module(".reporting.page", __name__).report
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
