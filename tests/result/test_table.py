import io
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mjrock as mr
from mjrock.contacts.files import csv_text

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
E = mr.Restitution.from_geometry(WALL)
UP = mr.GroundMotion.sine(0.5, 0.3)
SHAKEN = mr.Case(WALL, 0.02, 0.2, motion=mr.GroundMotion.sine(1.0, 0.2), vertical=UP)
READ = 1e-13
"""What pandas before 3.0 errs by as it reads a number, over it [-]: up to 1.01e-14."""
FILES = sorted(Path(__file__).parents[2].glob("docs/figures/**/*.csv"))


def test_numpy_and_pandas_read_a_response(tmp_path):
    response = mr.solve_analytical(SHAKEN, E)
    text = response.csv(tmp_path / "response.csv")
    assert (tmp_path / "response.csv").read_text() == text
    assert [path.name for path in tmp_path.iterdir()] == ["response.csv"]
    read = np.genfromtxt(tmp_path / "response.csv", delimiter=",", names=True)
    assert read.dtype.names[:4] == ("t_s", "theta_rad", "omega_rads", "energy_J")
    for name, values in (("t_s", response.t), ("theta_rad", response.theta), ("omega_rads", response.omega)):
        np.testing.assert_array_equal(read[name], values)
    np.testing.assert_array_equal(read["x_m"], response.pose[:, 0, 0])
    np.testing.assert_array_equal(read["ground_vertical_ms2"], UP(response.t))
    frame = pd.read_csv(tmp_path / "response.csv", comment="#")
    assert list(frame)[:3] == ["t [s]", "theta [rad]", "omega [rad/s]"]
    np.testing.assert_allclose(frame["energy [J]"], response.energy, rtol=READ, atol=1e-300)
    np.testing.assert_allclose(frame["rotation [rad]"], response.theta, rtol=READ, atol=1e-300)
    np.testing.assert_allclose(frame["z [m]"], response.pose[:, 0, 1], rtol=READ, atol=1e-300)
    np.testing.assert_allclose(frame["ground horizontal [m/s2]"], SHAKEN.motion(response.t), rtol=READ, atol=1e-300)


def test_numpy_reads_a_comparison():
    case = mr.Case(WALL, 0.02, 0.8)
    theory = mr.solve_analytical(case, E)
    table = mr.compare(theory, theory)
    read = np.genfromtxt(io.StringIO(table.csv()), delimiter=",", names=True)
    expected = [row["restitution, analytical 1 [-]"] for row in table.rows()]
    np.testing.assert_array_equal(np.atleast_1d(read["restitution_analytical_1_"]), expected)


def test_what_numpy_would_trip_over_is_left_out():
    text = csv_text(["case #", "peak, MuJoCo [-]", 'the "law"'], [[1, 0.1 + 0.2, "sine, reversed #2"]])
    assert text == "case,peak MuJoCo [-],the law\n1,0.30000000000000004,sine; reversed no. 2\n"
    read = np.genfromtxt(io.StringIO(text), delimiter=",", names=True, dtype=None, encoding=None)
    assert read.dtype.names == ("case", "peak_MuJoCo_", "the_law")
    with pytest.raises(ValueError, match=r"two columns have the name 'e 1'"):
        csv_text(["e, 1", "e 1"], [])


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_numpy_reads_what_the_scripts_have_written(path):
    read = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert len(np.atleast_1d(read)) == len(path.read_text().splitlines()) - 1
