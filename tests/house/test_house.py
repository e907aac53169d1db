"""The rules of the house: imports run down its floors, solvers do not know each other, and pieces are short."""

import ast
import re
import sys
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from trees import nodes, tree

import mjrock
from mjrock import contacts

ROOT = Path(mjrock.__file__).parent
FLOORS = (
    ("contacts",),
    ("machine", "notice", "toml_text"),
    ("_version", "bars", "command_line", "background_compilation", "deprecation", "interrupts", "notebook"),
    ("loop_cache",),
    ("compiled", "compiler", "method", "quantities"),
    ("geometry", "linear", "rows"),
    ("problem.ground",),
    ("problem.wall",),
    ("problem.damping",),
    ("problem.masonry",),
    ("blocks",),
    ("scene",),
    ("result",),
    ("theory", "reference", "distinct", "engine"),
    ("study",),
    ("plotting",),
    ("reporting",),
    ("assessment",),
    ("commands",),
    ("app",),
    ("__main__",),
)
"""From the ground up. Rooms of one floor do not import each other."""
FOLDERS = ("blocks", "laws", "builders", "files")
"""Folders of masonry from the ground up. They know nothing of the modules beside them."""
FLOOR = {room: height for height, rooms in enumerate(FLOORS) for room in rooms}
WITHOUT_MUJOCO = ("geometry", "problem", "scene", "result", "theory", "reference", "distinct")
LONGEST_FUNCTION, MOST_ARGUMENTS = 60, 7
NUMERICS = ("linear.py", "geometry", "scene", "engine", "distinct", "theory", "reference")
MODULES = [path for path in sorted(ROOT.rglob("*.py")) if path.name != "__init__.py"]


def room(name):
    """The room of a module, with a dot where it is one within another."""
    parts = name.split(".")
    return ".".join(parts[: 2 if parts[0] == "problem" else 1])


def test_every_module_stands_in_the_list_of_folders():
    table = (ROOT.parent / "docs" / "how_it_works.md").read_text("utf-8")
    rows = dict(re.findall(r"^\| `([\w/]+)` \| .*? \| (.*) \|$", table, re.MULTILINE))
    within = [path.relative_to(ROOT) for path in MODULES if path.parent != ROOT and not path.stem.startswith("_")]
    unlisted = [path.as_posix() for path in within if f"`{path.stem}`" not in rows.get(path.parent.as_posix(), "")]
    assert {Path(path).parent.as_posix() for path in unlisted} == {"commands", "examples"}


@cache
def imports(path):
    """Modules of the package that a module imports, by their text too, as names below it, and all others."""
    own, others, here = [], [], path.relative_to(ROOT).with_suffix("").parts
    for node in nodes(path):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = here[: len(here) - node.level]
            own.append(".".join((*base, *(node.module or "").split("."))).strip("."))
        elif isinstance(node, ast.Import | ast.ImportFrom):
            others += [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""]
        elif isinstance(node, ast.Call) and "import_module" in (
            getattr(node.func, "attr", ""),
            getattr(node.func, "id", ""),
        ):
            text = getattr(node.args[0], "value", "")
            own += [text.partition(".")[2]] if str(text).startswith(f"{ROOT.name}.") else []
    return own, others


def test_imports_run_down():
    offenders = []
    for path in MODULES:
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        own, others = imports(path)
        across = [target for target in own if room(target) != room(name)]
        offenders += [f"{name} imports {target}" for target in across if FLOOR[room(target)] >= FLOOR[room(name)]]
        if name.split(".")[0] in WITHOUT_MUJOCO:
            offenders += [f"{name} imports {module}" for module in others if module.split(".")[0] == "mujoco"]
    assert offenders == []


