"""Whole results in files: every kind of answer comes back to the bit, runs go on from it to the bit, and files explain
themselves, keep out what is not theirs, and are whole or absent."""

import dataclasses
import enum
import hashlib
import json
import os
import subprocess
import sys
import warnings
from collections.abc import Mapping
from functools import cache, cached_property

import matplotlib
import numpy as np
import pytest
from everyday import among, slow

import mjrock as mr
from mjrock.result.tree import NotKept, Reader

h5py = pytest.importorskip("h5py")

WALL = mr.Block.from_size(0.6, 4.2, openings=[mr.Opening(width=0.3, height=1.0, sill=1.0)])
E = mr.Restitution.from_geometry(WALL)
CONTACTS = mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=5e8)
SHAKE = mr.GroundMotion.sine(3.0, 0.6, cycles=1)
TIE = mr.Tie(height=3.0, stiffness=5e6, slack=1e-3, strength=2e3)
ROCKS = mr.Case(WALL, 0.06, 0.4, effects=(mr.AddedMass(mass=100.0, height=4.0),))
SHAKEN = mr.Case(WALL, 0.0, 0.5, side_stop=False, motion=SHAKE, vertical=SHAKE.scaled(0.3), effects=(TIE,))
BOND = mr.Bond(tension=2e4, cohesion=3e4, opening_energy=5.0, slip_energy=20.0)
T = np.linspace(0.0, 0.4, 41)


def boxes(count=2, fixed=True):
    """Blocks of the plane on each other."""
    base = [mr.Polygon([(-3, -0.5), (3, -0.5), (3, 0), (-3, 0)], fixed=True, name="ground")] if fixed else []
    return base + [
        mr.Polygon([(-0.3, i), (0.3, i), (0.3, i + 1), (-0.3, i + 1)], name=f"box/{i}.") for i in range(count)
    ]


def column(**joints):
    return mr.Masonry(boxes(), **{"k_n": 1e8, "k_s": 5e7, "friction": 0.6} | joints)


def hook():
    """A block that is not convex, by two that are."""
    parts = [mr.Polygon([(-0.3, 0), (0.3, 0), (0.3, 0.4), (-0.3, 0.4)])]
    parts += [mr.Polygon([(-0.3, 0.4), (0, 0.4), (0, 1.0), (-0.3, 1.0)])]
    return mr.Masonry([boxes(0)[0], mr.Compound(parts, name="hook")], k_n=1e8, k_s=5e7)


def law(wall, e, k_base):
    """Damping ratios of a user's own law."""
    return 0.04, 0.3


def fallen():
    """A column in space whose upper drum is thrown off, so that contacts are found where blocks are."""
    drums = mr.Masonry.column(width=0.4, height=1.2, drums=2, k_n=1e7, k_s=5e6)
    return mr.MasonryCase(drums, 0.9, velocity=[[0.0] * 6, [2.5, 0.0, 0.5, 0.0, 2.0, 0.0]])


def driven():
    effects = (
        mr.Actuator("box/1.", (0.0, 1.5), (1.0, 0.0), (T, 0.02 * T), 1e6, 1e3),
        mr.Damper(height=0.5, c=1e4, block="box/0."),
        mr.FrictionDamper(height=1.2, stiffness=1e6, slip_force=500.0, block="box/1."),
    )
    return mr.MasonryCase(column(), 0.3, effects=effects, tilt=(T, 0.1 * T))


