"""
A church façade, from a recorded motion to a report
===================================================

A façade of 12 m with a portal and a rose window has come loose. The vault behind it pushes it outwards, and two steel
bars hold it. Does it stand a recorded motion, what are the bars worth, and what goes into the file of the building?
"""

# %%
# The record is an AT2 file of the PEER NGA data base: name yours here. So that this script runs as it is, it writes an
# artificial motion in that format first.
import math
from pathlib import Path
from tempfile import mkdtemp

import mjrock as mr
from mjrock import plotting

folder = Path(mkdtemp())
at2 = folder / "record.AT2"
made = mr.GroundMotion.synthetic(peak=3.0, duration=12.0, seed=102, ground_frequency=1.2)
head = f"PEER NGA\nartificial\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {len(made.accel)}, DT= {made.dt} SEC\n"
at2.write_text(head + "".join(f"{a / mr.GRAVITY:.8E}\n" for a in made.accel))
record = mr.GroundMotion.from_at2(at2)
print(f"peak {record.peak / mr.GRAVITY:.2f} g, {record.duration:g} s")

# %%
# The wall: 0.9 m thick at its foot and 0.7 m at its top, of rubble of 1900 kg/m3. Openings are rectangles; a round one
# is the square of the same area. The side walls reach up to 9 m.
portal = mr.Opening(width=2.6, height=4.0)  # m
side = 2.4 * math.sqrt(math.pi / 4)
rose = mr.Opening(width=side, height=side, sill=7.2 - side / 2)
taper = [(0.0, 0.9), (12.0, 0.7)]
wall = mr.Block.from_size(0.9, 12.0, 10.0, 1900.0, openings=[portal, rose], profile=taper)
stop = mr.SideStop(top=9.0)
e = mr.Restitution.from_geometry(wall, stop_top=9.0)
contacts = mr.matched_contacts(wall, e, k_base=1e9, k_side=1e9, side_stop=stop)  # N/m3
print(f"{wall.mass / 1e3:.0f} t, alpha = {wall.alpha:.4f} rad, e_1s = {e.lumped:.2f}")

# %%
# The vault, and two bars whose anchor plates follow 30 mm and are then pulled through.
vault = mr.Thrust(height=10.5, force=12e3)  # m, N
bar = mr.Tie(height=10.0, stiffness=12e6, slack=0.003, strength=80e3, length=8.0, ultimate=0.03)
around = {"side_stop": stop, "effects": (vault, bar, bar)}
tied = mr.Case(wall, 0.0, 15.0, motion=record, **around)
figure = plotting.sketch(tied)

# %%
# A wall that opens to one side takes a record and its mirror image as two earthquakes: both, with the bars and without.
answers, names = [], []
for motion, polarity in zip(record.polarities, ("as recorded", "reversed"), strict=True):
    for effects, name in (((vault, bar, bar), "with bars"), ((vault,), "without")):
        case = mr.Case(wall, 0.0, 15.0, side_stop=stop, motion=motion, effects=effects)
        answers.append(mr.simulate(case, contacts))
        names.append(f"{name}, {polarity}")
        print(f"{names[-1]}: {answers[-1].outcome.value}, peak {answers[-1].peak_over_alpha:.2f} alpha")
figure = plotting.history(answers[2:], labels=names[2:])

# %%
# The report: one page with the sketch, the inputs and what they rest on, what to be careful of, histories and tables.
# It opens in any browser and prints to PDF. `k_base` is the input that is known least: run both ends of its range.
path = mr.report(
    tied,
    answers,
    folder / "facade.html",
    title="Church façade, out of plane",
    labels=names,
    e=e,
    contacts=contacts,
    basis={"density": "three cores", "k_base": "E of the mortar 800 MPa over 30 mm, and of rubble over its height"},
    notes="Does the façade stand a recorded motion, and what are the two bars worth?",
)
print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB")
