"""What accuracy costs in time: error against wall time for every way of stepping a rocking wall.

Errors are those of the restitution per rebound (worst of the first four two-sided, two one-sided) and the RMS of
theta/alpha, the worst over several releases, so that no touch is met by luck; the reference is the contact law solved
by SciPy. Times are medians over repeats in this one process, a warm-up excluded. Writes work_precision.csv,
work_precision.png and prints the table, the ratios at equal error, and the shares of a run.
"""

from __future__ import annotations

import math
import os
import platform
import statistics
import sys
import time
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache, partial
from multiprocessing import get_context

import mujoco
import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock import machine, plotting
from mjrock.contacts.solref import WITHIN, inertia_of, pair_values
from mjrock.engine.model import Engine
from mjrock.engine.rows import inverse_weights
from mjrock.engine.stepping import fixed_steps
from mjrock.problem.damping.contacts import Uplift
from mjrock.result.ledger import StepError
from mjrock.result.response import Response
from mjrock.result.rocking import Rocking, RotationHistory, peak_energies, restitution_of, rocking_history
from mjrock.scene.wall import wall_course
from mjrock.theory.analytical import RigidMotion
from scripts.shared import accuracy, cli
from scripts.shared.paper import FIGURE_3, K_N

Solve = Callable[[mr.Case, mr.Contacts, bool], tuple[Response, float]]
"""Solves a case, with the energy ledger where asked and available; returns the response and the wall time [s]."""
LOOKS = {
    "fitted steps": plotting.STYLES["MuJoCo"] | {"label": "MuJoCo, fitted steps"},
    "fixed, beta 1/4": plotting.STYLES["MuJoCo"] | {"label": "MuJoCo, fixed steps", "linestyle": "--"},
    "contact law, SciPy": plotting.STYLES["compliant"],
    "rocking theory": plotting.STYLES["analytical"],
}
"""What the figure names; other ways to step are grey."""
TARGETS = {"two-sided": (5e-4, 2e-3), "one-sided": (5e-3, math.inf)}
"""Largest errors of the restitution and of RMS theta/alpha at which times are compared [-]."""


@dataclass(frozen=True)
class Point:
    """One setting of one method: what it costs, and how wrong it is."""

    case: str
    method: str
    setting: str
    steps: int
    seconds: float
    e_error: float
    rms: float
    residual: float


def simulated(
    options: dict[str, float], case: mr.Case, contacts: mr.Contacts, ledger: bool = False
) -> tuple[Response, float]:
    """`simulate` with the options given."""
    response = mr.simulate(case, contacts, ledger=ledger, **options)  # type: ignore[arg-type]
    return response, response.stats["wall_time"]


def our_steps(**options: float) -> Solve:
    """`simulate` with the options given."""
    return partial(simulated, options)


@cache
def without_numba() -> ProcessPoolExecutor:
    """A process in which nothing is compiled."""
    os.environ["NUMBA_DISABLE_JIT"] = "1"
    pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"))
    pool.submit(warnings.simplefilter, "ignore", UserWarning).result()
    del os.environ["NUMBA_DISABLE_JIT"]
    return pool


def plain_steps(**options: float) -> Solve:
    """`simulate` with its loops as plain Python, in a process of its own."""

    def solve(case: mr.Case, contacts: mr.Contacts, ledger: bool = False) -> tuple[Response, float]:
        return without_numba().submit(simulated, options, case, contacts, ledger).result()

    return solve


def stock(integrator: str, h: float, *, default_contacts: bool = False) -> Solve:
    """MuJoCo's own integrators on physical rows of the least inertia, or on MuJoCo's default contacts."""

    def solve(case: mr.Case, contacts: mr.Contacts, ledger: bool = False) -> tuple[Response, float]:
        started = time.perf_counter()
        scene = mr.wall_scene(case, contacts)
        engine = Engine.from_model(mujoco.MjModel.from_xml_string(mr.wall_mjcf(case, contacts, h)), scene)
        model = engine.model
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
        if default_contacts:
            model.pair_solref[:] = 0.02, 1.0
            model.pair_solimp[:] = 0.9, 0.95, 0.001, 0.5, 2.0
            model.pair_solreffriction[:] = 0
            model.opt.impratio = 1
        else:
            d = WITHIN[0]
            for i, (k, c, W) in enumerate(zip(scene.contacts.k, scene.contacts.c, inverse_weights(scene), strict=True)):
                model.pair_solref[i] = pair_values(k, c, inertia_of(d, W), W)[:2]
            model.pair_solimp[:, :2] = d
            held = model.pair_solreffriction[:, 1] < 0
            model.pair_solreffriction[held, 1] = -d / (2 * h)
            model.opt.impratio = 1e7
        course = wall_course(case, scene)
        engine.release(course)
        synchronised = integrator == "RK4"  # the others keep velocities half a step back, as our own steps do
        if synchronised:
            engine.data.qvel[:] = course.velocity.ravel()
        steps = fixed_steps(engine, scene, course, 0)
        seconds = time.perf_counter() - started
        omega = (steps.record.before if synchronised else steps.velocity)[:, 2]
        return _as_response(case, contacts, steps.t, steps.pose[:, 2], omega, len(steps.t)), seconds

    return solve