STICKS = mr.MasonryCase(column(k_s=None), 0.2, motion=SHAKE)
ANSWERS = {
    "wall, MuJoCo": lambda: mr.simulate(ROCKS, CONTACTS, ledger=True, forces=True),
    "shaken wall, MuJoCo": lambda: mr.simulate(SHAKEN, CONTACTS, ledger=True),
    "wall, fixed step": lambda: mr.simulate(ROCKS, CONTACTS, timestep=2e-4, output_step=1e-3),
    "wall, plain": lambda: mr.simulate(ROCKS, CONTACTS, collisions=True, forces=True),
    "wall, explicit": lambda: mr.solve_explicit(SHAKEN, CONTACTS, ledger=True, forces=True),
    "theory": lambda: mr.solve_analytical(SHAKEN, E.scattered(0.05, 3)),
    "fall in theory": lambda: mr.solve_analytical(mr.Case(WALL, 0.15, 2.0), E),
    "contact law": lambda: mr.solve_compliant(dataclasses.replace(ROCKS, duration=0.1), CONTACTS),
    "masonry, MuJoCo": lambda: mr.simulate(STICKS, forces=True, ledger=True),
    "masonry, plain": lambda: mr.simulate(STICKS, collisions=True),
    "mortar": lambda: mr.solve_explicit(
        mr.MasonryCase(column(bond=BOND, points=5), 0.4, motion=SHAKE.scaled(3)), forces=True, ledger=True
    ),
    "supports": lambda: mr.solve_explicit(
        mr.MasonryCase(column(), 0.4, supports={"ground": (T, 0.05 * T, 0 * T)}), forces=True, ledger=True
    ),
    "driven": lambda: mr.solve_explicit(driven(), forces=True, ledger=True),
    "in space": lambda: mr.solve_explicit(fallen(), ledger=True, forces=True),
    "hook": lambda: mr.solve_explicit(mr.MasonryCase(hook(), 0.1, velocity=[[0.5, 0, 0.2]])),
    "rigid friction": lambda: mr.solve_explicit(STICKS),
    "dome": lambda: mr.solve_explicit(
        mr.MasonryCase(mr.Masonry.dome(3.0, 0.6, lunes=4, hoops=3, k_s=5e9), 0.02, transverse=SHAKE)
    ),
}
REMEMBERED = ("wall, explicit", "mortar", "supports", "driven", "in space", "hook", "rigid friction", "dome")
"""Answers with a memory of explicit steps."""


@cache
def answer(kind):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ANSWERS[kind]()


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.h5"


def reloaded(found, path):
    return mr.load(found.save(path))


def differences(one, other, at="answer"):
    """Where two values differ, in their kind or by a bit."""
    if type(one) is not type(other) and not (isinstance(one, Mapping) and isinstance(other, Mapping)):
        return [f"{at}: {type(one).__name__} and {type(other).__name__}"]
    if isinstance(one, np.ndarray):
        alike = one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
        alike = alike and one.flags.writeable == other.flags.writeable and one.flags.fnc == other.flags.fnc
        return [] if alike else [f"{at}: {one.dtype} {one.shape} and {other.dtype} {other.shape}"]
    if isinstance(one, Mapping):
        if list(one) != list(other):
            return [f"{at}: {list(one)} and {list(other)}"]
        return [text for name in one for text in differences(one[name], other[name], f"{at}[{name!r}]")]
    if isinstance(one, float):
        return [] if np.float64(one).tobytes() == np.float64(other).tobytes() else [f"{at}: {one!r} and {other!r}"]
    if dataclasses.is_dataclass(one) and not isinstance(one, enum.Enum):
        parts = {each.name: [getattr(side, each.name) for side in (one, other)] for each in dataclasses.fields(one)}
        return [text for name, pair in parts.items() for text in differences(*pair, f"{at}.{name}")]
    if isinstance(one, tuple | list):
        if len(one) != len(other):
            return [f"{at}: {len(one)} and {len(other)} items"]
        pairs = enumerate(zip(one, other, strict=True))
        return [text for i, pair in pairs for text in differences(*pair, f"{at}.{i}")]
    return [] if one == other else [f"{at}: {one!r} and {other!r}"]


@pytest.mark.parametrize("kind", ANSWERS)
def test_every_answer_comes_back_to_the_bit(kind, path):
    found = answer(kind)
    read = reloaded(found, path)
    assert differences(found, read) == []
    assert read == found
    assert repr(read) == repr(found)
    assert read.csv() == found.csv()
    public = [name for name in dir(type(found)) if isinstance(getattr(type(found), name), property | cached_property)]
    assert len(public) > 25
    for name in public:
        try:
            expected = getattr(found, name)
        except (AttributeError, ValueError) as error:
            with pytest.raises(type(error)):
                getattr(read, name)
        else:
            assert differences(expected, getattr(read, name), name) == []


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["wall, MuJoCo", "theory", "mortar", "in space"])
def test_pictures_and_reports_of_it_are_the_same(kind, path):
    found = answer(kind)
    read = reloaded(found, path)
    pages = []
    for name, one in (("saved", found), ("read", read)):
        folder = path.with_name(name)
        folder.mkdir()
        mr.plotting.view(one, folder / "film.html")
        mr.report(one.case, one, folder / "report.html")
        with matplotlib.rc_context({"svg.hashsalt": "same"}):
            mr.plotting.history(one).figure.savefig(folder / "history.svg", metadata={"Date": None})
        pages.append({file.name: file.read_text() for file in folder.iterdir()})
    assert set(pages[0]) >= {"film.html", "report.html", "history.svg"}
    assert [name for name in pages[0] if pages[0][name] != pages[1][name]] == []


