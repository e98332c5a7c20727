"""Makes immutable objects of JSON answers, by the types of their attributes."""

import dataclasses
import enum
import functools
import types
import typing
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

T = TypeVar("T")


Converter = Callable[[Any], Any]


class _Attributes(NamedTuple):
    """What is known of a dataclass: found once, since that takes longer than a record."""

    names: frozenset[str]
    """Names of all attributes."""
    defaults: dict[str, Any]
    """Values of those that have a default."""
    converters: list[tuple[str, Converter]]
    """What makes an attribute of its JSON value, for those that are not the JSON value itself."""


@functools.cache
def _attributes(cls: type) -> _Attributes:
    hints = typing.get_type_hints(cls)
    fields = dataclasses.fields(cls)
    defaults = {field.name: field.default for field in fields if field.default is not dataclasses.MISSING}
    # Immutable, so that one serves all.
    defaults |= {field.name: field.default_factory() for field in fields if field.default_factory is not dataclasses.MISSING}
    converters = [(field.name, converter) for field in fields if (converter := _converter(hints[field.name]))]
    return _Attributes(frozenset(hints), defaults, converters)


def record(cls: type[T], values: Mapping[str, Any]) -> T:
    """A dataclass of a JSON object; keys without an attribute are left out."""
    names, defaults, converters = _attributes(cls)  # type: ignore[arg-type]
    own = {**defaults, **values}
    if own.keys() != names:
        own = {name: own[name] for name in names}
    for name, convert in converters:
        own[name] = convert(own[name])
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
        return lambda value: record(kind, value) if isinstance(value, dict) else value
    if isinstance(kind, type) and issubclass(kind, enum.Enum):
        return lambda value: None if value is None else kind(value)
    return None


def _each(kind: Any) -> Converter:
    return _converter(kind) or (lambda value: value)