def free_wall(h: float) -> Solve:
    """The wall with all six degrees of freedom, every contact line carried at its two ends."""

    def solve(case: mr.Case, contacts: mr.Contacts, ledger: bool = False) -> tuple[Response, float]:
        started = time.perf_counter()
        wall = case.block
        root = ET.fromstring(mr.wall_mjcf(case, contacts, h))
        body = root.find("worldbody/body")
        assert body is not None
        for joint in body.findall("joint"):
            body.remove(joint)
        body.insert(0, ET.Element("freejoint", name="free"))
        pairs = root.find("contact")
        assert pairs is not None
        for geom in [g for g in body.findall("geom") if g.get("type") == "sphere"]:
            pair = next(p for p in pairs if p.get("name") == geom.get("name"))
            face = contacts.base if geom.get("name", "").startswith("base") else contacts.side
            assert face is not None
            i = int(geom.get("name", "_0").split("_")[1])
            row = mr.contact_parameters(
                face.stiffness[i] / 2, face.damping[i] / 2, timestep=h, inverse_weight=1 / wall.mass
            )
            pair.set("solref", " ".join(repr(float(v)) for v in row.solref))
            pair.set("solimp", " ".join(repr(float(v)) for v in row.solimp))
            x, _, z = geom.get("pos", "").split()
            geom.set("pos", f"{x} {-wall.length / 2!r} {z}")
            twin = ET.fromstring(ET.tostring(geom))
            twin.set("pos", f"{x} {wall.length / 2!r} {z}")
            twin.set("name", f"{geom.get('name')}_far")
            body.append(twin)
            copy = ET.fromstring(ET.tostring(pair))
            copy.set("name", f"{pair.get('name')}_far")
            copy.set("geom1", f"{pair.get('geom1')}_far")
            pairs.append(copy)
        key = root.find("keyframe/key")
        assert key is not None
        across, up, theta = map(float, key.get("qpos", "").split())
        up += wall.h + mr.wall_scene(case, contacts).radius
        pose = (across, 0.0, up, math.cos(theta / 2), 0.0, math.sin(theta / 2), 0.0)
        key.set("qpos", " ".join(map(repr, pose)))
        key.set("qvel", "0 0 0 0 0 0")
        model = mujoco.MjModel.from_xml_string(ET.tostring(root, encoding="unicode"))
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        for _ in range(10):
            mujoco.mj_forward(model, data)
            data.qvel[:] = -0.5 * h * data.qacc
        count = round(case.duration / h)
        theta_t, omega_t = np.empty(count), np.empty(count)
        for n in range(count):
            theta_t[n] = 2 * math.atan2(data.qpos[5], data.qpos[3])
            before = data.qvel[4]
            mujoco.mj_step(model, data)
            omega_t[n] = 0.5 * (before + data.qvel[4])
        seconds = time.perf_counter() - started
        t = h * np.arange(count)
        return _as_response(case, contacts, t, theta_t, omega_t, count), seconds

    return solve


def scipy_law(rtol: float) -> Solve:
    """`solve_compliant` at a tolerance."""

    def solve(case: mr.Case, contacts: mr.Contacts, ledger: bool = False) -> tuple[Response, float]:
        response = mr.solve_compliant(case, contacts, rtol=rtol, atol=1e-2 * rtol)
        return response, response.stats["wall_time"]

    return solve


def _as_response(case: mr.Case, contacts: mr.Contacts, t, theta, omega, steps: int) -> Response:  # type: ignore[no-untyped-def]
    _, peaks, impacts = rocking_history(
        case, RotationHistory(t, theta, omega, 0 * t), Uplift(contacts.uplift_rotation(case.block), 0.0)
    )
    return Response(
        *(case, "stock", t, RigidMotion(case, theta, omega, 0.0), mr.Outcome.TIME_ENDED, ""),
        rocking=Rocking(impacts, peaks),
        stats={"steps": steps},
    )