@pytest.mark.parametrize("kind", REMEMBERED)
def test_explicit_steps_go_on_to_the_bit(kind, path):
    """From the file, with the case of the file or that of the script, as without it."""
    found = answer(kind)
    read = reloaded(found, path)
    contacts = found.origin.contacts
    assert read.end.memory is not None
    on = [
        mr.solve_explicit(dataclasses.replace(case, duration=0.05), contacts, start=end)
        for case, end in ((found.case, found.end), (found.case, read.end), (read.case, read.end))
    ]
    for other in on[1:]:
        assert differences(on[0].motion, other.motion) == []
        assert differences(on[0].end, other.end) == []


@pytest.mark.parametrize("kind", ["wall, MuJoCo", "wall, fixed step", "masonry, MuJoCo", "masonry, plain"])
def test_mujoco_goes_on_to_the_bit(kind, path):
    found = answer(kind)
    read = reloaded(found, path)
    options = {name: found.origin.options[name] for name in ("timestep", "collisions")}
    on = [
        mr.simulate(dataclasses.replace(one.case, duration=0.1), one.origin.contacts, start=one.end, **options)
        for one in (found, read)
    ]
    assert differences(on[0].motion, on[1].motion) == []


def test_theory_is_repeated_to_the_bit(path):
    """It has no end; the file has what repeats it, the seed of its restitution included."""
    found = answer("theory")
    read = reloaded(found, path)
    assert read.end is None
    assert read.origin.e.seed == 3
    again = mr.solve_analytical(read.case, read.origin.e, **read.origin.options)
    assert differences(found.motion, again.motion) == []


def test_an_answer_says_what_made_it():
    origin = answer("wall, fixed step").origin
    assert origin.contacts is CONTACTS
    assert origin.options["timestep"] == 2e-4
    assert not origin.options["ledger"]
    assert origin.version == mr.__version__
    assert "numpy" in origin.machine
    assert "mujoco" in origin.machine
    on = mr.simulate(ROCKS, CONTACTS, timestep=2e-4, start=answer("wall, fixed step").end)
    assert on.origin.options["start"].memory is None


def test_the_file_explains_itself(path):
    """By h5py alone: units and descriptions of all, dimensions by name, versions and sources at the top."""
    found = answer("mortar")
    found.save(path)
    with h5py.File(path) as file:
        assert file.attrs["mjrock_version"] == mr.__version__
        assert file.attrs["machine"] == found.origin.machine
        assert file.attrs["ground_motion"] == found.case.motion.name
        assert file.attrs["solver"] == "explicit"
        names = []
        file.visit(names.append)
        sets = [file[name] for name in names if isinstance(file[name], h5py.Dataset)]
        assert [one.name for one in sets if not (one.attrs["description"] and "units" in one.attrs)] == []
        arrays = [one for one in sets if one.ndim]
        assert [one.name for one in arrays if not one.is_scale and not all(dim.label for dim in one.dims)] == []
        assert [dim.label for dim in file["pose"].dims] == ["t", "body", "coordinate"]
        assert file["t"].attrs["units"] == "s"
        assert file["normal"].attrs["units"] == "N"
        assert file["ledger kinetic"].attrs["units"] == "J"
        assert file["ground_motion"].attrs["units"] == "m/s2"
        np.testing.assert_array_equal(file["pose"], found.pose)
        np.testing.assert_array_equal(file["normal"], found.forces.normal)
        case = json.loads(file["answer/case"][()])
    assert case["class"] == "MasonryCase"
    assert case["masonry"]["blocks"][1]["vertices"][1] == [0.3, 0.0]
    assert case["masonry"]["bond"]["tension"] == BOND.tension


