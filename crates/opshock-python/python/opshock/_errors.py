"""Exceptions, each with the faults that ``opshock --json`` prints."""

import json
import re
from dataclasses import dataclass

from ._records import record


@dataclass(frozen=True)
class Fault:
    """One fault: what is wrong, where, and what would be valid."""

    code: str
    """Stable code, as ``E130``."""
    message: str
    """What is wrong, in a sentence."""
    file: str | None = None
    """File; ``settings`` for a setting."""
    line: int | None = None
    """Line in the file, from 1."""
    key: str | None = None
    """Key or argument."""
    value: str | None = None
    """Value found."""
    allowed: str | None = None
    """What would be valid."""
    hint: str | None = None
    """What to do."""


class OpshockError(Exception):
    """opshock could not do what it was asked."""

    faults: tuple[Fault, ...]
    """What is wrong, one by one."""

    def __init__(self, message: str, faults: tuple[Fault, ...] = ()) -> None:
        super().__init__(message)
        self.faults = faults


class StudyError(OpshockError, ValueError):
    """A study is not valid, or its scene has no answer."""


class ChoiceError(OpshockError, ValueError):
    """An argument does not name one point of a study, or is out of range."""


class StoreError(OpshockError, OSError):
    """A store is damaged, locked, of another study, or cannot be written."""

    def __str__(self) -> str:
        return str(self.args[0])


_BY_EXIT_CODE: dict[int, type[OpshockError]] = {2: ChoiceError, 3: StudyError, 6: StoreError}


def _in_python(text: str) -> str:
    """A message with arguments of Python for options of the command line."""
    text = re.sub(r"--accept ([EWN]\d+)", r'accept=["\1"]', text)
    text = re.sub(r"--set ([\w.]+)=VALUE", r'settings={"\1": VALUE}', text)
    text = re.sub(r"--set\b", "settings", text)
    text = re.sub(r"(?<![\w-])-j (\d+)", r"threads=\1", text)
    text = re.sub(r"(?<![\w-])-j\b", "threads", text)
    return re.sub(r"(?<!\w)--([a-z]+(?:-[a-z]+)*)", lambda found: found[1].replace("-", "_"), text)


def of(exit_code: int, message: str, faults: str) -> OpshockError:
    """The exception of a failure; called by the compiled half."""
    said = ("message", "allowed", "hint", "key")
    read = tuple(
        record(
            Fault, {key: _in_python(value) if value and (key in said or value == "--set") else value or None for key, value in one.items()}
        )
        for one in json.loads(faults)
    )
    kind = _BY_EXIT_CODE.get(exit_code, OpshockError)
    if kind is ChoiceError:
        parts = [[fault.message, fault.allowed and f"allowed: {fault.allowed}", fault.hint] for fault in read]
        message = "; ".join(", ".join(part for part in one if part) for one in parts)
    else:
        message = re.sub(r"^--set(?=:)", "settings", message, flags=re.MULTILINE)
        for one in json.loads(faults):
            for key in said:
                message = message.replace(one.get(key) or "\0", _in_python(one.get(key) or ""))
    return kind(message.strip().removeprefix("error: "), read)
