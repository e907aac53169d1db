"""Numbers with a unit as text: every argument that has a unit takes one, as its declaration says."""

import re

import numpy as np
import pytest

import mjrock as mr
from mjrock.assessment import declarations, mechanisms, running
from mjrock.problem.damping.contacts import Contacts
from mjrock.problem.damping.restitution import Restitution

UNIT = re.compile(r"\[(?!-\])(\w[^\]]*)\]")
"""A unit in a docstring."""
GIVEN = {"Restitution.from_geometry": "wall", "VerticalBending": "effects"}
"""Arguments that the file gives otherwise, or whose unit is that of effects in them."""


def tables():
    """What a table of the file may stand for, by name."""
    found = dict(mechanisms.MECHANISMS | mechanisms.SITES | running.RECORDS)
    found |= {kind.__name__: declarations.makers_of(kind) for kind in (Contacts, Restitution)}
    for name in ("FLOOR", "CHECK", "CURVE"):
        found[name] = {"": getattr(mechanisms, name)}
    found |= {"SCALED": {"": running.SCALED}, "DYNAMIC": {"": running.DYNAMIC}}
    found |= {solver: {"": running.run_maker(solver)} for solver in running.SOLVERS}
    return {f"{name}.{make}".strip("."): maker for name, makers in found.items() for make, maker in makers.items()}


def within(found):
    """Tables with those that may stand in them."""
    everything, left = {}, dict(found)
    while left:
        name, maker = left.popitem()
        if maker.call in {one.call for one in everything.values()}:
            continue
        everything[name] = maker
        for key in maker.keys.values():
            for kind in key.kinds:
                items = [kind, *(one for one in declarations.items_of(kind) or () if one is not ...)]
                classes = declarations.classes_of([one for item in items for one in declarations.kinds_of(item)])
                for title, cls in classes.items():
                    makers = declarations.makers_of(cls)
                    left |= {f"{title}.{make}".strip("."): one for make, one in makers.items()}
    return everything


def test_every_argument_with_a_unit_declares_it():
    makers = within(tables())
    assert len(makers) > 80
    without = [
        f"{name}.{key.name}"
        for name, maker in makers.items()
        for key in maker.keys.values()
        if UNIT.search(key.doc) and "unit='" not in str(key.hint) and GIVEN.get(name) != key.name
    ]
    assert without == []


@pytest.mark.parametrize(
    ("maker", "names"),
    [
        (running.SCALED, {"periods": "s"}),
        (declarations.makers_of(mr.Masonry)["between_floors"], {"load": "N", "bearing": "m", "crack": "m"}),
    ],
    ids=["scaled_to", "between_floors"],
)
def test_arguments_that_are_described_elsewhere_declare_their_unit_too(maker, names):
    assert {name: maker.keys[name].within.unit for name in names} == names


def test_an_argument_without_one_is_noticed():
    class Odd:
        def __init__(self, height: float) -> None:
            """An odd one.

            Args:
                height: of it [m].
            """

    key = declarations.maker_of(Odd.__init__).keys["height"]
    assert UNIT.search(key.doc)
    assert "unit='" not in str(key.hint)


BLOCKS = """
kind = "MasonryCase"
[masonry]
make = "Masonry"
k_n = "5 N/mm3"
[[masonry.blocks]]
kind = "Polygon"
vertices = [["-50 cm", "-50 cm"], ["150 cm", "-50 cm"], ["150 cm", 0], ["-50 cm", 0]]
fixed = true
name = "ground"
[[masonry.blocks]]
kind = "Polygon"
vertices = [[0, 0], ["100 cm", 0], ["100 cm", "1 m"], [0, "1 m"]]
density = "18 kN/m3"
length = "50 cm"
name = "stone"
[[effects]]
kind = "Actuator"
block = "stone"
at = ["0 cm", "80 cm"]
direction = 1
displacement = [["0 s", "2 s"], ["0 mm", "8 mm"]]
stiffness = "20 kN/mm"
damping = "3 kN s/m"
[[effects]]
kind = "Load"
force = "2 kN"
at = ["50 cm", "1 m"]
block = "stone"
[supports]
ground = [["0 s", "1 s"], ["0 mm", "5 mm"], [0, 0]]
[run]
solver = "explicit"
timestep = "10 ms"
output_step = "20 ms"
mass_damping = "2 1/s"
"""


def test_blocks_an_actuator_supports_and_steps_take_units():
    mechanism = mr.from_toml(text=BLOCKS).mechanisms[""]
    blocks = [
        mr.Polygon([(-0.5, -0.5), (1.5, -0.5), (1.5, 0), (-0.5, 0)], fixed=True, name="ground"),
        mr.Polygon([(0, 0), (1, 0), (1, 1), (0, 1)], 18e3 / mr.GRAVITY, 0.5, name="stone"),
    ]
    jack = mr.Actuator("stone", (0.0, 0.8), 1, ([0, 2], [0, 0.008]), 2e7, 3e3)
    load = mr.Load(2e3, at=(0.5, 1.0), block="stone")
    supports = {"ground": ([0, 1], [0, 0.005], [0, 0])}
    case = mr.MasonryCase(mr.Masonry(blocks, k_n=5e9), effects=(jack, load), supports=supports)
    assert mechanism.problem.effects == case.effects
    assert mechanism.problem.supports == case.supports
    assert mechanism.problem.masonry.blocks == case.masonry.blocks
    np.testing.assert_array_equal(mechanism.problem.masonry.joint_stiffness, case.masonry.joint_stiffness)
    assert mechanism.shaking.options == {"timestep": 0.01, "output_step": 0.02, "mass_damping": 2.0}


