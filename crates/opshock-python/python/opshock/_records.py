"""Makes immutable objects of JSON answers, by the types of their attributes."""

import dataclasses
import enum
import functools
import types
import typing
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

T = TypeVar("T")


Converter = Callable[[Any], Any]


@functools.cache
def _attributes(cls: type) -> list[tuple[str, Converter | None]]:
    """Attributes of a dataclass with what converts their JSON values: found once, since that takes longer than a record."""
    hints = typing.get_type_hints(cls)
    return [(field.name, _converter(hints[field.name])) for field in dataclasses.fields(cls)]


def record(cls: type[T], values: Mapping[str, Any]) -> T:
    """A dataclass of a JSON object; keys without an attribute are left out."""
    attributes = _attributes(cls)  # type: ignore[arg-type]
    own = {name: convert(values[name]) if convert else values[name] for name, convert in attributes if name in values}
    if len(own) < len(attributes):
        return cls(**own)
    # What its initialiser would do, attribute by attribute, since it is frozen.
    made = object.__new__(cls)
    made.__dict__.update(own)
    return made


def _converter(kind: Any) -> Converter | None:
    """What makes a value of this type of its JSON; ``None`` where it is the JSON value itself."""
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if origin in (types.UnionType, typing.Union):
        kinds = [one for one in inner if one is not type(None)]
        listed = [one for one in kinds if typing.get_origin(one) is tuple] or kinds
        of_list, of_other = _each(listed[0]), _each(kinds[0])
        return lambda value: of_list(value) if isinstance(value, list) else of_other(value)
    if origin is tuple:
        convert = _each(inner[0])
        return lambda value: None if value is None else tuple(map(convert, value))
    if origin in (Mapping, dict):
        convert = _each(inner[1])
        return lambda value: None if value is None else types.MappingProxyType({key: convert(one) for key, one in value.items()})
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        return lambda value: record(kind, value) if isinstance(value, Mapping) else value
    if isinstance(kind, type) and issubclass(kind, enum.Enum):
        return lambda value: None if value is None else kind(value)
    return None


def _each(kind: Any) -> Converter:
    return _converter(kind) or (lambda value: value)