@pytest.mark.parametrize("kind", among(["mortar", "shaken wall, MuJoCo", "in space"], "mortar", "in space"))
def test_xarray_opens_it(path, kind):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    found = answer(kind)
    made = found.to_xarray()
    with xarray.open_dataset(found.save(path), engine="h5netcdf") as read:
        assert set(made) <= set(read)
        for name in made:
            assert made[name].dims == read[name].dims
            assert made[name].attrs == {key: read[name].attrs[key] for key in ("units", "description")}
            np.testing.assert_array_equal(made[name].values, read[name].values)
        assert made.attrs.items() <= read.attrs.items()
        x = read.pose.sel(body=found.bodies[0], coordinate="x")
        np.testing.assert_array_equal(x, found.pose[:, 0, 0])


@pytest.mark.parametrize("kind", ["wall, MuJoCo", "theory", "mortar", "in space"])
class TestFilesOfOthers:
    """Tables, glTF and VTK have the case, the options, versions and the processor, from which the case is read."""

    def is_right(self, message, found):
        assert message["mjrock_version"] == mr.__version__
        assert message["machine"] == found.origin.machine
        assert message["solver"] == found.solver
        assert Reader({}).value(message["case"], "case") == found.case
        origin = Reader({}).value(message["origin"], "origin")
        assert differences(origin, found.origin) == []

    def test_csv(self, kind, path):
        found = answer(kind)
        text = found.csv(path)
        comments = dict(line[2:].split(": ", 1) for line in text.splitlines() if line.startswith("# "))
        self.is_right(comments | {name: json.loads(comments[name]) for name in ("case", "origin")}, found)
        assert len(np.genfromtxt(path, delimiter=",", names=True)) == len(found.t)
        assert len(np.loadtxt(path, delimiter=",", skiprows=1)) == len(found.t)
        frame = pytest.importorskip("pandas").read_csv(path, comment="#")
        assert {str(kind) for kind in frame.dtypes} == {"float64"}
        np.testing.assert_array_equal(frame["t [s]"], found.t)

    def test_gltf(self, kind, path):
        found, trimesh = answer(kind), pytest.importorskip("trimesh")
        content = found.to_gltf(path.with_suffix(".glb")).read_bytes()
        text = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
        self.is_right(text["asset"]["extras"], found)
        assert len(trimesh.load(path.with_suffix(".glb")).geometry) >= len(found.bodies)

    def test_vtk(self, kind, path):
        found, meshio = answer(kind), pytest.importorskip("meshio")
        found.to_vtk(path.parent)
        first, second = (meshio.read(path.parent / f"blocks_{i:05d}.vtu") for i in range(2))
        self.is_right(json.loads(bytes(first.field_data["answer"].tolist()).decode()), found)
        assert "answer" not in second.field_data


class TestFunctions:
    """Functions of the user have no content that a file can hold."""

    def test_of_joints_are_kept_by_what_they_gave(self, path):
        varied = mr.Masonry(boxes(), joints=lambda joint: mr.Dry(k_n=1e8 if "ground" in joint.name else 2e8, k_s=5e7))
        found = mr.solve_explicit(mr.MasonryCase(varied, 0.1, motion=SHAKE))
        read = reloaded(found, path)
        assert read.case.masonry.joint_stiffness.tolist() == [1e8, 2e8]
        assert differences(found.motion, read.motion) == []
        assert differences(varied.table, read.case.masonry.table) == []
        case, end = dataclasses.replace(read.case, duration=0.05), read.end
        on = mr.solve_explicit(dataclasses.replace(found.case, duration=0.05), start=found.end)
        assert differences(on.motion, mr.solve_explicit(case, start=end).motion) == []

    def test_laws_of_damping_too(self, path):
        stack = mr.Masonry.stack([mr.Block.from_size(0.6, 0.9)] * 2, k_n=5e8, law=law)
        found = mr.simulate(mr.MasonryCase(stack, 0.1, motion=SHAKE))
        read = reloaded(found, path)
        again = mr.simulate(read.case)
        assert differences(found.motion, again.motion) == []

    def test_of_pairs_are_lost_and_the_motion_is_not(self, path):
        given = column(pairs=lambda one, other: mr.Dry(friction=0.3))
        found = mr.solve_explicit(mr.MasonryCase(given, 0.1, motion=SHAKE))
        with pytest.warns(UserWarning, match=r"does not hold case\.masonry\.pairs \(function .*lambda"):
            found.save(path)
        read = mr.load(path)
        assert differences(found.motion, read.motion) == []
        assert isinstance(read.case.masonry.pairs, NotKept)
        with pytest.raises(ValueError, match="was not kept in the file"):
            mr.solve_explicit(read.case)


