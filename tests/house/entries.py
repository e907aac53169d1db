"""Every public entry with arguments that work: the one table of the tests that try all entries.

A new public name is a row of `ENTRIES`, or of `ANSWERS` where calls give it. Numbers are those that numbers of few bits
hold, 0.0625 in place of 0.05, since they are tried too.
"""

import inspect
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import mujoco
import numpy as np

import mjrock as mr
from mjrock.plotting.bodies import Bodies
from mjrock.study.intensity.ida import IncrementalAnalysis


class Entry(NamedTuple):
    """A public function or type, with arguments that work by name."""

    call: Callable
    given: dict
    wide: tuple

    @property
    def numbers(self):
        """The arguments that are tried as numbers of few bits: all numbers but the `wide` ones."""
        return {name: one for name, one in self.given.items() if type(one) in (int, float) and name not in self.wide}

    @property
    def paths(self):
        """The arguments that are paths."""
        return self.given.keys() & {"path", "store", "damaged", "histories", "folder"}


def entry(call, *, wide=(), **given):
    """A function and its arguments. Those in `wide` are whole numbers that choose, or of calls that take long."""
    return Entry(call, given, wide)


BALL = mujoco.MjModel.from_xml_string(
    """<mujoco><option timestep="1e-5"/><worldbody><geom name="floor" type="plane" size="1 1 1"/>
    <body name="ball" pos="0 0 .1"><freejoint/><geom name="ball" size=".1"/></body></worldbody></mujoco>"""
)
"""A ball on a floor."""


@mr.link_law
class Elastic:
    """The law of a link that is a spring."""

    k: float

    def force(self, u, rate):
        return self.k * u

    def energy(self, u):
        return 0.5 * self.k * u * u


def link(**given):
    """A link that is a spring."""
    return mr.Link(own=Elastic(k=1e5), **given)


