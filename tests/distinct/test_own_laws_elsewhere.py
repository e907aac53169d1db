"""Own laws of joints and links in other processes: as plain Python, in campaigns, and where a file is gone on with."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
PROGRAM = """
import pickle, sys
import mjrock as mr
sys.path.insert(0, sys.argv[1])
import own_laws as laws
import own_links

@mr.joint_law
class Mine:
    memory = ("deepest",)

    def remember(self, u):
        self.deepest = max(self.deepest, u)

    def stress(self, u):
        return self.k_n * u if u > 0 else 0.0

    def energy(self, u):
        return 0.5 * self.k_n * u * u if u > 0 else 0.0

@mr.link_law
class Catch:
    k: float
    memory = ("longest",)

    def remember(self, u):
        self.longest = max(self.longest, u)

    def force(self, u, rate):
        return self.k * (u - 0.5 * self.longest) + 1e3 * rate if u > 0 else 0.0

    def energy(self, u):
        return 0.5 * self.k * u * (u - self.longest) if u > 0 else 0.0

def case(speed, law):
    ground = mr.Polygon([(-2, -1), (2, -1), (2, 0), (-2, 0)], fixed=True, name="ground")
    block = mr.Polygon([(0, 0), (0.3, 0), (0.3, 1), (0, 1)])
    linked = hasattr(law, "force")
    dry = mr.Dry(k_n=1e9, k_s=1e9, friction=0.6, points=3, law=None if linked else law)
    effects = mr.Link(height=0.9, own=law, length=1.0, block=1) if linked else ()
    return mr.MasonryCase(mr.Masonry([ground, block], joints=dry), 0.1, velocity=[[speed, 0, 0]], effects=effects)

def run(law, **options):
    return mr.solve_explicit(case(0.2, law), output_step=0.01, timestep=1e-4, **options)

if __name__ == "__main__":
"""


def printed(tmp_path, lines, *arguments, **environment):
    """What a program prints in a process of its own."""
    path = tmp_path / "program.py"
    path.write_text(PROGRAM + "".join(f"    {line}\n" for line in lines))
    done = subprocess.run(
        [sys.executable, str(path), str(TESTS), *map(str, arguments)],
        capture_output=True, text=True, check=False, env=os.environ | environment,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


BOTH = "(laws.Stiffening(2e-5), own_links.Slider(1e5, 40.0))"
"""A law of joints and one of links."""


@pytest.mark.slow
def test_plain_python_gives_the_same_bits(tmp_path):
    """Compiled, as plain Python in compiled loops, and as plain Python in loops that are plain Python."""
    lines = [f"print([run(law).pose[-1].tolist() for law in {BOTH}])"]
    modes = ({}, {"MJROCK_INTERPRET": "laws"}, {"NUMBA_DISABLE_JIT": "1"})
    assert len({printed(tmp_path, lines, **mode) for mode in modes}) == 1


@pytest.mark.slow
def test_a_run_goes_on_in_a_fresh_process(tmp_path):
    """The addresses of compiled laws are those of the process."""
    path = tmp_path / "ends.pickle"
    goes_on = f"print([run(law, start=end).pose[-1].tolist() for law, end in zip({BOTH}, ends)])"
    ends = [f"ends = [run(law).end for law in {BOTH}]", "pickle.dump(ends, open(sys.argv[2], 'wb'))"]
    first = printed(tmp_path, [*ends, goes_on], path)
    lines = ["run(laws.Hertz(1e-3))", "ends = pickle.load(open(sys.argv[2], 'rb'))"]
    assert printed(tmp_path, [*lines, goes_on], path) == first


@pytest.mark.slow
def test_a_campaign_takes_laws_of_the_script_to_its_processes(tmp_path):
    lines = [
        "runs = [(v, law) for v in (0.1, 0.2) for law in (Mine(), Catch(k=1e5))]",
        "of = lambda v, law: {'v': v, 'law': type(law).__name__}",
        "tasks = [mr.MasonryAnalysis(case(*run), solver='explicit', labels=of(*run)) for run in runs]",
        "path = mr.campaign(tasks, sys.argv[2], workers=int(sys.argv[3]))",
        "rows = mr.Store(path).rows()",
        "print(sorted((row['v'], row['law'], row['status'], row['largest_rotation_rad']) for row in rows))",
    ]
    found = [printed(tmp_path, lines, tmp_path / f"{n}.sqlite", n).splitlines()[-1] for n in (1, 2)]
    assert found[0] == found[1]
    assert found[0].count("done") + found[0].count("ok") == 4


@pytest.mark.slow
def test_a_saved_run_goes_on_with_its_laws(tmp_path):
    pytest.importorskip("h5py")
    lines = [
        f"for law in {BOTH}:",
        "    whole = run(law)",
        "    whole.save(sys.argv[2])",
        "    again = mr.load(sys.argv[2], laws=[type(law)])",
        "    runs = [run(law, start=each.end).pose[-1].tolist() for each in (whole, again)]",
        "    print(runs[0] == runs[1])",
    ]
    assert printed(tmp_path, lines, tmp_path / "run.h5").split() == ["True", "True"]