@dataclasses.dataclass(frozen=True)
class OwnLoad(mr.Load):
    """An effect from a user's file."""


def test_classes_of_the_user_are_read_where_they_are_given(path):
    load = OwnLoad(force=1e3, height=4.2, offset=0.1)
    found = mr.solve_analytical(mr.Case(WALL, 0.05, 0.2, effects=(load,)), E)
    found.save(path)
    with pytest.raises(ValueError, match=r"case\.effects\.0 is of the class .*OwnLoad of a user; give it as laws="):
        mr.load(path)
    assert mr.load(path, laws=[OwnLoad]) == found
    with pytest.raises(TypeError, match=r"laws has .*OwnLoad.*, which is not a class"):
        mr.load(path, laws=[load])
    with pytest.raises(TypeError, match=r"laws = .*OwnLoad.* is one class; give a list of them, laws=\[OwnLoad\]"):
        mr.load(path, laws=OwnLoad)


@mr.joint_law
class Stiffening:
    """A law of joints from a user's file, with a memory."""

    a: float
    memory = ("most",)

    def stress(self, u):
        return self.k_n * u * (1 + u / self.a) if u > 0 else 0.0

    def energy(self, u):
        return self.k_n * u * u * (0.5 + u / (3 * self.a)) if u > 0 else 0.0

    def remember(self, u):
        self.most = max(self.most, u)


@pytest.mark.slow
def test_own_laws_of_joints_go_on_to_the_bit(path):
    """Compiled in each process; slow for that."""
    masonry = mr.Masonry(boxes(), joints=mr.Dry(k_n=1e9, k_s=1e9, law=Stiffening(a=2e-5)))
    found = mr.solve_explicit(mr.MasonryCase(masonry, 0.1, motion=SHAKE), ledger=True, forces=True)
    found.save(path)
    with pytest.raises(ValueError, match=r"masonry\.bond is of the class .*Stiffening of a user; give it as laws="):
        mr.load(path)
    read = mr.load(path, laws=[Stiffening])
    assert differences(found, read) == []
    on = [mr.solve_explicit(one.case, start=one.end) for one in (found, read)]
    assert differences(on[0].motion, on[1].motion) == []
    assert read.end.memory is not None
    with pytest.warns(UserWarning, match=r"masonry\.bond is of the class .*Stiffening, whose methods have changed"):
        mr.load(path, laws=[changed(Stiffening)])


def changed(law):
    """A law of the same name that remembers something else."""
    methods = {name: getattr(law, name) for name in ("stress", "energy", "remember")}
    body = {"__annotations__": {"a": float}, "memory": ("most", "least"), **methods}
    return mr.joint_law(type(law.__name__, (), body))


def test_a_class_of_the_user_takes_the_place_of_none_of_mjrock(path):
    own = dataclasses.make_dataclass("Case", ["wall"])
    answer("theory").save(path)
    assert mr.load(path, laws=[own]) == answer("theory")


