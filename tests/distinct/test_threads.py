"""One run in several threads: the same bits for any number, and what ends a run ends it."""

import itertools
import multiprocessing
import os
import signal
import threading
from dataclasses import replace

import numpy as np
import own_laws
import own_links
import pytest

import mjrock as mr
from mjrock import machine
from mjrock.distinct import thread, thread_pool
from mjrock.distinct.rows import kinds
from mjrock.distinct.setup import setup_of
from mjrock.distinct.system import Books
from mjrock.distinct.thread import LINES_TOGETHER, pending_forces, spans_of, threads_of
from mjrock.rows import rows
from tests.cores import one_core

JOINTS = {"k_n": 1e9, "k_s": 4e8, "friction": 0.6, "xi": 0.05}
MORTAR = mr.BONDS["cement mortar, wall J4D"]
RECORD = mr.GroundMotion.synthetic(6.0, 1.0, seed=3)
WALL = (6.0, 2.8, (0.4, 0.2))

TIE_AND_JACK = (
    mr.Tie(height=2.7, stiffness=1e6, slack=1e-5, strength=1e4, block=210),
    mr.Actuator(217, (5.9, 2.7), 1, ([0.0, 1.0], [0.0, 0.1]), 1e6, damping=1e3),
)


def wall(duration=0.02, **joints):
    return mr.MasonryCase(mr.Masonry.running_bond(*WALL, **JOINTS | joints), duration, motion=RECORD)


def facade(duration=0.01, **joints):
    masonry = mr.Masonry.facade(2.0, 1.5, 1.0, (0.5, 0.25), **JOINTS | joints)
    return mr.MasonryCase(masonry, duration, motion=RECORD)


def same(case, threads, **options):
    """Answers that are equal to the last bit, with ledger and forces."""
    one, *others = (
        mr.solve_explicit(case, threads=count, ledger=True, forces=True, **options) for count in (1, *threads)
    )
    for count, other in zip(threads, others, strict=True):
        assert other.stats["threads"] == count
        np.testing.assert_array_equal(other.pose, one.pose)
        np.testing.assert_array_equal(other.energy, one.energy)
        np.testing.assert_array_equal(other.end.velocity, one.end.velocity)
        np.testing.assert_array_equal(other.forces.normal, one.forces.normal)
        np.testing.assert_array_equal(other.forces.shear, one.forces.shear)
        for name in ("friction", "ground", "elastic", "kinetic", "potential"):
            np.testing.assert_array_equal(getattr(other.ledger, name), getattr(one.ledger, name))
        for name in ("dashpots", "bonds", "ends", "ties", "actuators"):
            accounts = getattr(one.ledger, name)
            assert all((getattr(other.ledger, name)[each] == account).all() for each, account in accounts.items())
        assert other.outcome is one.outcome
    return one


def test_a_wall_has_the_same_bits_in_any_number_of_threads():
    answer = same(wall(0.004), (2, 3))
    assert len(setup_of(wall(), None, None).system.lines) > LINES_TOGETHER
    assert np.abs(answer.pose).max() > 0


def test_the_number_of_threads_is_a_whole_one():
    with pytest.raises(ValueError, match=r"threads = 0 .* 1 to 256"):
        mr.solve_explicit(wall(), threads=0)


