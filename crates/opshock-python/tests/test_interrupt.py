"""Ctrl-C, exceptions from the progress object, and what progress is shown."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import opshock
import pytest

CHILD = """\
import sys
import opshock

class Bar:
    total = None
    def update(self, n=1): pass
    def set_postfix_str(self, s): print(s, flush=True)
    def close(self): print("closed", flush=True)

try:
    opshock.sweep(opshock.Study(sys.argv[1]), sys.argv[2], threads=1, progress=Bar())
    print("ended")
except KeyboardInterrupt:
    print("interrupted")
"""


class Bar:
    """Counts what a sweep reports, and raises at a given update."""

    def __init__(self, raise_at: int | None = None) -> None:
        self.total: int | None = None
        self.updates: list[int] = []
        self.texts: list[str] = []
        self.closed = 0
        self.raise_at = raise_at

    def update(self, n: int = 1, /) -> None:
        """Notes it."""
        self.updates.append(n)
        if len(self.updates) == self.raise_at:
            raise ZeroDivisionError("from the bar")

    def set_postfix_str(self, s: str, /) -> None:
        """Notes it."""
        self.texts.append(s)

    def close(self) -> None:
        """Notes it."""
        self.closed += 1


def numbers(store: opshock.Store) -> list[opshock.CriticalShock]:
    """The rows of a store."""
    return list(store)


def test_ctrl_c_saves_and_a_second_sweep_ends_it(tmp_path: Path, study_file: Path, study: opshock.Study, store: opshock.Store) -> None:
    """Interrupted after the third estimate: KeyboardInterrupt, a whole store, and the same table at last."""
    folder = tmp_path / "swept"
    child = subprocess.Popen([sys.executable, "-c", CHILD, study_file, folder], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    lines = [child.stdout.readline() for _ in range(3)]
    child.send_signal(signal.SIGINT)
    began = time.monotonic()
    rest, _ = child.communicate(timeout=60)
    assert time.monotonic() - began < 5
    assert all("runs" in line for line in lines)
    assert rest.split()[-2:] == ["closed", "interrupted"]
    assert child.returncode == 0

    partial = opshock.open_store(folder)
    assert not partial.is_complete
    assert 0 < len(partial.runs()) < len(store.runs())
    assert partial.warnings == ()
    whole = opshock.sweep(study, folder, threads=1)
    assert whole.is_complete
    assert numbers(whole) == numbers(store)
    assert len(whole.runs()) == len(store.runs()), "nothing was simulated twice"


def test_ctrl_c_ends_a_batch(study_file: Path) -> None:
    """``simulate_many`` ends within seconds of a signal, though it has minutes of work."""
    text = (
        "import sys, opshock\n"
        "scene = opshock.Study(sys.argv[1]).scene(ramp='rigid', pulse_ms=2)\n"
        "print('ready', flush=True)\n"
        "try:\n"
        "    opshock.simulate_many([(scene, 200.0 + number) for number in range(1000)], threads=1)\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted')\n"
    )
    child = subprocess.Popen([sys.executable, "-c", text, study_file], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.7)
    assert child.poll() is None
    child.send_signal(signal.SIGINT)
    rest, _ = child.communicate(timeout=5)
    assert (rest, child.returncode) == ("interrupted\n", 0)


@pytest.fixture(scope="module")
def two(study: opshock.Study) -> opshock.Study:
    """The two points of one width."""
    return study.with_settings({"pulse.widths_ms": [2.0]})


def test_what_the_progress_object_raises_stops_the_sweep(tmp_path: Path, study: opshock.Study) -> None:
    """It is raised, the bar is closed, the store keeps what is done."""
    bar = Bar(raise_at=1)
    with pytest.raises(ZeroDivisionError, match="from the bar"):
        opshock.sweep(study, tmp_path / "swept", threads=1, progress=bar)
    assert bar.updates[0] == 1
    assert bar.closed == 1
    partial = opshock.open_store(tmp_path / "swept")
    assert not partial.is_complete
    assert {row.status for row in partial} == {"ok", "open"}
    assert partial.totals["runs"] == len(partial.runs()) > 0


def test_updates_add_up_to_the_points(tmp_path: Path, two: opshock.Study, store: opshock.Store) -> None:
    """In a fresh sweep and in one that has nothing left to do."""
    for _ in range(2):
        bar = Bar()
        shown: opshock.Progress = bar
        swept = opshock.sweep(two, tmp_path / "swept", threads=1, progress=shown)
        assert sum(bar.updates) == bar.total == len(two.points) == 2
        assert bar.closed == 1
        brackets = [(row.survived_g, row.failed_g) for row in store.select(pulse_ms=2)]
        assert [(row.survived_g, row.failed_g) for row in swept] == brackets
        counts = [int(text.split(" runs")[0]) for text in bar.texts]
        assert counts == sorted(counts)
        assert all(0 < count <= len(swept.runs()) for count in counts)


def test_a_store_is_readable_while_it_is_swept(tmp_path: Path, free: opshock.Scene) -> None:
    """From the progress object itself; a second sweep of it is refused."""
    seen: list[object] = []

    class Reader(Bar):
        def update(self, n: int = 1, /) -> None:
            super().update(n)
            seen.append(opshock.open_store(tmp_path / "swept")[0].status)
            with pytest.raises(opshock.StoreError, match="E184.*in use by process"):
                opshock.sweep(free, tmp_path / "swept", threads=1)

    opshock.sweep(free, tmp_path / "swept", threads=1, progress=Reader())
    assert seen == ["ok"]


def test_a_bar_of_tqdm(tmp_path: Path, free: opshock.Scene, capsys: pytest.CaptureFixture[str]) -> None:
    """``progress=True`` shows the study's name and all points on standard error."""
    opshock.sweep(free, tmp_path / "swept", threads=1, progress=True)
    shown = capsys.readouterr().err
    assert "small: 100%" in shown
    assert "1/1" in shown


