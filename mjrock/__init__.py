"""One-sided rocking masonry walls in MuJoCo, and the energy lost at every impact.

Units are SI, angles radians, damping ratios fractions. `Block` is the wall, `Case` the problem, `Contacts` the
compliant interfaces. `simulate` solves the contact law in MuJoCo, `solve_compliant` the same law in SciPy, and
`solve_explicit` by explicit steps, for many blocks. `solve_analytical` is classical rocking theory, and `compare` sets
two answers side by side.

A name is imported when it is first used: `contact_for` alone imports MuJoCo and NumPy only.
"""

import importlib
from typing import TYPE_CHECKING

from ._version import __version__
from .contacts.names import homes
from .interrupts import interrupts_held_back
from .notebook import NotebookPicture

if TYPE_CHECKING:
    from . import blocks as blocks
    from . import plotting as plotting
    from .assessment.assessment import Assessment, from_toml
    from .assessment.schema import toml_schema
    from .assessment.tables import AssessmentError
    from .contacts.contact import PairContact, PairContacts
    from .contacts.coulomb import CoulombFriction
    from .contacts.inspect import FlexContact, InspectedContact, inspect_contacts, inspect_flexes
    from .contacts.make import contact_for, contacts_for, stiffest_contacts
    from .contacts.notes import ContactWarning
    from .contacts.solref import ContactParameters, ManyContactParameters, contact_parameters, contact_stiffness
    from .distinct.explicit import solve_explicit
    from .engine.model import SimulationError
    from .engine.simulation import simulate
    from .engine.text import masonry_mjcf, mjcf_of, wall_mjcf
    from .problem.damping.contacts import Contacts, Interface, reference_frequency
    from .problem.damping.law import CALIBRATED, CALIBRATED_BED, PUBLISHED, DampingLaw, PowerLaw
    from .problem.damping.measured import MeasuredContact, hertz_stiffness, measured_contact
    from .problem.damping.restitution import Restitution, ScatteredRestitution
    from .problem.damping.stiffness import (
        MASONRY_TYPES,
        MasonryType,
        StiffnessRange,
        crushed_inset,
        joint_stiffness,
        layered_stiffness,
        measured_stiffness,
        stiffness_range,
        wall_stiffness,
    )
    from .problem.ground.motion import GroundMotion
    from .problem.ground.record_sets import RecordSet, components_in, records_in, scaled_together
    from .problem.ground.spectrum import (
        CodeSpectrum,
        FloorSpectrum,
        PointSpectrum,
        ResponseSpectrum,
        code_spectrum,
        response_spectrum,
        scaled_to_sa,
        scaled_to_spectrum,
    )
    from .problem.masonry.actuator import Actuator
    from .problem.masonry.blocks.compound import Compound
    from .problem.masonry.blocks.joints import Joint
    from .problem.masonry.blocks.joints_in_space import SpaceJoint
    from .problem.masonry.blocks.polygon import Polygon
    from .problem.masonry.blocks.polyhedron import Polyhedron
    from .problem.masonry.case import MasonryCase
    from .problem.masonry.fill import Fill
    from .problem.masonry.laws.bond import BONDS, Bond
    from .problem.masonry.laws.dry import Dry, Mortar
    from .problem.masonry.laws.own_law import joint_law
    from .problem.masonry.limit.collapse import Collapse
    from .problem.masonry.masonry import Masonry
    from .problem.wall.bending import HorizontalBending, VerticalBending
    from .problem.wall.block import Block
    from .problem.wall.case import Case
    from .problem.wall.earth import EarthPressure
    from .problem.wall.effects import AddedMass, Damper, FrictionDamper, Load, SideStop, Thrust
    from .problem.wall.own_link import Link, link_law
    from .problem.wall.section import Gable, Opening
    from .problem.wall.tie import Tie, strengths_of_anchor, strengths_of_bar
    from .problem.wall.wedge import Corner, Wedge
    from .quantities import GRAVITY, Implausible
    from .reference.compliant import solve_compliant
    from .reporting.page import report
    from .result.compare import Comparison, compare
    from .result.ending import Outcome
    from .result.ledger import Ledger
    from .result.problem import scene_of
    from .result.response import MasonryResponse, Response, load
    from .result.rocking import Impact
    from .scene.masonry import masonry_scene
    from .scene.scene import Scene
    from .scene.time_step import automatic_timestep
    from .scene.wall import wall_scene
    from .study.analysis import Analysis, MasonryAnalysis
    from .study.campaign.campaign import campaign, results
    from .study.campaign.store import Store
    from .study.campaign.task import Grid
    from .study.intensity.fragility import Fragility, PairedRatio, fit_capacities, fit_fragility, lost, paired_ratio
    from .study.intensity.ida import Capacity, ida, overturning_intensity
    from .study.intensity.overturning_map import OverturningMap, overturning_map
    from .study.intensity.rocking_spectrum import RockingSpectrum, rocking_spectrum
    from .study.intensity.thresholds import Island, Thresholds, thresholds
    from .study.loading.code import Code
    from .study.loading.design import Design, design
    from .study.loading.dynamic_check import DynamicCheck, dynamic_check
    from .study.loading.limit_analysis import LimitCurve, collapse_multiplier, limit_curve
    from .study.loading.load_check import LoadCheck, load_check
    from .study.loading.mechanism_check import MechanismCheck, mechanism_check
    from .study.loading.push import Push, push
    from .study.loading.pushover import pushover
    from .study.matching.calibration import Plan, calibrate
    from .study.matching.matched import as_theory, matched_contacts, matched_masonry
    from .study.sensitivity import Sensitivity, sensitivity
    from .theory.analytical import solve_analytical
    from .theory.impact import RigidImpact, rigid_impact

