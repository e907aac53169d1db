"""How many files of the package a change touches: five of the six changes are carried out in a copy of it, and run.

The sixth, a number of a joint, stands in `test_number_of_a_joint.py`. The table of all six is in CONTRIBUTING.md.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import mjrock

ROOT = Path(mjrock.__file__).parents[1]

# A damper of oil through an orifice: it resists with C v |v| alone, in every solver that takes dampers.
DAMPER = {
    "problem/wall/effect.py": (
        ("    c: float = 0.0\n\n    @property", "    c: float = 0.0\n    square: float = 0.0\n\n    @property"),
        ('DASHPOT = ("c",)', 'DASHPOT = ("c", "square")'),
        ("    return law.c * rate\n", "    return law.c * rate + law.square * abs(rate) * rate\n"),
        ("    return law.c\n", "    return law.c + 2.0 * law.square\n"),
    ),
    "problem/wall/effects.py": (
        ("EFFECT_KINDS = (Tie, Load, Thrust, Damper,", "EFFECT_KINDS = (Tie, Load, Thrust, Damper, OilDamper,"),
        (
            "@dataclass(frozen=True, repr=False)\nclass FrictionDamper(Anchored):",
            '''@dataclass(frozen=True, repr=False)
class OilDamper(Anchored):
    """A damper of oil through an orifice: it resists both ways with C v |v|."""

    label: ClassVar[str] = "oil_damper"
    arguments: ClassVar[str] = "height, square, length"
    height: float
    square: Annotated[float, Within(0, 1e9, "N s2/m2")]
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: OfBlock | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    @property
    def law(self) -> LinkLaw:
        """A dashpot."""
        return LinkLaw(square=self.square)

    @property
    def description(self) -> str:
        """For sketches and reports."""
        return f"z = {self.height:g} m, C = {self.square:g} N s2/m2"


@dataclass(frozen=True, repr=False)
class FrictionDamper(Anchored):''',
        ),
    ),
    "__init__.py": (
        (
            "import AddedMass, Damper, FrictionDamper, Load, SideStop, Thrust",
            "import AddedMass, Damper, FrictionDamper, Load, OilDamper, SideStop, Thrust",
        ),
    ),
}
TRY_DAMPER = """
import numpy as np
from scipy.integrate import solve_ivp

ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True)
block = mr.Polygon([(-0.2, 0), (0.2, 0), (0.2, 0.4), (-0.2, 0.4)], density=1000.0, length=0.4)
masonry = mr.Masonry([ground, block], k_n=2e8, friction=0.0, frequency=150.0)
c, square, speed = 400.0, 600.0, 0.8
left = speed / (1 + square * speed * 0.1 / block.mass)
damper = mr.OilDamper(0.2, square, block=1)
case = mr.MasonryCase(masonry, 0.1, velocity=[[speed, 0, 0]], effects=damper)
for solver, options in ((mr.solve_explicit, {}), (mr.simulate, {"accuracy": 1e-5})):
    answer = solver(case, ledger=True, **options)
    assert abs(answer.velocity[-1, 0, 0] / left - 1) < 1e-3, (solver, answer.velocity[-1, 0, 0], left)
    taken = answer.ledger.dashpots["oil_damper_0"][-1]
    assert abs(abs(taken) / (0.5 * block.mass * (speed**2 - left**2)) - 1) < 1e-2, taken
