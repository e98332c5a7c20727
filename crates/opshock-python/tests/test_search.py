"""The search by asking and telling."""

from __future__ import annotations

from collections.abc import Callable

import opshock
import pytest
from opshock import Run, Search, SearchResult, Verdict


def searched(search: Search, answer: Callable[[float], Verdict | Run]) -> tuple[SearchResult, list[float]]:
    """Runs a search to its end; what it found and what it asked."""
    asked: list[float] = []
    while (amplitude_g := search.ask()) is not None:
        assert len(asked) < 200, "a search must end"
        asked.append(amplitude_g)
        search.tell(answer(amplitude_g))
    return search.result, asked


def fails_from(threshold_g: float) -> Callable[[float], Verdict]:
    """Survives below the threshold and fails from it on."""
    return lambda amplitude_g: Verdict.FAILS if amplitude_g >= threshold_g else Verdict.SURVIVES


@pytest.fixture(scope="session")
def scanned(small_toml: str) -> opshock.Scene:
    """The scene without a ramp, whose search looks for further failures below the first."""
    text = small_toml.replace('monotonicity_scan = "off"', 'monotonicity_scan = "sampled"')
    return opshock.Study.from_toml(text).scene(ramp="none", pulse_ms=2)


@pytest.mark.parametrize("threshold_g", [120.0, 150.0, 333.3, 574.8, 1000.0, 1400.0])
def test_the_threshold_is_bracketed_within_the_tolerance(free: opshock.Scene, threshold_g: float) -> None:
    """5 % at most between the survivor and the failure around the threshold."""
    result, asked = searched(Search(free), fails_from(threshold_g))
    assert result.status == "ok"
    assert result.survived_g is not None and result.failed_g is not None
    assert result.survived_g < threshold_g <= result.failed_g
    assert result.failed_g / result.survived_g <= 1.05
    assert result.brackets_g == ((result.survived_g, result.failed_g),)
    assert result.flags == ()
    assert result.runs == len(asked) == len(set(asked))
    assert max(asked) <= 1500.0 and min(asked) >= 100.0


def test_above_and_below_the_range(free: opshock.Scene) -> None:
    """The range is 100 to 1500 G; its ends are the amplitudes next to them on the grid."""
    above, asked = searched(Search(free), fails_from(1e9))
    assert (above.status, above.survived_g, above.failed_g) == ("above_range", max(asked), None)
    assert 1500 / 1.05 < max(asked) <= 1500
    below, asked = searched(Search(free), fails_from(0.0))
    assert (below.status, below.survived_g, below.failed_g) == ("below_range", None, min(asked))
    assert 100 <= min(asked) < 105


def test_failures_that_are_not_monotone_are_flagged(scanned: opshock.Scene) -> None:
    """A second region of failure below the first is found by the scan, and both brackets are reported."""

    def answer(amplitude_g: float) -> Verdict:
        return Verdict.FAILS if amplitude_g >= 1000 or 560 <= amplitude_g < 720 else Verdict.SURVIVES

    result, _ = searched(Search(scanned), answer)
    assert result.status == "ok"
    assert "non_monotone" in result.flags
    assert len(result.brackets_g) == 2
    (low, first), (next_low, second) = result.brackets_g
    assert low < 560 <= first <= next_low < 1000 <= second
    assert (result.survived_g, result.failed_g) == (low, first)


def test_monotone_failures_are_not_flagged(scanned: opshock.Scene) -> None:
    """The same search without the second region: one bracket."""
    result, asked = searched(Search(scanned), fails_from(1000.0))
    assert "non_monotone" not in result.flags
    assert len(result.brackets_g) == 1
    survivors = sorted(g for g in asked if g < 1000)
    assert len([g for g in survivors if g < 800]) >= 3, "the scan looks below the bracket"


def test_undecided_verdicts_end(free: opshock.Scene) -> None:
    """Nothing but undecided: no bracket, and no amplitude twice."""
    result, asked = searched(Search(free), lambda _: Verdict.UNDECIDED)
    assert (result.status, result.survived_g, result.failed_g) == ("undecided", None, None)
    assert "undecided_amplitude" in result.flags
    assert len(asked) == len(set(asked))


