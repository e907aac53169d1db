"""Bars of what takes long: two decimals of seconds, nothing before they are worth it, and widgets in notebooks."""

import _thread
import contextlib
import io
import sys
import threading
import time
import types
import warnings

import pytest
import scipy

import mjrock as mr
from mjrock import bars


class Terminal(io.StringIO):
    def isatty(self):
        return True


def screen_and_clock(monkeypatch):
    """What a terminal is told, and the time [s], a list of one that is turned by hand."""
    now, screen = [1000.0], Terminal()
    monkeypatch.setattr(sys, "stderr", screen)  # within the test: capturing sets it before
    for clock in ("mjrock.bars.time.time", "tqdm.std.time"):
        monkeypatch.setattr(clock, lambda: now[0])
    return screen, now


@pytest.mark.parametrize(
    ("unit", "total", "line"),
    [
        ("s", 13.0, "MuJoCo:  38%|{bar}| 5.00 of 13 s [00:04<00:06]"),
        ("frames", 12, "MuJoCo:  42%|{bar}| 5 of 12 frames [00:04<00:05]"),
        ("runs", None, "MuJoCo: 5 runs [00:04]"),
    ],
)
def test_a_bar_says_how_much_of_what_with_its_unit(monkeypatch, unit, total, line):
    """Of 5.000000000000001: 13 s at 5 s in 4 s of the clock leave 4 * 8 / 5 = 6 s."""
    screen, now = screen_and_clock(monkeypatch)
    with bars.Bar("MuJoCo", unit, total) as bar:
        now[0] = 1002.9
        bar.to(3.0)
        assert screen.getvalue() == ""
        now[0] = 1004.0
        bar.to(5.000000000000001)
        *_, last = screen.getvalue().split("\r")
    before, _, after = line.partition("{bar}")
    assert last.startswith(before)
    assert last.endswith(after)


def test_a_bar_within_another_leaves_no_line(monkeypatch):
    screen, now = screen_and_clock(monkeypatch)
    with bars.Bar("push", "pieces") as outer:
        now[0] += 4
        outer.add()
        with bars.Bar("explicit steps", "s", 1.0) as inner:
            now[0] += 4
            inner.to(1.0)
        outer.add()
    *_, left = screen.getvalue().rstrip("\n").split("\n")
    assert "push: 2 pieces" in left
    assert "explicit" not in left


@pytest.mark.parametrize(("error", "left"), [(None, "100%"), (ValueError, " 38%")])
def test_a_run_that_ends_before_its_time_is_whole_and_one_that_fails_is_not(monkeypatch, error, left):
    screen, now = screen_and_clock(monkeypatch)
    with contextlib.suppress(ValueError), bars.Bar("MuJoCo", "s", 13.0) as bar:
        now[0] = 1004.0
        bar.to(5.0)
        if error is not None:
            raise error
    *_, last = screen.getvalue().strip("\n").split("\r")
    assert last.startswith(f"MuJoCo: {left}|")


def test_values_are_counted(monkeypatch):
    screen, now = screen_and_clock(monkeypatch)
    for value in bars.counted(range(8), "arch.gif", "frames"):
        now[0] += 1 + value
    assert "8 of 8 frames" in screen.getvalue()


@pytest.mark.parametrize("widgets", [True, False])
def test_a_notebook_has_a_widget_or_text_and_no_warning(monkeypatch, widgets):
    """Without `ipywidgets` the bar is text, though the output of a kernel is no terminal."""
    shell = types.SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setattr(bars.importlib.util, "find_spec", lambda name: object() if widgets else None)
    made = types.ModuleType("tqdm.notebook")
    made.tqdm = lambda **options: options
    monkeypatch.setitem(sys.modules, "tqdm.notebook", made)
    monkeypatch.setattr(bars, "tqdm", lambda **options: options | {"text": True})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shown = bars.shown_bar("MuJoCo", "s", 1.0)
    assert shown["disable"] is False
    assert ("text" in shown) != widgets


def test_elsewhere_a_bar_is_shown_on_terminals_alone(monkeypatch):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert bars.shown_bar("MuJoCo", "s", 1.0).disable
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert not bars.shown_bar("MuJoCo", "s", 1.0, leave=False).disable


def test_a_wait_has_a_bar(monkeypatch):
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(bars, "DELAY", 0.0)
    assert bars.waited(lambda: time.sleep(0.25) or 3, "limit analysis") == 3
    assert "limit analysis: 0." in screen.getvalue()


def test_a_wait_raises_what_the_function_raises():
    with pytest.raises(ZeroDivisionError):
        bars.waited(lambda: 1 / 0, "limit analysis")


def test_ctrl_c_ends_limit_analysis_while_a_programme_is_solved(monkeypatch):
    done, ended = threading.Event(), []

    def solving(*given, **options):
        _thread.interrupt_main()
        try:
            done.wait(20)
        finally:
            ended.append(True)

    monkeypatch.setattr(scipy.optimize, "linprog", solving)
    with pytest.raises(KeyboardInterrupt):
        mr.collapse_multiplier(mr.Masonry.arch(2.0, 0.4, voussoirs=5, k_n=1e9, friction=0.7), 1)
    assert not ended
    done.set()