def test_spans_end_with_joints_and_found_lines_follow():
    lines = rows(kinds(2).line, 3000, group=np.arange(3000) // 3, sense=1.0)
    lines["sense"][1700:], lines["group"][1700:] = 0.0, 900
    spans = spans_of(lines)
    assert spans[0] == 0
    assert spans[-1] == 3000
    assert 1700 in spans
    joints = spans[spans < 1700]
    assert (joints % 3 == 0).all()
    assert np.diff(joints).max() <= LINES_TOGETHER + 2
    assert np.diff(spans[spans >= 1700]).max() == LINES_TOGETHER
    assert spans_of(lines[:0]).tolist() == [0]


def test_forces_wait_where_two_threads_press_on_a_body():
    """Lines in a chain of bodies: those of the one body that both threads press on wait, in their order."""
    bodies, lines = rows(kinds(2).body, 6), rows(kinds(2).line, 5, sense=1.0)
    lines["body"], lines["face"] = np.arange(1, 6), np.arange(5)
    pending = pending_forces(bodies, lines, np.array([0, 2, 5]))
    assert pending["body"].tolist() == [-1, 2, 2]
    assert lines["pending"].tolist() == [0, 1, 0, 0, 0]
    assert lines["face_pending"].tolist() == [0, 0, 2, 0, 0]
    threads, alone = threads_of(bodies, lines, 1)
    assert len(alone) == 1
    assert not lines["pending"].any()
    assert threads[0].own_bodies == (0, 1)


def test_room_for_one_thread_takes_back_what_waits():
    """Lines of a run by two threads write outside of the room of one thread otherwise."""
    system = setup_of(wall(), None, None).system
    books, _ = Books.empty(system, len(system.lines)).of_threads(system, 2)
    assert system.lines["pending"].any()
    assert len(books.pending) > len(books.with_room(system).pending) == 1
    assert not system.lines["pending"].any()


def test_each_body_and_line_has_one_thread():
    system = setup_of(wall(), None, None).system
    threads, pending = threads_of(system.bodies, system.lines, 5)
    for name, spans in (("own_lines", threads[0].lines), ("own_bodies", threads[0].bodies)):
        parts = [getattr(thread, name) for thread in threads]
        assert parts[0][0] == 0
        assert parts[-1][1] == len(spans) - 1
        assert all(one[1] == other[0] for one, other in itertools.pairwise(parts))
    assert [threads[0].own_pending[0], threads[-1].own_pending[1]] == [1, len(pending)]


def test_small_runs_rigid_friction_and_workers_take_one_thread(monkeypatch):
    monkeypatch.setattr(thread_pool, "cores", lambda: 4)
    assert thread_pool.all_threads() == 4
    monkeypatch.setenv("NUMBA_NUM_THREADS", "3")
    assert thread_pool.all_threads() == 3
    monkeypatch.setattr(thread_pool, "parent_process", lambda: object())
    assert thread_pool.all_threads() == 1
    assert mr.solve_explicit(wall(0.002, k_s=None), threads=2).stats["threads"] == 1
    assert mr.solve_explicit(wall(0.002)).stats["threads"] == 1


def test_all_cores_are_those_of_affinity_and_quota(monkeypatch):
    assert 1 <= machine.cores() <= (os.cpu_count() or 1)
    monkeypatch.setattr(machine.Path, "read_text", lambda path: "150000 100000\n" if path.name == "cpu.max" else "-1")
    assert machine.cores() == min(2, os.cpu_count() or 1)


def test_a_run_goes_on_with_one_thread_where_no_more_can_be_started(monkeypatch):
    def refused(*given):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", refused)
    answer = mr.solve_explicit(wall(0.002), threads=2)
    assert answer.stats["threads"] == 1


def test_the_faster_number_of_threads_makes_the_steps():
    threads = thread_pool.ThreadPool(None)
    clock = thread_pool.Clock(h=1.0, steps_per_sample=1, stop=80, last=100, ground_acceleration_before=(0.0, 0.0))
    assert threads._choice((2, 1), clock) == (2, 80)
    threads._step_times[2] = 3.0
    assert threads._choice((2, 1), clock) == (1, 80)
    threads._step_times[1] = 2.0
    taken = [threads._choice((2, 1), clock) for _ in range(thread_pool.TRIED_AGAIN)]
    assert taken.count((1, 80)) == thread_pool.TRIED_AGAIN - 1
    assert taken.count((2, 10)) == 1


def test_two_runs_at_once_in_two_threads_of_python_do_not_meet():
    answers, one = {}, mr.solve_explicit(wall(0.002), threads=1)
    runs = [
        threading.Thread(target=lambda i=i: answers.update({i: mr.solve_explicit(wall(0.002), threads=2)}))
        for i in range(2)
    ]
    for run in runs:
        run.start()
    for run in runs:
        run.join()
    assert all((answers[i].pose == one.pose).all() for i in range(2))


def _pose_of_run(threads):
    return mr.solve_explicit(wall(0.002), threads=threads).pose[-1]


@pytest.mark.slow
@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_other_processes_run_in_threads_after_a_run_in_threads(method):
    here = _pose_of_run(2)
    with multiprocessing.get_context(method).Pool(2) as pool:
        for pose in pool.map(_pose_of_run, (1, 2)):
            np.testing.assert_array_equal(pose, here)


GLUE = own_laws.Cohesive(strength=2e4, toughness=1.0)
HELD = {"block": "unit_13_0", "at": (0.0, 2.7)}
OWN_LINKS = (
    mr.Link(own=own_links.Slider(k=1e6, slips_at=2e3), anchor=(-0.6, 2.9), **HELD),
    mr.Link(own=own_links.Relief(c=1e4, relief=2e3), anchor=(-0.6, 2.5), **HELD),
    mr.Damper(c=2e4, anchor=(-0.6, 2.7), **HELD),
)
MOVED = {"ground": ([0.0, 1.0], [0.0, 0.05], [0.0, 0.02])}


@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    [
        pytest.param(lambda: wall(0.05), id="dry"),
        pytest.param(lambda: wall(0.05, bond=MORTAR, points=3), id="mortar"),
        pytest.param(lambda: wall(0.05, bond=own_laws.Stiffening(a=2e-5)), id="own law"),
        pytest.param(lambda: wall(0.05, bond=GLUE, points=3), id="own law that remembers"),
        pytest.param(lambda: replace(wall(0.05), effects=TIE_AND_JACK), id="tie and jack"),
        pytest.param(lambda: replace(wall(0.05), effects=OWN_LINKS), id="own links and a damper"),
        pytest.param(lambda: replace(wall(0.05), supports=MOVED), id="support that moves"),
        pytest.param(lambda: facade(0.02), id="space"),
        pytest.param(lambda: facade(0.02, bond=MORTAR, points=3), id="space, mortar"),
        pytest.param(lambda: facade(0.02, bond=GLUE, points=3), id="space, own law that remembers"),
        pytest.param(lambda: replace(facade(0.02), motion=None, tilt=([0.0, 1.0], [0.0, 0.3])), id="space, tilted"),
    ],
)
def test_the_same_bits_in_any_number_of_threads(case):
    same(case(), (2, 4))