strong = [mr.MasonryCase(masonry, 0.01, effects=kind(0.2, 1e6, block=1)) for kind in (mr.OilDamper, mr.Damper)]
steps = [0.01 / mr.solve_explicit(each).stats["steps"] for each in strong]
assert steps[0] < 0.8 * steps[1], steps
plain = mr.MasonryCase(masonry, 0.1, velocity=[[speed, 0, 0]], effects=mr.Damper(0.2, c, block=1))
assert abs(mr.solve_explicit(plain).velocity[-1, 0, 0] / (speed * np.exp(-c * 0.1 / block.mass)) - 1) < 1e-3
wall = mr.Block.from_size(0.6, 4.2)
contacts = mr.Contacts.from_damping(wall, k_base=5e8, xi_base=0.0)
held = mr.Case(wall, 0.5 * wall.alpha, 0.2, effects=mr.OilDamper(3.0, 1e6), side_stop=False)
found = mr.solve_compliant(held, contacts).theta[-1]
assert abs(mr.simulate(held, contacts).theta[-1] / found - 1) < 1e-4
assert abs(mr.solve_explicit(held, contacts).theta[-1] / found - 1) < 1e-4
refused(lambda: mr.simulate(held, contacts, timestep=1e-4), "oil_damper_0 has square = 1e+06 N s2/m2")
refused(lambda: mr.solve_analytical(held, mr.Restitution.from_geometry(wall)), "oil_damper_0 is none")
"""

# A format of records: fields that begin with #, then rows of time and three components in gal.
RECORDS = {
    "problem/ground/formats.py": (
        (
            "def seismograms(path: Path, unit: str | float | None) -> list[Trace]:\n",
            '''def parse_marked(lines: list[str]) -> list[Trace]:
    """The components of a file whose fields begin with #, before rows of time, U, N and E in gal."""
    fields = dict(re.findall(r"#(\\w+): *(\\S+)", "\\n".join(lines)))
    head = sum(line.startswith("#") for line in lines)
    values = samples(lines, head, 4 * int(fields["Samples"])).reshape(-1, 4)
    factor = ACCELERATION_UNITS["cm/s2"]
    return [
        Trace(factor * column, float(fields["Step"]), {"STATION_CODE": fields["Station"], "STREAM": stream})
        for stream, column in zip(("UD", "NS", "EW"), values[:, 1:].T, strict=True)
    ]


def seismograms(path: Path, unit: str | float | None) -> list[Trace]:
''',
        ),
        ('    Format("SMC",', '    Format("marked", re.compile(r"#Station:"), parse_marked),\n    Format("SMC",'),
    ),
}
TRY_RECORDS = """
with open("a.dat", "w") as file:
    file.write("#Station: XYZ\\n#Step: 0.01\\n#Samples: 3\\n")
    file.write("0.00 1 10 100\\n0.01 2 20 200\\n0.02 3 30 300\\n")
record = mr.GroundMotion.from_file("a.dat", "NS")
assert record.dt == 0.01
assert abs(record.accel - [0.1, 0.2, 0.3]).max() < 1e-15
"""

# A builder: a flat arch between two inclined abutments.
BUILDER = {
    "problem/masonry/builders/in_plane.py": (
        ('__all__ = ["arch",', '__all__ = ["arch", "flat_arch",'),
        (
            "@within_ranges\ndef running_bond(",
            '''@within_ranges
def flat_arch(span: Size, depth: Size, skew: SpanAngle = 0.35, voussoirs: Voussoirs = 9) -> list[Polygon]:
    """A flat arch over an opening, between two fixed abutments whose faces lean outwards."""
    below = np.linspace(-0.5 * span, 0.5 * span, voussoirs + 1)
    above = below * (1 + 2 * depth * math.tan(skew) / span)
    blocks = [
        Polygon([(a, 0.0), (b, 0.0), (d, depth), (c, depth)], name=f"voussoir_{i}")
        for i, ((a, b), (c, d)) in enumerate(zip(pairwise(below), pairwise(above), strict=True))
    ]
    for name, end, out in (("left", 0, -depth), ("right", -1, depth)):
        corners = [(below[end], 0.0), (above[end], depth), (above[end] + out, depth), (above[end] + out, 0.0)]
        blocks.append(Polygon(corners, fixed=True, name=name))
    return blocks


