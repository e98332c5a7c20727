"""Sweeps, their stores, and their tables."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import Any

import numpy as np
import opshock
import pytest
from opshock import CriticalShock, Store, Verdict


def test_the_table(store: Store, study: opshock.Study) -> None:
    """A row for each point, in the study's order; each bracketed within the tolerance."""
    assert [f"{row.ramp} {row.pulse_ms:g} ms {row.sign}" for row in store] == list(study.points)
    for row in store:
        assert row.status == "ok"
        assert row.survived_g is not None and row.failed_g is not None and row.a_crit_g is not None
        assert row.failed_g / row.survived_g <= 1.05
        assert row.a_crit_g == pytest.approx((row.survived_g + row.failed_g) / 2, rel=1e-12)
        assert row.brackets_g == ((row.survived_g, row.failed_g),)
        assert (row.uncertainty_g, row.interval_g, row.levels, dict(row.axes)) == (None, None, "", {})
        assert row.half_min_height_g is None and "below_continuum" in row.flags
        assert (row.onset_g is None) == (row.ramp == "none")
        assert row.scanned_from_g is None and row.largest_gap_pct is None, "no scan"
        assert dict(row.contributions) == {}


def test_a_ramp_lowers_the_critical_shock(store: Store) -> None:
    """At both widths; the disk touches the ramp before that."""
    for pulse_ms in (1.0, 2.0):
        (free,), (rigid,) = store.select(ramp="none", pulse_ms=pulse_ms), store.select(ramp="rigid", pulse_ms=pulse_ms)
        assert free.a_crit_g is not None and rigid.a_crit_g is not None and rigid.onset_g is not None
        assert rigid.onset_g < rigid.a_crit_g < free.a_crit_g


def test_the_bracket_holds(store: Store, rigid: opshock.Scene) -> None:
    """Simulated apart: the survivor survives, the failure fails, the onset is the first touch."""
    row = store.select(ramp="rigid", pulse_ms=2)[0]
    assert row.survived_g is not None and row.failed_g is not None and row.onset_g is not None
    shocks = [(rigid, g) for g in (row.survived_g, row.failed_g, row.onset_g * 0.999, row.onset_g * 1.001)]
    runs = opshock.simulate_many(shocks, threads=1)
    assert [run.verdict for run in runs[:2]] == [Verdict.SURVIVES, Verdict.FAILS]
    assert [run.contact.top.first_touch_s is not None for run in runs[2:]] == [False, True]


def test_a_sequence(store: Store) -> None:
    """Length, places from both ends, slices, membership."""
    assert len(store) == 4
    assert store[-1] is store[3]
    assert store[1:3] == (store[1], store[2])
    assert store[2] in store
    assert store.index(store[2]) == 2
    with pytest.raises(IndexError):
        store[4]


def test_select(store: Store) -> None:
    """By any coordinates; an unknown one is an error."""
    assert [row.pulse_ms for row in store.select(ramp="rigid")] == [1.0, 2.0]
    assert store.select(ramp="rigid", pulse_ms=2, sign="+") == (store[3],)
    assert store.select(sign="-") == ()
    with pytest.raises(KeyError, match="width"):
        store.select(width=2)


def test_what_a_store_says_of_itself(store: Store, study: opshock.Study) -> None:
    """Name, digest, program, study, answer."""
    assert (store.name, store.digest, store.program) == ("small", study.digest, opshock.program())
    assert store.study.digest == study.digest
    assert store.study.points == study.points
    assert store.is_complete and store.warnings == ()
    assert store.path.name == "small.opshock" and store.path.is_dir()
    assert repr(store) == f"<Store {str(store.path)!r}: 'small', 4 points>"
    lowest = min(row.a_crit_g or np.inf for row in store)
    assert f"from {lowest:.1f} G (the worst case: rigid ramp, 1 ms, sign +)" in store.answer