def test_contacts_stand_alone():
    """They are also a package of their own, which brings MuJoCo and NumPy alone; the public names that they share with
    the whole are the same objects, and none is hidden by a folder."""
    paths = [path for path in MODULES if path.relative_to(ROOT).parts[0] == "contacts"]
    assert len(paths) > 12
    for path in [*paths, ROOT / "contacts" / "__init__.py"]:
        own, others = imports(path)
        assert [name for name in own if room(name) != "contacts"] == [], path
        known = {"mujoco", "numpy", *sys.stdlib_module_names}
        known |= {"matplotlib"} if path.stem == "measurement" else set()  # its picture, where that is installed
        assert [name for name in others if name.split(".")[0] not in known] == [], path
    assert set(contacts.HOME) == set(contacts.__all__)
    shared = set(contacts.__all__) & set(mjrock.__all__)
    assert len(shared) > 10
    assert [name for name in shared if getattr(contacts, name) is not getattr(mjrock, name)] == []
    assert {path.stem for path in paths} & set(contacts.__all__) == set()
    assert {path.name for path in ROOT.iterdir()} & set(mjrock.__all__) == set()


def test_folders_of_masonry_stand_on_each_other():
    offenders = []
    for height, folder in enumerate(FOLDERS):
        for path in sorted((ROOT / "problem" / "masonry" / folder).glob("*.py")):
            within = [name for name in imports(path)[0] if name.startswith("problem.masonry.")]
            below = tuple(f"problem.masonry.{name}." for name in FOLDERS[: height + 1])
            offenders += [f"{folder}/{path.stem} imports {name}" for name in within if not name.startswith(below)]
    assert offenders == []


def test_no_circle():
    """Modules can be put into a row in which each imports only those before it."""
    names = {".".join(path.relative_to(ROOT).with_suffix("").parts): path for path in MODULES}
    waits = {name: {target for target in imports(path)[0] if target in names} for name, path in names.items()}
    while waits:
        free = [name for name, targets in waits.items() if not targets & waits.keys()]
        assert free, f"these import each other: {sorted(waits)}"
        for name in free:
            del waits[name]


@pytest.mark.parametrize("solver", ["engine", "distinct"])
def test_solvers_take_scenes_and_know_no_blocks(solver):
    """What they need of a wall or of masonry is in the scene."""
    paths = [path for path in MODULES if path.relative_to(ROOT).parts[0] == solver]
    blocks = {"problem.wall.block", "problem.masonry.masonry"}
    blocks |= {f"problem.masonry.blocks.{name}" for name in ("polygon", "polyhedron", "compound")}
    assert [f"{path.name} imports {target}" for path in paths for target in blocks & set(imports(path)[0])] == []
    assert len(paths) > 20


def test_functions_are_short():
    offenders = []
    for path in MODULES:
        name = path.relative_to(ROOT)
        for node in nodes(path):
            if isinstance(node, ast.FunctionDef):
                described = ast.get_docstring(node, clean=False)
                lines = node.end_lineno - node.lineno + 1 - (described.count("\n") + 1 if described else 0)
                arguments = [argument for argument in node.args.args if argument.arg not in ("self", "cls")]
                if lines > LONGEST_FUNCTION:
                    offenders.append(f"{name}: {node.name} has {lines} lines beside its docstring")
                if name.parts[0] in NUMERICS and len(arguments) > MOST_ARGUMENTS:
                    offenders.append(f"{name}: {node.name} takes {len(arguments)} arguments")
    assert offenders == []


SOLVES = re.compile(r"simulate|solve_\w+|push|pushover|collapse_multiplier|campaign|ida|masonry_scene|sensitivity")
"""Public functions that solve."""


def called_at_import(node):
    """Names of the functions that a module calls as it is imported: none of a body of a function that it defines."""
    inside = [node]
    while inside:
        node = inside.pop()
        if isinstance(node, ast.Call):
            yield getattr(node.func, "attr", getattr(node.func, "id", ""))
        if isinstance(node, ast.FunctionDef):
            inside += [*node.decorator_list, *node.args.defaults, *filter(None, node.args.kw_defaults)]
        elif not isinstance(node, ast.Lambda):
            inside += ast.iter_child_nodes(node)


def without_bodies(text):
    """A module without the bodies of its functions, which need not be parsed."""
    parts = re.split(r"^(?=\S)", text, flags=re.MULTILINE)
    return "".join(part.partition(":\n")[0] if part.startswith("def ") else part for part in parts)


