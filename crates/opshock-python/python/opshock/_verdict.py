"""Verdicts, which are never a bool."""

import enum
from typing import NoReturn


class Verdict(enum.Enum):
    """Whether the interface survives a shock: yes, no, or not known.

    It has no truth value, since ``if verdict:`` would take *undecided* for one of the others. Compare it:
    ``run.verdict is Verdict.SURVIVES``.
    """

    SURVIVES = "survives"
    """The slider does not touch the disk, or is not damaged where that is called failure (``failure.criterion``)."""
    FAILS = "fails"
    """It does, or is."""
    UNDECIDED = "undecided"
    """The simulation, or the uncertainty interval, does not say."""

    def __bool__(self) -> NoReturn:
        raise TypeError(f"a verdict has three values and no truth value: compare it, as `verdict is Verdict.{self.name}`")
