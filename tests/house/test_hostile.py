"""Every public entry with values that cannot be: a result, or an error that names the argument.

A call starts from arguments that work, and one or two of them are replaced. It has to end in a result, or in a
ValueError or TypeError whose message names an argument of the call, or in a SimulationError of the engine.
"""

import inspect
import math
import re
import warnings
from functools import cache
from itertools import repeat

import mujoco
import numpy as np
import pytest
from arguments import BALL, OF_NUMBERS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import mjrock as mr

WALL = mr.Block(0.3, 2.1)
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, 5e8, 5e8)
SHORT = mr.Case(WALL, 0.05, 0.02)
MOTION = mr.GroundMotion.half_sine(3.0, 0.1)
SPECTRUM = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")
RESPONSE, END = object(), object()
"""A response, and its end, which take their places as a call is made: nothing is solved before."""
ROWS = mr.contact_parameters(1.5e8, 5e5, timestep=1e-3, inverse_weight=2 / (3 * WALL.mass))
PAIRED = mujoco.MjModel.from_xml_string(
    """<mujoco><option cone="elliptic"/><worldbody><geom name="floor" type="plane" size="1 1 1"/><body pos="0 0 .1">
    <freejoint/><geom name="ball" size=".1"/></body></worldbody><contact><pair geom1="ball" geom2="floor"/></contact>
    </mujoco>"""
)
PLAN = mr.Plan(base_count=2, side_count=2)
COLUMN = mr.Masonry.stack([WALL], 5e8)
GROUND = mr.Polyhedron.box((4, 4, 1), (0, 0, -0.5), fixed=True)
L_UNIT = mr.Compound(
    [mr.Polygon([(0, 0), (1, 0), (1, 3), (0, 3)]), mr.Polygon([(1, 0), (2, 0), (2, 1), (1, 1)])], name="L"
)
DRY = mr.Dry(k_n=5e8, k_s=5e8, points=3)
BOND = mr.Bond(2e5, 3e5, 18.0, 125.0)
BOX = mr.Masonry([GROUND, mr.Polyhedron.box((0.6, 0.4, 2.0), (0, 0, 1))], k_n=5e8)


def pushed(scale):
    """A case that is pushed outwards by so many times g alpha, and overturns at the larger scales."""
    motion = mr.GroundMotion(np.full(2, -min(scale, 100.0) * 9.81 * WALL.alpha), 0.5)
    return mr.Analysis(mr.Case(WALL, 0.0, 1.0, motion=motion), "analytical", e=E, options={"rtol": 1e-4})


