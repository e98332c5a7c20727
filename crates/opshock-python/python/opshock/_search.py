"""The search of a critical shock whose verdicts come from outside."""

from __future__ import annotations

import json
from dataclasses import dataclass

from . import _native
from ._records import record
from ._run import Run
from ._study import Scene, only_point
from ._verdict import Verdict


@dataclass(frozen=True)
class SearchResult:
    """What a search knows. Amplitudes are multiples of standard gravity."""

    status: str
    """``ok``, ``above_range``, ``below_range``, ``undecided``, or ``open`` while the search goes on."""
    survived_g: float | None
    """Highest survivor below the lowest failure."""
    failed_g: float | None
    """Lowest failure."""
    brackets_g: tuple[tuple[float, ...], ...]
    """Every survivor with the next higher failure: several where failure is not monotone."""
    flags: tuple[str, ...]
    """What a reader must know."""
    runs: int
    """Verdicts taken."""


class Search:
    """Asks for amplitudes and receives verdicts: those of a drop table, of another program, or of many searches run together.

    ::

        search = opshock.Search(scene)
        while (amplitude_g := search.ask()) is not None:
            search.tell(my_verdict(amplitude_g))
        print(search.result.survived_g, search.result.failed_g)

    Range, tolerance and scan are those of the scene's study: ``search.amplitude_g``, ``search.tolerance_pct``,
    ``search.monotonicity_scan``.
    """

    def __init__(self, scene: Scene, *, hint_g: float | None = None) -> None:
        """Begins a search; near ``hint_g``, in multiples of standard gravity, if that is given."""
        only_point(scene)
        if hint_g is not None and not hint_g > 0:
            raise ValueError(f"hint_g = {hint_g}: must be an amplitude > 0")
        self._search = _native.Search(scene._study, hint_g)

    def ask(self) -> float | None:
        """The amplitude to try next, multiples of standard gravity; ``None`` when the search has its answer."""
        asked = self._search.ask()
        return asked[0] if asked else None

    @property
    def purpose(self) -> str | None:
        """What the amplitude is asked for: ``bracketing``, ``bisect``, ``scan``; ``None`` at the end."""
        asked = self._search.ask()
        return asked[1] if asked else None

    def tell(self, verdict: Verdict | Run, min_clearance_m: float | None = None) -> None:
        """The verdict of the amplitude asked for, or the run that has it.

        The smallest clearance of a survivor, m, may save simulations; it decides nothing.
        """
        if isinstance(verdict, Run):
            if (asked := self.ask()) is not None and verdict.amplitude_g != asked:
                raise ValueError(f"the run is of {verdict.amplitude_g} G, asked for were {asked} G")
            min_clearance_m = verdict.min_clearance_m
            verdict = Verdict.UNDECIDED if verdict.verdict is None else verdict.verdict
        self._search.tell(Verdict(verdict).value, min_clearance_m)

    @property
    def result(self) -> SearchResult:
        """What is known now."""
        return record(SearchResult, json.loads(self._search.findings()))
