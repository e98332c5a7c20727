"""Verdicts, which are never a bool."""

import enum
from typing import NoReturn


class Verdict(enum.Enum):
    """Whether the interface survives a shock: yes, no, or not known.

    It has no truth value, since ``if verdict:`` would take *undecided* for one of the others. Compare it:
    ``run.verdict is Verdict.SURVIVES``.
    """

    SURVIVES = "survives"
    """The slider does not touch the disk."""
    FAILS = "fails"
    """It does: the clearance falls to the limit of failure."""
    UNDECIDED = "undecided"
    """The simulation, or the uncertainty interval, does not say."""

    def __bool__(self) -> NoReturn:
        raise TypeError(f"a verdict has three values and no truth value: compare it, as `verdict is Verdict.{self.name}`")