BOX_CORNERS = np.array(list(np.ndindex(2, 2, 2)), dtype=float)
BOX_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CALLS = OF_NUMBERS | {
    "Block": (mr.Block,
        {
            "b": 0.3, "h": 2.1, "length": 1.0, "density": 2000.0, "inset": 0.0, "openings": (), "profile": None,
            "masses": (), "plumb": "outer",
        },
    ),
    "Wedge": (mr.Wedge, {"angle": 0.4, "thickness": 0.5, "height": 4.0, "number": 2, "density": None}),
    "Corner": (mr.Corner, {"thickness": 0.5, "height": 4.0, "angle": 0.4, "density": 2000.0}),
    "HorizontalBending": (mr.HorizontalBending, {"wall": WALL, "thrust": 1e4, "crack": None}),
    "VerticalBending": (mr.VerticalBending, {"wall": WALL, "load": 2e4, "bearing": None, "crack": None, "effects": ()}),
    "Restitution.from_geometry": (mr.Restitution.from_geometry, {"wall": WALL}),
    "ScatteredRestitution": (mr.ScatteredRestitution, {"mean": E, "sd": 0.01, "seed": 1}),
    "Case": (
        mr.Case,
        {
            "block": WALL, "theta0": 0.05, "duration": 1.0, "side_stop": True, "omega0": 0.0, "motion": None,
            "vertical": None, "effects": (mr.Tie(3.0, 1e6),),
        },
    ),
    "Contacts": (mr.Contacts, {"base": CONTACTS.base, "side": CONTACTS.side, "law": "mine"}),
    "Contacts.from_damping": (
        mr.Contacts.from_damping,
        {"wall": WALL, "k_base": 5e8, "xi_base": 0.05, "k_side": 5e8, "xi_side": 0.01, "points": 2, "friction": 0.6},
    ),
    "Contacts.from_law": (
        mr.Contacts.from_law,
        {"wall": WALL, "e": E, "k_base": 5e8, "k_side": 5e8, "law": None, "points": 2, "amplitude": 0.5},
    ),
    "law": (mr.CALIBRATED, {"wall": WALL, "e": E, "k_n": 5e8, "k_side": 5e8, "amplitude": 0.5}),
    "law.reach": (mr.CALIBRATED.reach, {"wall": WALL, "k_n": 5e8, "amplitude": 0.5}),
    "law.covers": (mr.CALIBRATED.covers, {"wall": WALL, "e": E, "k_n": 5e8, "k_side": 5e8, "amplitude": 0.5}),
    "reference_frequency": (mr.reference_frequency, {"wall": WALL, "k_n": 5e8, "points": 2}),
    "wall_stiffness": (mr.wall_stiffness, {"E": 1e9, "wall": WALL, "points": 2}),
    "stiffness_range": (
        mr.stiffness_range,
        {"wall": WALL, "E": 1e9, "joint": (1e9, 0.01), "frequency": 4.0, "points": 2},
    ),
    "StiffnessRange": (mr.StiffnessRange, {"low": 1e8, "best": 2e8, "high": 3e8, "basis": "a guess"}),
    "strengths_of_bar": (
        mr.strengths_of_bar,
        {
            "diameter": 0.02, "yield_stress": 235e6, "plate": 0.3, "thickness": 0.5, "shear_strength": 3e4,
            "compressive_strength": 2e6, "number": 2, "spacing": 1.0,
        },
    ),
    "strengths_of_anchor": (
        mr.strengths_of_anchor,
        {"hole": 0.05, "length": 0.6, "bond_strength": 3e5, "shear_strength": 3e4, "number": 2},
    ),
    "EarthPressure": (
        mr.EarthPressure,
        {
            "height": 3.0, "friction_angle": 0.6, "density": 1900.0, "wall_friction": 0.2, "slope": 0.1, "k_h": 0.1,
            "k_v": 0.0,
        },
    ),
    "Fill": (mr.Fill, {"top": 5.8, "density": 1800.0, "spread": 0.5, "passive": 3.0}),
    "crushed_inset": (mr.crushed_inset, {"wall": WALL, "f_c": 2e6, "load": 1e3}),
    "measured_stiffness": (mr.measured_stiffness, {"wall": WALL, "frequency": 5.0, "points": 2}),
    "layered_stiffness": (
        lambda stiffnesses: mr.layered_stiffness(*stiffnesses) if isinstance(stiffnesses, tuple) else
        mr.layered_stiffness(stiffnesses), {"stiffnesses": (1e9, 2e9)},
    ),
    "contact_stiffness": (
        mr.contact_stiffness,
        {"solref": ROWS.solref, "solimp": ROWS.solimp, "inverse_weight": 1e-4},
    ),
    "contact_for": (
        mr.contact_for,
        {
            "model": BALL, "geom1": "ball", "geom2": "floor", "k": 1e6, "c": None, "restitution": 0.5, "xi": None,
            "friction": 0.5, "mass": None, "at": None, "contacts": 1, "timestep": 1e-5, "newmark_beta": 0.25,
            "keyframe": None, "qpos": [0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0], "speed": 1.0,
        },
    ),
    "contact_for, by c": (
        mr.contact_for,
        {"model": BALL, "geom1": "ball", "geom2": 0, "k": 1e6, "c": 30.0, "mass": 1.0, "timestep": 1e-5},
    ),
    "contact_for, by depth": (
        mr.contact_for,
        {"model": BALL, "geom1": "ball", "geom2": 0, "depth": 1e-4, "load": 50.0, "xi": 1.0, "timestep": 1e-5},
    ),
    "contact_for, by face": (
        mr.contact_for,
        {"model": BALL, "geom1": "ball", "geom2": 0, "k_face": 1e6, "xi": 1.0, "timestep": 1e-5, "normal": [0, 0, 1]},
    ),
    "stiffest_contacts": (
        mr.stiffest_contacts,
        {"model": BALL, "geom1": "ball", "geom2": 0, "timestep": 1e-3, "keyframe": None, "qpos": None},
    ),
    "contacts_for": (
        mr.contacts_for,
        {
            "model": BALL, "pairs": {("b*", "floor"): {"k": 1e6, "restitution": 0.5}}, "keyframe": None, "qpos": None,
            "timestep": 1e-5,
        },
    ),
    "measured_contact": (
        mr.measured_contact,
        {"heights": [1.0, 0.5], "mass": 1.0, "contact_times": [0.01], "confidence": 0.9, "gravity": 9.81},
    ),
    "hertz_stiffness": (
        mr.hertz_stiffness,
        {"radius": 0.1, "E": 1e9, "nu": 0.3, "other": (1e9, 0.3), "force": None, "mass": 1.0, "speed": 1.0},
    ),
    "CoulombFriction": (mr.CoulombFriction, {"model": PAIRED}),
    "inspect_contacts": (
        mr.inspect_contacts,
        {"model": BALL, "candidates": True, "contacts": 1, "keyframe": None, "qpos": None, "load": 3.0},
    ),
    "inspect_flexes": (mr.inspect_flexes, {"model": BALL}),
    "automatic_timestep": (mr.automatic_timestep, {"wall": WALL, "contacts": CONTACTS, "side_stop": True}),
    "simulate": (
        mr.simulate,
        {
            "case": SHORT, "contacts": CONTACTS, "timestep": 1e-3, "accuracy": 1e-3, "newmark_beta": 0.25,
            "output_step": 1e-3, "ledger": False, "forces": True, "start": END,
        },
    ),
    "simulate, fitted": (mr.simulate, {"case": SHORT, "contacts": CONTACTS, "accuracy": 1e-2, "output_step": 1e-3}),
    "solve_analytical": (mr.solve_analytical, {"case": SHORT, "e": E, "rtol": 1e-8, "output_step": 1e-3, "rest": 1e-9}),
    "solve_explicit": (
        mr.solve_explicit,
        {"case": SHORT, "contacts": CONTACTS, "timestep": 1e-4, "output_step": 1e-3, "forces": True},
    ),
    "solve_compliant": (mr.solve_compliant, {"case": SHORT, "contacts": CONTACTS, "rtol": 1e-6, "output_step": 1e-3}),
    "compare": (mr.compare, {"reference": RESPONSE, "candidate": RESPONSE}),
    "wall_mjcf": (mr.wall_mjcf, {"case": SHORT, "contacts": CONTACTS, "timestep": 1e-3, "newmark_beta": 0.25}),
    "wall_scene": (mr.wall_scene, {"case": SHORT, "contacts": CONTACTS}),
    "scene_of": (mr.scene_of, {"case": SHORT, "contacts": CONTACTS}),
    "scene_of, masonry": (mr.scene_of, {"case": mr.MasonryCase(COLUMN, 0.02), "contacts": None}),
    "mjcf_of": (mr.mjcf_of, {"case": SHORT, "contacts": CONTACTS, "timestep": 1e-3, "newmark_beta": 0.25}),
    "overturning_intensity": (
        mr.overturning_intensity, {"build": pushed, "low": 0.5, "high": 3.0, "tolerance": 0.1, "start": 1.0},
    ),
    "Capacity": (mr.Capacity, {"analysis": pushed(1.0), "tolerance": 0.1, "start": 1.0, "below": 1}),
    "fit_fragility": (
        mr.fit_fragility,
        {
            "intensity": [1.0, 2.0, 3.0, 4.0, 2.5, 3.5], "overturned": [0, 0, 1, 1, 1, 0], "groups": range(6),
            "resamples": 20, "seed": 0,
        },
    ),
    "fit_capacities": (
        mr.fit_capacities, {"capacities": [1.0, 2.0, 3.0, 4.0, 5.0], "groups": None, "resamples": 20, "seed": 0},
    ),
    "paired_ratio": (
        mr.paired_ratio, {"capacities": [1.0, 2.0], "over": [1.0, 1.5], "groups": ["a", "b"], "confidence": 0.9},
    ),
    "lost": (mr.lost, {"rows": [{"outcome": "at rest", "peak_over_alpha": 0.1}]}),
    "response_spectrum": (mr.response_spectrum, {"motion": MOTION, "periods": [0.5, 1.0], "damping": 0.05}),
    "scaled_to_sa": (mr.scaled_to_sa, {"motion": MOTION, "period": 0.5, "sa": 2.0, "damping": 0.05}),
    "scaled_to_spectrum": (
        mr.scaled_to_spectrum, {"motion": MOTION, "periods": [0.5, 1.0], "target": [2.0, 1.0], "damping": 0.05},
    ),
    "rocking_spectrum": (
        mr.rocking_spectrum, {"motion": MOTION, "R": [2.0], "slenderness": 7.0, "side_stop": True, "rtol": 1e-4},
    ),
    "scaled_together": (
        mr.scaled_together,
        {"motions": (MOTION, MOTION), "periods": [0.5, 1.0], "target": [2.0, 1.0], "damping": 0.05},
    ),
    "code_spectrum": (
        mr.code_spectrum,
        {"code": "NTC 2018", "ag": 2.0, "soil": "C", "F0": 2.4, "Tc": 0.3, "topography": "T1", "damping": 0.05},
    ),
    "spectrum": (SPECTRUM, {"T": [0.0, 0.5], "damping": 0.05}),
    "spectrum.at_height": (
        SPECTRUM.at_height, {"period": [0.3, 0.1], "damping": 0.05, "participation": [1.2, 0.3], "height": [0.5, -0.2]},
    ),
    "through_building": (
        MOTION.through_building, {"period": [0.3], "damping": 0.05, "participation": [1.2], "height": [0.5]},
    ),
    "Bond": (
        mr.Bond,
        {
            "tension": 2e5, "cohesion": 3e5, "opening_energy": 18.0, "slip_energy": 125.0, "crushing": 1e7,
            "crushing_energy": 5e3,
        },
    ),
    "Actuator": (
        mr.Actuator,
        {
            "block": 1, "at": (0.3, 4.0), "direction": 1, "displacement": ([0.0, 1.0], [0.0, 0.01]), "stiffness": 1e7,
            "damping": 0.0, "guided": None,
        },
    ),
    "load_check": (mr.load_check, {"result": RESPONSE, "demand": 0.1}),
    "push": (mr.push, {"masonry": COLUMN, "driver": 1, "to": -0.01, "inertia": 0.01}),
    "mechanism_check": (
        mr.mechanism_check,
        {"case": SHORT, "demand": MOTION, "confidence_factor": 1.35, "elastic_period": 0.1, "code": "NTC 2018"},
    ),
    "PointSpectrum": (mr.PointSpectrum, {"period": [0.0, 0.5], "acceleration": [2.0, 5.0], "damping": 0.05}),
    "dynamic_check": (
        mr.dynamic_check,
        {"runs": [mr.Analysis(SHORT, "analytical", e=E)], "limit_state": "SLV", "store": None, "natural": True},
    ),
    "pushover": (mr.pushover, {"case": SHORT, "contacts": CONTACTS, "rotations": [0.01, 0.05], "points": 30}),
    "matched_contacts": (
        mr.matched_contacts,
        {"wall": WALL, "e": E, "k_base": 5e8, "points": 2, "amplitude": 0.5, "friction": None, "accuracy": 1e-2},
    ),
    "as_theory": (mr.as_theory, {"wall": WALL, "e": E, "side_stop": False, "rebounds": 2, "amplitude": 0.5}),
    "Polygon": (
        mr.Polygon,
        {"vertices": [(0, 0), (1, 0), (0, 1)], "density": 2e3, "length": 1.0, "fixed": False, "name": None},
    ),
    "Compound": (mr.Compound, {"parts": list(L_UNIT.parts), "fixed": False, "name": "L"}),
    "Compound.prism": (mr.Compound.prism, {"compound": L_UNIT, "middle": 0.0}),
    "Polyhedron": (
        mr.Polyhedron,
        {
            "vertices": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], "density": 2e3, "fixed": False, "name": None,
        },
    ),
    "Polyhedron.box": (
        mr.Polyhedron.box,
        {"size": (1, 1, 1), "centre": (0, 0, 0), "density": 2e3, "fixed": False, "name": None},
    ),
    "Masonry.box": (mr.Masonry.box, {"size": (0.6, 0.4, 2.0), "density": 2e3, "k_n": 1e9}),
    "Masonry.column": (mr.Masonry.column, {"width": 1.0, "height": 4.0, "drums": 2, "sides": 4, "density": 2e3}),
    "Masonry.dome": (
        mr.Masonry.dome,
        {"radius": 5.0, "thickness": 0.5, "lunes": 4, "hoops": 2, "oculus": 0.1, "density": 2e3, "friction": 0.7},
    ),
    "Masonry.facade": (
        mr.Masonry.facade,
        {
            "length": 0.8, "height": 0.4, "depth": 0.4, "unit": (0.4, 0.2), "openings": (), "gable": 0, "density": 2e3,
            "thickness": 0.2, "returns": "both", "ground": None,
        },
    ),
    "Polyhedron.prism": (mr.Polyhedron.prism, {"polygon": COLUMN.blocks[1], "middle": 0.0}),
    "collapse_multiplier": (
        mr.collapse_multiplier,
        {"masonry": COLUMN, "direction": 1, "angle": None, "associated": True, "loads": {"block_0": (1.0, 0.0)}},
    ),
    "collapse_multiplier, in a pose": (
        mr.collapse_multiplier, {"masonry": COLUMN, "pose": [3 * [0.0]] * len(COLUMN.free)},
    ),
    "limit_curve": (
        mr.limit_curve, {"masonry": COLUMN, "direction": 1, "to": 1e-3, "angle": None, "effects": (), "poses": 2},
    ),
    "collapse_multiplier, space": (
        mr.collapse_multiplier,
        {"masonry": BOX, "direction": (1.0, 0.3), "angle": None, "associated": True, "loads": {"block": (1.0, 0, 0)}},
    ),
    "Masonry, space": (
        mr.Masonry,
        {
            "blocks": BOX.blocks, "k_n": 5e8, "friction": 0.7, "xi": 0.05, "frequency": None, "points": 2,
            "tolerance": 1e-5, "law": None,
        },
    ),
    "MasonryCase, space": (
        mr.MasonryCase,
        {
            "masonry": BOX, "duration": 1.0, "motion": None, "vertical": None, "transverse": None,
            "velocity": [6 * [0.0]], "effects": (), "supports": (),
        },
    ),
    "Tie, space": (
        mr.Tie,
        {"at": (0, 0, 1), "stiffness": 1e6, "anchor": (1, 0, 1), "anchor_block": None, "height": None, "slack": 0.0},
    ),
    "Damper, space": (
        mr.Damper, {"at": (0, 0, 1), "c": 1e6, "anchor": (1, 0, 1), "anchor_block": None, "height": None},
    ),
    "FrictionDamper, space": (
        mr.FrictionDamper,
        {
            "at": (0, 0, 1), "stiffness": 1e6, "slip_force": 1e3, "anchor": (1, 0, 1), "anchor_block": None,
            "height": None,
        },
    ),
    "Thrust, space": (mr.Thrust, {"at": (0, 0, 1), "force": 1e3, "direction": (0, 1, 0), "height": None}),
    "Masonry": (
        mr.Masonry,
        {
            "blocks": COLUMN.blocks, "k_n": 5e8, "friction": 0.7, "xi": 0.05, "frequency": None, "points": 2,
            "tolerance": 1e-5, "law": None,
        },
    ),
    "Masonry, joints": (mr.Masonry, {"blocks": COLUMN.blocks, "joints": DRY, "tolerance": 1e-5, "law": None}),
    "Dry": (mr.Dry, {"k_n": 5e8, "friction": 0.7, "xi": 0.05, "k_s": 5e8, "frequency": 30.0, "points": 3}),
    "Mortar": (mr.Mortar, {"dry": DRY, "bond": BOND}),
    "Masonry.stack": (mr.Masonry.stack, {"blocks": [WALL], "k_n": 5e8, "ground": True, "law": None, "friction": 0.7}),
    "Masonry.stack, side": (
        mr.Masonry.stack,
        {"blocks": [WALL], "k_n": 5e8, "side_stop": True, "k_side": 1e8, "side_friction": 0.1, "xi": 0.05},
    ),
    "rigid_impact": (mr.rigid_impact, {"masonry": COLUMN, "velocity": [[-2.0, 0.3, -1.0]]}),
    "matched_masonry": (mr.matched_masonry, {"masonry": COLUMN, "e": E, "amplitude": 0.5, "accuracy": 1e-2}),
    "Masonry.arch": (
        mr.Masonry.arch,
        {
            "radius": 5.0, "thickness": 0.75, "span_angle": 3.0, "voussoirs": 5, "density": 2e3, "length": 1.0,
            "k_n": 1e9,
        },
    ),
    "Masonry.arch, tapered": (
        mr.Masonry.arch, {"radius": 5.0, "thickness": (0.9, 0.6), "span_angle": 3.0, "voussoirs": 5, "chords": 2},
    ),
    "Masonry.bridge": (
        mr.Masonry.bridge,
        {
            "radius": 3.0, "thickness": 0.45, "span_angle": 3.0, "voussoirs": 5, "spans": 2, "pier_width": 1.6,
            "pier_height": 2.0, "abutments": False, "density": 2e3, "length": 1.0,
        },
    ),
    "Masonry.barrel_vault": (
        mr.Masonry.barrel_vault,
        {
            "radius": 2.0, "thickness": 0.4, "length": 1.0, "unit": 0.5, "span_angle": 2.8, "courses": 3,
            "density": 2e3,
        },
    ),
    "Masonry.groin_vault": (
        mr.Masonry.groin_vault,
        {
            "radius": 2.0, "thickness": 0.4, "length": 4.5, "unit": 1.0, "span_angle": 2.8, "courses": 3, "cut": False,
            "density": 2e3,
        },
    ),
    "Masonry.running_bond": (
        mr.Masonry.running_bond,
        {"length": 1.0, "height": 1.0, "unit": (0.5, 0.25), "thickness": 0.1, "density": 2e3, "xi": 0.05},
    ),
    "Masonry.shear_wall": (
        mr.Masonry.shear_wall,
        {"length": 1.0, "height": 1.0, "unit": (0.5, 0.25), "thickness": 0.1, "density": 2e3, "xi": 0.05},
    ),
    "Masonry.wallette": (
        mr.Masonry.wallette,
        {
            "length": 1.0, "height": 1.0, "unit": (0.5, 0.25), "thickness": 0.25, "density": 2e3, "leaves": 2,
            "headers": 2, "beam": True,
        },
    ),
    "MasonryCase": (
        mr.MasonryCase,
        {
            "masonry": COLUMN, "duration": 1.0, "motion": None, "vertical": None, "velocity": [[0.0, 0.0, 0.1]],
            "effects": (),
        },
    ),
    "Masonry.from_meshes": (
        mr.Masonry.from_meshes,
        {
            "meshes": {"box": (BOX_CORNERS, BOX_FACES)}, "fixed": (), "ground": True, "density": 2000.0, "scale": None,
            "unit": None, "up": None, "convex": None, "tolerance": 1e-5,
        },
    ),
    "masonry_scene": (mr.masonry_scene, {"case": mr.MasonryCase(COLUMN, 0.02)}),
    "masonry_mjcf": (mr.masonry_mjcf, {"case": mr.MasonryCase(COLUMN, 0.02), "timestep": 1e-3, "newmark_beta": 0.25}),
    "simulate, masonry": (
        mr.simulate,
        {
            "case": mr.MasonryCase(COLUMN, 0.02), "contacts": None, "timestep": None, "accuracy": 1e-2,
            "newmark_beta": 0.25, "output_step": 1e-3, "ledger": False, "forces": False, "start": None,
        },
    ),
    "Plan": (mr.Plan, {name: getattr(PLAN, name) for name in inspect.signature(mr.Plan).parameters}),
}  # fmt: skip
"""Arguments that work, by entry."""

