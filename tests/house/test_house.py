"""The rules of the house: imports run down its floors, solvers do not know each other, and pieces are short."""

import ast
from functools import cache
from pathlib import Path

import pytest

import mjrock

ROOT = Path(mjrock.__file__).parent
FLOORS = (
    ("_version", "interrupts", "patience"),
    ("stored",),
    ("compiled", "files", "method", "quantities"),
    ("geometry", "linear"),
    ("problem.ground",),
    ("problem.wall",),
    ("problem.damping",),
    ("problem.masonry",),
    ("scene",),
    ("result",),
    ("theory", "reference", "distinct", "engine"),
    ("anymodel",),
    ("study",),
    ("plotting",),
    ("reporting",),
    ("__main__",),
)
"""From the ground up. Rooms of one floor do not import each other."""
FLOOR = {room: height for height, rooms in enumerate(FLOORS) for room in rooms}
WITHOUT_MUJOCO = ("geometry", "problem", "scene", "result", "theory", "reference", "distinct")
LONGEST_FUNCTION, MOST_ARGUMENTS = 60, 7
NUMERICS = ("linear.py", "geometry", "scene", "engine", "distinct", "theory", "reference")
MODULES = [path for path in sorted(ROOT.rglob("*.py")) if path.name != "__init__.py"]


def room(name):
    """The room of a module, with a dot where it is one within another."""
    parts = name.split(".")
    return ".".join(parts[: 2 if parts[0] == "problem" else 1])


@cache
def imports(path):
    """Modules of the package that a module imports, as names below the package, and all others that it imports."""
    own, others, here = [], [], path.relative_to(ROOT).with_suffix("").parts
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = here[: len(here) - node.level]
            own.append(".".join((*base, *(node.module or "").split("."))).strip("."))
        elif isinstance(node, ast.Import | ast.ImportFrom):
            others += [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""]
    return own, others


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_run_down(path):
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
    own, others = imports(path)
    for target in own:
        if room(target) != room(name):
            assert FLOOR[room(target)] < FLOOR[room(name)], f"{name} imports {target}"
    if name.split(".")[0] in WITHOUT_MUJOCO:
        assert not [module for module in others if module.split(".")[0] == "mujoco"]


def test_no_circle():
    """Modules can be put into a row in which each imports only those before it."""
    names = {".".join(path.relative_to(ROOT).with_suffix("").parts): path for path in MODULES}
    waits = {name: {target for target in imports(path)[0] if target in names} for name, path in names.items()}
    while waits:
        free = [name for name, targets in waits.items() if not targets & waits.keys()]
        assert free, f"these import each other: {sorted(waits)}"
        for name in free:
            del waits[name]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_functions_are_short(path):
    numerics = path.relative_to(ROOT).parts[0] in NUMERICS
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef):
            described = ast.get_docstring(node, clean=False)
            lines = node.end_lineno - node.lineno + 1 - (described.count("\n") + 1 if described else 0)
            assert lines <= LONGEST_FUNCTION, f"{node.name} has {lines} lines beside its docstring"
            arguments = [argument for argument in node.args.args if argument.arg not in ("self", "cls")]
            assert not numerics or len(arguments) <= MOST_ARGUMENTS, f"{node.name} takes {len(arguments)} arguments"


def test_few_ask_whether_a_case_is_of_a_wall_or_of_masonry():
    """A case answers for itself. It is asked which it is at the doors alone, where a class for it is chosen."""
    kinds, doors = {"Case", "MasonryCase", "Masonry"}, []
    for path in MODULES:
        for node in ast.walk(ast.parse(path.read_text())):
            asks = isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "issubclass")
            if asks and {one.id for one in ast.walk(node.args[1]) if isinstance(one, ast.Name)} & kinds:
                doors.append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert 1 < len(doors) <= 8, doors


def test_no_name_stands_twice_in_the_explicit_steps():
    """There is one text for the plane and for space."""
    modules = [path for path in MODULES if path.relative_to(ROOT).parts[0] == "distinct"]
    defined = [
        node.name
        for path in modules
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name != "__init__"
    ]
    assert len(modules) > 10
    assert sorted(defined) == sorted(set(defined))
