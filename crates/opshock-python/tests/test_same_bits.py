"""Python and the command line give the same numbers, to the bit, on any number of threads."""

from __future__ import annotations

import csv
import dataclasses
import json
import shutil
import struct
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import opshock
import pytest

Command = Callable[..., "subprocess.CompletedProcess[str]"]


def plain(value: Any) -> Any:
    """A record as JSON has it."""
    if isinstance(value, opshock.Verdict):
        return value.value
    if dataclasses.is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(one) for key, one in value.items()}
    return [plain(one) for one in value] if isinstance(value, tuple) else value


def answer(run: opshock.Run) -> dict[str, Any]:
    """All that a run says, but what was asked and the time that it took."""
    values = {field.name: plain(getattr(run, field.name)) for field in dataclasses.fields(run) if field.name not in ("scene", "history")}
    del values["cost"]["wall_s"], values["amplitude_g"]
    return values


def bits(numbers: Any) -> list[bytes]:
    """Numbers as their 64 bits."""
    return [struct.pack("<d", number) for number in numbers]


def numbers_in(value: Any) -> int:
    """How many numbers a JSON value holds."""
    if isinstance(value, dict):
        return sum(numbers_in(one) for one in value.values())
    if isinstance(value, list):
        return sum(numbers_in(one) for one in value)
    return int(isinstance(value, (int, float)) and not isinstance(value, bool))


@pytest.mark.parametrize("name", ["survived", "failed"])
def test_a_run(name: str, request: pytest.FixtureRequest, command: Command, study_file: Path, tmp_path: Path) -> None:
    """Every number of ``run --json``, and every column of its history."""
    run: opshock.Run = request.getfixturevalue(name)
    shock = ("--ramp", "rigid", "--pulse-ms", "2", "--sign", "+", "--amplitude-g", repr(run.amplitude_g))
    done = command("run", study_file, *shock, "--json", "--history", tmp_path / "history.csv")
    assert done.returncode == 0, done.stderr
    printed = json.loads(done.stdout)
    del printed["cost"]["wall_s"]
    own = answer(run)
    assert {key: value for key, value in own.items() if key in printed} == printed
    assert all(value is None for key, value in own.items() if key not in printed)
    assert numbers_in(printed) > 30

    assert run.history is not None
    with (tmp_path / "history.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header == list(run.history)
    for place, column in enumerate(header):
        written = [float(row[place] or "nan") for row in rows]
        assert bits(written) == bits(run.history[column]), column
        assert bits(float(repr(number)) for number in run.history[column].tolist()) == bits(written)


@pytest.mark.parametrize("threads", [1, 3])
def test_a_batch(threads: int, rigid: opshock.Scene, free: opshock.Scene, survived: opshock.Run, failed: opshock.Run) -> None:
    """``simulate_many`` is ``simulate``, whatever the number of threads and the company."""
    shocks = [(rigid, 400.0), (free, 300.0), (rigid, 600.0), (rigid, 400.0)]
    first, second, third, fourth = opshock.simulate_many(shocks, threads=threads)
    assert answer(first) == answer(survived) == answer(fourth)
    # The mechanism is seen in a history.
    assert third.mechanism is None
    assert answer(third) == answer(failed) | {"mechanism": None}
    assert answer(second) == answer(opshock.simulate(free, 300.0))
    assert answer(second) != answer(first)


def test_many_in_order(free: opshock.Scene, rigid: opshock.Scene) -> None:
    """Answers come in the order of the shocks, of a generator too; none for none."""
    shocks = [(rigid, 600), (free, 100), (rigid, 400)]
    runs = opshock.simulate_many((one for one in shocks), threads=1)
    assert [(run.scene, run.amplitude_g) for run in runs] == [(scene, float(g)) for scene, g in shocks]
    assert [run.verdict for run in runs] == [opshock.Verdict.FAILS, opshock.Verdict.SURVIVES, opshock.Verdict.SURVIVES]
    assert all(run.history is None for run in runs)
    assert opshock.simulate_many([]) == []


def test_a_history_changes_nothing(rigid: opshock.Scene, survived: opshock.Run) -> None:
    """A run without one has the same answer."""
    bare = opshock.simulate(rigid, 400)
    assert bare.history is None
    assert answer(bare) == answer(survived)


def test_a_sweep(command: Command, study: opshock.Study, study_file: Path, store: opshock.Store, tmp_path: Path) -> None:
    """One thread, two threads and the command line: row by row; each opens and goes on with the other's store."""
    two = opshock.sweep(study, tmp_path / "two", threads=2)
    assert list(two) == list(store)
    assert [one.to_dict() for one in two] == [one.to_dict() for one in store]

    folder = tmp_path / "command"
    done = command("sweep", study_file, "--store", folder, "--json", "--progress", "none", "-j", "1")
    assert done.returncode == 0, done.stderr
    printed = json.loads(done.stdout)
    own = [{**{key: value for key, value in plain(row).items() if key != "axes"}, **row.axes} for row in store]
    assert own == printed["points"]
    assert (printed["digest"], printed["answer"]) == (store.digest, store.answer)

    opened = opshock.open_store(folder)
    assert list(opened) == list(store)
    assert opened.study.digest == study.digest
    before = opened.runs()
    resumed = opshock.sweep(study, folder, threads=1)
    assert resumed.runs() == before, "no new simulation"
    assert list(resumed) == list(store)


def test_the_command_line_goes_on_with_a_store_of_python(command: Command, study_file: Path, store: opshock.Store, tmp_path: Path) -> None:
    """Its table, its simulations, and nothing to do in it."""
    folder = tmp_path / "copy"
    shutil.copytree(store.path, folder)
    exported = command("export", folder, "--json")
    assert exported.returncode == 0, exported.stderr
    assert json.loads(exported.stdout)["runs"] == store.runs()
    done = command("sweep", study_file, "--store", folder, "--json", "--progress", "none")
    assert done.returncode == 0, done.stderr
    assert [row["a_crit_g"] for row in json.loads(done.stdout)["points"]] == [row.a_crit_g for row in store]
    assert opshock.open_store(folder).runs() == store.runs()


def test_part_of_a_sweep_is_gone_on_with(study: opshock.Study, store: opshock.Store, tmp_path: Path) -> None:
    """A store of some points: those are not simulated again, and the table is that of one sweep."""
    folder = tmp_path / "parts"
    part = opshock.sweep(study.with_settings({"pulse.widths_ms": [1.0], "ramp.models": ["none"]}), folder, threads=1)
    done = [(one["ramp"], one["amplitude_g"]) for one in part.runs()]
    whole = opshock.sweep(study, folder, threads=1)
    brackets = [(row.survived_g, row.failed_g, row.onset_g) for row in store]
    assert [(row.survived_g, row.failed_g, row.onset_g) for row in whole] == brackets
    again = [(one["ramp"], one["amplitude_g"]) for one in whole.runs() if (one["ramp"], one["pulse_ms"]) == ("none", 1.0)]
    assert sorted(again) == sorted(done)