__all__ = [
    "BONDS", "CALIBRATED", "CALIBRATED_BED", "GRAVITY", "MASONRY_TYPES", "PUBLISHED", "Actuator", "AddedMass",
    "Analysis", "Assessment", "AssessmentError", "Block", "Bond", "Capacity", "Case", "Code", "CodeSpectrum",
    "Collapse", "Comparison", "Compound", "ContactParameters", "ContactWarning", "Contacts", "Corner",
    "CoulombFriction", "Damper", "DampingLaw", "Design", "Dry", "DynamicCheck", "EarthPressure", "Fill", "FlexContact",
    "FloorSpectrum", "Fragility", "FrictionDamper", "Gable", "Grid", "GroundMotion", "HorizontalBending", "Impact",
    "Implausible", "InspectedContact", "Interface", "Island", "Joint", "Ledger", "LimitCurve", "Link", "Load",
    "LoadCheck", "ManyContactParameters", "Masonry", "MasonryAnalysis", "MasonryCase", "MasonryResponse",
    "MasonryType", "MeasuredContact", "MechanismCheck", "Mortar", "Opening", "Outcome", "OverturningMap", "PairContact",
    "PairContacts", "PairedRatio", "Plan", "PointSpectrum", "Polygon", "Polyhedron", "PowerLaw", "Push", "RecordSet",
    "Response", "ResponseSpectrum", "Restitution", "RigidImpact", "RockingSpectrum", "ScatteredRestitution", "Scene",
    "Sensitivity", "SideStop", "SimulationError", "SpaceJoint", "StiffnessRange", "Store", "Thresholds", "Thrust",
    "Tie", "VerticalBending", "Wedge", "__version__", "as_theory", "automatic_timestep", "calibrate", "campaign",
    "code_spectrum", "collapse_multiplier", "compare", "components_in", "contact_for", "contact_parameters",
    "contact_stiffness", "contacts_for", "crushed_inset", "design", "dynamic_check", "fit_capacities", "fit_fragility",
    "from_toml", "hertz_stiffness", "ida", "inspect_contacts", "inspect_flexes", "joint_law", "joint_stiffness",
    "layered_stiffness", "limit_curve", "link_law", "load", "load_check", "lost", "masonry_mjcf", "masonry_scene",
    "matched_contacts", "matched_masonry", "measured_contact", "measured_stiffness", "mechanism_check", "mjcf_of",
    "overturning_intensity", "overturning_map", "paired_ratio", "push", "pushover", "records_in", "reference_frequency",
    "report", "response_spectrum", "results", "rigid_impact", "rocking_spectrum", "scaled_to_sa", "scaled_to_spectrum",
    "scaled_together", "scene_of", "sensitivity", "simulate", "solve_analytical", "solve_compliant", "solve_explicit",
    "stiffest_contacts", "stiffness_range", "strengths_of_anchor", "strengths_of_bar", "thresholds", "toml_schema",
    "wall_mjcf", "wall_scene", "wall_stiffness",
]  # fmt: skip

HOME = homes(__file__)
"""The module of each public name."""
PUBLIC_MODULES = ("blocks", "plotting")
"""Public modules: builders of blocks, and pictures."""


def _png_of(shown: object) -> bytes | None:
    """The picture of a problem or an answer as a PNG, for notebooks."""
    png: bytes | None = importlib.import_module(".plotting.notebook", __name__).png_of(shown)
    return png


NotebookPicture._png_of = staticmethod(_png_of)


def __getattr__(name: str) -> object:
    """A public name, or a public module, imported when it is first used. Ctrl-C is delayed until then."""
    if name not in PUBLIC_MODULES and name not in HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    with interrupts_held_back():
        module = importlib.import_module(f".{HOME.get(name, name)}", __name__)
    if name in PUBLIC_MODULES:
        return module
    value = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names."""
    return [*__all__, *PUBLIC_MODULES]
