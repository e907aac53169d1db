"""What the scenes answer, in this process, and the file of what they answered when it was made."""

import json
import os
import subprocess
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path

from .digest_scenes import SCENES

ROOT = Path(__file__).resolve().parents[2]
STORED = Path(__file__).with_name("digests.json")
NUDGED = 1 + 2.0**-50
"""A length and its last digits more."""

Answers = dict[str, dict[str, float]]


def answers(names: Iterable[str] = SCENES, one: float = 1.0) -> Answers:
    """The numbers of each scene, in the order of the names."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {name: {label: float(value) for label, value in SCENES[name](one).items()} for name in names}


def stored() -> dict[str, dict]:
    """Value and tolerance of each answer by scene, and a word where a scene multiplies rounding."""
    return json.loads(STORED.read_text(encoding="utf-8"))


def elsewhere(*options: str, **environment: str) -> dict:
    """What `python -m tests.digests` prints in a process of its own."""
    setting = os.environ | {"OPENBLAS_NUM_THREADS": "1", "MJROCK_INTERPRET": "0"} | environment
    command = [sys.executable, "-m", "tests.digests", *options]
    run = subprocess.run(command, env=setting, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(run.stdout)


def moved(name: str, found: dict[str, float], kept: dict) -> list[str]:
    """The answers of a scene that are not as kept, each with its old and new number."""
    if found.keys() != kept["answers"].keys():
        return [f"{name}: answers {', '.join(found)} for {', '.join(kept['answers'])}"]
    return [
        f"{name}, {label}: {value!r} is now {found[label]!r}, {abs(found[label] - value):.1e} apart for {tolerance:.1e}"
        for label, (value, tolerance) in kept["answers"].items()
        if not abs(found[label] - value) <= tolerance
    ]
