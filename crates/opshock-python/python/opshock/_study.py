"""Studies and scenes."""

from __future__ import annotations

import json
import math
import sys
import types
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import FrozenInstanceError
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, Self

from . import _html, _native
from ._records import record

if TYPE_CHECKING:
    from ._keys import Study as _Settings
else:
    # Their classes take a third of the package's import, and are made when a setting is first read.
    _Settings = object


class OpshockWarning(UserWarning):
    """Something in a study is doubtful: the code, and what is doubtful."""


def _text(text: str) -> str:
    """A text as TOML writes it."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def _toml_value(value: Any) -> str:
    """A value as TOML writes it."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, (str, PathLike)):
        return _text(fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_text(str(key))} = {_toml_value(one)}" for key, one in value.items()) + " }"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return "[" + ", ".join(_toml_value(one) for one in value) + "]"
    raise TypeError(f"{value!r}: a study holds numbers, words, truth values, lists and tables")


def _callers_level() -> int:
    """Level of the line outside of this package that is at work, as ``warnings.warn`` counts it from the caller."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and Path(frame.f_code.co_filename).parent == Path(__file__).parent:
        level, frame = level + 1, frame.f_back
    return level


def _settings(settings: Mapping[str, Any] | None) -> list[str]:
    return [f"{key}={_toml_value(value)}" for key, value in (settings or {}).items()]


class Study(_Settings):
    """A study: a drive, its shocks, and how the critical shock of each is searched.

    The same as a study file in every respect. Its settings are attributes, with the unit in the name:
    ``study.disk.thickness_mm``, with every default filled in; a setting with several values is an axis and gives a tuple.
    A study never changes: :meth:`with_settings` gives another one.
    """

    _study: _native.Study

    def __init__(self, path: str | PathLike[str], settings: Mapping[str, Any] | None = None) -> None:
        """Reads a study file (TOML), with ``settings`` laid over it: ``{"disk.thickness_mm": 0.5}``."""
        self._take(_native.Study.read(path, _settings(settings)))

    @classmethod
    def from_toml(cls, text: str, *, folder: str | PathLike[str] = "") -> Self:
        """Reads the text of a study file; ``folder`` is where relative names of files in it start."""
        return cls._of(_native.Study.parse(text, f"{fspath(folder)}/study.toml" if fspath(folder) else "study.toml", []))

    @classmethod
    def from_dict(cls, settings: Mapping[str, Any], *, folder: str | PathLike[str] = "") -> Self:
        """A study of nested dictionaries: ``{"name": "mine", "disk": {"rpm": 5400.0}, ...}``."""
        lines = [f"{_text(str(key))} = {_toml_value(value)}\n" for key, value in {"study_format": 2, **settings}.items()]
        return cls.from_toml("".join(lines), folder=folder)

    @classmethod
    def example(cls, name: str = "my drive") -> Self:
        """The drive to start from: what ``opshock new`` prints."""
        return cls.from_toml(_native.Study.example(name))

    @classmethod
    def _of(cls, native: _native.Study) -> Self:
        study = cls.__new__(cls)
        study._take(native)
        return study

    def _take(self, native: _native.Study) -> None:
        described = json.loads(native.described())
        own = self.__dict__
        own["_study"] = native
        own["_described"] = described
        own["_toml"] = native.resolved_toml()
        for remark in described["remarks"]:
            if remark["code"].startswith("W"):
                message = f"{remark['code']}: {remark['key']} = {remark['value']}: {remark['message']}"
                warnings.warn(message, OpshockWarning, stacklevel=_callers_level())

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            own = self.__dict__
            if not name.startswith("_") and "_toml" in own and "name" not in own:
                import tomllib

                from . import _keys

                own.update(vars(record(_keys.Study, tomllib.loads(own["_toml"]))))
                return getattr(self, name)
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

        def __dir__(self) -> list[str]:
            _ = self.name
            return sorted({*super().__dir__(), *self.__dict__})

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return bool(self.__dict__["_toml"] == other.__dict__["_toml"])

    def __hash__(self) -> int:
        return hash(self.__dict__["_toml"])

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self._study.parts())

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise FrozenInstanceError(f"cannot assign to {name!r}: with_settings() gives another study")

    def __delattr__(self, name: str) -> NoReturn:
        raise FrozenInstanceError(f"cannot delete {name!r}")

    @property
    def digest(self) -> str:
        """Digest of every setting: two studies with the same one have the same answers."""
        return str(self.__dict__["_described"]["digest"])

    @property
    def axes(self) -> Mapping[str, str]:
        """Axes beside ramp model, pulse width and sign: the column in tables, and the key."""
        return types.MappingProxyType(self.__dict__["_described"]["axes"])

    @property
    def points(self) -> tuple[str, ...]:
        """Labels of the points, in the order of tables: ``"rigid 2 ms +"``."""
        return tuple(point["label"] for point in self.__dict__["_described"]["points"])

    @property
    def toml(self) -> str:
        """The study as a study file, with every default written out."""
        return str(self.__dict__["_toml"])

    def with_settings(self, settings: Mapping[str, Any]) -> Self:
        """The same study with other values: ``study.with_settings({"ramp.clearance_um": 60.0})``."""
        return self._of(self._study.changed(_settings(settings)))

    def scene(
        self,
        *,
        ramp: str | None = None,
        pulse_ms: float | None = None,
        sign: str | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> Scene:
        """The scene of one point: ramp model (``none``, ``rigid``, ``deformable``), pulse width in ms, sign (``+``, ``-``).

        What has one value in the study need not be named; width and ramp need not be among the study's. ``settings`` chooses
        values of further axes, and changes whatever else.
        """
        native = self._study.changed(_settings(settings)) if settings else self._study
        return Scene._of(native.chosen(ramp, pulse_ms, sign))

    def scenes(self) -> tuple[Scene, ...]:
        """The scene of every point, in the order of tables."""
        paths, scenes = self.axes, []
        for point in self.__dict__["_described"]["points"]:
            settings = {paths[column]: value for column, value in point["axes"].items()}
            scene = self.scene(ramp=point["ramp"], pulse_ms=point["pulse_ms"], sign=point["sign"], settings=settings)
            scene.__dict__["_label"] = point["label"]
            scenes.append(scene)
        return tuple(scenes)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r}, {len(self.points)} points>"

    def _repr_html_(self) -> str:
        axes = list(self.axes)
        rows = [[p["ramp"], p["pulse_ms"], p["sign"], *(p["axes"][axis] for axis in axes)] for p in self.__dict__["_described"]["points"]]
        return _html.table(f"{self.name}: {len(rows)} points", ["ramp", "pulse_ms", "sign", *axes], rows)


def _restored(kind: type[Study], parts: tuple[str, str, str | None, list[str]]) -> Study:
    """A study that was copied or came from another process."""
    return kind._of(_native.Study.restored(*parts))


def only_point(study: Study) -> None:
    """Refuses a study that is no scene."""
    if len(study.points) != 1:
        axes = ", ".join(study.axes.values()) or "ramp.models, pulse.widths_ms, pulse.signs"
        raise ValueError(f"a scene is one point, here are {len(study.points)}: choose one value of {axes}, as with study.scene()")


class Scene(Study):
    """A study of one point: all that a simulation needs but the amplitude."""

    def _take(self, native: _native.Study) -> None:
        super()._take(native)
        only_point(self)

    @property
    def label(self) -> str:
        """Name of the point: ``"rigid 2 ms +"``."""
        return str(self.__dict__.get("_label", self.points[0]))

    @property
    def ramp_model(self) -> str:
        """Ramp model: ``none``, ``rigid`` or ``deformable``."""
        return str(self.__dict__["_described"]["points"][0]["ramp"])

    @property
    def pulse_ms(self) -> float:
        """Width of the pulse, ms."""
        return float(self.__dict__["_described"]["points"][0]["pulse_ms"])

    @property
    def sign(self) -> str:
        """Sign of the shock: ``+`` moves the disk towards the slider first."""
        return str(self.__dict__["_described"]["points"][0]["sign"])

    def __repr__(self) -> str:
        return f"<Scene {self.name!r}: {self.label}>"
