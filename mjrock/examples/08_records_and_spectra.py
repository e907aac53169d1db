"""
8. Records, and the spectrum of a site
======================================

A check asks for records that fit the spectrum of the site. This example makes
four artificial records, scales each to a spectrum of NTC 2018, and runs the
wall under all of them. Records from files are used in the same way.
"""

# %%
# The spectrum of life safety on soil B. A record is scaled by one factor, so
# that its spectrum fits that of the site in the mean over the periods.
import numpy as np

import mjrock as mr
from mjrock import plotting

spectrum = mr.code_spectrum(
    "NTC 2018", ag=3.4, F0=2.45, Tc=0.33, soil="B"
)  # m/s2, -, s
periods = np.linspace(0.1, 2.0, 40)  # s
made = [
    mr.GroundMotion.synthetic(peak=3.0, duration=12.0, seed=seed)
    for seed in range(4)
]
scaled = [
    mr.scaled_to_spectrum(motion, periods, spectrum(periods)) for motion in made
]
for motion in scaled:
    print(
        f"{motion.name}: peak {motion.peak:.2f} m/s2, Arias intensity "
        f"{motion.arias_intensity:.2f} m/s"
    )
figure = plotting.spectra(scaled, periods, spectrum).figure

# %%
# The wall under each of them, by rocking theory. Rotations are shares of that
# which overturns the wall.
wall = mr.Block.from_size(thickness=0.5, height=6.0)  # m
e = mr.Restitution.from_geometry(wall)
answers = [
    mr.solve_analytical(mr.Case(wall, 0.0, 15.0, motion=motion), e)
    for motion in scaled
]
for answer in answers:
    print(
        f"{answer.case.motion.name}: {answer.outcome.value}, peak "
        f"{answer.peak_over_alpha:.2f} alpha"
    )
worst = max(answers, key=lambda answer: answer.peak_over_alpha)
figure = plotting.history(worst)