def test_every_simulation(store: Store) -> None:
    """As many as the rows say, each with its verdict; survivors and failures do not mix."""
    runs = store.runs()
    assert {one["window_factor"] for one in runs} <= {1, 2}, "some in a doubled window"
    assert len(runs) == store.totals["runs"] == sum(row.runs for row in store)
    assert (store.totals["points"], store.totals["ok"], store.totals["open"]) == (4, 4, 0)
    for row in store:
        point = (row.ramp, row.pulse_ms, row.sign, 1)
        own = [one for one in runs if (one["ramp"], one["pulse_ms"], one["sign"], one["window_factor"]) == point]
        assert max(one["amplitude_g"] for one in own if one["verdict"] == "survives") == row.survived_g
        assert min(one["amplitude_g"] for one in own if one["verdict"] == "fails") == row.failed_g
    assert store.totals["cost"]["film_solves"] == sum(one["film_solves"] for one in runs)


def test_a_row_as_a_dictionary(store: Store) -> None:
    """Coordinates first; no contributions, no brackets."""
    row = store[0].to_dict()
    assert list(row)[:4] == ["ramp", "pulse_ms", "sign", "a_crit_g"]
    fields = {field.name for field in dataclasses.fields(CriticalShock)}
    assert set(row) == fields - {"axes", "contributions", "brackets_g"}
    assert all(row[key] == getattr(store[0], key) for key in row)


def test_pandas(store: Store) -> None:
    """A row for each point; where the numbers come from is in ``attrs``."""
    frame = store.to_pandas()
    assert frame["a_crit_g"].tolist() == [row.a_crit_g for row in store]
    assert frame["ramp"].tolist() == ["none", "none", "rigid", "rigid"]
    assert frame.attrs == {"study": "small", "digest": store.digest, "program": store.program}


def test_xarray(store: Store) -> None:
    """Over the coordinates, with units; what is not known is not a number."""
    dataset = store.to_xarray()
    assert dict(dataset.sizes) == {"ramp": 2, "pulse_ms": 2, "sign": 1}
    for row in store:
        at = dataset.sel(ramp=row.ramp, pulse_ms=row.pulse_ms, sign=row.sign)
        assert float(at["a_crit_g"]) == row.a_crit_g
        assert str(at["status"].item()) == row.status
        assert np.isnan(float(at["uncertainty_g"]))
        assert np.isnan(float(at["onset_g"])) == (row.ramp == "none")
    assert dataset["failed_g"].attrs["units"] == "g0 (9.80665 m/s2)"
    assert dataset["pulse_ms"].attrs["units"] == "ms"
    assert dataset.attrs["digest"] == store.digest


def test_further_axes(study: opshock.Study, tmp_path: Path) -> None:
    """A column of their own in every table, and a coordinate to select by; a ramp 0.6 times as far is touched at 0.6 times the shock."""
    settings = {"ramp.models": ["rigid"], "pulse.widths_ms": [2.0], "ramp.clearance_um": [60.0, 100.0]}
    swept = opshock.sweep(study.with_settings(settings), tmp_path / "swept", threads=1)
    assert [dict(row.axes) for row in swept] == [{"clearance_um": 60.0}, {"clearance_um": 100.0}]
    (near,), (far,) = swept.select(clearance_um=60), swept.select(clearance_um=100)
    assert near.onset_g is not None and far.onset_g is not None
    assert near.onset_g / far.onset_g == pytest.approx(0.6, rel=1e-6)
    assert list(near.to_dict())[3] == "clearance_um"
    assert swept.to_pandas()["clearance_um"].tolist() == [60.0, 100.0]
    assert dict(swept.to_xarray().sizes) == {"ramp": 1, "pulse_ms": 1, "sign": 1, "clearance_um": 2}
    labels = [str(one.get_label()) for one in swept.plot().containers]
    assert labels == ["rigid, clearance_um = 60.0, +", "rigid, clearance_um = 100.0, +"]
    assert swept._repr_html_().count(">60<") == 1


