"""Public entries and arguments that work, as whole numbers where they can be, which are replaced by what is tried."""

import mujoco

import mjrock as mr

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


OF_NUMBERS = {
    "Block.from_size": (mr.Block.from_size, {"thickness": 2, "height": 100, "length": 8, "density": 100, "inset": 0.5}),
    "Block.from_slenderness": (mr.Block.from_slenderness, {"slenderness": 100, "R": 50, "length": 8, "density": 100}),
    "Restitution": (mr.Restitution, {"base": 0.5, "side": -0.5}),
    "Restitution.from_geometry": (mr.Restitution.from_geometry, {"wall": 0.5}),
    "Restitution.from_lumped": (mr.Restitution.from_lumped, {"lumped": -0.25, "wall": 0.5}),
    "Gable": (mr.Gable, {"height": 100, "top": 100}),
    "Opening": (mr.Opening, {"width": 100, "height": 100, "sill": 100}),
    "Damper": (mr.Damper, {"height": 100, "c": 100, "length": 100, "block": 100}),
    "FrictionDamper": (
        mr.FrictionDamper, {"height": 100, "stiffness": 100, "slip_force": 100, "length": 100, "block": 100},
    ),
    "Link": (link, {"height": 100, "length": 100, "stroke": 1, "block": 100}),
    "Tie": (
        mr.Tie,
        {
            "height": 100, "stiffness": 100, "slack": 1, "strength": 100, "length": 100, "anchor_height": 1,
            "block": 100, "ultimate": 1,
        },
    ),
    "Thrust": (mr.Thrust, {"height": 100, "force": 100, "block": 100}),
    "Load": (mr.Load, {"force": 100, "height": 100, "offset": 1, "block": 100}),
    "AddedMass": (mr.AddedMass, {"mass": 100, "height": 100, "offset": 1, "block": 100}),
    "SideStop": (mr.SideStop, {"top": 100}),
    "Interface": (
        mr.Interface, {"k_n": 16384, "xi": 1, "face": 1, "length": 100, "frequency": 100, "points": 100, "friction": 1},
    ),
    "joint_stiffness": (mr.joint_stiffness, {"E": 2**20, "thickness": 1}),
    "contact_parameters": (
        mr.contact_parameters, {"k": 100, "c": 100, "timestep": 0.125, "inverse_weight": 1, "newmark_beta": 1},
    ),
}  # fmt: skip
"""Entries that take nothing but numbers."""
