#!/usr/bin/env python3
"""Writes the book's page of every public name of the package, with types and docstrings, from its sources:

crates/opshock-python/generate_reference.py > docs/python-reference.md
"""

import ast
import inspect
import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent / "python/opshock"
HEAD = """# Python: every name

Made by `crates/opshock-python/generate_reference.py` from the package's docstrings. Names end in their units: `_g` in
multiples of standard gravity, all others in SI units unless they say so. Names of results are those of `--json` ([files](files.md)).
How the parts work together: [Python](python.md).
"""

# Classes that a user makes; the program makes the others.
MADE_BY_USERS = ("Search", "Study")


def text(docstring):
    """A docstring as Markdown: roles of Sphinx as code, double backquotes as single ones."""
    plain = re.sub(r":\w+:`~?([^`]+)`", r"`\1`", inspect.cleandoc(docstring or ""))
    return plain.replace("``", "`")


def row(name, kind, about):
    """A row of the table of attributes; a bar would end its cell."""
    cells = (f"`{name}`", f"`{kind}`".replace(" | ", " or "), " ".join(text(about).split()).replace("|", "\\|"))
    return f"| {' | '.join(cells)} |"


def call(function):
    """A function as it is called."""
    own = ast.unparse(function.args).removeprefix("self, ").removeprefix("self").removeprefix("cls, ")
    return f"{function.name}({own})"


def members(cls):
    """Rows of attributes with the string behind each, and of properties; then the methods."""
    attributes, methods = [], []
    for one, after in zip(cls.body, [*cls.body[1:], None], strict=True):
        is_explained = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        if isinstance(one, ast.AnnAssign) and is_explained:
            attributes.append(row(one.target.id, ast.unparse(one.annotation), after.value.value))
        elif isinstance(one, ast.Assign) and is_explained:
            attributes.append(row(one.targets[0].id, cls.name, after.value.value))
        elif isinstance(one, ast.FunctionDef) and one.name == "__init__" and cls.name in MADE_BY_USERS:
            methods.append(f"- `{cls.name}({call(one).removeprefix('__init__(')}` makes one.")
        elif isinstance(one, ast.FunctionDef) and not one.name.startswith("_"):
            if any(ast.unparse(mark) == "property" for mark in one.decorator_list):
                attributes.append(row(one.name, ast.unparse(one.returns), ast.get_docstring(one)))
            else:
                about = text(ast.get_docstring(one)).replace("\n", "\n  ").replace("\n  \n", "\n\n")
                methods.append(f"- `{call(one)}` → `{ast.unparse(one.returns)}`. {about}")
    return attributes, methods


def entry(node):
    """The section of a class or function."""
    about = text(ast.get_docstring(node))
    if isinstance(node, ast.FunctionDef):
        return f"## {node.name}\n\n`{call(node)}` → `{ast.unparse(node.returns)}`\n\n{about}\n"
    attributes, methods = members(node)
    parts = [f"## {node.name}\n\n{about}\n"]
    if attributes:
        parts.append("\n".join(["| attribute | type | what |", "|---|---|---|", *attributes]) + "\n")
    if methods:
        parts.append("\n".join(methods) + "\n")
    return "\n".join(parts)


def main():
    """Prints the page."""
    trees = [ast.parse(file.read_text(encoding="utf-8")) for file in sorted(PACKAGE.glob("*.py"))]
    (names,) = (one.value for tree in trees for one in tree.body if isinstance(one, ast.Assign) and one.targets[0].id == "__all__")
    nodes = {one.name: one for tree in trees for one in tree.body if isinstance(one, ast.ClassDef | ast.FunctionDef)}
    own = [name for name in sorted(ast.literal_eval(names), key=str.lower) if name in nodes]
    print("\n".join([HEAD, *(entry(nodes[name]) for name in own)]).rstrip())


main()