class TestRefused:
    def test_other_files(self, path, tmp_path):
        with pytest.raises(FileNotFoundError, match="none"):
            mr.load(tmp_path / "none.h5")
        path.write_text("t,theta\n")
        with pytest.raises(ValueError, match=r"run\.h5 is no file of Response\.save, or is damaged"):
            mr.load(path)
        with h5py.File(path, "w") as file:
            file["x"] = 1.0
        with pytest.raises(ValueError, match=r"and not one of Response\.save"):
            mr.load(path)

    @pytest.mark.parametrize(("version", "message"), [(2, "newer format 2.*update mjrock"), (0, "older format 0")])
    def test_other_formats(self, path, version, message):
        answer("theory").save(path)
        with h5py.File(path, "a") as file:
            file.attrs["format_version"] = version
        with pytest.raises(ValueError, match=message):
            mr.load(path)

    def test_changed_numbers(self, path):
        answer("theory").save(path)
        with h5py.File(path, "a") as file:
            file["energy"][3] += 1e-9
        with pytest.raises(ValueError, match="energy is not as it was written"):
            mr.load(path)

    def test_what_a_user_adds_is_left_alone(self, path):
        answer("theory").save(path)
        with h5py.File(path, "a") as file:
            file["remark"] = "the third wall"
            file.attrs["project"] = "Amatrice"
        assert mr.load(path) == answer("theory")

    @pytest.mark.parametrize(
        ("kind", "count"),
        [("theory", 40), ("mortar", 40), slow(("theory", 60)), slow(("mortar", 60))],
    )
    def test_damaged_files(self, path, kind, count):
        """Cut, or with bytes that are others, they are refused, or what is read is right."""
        found = answer(kind)
        whole = found.save(path).read_bytes()
        random = np.random.default_rng(1)
        refused = 0
        for i in range(count):
            torn = bytearray(whole)
            if i < count // 4:
                torn = torn[: int(random.integers(len(whole)))]
            else:
                torn[int(random.integers(len(whole) if i % 2 else 4096))] ^= 1 << int(random.integers(8))
            path.write_bytes(torn)
            try:
                read = mr.load(path)
            except ValueError as error:
                refused += str(path) in str(error)
            else:
                assert differences(read, found) == []
        assert count / 2 < refused < count

    @pytest.mark.parametrize(
        "name", ["mjrock.examples.01_release.x", "mjrock.x", "os.system", "simulate", "mjrock.result.tree.Writer"]
    )
    def test_classes_that_hold_no_values(self, path, name):
        """A file names classes. None is imported, or called, that only a forger would name."""
        answer("theory").save(path)
        with h5py.File(path, "a") as file:
            text = file["answer/outcome"][()].decode().replace("Outcome", name)
            sums = json.loads(file["answer/checksums"][()])
            del file["answer/outcome"], file["answer/checksums"]
            sums["answer/outcome"] = hashlib.sha256(text.encode()).hexdigest()
            file["answer/outcome"], file["answer/checksums"] = text, json.dumps(sums)
        with pytest.raises(ValueError, match="outcome is of the class"):
            mr.load(path)

    def test_a_memory_of_another_version_costs_no_motion(self, path, monkeypatch):
        from mjrock.distinct import memory

        found = answer("mortar")
        found.save(path)
        fewer = memory.NamedTuple("Memory", [("structure", object)])
        monkeypatch.setattr(memory, "Memory", fewer)
        with pytest.warns(UserWarning, match=r"end\.memory is of the class .* goes? on from its end"):
            read = mr.load(path)
        assert read == found
        assert read.end.memory is None
        np.testing.assert_array_equal(read.end.pose, found.end.pose)


def test_without_h5py_the_error_names_it(path, monkeypatch):
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(ImportError, match="pip install h5py"):
        answer("theory").save(path)
    assert not path.exists()


SCRIPT = """
import sys, numpy as np, mjrock as mr
one = mr.load(sys.argv[1])
print(one.pose.tobytes().hex()[-64:], one.end.pose.tobytes().hex(), one.case.masonry.joints[0].name, one.outcome.value)
"""


@pytest.mark.slow
@pytest.mark.parametrize("kernel", ["Haswell", "Nehalem", "SkylakeX"])
def test_a_fresh_process_reads_it_on_any_kernel(path, kernel):
    found = answer("in space")
    found.save(path)
    environment = os.environ | {"OPENBLAS_CORETYPE": kernel}
    printed = subprocess.run(
        [sys.executable, "-c", SCRIPT, path], capture_output=True, text=True, check=True, env=environment
    ).stdout
    expected = found.pose.tobytes().hex()[-64:], found.end.pose.tobytes().hex()
    assert printed.split()[:2] == list(expected)