def test_rows_and_stores_never_change(store: Store, uncertain: Store) -> None:
    """Fields, mappings and properties refuse assignment."""
    row: Any = uncertain[0]
    for field in dataclasses.fields(row):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(row, field.name, None)
    with pytest.raises(dataclasses.FrozenInstanceError):
        row.contributions["search"].low_g = 1.0
    mappings: list[Any] = [row.axes, row.contributions, store.totals]
    for mapping in mappings:
        with pytest.raises(TypeError, match="item assignment"):
            mapping["search"] = None
    anything: Any = store
    with pytest.raises(TypeError, match="item assignment"):
        anything[0] = row
    for name in ("name", "digest", "path", "totals"):
        with pytest.raises(AttributeError):
            setattr(anything, name, None)


def test_totals_never_change(store: Store) -> None:
    """Tables within the table neither."""
    with pytest.raises(TypeError):
        opshock.open_store(store.path).totals["cost"]["steps"] = 0


def test_one_critical_shock(free: opshock.Scene, store: Store, tmp_path: Path) -> None:
    """That of the sweep, kept where it is asked to be; nothing is left elsewhere."""
    row = opshock.critical_shock(free, threads=1, store=tmp_path / "one")
    swept = store.select(ramp="none", pulse_ms=2)[0]
    assert (row.a_crit_g, row.survived_g, row.failed_g) == (swept.a_crit_g, swept.survived_g, swept.failed_g)
    assert opshock.open_store(tmp_path / "one")[0] == row
    before = os.stat(tmp_path / "one" / "journal").st_size
    assert opshock.critical_shock(free, threads=1, store=str(tmp_path / "one")) == row
    assert len(opshock.open_store(tmp_path / "one").runs()) == row.runs
    assert os.stat(tmp_path / "one" / "journal").st_size >= before


def test_above_and_below_the_range(free: opshock.Scene) -> None:
    """Ranges beside the critical shock: bounds, and what is known of an amplitude."""
    low = free.scene(settings={"search.amplitude_g": {"min": 100.0, "max": 200.0}})
    above = opshock.critical_shock(low, threads=1)
    assert (above.status, above.a_crit_g, above.failed_g) == ("above_range", None, None)
    assert above.survived_g is not None and above.at(above.survived_g) is Verdict.SURVIVES
    high = free.scene(settings={"search.amplitude_g": {"min": 1200.0, "max": 2000.0}})
    below = opshock.critical_shock(high, threads=1)
    assert (below.status, below.a_crit_g, below.survived_g) == ("below_range", None, None)
    assert below.interval_g == (0.0, below.failed_g)


def test_a_budget_ends_a_sweep(study: opshock.Study, tmp_path: Path) -> None:
    """Nothing is begun without time: every point is open, and nothing is decided."""
    begun = opshock.sweep(study, tmp_path / "swept", threads=1, budget_s=0)
    assert not begun.is_complete
    assert begun.totals["open"] == 4
    assert {row.status for row in begun} == {"open"}
    assert begun[0].at(1.0) is Verdict.UNDECIDED


def test_a_changed_study_is_reported(study: opshock.Study, tmp_path: Path) -> None:
    """By a warning, with the change; the store is the new study's."""
    opshock.sweep(study, tmp_path / "swept", threads=1, budget_s=0)
    thin = study.with_settings({"disk.thickness_mm": 0.6})
    with pytest.warns(opshock.OpshockWarning, match="the study has changed"):
        changed = opshock.sweep(thin, tmp_path / "swept", threads=1, budget_s=0)
    assert changed.digest == thin.digest != study.digest


def test_retries_are_asked_for(study: opshock.Study, store: Store) -> None:
    """Where nothing is undecided there is nothing to retry: the same rows, no further simulation."""
    again = opshock.sweep(study, store.path, threads=1, retry_undecided=True)
    assert list(again) == list(store)
    assert len(again.runs()) == len(store.runs())


@pytest.mark.parametrize("budget_s", [-1.0, float("nan")])
def test_budgets_that_are_none(study: opshock.Study, tmp_path: Path, budget_s: float) -> None:
    """Refused, as every other number out of range."""
    with pytest.raises(ValueError, match="budget_s"):
        opshock.sweep(study.scene(ramp="none", pulse_ms=1), tmp_path / "swept", threads=1, budget_s=budget_s)