WALL = mr.Block(0.3, 2.1)
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, 5e8, 5e8)
SHORT = mr.Case(WALL, 0.05, 0.02)
MOTION = mr.GroundMotion.half_sine(3.0, 0.1)
SPECTRUM = mr.code_spectrum("EC8 type 1", ag=2.0, soil="B")
RESPONSE, RESPONSES, END, COLLAPSE = (object() for _ in range(4))
"""What a solver answers stands here as a call is made, see `solved`: nothing is solved before."""
ROWS = mr.contact_parameters(1.5e8, 5e5, timestep=1e-3, inverse_weight=2 / (3 * WALL.mass))
PAIRED = mujoco.MjModel.from_xml_string(
    """<mujoco><option cone="elliptic"/><worldbody><geom name="floor" type="plane" size="1 1 1"/><body pos="0 0 .1">
    <freejoint/><geom name="ball" size=".1"/></body></worldbody><contact><pair geom1="ball" geom2="floor"/></contact>
    </mujoco>"""
)
PLAN = mr.Plan(base_count=2, side_count=2)
COLUMN, SQUAT = mr.Masonry.stack([WALL], 5e8), mr.Masonry.stack([mr.Block(0.5, 2.0)], 2.0**29)
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
TIMES = np.linspace(0.0, 1.0, 3)
IDA = IncrementalAnalysis(("a", "b"), np.array([1.0]), np.array([[1.0], [2.0]]), ((), ()))
ENTRIES = {
    "Actuator": entry(
        mr.Actuator, wide=("direction",), block=1, at=(0.3, 4.0), direction=1, displacement=([0.0, 1.0], [0.0, 0.01]),
        stiffness=1e7, damping=0.0, guided=None,
    ),
    "AddedMass": entry(mr.AddedMass, mass=100, height=100, offset=1, block=100),
    "Analysis": entry(mr.Analysis, case=SHORT, solver="analytical", e=E, contacts=None, options={"rtol": 1e-4}),
    "as_theory": entry(mr.as_theory, wall=WALL, e=E, side_stop=False, rebounds=2, amplitude=0.5),
    "automatic_timestep": entry(mr.automatic_timestep, wall=WALL, contacts=CONTACTS, side_stop=True),
    "Block": entry(
        mr.Block, b=0.3125, h=2.125, length=1.0, density=2000.0, inset=0.0, openings=(), profile=None, masses=(),
        plumb="outer",
    ),
    "Block, profile": entry(lambda z, t: mr.Block(1.0, 50.0, profile=[(0.0, 2.0), (z, t)]), z=100, t=1),
    "Block.from_size": entry(mr.Block.from_size, thickness=2, height=100, length=8, density=100, inset=0.5),
    "Block.from_slenderness": entry(mr.Block.from_slenderness, slenderness=100, R=50, length=8, density=100),
    "Bodies": entry(lambda magnify: Bodies.of(response(), magnify), magnify=100),
    "Bond": entry(
        mr.Bond, tension=2e5, cohesion=3e5, opening_energy=18.0, slip_energy=125.0, crushing=1e7, crushing_energy=5e3,
    ),
    "calibrate": entry(mr.calibrate, name="corners", store="s.sqlite"),
    "campaign": entry(mr.campaign, tasks=[], store="s.sqlite", histories=None),
    "Capacity": entry(mr.Capacity, analysis=pushed(1.0), tolerance=0.125, start=1.0, below=1),
    "Case": entry(
        mr.Case, block=WALL, theta0=0.0625, duration=1.0, side_stop=True, omega0=0.0, motion=None, vertical=None,
        effects=(mr.Tie(3.0, 1e6),),
    ),
    "code_spectrum": entry(
        mr.code_spectrum, code="NTC 2018", ag=2.0, soil="C", F0=2.5, Tc=0.3125, topography="T1", damping=0.0625,
    ),
    "CodeSpectrum": entry(SPECTRUM, T=[0.0, 0.5], damping=0.0625),
    "CodeSpectrum.at_height": entry(
        SPECTRUM.at_height, period=[0.3, 0.1], damping=0.0625, participation=[1.2, 0.3], height=[0.5, -0.2],
    ),
    "collapse_multiplier": entry(
        mr.collapse_multiplier, wide=("direction",), masonry=COLUMN, direction=1, angle=None, associated=True,
        loads={"block_0": (1.0, 0.0)},
    ),
    "collapse_multiplier, in a pose": entry(
        mr.collapse_multiplier, masonry=COLUMN, pose=[3 * [0.0]] * len(COLUMN.free),
    ),
    "collapse_multiplier, space": entry(
        mr.collapse_multiplier, masonry=BOX, direction=(1.0, 0.3), angle=None, associated=True,
        loads={"block_1": (1.0, 0, 0)},
    ),
    "compare": entry(mr.compare, reference=RESPONSE, candidate=RESPONSE),
    "components_in": entry(mr.components_in, path="a.csv"),
    "Compound": entry(mr.Compound, parts=list(L_UNIT.parts), fixed=False, name="L"),
    "Compound.prism": entry(mr.Compound.prism, compound=L_UNIT, middle=0.0),
    "contact_for": entry(
        mr.contact_for, model=BALL, geom1="ball", geom2="floor", k=1e6, c=None, restitution=0.5, xi=None, friction=0.5,
        mass=None, at=None, contacts=1, timestep=2.0**-17, newmark_beta=0.25, keyframe=None, qpos=[0.0, 0.0, 0.1, 1.0,
        0.0, 0.0, 0.0], speed=1.0,
    ),
    "contact_for, by c": entry(
        mr.contact_for, model=BALL, geom1="ball", geom2=0, wide=("geom2",), k=1e6, c=30.0, mass=1.0, timestep=2.0**-17,
    ),
    "contact_for, by depth": entry(
        mr.contact_for, model=BALL, geom1="ball", geom2=0, wide=("geom2",), depth=2.0**-13, load=50.0, xi=1.0,
        timestep=2.0**-17,
    ),
    "contact_for, by face": entry(
        mr.contact_for, model=BALL, geom1="ball", geom2=0, wide=("geom2",), k_face=1e6, xi=1.0, timestep=2.0**-17,
        normal=[0, 0, 1],
    ),
    "contact_parameters": entry(mr.contact_parameters, k=100, c=100, timestep=0.125, inverse_weight=1, newmark_beta=1),
    "contact_stiffness": entry(mr.contact_stiffness, solref=ROWS.solref, solimp=ROWS.solimp, inverse_weight=2.0**-13),
    "Contacts": entry(mr.Contacts, base=CONTACTS.base, side=CONTACTS.side, law="mine"),
    "Contacts.from_damping": entry(
        mr.Contacts.from_damping, wall=WALL, k_base=5e8, xi_base=0.0625, k_side=5e8, xi_side=2.0**-7, points=2,
        friction=0.625,
    ),
    "Contacts.from_law": entry(
        mr.Contacts.from_law, wall=WALL, e=E, k_base=5e8, k_side=5e8, law=None, points=2, amplitude=0.5,
    ),
    "contacts_for": entry(
        mr.contacts_for, model=BALL, pairs={("b*", "floor"): {"k": 1e6, "restitution": 0.5}}, keyframe=None, qpos=None,
        timestep=2.0**-17,
    ),
    "Corner": entry(mr.Corner, thickness=0.5, height=4.0, angle=0.375, density=2000.0),
    "CoulombFriction": entry(mr.CoulombFriction, model=PAIRED),
    "crushed_inset": entry(mr.crushed_inset, wall=WALL, f_c=2e6, load=1e3),
    "Damper": entry(mr.Damper, height=100, c=100, length=100, block=100),
    "Damper, space": entry(mr.Damper, at=(0, 0, 1), c=1e6, anchor=(1, 0, 1), anchor_block=None, height=None),
    "DampingLaw": entry(mr.CALIBRATED, wall=WALL, e=E, k_n=5e8, k_side=5e8, amplitude=0.5),
    "DampingLaw.covers": entry(mr.CALIBRATED.covers, wall=WALL, e=E, k_n=5e8, k_side=5e8, amplitude=0.5),
    "DampingLaw.load": entry(mr.DampingLaw.load, path="law.toml"),
    "DampingLaw.reach": entry(mr.CALIBRATED.reach, wall=WALL, k_n=5e8, amplitude=0.5),
    "DampingLaw.save": entry(mr.CALIBRATED.save, path="law.toml"),
    "design": entry(mr.design, build=lambda b: mr.Case(mr.Block(b, 2.0), 0.0, 1.0), values=[0.5, 1.0], demand=SPECTRUM),
    "Dry": entry(mr.Dry, k_n=5e8, friction=0.75, xi=0.0625, k_s=5e8, frequency=30.0, points=3),
    "dynamic_check": entry(
        mr.dynamic_check, runs=RESPONSES, limit_state="SLV", natural=True,
    ),
    "EarthPressure": entry(
        mr.EarthPressure, height=3.0, friction_angle=0.625, density=1900.0, wall_friction=0.25, slope=0.125, k_h=0.125,
        k_v=0.0,
    ),
    "Fill": entry(mr.Fill, top=5.75, density=1800.0, spread=0.5, passive=3.0),
    "fit_capacities": entry(mr.fit_capacities, capacities=[1.0, 2.0, 3.0, 4.0, 5.0], groups=None, resamples=20, seed=0),
    "fit_fragility": entry(
        mr.fit_fragility, intensity=[1.0, 2.0, 3.0, 4.0, 2.5, 3.5], overturned=[0, 0, 1, 1, 1, 0], groups=range(6),
        resamples=20, seed=0,
    ),
    "FrictionDamper": entry(mr.FrictionDamper, height=100, stiffness=100, slip_force=100, length=100, block=100),
    "FrictionDamper, space": entry(
        mr.FrictionDamper, at=(0, 0, 1), stiffness=1e6, slip_force=1e3, anchor=(1, 0, 1), anchor_block=None,
        height=None,
    ),
    "from_toml": entry(mr.from_toml, path="a.toml"),
    "Gable": entry(mr.Gable, height=100, top=100),
    "Grid": entry(mr.Grid, build=pushed, scale=[1.0, 2.0]),
    "GroundMotion": entry(mr.GroundMotion, accel=[0.0, 1.0], dt=0.5),
    "GroundMotion.from_at2": entry(mr.GroundMotion.from_at2, path="a.at2"),
    "GroundMotion.from_csv": entry(mr.GroundMotion.from_csv, path="a.csv", unit="g"),
    "GroundMotion.half_sine": entry(mr.GroundMotion.half_sine, amplitude=1, duration=1, samples=100),
    "GroundMotion.rectangular": entry(mr.GroundMotion.rectangular, amplitude=1, duration=100),
    "GroundMotion.resampled": entry(mr.GroundMotion([0.0, 1.0, 0.5], 0.0625).resampled, dt=0.03125),
    "GroundMotion.ricker": entry(mr.GroundMotion.ricker, amplitude=1, period=1, samples=100),
    "GroundMotion.scaled": entry(MOTION.scaled, factor=1),
    "GroundMotion.scaled, to a peak": entry(MOTION.scaled, peak=1),
    "GroundMotion.sine": entry(mr.GroundMotion.sine, amplitude=1, period=1, cycles=2, samples=100),
    "GroundMotion.synthetic": entry(
        mr.GroundMotion.synthetic, peak=1, duration=100, seed=100, dt=0.125, ground_frequency=1, ground_damping=1,
        filter_frequency=0.25, filter_damping=1, rise=0.25, fall=0.25,
    ),
    "GroundMotion.through_building": entry(
        MOTION.through_building, period=[0.3], damping=0.0625, participation=[1.2], height=[0.5],
    ),
    "hertz_stiffness": entry(
        mr.hertz_stiffness, radius=0.125, E=1e9, nu=0.3125, other=(1e9, 0.3), force=None, mass=1.0, speed=1.0,
    ),
    "HorizontalBending": entry(mr.HorizontalBending, wall=WALL, thrust=1e4, crack=None),
    "ida": entry(mr.ida, build=pushed, scales=[1.0], store="s.sqlite", workers=1),
    "IncrementalAnalysis.percentiles": entry(lambda share: IDA.percentiles([share]), share=100),
    "inspect_contacts": entry(
        mr.inspect_contacts, model=BALL, candidates=True, contacts=1, keyframe=None, qpos=None, load=3.0,
    ),
    "inspect_flexes": entry(mr.inspect_flexes, model=BALL),
    "Interface": entry(mr.Interface, k_n=16384, xi=1, face=1, length=100, frequency=100, points=100, friction=1),
    "joint_stiffness": entry(mr.joint_stiffness, E=2**20, thickness=1),
    "layered_stiffness": entry(
        lambda stiffnesses: mr.layered_stiffness(*stiffnesses) if isinstance(stiffnesses, tuple) else
        mr.layered_stiffness(stiffnesses), stiffnesses=(1e9, 2e9),
    ),
    "limit_curve": entry(
        mr.limit_curve, wide=("direction",), masonry=COLUMN, direction=1, to=2.0**-10, angle=None, effects=(), poses=2,
    ),
    "Link": entry(link, height=100, length=100, stroke=1, block=100),
    "Load": entry(mr.Load, force=100, height=100, offset=1, block=100),
    "load": entry(mr.load, path="a.h5"),
    "load_check": entry(mr.load_check, result=COLLAPSE, demand=0.125),
    "lost": entry(mr.lost, rows=[{"outcome": "at rest", "peak_over_alpha": 0.125}]),
    "Masonry": entry(
        mr.Masonry, blocks=COLUMN.blocks, k_n=5e8, friction=0.75, xi=0.0625, frequency=None, points=2,
        tolerance=2.0**-17, law=None,
    ),
    "Masonry, joints": entry(mr.Masonry, blocks=COLUMN.blocks, joints=DRY, tolerance=2.0**-17, law=None),
    "Masonry, space": entry(
        mr.Masonry, blocks=BOX.blocks, k_n=5e8, friction=0.75, xi=0.0625, frequency=None, points=2, tolerance=2.0**-17,
        law=None,
    ),
    "Masonry.arch": entry(
        mr.Masonry.arch, radius=5.0, thickness=0.75, span_angle=3.0, voussoirs=5, density=2e3, length=1.0, k_n=1e9,
    ),
    "Masonry.arch, tapered": entry(
        mr.Masonry.arch, radius=5.0, thickness=(0.9, 0.6), span_angle=3.0, voussoirs=5, chords=2,
    ),
    "Masonry.barrel_vault": entry(
        mr.Masonry.barrel_vault, radius=2.0, thickness=0.375, length=1.0, unit=0.5, span_angle=2.75, courses=3,
        density=2e3,
    ),
    "Masonry.box": entry(mr.Masonry.box, size=(0.6, 0.4, 2.0), density=2e3, k_n=1e9),
    "Masonry.bridge": entry(
        mr.Masonry.bridge, radius=3.0, thickness=0.4375, span_angle=3.0, voussoirs=5, spans=2, pier_width=1.625,
        pier_height=2.0, abutments=False, density=2e3, length=1.0,
    ),
    "Masonry.column": entry(mr.Masonry.column, width=1.0, height=4.0, drums=2, sides=4, density=2e3),
    "Masonry.dome": entry(
        mr.Masonry.dome, radius=5.0, thickness=0.5, lunes=4, hoops=2, oculus=0.125, density=2e3, friction=0.75,
    ),
    "Masonry.facade": entry(
        mr.Masonry.facade, length=1.25, height=0.375, depth=0.5, unit=(0.4, 0.2), openings=(), gable=0, density=2e3,
        thickness=0.25, returns="both", ground=None,
    ),
    "Masonry.from_meshes": entry(
        mr.Masonry.from_meshes, meshes={"box": (BOX_CORNERS, BOX_FACES)}, fixed=(), ground=True, density=2000.0,
        scale=None, unit=None, up=None, convex=None, tolerance=2.0**-17,
    ),
    "Masonry.groin_vault": entry(
        mr.Masonry.groin_vault, radius=2.0, thickness=0.375, length=4.5, unit=2.0, span_angle=2.75, courses=1,
        cut=False, density=2e3,
    ),
    "Masonry.running_bond": entry(
        mr.Masonry.running_bond, length=1.0, height=1.0, unit=(0.5, 0.25), thickness=0.125, density=2e3, xi=0.0625,
    ),
    "Masonry.shear_wall": entry(
        mr.Masonry.shear_wall, length=1.0, height=1.0, unit=(0.5, 0.25), thickness=0.125, density=2e3, xi=0.0625,
    ),
    "Masonry.stack": entry(mr.Masonry.stack, blocks=[WALL], k_n=5e8, ground=True, law=None, friction=0.75),
    "Masonry.stack, side": entry(
        mr.Masonry.stack, blocks=[WALL], k_n=5e8, side_stop=True, k_side=1e8, side_friction=0.125, xi=0.0625,
    ),
    "Masonry.wallette": entry(
        mr.Masonry.wallette, length=1.0, height=0.5, unit=(1.0, 0.25), thickness=0.25, density=2e3, leaves=2, headers=2,
        beam=True,
    ),
    "masonry_mjcf": entry(mr.masonry_mjcf, case=mr.MasonryCase(COLUMN, 0.02), timestep=2.0**-10, newmark_beta=0.25),
    "masonry_scene": entry(mr.masonry_scene, case=mr.MasonryCase(COLUMN, 0.02)),
    "MasonryAnalysis": entry(mr.MasonryAnalysis, case=mr.MasonryCase(COLUMN, 0.02), solver="explicit", options={}),
    "MasonryCase": entry(
        mr.MasonryCase, masonry=COLUMN, duration=1.0, motion=None, vertical=None, velocity=[[0.0, 0.0, 0.1]],
        effects=(),
    ),
    "MasonryCase, space": entry(
        mr.MasonryCase, masonry=BOX, duration=1.0, motion=None, vertical=None, transverse=None, velocity=[6 * [0.0]],
        effects=(), supports=(),
    ),
    "matched_contacts": entry(
        mr.matched_contacts, wall=WALL, e=E, k_base=5e8, points=2, amplitude=0.5, friction=None, accuracy=2.0**-7,
    ),
    "matched_masonry": entry(mr.matched_masonry, masonry=SQUAT, e=None, amplitude=0.5, accuracy=0.0625),
    "measured_contact": entry(
        mr.measured_contact, heights=[1.0, 0.5], mass=1.0, contact_times=[0.01], confidence=0.875, gravity=9.8125,
    ),
    "measured_stiffness": entry(mr.measured_stiffness, wall=WALL, frequency=5.0, points=2),
    "mechanism_check": entry(
        mr.mechanism_check, case=SHORT, demand=SPECTRUM, confidence_factor=1.25, elastic_period=0.125, code="NTC 2018",
    ),
    "mjcf_of": entry(mr.mjcf_of, case=SHORT, contacts=CONTACTS, timestep=2.0**-10, newmark_beta=0.25),
    "Mortar": entry(mr.Mortar, dry=DRY, bond=BOND),
    "Opening": entry(mr.Opening, width=100, height=100, sill=100),
    "overturning_intensity": entry(
        mr.overturning_intensity, build=pushed, low=0.5, high=3.0, tolerance=0.125, start=1.0,
    ),
    "overturning_map": entry(
        mr.overturning_map, build=lambda a, T: pushed(a), amplitudes=[1.0], periods=[1.0], store="s.sqlite",
        workers=1,
    ),
    "paired_ratio": entry(mr.paired_ratio, capacities=[1.0, 2.0], over=[1.0, 1.5], groups=["a", "b"], confidence=0.875),
    "Plan": entry(mr.Plan, **{name: getattr(PLAN, name) for name in inspect.signature(mr.Plan).parameters}),
    "PointSpectrum": entry(mr.PointSpectrum, period=[0.0, 0.5], acceleration=[2.0, 5.0], damping=0.0625),
    "Polygon": entry(mr.Polygon, vertices=[(0, 0), (1, 0), (0, 1)], density=2e3, length=1.0, fixed=False, name=None),
    "Polyhedron": entry(
        mr.Polyhedron, vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], density=2e3, fixed=False, name=None,
    ),
    "Polyhedron.box": entry(mr.Polyhedron.box, size=(1, 1, 1), centre=(0, 0, 0), density=2e3, fixed=False, name=None),
    "Polyhedron.prism": entry(mr.Polyhedron.prism, polygon=COLUMN.blocks[1], middle=0.0),
    "PowerLaw": entry(mr.PowerLaw, coefficient=0.5, slenderness_exponent=2, stiffness_exponent=2, r_squared=1),
    "push": entry(mr.push, masonry=COLUMN, driver=1, to=2.0**-10, inertia=2.0**-5, wide=("driver", "to", "inertia")),
    "pushover": entry(mr.pushover, case=SHORT, contacts=CONTACTS, rotations=[0.01, 0.05], points=30),
    "records_in": entry(mr.records_in, folder="records"),
    "reference_frequency": entry(mr.reference_frequency, wall=WALL, k_n=5e8, points=2),
    "report": entry(mr.report, case=SHORT, responses=RESPONSES, path="a.html"),
    "Response.csv": entry(lambda path: response().csv(path), path="a.csv"),
    "response_spectrum": entry(mr.response_spectrum, motion=MOTION, periods=[0.5, 1.0], damping=0.0625),
    "Restitution": entry(mr.Restitution, base=0.5, side=-0.5),
    "Restitution.from_geometry": entry(mr.Restitution.from_geometry, wall=WALL),
    "Restitution.from_lumped": entry(mr.Restitution.from_lumped, lumped=-0.25, wall=0.5),
    "results": entry(mr.results, tasks=[], store="s.sqlite"),
    "rigid_impact": entry(mr.rigid_impact, masonry=COLUMN, velocity=[[-2.0, 0.3, -1.0]]),
    "rocking_spectrum": entry(
        mr.rocking_spectrum, motion=MOTION, R=[2.0], slenderness=7.0, side_stop=True, rtol=2.0**-13,
    ),
    "scaled_to_sa": entry(mr.scaled_to_sa, motion=MOTION, period=0.5, sa=2.0, damping=0.0625),
    "scaled_to_spectrum": entry(
        mr.scaled_to_spectrum, motion=MOTION, periods=[0.5, 1.0], target=[2.0, 1.0], damping=0.0625,
    ),
    "scaled_together": entry(
        mr.scaled_together, motions=(MOTION, MOTION), periods=[0.5, 1.0], target=[2.0, 1.0], damping=0.0625,
    ),
    "ScatteredRestitution": entry(mr.ScatteredRestitution, mean=E, sd=2.0**-7, seed=1),
    "scene_of": entry(mr.scene_of, case=SHORT, contacts=CONTACTS),
    "scene_of, masonry": entry(mr.scene_of, case=mr.MasonryCase(COLUMN, 0.02), contacts=None),
    "sensitivity": entry(
        mr.sensitivity, build=lambda k: pushed(0.5 * k), base={"k": 2.0}, vary={"k": [1.0, 3.0]}, store=None,
    ),
    "SideStop": entry(mr.SideStop, top=100),
    "simulate": entry(
        mr.simulate, case=SHORT, contacts=CONTACTS, timestep=2.0**-10, accuracy=2.0**-10, newmark_beta=0.25,
        output_step=2.0**-10, ledger=False, forces=True, start=END,
    ),
    "simulate, fitted": entry(mr.simulate, case=SHORT, contacts=CONTACTS, accuracy=2.0**-7, output_step=2.0**-10),
    "simulate, masonry": entry(
        mr.simulate, case=mr.MasonryCase(COLUMN, 0.02), contacts=None, timestep=None, accuracy=2.0**-7,
        newmark_beta=0.25, output_step=2.0**-10, ledger=False, forces=False, start=None,
    ),
    "solve_analytical": entry(mr.solve_analytical, case=SHORT, e=E, rtol=2.0**-27, output_step=2.0**-10, rest=2.0**-30),
    "solve_compliant": entry(mr.solve_compliant, case=SHORT, contacts=CONTACTS, rtol=2.0**-20, output_step=2.0**-10),
    "solve_explicit": entry(
        mr.solve_explicit, case=SHORT, contacts=CONTACTS, timestep=2.0**-13, output_step=2.0**-10, forces=True,
    ),
    "stiffest_contacts": entry(
        mr.stiffest_contacts, model=BALL, geom1="ball", geom2=0, wide=("geom2",), timestep=2.0**-10, keyframe=None,
        qpos=None,
    ),
    "stiffness_range": entry(mr.stiffness_range, wall=WALL, E=1e9, joint=(1e9, 0.01), frequency=4.0, points=2),
    "StiffnessRange": entry(mr.StiffnessRange, low=1e8, best=2e8, high=3e8, basis="a guess"),
    "Store": entry(mr.Store, path="s.sqlite"),
    "Store.rescue": entry(mr.Store.rescue, damaged="old.sqlite", path="new.sqlite"),
    "strengths_of_anchor": entry(
        mr.strengths_of_anchor, hole=0.0625, length=0.625, bond_strength=3e5, shear_strength=3e4, number=2,
    ),
    "strengths_of_bar": entry(
        mr.strengths_of_bar, diameter=2.0**-6, yield_stress=235e6, plate=0.3125, thickness=0.5, shear_strength=3e4,
        compressive_strength=2e6, number=2, spacing=1.0,
    ),
    "thresholds": entry(mr.thresholds, build=pushed, scales=[1.0], store="s.sqlite", workers=1),
    "Thrust": entry(mr.Thrust, height=100, force=100, block=100),
    "Thrust, space": entry(mr.Thrust, at=(0, 0, 1), force=1e3, direction=(0, 1, 0), height=None),
    "Tie": entry(
        mr.Tie, height=100, stiffness=100, slack=1, strength=100, length=100, anchor_height=1, block=100, ultimate=1,
    ),
    "Tie, space": entry(
        mr.Tie, at=(0, 0, 1), stiffness=1e6, anchor=(1, 0, 1), anchor_block=None, height=None, slack=0.0,
    ),
    "toml_schema": entry(mr.toml_schema),
    "VerticalBending": entry(mr.VerticalBending, wall=WALL, load=2e4, bearing=None, crack=None, effects=()),
    "wall_mjcf": entry(mr.wall_mjcf, case=SHORT, contacts=CONTACTS, timestep=2.0**-10, newmark_beta=0.25),
    "wall_scene": entry(mr.wall_scene, case=SHORT, contacts=CONTACTS),
    "wall_stiffness": entry(mr.wall_stiffness, E=1e9, wall=WALL, points=2),
    "Wedge": entry(mr.Wedge, angle=0.375, thickness=0.5, height=4.0, number=2, density=None),
}  # fmt: skip
"""By name, with what is special about a row behind a comma."""


