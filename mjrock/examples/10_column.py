"""
10. A column of drums under a pulse
===================================

A column of five drums may rock as one block, or open at any of its joints.
Which of both it does depends on the length of the pulse. The motion is solved
by explicit steps, in which every block moves by itself.
"""

# %%
# Drums are stacked from the base upwards. A joint has a stiffness, a friction
# and a damping ratio.
import mjrock as mr
from mjrock import plotting

drums = [mr.Block.from_size(thickness=0.8, height=1.0, length=0.8)] * 5  # m
column = mr.Masonry.stack(
    drums, joints=mr.Dry(k_n=2e9, friction=0.7, xi=0.05)
)  # N/m3
answers = {}
for period, amplitude in ((1.2, 2.3), (0.4, 9.0)):  # s, m/s2
    pulse = mr.GroundMotion.sine(amplitude, period)
    answers[period] = answer = mr.solve_explicit(
        mr.MasonryCase(column, 2.5, motion=pulse), output_step=0.01
    )
    widest = " ".join(f"{1e3 * opening:.0f}" for opening in answer.opening)
    print(
        f"one cycle of {period} s: joints open by {widest} mm, from the base "
        "upwards"
    )


# %%
# Each column as it leans most, with displacements twice as large.
def drawing(answer):
    """What draws one column."""
    moment = abs(answer.pose[:, :, 0]).max(axis=1).argmax()
    return lambda ax: plotting.blocks(
        ax, answer.case.masonry, answer.pose[moment], magnified=2.0
    )


figure = plotting.panels(
    [
        (f"cycle of {period} s", drawing(answer))
        for period, answer in answers.items()
    ]
)
