"""The response of a solver: the motion, the results of a wall or of joints, and how it ended."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..contacts.files import csv_text, write_text
from ..geometry.poses import angle_of, tilt_of
from ..notebook import NotebookPicture
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..problem.wall.rest_geometry import in_space
from ..quantities import Array, keep, require_path, require_within, shown
from .bodies import BodyMotion, bodies_of, frames_at, openings
from .ending import Outcome
from .files import comments_text, results_text, texts_of_bodies, texts_of_joints, write_gltf, write_series
from .forces import Forces
from .joint_motion import JointMotion
from .ledger import Ledger
from .motion import Motion, sample_at
from .origin import Origin
from .rocking import Impact, Rocking, largest_rotations, restitution_of
from .storage import read_answer, write_answer
from .ties import Plastic, TieMotion, motion_of_ties
from .variables import attributes_of, record_of, variables_of

if TYPE_CHECKING:
    import xarray

State = tuple[Array, Array]
"""Pose (x, z, theta) of each body as its displacement from rest [m, m, rad], and its velocity, shape (bodies, 3). In
space as the `pose` and `velocity` of a `Response`, shapes (bodies, 7) and (bodies, 6)."""


@dataclass(frozen=True, eq=False)
class End:
    """The end of a run, from which another one starts. It unpacks into pose and velocity.

    Args:
        pose, velocity: of each body [m and rad, m/s and rad/s], see `State`.
        memory: what explicit steps know beside them, so that a run carries on to rounding, or None.
    """

    pose: Array
    velocity: Array
    memory: object = None

    def __iter__(self) -> Iterator[Array]:
        return iter((self.pose, self.velocity))

    def __getitem__(self, part: int) -> Array:
        parts = self.pose, self.velocity
        return parts[part]


@dataclass(frozen=True, eq=False, repr=False)
class Response(NotebookPicture):
    """The motion that a solver found, of a wall or of masonry.

    A wall is one body. The bodies of masonry are its blocks that are not fixed, in order. What is read from the motion
    of a wall is in `rocking`, and of masonry in `joints`. Two responses are equal if they have the same case, solver,
    samples, outcome, and impacts or fallen blocks.

    Args:
        case: the problem.
        solver: which solver answered.
        t: times [s], shape (n,).
        motion: pose, velocity and energy of the bodies at these times.
        outcome: how the run ended. The outcome of masonry is overturned when a block has fallen.
        message: the same in words, for the user.
        rocking: impacts and peaks of a wall; None for masonry.
        joints: openings and slidings of joints, and fallen blocks; None for a wall.
        plastic: what ties have yielded, and when they broke, by tie.
        ledger: every part of the energy, or None without `ledger=True`.
        stats: what the run took: `steps`, `timestep` [s] or solver tolerances, `wall_time`, `processor_time` [s], and
            of the steps alone `stepping_time` and `stepping_processor_time` [s]. Solvers on compliant contacts add the
            `base_displacement` of a wall when the duration is over, and the deepest penetration of masonry, `deepest`
            [m]; MuJoCo has those of a wall, `deepest_base` and `deepest_side`.
        actuators: force of each actuator at the samples, by its name [N], shape (n,), positive where it pushes its
            block along its direction.
        end: pose and velocity at the end, to continue from with `simulate(..., start=...)`. None from other solvers.
        kept_forces: what `forces` and `reactions` give, or None without `forces=True`.
        origin: what the solver was given beside the case, and versions and processor, see `Origin`.
    """

    case: AnyCase
    solver: str
    t: Array
    motion: Motion
    outcome: Outcome
    message: str
    rocking: Rocking | None = None
    joints: JointMotion | None = None
    plastic: Mapping[str, Plastic] = field(default_factory=dict)
    ledger: Ledger | None = None
    stats: dict[str, Any] = field(default_factory=dict)
    actuators: Mapping[str, Array] = field(default_factory=dict)
    end: End | None = None
    kept_forces: Forces | None = None
    origin: Origin | None = None

    @property
    def pose(self) -> Array:
        """Displacement of each centroid from the undeformed contacts [m] and rotation [rad], shape (n, bodies, 3).

        In the plane x, z and theta. x points away from the side stop, z upwards, and theta is positive where a top
        turns towards +x. In space displacement x, y, z and unit quaternion of the rotation, w first, shape (n, bodies,
        7).
        """
        return self.motion.pose

    @property
    def velocity(self) -> Array:
        """Rate of the pose [m/s, m/s, rad/s], shape (n, bodies, 3).

        In space the velocity x, y, z [m/s], and the angular velocity in the axes of the body, which are those of the
        world at rest [rad/s], shape (n, bodies, 6).
        """
        return self.motion.velocity

    @property
    def energy(self) -> Array:
        """Kinetic, potential and, where contacts are compliant, elastic energy above rest [J], shape (n,)."""
        return self.motion.energy

    @property
    def moving(self) -> BodyMotion:
        """Where the bodies are at the samples."""
        return BodyMotion(self.case, self.t, self.pose)

    @property
    def in_space(self) -> bool:
        """Whether the bodies move in space."""
        return self.case.in_space

    @property
    def tilt(self) -> Array:
        """Angle between the axis of each body that was vertical at rest and the vertical [rad], shape (n, bodies)."""
        return tilt_of(self.pose) if self.in_space else np.abs(self.motion.theta)

    @property
    def theta(self) -> Array:
        """Rotation [rad], shape (n,) of a wall, and (n, bodies) of masonry.

        Raises:
            AttributeError: in space, where a rotation is a quaternion.
        """
        self._require_plane("theta")
        return self.motion.theta if self.rocking is None else self.motion.theta[:, 0]

    @property
    def omega(self) -> Array:
        """Angular velocity [rad/s], shape (n,) of a wall, and (n, bodies) of masonry.

        Raises:
            AttributeError: in space, where it has three components.
        """
        self._require_plane("omega")
        return self.velocity[:, :, 2] if self.rocking is None else self.velocity[:, 0, 2]

    @property
    def peak(self) -> Array:
        """Largest |rotation| of each body among the samples [rad], in space about any axis, shape (bodies,)."""
        angle = angle_of(self.pose) if self.in_space else np.abs(self.motion.theta)
        return np.asarray(angle.max(axis=0))

    def _require_plane(self, name: str) -> None:
        if self.in_space:
            raise AttributeError(
                f"a response in space has no {name}; its rotations are quaternions, pose[:, :, 3:], and its tilt and "
                "peak are angles"
            )

    @property
    def energy_residual(self) -> Array | None:
        """Closure error of the energy ledger [J], shape (n,), or None without `ledger=True`."""
        return None if self.ledger is None else self.ledger.residual

    @property
    def forces(self) -> Forces:
        """Forces of joints and links at the samples, see `Forces`.

        Raises:
            AttributeError: where the run was made without `forces=True`.
        """
        if self.kept_forces is None:
            raise AttributeError(
                "this run kept no forces; pass forces=True to solve_explicit or simulate, which keep those of joints, "
                "links and fixed blocks at every sample"
            )
        return self.kept_forces

    @property
    def reactions(self) -> Mapping[str, Array]:
        """Force on the masonry, or on the wall, by each fixed block, by its name [N], shape (n, 2), in space (n, 3).

        Along x and z, in space x, y and z. They sum to the weight at rest. What counts is described at `Forces`.

        Raises:
            AttributeError: where the run was made without `forces=True`.
        """
        return self.forces.reactions

    @cached_property
    def ties(self) -> Mapping[str, TieMotion]:
        """Elongation, force and energy of each tie at the samples, by its name, see `TieMotion`."""
        return motion_of_ties(self.moving, self.plastic)

    @property
    def of_wall(self) -> tuple[Case, Rocking]:
        """The case of a wall, and its impacts and peaks.

        Raises:
            AttributeError: for masonry.
        """
        if self.rocking is None:
            raise AttributeError(
                "a response of masonry has opening, sliding and fallen of its joints; impacts, peaks and restitution "
                "are those of one wall"
            )
        return cast(Case, self.case), self.rocking

    @property
    def of_masonry(self) -> MasonryCase:
        """The case of masonry.

        Raises:
            AttributeError: for a wall.
        """
        _ = self.of_joints
        return cast(MasonryCase, self.case)

    @property
    def of_joints(self) -> JointMotion:
        """The motion of joints and blocks.

        Raises:
            AttributeError: for a wall.
        """
        if self.joints is None:
            raise AttributeError("a response of one wall has impacts and peaks; it has no joints")
        return self.joints

    @property
    def impacts(self) -> tuple[Impact, ...]:
        """The impacts of a wall in order."""
        return self.of_wall[1].impacts

    @property
    def peaks(self) -> Array:
        """Rotation maxima |theta| of a wall [rad], the release first, shape (m,)."""
        return self.of_wall[1].peaks

    def displacement(self, z: float) -> Array:
        """Horizontal displacement of the middle of a wall at the height z, from rest, seen from the base [m], (n,)."""
        height = 2 * self.of_wall[0].wall.h * (1 + 1e-12)
        point = np.array([[0.0, require_within("height z", z, 0.0, height, "m")]])
        return self.moving.displaced(0, point)[:, 0, 0]

    def at(self, t: float | None = None) -> Array:
        """The pose of all blocks of masonry at a time, also of fixed ones that supports have moved.

        Args:
            t: time [s]; None is the last. The last sample up to it is taken.

        Returns:
            Displacement of the centroid of each block, without masses added to it, and its rotation as in `pose`, shape
            (blocks, 3), in space (blocks, 7), for `collapse_multiplier(..., pose=...)`.

        Raises:
            ValueError: for a time outside the run.
            AttributeError: for a wall.
        """
        centroids, moving = self.of_masonry.masonry.centroids, self.moving.at([sample_at(self.t, t)])
        places = [moving.displaced(i, centroid[None])[0, 0] for i, centroid in enumerate(centroids)]
        return np.hstack([places, moving.poses[0, :, centroids.shape[1] :]])

    @property
    def opening(self) -> Array:
        """Largest gap of each joint of masonry [m], shape (joints,)."""
        return self.of_joints.opening

    @property
    def crack_widths(self) -> Array:
        """Gap of each joint of masonry at its widest line [m], at every sample, shape (n, joints), 0 where all press.

        Of a mortared joint that has cracked it is the width of the crack.
        """
        return openings(self.of_masonry.masonry, bodies_of(self.moving, self.velocity))

    @property
    def sliding(self) -> Array:
        """Largest distance by which each joint has slid from rest, at its most pressed line [m], shape (joints,)."""
        return self.of_joints.sliding

    @property
    def fallen(self) -> Mapping[str, float]:
        """When each block that fell did [s], by its name, the earliest first, see `JointMotion`."""
        return self.of_joints.fallen

    @property
    def cracked(self) -> Mapping[str, float]:
        """When each mortared joint that cracked did [s], by its name, the earliest first, see `JointMotion`."""
        return self.of_joints.cracked

    @property
    def peak_over_alpha(self) -> float:
        """Largest rotation of a wall over alpha [-], over a low side stop too; infinite for one that has overturned."""
        return self._largest(self.of_wall[0].wall.alpha, self.of_wall[0].wall.alpha)

    @property
    def peak_over_overturning(self) -> float:
        """The same over `Case.overturning_rotation`, or inwards `Case.inward_limit`, which effects may lower [-]."""
        return self._largest(self.of_wall[0].overturning_rotation, self.of_wall[0].inward_limit)

    @property
    def inwards_over_alpha(self) -> float | None:
        """How far a wall leaned inwards over its side stop, over alpha [-]; None without a stop."""
        case, rocking = self.of_wall
        return largest_rotations(case, rocking, self.theta)[1] / case.wall.alpha if case.one_sided else None

    def _largest(self, outer: float, inner: float) -> float:
        """Largest rotation over a limit outwards and one inwards [rad], infinite for a wall that has overturned."""
        case, rocking = self.of_wall
        outwards, inwards = largest_rotations(case, rocking, self.theta)
        if self.outcome is Outcome.OVERTURNED:
            return math.inf
        return outwards / outer if case.stop_top == 2 * case.block.h else max(outwards / outer, inwards / inner)

    @property
    def restitution(self) -> Array:
        """|e| of each rebound of a wall, from successive peaks [-], see `Rocking.restitution`."""
        return self.of_wall[1].restitution(self.of_wall[0])

    @property
    def settled_restitution(self) -> Array:
        """|e| of each rebound, from the whole energy of the wall above its settled rest [-], shape (m - 1,).

        The energy at a rotation peak is potential and elastic. It differs from that of `restitution`, the rigid wall's
        above the undeformed base, by what the settled base gives back as the wall lifts off it: V - E is nearly the
        same at every peak. It counts for more the smaller the rebound is. Both are the same in rocking theory.

        Raises:
            ValueError: on a shaken base, where the ground does work between two peaks, and with ties.
        """
        case, rocking = self.of_wall
        if case.shaken or case.pulls:
            raise ValueError("on a shaken base the ground does work between two peaks, and ties may; see impacts")
        bounds = [0.0, *(impact.t for impact in rocking.impacts), float(self.t[-1])]
        energies = []
        for i in range(len(rocking.peaks)):
            first, last = np.searchsorted(self.t, bounds[i : i + 2])
            turn = first + int(np.argmax(np.abs(self.theta[first : last + 1])))
            released = i == 0 and rocking.peaks[0] == case.release_peak
            energies.append(self.energy[0] if released else self.energy[turn])
        return restitution_of(np.array(energies), np.array(energies))

    def csv(self, path: str | Path | None = None) -> str:
        """The samples as CSV text, one row each, written to `path` where one is given.

        The columns are t [s], theta [rad] and omega [rad/s] of a wall, energy [J], x, z and rotation of each body from
        rest [m, m, rad], in space x, y, z and the quaternion, the acceleration of the ground where there is one [m/s2],
        the force of each actuator [N], the accounts of a ledger where there is one [J], and forces where the run kept
        them: of each fixed block, joint and link [N], and eccentricities [m]. They are those of `Forces`. Mortared
        joints have their damage and the width of their crack too. No name has a comma:
        `np.genfromtxt(path, delimiter=",", names=True)` reads them. All digits are kept. Comments at the end, lines
        that begin with #, have the solver, versions, the processor, the case and the options; pandas skips them with
        comment="#".

        Raises:
            OSError: if the file cannot be written.
        """
        columns = {"t [s]": self.t}
        if self.rocking is not None:
            columns |= {"theta [rad]": self.theta, "omega [rad/s]": self.omega}
        columns["energy [J]"] = self.energy
        coordinates = [("x", "m"), ("z", "m"), ("rotation", "rad")]
        if self.in_space:
            coordinates = [*((axis, "m") for axis in "xyz"), *((f"quaternion {part}", "-") for part in "wxyz")]
        for i, body in enumerate(self.bodies):
            suffix = f" of {body}" if self.rocking is None else ""
            for j, (name, unit) in enumerate(coordinates):
                columns[f"{name}{suffix} [{unit}]"] = self.pose[:, i, j]
        for name, motion in self.case.grounds.items():
            columns[f"ground {'horizontal' if name == 'motion' else name} [m/s2]"] = motion(self.t)
        columns |= {f"force of {name} [N]": force for name, force in self.actuators.items()}
        if self.ledger is not None:
            columns |= self.ledger.columns()
        if self.kept_forces is not None:
            columns |= self.kept_forces.columns()
            bonded = np.flatnonzero(~np.isnan(self.kept_forces.damage[0]))
            widths = self.crack_widths[:, bonded] if bonded.size else np.empty((len(self.t), 0))
            for joint, width in zip(bonded, widths.T, strict=True):
                name = self.kept_forces.joints[joint]
                columns[f"damage of {name} [-]"] = self.kept_forces.damage[:, joint]
                columns[f"crack width of {name} [m]"] = width
        text = csv_text(list(columns), np.column_stack(list(columns.values())).tolist()) + comments_text(
            record_of(self)
        )
        if path is not None:
            write_text(require_path("path", path), text)
        return text

    def save(self, path: str | Path) -> Path:
        """Write all of it to a file of HDF5, from which `mjrock.load` reads it to the bit.

        Opened by h5py or xarray the file describes its content, see docs/results.md. It needs h5py, the extra
        `hdf5`.

        Args:
            path: where to, such as "run.h5". The file takes the place of an older one when it is whole.

        Returns:
            The path that was written.

        Raises:
            ImportError: without h5py.
            OSError: if the file cannot be written.

        Warns:
            UserWarning: of what no file can hold, such as a function for pairs of blocks; all else is kept. Functions
                of the joint are kept by what they gave for each joint.
        """
        return write_answer(self, path)

    def to_xarray(self) -> xarray.Dataset:
        """The arrays at the top of a saved file, with their dimensions, units and descriptions.

        Raises:
            ImportError: without xarray.
        """
        try:
            import xarray  # an extra
        except ImportError as error:
            raise ImportError(f"{error}; to_xarray needs it: pip install xarray") from None
        variables = {
            name: (variable.dims, variable.values, {"units": variable.units, "description": variable.text})
            for name, variable in variables_of(self).items()
        }
        return xarray.Dataset(variables, attrs=attributes_of(self))

    def to_gltf(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write the motion as glTF in one .glb, which Blender and viewers on the web open.

        Each block is a node of its name with its mesh, animated where it moves. Blocks of the plane are prisms of their
        length. A wall has no openings, and stands on a slab, beside another one where it has a side stop. y points
        upwards in the file, as it does in glTF. `asset.extras` has solver, versions, processor, case and options.

        Args:
            path: where to, a .glb.
            fps: most samples of a second that are kept [1/s], 1 to 10000. They are those of the response.

        Returns:
            The path that was written.

        Raises:
            ValueError: for another ending, or a value outside its range.
            OSError: if the file cannot be written.
        """
        frames = frames_at(self.t, fps)
        bodies = bodies_of(self.moving.at(frames), self.velocity[frames])
        return write_gltf(path, self.t[frames], bodies, record_of(self))

    def to_vtk(self, folder: str | Path, fps: float = 25.0) -> Path:
        """Write the motion as a series of files, which ParaView opens by `blocks.pvd`.

        Corners have their displacement [m] and velocity [m/s], and faces the number of their block, whether it is
        fixed, and its colour. With forces=True there is `joints.pvd` too: a point in the middle of each joint with the
        force on the block above and its normal part [N], and of masonry the largest gap at that time [m]. The field
        data `answer` of the first file of blocks is the UTF-8 of solver, versions, processor, case and options in JSON.

        Args:
            folder: where to; it is made where there is none.
            fps: most samples of a second that are kept [1/s], 1 to 10000. They are those of the response.

        Returns:
            The path of `blocks.pvd`.

        Raises:
            ValueError: for a value outside its range.
            OSError: if a file cannot be written.
        """
        frames = frames_at(self.t, fps)
        moving = self.moving.at(frames)
        t, bodies = moving.t, bodies_of(moving, self.velocity[frames])
        if self.kept_forces is not None:
            forces, d = self.kept_forces, 3 if self.in_space else 2
            middle, axes = moving.joints(forces.frames)
            normal, shear = forces.normal[frames], forces.shear[frames].reshape(*middle.shape[:2], d - 1)
            along = np.concatenate([normal[..., None], shear], axis=-1)
            values = {"force": in_space((along[..., None] * axes).sum(axis=-2)), "normal": normal}
            if self.joints is not None:
                values["opening"] = openings(self.of_masonry.masonry, bodies)
            write_series(folder, "joints", t, texts_of_joints(in_space(middle), values))
        return write_series(folder, "blocks", t, texts_of_bodies(bodies, record_of(self)))

    def to_compas(self, path: str | Path, at: float | None = None) -> Path:
        """Write the blocks in space at a time as `Results` of compas_dem, for its viewer and Rhino plug-in.

        They refer to the model that `masonry.to_compas` writes. Each block has its transformation. With forces=True
        each joint has its polygon, normal and tangential forces at its corners, which add up to its resultant where
        that acts, gaps and a status: noctc, stick or slide.

        Args:
            path: where to, a .json.
            at: time [s]; None is the last. The last sample up to it is taken.

        Returns:
            The path that was written.

        Raises:
            ValueError: for a wall, blocks in the plane or a `Compound`, or a time outside the run.
            OSError: if the file cannot be written.
        """
        if not self.in_space:
            raise ValueError(
                "a COMPAS model takes masonry in space; this response is of a wall, or of blocks in the plane, which "
                "Polyhedron.prism makes bodies"
            )
        case = self.of_masonry
        case.masonry.convex_in_space("a COMPAS model")
        k = sample_at(self.t, at)
        bodies = bodies_of(self.moving.at([k]), self.velocity[[k]])
        text = results_text(case, bodies, float(self.t[k]), self.kept_forces, k)
        return write_text(require_path("path", path), text)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the bodies, in their order."""
        return self.case.bodies

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Response):
            return NotImplemented
        names = ("case", "solver", "outcome", "rocking", "joints")
        samples = ("t", "pose", "velocity", "energy")
        return all(getattr(self, name) == getattr(other, name) for name in names) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in samples
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        if self.joints is None:
            peak_over_alpha = float(self.peak[0]) / self.of_wall[0].wall.alpha
            motion = f"{len(self.impacts)} impacts, largest rotation {peak_over_alpha:.3g} alpha"
        else:
            motion = f"largest opening {self.opening.max(initial=0):.3g} m, "
            motion += f"{len(self.fallen)} of {len(self.bodies)} blocks fallen"
        samples = f"{len(self.t)} samples over {self.t[-1]:.4g} s"
        return f"<Response of {self.solver}: {samples}, {motion}, {self.outcome.value}>"


MasonryResponse = Response
"""The response of masonry, which is like that of a wall."""


def recorded(response: Response, arguments: Mapping[str, Any]) -> Response:
    """A response that was just made, with the arguments of its solver, by their names, as its origin."""
    options = {name: value for name, value in arguments.items() if name not in ("case", "contacts", "e")}
    if isinstance(start := options.get("start"), End):
        options["start"] = replace(start, memory=None)
    keep(response, origin=Origin(arguments.get("contacts"), arguments.get("e"), options))
    return response


def load(path: str | Path, laws: Iterable[type] = ()) -> Response:
    """The response of a file of `Response.save`, to the bit, from whose `end` runs go on as from the one that was
    saved.

    Nothing in the file is executed or unpickled.

    Args:
        path: the file.
        laws: classes of your own that the case has, such as laws of joints: dataclasses and NamedTuples.

    Raises:
        TypeError: for a law that is not a class.
        ImportError: without h5py.
        OSError: if there is no such file.
        ValueError: for another file, a damaged one, one of a newer or older format, or a class that is not known.

    Warns:
        UserWarning: where the file has a memory of explicit steps that this version of mjrock does not read. All else
            is there, and a run goes on from pose and velocity.
    """
    if isinstance(laws, type):
        raise TypeError(f"laws = {shown(laws)} is one class; give a list of them, laws=[{laws.__name__}]")
    for law in (classes := tuple(laws)):
        if not isinstance(law, type):
            raise TypeError(f"laws has {shown(law)}, which is not a class; give its class")
    answer: Response = read_answer(path, classes)
    return answer
