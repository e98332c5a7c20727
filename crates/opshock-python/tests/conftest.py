"""What every test shares: a small study, and one sweep of it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib
import opshock
import pytest

matplotlib.use("Agg")

SMALL = """\
study_format = 2
name = "small"
outputs = ["critical_shock"]

[pulse]
widths_ms = [1.0, 2.0]
signs = ["+"]
window_ms = 2.5

[ramp]
models = ["none", "rigid"]

[search]
amplitude_g = { min = 100.0, max = 1500.0 }
tolerance_pct = 5.0
monotonicity_scan = "off"
uncertainty = false
max_refinements = 0

[resolution]
preset = "coarse"
film_cells = 200
film_correction_cells = 200
disk_cut_khz = 40.0
structure_step_us = 1.0
"""


@pytest.fixture(scope="session")
def small_toml() -> str:
    """Text of the small study: two ramp models, two widths, half a second a simulation."""
    return SMALL


@pytest.fixture(scope="session")
def study_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small study in a file."""
    path = tmp_path_factory.mktemp("study") / "small.toml"
    path.write_text(SMALL)
    return path


@pytest.fixture(scope="session")
def study() -> opshock.Study:
    """The small study."""
    return opshock.Study.from_toml(SMALL)


@pytest.fixture(scope="session")
def free(study: opshock.Study) -> opshock.Scene:
    """The scene without a ramp."""
    return study.scene(ramp="none", pulse_ms=2)


@pytest.fixture(scope="session")
def rigid(study: opshock.Study) -> opshock.Scene:
    """The scene with a rigid ramp."""
    return study.scene(ramp="rigid", pulse_ms=2)


@pytest.fixture(scope="session")
def survived(rigid: opshock.Scene) -> opshock.Run:
    """A shock that touches the ramp and is survived, with its history."""
    return opshock.simulate(rigid, 400, history=True)


@pytest.fixture(scope="session")
def failed(rigid: opshock.Scene) -> opshock.Run:
    """A shock that is not survived, with its history."""
    return opshock.simulate(rigid, 600.0, history=True)


@pytest.fixture(scope="session")
def store(study: opshock.Study, tmp_path_factory: pytest.TempPathFactory) -> opshock.Store:
    """The sweep of the small study, on one thread."""
    return opshock.sweep(study, tmp_path_factory.mktemp("swept") / "small.opshock", threads=1)


@pytest.fixture(scope="session")
def uncertain(tmp_path_factory: pytest.TempPathFactory) -> opshock.Store:
    """A sweep with uncertainty intervals: no ramp, one width, both signs."""
    settings = {
        "ramp.models": ["none"],
        "pulse.widths_ms": [1.0],
        "pulse.window_ms": 1.5,
        "pulse.signs": ["+", "-"],
        "search.uncertainty": True,
        "resolution.film_cells": 100,
        "resolution.film_correction_cells": 100,
    }
    path = tmp_path_factory.mktemp("uncertain") / "small.toml"
    path.write_text(SMALL)
    own = opshock.Study(path, settings)
    return opshock.sweep(own, path.with_suffix(".opshock"), threads=1)


Command = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session")
def command(tmp_path_factory: pytest.TempPathFactory) -> Command:
    """Runs the command line: the program that OPSHOCK_PROGRAM names, else the package's own."""
    program = [os.environ["OPSHOCK_PROGRAM"]] if "OPSHOCK_PROGRAM" in os.environ else [sys.executable, "-m", "opshock"]
    folder = tmp_path_factory.mktemp("command")

    def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        words = [*program, *(str(one) for one in arguments)]
        return subprocess.run(words, capture_output=True, text=True, cwd=folder, timeout=120, check=False)

    return run