@within_ranges
def running_bond(''',
        ),
    ),
}
TRY_BUILDER = """
masonry = mr.Masonry.flat_arch(2.0, 0.5, k_n=1e9, friction=0.7)
assert masonry.blocks == tuple(mr.blocks.flat_arch(2.0, 0.5))
assert len(masonry.joints) == 10
answer = mr.solve_explicit(mr.MasonryCase(masonry, 0.01), forces=True)
weight = sum(masonry.blocks[i].mass for i in masonry.free) * mr.GRAVITY
borne = -sum(force[-1, 1] for force in answer.reactions.values())
assert abs(abs(borne) / weight - 1) < 1e-6, (borne, weight)
refused(lambda: mr.Masonry.flat_arch(2.0, 0.5, frction=1.0), "did you mean friction?")
text = "kind = 'MasonryCase'\\n[masonry]\\nmake = 'flat_arch'\\nspan = '200 cm'\\ndepth = 0.5\\n"
assert mr.from_toml(text=text).mechanisms[""].problem.masonry.blocks == masonry.blocks
"""

# A picture: the phase portrait of walls.
PICTURE = {
    "plotting/histories.py": (
        (
            "@picture(responses=listed(kind(Response)))\ndef energy(",
            '''@picture(responses=listed(kind(Response)))
def phase(ax: Axes, responses: Sequence[Response]) -> Axes:
    """Angular velocity over p alpha against rotation over alpha: the phase portrait of a wall."""
    for response in responses:
        wall = response.of_wall[0].wall
        ax.plot(response.theta / wall.alpha, response.omega / (wall.p * wall.alpha))
    ax.set(xlabel=r"rotation $\\theta/\\alpha$ [-]", ylabel=r"velocity $\\omega/(p\\alpha)$ [-]")
    return ax


@picture(responses=listed(kind(Response)))
def energy(''',
        ),
    ),
    "plotting/__init__.py": (
        (
            "from .histories import acceleration,",
            "from .histories import phase as phase\nfrom .histories import acceleration,",
        ),
        ('"energy",', '"energy", "phase",'),
    ),
}
TRY_PICTURE = """
from mjrock import plotting

wall = mr.Block.from_size(0.6, 4.2)
answer = mr.solve_analytical(mr.Case(wall, 0.5 * wall.alpha, 2.0), mr.Restitution.from_geometry(wall))
ax = plotting.phase([answer])
assert abs(ax.figure.axes[0].lines[0].get_xdata()[0] - 0.5) < 1e-12
refused(lambda: plotting.phase("x"), "responses")
"""

# A code for the check of mechanisms: the rule of a museum in docs/own_code.md, which is one file.
PAGE = (ROOT / "docs" / "own_code.md").read_text(encoding="utf-8")
CODE = {
    "study/loading/codes/museum.toml": ((None, re.search(r"<!-- museum.toml -->\n```toml\n(.*?)```", PAGE, re.S)[1]),)
}
TRY_CODE = """
statue = mr.Block.from_size(thickness=0.5, height=2.0, length=0.5, density=2600.0)
case, demand = mr.Case(statue, 0.0, 1.0, side_stop=False), mr.code_spectrum("EC8 type 1", ag=2.5, soil="B")
check = mr.mechanism_check(case, demand, code="Museum")
assert list(check.states) == ["stays"]
state = check.states["stays"]
assert abs(state.capacity / 0.125 - 1) < 1e-9
leans = math.asin(0.5 * math.sin(math.atan(0.25)))  # at half of d_0
assert abs(state.period / (2 * math.pi * math.sqrt(0.125 / (mr.GRAVITY * math.tan(leans)))) - 1) < 1e-5
mr.report(case, (), "report.html", checks=check)
with open("report.html") as file:
    assert "rule 2" in file.read()
"""

CHANGES = {
    "damper": (DAMPER, TRY_DAMPER, 3),
    "records": (RECORDS, TRY_RECORDS, 1),
    "builder": (BUILDER, TRY_BUILDER, 1),
    "picture": (PICTURE, TRY_PICTURE, 2),
    "code": (CODE, TRY_CODE, 1),
}
"""Edits by file, where None is for a new file, what tries them, and how many files there are."""
HEAD = """
import math
import warnings
import mjrock as mr

warnings.simplefilter("ignore")


def refused(call, text):
    try:
        call()
    except (TypeError, ValueError) as error:
        assert text in str(error), error
        return
    raise AssertionError(text)
"""


def copied(folder):
    """A copy of the package in a folder."""
    shutil.copytree(ROOT / "mjrock", folder / "mjrock", ignore=shutil.ignore_patterns("__pycache__"))
    return folder / "mjrock"


def run(folder, text):
    """Run a text with the copy of the package that lies in a folder, its loops as plain Python."""
    environment = os.environ | {"PYTHONPATH": str(folder), "NUMBA_DISABLE_JIT": "1", "MPLBACKEND": "agg"}
    command = [sys.executable, "-c", f"{HEAD}{text}\nprint('all hold', mr.__file__)"]
    return subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.slow
@pytest.mark.parametrize("name", CHANGES)
def test_a_change_touches_few_files(name, tmp_path):
    edits, attempt, count = CHANGES[name]
    package = copied(tmp_path)
    for file, pairs in edits.items():
        text = (package / file).read_text(encoding="utf-8") if (package / file).exists() else ""
        for old, new in pairs:
            assert old is None or text.count(old) == 1, (file, old)
            text = new if old is None else text.replace(old, new)
        (package / file).write_text(text, encoding="utf-8")
    done = run(tmp_path, attempt)
    assert done.stdout.startswith(f"all hold {package}"), done.stdout + done.stderr[-2000:]
    assert len(edits) == count
