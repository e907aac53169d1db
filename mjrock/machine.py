"""The machine: cores and memory that this process may use, and the kernels of linear algebra, on which last digits
depend."""

from __future__ import annotations

import contextlib
import ctypes
import importlib.metadata
import importlib.util
import math
import os
import platform
from functools import cache
from pathlib import Path

NAMES = ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename", "openblas_get_corename")
"""Functions of OpenBLAS that give the name of its kernel, as NumPy, SciPy and others name them."""


@cache
def kernels() -> dict[str, str]:
    """The kernel that OpenBLAS takes for this processor, for NumPy and for SciPy, such as "Haswell".

    The environment variable OPENBLAS_CORETYPE names another one. Packages that bring no OpenBLAS of their own, as those
    of macOS and of conda, are left out.
    """
    names = {}
    for package in ("numpy", "scipy"):
        spec = importlib.util.find_spec(package)
        folder = Path(spec.origin if spec is not None and spec.origin else package).parent
        for path in [*folder.with_name(f"{package}.libs").glob("*openblas*"), *folder.glob(".dylibs/*openblas*")]:
            with contextlib.suppress(OSError):
                library = ctypes.CDLL(str(path))
                for function in (getattr(library, name) for name in NAMES if hasattr(library, name)):
                    function.restype = ctypes.c_char_p
                    names[package] = function().decode()
    return names


@cache
def description() -> str:
    """The processor, Python, and the versions and kernels of what computes, in one line."""
    versions = [f"Python {platform.python_version()} on {platform.machine()}"]
    for package in ("numpy", "scipy", "numba", "mujoco"):
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            kernel = f" with OpenBLAS for {kernels()[package]}" if package in kernels() else ""
            versions.append(f"{package} {importlib.metadata.version(package)}{kernel}")
    if name := os.environ.get("NUMBA_CPU_NAME"):
        versions.append(f"compiled for {name}")
    return ", ".join(versions)


def memory() -> float:
    """Memory that this process can take [bytes]: what the machine has available, and the limit of its control group;
    without /proc what the machine has, or infinite where that is not known either."""
    available = math.inf
    with contextlib.suppress(AttributeError, OSError, ValueError):
        available = float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    with contextlib.suppress(OSError):
        table = dict(line.split(":") for line in Path("/proc/meminfo").read_text().splitlines())
        available = 1024.0 * int(table["MemAvailable"].split()[0])
    for path in (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes")):
        with contextlib.suppress(OSError, ValueError):  # "max" stands for none
            available = min(available, float(path.read_text()))
    return available


def cores() -> int:
    """Cores that this process may use: those of the machine, its affinity, and the quota of its control group."""
    count = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    quotas = Path("/sys/fs/cgroup/cpu.max"), Path("/sys/fs/cgroup/cpu/cpu.cfs_quota_us")
    for path, period in zip(quotas, (None, quotas[1].with_name("cpu.cfs_period_us")), strict=True):
        with contextlib.suppress(OSError, ValueError):  # "max" and -1 stand for none
            quota, *periods = (path.read_text() + (period.read_text() if period else "")).split()
            count = min(count, math.ceil(float(quota) / float(periods[0]))) if float(quota) > 0 else count
    return count
