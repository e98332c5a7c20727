"""Every public name is documented, says its unit, and is used in a test."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import opshock
import pytest
from opshock import _native

TESTS = Path(__file__).parent
SOURCE = TESTS.parent / "python" / "opshock"
MODULES = sorted(path for path in SOURCE.glob("_*.py") if path.name not in ("__init__.py", "__main__.py", "_keys.py"))

UNITS = re.compile(r"_(g|m|s|ms|pct|rad|n|j|pa|n_s|n_s_m)$")

# Floats without a unit, and the words of their docstring that say what they are a share or factor of.
PURE = {
    "Mechanism.dimple_over_steady": "dimensionless",
    "Mechanism.bearing_over_steady": "dimensionless",
    "Mechanism.bearing_range_over_steady": "dimensionless",
    "Energy.closure": "a share of the largest H",
    "Contribution.factor": "Safety factor",
}
PURE |= {f"{owner}.momentum_closure": "a share of the largest momentum" for owner in ("Hub", "Base")}
# Of the study's further axes: the name of each ends in the unit.
PURE |= {"CriticalShock.axes": "in the unit that the name of each ends in"}
# A method whose name is a verb.
PURE |= {"Search.ask": "multiples of standard gravity"}


def definitions() -> dict[str, ast.ClassDef | ast.FunctionDef]:
    """Every class and function at the top of a module, by name."""
    found: dict[str, ast.ClassDef | ast.FunctionDef] = {}
    for path in [*MODULES, SOURCE / "__init__.py"]:
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                found[node.name] = node
    return found


def public() -> dict[str, ast.ClassDef | ast.FunctionDef]:
    """Those of ``opshock.__all__``."""
    found = definitions()
    return {name: found[name] for name in opshock.__all__}


def methods(owner: ast.ClassDef) -> Iterator[ast.FunctionDef]:
    """Public methods and properties of a class."""
    for node in owner.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node


def fields(owner: ast.ClassDef) -> Iterator[tuple[str, str, str | None]]:
    """Public attributes of a class: name, type, and the string after it."""
    for node, after in zip(owner.body, [*owner.body[1:], None], strict=True):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            name, kind = node.target.id, ast.unparse(node.annotation)
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name, kind = node.targets[0].id, "constant"
        else:
            continue
        if not name.startswith("_"):
            text = after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else None
            yield name, kind, text if isinstance(text, str) else None


def arguments(function: ast.FunctionDef) -> Iterator[tuple[str, str]]:
    """Arguments of a function with their types."""
    named = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
    for one in [*named, *([function.args.kwarg] if function.args.kwarg else [])]:
        if one.annotation is not None:
            yield one.arg, ast.unparse(one.annotation)


def is_float(kind: str) -> bool:
    """Whether a type holds floats."""
    return re.search(r"\bfloat\b|\bArray\b", kind) is not None


def test_what_is_public_is_there() -> None:
    """``__all__`` is sorted, and names what the module has."""
    assert opshock.__all__ == sorted(set(opshock.__all__))
    assert all(hasattr(opshock, name) for name in opshock.__all__)
    others = {name for name in vars(opshock) if not name.startswith("_")} - set(opshock.__all__)
    assert others == set()


@pytest.mark.parametrize("name", opshock.__all__)
def test_every_name_has_a_docstring(name: str) -> None:
    """Functions, classes, public methods and properties, fields: one sentence at least."""
    node = public()[name]
    found: dict[str, str | None] = {name: ast.get_docstring(node)}
    if isinstance(node, ast.ClassDef):
        found |= {f"{name}.{method.name}": ast.get_docstring(method) for method in methods(node)}
        found |= {f"{name}.{field}": text for field, _, text in fields(node)}
    without = [key for key, text in found.items() if not text or not re.search(r"[.:]$", text.strip().splitlines()[0])]
    assert without == []


def test_the_source_is_what_runs() -> None:
    """The fields that the source shows are those of the classes."""
    for name, node in public().items():
        if isinstance(node, ast.ClassDef) and any("dataclass" in ast.unparse(one) for one in node.decorator_list):
            assert list(getattr(opshock, name).__dataclass_fields__) == [field for field, _, _ in fields(node)]


def test_every_float_says_its_unit() -> None:
    """By its name, or it is a listed share or factor whose docstring says of what."""
    seen: set[str] = set()
    wrong: list[str] = []
    checked = 0
    for name, node in public().items():
        found: list[tuple[str, str, str]] = []
        if isinstance(node, ast.FunctionDef):
            found += [(f"{name}.{one}", kind, "") for one, kind in arguments(node)]
        else:
            found += [(f"{name}.{one}", kind, text or "") for one, kind, text in fields(node)]
            # The arguments of select are coordinates: their names are columns, which end in units.
            own = [one for one in node.body if isinstance(one, ast.FunctionDef) and (one.name == "__init__" or one.name[0] != "_")]
            own = [one for one in own if one.name != "select"]
            for one in own:
                found += [(f"{name}.{argument}", kind, "") for argument, kind in arguments(one)]
                if is_float(ast.unparse(one.returns) if one.returns else ""):
                    found.append((f"{name}.{one.name}", "float", ast.get_docstring(one) or ""))
        for key, kind, text in found:
            if not is_float(kind):
                continue
            checked += 1
            if key in PURE and PURE[key] in text:
                seen.add(key)
            elif not UNITS.search(key):
                wrong.append(key)
    # A pair of scene and amplitude has no name of its own.
    assert wrong == ["simulate_many.shocks"]
    assert "multiples of standard gravity" in (opshock.simulate_many.__doc__ or "")
    assert seen == set(PURE), "no exception without need"
    assert checked > 60


def test_every_name_is_used_in_a_test() -> None:
    """Functions and classes, their public methods and properties."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in TESTS.glob("test_*.py") if path != Path(__file__))
    words = set(re.findall(r"\w+", text))
    names = set(opshock.__all__)
    for node in public().values():
        if isinstance(node, ast.ClassDef):
            names |= {method.name for method in methods(node)} | {field for field, _, _ in fields(node)}
    assert sorted(names - words) == []


