"""How a hard disk drive's head-disk interface survives operational shock.

::

    import opshock

    study = opshock.Study("my-drive.toml")
    run = opshock.simulate(study.scene(ramp="rigid", pulse_ms=2, sign="+"), 400, history=True)
    store = opshock.sweep(study, "my-drive.opshock", progress=True)
    store.plot()

Every number is that of the command line, to the bit. Names end in their units; results never change.
"""

from . import _native
from ._errors import ChoiceError, Fault, OpshockError, StoreError, StudyError
from ._run import (
    ArmContact,
    Base,
    Columns,
    Complementarity,
    ContactEpisode,
    ContactWork,
    Cost,
    Dimple,
    DiskMotion,
    Energy,
    HeadEnergy,
    History,
    Hub,
    Mechanism,
    Place,
    PressureFields,
    RampContact,
    Run,
    RunWarning,
    SliderContact,
    SliderEpisode,
    Steady,
    Stop,
    simulate,
    simulate_many,
)
from ._search import Search, SearchResult
from ._store import Contribution, CriticalShock, Progress, Store, critical_shock, open_store, sweep
from ._study import OpshockWarning, Scene, Study
from ._verdict import Verdict

__all__ = [
    "ArmContact",
    "Base",
    "ChoiceError",
    "Columns",
    "Complementarity",
    "ContactEpisode",
    "ContactWork",
    "Contribution",
    "Cost",
    "CriticalShock",
    "Dimple",
    "DiskMotion",
    "Energy",
    "Fault",
    "HeadEnergy",
    "History",
    "Hub",
    "Mechanism",
    "OpshockError",
    "OpshockWarning",
    "Place",
    "PressureFields",
    "Progress",
    "RampContact",
    "Run",
    "RunWarning",
    "Scene",
    "Search",
    "SearchResult",
    "SliderContact",
    "SliderEpisode",
    "Steady",
    "Stop",
    "Store",
    "StoreError",
    "Study",
    "StudyError",
    "Verdict",
    "critical_shock",
    "open_store",
    "program",
    "simulate",
    "simulate_many",
    "sweep",
]

__version__ = _native.program().split()[1]


def program() -> str:
    """This program, as every result names it: version, commit, physics versions of structure and head."""
    return _native.program()