def measure(
    label: str,
    method: str,
    setting: str,
    solve: Solve,
    references: Sequence[tuple[Response, mr.Contacts]],
    repeats: int,
) -> Point:
    """Error over all references, median time of the first."""
    rebounds = 2 if references[0][0].of_wall[0].side_stop else 4
    e_errors, rms, residuals, steps = [], [], [], 0
    for reference, contacts in references:
        try:
            response, _ = solve(reference.of_wall[0], contacts, True)
        except (mr.SimulationError, StepError):
            return Point(label, method, setting, 0, math.nan, math.nan, math.nan, math.nan)
        steps = response.stats.get("steps", response.stats.get("evaluations", 0))
        wanted = restitution_of(*peak_energies(reference.of_wall[0], reference.peaks))[:rebounds]
        found = np.append(response.restitution, np.full(rebounds, np.nan))[: len(wanted)]
        e_errors.append(float(np.max(np.abs(np.nan_to_num(found / wanted - 1, nan=1.0)))))
        rms.append(mr.compare(reference, response).rms)
        residual = response.energy_residual
        if residual is not None:
            residuals.append(float(np.abs(residual).max()) / reference.of_wall[0].release_energy)
    case, contacts = references[0][0].of_wall[0], references[0][1]
    seconds = [solve(case, contacts, False)[1]]
    seconds += [solve(case, contacts, False)[1] for _ in range(repeats - 1) if seconds[0] < 1]
    errors = max(e_errors), max(rms), max(residuals, default=math.nan)
    return Point(label, method, setting, steps, statistics.median(seconds), *errors)


def methods(quick: bool) -> dict[str, dict[str, Solve]]:
    """Every method with its settings."""
    ladder = (1e-3,) if quick else (2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5)
    short = ladder[:1] if quick else ladder[1:5]
    knobs = (1e-3,) if quick else (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6)
    made: dict[str, dict[str, Solve]] = {
        "fitted steps": {f"accuracy {a:g}": our_steps(accuracy=a) for a in knobs},
        "fitted, loop not compiled": {f"accuracy {a:g}": plain_steps(accuracy=a) for a in knobs[1:5:2] or knobs},
        **{
            f"fixed, {name}": {f"{h * 1e3:g} ms": our_steps(timestep=h, newmark_beta=beta) for h in ladder}
            for name, beta in (("beta 0", 0.0), ("beta 1/12", 1 / 12), ("beta 1/4", 0.25), ("beta 1", 1.0))
        },
        "Euler, default contacts": {f"{h * 1e3:g} ms": stock("euler", h, default_contacts=True) for h in short},
        **{name: {f"{h * 1e3:g} ms": stock(name, h) for h in short} for name in ("implicitfast", "RK4")},
        "discrete": {f"{h * 1e3:g} ms": stock("discrete", h) for h in (ladder if quick else (*ladder, 5e-6))},
        "free wall, 6 dof": {f"{h * 1e3:g} ms": free_wall(h) for h in short},
        "contact law, SciPy": {f"rtol {r:g}": scipy_law(r) for r in ((1e-6,) if quick else (1e-4, 1e-6, 1e-8))},
    }
    return made


def theory(label: str, side_stop: bool, repeats: int) -> list[Point]:
    """`solve_analytical` at several tolerances, against the restitution that it is given and its tightest answer."""
    e = mr.Restitution.from_geometry(FIGURE_3.alpha)
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 2.0 if side_stop else 6.0, side_stop=side_stop)
    exact = mr.solve_analytical(case, e, rtol=1e-13)
    wanted, rebounds = (abs(e.lumped), 2) if side_stop else (e.base, 4)
    found = []
    for rtol in (1e-4, 1e-7, 1e-10):
        runs = [mr.solve_analytical(case, e, rtol=rtol) for _ in range(repeats)]
        error = float(np.abs(runs[0].restitution[:rebounds] / wanted - 1).max())
        seconds = statistics.median(run.stats["wall_time"] for run in runs)
        rms = mr.compare(exact, runs[0]).rms
        evaluations = runs[0].stats["evaluations"]
        found.append(Point(label, "rocking theory", f"rtol {rtol:g}", evaluations, seconds, error, rms, math.nan))
    return found


