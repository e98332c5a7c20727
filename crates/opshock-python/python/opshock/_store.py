"""Critical shocks: sweeps, their stores, and their tables."""

from __future__ import annotations

import json
import os
import sys
import types
import warnings
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from . import _html, _native
from ._errors import StoreError
from ._records import record
from ._run import cores
from ._study import OpshockWarning, Scene, Study, only_point
from ._verdict import Verdict

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

_Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Contribution:
    """One contribution to an uncertainty interval."""

    low_g: float
    """Below the highest survivor, multiples of standard gravity."""
    high_g: float
    """Above it, multiples of standard gravity."""
    factor: float
    """Safety factor in both: 1 for a bound, 1.25 where the formal order was observed, else 3."""


@dataclass(frozen=True)
class CriticalShock:
    """The largest shock that a point survives, with its interval. Amplitudes are multiples of standard gravity, without sign."""

    ramp: str
    """Ramp model: ``none``, ``rigid`` or ``deformable``."""
    pulse_ms: float
    """Width of the pulse, ms."""
    sign: str
    """Sign of the shock."""
    axes: Mapping[str, float | str] = field(hash=False)
    """Values on the study's further axes, in the unit that the name of each ends in."""
    a_crit_g: float | None
    """Critical shock: the middle of the interval, or of the bracket where there is none; ``None`` unless bracketed."""
    uncertainty_g: float | None
    """Half-width of the uncertainty interval; ``None`` where there is none."""
    half_min_height_g: float | None
    """Change of the critical shock with half the minimum film height, no part of the interval.

    ``None`` where it was not computed, or the clearance called failure is above twice that height."""
    survived_g: float | None
    """Highest survivor below the lowest failure."""
    failed_g: float | None
    """Lowest failure."""
    onset_g: float | None
    """Amplitude at which the disk first touches the ramp; ``None`` where it never does."""
    status: str
    """``ok``, ``above_range``, ``below_range``, ``undecided`` or ``open``."""
    flags: tuple[str, ...]
    """What a reader must know: ``opshock schema FLAG`` explains each."""
    contributions: Mapping[str, Contribution] = field(hash=False)
    """Contributions to the interval; they add up."""
    levels: str
    """Refinement levels of the answer beyond the study's resolution; empty for none."""
    runs: int
    """Simulations that the answer took."""
    brackets_g: tuple[tuple[float, ...], ...]
    """Every survivor with the next higher failure, on the study's own resolution: several where failure is not monotone."""
    scanned_from_g: float | None
    """Lower end of what was searched."""
    largest_gap_pct: float | None
    """Largest untested step between survivors, per cent."""

    @property
    def interval_g(self) -> tuple[float, float] | None:
        """Uncertainty interval; for a bound (``above_range``, ``below_range``) what is known; ``None`` where nothing is."""
        if self.status == "ok" and self.a_crit_g is not None and self.uncertainty_g is not None:
            return (self.a_crit_g - self.uncertainty_g, self.a_crit_g + self.uncertainty_g)
        if self.status == "above_range" and self.survived_g is not None:
            return (self.survived_g, float("inf"))
        if self.status == "below_range" and self.failed_g is not None:
            return (0.0, self.failed_g)
        return None

    def at(self, amplitude_g: float) -> Verdict:
        """Whether every shock up to this amplitude is survived, as ``opshock qualify`` judges it from the interval.

        Undecided within the interval, where there is none or a contribution is missing from it, and where a flag says that a
        survivor is in doubt (``window``, ``window_undecided``, ``undecided_amplitude``).
        """
        if not amplitude_g >= 0:
            raise ValueError(f"amplitude_g = {amplitude_g}: must be >= 0; the sign is the point's")
        interval = self.interval_g
        if interval is None or interval[0] < amplitude_g < interval[1]:
            return Verdict.UNDECIDED
        if self.uncertainty_g is not None and "contribution_missing" in self.flags:
            return Verdict.UNDECIDED
        if amplitude_g > interval[0]:
            return Verdict.FAILS
        in_doubt = {"window", "window_undecided", "undecided_amplitude"} & set(self.flags)
        return Verdict.UNDECIDED if in_doubt else Verdict.SURVIVES

    def to_dict(self) -> dict[str, Any]:
        """A row of a table: axes as columns of their own, contributions left out."""
        own = {field.name: getattr(self, field.name) for field in fields(self)}
        del own["axes"], own["contributions"], own["brackets_g"]
        return {"ramp": own.pop("ramp"), "pulse_ms": own.pop("pulse_ms"), "sign": own.pop("sign"), **self.axes, **own}

    def _repr_html_(self) -> str:
        return _html.table("critical shock", ["", ""], [(key, "" if value is None else value) for key, value in self.to_dict().items()])


