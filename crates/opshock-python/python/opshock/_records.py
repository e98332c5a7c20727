"""Makes immutable objects of JSON answers, by the types of their attributes."""

import dataclasses
import enum
import functools
import types
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

T = TypeVar("T")


@functools.cache
def _types(cls: type) -> list[tuple[str, Any]]:
    """Attributes of a dataclass with their types: found once, since that takes longer than a record."""
    hints = typing.get_type_hints(cls)
    return [(field.name, hints[field.name]) for field in dataclasses.fields(cls)]


def record(cls: type[T], values: Mapping[str, Any]) -> T:
    """A dataclass of a JSON object; keys without an attribute are left out."""
    return cls(**{name: _value(kind, values[name]) for name, kind in _types(cls) if name in values})  # type: ignore[arg-type]


def _value(kind: Any, value: Any) -> Any:
    if value is None:
        return None
    if typing.get_origin(kind) in (types.UnionType, typing.Union):
        kinds = [one for one in typing.get_args(kind) if one is not type(None)]
        if isinstance(value, list):
            kinds = [one for one in kinds if typing.get_origin(one) is tuple] or kinds
        return _value(kinds[0], value)
    if typing.get_origin(kind) is tuple:
        return tuple(_value(typing.get_args(kind)[0], one) for one in value)
    if typing.get_origin(kind) in (Mapping, dict):
        return types.MappingProxyType({key: _value(typing.get_args(kind)[1], one) for key, one in value.items()})
    if isinstance(kind, type) and dataclasses.is_dataclass(kind) and isinstance(value, Mapping):
        return record(kind, value)
    if isinstance(kind, type) and issubclass(kind, enum.Enum):
        return kind(value)
    return value