def test_a_bar_of_tqdm_of_your_own(tmp_path: Path, free: opshock.Scene) -> None:
    """Without a total, which the sweep sets."""
    from tqdm import tqdm

    bar = tqdm(disable=False)
    opshock.sweep(free, tmp_path / "swept", threads=1, progress=bar)
    assert (bar.n, bar.total) == (1, 1)


def test_rounds_that_add_widths_do_not_overshoot(tmp_path: Path, small_toml: str) -> None:
    """A bar ends where its total is, and never beyond."""
    text = small_toml.replace('["none", "rigid"]', '["none"]').replace("[1.0, 2.0]", "[0.5, 2.0]")
    bar = Shown()
    swept = opshock.sweep(
        opshock.Study.from_toml(text + "[search.added_points]\ntolerance_pct = 5.0\nclosest_pct = 1.0\nmax_points = 2\n"),
        tmp_path / "s",
        threads=1,
        progress=bar,
    )
    assert len(swept) > 2
    assert (bar.shown, bar.total) == (len(swept), len(swept))


def test_a_bar_that_is_none_is_refused_before_the_sweep(tmp_path: Path, study: opshock.Study) -> None:
    """A number is no bar."""
    with pytest.raises(TypeError, match="progress = 1: must be True, False, or a bar"):
        opshock.sweep(study, tmp_path / "swept", threads=1, progress=1)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    assert not (tmp_path / "swept").exists()


def test_one_scene_is_searched_at_a_time(study: opshock.Study) -> None:
    """A study of several points is none."""
    searches: list[Any] = [opshock.critical_shock, opshock.Search]
    for search in searches:
        with pytest.raises(ValueError, match="a scene is one point, here are 4"):
            search(study)


class Shown:
    """A bar that counts."""

    total: int = 0
    shown: int = 0

    def update(self, n: int = 1, /) -> None:
        self.shown += n
        assert self.shown <= self.total

    def set_postfix_str(self, s: str, /) -> None:
        pass

    def close(self) -> None:
        pass