@cache
def response():
    return mr.simulate(SHORT, CONTACTS)


ANSWERED = {
    RESPONSE: response,
    RESPONSES: cache(lambda: [mr.solve_analytical(pushed(0.5).case, E)]),
    END: lambda: response().end,
    COLLAPSE: cache(lambda: mr.collapse_multiplier(COLUMN)),
}


def solved(value):
    """A value, or the answer of a solver for what stands for it."""
    return ANSWERED[value]() if type(value) is object and value in ANSWERED else value


def given_to(name):
    """The arguments of an entry by name, ready for the call."""
    return {argument: solved(value) for argument, value in ENTRIES[name].given.items()}


STANDS_FOR = {
    "b": "half thickness", "h": "half height", "R": "half diagonal", "base": "base restitution",
    "side": "side restitution", "lumped": "lumped restitution", "k_n": "interface stiffness",
    "k_base": "base stiffness", "k_side": "side stiffness", "xi": "damping ratio", "xi_base": "damping ratio",
    "xi_side": "damping ratio", "theta0": "release rotation", "omega0": "release velocity",
    "frequency": "reference frequency", "E": "modulus E", "f_c": "compressive strength",
    "contacts": "the base contacts", "wall": "alpha", "z": "profile", "t": "profile", "top": "top of",
    "k": "stiffness k|solref", "c": "damping c|solref", "anchor_height": "height of the anchor", "share": "shares",
    "restitution": "damping ratio xi", "options": "option", "values": "half thickness", "demand": "result",
}  # fmt: skip
"""What messages call an argument, where that is not its name."""


