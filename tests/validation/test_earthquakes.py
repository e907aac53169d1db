"""Rocking theory against MuJoCo under recorded earthquakes: single histories part, distributions may not."""

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import ks_2samp

import agreement
import suite

RECORDS = Path(__file__).parents[3] / "shared" / "records"


@pytest.mark.slow
def test_outcomes_and_distributions(tmp_path):
    if not RECORDS.is_dir():
        pytest.skip(f"the recorded ground motions are not at {RECORDS.name}")
    agreement.main(["--records", str(RECORDS), "--out", str(tmp_path)])
    with open(tmp_path / "agreement.csv") as file:
        rows = list(csv.DictReader(file))
    theory, mujoco = ([row for row in rows if row["solver"] == solver] for solver in agreement.SOLVERS)
    assert len(theory) == len(mujoco) >= 200
    same = np.mean([suite.verdict(a) == suite.verdict(b) for a, b in zip(theory, mujoco, strict=True)])
    assert same > 0.8
    for side_stop in "10":
        peaks = [
            [9.0 if suite.verdict(r) == "overturns" else max(suite.STILL, float(r["peak_over_alpha"])) for r in own]
            for own in ([r for r in rows if r["side_stop"] == side_stop] for rows in (theory, mujoco))
        ]
        assert ks_2samp(*peaks).pvalue > 0.05
        halved = [value if value == 9.0 else max(suite.STILL, 0.5 * value) for value in peaks[1]]
        if side_stop == "1":  # the twin that must fail: half the rotations are another distribution
            assert ks_2samp(peaks[0], halved).pvalue < 0.05
