"""Print how many lines of code each room of the package has, without docstrings, comments and blank lines.

python tests/house/count_lines.py [folder]
"""

import ast
import io
import sys
import tokenize
from collections import Counter
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "mjrock"
SILENT = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING}


def code_lines(path):
    """How many lines of a module hold code."""
    text = path.read_text()
    lines = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in SILENT and token.type != tokenize.ENDMARKER:
            lines.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):  # docstrings, also those below constants
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            lines -= set(range(node.lineno, node.end_lineno + 1))
    return len(lines)


def main():
    """Print the lines of the rooms, and of all of them."""
    package = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else PACKAGE
    rooms, files = Counter(), Counter()
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).parts
        if parts[0] == "examples":
            continue
        room = "/".join(parts[:-1]) or "."
        rooms[room] += code_lines(path)
        files[room] += 1
    for room, count in sorted(rooms.items()):
        print(f"{room:20} {files[room]:4} files {count:6} lines")
    print(f"{'all':20} {files.total():4} files {rooms.total():6} lines")


if __name__ == "__main__":
    main()
