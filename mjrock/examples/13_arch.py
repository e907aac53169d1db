"""
13. An arch under one pulse
===========================

Masonry of many blocks has no rocking theory to lean on. This arch of 11
voussoirs is shaken by one cycle of a sine. Two things are to be looked at:
where it opens, and how far that depends on the stiffness of its joints.
"""

# %%
# The arch has a radius of 5 m, a thickness of 0.75 m and 0.9 of a half circle.
# Joints are found where edges touch. A joint of two lines turns about its end
# lines, and k_n says how stiff they are.
import math

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import power_of_ten

pulse = mr.GroundMotion.sine(amplitude=4.0, period=0.6)  # m/s2, s
answers = {}
for k_n in (1e9, 1e10):  # N/m3
    arch = mr.Masonry.arch(
        5.0, 0.75, 0.9 * math.pi, voussoirs=11, k_n=k_n, friction=0.7
    )
    answers[k_n] = mr.simulate(mr.MasonryCase(arch, duration=1.2, motion=pulse))
    print(
        f"{k_n:.0e} N/m3: the widest joint opens by "
        f"{1e3 * answers[k_n].opening.max():.0f} mm"
    )


# %%
# The arch at the moment of its largest rotation, with all displacements five
# times as large.
def drawing(answer):
    """What draws one arch."""
    moment = abs(answer.theta).max(axis=1).argmax()
    return lambda ax: plotting.blocks(
        ax, answer.case.masonry, answer.pose[moment], magnified=5.0
    )


figure = plotting.panels(
    [
        (f"{power_of_ten(k_n)} N/m³", drawing(answer))
        for k_n, answer in answers.items()
    ]
)