class Progress(Protocol):
    """What shows progress: a bar of tqdm, or anything that has these."""

    total: Any
    """Number of points."""

    def update(self, n: int = 1, /) -> Any:
        """So many points more have their answer."""

    def set_postfix_str(self, s: str, /) -> Any:
        """What is shown behind the bar."""

    def close(self) -> Any:
        """The sweep has ended."""


class Store(Sequence[CriticalShock]):
    """The critical shocks of a study, and every simulation behind them. Never changes: :func:`open_store` reads anew."""

    def __init__(self, path: _Path) -> None:
        """Reads the store in a folder; also one that a sweep is working on."""
        self._path = Path(path).resolve()
        read = json.loads(_native.open_store(path))
        table = read["table"]
        known = {field.name for field in fields(CriticalShock)} - {"axes"}
        self._rows = tuple(
            record(CriticalShock, {**row, "axes": {key: value for key, value in row.items() if key not in known}})
            for row in table["points"]
        )
        self._read, self._table = read, table

    @property
    def path(self) -> Path:
        """Folder."""
        return self._path

    @property
    def name(self) -> str:
        """Name of the study."""
        return str(self._table["study"])

    @property
    def digest(self) -> str:
        """Digest of the study: :attr:`Study.digest`."""
        return str(self._table["digest"])

    @property
    def program(self) -> str:
        """Program that made the numbers: version, commit, physics versions."""
        return str(self._read["program"])

    @property
    def answer(self) -> str:
        """The answer in words."""
        return " ".join(self._read["answer"])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is wrong with the store."""
        return tuple(self._read["warnings"])

    @property
    def totals(self) -> Mapping[str, Any]:
        """Numbers of points by status, simulations and their cost."""
        return types.MappingProxyType(
            {key: types.MappingProxyType(value) if isinstance(value, dict) else value for key, value in self._table["totals"].items()}
        )

    @property
    def is_complete(self) -> bool:
        """Whether every point's search has ended."""
        return not self._table["totals"]["open"]

    @property
    def study(self) -> Study:
        """The study, with every default written out."""
        if self._read["study_toml"] is None:
            raise StoreError(f"{self._path} does not hold its study any more")
        return Study.from_toml(self._read["study_toml"])

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, place: Any) -> Any:
        return self._rows[place]

    def __iter__(self) -> Iterator[CriticalShock]:
        return iter(self._rows)

    def select(self, **coordinates: float | str) -> Sequence[CriticalShock]:
        """Rows with these coordinates: ``store.select(ramp="rigid", pulse_ms=2)``."""

        def has(row: CriticalShock) -> bool:
            own = {"ramp": row.ramp, "pulse_ms": row.pulse_ms, "sign": row.sign, **row.axes}
            return all(own[key] == value for key, value in coordinates.items())

        return tuple(row for row in self._rows if has(row))

    def runs(self) -> list[dict[str, Any]]:
        """Every simulation that the folder holds now, as ``opshock export`` prints it: amplitude, verdict, clearance, cost."""
        runs: list[dict[str, Any]] = json.loads(_native.store_runs(self._path))
        return runs

    def to_pandas(self) -> pd.DataFrame:
        """The table; amplitudes in multiples of standard gravity, the program and digest in ``attrs``.

        The column ``flags`` is ``frame["flags"]``: pandas has an attribute of that name.
        """
        import pandas as pd

        frame = pd.DataFrame([row.to_dict() for row in self._rows])
        frame.attrs.update(self._provenance())
        return frame

    def to_xarray(self) -> xr.Dataset:
        """The table over ``ramp``, ``pulse_ms``, ``sign`` and the further axes; amplitudes and widths have their units."""
        import xarray as xr

        axes = list(self._rows[0].axes) if self._rows else []
        index = ["ramp", "pulse_ms", "sign", *axes]
        numbers = ["a_crit_g", "uncertainty_g", "half_min_height_g", "survived_g", "failed_g", "onset_g"]
        frame = self.to_pandas().set_index(index)[[*numbers, "status"]]
        dataset = xr.Dataset.from_dataframe(frame.astype(dict.fromkeys(numbers, float)))
        for name in numbers:
            dataset[name].attrs["units"] = "g0 (9.80665 m/s2)"
        dataset["pulse_ms"].attrs["units"] = "ms"
        dataset.attrs.update(self._provenance())
        return dataset

    def _provenance(self) -> dict[str, str]:
        return {"study": self.name, "digest": self.digest, "program": self.program}

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws the critical shocks with their intervals over the pulse width with matplotlib."""
        from ._plots import plot_critical_shocks

        return plot_critical_shocks(self, axes)

    def __repr__(self) -> str:
        return f"<Store {str(self._path)!r}: {self.name!r}, {len(self)} points>"

    def _repr_html_(self) -> str:
        rows = [row.to_dict() for row in self._rows]
        header = [
            key
            for key in (rows[0] if rows else {})
            if key in {"ramp", "pulse_ms", "sign", "a_crit_g", "uncertainty_g", "status", "flags"} | set(self._rows[0].axes)
        ]
        cells = [["" if row[key] is None else ", ".join(row[key]) if key == "flags" else row[key] for key in header] for row in rows]
        return _html.table(f"{self.name}: {self.answer}", header, cells)


def open_store(path: _Path) -> Store:
    """Opens the store in a folder, which a sweep of Python or of the command line made."""
    return Store(path)


def sweep(
    study: Study,
    store: _Path,
    *,
    threads: int | None = None,
    budget_s: float | None = None,
    progress: bool | Progress = False,
    retry_undecided: bool = False,
    reuse: Collection[_Path] = (),
    accept: Collection[str] = (),
) -> Store:
    """Finds the critical shock of every point of a study, on all cores, into the store in a folder.

    Every simulation is on the disk when it is done: called again, with the same study, it goes on where it stopped. Ctrl-C
    saves, then raises ``KeyboardInterrupt``. ``budget_s`` ends it after so many seconds: then :attr:`Store.is_complete` is
    false. ``progress=True`` shows a bar of tqdm; a bar of your own may be given. ``reuse`` are other stores whose simulations
    of equal content are taken. ``accept`` are codes of warnings of the study that need not stop it.
    """
    bar = _bar(study.name) if progress is True else None if progress is False else progress
    if bar is not None and not callable(getattr(bar, "update", None)):
        raise TypeError(f"progress = {progress!r}: must be True, False, or a bar with total, update, set_postfix_str and close")
    codes = [accept] if isinstance(accept, str) else list(accept)
    try:
        _native.sweep(study._study, store, cores(threads), budget_s, retry_undecided, list(reuse), codes, _shown(bar))
    finally:
        if bar is not None:
            bar.close()
    return Store(store)


def critical_shock(
    scene: Scene,
    *,
    store: _Path | None = None,
    threads: int | None = None,
    progress: bool | Progress = False,
    accept: Collection[str] = (),
) -> CriticalShock:
    """The critical shock of one scene, with its uncertainty interval; kept in ``store`` if one is given.

    A store holds one study: give none that another study was swept into.
    """
    only_point(scene)
    # Imported here as NumPy is: it is felt at the package's start.
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        swept = sweep(scene, store or Path(folder) / "store", threads=threads, progress=progress, accept=accept)
        row: CriticalShock = swept[0]
        return row


def _bar(name: str) -> Progress:
    try:
        from tqdm.auto import tqdm
    except ImportError as error:
        raise ImportError("progress=True needs tqdm: pip install tqdm") from error
    bar: Progress = tqdm(desc=name, unit="point")
    return bar


def _shown(bar: Progress | None) -> Callable[[str], None]:
    """Receives the events of a sweep: warnings are raised as such, messages go to standard error, the rest to the bar."""

    # Rounds that add widths report all points again.
    shown, done = 0, 0

    def show(text: str) -> None:
        nonlocal shown, done
        event = json.loads(text)
        kind = event["event"]
        if kind == "warning":
            warnings.warn(f"{event['code']}: {event['message']}", OpshockWarning, stacklevel=2)
        if kind == "message":
            print(event["message"], file=sys.stderr)
        if bar is None:
            return
        if kind == "started":
            bar.total, done = event["points"], 0
        elif kind == "point":
            done += 1
            if done > shown:
                shown = done
                bar.update(1)
        elif kind == "estimate":
            left = event["left_s"]
            time = f", {left[0]:.0f} to {left[2]:.0f} s left" if left else ""
            bar.set_postfix_str(f"{event['runs_done']} runs{time}")

    return show
