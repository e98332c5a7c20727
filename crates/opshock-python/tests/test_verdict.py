"""A verdict is no bool, and an interval leaves an amplitude undecided."""

from __future__ import annotations

from dataclasses import replace

import opshock
import pytest
from opshock import CriticalShock, Verdict


def row(**values: object) -> CriticalShock:
    """A bracketed critical shock of 500 G, 20 G either way, with other values."""
    base = CriticalShock(
        ramp="rigid",
        pulse_ms=2.0,
        sign="+",
        axes={},
        a_crit_g=500.0,
        uncertainty_g=20.0,
        half_min_height_g=None,
        survived_g=495.0,
        failed_g=505.0,
        onset_g=250.0,
        status="ok",
        flags=(),
        contributions={},
        levels="",
        runs=9,
        brackets_g=((495.0, 505.0),),
        scanned_from_g=None,
        largest_gap_pct=None,
    )
    return replace(base, **values)  # type: ignore[arg-type]


@pytest.mark.parametrize("verdict", list(Verdict))
def test_a_verdict_has_no_truth_value(verdict: Verdict) -> None:
    """Its message says how to compare it."""
    with pytest.raises(TypeError, match=rf"Verdict\.{verdict.name}`"):
        bool(verdict)
    with pytest.raises(TypeError):
        _ = not verdict  # pyright: ignore[reportGeneralTypeIssues]


def test_the_words_are_those_of_the_command_line() -> None:
    """Three verdicts, by their words."""
    assert [one.value for one in Verdict] == ["survives", "fails", "undecided"]
    assert Verdict("fails") is Verdict.FAILS


@pytest.mark.parametrize(
    ("amplitude_g", "expected"),
    [
        (0.0, Verdict.SURVIVES),
        (479.9, Verdict.SURVIVES),
        (480.0, Verdict.SURVIVES),
        (480.1, Verdict.UNDECIDED),
        (500.0, Verdict.UNDECIDED),
        (519.9, Verdict.UNDECIDED),
        (520.0, Verdict.FAILS),
        (1e6, Verdict.FAILS),
    ],
)
def test_at_an_amplitude(amplitude_g: float, expected: Verdict) -> None:
    """Below, within and above the interval from 480 to 520 G."""
    assert row().interval_g == (480.0, 520.0)
    assert row().at(amplitude_g) is expected


def test_above_the_range_is_a_bound() -> None:
    """What the highest amplitude survives is known, and no more."""
    bound = row(status="above_range", a_crit_g=None, uncertainty_g=None, survived_g=1482.0, failed_g=None)
    assert bound.interval_g == (1482.0, float("inf"))
    assert bound.at(1482.0) is Verdict.SURVIVES
    assert bound.at(1482.1) is Verdict.UNDECIDED
    assert bound.at(1e9) is Verdict.UNDECIDED


def test_below_the_range_is_a_bound() -> None:
    """What the lowest amplitude fails is known, and no more."""
    bound = row(status="below_range", a_crit_g=None, uncertainty_g=None, survived_g=None, failed_g=101.6)
    assert bound.interval_g == (0.0, 101.6)
    assert bound.at(101.6) is Verdict.FAILS
    assert bound.at(101.5) is Verdict.UNDECIDED


@pytest.mark.parametrize("values", [{"uncertainty_g": None}, {"status": "undecided", "a_crit_g": None}, {"status": "open"}])
def test_without_an_interval_nothing_is_decided(values: dict[str, object]) -> None:
    """No interval: undecided far below and far above the bracket too."""
    assert row(**values).interval_g is None
    assert {row(**values).at(amplitude_g) for amplitude_g in (1.0, 500.0, 1e6)} == {Verdict.UNDECIDED}


@pytest.mark.parametrize("amplitude_g", [float("nan"), -5.0])
def test_what_is_no_amplitude_is_refused(amplitude_g: float) -> None:
    """An amplitude has no sign."""
    with pytest.raises(ValueError, match="amplitude_g = .*: must be >= 0"):
        row().at(amplitude_g)


def test_a_real_interval_decides(uncertain: opshock.Store) -> None:
    """Ends of the interval of a sweep: the middle is undecided, what lies outside is not."""
    for found in uncertain:
        assert found.interval_g is not None
        low, high = found.interval_g
        assert found.a_crit_g == pytest.approx((low + high) / 2, rel=1e-12)
        assert found.uncertainty_g == pytest.approx((high - low) / 2, rel=1e-9)
        assert [found.at(g) for g in (low, (low + high) / 2, high)] == [Verdict.SURVIVES, Verdict.UNDECIDED, Verdict.FAILS]
        assert found.survived_g is not None and low <= found.survived_g <= high


def test_contributions_add_up_to_the_interval(uncertain: opshock.Store) -> None:
    """Both ends are the highest survivor less and plus the contributions; each has a known safety factor."""
    for found in uncertain:
        assert found.interval_g is not None and found.survived_g is not None
        parts: list[opshock.Contribution] = list(found.contributions.values())
        assert {"search", "film_grid"} <= set(found.contributions)
        assert found.survived_g - found.interval_g[0] == pytest.approx(sum(part.low_g for part in parts), rel=1e-9)
        assert found.interval_g[1] - found.survived_g == pytest.approx(sum(part.high_g for part in parts), rel=1e-9)
        assert {part.factor for part in parts} <= {1.0, 1.25, 3.0}
        assert found.failed_g is not None
        assert found.contributions["search"].high_g == pytest.approx(found.failed_g - found.survived_g, rel=1e-9)
        assert found.contributions["search"].low_g == 0.0


@pytest.mark.parametrize(
    ("flag", "below", "above"),
    [
        ("window", Verdict.UNDECIDED, Verdict.FAILS),
        ("window_undecided", Verdict.UNDECIDED, Verdict.FAILS),
        ("undecided_amplitude", Verdict.UNDECIDED, Verdict.FAILS),
        ("contribution_missing", Verdict.UNDECIDED, Verdict.UNDECIDED),
        ("safety_factor_3", Verdict.SURVIVES, Verdict.FAILS),
        ("non_monotone", Verdict.SURVIVES, Verdict.FAILS),
    ],
)
def test_flags_leave_undecided_what_qualify_does(flag: str, below: Verdict, above: Verdict) -> None:
    """A survivor in doubt survives nothing; an interval without a contribution decides nothing."""
    flagged = row(flags=(flag,), brackets_g=((495.0, 505.0), (900.0, 950.0)))
    assert (flagged.at(479.0), flagged.at(500.0), flagged.at(521.0)) == (below, Verdict.UNDECIDED, above)
    # Some shock below 900 G fails.
    assert flagged.at(900.0) is above