@pytest.mark.parametrize(
    ("made", "make", "keys"),
    [
        (
            mr.Masonry.facade(4.0, 2.0, 1.5, (0.5, 0.25), k_n=1e10),
            "facade",
            "length = '400 cm'\nheight = '2 m'\ndepth = '1500 mm'\nunit = ['50 cm', '25 cm']",
        ),
        (mr.Masonry.box((1.0, 2.0, 3.0), k_n=1e10), "box", "size = ['1 m', '200 cm', '3000 mm']"),
    ],
    ids=["facade", "box"],
)
def test_builders_take_units(made, make, keys):
    text = f"kind = 'MasonryCase'\n[masonry]\nmake = '{make}'\nk_n = '10 N/mm3'\n{keys}\n"
    assert mr.from_toml(text=text).mechanisms[""].problem.masonry.blocks == made.blocks


WALL = "[wall]\nthickness = 0.5\nheight = 4.0\n[site]\ncode = 'EC8 type 1'\nag = '0.1 g'\nsoil = 'A'\n"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (
            "[contacts]\nmake = 'from_damping'\nk_base = '0.5 N/mm3'\nxi_base = '5 %'\nxi_side = '1 %'\nk_side = 5e8",
            0.05,
        ),
        ("[contacts]\nmake = 'from_damping'\nk_base = 5e8\nxi_base = 0.05\nxi_side = 0.01\nk_side = 5e8", 0.05),
    ],
)
def test_damping_ratios_take_percent(text, found):
    contacts = mr.from_toml(text=WALL + text).mechanisms[""].shaking.contacts
    assert (contacts.base.xi, contacts.side.xi) == (found, 0.01)


def test_records_take_units():
    text = """
[[records]]
kind = "GroundMotion"
make = "synthetic"
peak = "0.2 g"
duration = 5
seed = 1
dt = "5 ms"
filter_frequency = "0.5 Hz"
[[records]]
kind = "GroundMotion"
accel = [0, "0.1 g", "-1 m/s2", 0]
dt = "20 ms"
"""
    synthetic, given = mr.from_toml(text=WALL + text).mechanisms[""].shaking.records
    assert synthetic == mr.GroundMotion.synthetic(0.2 * mr.GRAVITY, 5.0, seed=1, dt=0.005, filter_frequency=0.5)
    assert given == mr.GroundMotion([0.0, 0.1 * mr.GRAVITY, -1.0, 0.0], 0.02)


def test_restitution_and_points_of_a_spectrum_take_units():
    site = "kind = 'PointSpectrum'\nperiod = ['0 s', '200 ms', 2]\nacceleration = ['0.1 g', '0.25 g', '50 cm/s2']\n"
    text = WALL.partition("[site]")[0] + f"[site]\n{site}[restitution]\nstop_top = '350 cm'\n"
    mechanism = mr.from_toml(text=text).mechanisms[""]
    np.testing.assert_allclose(mechanism.demand.period, [0.0, 0.2, 2.0], rtol=1e-15)
    np.testing.assert_allclose(mechanism.demand.acceleration, [0.981, 2.4525, 0.5], rtol=1e-15)
    assert mechanism.shaking.e == mr.Restitution.from_geometry(mechanism.problem.block, 3.5)


def test_a_limit_curve_takes_units():
    text = "kind = 'MasonryCase'\n[masonry]\nmake = 'column'\nwidth = 0.5\nheight = 2\ndrums = 2\n"
    text += "[limit_curve]\nangle = '30 deg'\nto = '80 mm'\nposes = 8\n"
    assert mr.from_toml(text=text).mechanisms[""].curve == {"angle": np.radians(30.0), "to": 0.08, "poses": 8}
    with pytest.raises(
        mr.AssessmentError, match=r"limit_curve\.to = '800 mm?' = 800 m is outside the valid range 1e-06 to 100 m"
    ):
        mr.from_toml(text=text.replace("80 mm", "800 m"))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mr.Actuator("a", (0, 1), 1, None, 0.5), "stiffness of the actuator = 0.5 N/m is outside"),
        (lambda: mr.Polyhedron.box((1, 1, 2e4)), "size = 20000 m is outside the valid range 0.001 to 10000 m"),
        (
            lambda: mr.Contacts.from_damping(mr.Block.from_size(0.5, 4), k_base=5e8, xi_base=-1),
            "xi_base = -1 is|xi = -1",
        ),
        (lambda: mr.PointSpectrum([0, 1], [1.0, -1.0]), "acceleration of the spectrum = -1 m/s2 is outside"),
        (lambda: mr.limit_curve(mr.Masonry.column(0.5, 2.0, 2), to=-1), "to = -1 m is outside the valid range 1e-06"),
        (lambda: mr.Masonry.box(("a", 1, 1)), "size = "),
    ],
)
def test_declared_ranges_are_checked_from_python(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()
