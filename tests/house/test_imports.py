"""What `import mjrock` brings, and what it leaves alone until it is asked for."""

import subprocess
import sys

import pytest

import mjrock as mr


def test_importing_the_package_imports_no_matplotlib():
    code = """
import sys
import mjrock as mr
assert not [name for name in sys.modules if name.startswith(("matplotlib", "pandas", "dask"))]
from mjrock.study.fragility import fit_fragility
assert "matplotlib" not in sys.modules
assert mr.plotting.rotation.__module__ == "mjrock.plotting.histories"
from mjrock import plotting
assert plotting is mr.plotting
"""
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_what_is_not_there_is_no_attribute():
    with pytest.raises(AttributeError, match="module 'mjrock' has no attribute 'plots'"):
        mr.plots  # noqa: B018