def test_runs_are_the_verdicts_taken(free: opshock.Scene) -> None:
    """One for each tell, undecided or not."""
    result, asked = searched(Search(free), lambda _: Verdict.UNDECIDED)
    assert result.runs == len(asked)


def test_undecided_amplitudes_lie_within_the_bracket(free: opshock.Scene) -> None:
    """A gap without verdicts from 500 to 700 G: the bracket is around it."""

    def answer(amplitude_g: float) -> Verdict:
        return Verdict.UNDECIDED if 500 < amplitude_g < 700 else fails_from(600.0)(amplitude_g)

    result, _ = searched(Search(free), answer)
    assert result.survived_g is not None and result.failed_g is not None
    assert 500 / 1.05 < result.survived_g <= 500
    assert 700 <= result.failed_g < 700 * 1.05


def test_driven_by_simulate_it_is_the_critical_shock(free: opshock.Scene, store: opshock.Store) -> None:
    """The same bracket as the sweep has for the scene without a ramp."""
    result, _ = searched(Search(free), lambda amplitude_g: opshock.simulate(free, amplitude_g))
    swept = store.select(ramp="none", pulse_ms=2)[0]
    assert (result.status, result.survived_g, result.failed_g) == (swept.status, swept.survived_g, swept.failed_g)


def test_a_run_is_reported_as_its_verdict_with_its_clearance(free: opshock.Scene) -> None:
    """Telling a run is telling verdict and smallest clearance; a clearance decides nothing."""
    run = opshock.simulate(free, Search(free).ask() or 0.0)
    assert run.verdict is Verdict.SURVIVES
    told, apart, bare = Search(free), Search(free), Search(free)
    told.tell(run)
    apart.tell(run.verdict, run.min_clearance_m)
    bare.tell(run.verdict)
    assert told.result == apart.result == bare.result
    assert told.ask() == apart.ask()


def test_a_hint_saves_verdicts(free: opshock.Scene) -> None:
    """Begun near the answer the search takes fewer verdicts, and finds the same."""
    far, asked = searched(Search(free), fails_from(700.0))
    near, fewer = searched(Search(free, hint_g=690.0), fails_from(700.0))
    assert (near.survived_g, near.failed_g) == (far.survived_g, far.failed_g)
    assert len(fewer) < len(asked)
    assert abs(fewer[0] / 690 - 1) < 0.05


def test_purposes_and_the_open_search(free: opshock.Scene) -> None:
    """First the bracket, then bisection; asking twice is asking once; at the end there is no purpose."""
    search = Search(free)
    assert search.result == SearchResult(status="open", survived_g=None, failed_g=None, brackets_g=(), flags=(), runs=0)
    purposes: list[str | None] = []
    while (amplitude_g := search.ask()) is not None:
        assert search.ask() == amplitude_g
        purposes.append(search.purpose)
        search.tell(fails_from(574.8)(amplitude_g))
    assert purposes == 2 * ["bracketing"] + (len(purposes) - 2) * ["bisect"]
    assert len(purposes) > 4
    assert search.purpose is None


def test_told_after_the_end_it_raises(free: opshock.Scene) -> None:
    """And what it knows stays."""
    search = Search(free)
    result, _ = searched(search, fails_from(300.0))
    with pytest.raises(RuntimeError, match="the search has its answer"):
        search.tell(Verdict.FAILS)
    assert search.result == result


def test_only_verdicts_are_taken(free: opshock.Scene) -> None:
    """A truth value is no verdict, and is not taken for one."""
    search = Search(free)
    with pytest.raises(ValueError, match="True is not a valid Verdict"):
        search.tell(True)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    assert search.result.runs == 0


def test_a_run_of_another_amplitude_is_refused(free: opshock.Scene) -> None:
    """And a hint that is no amplitude."""
    search = Search(free)
    asked = search.ask()
    assert asked is not None
    with pytest.raises(ValueError, match="asked for were"):
        search.tell(opshock.simulate(free, asked / 2))
    assert search.result.runs == 0
    with pytest.raises(ValueError, match="hint_g = -5"):
        Search(free, hint_g=-5)