def references(side_stop: bool, quick: bool, points: int = 2) -> list[tuple[Response, mr.Contacts]]:
    """The contact law solved tightly for several releases of the Figure 3 wall."""
    e = mr.Restitution.from_geometry(FIGURE_3.alpha)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N, law="PUBLISHED", points=points)
    releases = (0.5,) if quick else (0.5, 0.43, 0.47, 0.53, 0.57)
    duration = 2.0 if side_stop else 6.0
    return [
        (
            mr.solve_compliant(
                mr.Case(FIGURE_3, s * FIGURE_3.alpha, duration, side_stop=side_stop), contacts, rtol=1e-10
            ),
            contacts,
        )
        for s in releases
    ]


def fastest(points: Sequence[Point], methods: Sequence[str], targets: tuple[float, float]) -> Point | None:
    """The cheapest setting of some methods that stays within the targets."""
    fine = [p for p in points if p.method in methods and p.e_error <= targets[0] and p.rms <= targets[1]]
    return min(fine, key=lambda p: p.seconds, default=None)


def table_1_walls(count: int) -> list[tuple[mr.Case, mr.Contacts]]:
    """Walls drawn from the ranges of the paper's Table 1, alternately two-sided and one-sided."""
    rng = np.random.default_rng(2026)
    drawn = []
    for i in range(count):
        slenderness, R = rng.uniform(4, 15), rng.uniform(1.4, 2.8)
        k_base, k_side = np.exp(rng.uniform(math.log(0.5e8), math.log(30e8), 2)).tolist()
        wall = mr.Block.from_slenderness(slenderness, R)
        e = mr.Restitution.from_geometry(wall.alpha)
        contacts = mr.Contacts.from_law(wall, e, k_base=k_base, k_side=k_side, law="PUBLISHED")
        drawn.append((mr.Case(wall, rng.uniform(0.3, 0.8) * wall.alpha, 3.0, side_stop=i % 2 == 1), contacts))
    return drawn


def walls_study(count: int) -> str:
    """The default knob on walls of Table 1 against the fixed step of equal error, and which exceed its tolerance."""
    ratios, outside = [], []
    for case, contacts in tqdm(table_1_walls(count), desc="walls of Table 1", disable=None, leave=False):
        exact = mr.simulate(case, contacts, accuracy=1e-6)

        def error(run: Response, exact: Response = exact) -> float:
            pairs = [(i.energy_after, j.energy_after) for i, j in zip(exact.impacts[:2], run.impacts[:2], strict=False)]
            released: float = exact.of_wall[0].release_energy
            if len(run.impacts) < min(2, len(exact.impacts)):
                return 1.0
            return max([abs(a - b) / released for a, b in pairs] + [mr.compare(exact, run).rms])

        fitted = mr.simulate(case, contacts)
        seconds = statistics.median(mr.simulate(case, contacts).stats["wall_time"] for _ in range(3))
        reached = error(fitted)
        if reached > 1e-3:
            wall = case.block
            outside.append(
                f"{'one' if case.side_stop else 'two'}-sided, h/b {wall.slenderness:.1f}, "
                f"k_base {contacts.base.k_n:.2g}, k_side {contacts.side.k_n if contacts.side else 0:.2g} N/m3: "
                f"{reached:.1e}"
            )
        for h in (2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6):
            try:
                run = mr.simulate(case, contacts, h)
            except mr.SimulationError:
                continue  # a step so long that it makes energy
            if error(run) <= max(reached, 1e-3):
                break
        ratios.append(seconds / run.stats["wall_time"])
    inside = count - len(outside)
    text = (
        f"{count} walls of Table 1, default accuracy: errors of the energy after the first two impacts and of "
        f"theta/alpha within 1e-3 on {inside}; median time {statistics.median(ratios):.3f} of the fixed step of equal "
        "error"
    )
    return "\n".join([text, *(f"  outside: {line}" for line in outside)])


