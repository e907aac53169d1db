"""Sets of records: the components of each station in a folder, and one factor for the components of a record."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import Array, require_kind, require_path, require_text, shown, spelt
from .code_spectrum import SpectrumOfCode
from .motion import GroundMotion
from .spectrum import factor_to_spectrum, response_spectrum

COMPONENTS = ("ENZ", "XYZ", "LTV", "XYV"), ("12Z", "123")
"""Letters that tell the components of a record apart in the names of its files: two horizontal ones, the vertical. The
numbers come second, as they tell stations apart too."""


class RecordSet(dict[str, tuple[GroundMotion, ...]]):
    """Records by name: the components of each, the horizontal ones first, a vertical one last where there is one."""

    def __or__(self, other: Mapping[str, tuple[GroundMotion, ...]]) -> RecordSet:  # type: ignore[override]
        """The records of both; those of the second where both have one of a name."""
        return RecordSet({**self, **other}) if isinstance(other, Mapping) else NotImplemented

    def __ror__(self, other: Mapping[str, tuple[GroundMotion, ...]]) -> RecordSet:  # type: ignore[override]
        """The same with the other one first."""
        return RecordSet({**other, **self}) if isinstance(other, Mapping) else NotImplemented

    @property
    def horizontal(self) -> list[GroundMotion]:
        """The horizontal components of all records, at most two of each."""
        return [motion for components in self.values() for motion in components[:2]]

    @property
    def first(self) -> list[GroundMotion]:
        """The first component of each record."""
        return [components[0] for components in self.values()]

    def scaled_to(self, spectrum: ArrayLike | SpectrumOfCode, periods: ArrayLike, damping: float = 0.05) -> RecordSet:
        """The set with each record scaled to a spectrum, all components of a record by one factor.

        Args:
            spectrum: of a code, or pseudo-accelerations at the periods [m/s2].
            periods, damping: as `scaled_together` takes them.

        Raises:
            TypeError, ValueError: for a value outside its range, or a motion at rest.
        """
        scaled = {name: scaled_together(components, periods, spectrum, damping) for name, components in self.items()}
        return RecordSet(scaled)

    def mean_over(self, spectrum: SpectrumOfCode, periods: ArrayLike, damping: float = 0.05) -> Array:
        """Mean of the spectra of the horizontal components over that of a code at each period [-], shape (n,).

        Raises:
            TypeError, ValueError: for a value outside its range, or a set without records.
        """
        require_kind("spectrum", spectrum, *get_args(SpectrumOfCode))
        if not self:
            raise ValueError("the set has no records")
        found = [response_spectrum(motion, periods, damping) for motion in self.horizontal]
        return np.asarray(np.mean([one.Sa for one in found], axis=0) / spectrum(found[0].period, damping))


def records_in(
    folder: str | PathLike[str], read: Callable[[Path], GroundMotion] = GroundMotion.from_esm, pattern: str = "*"
) -> RecordSet:
    """The records of a folder, as data bases and REXEL write them: a file for each component.

    The names of the files of one record differ in one letter alone, E, N and Z, X, Y and Z, or 1, 2 and 3. The two
    horizontal components come first, the vertical one last where there is one. A file that stands alone is a record of
    one component, and so is one whose header names another station.

    Args:
        folder: where the files are.
        read: reads one file, such as `GroundMotion.from_at2`.
        pattern: which files, such as "*.ASC".

    Returns:
        The components of each record, by the name of its files with ? in place of the letter, in order. The set has
        `scaled_to`, which scales it to a spectrum.

    Raises:
        OSError: if the folder cannot be read.
        ValueError: for a folder without such files, names that go together in more than one way, or a file that is not
            what it should be.
    """
    folder, pattern = require_path("folder", folder), require_text("pattern", pattern)
    files = {path.name: path for path in sorted(folder.iterdir()) if path.is_file() and not path.name.startswith(".")}
    names = [name for name in files if fnmatch.fnmatch(name.lower(), pattern.lower())]
    if not names:
        raise ValueError(f"{folder} has no file that fits the pattern {spelt(pattern)}")
    records = RecordSet()
    for key, members in _grouped(names).items():
        motions = tuple(read(files[name]) for name in members)
        if len({motion.header.get("STATION_CODE") for motion in motions}) == 1:
            records[key] = motions
        else:
            records.update({name: (motion,) for name, motion in zip(members, motions, strict=True)})
    return records


def _grouped(names: Sequence[str]) -> dict[str, list[str]]:
    """Names that differ in the letter of the component, by the name with ? in its place."""
    groups: dict[str, list[str]] = {}
    left = list(names)
    for kinds in COMPONENTS:
        found = _together(left, kinds)
        for name in left:
            keys = [key for key, members in found.items() if name in members]
            if len(keys) > 1:
                raise ValueError(
                    f"{name} goes with other files in more than one way: {', '.join(keys)}; give a pattern"
                )
        groups |= found
        left = [name for name in left if not any(name in members for members in found.values())]
    return dict(sorted((groups | {name: [name] for name in left}).items()))


def _together(names: Sequence[str], kinds: Sequence[str]) -> dict[str, list[str]]:
    """Names that differ in one of these sets of letters, at one place, by the name with ? there."""
    found: dict[str, list[str]] = {}
    sets = [cased for letters in kinds for cased in (letters, letters.lower())]
    for name in names:
        for i, letter in enumerate(name):
            key = f"{name[:i]}?{name[i + 1 :]}"
            for letters in sets:
                members = [other for other in (key.replace("?", one, 1) for one in letters) if other in names]
                if letter in letters and len(members) > len(found.get(key, "1")):
                    found[key] = members
    return found


def scaled_together(
    motions: Sequence[GroundMotion],
    periods: ArrayLike,
    target: ArrayLike | SpectrumOfCode,
    damping: float = 0.05,
) -> tuple[GroundMotion, ...]:
    """The components of a record scaled by one factor to a spectrum, a vertical one by the same.

    The factor is that of `scaled_to_spectrum` for the geometric mean of the spectra of the first two components, or of
    the only one.

    Args:
        motions: the components, the horizontal ones first, at least one.
        periods, target, damping: as `scaled_to_spectrum` takes them.

    Raises:
        TypeError, ValueError: for a value outside its range, or a motion at rest.
    """
    if not isinstance(motions, Sequence) or not motions:
        raise TypeError(f"motions = {shown(motions)} is not a sequence of at least one GroundMotion")
    for i, motion in enumerate(motions):
        require_kind(f"motions[{i}]", motion, GroundMotion)
    factors = [factor_to_spectrum(motion, periods, target, damping) for motion in motions[:2]]
    factor = float(np.exp(np.log(factors).mean()))
    return tuple(motion.scaled(factor) for motion in motions)