def test_the_settings_are_made_of_the_schema() -> None:
    """``generate_keys.py`` of this program's schema writes ``_keys.py``, byte for byte."""
    generator = TESTS.parent / "generate_keys.py"
    made = subprocess.run([sys.executable, generator], input=_native.schema(), capture_output=True, text=True, check=True)
    assert made.stdout == (SOURCE / "_keys.py").read_text(encoding="utf-8")


def test_every_setting_says_what_it_is() -> None:
    """Of the schema: every number has a description and, unless it is a share, a count or a place, its unit in name or words."""
    tables = [json.loads(_native.schema())]
    described = 0
    while tables:
        for key, member in tables.pop().get("properties", {}).items():
            items = member.get("items", {})
            if "properties" in member or "properties" in items:
                tables.append(member if "properties" in member else items)
                continue
            assert key in ("$schema", "study_format") or len(member["description"]) > 10, key
            described += 1
            unit = re.search(r"In (\S.*?)\.(?: |$)", member["description"])
            if unit and unit[1] in ("mm", "ms", "nm", "Hz", "kHz", "mg", "GPa", "Pa"):
                suffix = unit[1].lower().replace("gpa", "gpa")
                assert re.search(rf"_{suffix}(_|$)|^(min|max|amplitude)|lines$", key), (key, unit[1])
    assert described > 150


def test_the_book_has_every_name_as_it_is_today() -> None:
    root = Path(__file__).resolve().parents[3]
    generator = root / "crates/opshock-python/generate_reference.py"
    done = subprocess.run([sys.executable, generator], check=True, capture_output=True, text=True)
    assert done.stdout == (root / "docs/python-reference.md").read_text(encoding="utf-8")
    for name in opshock.__all__:
        value = getattr(opshock, name)
        assert f"\n## {name}\n" in done.stdout or not callable(value), name