def profile() -> str:
    """Where the time of a run goes, and how far it is from the bare engine."""
    lines = []
    e = mr.Restitution.from_geometry(FIGURE_3.alpha)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N, law="PUBLISHED")
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 60.0, side_stop=False)
    for _ in range(3):  # the last counts
        whole = cli.seconds(lambda: mr.simulate(case, contacts, 1e-3, output_step=1e-3))
        bare = bare_engine(case, contacts, 1e-3, 60_000)
    lines.append(
        f"fixed 1 ms, 60 s: {60 / whole:.0f} times real time, {whole / bare:.2f} times mj_step(model, data, n) with "
        f"nothing recorded: recording and evaluation {(whole - bare) / whole:.0%} of the run"
    )
    one = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 6.0, side_stop=False)
    runs = [mr.simulate(one, contacts) for _ in range(20)]
    whole, stepping = (statistics.median(run.stats[name] for run in runs) for name in ("wall_time", "stepping_time"))
    steps, scene = runs[0].stats["steps"], mr.wall_scene(one, contacts)
    engine = statistics.median(bare_engine(one, contacts, runs[0].stats["timestep"], steps) for _ in range(20))
    compiling = [cli.seconds(lambda: Engine.compile(scene)) for _ in range(20)]
    lines.append(
        f"fitted, 6 s: {whole * 1e3:.1f} ms for {steps} steps, of which the engine's steps {engine / whole:.0%}, the "
        f"rest of the loop {(stepping - engine) / whole:.0%}, scene, release, evaluation and output "
        f"{(whole - stepping) / whole:.0%}; text and compilation, once for a wall, "
        f"{statistics.median(compiling) * 1e3:.1f} ms"
    )
    return "\n".join(lines)


def bare_engine(case: mr.Case, contacts: mr.Contacts, timestep: float, steps: int) -> float:
    """Seconds of as many of the engine's own steps, with nothing recorded."""
    model = mujoco.MjModel.from_xml_string(mr.wall_mjcf(case, contacts, timestep))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return cli.seconds(lambda: mujoco.mj_step(model, data, steps))


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "work_precision").parse_args(argv)
    out = cli.folder(args.out)
    points: list[Point] = []
    repeats = 1 if args.quick else 5
    warnings.simplefilter("ignore", UserWarning)  # steps that do not resolve the contacts are part of the study
    for label, side_stop in (("two-sided", False), ("one-sided", True)):
        made = references(side_stop, args.quick)
        todo = [(m, s, solve) for m, settings in methods(args.quick).items() for s, solve in settings.items()]
        for method, setting, solve in tqdm(todo, desc=label, disable=None, leave=False):
            points.append(measure(label, method, setting, solve, made, repeats))
        points += theory(label, side_stop, repeats)
    for lines in () if args.quick else (4, 8, 16, 32):
        for label, side_stop in (("two-sided", False), ("one-sided", True)):
            made = references(side_stop, True, lines)
            for name, solve in (
                ("fitted", our_steps(accuracy=1e-3)),
                ("fixed 0.1 ms", our_steps(timestep=1e-4)),
            ):
                points.append(measure(label, f"{name}, {lines} lines", "", solve, made, repeats))

    header = ["case", "method", "setting", "steps", "time [ms]", "error of e", "RMS theta/alpha", "ledger residual"]
    rows = [
        [p.case, p.method, p.setting, p.steps, f"{p.seconds * 1e3:.2f}"]
        + [f"{error:.1e}" for error in (p.e_error, p.rms, p.residual)]
        for p in points
    ]
    plotting.save(
        accuracy.work_precision([(p.case, p.method, p.seconds, p.e_error) for p in points if p.e_error < 1], LOOKS),
        out / "work_precision.png",
    )
    lines_out = [
        cli.table(header, rows),
        "",
        f"machine: {platform.machine()}, {machine.cores()} cores, MuJoCo {mujoco.__version__}",
    ]
    fixed = [m for m in {p.method for p in points} if m.startswith("fixed, ")]
    for label in TARGETS:
        of_case = [p for p in points if p.case == label]
        default = next(p for p in of_case if p.method == "fitted steps" and p.setting == "accuracy 0.001")
        for name, group in (("the fastest fixed Euler step", fixed), ("discrete", ["discrete"])):
            best = fastest(of_case, group, TARGETS[label])
            slowest = max(
                (p.seconds for p in of_case if p.method in group and p.seconds == p.seconds), default=math.nan
            )
            ratio = (
                f"{default.seconds / best.seconds:.3f} of {name} ({best.setting})"
                if best
                else (f"under {default.seconds / slowest:.3f} of {name}, which does not get there at its smallest step")
            )
            lines_out.append(
                f"{label}: the default (error of e {default.e_error:.1e}, RMS {default.rms:.1e}) takes {ratio} "
                "at equal error"
            )
    lines_out.append(walls_study(1 if args.quick else 30))
    if not args.quick:
        lines_out.append(profile())
    cli.report(out / "work_precision", "\n".join(lines_out), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
