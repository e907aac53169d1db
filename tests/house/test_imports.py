"""What `import mjrock` brings, and what it leaves alone until it is asked for."""

import subprocess
import sys

import pytest

import mjrock as mr


def test_what_is_not_called_for_is_not_imported():
    """Formulas take no engine and no database, contacts no compiler, statistics no pictures; one process calls for one
    more each."""
    code = """
import sys
import mjrock as mr

def absent(*names):
    assert not [name for name in sys.modules if name.startswith(names)]

absent("mujoco", "numpy", "importlib.metadata", "matplotlib", "pandas", "dask")
mr.fit_fragility, mr.mechanism_check, mr.PointSpectrum, mr.code_spectrum, mr.Masonry.arch, mr.collapse_multiplier
absent("mujoco", "sqlite3", "pebble", "filelock", "numba", "matplotlib", "scipy.stats", "scipy.optimize")
contact = mr.contact_for, mr.contacts_for, mr.inspect_contacts, mr.contact_parameters
absent("numba", "scipy.optimize", "matplotlib")
solvers = mr.simulate, mr.solve_analytical, mr.solve_explicit, mr.Case, mr.Contacts, mr.Masonry, mr.MasonryCase
absent("scipy.signal", "scipy.stats", "scipy.optimize", "scipy.spatial", "scipy.integrate", "scipy.interpolate")
assert mr.plotting.rotation.__module__ == "mjrock.plotting.histories"
from mjrock import plotting
assert plotting is mr.plotting
"""
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


BLOCKED = "numba", "scipy", "matplotlib", "tqdm", "filelock", "pebble", "pandas"


def test_contacts_alone_work_where_only_mujoco_and_numpy_are_installed():
    """A ball rebounds with half of its speed, with all other dependencies out of reach."""
    code = f"""
import sys
for name in {BLOCKED}:
    sys.modules[name] = None
import mujoco
from mjrock import contact_for, contacts_for, inspect_contacts, measured_contact, contact_parameters, CoulombFriction
spec = mujoco.MjSpec.from_string('<mujoco><option timestep="1e-4" gravity="0 0 0"/><worldbody><geom name="floor" '
    'type="plane" size="1 1 1"/><body name="ball" pos="0 0 .2"><freejoint/><geom name="ball" size=".1" mass="2"/>'
    '</body></worldbody></mujoco>')
contact_for(spec, "ball", "floor", k=1e5, restitution=0.5).apply(spec)
model = spec.compile()
assert abs(inspect_contacts(model)[0].restitution - 0.5) < 1e-3
data = mujoco.MjData(model)
data.qvel[2] = -1.0
for _ in range(3000):
    mujoco.mj_step(model, data)
assert abs(data.qvel[2] - 0.5) < 0.01, data.qvel[2]
"""
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_an_older_mujoco_is_refused_by_name():
    """Where MuJoCo is first called for. Another version may take its place in the same process."""
    code = """
import mujoco
import mjrock as mr
for version in ("3.17.0", "2.3.7"):
    mujoco.__version__ = version
    mr.mechanism_check
    try:
        mr.simulate
    except ImportError as error:
        assert str(error) == f"mjrock needs MuJoCo 4.0 or newer, and {version} is installed: pip install 'mujoco>=4.0'"
    else:
        raise AssertionError(version)
mujoco.__version__ = "10.1.0rc1"
mr.simulate
"""
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_every_name_is_there():
    for name in mr.__all__:
        assert getattr(mr, name) is not None
    assert set(mr.HOME) | {"__version__"} == set(mr.__all__)
    assert dir(mr) == sorted([*mr.__all__, "blocks", "plotting"])


def test_what_is_not_there_is_no_attribute():
    with pytest.raises(AttributeError, match="module 'mjrock' has no attribute 'plots'"):
        mr.plots  # noqa: B018
