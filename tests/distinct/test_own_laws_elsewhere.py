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


OF_BOTH = pytest.mark.parametrize("law", ["laws.Stiffening(2e-5)", "own_links.Slider(1e5, 40.0)"])


@pytest.mark.slow
@OF_BOTH
def test_plain_python_gives_the_same_bits(tmp_path, law):
    """Compiled, as plain Python in compiled loops, and as plain Python in loops that are plain Python."""
    lines = [f"print(run({law}).pose[-1].tolist())"]
    modes = ({}, {"MJROCK_INTERPRET": "laws"}, {"NUMBA_DISABLE_JIT": "1"})
    assert len({printed(tmp_path, lines, **mode) for mode in modes}) == 1


@pytest.mark.slow
@OF_BOTH
def test_a_run_goes_on_in_a_fresh_process(tmp_path, law):
    """The addresses of compiled laws are those of the process."""
    end = tmp_path / "end.pickle"
    first = printed(
        tmp_path,
        [
            f"end = run({law}).end",
            "pickle.dump(end, open(sys.argv[2], 'wb'))",
            f"print(run({law}, start=end).pose[-1].tolist())",
        ],
        end,
    )
    lines = [f"print(run({law}, start=pickle.load(open(sys.argv[2], 'rb'))).pose[-1].tolist())"]
    assert printed(tmp_path, ["run(laws.Hertz(1e-3))", *lines], end) == first


@pytest.mark.slow
@pytest.mark.parametrize("law", ["Mine()", "Catch(k=1e5)"])
def test_a_campaign_takes_a_law_of_the_script_to_its_processes(tmp_path, law):
    lines = [
        f"tasks = [mr.MasonryAnalysis(case(v, {law}), solver='explicit', labels={{'v': v}}) for v in (0.1, 0.2)]",
        "path = mr.campaign(tasks, sys.argv[2], workers=int(sys.argv[3]))",
        "rows = mr.Store(path).rows()",
        "print(sorted((row['v'], row['status'], row['largest_rotation_rad']) for row in rows))",
    ]
    found = [printed(tmp_path, lines, tmp_path / f"{n}.sqlite", n).splitlines()[-1] for n in (1, 2)]
    assert found[0] == found[1]
    assert found[0].count("done") + found[0].count("ok") == 2


@pytest.mark.slow
@OF_BOTH
def test_a_saved_run_goes_on_with_its_laws(tmp_path, law):
    pytest.importorskip("h5py")
    lines = [
        f"whole = run({law})",
        "whole.save(sys.argv[2])",
        f"again = mr.load(sys.argv[2], laws=[type({law})])",
        f"runs = [run({law}, start=each.end).pose[-1].tolist() for each in (whole, again)]",
        "print(runs[0] == runs[1])",
    ]
    assert printed(tmp_path, lines, tmp_path / "run.h5") == "True\n"
