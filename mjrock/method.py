"""The constants of the method by which MuJoCo follows a scene, each with its reason. A study varies them by name."""

from __future__ import annotations

from typing import NamedTuple

from .contacts.solref import STIFF_DASHPOT


class Method(NamedTuple):
    """The constants of fitted steps, of friction, and of a base that holds.

    Args:
        short: (omega h)^2 of a short step over the accuracy, omega the highest contact frequency. Newmark's period
            error is (omega h)^2 / 24 for beta = 0 and less for beta = 1/12, which short steps use.
        most: omega h of a short step, however loose the accuracy: some eighteen steps in the shortest period [-].
        dashpot: (c h / m)^2 of a short step over the accuracy, m = 1 / (6 W) the least mass that a contact may feel,
            in space 1 / (7 W).
            The error of a dashpot centred in the step is (c h / m)^2 / 12.
        longest: (p h)^2 of the longest step over the accuracy, p the frequency parameter of the rocking.
        change: largest accepted (change of acceleration x step), as a multiple of accuracy x speed.
        faster: share of the present kinetic energy that changes are measured by, where it is more than the energy at
            the last touch [-]. A wall that falls from where it hardly moves would otherwise be followed ever more
            closely.
        stays: largest accepted movement of a loaded point in a step by the velocities alone, as a share of its
            penetration [-]. A point of a wall that turns at omega is moved by h^2/2 omega^2 times the height of the
            centroid. On a stiff base this lifts a toe that its weight presses in by micrometres, and friction at the
            toe is lost with it.
        loaded: a point counts as loaded from this share of its penetration at rest on [-]: an edge may lift off as it
            likes.
        stable: omega h of the longest step with a tie [-], omega as for `taut`: a tie may go taut unforeseen, and
            MuJoCo's explicit ties are stable up to 2.
        taut: (omega h)^2 of the longest step with a taut tie over the accuracy, omega the frequency of the bodies on it
            alone. MuJoCo integrates ties explicitly, and the energy of a bounce on one errs by about (omega h)^2 / 12.
        smooth: omega h below which a step resolves the contacts and takes Newmark's beta = 1/12 (stable below 2.45). A
            longer step takes a beta above 1/4, which is stable at every step. The closed contacts hardly move then.
        smooth_shaken: the same on moving ground, where walls rock by little more than their uplift rotation, and the
            ringing of longer steps would damp that [-].
        ringing_borne, ringing_open: extra dashpot h k r of a contact in a step that does not resolve it, with beta =
            (1 + r^2)/4 [-]: of a contact that bears weight at rest, and of one that is open at rest. beta above 1/4
            alone would let what is left of a vibration ring on from step to step. Where weight is borne, the dashpot
            takes a third of the energy of the vibration in a step, and next to nothing of the rocking. A contact that
            is open at rest, such as a side stop, carries only what has just hit it. What is too faint to be met with a
            short step has to die there, and not to be thrown back with more energy. Between several bodies a dashpot of
            the joint that already takes as much counts, because columns of flat blocks rock at frequencies at which the
            extra dashpot would be felt: it is only what the joint lacks in the longest step.
        faded: a touch is met with a short step where ignoring it would misplace more than this share of accuracy x
            energy [-].
        approach: largest share of the time to a touch that a step goes on moving ground [-].
        near: short steps before a touch within which it is met in one step [-]. The ground cannot change by much in
            them.
        abrupt: change of velocity in a step, over the speed that changes are measured by, beyond which no touch is
            predicted from it [-]. How a strong dashpot stops a body within a step or two says nothing of the next step.
        overdamped: c h W above which a dashpot acts on the velocity at the end of the step instead of the mean velocity
            [-]. The inverse mass that a contact of the wall feels is up to six times W. A centred dashpot leaves a
            quarter of the velocity there.
        resolved: the same of a wall's base in a step that resolves its contacts [-]. In free rocking an edge lands with
            a speed that a centred dashpot would leave a part of.
        borne: the same for a joint of several bodies that bears weight, and on moving ground for `resolved`: a
            resolving step centres its dashpot well [-]. It stays closed in long steps, and a dashpot at their end would
            damp small rocking to first order in the step.
        held_masses: inertia of a friction row in masses of the body that it holds [-]. A horizontal acceleration a
            creeps at a h / held_masses. It is no larger, because two edges that both hold rigidly do work against each
            other.
        held_growth: factor by which it grows over the step times the rocking frequency p of the scene, where there is
            no base that holds [-]. A joint under a sustained thrust creeps at F / (5e7 m p) at most, however long the
            step, m the mass of the blocks. The edge of a wall on a base that holds is put back instead, see
            `mjrock.engine.sticking`.
        slides: force that would stop the slip, over what friction can give, from which a contact is taken to slide [-].
        neglected: share of the normal force that the friction row of a contact that slides may add to it [-].
        looks: most looks at a step in which contacts slide.
        patient: looks in which a row is given back only once the friction is known.
        known: change of a friction force from look to look, over the largest of the step, that needs no further look
            [-].
        way_known: change of the direction of a friction force in space from look to look, times the force, over the
            largest of the step, that needs no further look [-].
        held_friction: friction coefficient of the outer edge of a wall that holds, with a side stop, on two lines [-].
            On a bed of n lines it is n/2 times that. This edge must not slip when the side impact pushes the hardly
            loaded base. On the paper's wall mu = 1 loses 13 % of |e_1s| and mu = 3 loses 2 %; from mu = 10 on nothing
            changes (`scripts/checks/friction.py`). The inner edge takes as much of it as `self_work` allows.
        free_friction: the same of both edges of a wall without a side stop [-]. It holds any wall in free rocking,
            whose base is pushed with at most (3/4) sin(2 alpha) / (2 - (3/2) sin(alpha)^2) of its load. It is no
            larger, because two edges that both stick while the wall turns over do work against each other. With mu = 30
            a wall of h/b = 15 on 5e7 N/m3 loses a third too much.
        self_work: most work that two sticking edges may do against each other in an impact, over the energy of a
            release at alpha/2 [-].
    """

    short: float = 24.0
    most: float = 0.35
    dashpot: float = 12.0
    longest: float = 0.6
    change: float = 2.0
    faster: float = 0.01
    stays: float = 0.1
    loaded: float = 0.5
    stable: float = 1.0
    taut: float = 12.0
    smooth: float = 1.5
    smooth_shaken: float = 2.2
    ringing_borne: float = 0.1
    ringing_open: float = 1.0
    faded: float = 0.01
    approach: float = 0.75
    near: float = 6.0
    abrupt: float = 0.1
    overdamped: float = STIFF_DASHPOT
    resolved: float = 0.2
    borne: float = 2.0
    held_masses: float = 1e3
    held_growth: float = 1e5
    slides: float = 2.0
    neglected: float = 1e-3
    looks: int = 6
    patient: int = 2
    known: float = 0.02
    way_known: float = 0.002
    held_friction: float = 30.0
    free_friction: float = 1.0
    self_work: float = 1e-4

    def on_moving_ground(self) -> Method:
        """The constants for a run whose ground moves."""
        return self._replace(smooth=self.smooth_shaken, resolved=self.borne)


METHOD = Method()
"""The constants that are used unless a study takes others."""