HOSTILE = st.one_of(
    st.sampled_from(
        [
            None, True, False, "", "0.3", b"1", [], [1.0], (), {}, 1j, 10**400, -(10**400), math.nan, math.inf,
            -math.inf, 0, -1, 1e-300, 1e300, np.nan, np.float32(2.0), np.int64(3), np.array(0.3), np.array([0.1, 0.2]),
            object(),
            WALL, E, SHORT, COLUMN, BOX, CONTACTS, CONTACTS.base, MOTION,
            mr.Load(1e3, 2.0), mr.SideStop(2.0), [mr.Opening(0.2, 1.0)], RESPONSE, mr.CALIBRATED, print, "no", 2.5,
        ]
    ),
    st.floats(),
    st.integers(-(10**12), 10**12),
)  # fmt: skip


STANDS_FOR = {
    "b": "half thickness",
    "h": "half height",
    "R": "half diagonal",
    "base": "base restitution",
    "side": "side restitution",
    "lumped": "lumped restitution",
    "k_n": "interface stiffness",
    "k_base": "base stiffness",
    "k_side": "side stiffness",
    "xi": "damping ratio",
    "xi_base": "damping ratio",
    "xi_side": "damping ratio",
    "theta0": "release rotation",
    "omega0": "release velocity",
    "frequency": "reference frequency",
    "E": "modulus E",
    "f_c": "compressive strength",
    "contacts": "the base contacts",
    "wall": "alpha",
}
"""What messages call an argument, where that is not its name."""


