"""What `import mjrock` brings, and what it leaves alone until it is asked for."""

import subprocess
import sys

import pytest

import mjrock as mr


def test_what_is_not_called_for_is_not_imported():
    """Contacts take no compiler, solvers no optimiser, statistics no pictures; one process calls for one more each."""
    code = """
import sys
import mjrock as mr

def absent(*names):
    assert not [name for name in sys.modules if name.startswith(names)]

absent("mujoco", "matplotlib", "pandas", "dask")
contact = mr.contact_for, mr.contacts_for, mr.inspect_contacts, mr.contact_parameters
absent("numba", "scipy.optimize", "matplotlib", "tqdm")
solvers = mr.simulate, mr.solve_analytical, mr.solve_explicit, mr.Case, mr.Contacts, mr.Masonry, mr.MasonryCase
absent("scipy.signal", "scipy.stats", "scipy.optimize", "scipy.spatial", "scipy.integrate", "scipy.interpolate")
from mjrock.study.intensity.fragility import fit_fragility
absent("matplotlib")
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


@pytest.mark.parametrize("version", ["3.12.0", "3.8.1", "2.3.7"])
def test_an_older_mujoco_is_refused_by_name(version):
    with pytest.raises(ImportError, match=f"needs MuJoCo 4.0 or newer, and {version} is installed"):
        mr._require_mujoco(version)
    mr._require_mujoco("4.0.0")
    mr._require_mujoco("10.1.0rc1")


def test_every_name_is_there():
    for name in mr.__all__:
        assert getattr(mr, name) is not None
    assert set(mr.HOME) | {"__version__"} == set(mr.__all__)
    assert dir(mr) == sorted([*mr.__all__, "plotting"])


def test_what_is_not_there_is_no_attribute():
    with pytest.raises(AttributeError, match="module 'mjrock' has no attribute 'plots'"):
        mr.plots  # noqa: B018