@pytest.mark.slow
def test_damped_motion_has_the_same_bits_in_any_number_of_threads():
    same(wall(0.05), (2, 4), mass_damping=5.0, local_damping=0.2)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:ground motion peaks")
def test_blocks_that_fall_have_the_same_bits_in_any_number_of_threads(monkeypatch):
    """Lines that are found have several spans, each with an account of its own."""
    monkeypatch.setattr(thread, "LINES_TOGETHER", 16)
    monkeypatch.setattr(thread, "BODIES_TOGETHER", 16)
    pushed = mr.GroundMotion([40.0, 40.0, -40.0, -40.0], 0.3)
    with one_core():
        answer = same(replace(wall(0.8, friction=0.2), motion=pushed), (2, 4), output_step=0.01)
    assert answer.fallen
    assert answer.ledger.dashpots["encounters"][-1] > 0


@pytest.mark.skipif(os.name == "nt", reason="Windows sends Ctrl-C to the whole console")
def test_ctrl_c_ends_a_run_in_several_threads_and_the_next_one_has_the_same_bits():
    """The run of a minute ends within one batch of steps, and no thread is left."""
    before = mr.solve_explicit(wall(0.004), threads=2)
    timer = threading.Timer(0.25, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        mr.solve_explicit(wall(60.0), threads=2)
    timer.join()
    assert [one.name for one in threading.enumerate() if one.name.startswith("mjrock")] == []
    np.testing.assert_array_equal(mr.solve_explicit(wall(0.004), threads=2).pose, before.pose)