def named(message, arguments):
    """Whether a message names an argument, or what it stands for."""
    words = [rf"\b{re.escape(name)}\b" for name in arguments] + [
        re.escape(STANDS_FOR[name]) for name in arguments if name in STANDS_FOR
    ]
    return any(re.search(word, message) for word in words)


ENTRY = st.sampled_from(sorted(CALLS))
REPLACED = {
    name: st.lists(st.sampled_from(sorted(arguments)), min_size=1, max_size=2, unique=True)
    for name, (_, arguments) in CALLS.items()
}
"""Which arguments of an entry are replaced; made once, since making them takes longer than most calls."""


@st.composite
def calls(draw):
    name = draw(ENTRY)
    function, arguments = CALLS[name]
    return name, function, arguments | {one: draw(HOSTILE) for one in draw(REPLACED[name])}


@cache
def response():
    return mr.simulate(SHORT, CONTACTS)


def solved(value):
    """A value, or the response or its end for what stands for it."""
    return response() if value is RESPONSE else response().end if value is END else value


def is_answered(call):
    name, function, arguments = call
    arguments = {one: solved(value) for one, value in arguments.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            function(**arguments)
        except mr.SimulationError:
            pass
        except (ValueError, TypeError) as error:
            if not named(str(error), arguments):
                pytest.fail(f"{name} names no argument: {type(error).__name__}: {error}")


HEALTH = [HealthCheck.too_slow, HealthCheck.data_too_large]


@given(calls())
@settings(max_examples=400, deadline=None, derandomize=True, suppress_health_check=HEALTH)
def test_a_call_is_answered_or_refused_by_name(call):
    is_answered(call)


class Unreadable:
    def __array__(self, *arguments, **named):
        raise RuntimeError("there is no array")


class Lying(list):
    """A list that says that it has more values than memory holds."""

    def __len__(self):
        return 10**12


RAGGED = [[1.0], [1.0, 2.0]]
AN_ARRAY_IS_TAKEN = {
    "Damper, space": ("at", "anchor"),
    "Thrust, space": ("direction",),
    "Actuator": ("at", "direction"),
    "collapse_multiplier, in a pose": ("pose",),
    "push": ("to",),
    "dynamic_check": ("runs",),
    "contact_parameters": ("k", "timestep"),
    "MasonryCase": ("velocity",),
}
"""Arguments that take arrays, each by a check of its own."""


def test_what_cannot_be_read_is_refused_by_name():
    """An object that cannot become an array, rows of different lengths, a module."""
    for name, arguments in AN_ARRAY_IS_TAKEN.items():
        function, given = CALLS[name]
        for argument in arguments:
            for value in (Unreadable(), RAGGED, np):
                is_answered((name, function, given | {argument: value}))


A_LIST_IS_TAKEN = {
    "Block": ("openings", "masses"),
    "VerticalBending": ("effects",),
    "Case": ("effects",),
    "contact_for": ("friction",),
    "dynamic_check": ("runs",),
    "scaled_together": ("motions",),
    "Masonry": ("blocks",),
    "Masonry.stack": ("blocks",),
}
"""Arguments that take lists of things."""


@pytest.mark.parametrize("values", [Lying, lambda: Lying([1.0]), lambda: repeat(1.0)], ids=["empty", "one", "endless"])
def test_a_list_that_lies_about_its_length_is_refused_by_name(values):
    for name, arguments in A_LIST_IS_TAKEN.items():
        function, given = CALLS[name]
        for argument in arguments:
            with pytest.raises((TypeError, ValueError), match=STANDS_FOR.get(argument, argument)):
                function(**given | {argument: values()})


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(CALLS))
def test_what_cannot_be_read_is_refused_by_name_everywhere(name):
    function, given = CALLS[name]
    for argument in given:
        for value in (
            Unreadable(),
            RAGGED,
            Lying([1.0]),
            np,
            np.ma.masked_all(3),
            np.array([1.0, None]),
            {"a": 1},
            [[[[[1.0]]]]],
        ):
            is_answered((name, function, given | {argument: value}))


