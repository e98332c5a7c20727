"""Makes immutable objects of JSON answers, by the types of their attributes."""

import dataclasses
import enum
import types
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

T = TypeVar("T")


def record(cls: type[T], values: Mapping[str, Any]) -> T:
    """A dataclass of a JSON object; keys without an attribute are left out."""
    hints = typing.get_type_hints(cls)
    fields = dataclasses.fields(cls)  # type: ignore[arg-type]
    return cls(**{field.name: _value(hints[field.name], values[field.name]) for field in fields if field.name in values})


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