def test_nothing_is_solved_as_tests_are_collected():
    """Each process that runs a share of the tests collects all of them."""
    paths = [*ROOT.parent.glob("tests/**/*.py"), *ROOT.parent.glob("scripts/**/*.py")]
    assert len(paths) > 200
    some = [path for path in paths if SOLVES.search(without_bodies(path.read_text(encoding="utf-8")))]
    calls = ((path.name, name) for path in some for name in called_at_import(tree(path)))
    assert [f"{path} calls {name}" for path, name in calls if SOLVES.fullmatch(name)] == []
    text = "X = [lambda: mr.simulate(case)]\nfor x in f(mr.push()): pass\ndef g(): mr.solve_explicit(1)\n"
    assert [name for name in called_at_import(ast.parse(text)) if SOLVES.fullmatch(name)] == ["push"]
    assert SOLVES.findall(without_bodies("def f(a=mr.ida()):\n    mr.push()\nmr.simulate()\n")) == ["ida", "simulate"]


def test_modules_of_tests_have_names_of_their_own():
    """Folders of tests are no packages, and Python imports one module of a name."""
    paths = ROOT.parent.glob("tests/**/*.py")
    names = Counter(path.name for path in paths if path.stem not in ("conftest", "__main__"))
    assert len(names) > 100
    assert [name for name, count in names.items() if count > 1] == []


def test_few_ask_whether_a_case_is_of_a_wall_or_of_masonry():
    """A case answers for itself. It is asked which it is at the doors alone, where a class for it is chosen."""
    kinds, doors = {"Case", "MasonryCase", "Masonry"}, []
    for path in MODULES:
        for node in nodes(path):
            asks = isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "issubclass")
            if asks and {one.id for one in ast.walk(node.args[1]) if isinstance(one, ast.Name)} & kinds:
                doors.append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert 1 < len(doors) <= 8, doors


def test_no_name_stands_twice_in_the_explicit_steps():
    """There is one text for the plane and for space. Kinds of links have methods of one name."""
    modules = [path for path in MODULES if path.relative_to(ROOT).parts[0] == "distinct"]
    defined = [
        node.name for path in modules for node in tree(path).body if isinstance(node, ast.FunctionDef | ast.ClassDef)
    ]
    assert len(modules) > 10
    assert sorted(defined) == sorted(set(defined))


def test_a_constant_has_a_name_of_its_own():
    """In no other module of the package does this name mean something else; modules of pictures, reports, theory, limit
    analysis, pushes and steps in MuJoCo are compared with the others alone."""
    named = {}
    for path in MODULES:
        for node in tree(path).body:
            targets = {ast.Assign: lambda n: n.targets, ast.AnnAssign: lambda n: [n.target]}.get(
                type(node), lambda n: []
            )
            for one in (x for target in targets(node) for x in ast.walk(target)):
                if isinstance(one, ast.Name) and one.id.isupper():
                    named.setdefault(one.id, []).append(str(path.relative_to(ROOT)))
    core = ("geometry", "scene", "result", "distinct", "problem", "reference", "contacts", "study/campaign")
    core += ("study/matching", "study/intensity")
    apart = "problem/masonry/limit", "contacts/checks"
    shared = {
        name: where
        for name, where in named.items()
        if len(where) > 1 and any(one.startswith(core) and not one.startswith(apart) for one in where)
    }
    assert len(named) > 100
    assert shared == {}


def test_compiled_functions_give_tuples_every_field():
    """numba makes a NamedTuple of what it is given: a field with a default that is left out is not there, and whoever
    reads it gets an error that names no module."""
    fields, calls = {}, []
    for path in MODULES:
        for node in nodes(path):
            if isinstance(node, ast.ClassDef) and "NamedTuple" in [getattr(base, "id", "") for base in node.bases]:
                fields.setdefault(node.name, set()).add(sum(isinstance(each, ast.AnnAssign) for each in node.body))
            marks = {getattr(mark, "id", "") for mark in getattr(node, "decorator_list", ())}
            if marks & {"compiled", "compiled_at_once", "inlined"}:
                calls += [(path, call) for call in ast.walk(node) if isinstance(call, ast.Call)]
    made = [(path, call) for path, call in calls if getattr(call.func, "id", "") in fields]
    assert [
        f"{path.relative_to(ROOT)}:{call.lineno}: {call.func.id} leaves out fields"
        for path, call in made
        if len(call.args) + len(call.keywords) not in fields[call.func.id]
    ] == []
    assert len(made) > 25