@pytest.mark.parametrize(
    ("name", "argument", "value"),
    [
        ("Tie", "strength", 1e308),
        ("contact_stiffness", "inverse_weight", 1e308),
        ("StiffnessRange", "basis", math.nan),
        ("StiffnessRange", "basis", float),
        ("StiffnessRange", "basis", np.ones(3)),
    ],
)
def test_what_no_wall_has_is_refused(name, argument, value):
    function, given = CALLS[name]
    with pytest.raises((ValueError, TypeError), match=argument):
        function(**given | {argument: value})


@pytest.mark.slow
@given(calls())
@settings(max_examples=10_000, deadline=None, derandomize=True, suppress_health_check=HEALTH)
def test_ten_thousand_calls(call):
    is_answered(call)


def test_every_public_entry_is_tried():
    """What is not called here is made by a solver, or tested with the campaigns, records, reports and files."""
    elsewhere = {
        "CALIBRATED", "CALIBRATED_BED", "PUBLISHED", "GRAVITY", "Comparison", "ContactParameters", "Impact", "Ledger",
        "Outcome", "Response", "MasonryResponse", "RigidImpact", "Joint", "SimulationError", "__version__", "PowerLaw",
        "DampingLaw", "Scene", "Analysis", "MasonryAnalysis", "Grid", "Store", "campaign", "ida", "results",
        "Island", "Thresholds", "thresholds", "OverturningMap", "overturning_map",
        "Sensitivity", "sensitivity", "MASONRY_TYPES", "MasonryType", "Implausible", "ResponseSpectrum",
        "Code", "Design", "design", "MechanismCheck", "DynamicCheck", "RockingSpectrum", "Fragility", "PairedRatio",
        "calibrate", "GroundMotion", "report",
        "ContactWarning", "FlexContact", "InspectedContact", "PairContact", "PairContacts", "ManyContactParameters",
        "MeasuredContact", "SpaceJoint", "Collapse", "LimitCurve", "CodeSpectrum", "FloorSpectrum", "BONDS", "Push",
        "records_in", "RecordSet", "components_in", "LoadCheck", "joint_law", "link_law",
        "Assessment", "AssessmentError", "from_toml", "toml_schema", "load",
    }  # fmt: skip
    tried = {name.split(".")[0].split(",")[0] for name in CALLS}
    assert set(mr.__all__) - elsewhere <= tried


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.Block(True, True), "half thickness b = True of type bool is not a real number"),
        (lambda: mr.Block.from_slenderness(-1, 2.0), "slenderness h/b = -1 is outside the valid range 1 to 200"),
        (lambda: mr.Case(WALL, 0.0, 1.0, side_stop="no"), "side_stop = 'no' of type str is neither True nor False"),
        (lambda: mr.simulate(CONTACTS, SHORT), "case and contacts are swapped: the case comes first"),
        (lambda: mr.simulate(SHORT, CONTACTS, start=0), "start = 0 of type int is not a pose and a velocity"),
        (
            lambda: mr.simulate(SHORT, CONTACTS, start=([[0, 0, math.nan]], [[0, 0, 0]])),
            "start, pose holds a value that is not finite",
        ),
        (
            lambda: mr.simulate(SHORT, CONTACTS, start=([[0, 0, 40]], [[0, 0, 0]])),
            "start, rotation = 40 rad is outside the valid range",
        ),
        (lambda: mr.simulate(SHORT, CONTACTS, 1e-3, output_step=-1), "output_step = -1 s is outside"),
        (
            lambda: mr.simulate(mr.Case(WALL, 0.05, 1e5), CONTACTS, 1e-5),
            r"the steps of this run would be 1e\+10; at most 5e\+07 fit into memory; take a longer timestep",
        ),
        (
            lambda: mr.solve_analytical(mr.Case(WALL, 0.05, 1e6), E),
            r"the samples of this answer would be 1e\+09; .* raise output_step",
        ),
        (lambda: mr.calibrate("x", "never.sqlite", points=2.5), "points = 2.5 is not a whole number"),
        (lambda: mr.CALIBRATED.reach(WALL, 5e8, math.nan), "amplitude theta_0/alpha = nan is outside"),
        (lambda: mr.CALIBRATED(WALL, E, 1e300), r"k_n = 1e\+300 N/m3 is outside the valid range"),
        (lambda: mr.Interface(5e8, 0.05, 0.6, -1.0, 30.0), "length = -1 m is outside the valid range"),
        (lambda: mr.Plan(losses=("a",)), "losses = 'a' of type str is not a real number"),
    ],
)
def test_it_says_what_is_wrong(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()


@pytest.mark.parametrize("value", ["nan", "inf", "-1.0", '"text"', "true"])
def test_a_law_with_coefficients_that_cannot_be(value, tmp_path):
    path = mr.CALIBRATED.save(tmp_path / "law.toml")
    text = re.sub(r"(?m)^floor = .*$", f"floor = {value}", path.read_text())
    path.write_text(text)
    with pytest.raises(ValueError, match=r"law.toml is not a damping law: base.floor = "):
        mr.DampingLaw.load(path)


def test_the_engine_leaves_no_log_behind(tmp_path, monkeypatch, caplog):
    monkeypatch.chdir(tmp_path)
    stiff = mr.Contacts.from_damping(WALL, k_base=1e13, xi_base=0.0)
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(mr.Case(WALL, 0.05, 1.0, side_stop=False), stiff, 1e-4))
    data = mujoco.MjData(model)
    data.qpos[0] = math.nan
    mujoco.mj_step(model, data)
    assert "QPOS" in caplog.text
    assert not list(tmp_path.iterdir())
