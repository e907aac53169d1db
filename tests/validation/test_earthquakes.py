"""Rocking theory against MuJoCo under earthquakes: single histories part, distributions may not."""

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import ks_2samp

import agreement
import suite

RECORDS = Path(__file__).parents[1] / "records"


@pytest.mark.slow
def test_outcomes_and_distributions(tmp_path):
    agreement.main(["--records", str(RECORDS), "--out", str(tmp_path)])
    with open(tmp_path / "agreement.csv") as file:
        rows = [row for row in csv.DictReader(file) if float(row["k_n"]) in (0.0, suite.STIFF)]
    theory, mujoco = ([row for row in rows if row["solver"] == solver] for solver in suite.SOLVERS)
    assert len(theory) == len(mujoco) >= 200
    same = np.mean([suite.verdict(a) == suite.verdict(b) for a, b in zip(theory, mujoco, strict=True)])
    assert same > 0.8
    peaks = {
        (solver, side_stop): [
            9.0 if suite.verdict(row) == "overturns" else max(suite.STILL, float(row["peak_over_alpha"]))
            for row in rows
            if (row["solver"], row["side_stop"]) == (solver, side_stop)
        ]
        for solver in suite.SOLVERS
        for side_stop in "10"
    }
    for side_stop in "10":
        assert ks_2samp(peaks["analytical", side_stop], peaks["MuJoCo", side_stop]).pvalue > 0.05
    # the twin that must fail: with other sides the walls of one solver are not those of the other
    assert ks_2samp(peaks["analytical", "1"], peaks["MuJoCo", "0"]).pvalue < 1e-3
