"""Write `constructors.pyi`: what editors and type checkers know of the class methods that build masonry.

python tests/house/stubs.py
"""

import ast
import inspect
import subprocess
import sys
import textwrap
from collections import defaultdict
from importlib.util import resolve_name
from pathlib import Path

from mjrock.problem.masonry import constructor, constructors
from mjrock.problem.masonry.files import bodies

STUB = Path(constructors.__file__).with_suffix(".pyi")
HEAD = '"""The class methods that build masonry, as `python tests/house/stubs.py` writes them."""\n\n'


def homes(module):
    """The module that each name of a module comes from."""
    found = defaultdict(lambda: module.__name__)
    for node in ast.parse(Path(module.__file__).read_text()).body:
        if isinstance(node, ast.ImportFrom):
            home = resolve_name("." * node.level + node.module, module.__package__) if node.level else node.module
            found |= {each.name: home for each in node.names}
    return found


def spelt(parameters):
    """Parameters as they are written, with a star before those that are keywords alone."""
    starred = False
    for one in parameters:
        if one.kind is one.KEYWORD_ONLY and not starred:
            starred = True
            yield "*"
        stars = "**" if one.kind is one.VAR_KEYWORD else ""
        hint = f": {one.annotation}" if one.annotation is not one.empty else ""
        yield f"{stars}{one.name}{hint}" + (f" = {one.default!r}" if one.default is not one.empty else "")


def stub():
    """The text of the stub."""
    sources = [
        inspect.getmodule(function) for function in (*constructors.BUILDERS.values(), *constructors.READERS.values())
    ]
    known = {}
    for module in (*sources, bodies, constructor):
        own = homes(module)
        known = {name: own[name] for name in vars(module)} | known
    body, used = "", {"Self"}
    for name, member in vars(constructors.Constructors).items():
        if isinstance(member, classmethod):
            parameters = inspect.signature(member.__func__).parameters.values()
            doc = textwrap.indent(inspect.getdoc(member.__func__), " " * 8).strip()
            body += f"    @classmethod\n    def {name}({', '.join(spelt(parameters))}) -> Self:\n"
            body += f'        """{doc}\n        """\n\n'
            hints = [one.annotation for one in parameters if one.annotation is not one.empty]
            used |= {node.id for hint in hints for node in ast.walk(ast.parse(hint)) if isinstance(node, ast.Name)}
    taken = "".join(f"from {known[name]} import {name}\n" for name in sorted(used) if name in known)
    text = f'{HEAD}{taken}\nclass Constructors:\n    """{inspect.getdoc(constructors.Constructors)}"""\n\n{body}'
    for command in (["check", "--select", "I", "--fix"], ["format"]):
        ruff = [sys.executable, "-m", "ruff", *command, "--quiet", "--stdin-filename", str(STUB), "-"]
        text = subprocess.run(ruff, input=text, capture_output=True, text=True, check=True).stdout
    return text


if __name__ == "__main__":
    STUB.write_text(stub())
