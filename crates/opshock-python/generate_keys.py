#!/usr/bin/env python3
"""Writes python/opshock/_keys.py, the typed settings of a study, from the JSON Schema of study files.

opshock schema | crates/opshock-python/generate_keys.py > crates/opshock-python/python/opshock/_keys.py
"""

import json
import sys

HEAD = '''"""Settings of a study, with their units. Made by generate_keys.py from `opshock schema`; not edited by hand."""

# ruff: noqa: E501
from dataclasses import dataclass, field
from typing import Any

# Of a setting that a study has only together with others.
MISSING: Any = None
'''


def scalar(schema):
    """Python type of a single value."""
    if "anyOf" in schema:
        return " | ".join(scalar(one) for one in schema["anyOf"])
    if "enum" in schema or schema.get("type") == "string":
        return "str"
    if schema.get("type") == "array":
        return f"tuple[{scalar(schema['items'])}, ...]"
    return {"number": "float", "integer": "int", "boolean": "bool"}[schema["type"]]


def kind(schema):
    """Python type of a setting: one value, several on an axis, or a list."""
    choices = schema.get("anyOf", [schema])
    lists = [one for one in choices if one.get("type") == "array"]
    plain = [one for one in choices if one.get("type") not in ("array", "object")]
    # A list of words may be written as one word, and is read as a list; an axis is never empty.
    if lists and "minItems" not in lists[0]:
        return scalar(lists[0])
    return " | ".join(scalar(one) for one in [*plain, *lists])


def is_given(schema):
    """Whether every study has something of this table: a setting that is required or has a default."""
    members = schema.get("properties", {})
    return any(key in schema.get("required", []) or "default" in one or is_given(one) for key, one in members.items())


def classes(schema, name, title, path, made):
    """Appends the class of a table, those of its tables first."""
    lines = []
    for key, member in sorted(schema["properties"].items()):
        if key in ("$schema", "study_format"):
            continue
        where = ".".join([*path, key])
        about = member.get("description", f"Settings `{where}`.")
        items = member.get("items", {})
        inner = "".join(part.title() for word in [*path, key] for part in word.split("_"))
        if "properties" in member:
            classes(member, inner, f"Settings `{where}`.", [*path, key], made)
            typed = f"{inner} = field(default_factory={inner})" if is_given(member) else f"{inner} | None = None"
        elif "properties" in items:
            classes(items, inner, f"An entry of `{where}`.", [*path, key], made)
            typed = f"tuple[{inner}, ...] = ()"
        elif "default" in member or key in schema.get("required", []):
            typed = f"{kind(member)} = MISSING"
        else:
            typed = f"{kind(member)} | None = None"
        lines += [f"    {key}: {typed}", f'    """{about}"""']
    made.append(f'\n\n@dataclass(frozen=True)\nclass {name}:\n    """{title}"""\n\n' + "\n".join(lines) + "\n")


def main():
    """Reads the schema, writes the module."""
    schema = json.load(sys.stdin)
    made = []
    classes(schema, "Study", "Settings of a study.", [], made)
    sys.stdout.write(HEAD + "".join(made))


main()
