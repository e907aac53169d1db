"""Rocking theory against MuJoCo under earthquakes: the stiffer the base, the closer they are, run by run."""

import csv
import shutil
from pathlib import Path

import numpy as np
import pytest

from scripts.shared import suite
from scripts.studies import agreement

RECORDS = Path(__file__).parents[1] / "records"


@pytest.mark.slow
def test_pairs_of_runs(tmp_path, monkeypatch):
    """Three walls under a record from far and one from near, in both polarities: walls rest, rock and overturn."""
    for name in ("far_a.sac", "near_a.sac"):
        shutil.copy(RECORDS / name, tmp_path)
    for name, kept in {"SIDES": [0], "WALLS": [0, 1, 3], "LEVELS": [0, 1, 3, 4]}.items():
        monkeypatch.setattr(agreement, name, [getattr(agreement, name)[i] for i in kept])
    agreement.main(["--records", str(tmp_path), "--out", str(tmp_path)])
    with open(tmp_path / "agreement.csv") as file:
        rows = list(csv.DictReader(file))
    equal, ratio = {}, {}
    for k_n in agreement.STIFFNESSES:
        ends, peaks = suite.in_pairs(
            [
                row | {"peak_over_alpha": float(row["peak_over_alpha"])}
                for row in rows
                if float(row["k_n"]) in (0.0, k_n)
            ]
        )
        assert len(ends) == 48
        assert {"rests", "rocks", "overturns"} == set(ends.ravel())
        rocks = (ends == "rocks").all(axis=1)
        equal[k_n] = np.mean(ends[:, 0] == ends[:, 1])
        ratio[k_n] = np.median(peaks[rocks, 1] / peaks[rocks, 0])
    soft, middle, stiff = agreement.STIFFNESSES
    assert equal[stiff] > 0.95
    assert abs(ratio[stiff] - 1) < 0.03
    # the twin that must fail: a soft base lets walls rock farther
    assert ratio[soft] > ratio[middle] > 1.03
    assert equal[soft] < 0.9