def words_for(argument):
    """The words by which a message may name an argument."""
    return argument, *STANDS_FOR.get(argument, argument).split("|")


ANSWERS = {
    "Collapse": "collapse_multiplier", "Comparison": "compare", "ContactParameters": "contact_parameters",
    "Design": "design", "DynamicCheck": "dynamic_check", "Fragility": "fit_fragility", "LimitCurve": "limit_curve",
    "LoadCheck": "load_check", "MasonryResponse": "simulate, masonry", "MeasuredContact": "measured_contact",
    "MechanismCheck": "mechanism_check", "PairContact": "contact_for", "PairContacts": "contacts_for",
    "PairedRatio": "paired_ratio", "Push": "push", "Response": "simulate, fitted",
    "ResponseSpectrum": "response_spectrum", "RigidImpact": "rigid_impact", "RockingSpectrum": "rocking_spectrum",
    "Scene": "wall_scene",
}  # fmt: skip
"""Types that no user makes, with the entry that answers with them."""
PARTS = {
    "AssessmentError", "Assessment", "Code", "ContactWarning", "FlexContact", "FloorSpectrum", "Impact", "Implausible",
    "InspectedContact", "Island", "Joint", "Ledger", "ManyContactParameters", "MasonryType", "Outcome",
    "OverturningMap", "RecordSet", "Sensitivity", "SimulationError", "SpaceJoint", "Thresholds", "joint_law",
    "link_law",
}  # fmt: skip
"""Types that stand within answers or are read from files, errors, warnings, and decorators."""
