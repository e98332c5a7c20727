"""One simulated shock: verdict, numbers and history."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _html, _native
from ._records import record
from ._study import Scene
from ._verdict import Verdict

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    Array = npt.NDArray[np.float64]


def _array(numbers: bytes) -> Array:
    # Imported with the first history: it takes half of the package's start.
    import numpy as np

    return np.frombuffer(numbers)


@dataclass(frozen=True)
class Place:
    """A place on the slider."""

    x_m: float
    """From the leading edge, m."""
    y_m: float
    """From the inner edge, m."""


@dataclass(frozen=True)
class Mechanism:
    """Why a shock failed, by its forces and times at the touch. Forces are over the steady force of the dimple."""

    name: str
    """``limiter``, ``lift_tab``, ``dimple_separation``, ``ramp_impact``, ``lift_loss``, ``compression`` or ``other``."""
    dimple_open_before_s: float | None
    """Since the dimple was last open, s; ``None``: it never was."""
    limiter_before_s: float | None
    """Since a limiter was last closed, s."""
    lift_tab_before_s: float | None
    """Since the lift tab's stop was last closed, s."""
    ramp_contact_before_s: float | None
    """Since disk and ramp were last in contact, s; 0 while they are."""
    ramp_began_before_s: float | None
    """Since that contact began, s."""
    dimple_over_steady: float
    """Force of the dimple, dimensionless."""
    bearing_over_steady: float
    """Net force of the air bearing, dimensionless; negative: suction."""
    bearing_range_over_steady: float
    """Largest less smallest net force of the air bearing in the last 50 us, dimensionless."""


@dataclass(frozen=True)
class Steady:
    """Steady flight before the shock."""

    min_clearance_m: float
    """Smallest clearance, m."""
    pitch_rad: float
    """Pitch, rad, positive with the leading edge up."""
    roll_rad: float
    """Roll, rad, positive with the outer edge up."""


@dataclass(frozen=True)
class DiskMotion:
    """Extremes of the disk over the simulated time."""

    slider_max_m: float | None
    """Largest displacement under the slider, m."""
    slider_min_m: float | None
    """Smallest displacement under the slider, m."""
    ramp_max_m: float | None
    """Largest displacement at the ramp, m."""
    ramp_min_m: float | None
    """Smallest displacement at the ramp, m."""
    rim_max_m: float | None
    """Largest displacement at the rim, m."""


@dataclass(frozen=True)
class ContactEpisode:
    """One episode of contact between disk and ramp."""

    on_s: float
    """Begin, s."""
    off_s: float
    """End, s."""
    impulse_n_s: float
    """Impulse, N s."""
    peak_20us_n: float
    """Peak of the force's running mean over 20 microseconds, N."""


@dataclass(frozen=True)
class ArmContact:
    """Contact with one arm of the ramp."""

    first_touch_s: float | None
    """First touch, s."""
    impulse_n_s: float
    """Impulse of all episodes, N s."""
    episodes: tuple[ContactEpisode, ...]
    """The episodes."""


@dataclass(frozen=True)
class RampContact:
    """Contact with both arms of the ramp."""

    top: ArmContact
    """Upper arm."""
    bottom: ArmContact
    """Lower arm."""


@dataclass(frozen=True)
class Dimple:
    """The dimple while the head was simulated."""

    min_force_n: float
    """Smallest force, N."""
    open_s: float
    """Time open, s."""


@dataclass(frozen=True)
class Stop:
    """The suspension's limiters together, or its lift tab."""

    max_force_n: float
    """Largest contact force, N."""
    first_s: float | None
    """First contact, s."""
    closed_s: float
    """Time closed, s."""


@dataclass(frozen=True)
class ContactWork:
    """Work of slider and disk on the asperities in an episode of contact."""

    loading_j: float
    """In the steps in which it was positive, and what they held as the episode began, J."""
    unloading_j: float
    """What they gave back in the others, J."""


@dataclass(frozen=True)
class SliderEpisode:
    """One contact of slider and disk."""

    on_s: float
    """Begin, s."""
    off_s: float
    """End, s."""
    approach_m_per_s: float
    """Speed at which the clearance fell in the step that began it, m/s; negative where it rose again."""
    impulse_n_s: float
    """Impulse of the asperities on the slider, N s."""
    peak_force_n: float
    """Largest normal force, N."""
    peak_pressure_pa: float
    """Largest pressure of a nominal area, Pa."""
    closest_m: float
    """Smallest distance of the mean planes, m; negative where they overlap."""
    place: Place
    """Place of the smallest clearance at the largest force."""
    friction_j: float
    """Work of friction, J."""
    mean_pressure_pa: float
    """Pressure at the largest force, its mean over that force, Pa."""
    work: ContactWork | None = None
    """Work of slider and disk on the asperities, of a run that goes on after its failure."""


@dataclass(frozen=True)
class HeadEnergy:
    """Energy balance of slider and suspension over a run through its contacts, beyond the energy of steady flight."""

    start_j: float
    """Kinetic and elastic at the onset, J: 0 without run-out."""
    kinetic_j: float
    """Kinetic energy at the end, J."""
    elastic_j: float
    """Energy at the end in modes, gimbal, dimple, limiters and lift tab, J."""
    peak_j: float
    """Largest sum of both, J."""
    shock_work_j: float
    """Work of the shock's inertia load, and of a pivot that moves, J."""
    film_work_j: float
    """Work on the slider of what acts in the gap beside the asperities, less the whole steady force, J."""
    contact_work_j: float
    """Work of the asperities' pressure on the slider, J."""
    friction_work_j: float
    """Work of their friction's couple on the slider, J; not the heat of ``friction_j``."""
    damping_loss_j: float
    """Loss in dampers, J."""
    imbalance_j: float
    """Gain of energy and losses less works, J: the error of the time integration and of the works' own integration."""


@dataclass(frozen=True)
class SliderContact:
    """Contact of slider and disk by their asperities; also after the first touch, if ``slider_contact`` is among the outputs."""

    touch_s: float | None
    """Time at which the smallest clearance first fell below ``failure.clearance_nm``, or below zero where damage is the failure, s."""
    episodes: tuple[SliderEpisode, ...]
    """The contacts: from a force above 1 % of the dimple's steady force until one below half of that."""
    end: str
    """``flying`` or ``in_contact``."""
    yielded_j: float
    """Work that the asperities do not give back, J."""
    energy: HeadEnergy | None = None
    """Energy balance of slider and suspension, of a run that goes on after its failure."""


@dataclass(frozen=True)
class Energy:
    """Energy balance of disk and ramp."""

    kinetic_j: float
    """Kinetic energy at the end, J."""
    elastic_j: float
    """Elastic energy at the end, J."""
    h_end_j: float
    """Energy H, on which a space-fixed ramp does no work, at the end, J."""
    h_peak_j: float
    """Its largest value, J."""
    shock_work_j: float
    """Work of the shock, J."""
    damping_loss_j: float
    """Loss by damping, J."""
    impact_loss_j: float
    """Loss by impacts, J."""
    algorithmic_j: float
    """Work of the discretisation, J."""
    spindle_work_j: float
    """Work of the spindle, J."""
    closure: float
    """Residual of the balance, a share of the largest H."""


@dataclass(frozen=True)
class Complementarity:
    """How well the contact conditions were met."""

    max_penetration_m: float
    """Largest penetration, m."""
    min_multiplier_n_s: float
    """Smallest contact impulse, N s; negative would be adhesion."""
    max_product_n_s_m: float
    """Largest product of gap and impulse, N s m."""


@dataclass(frozen=True)
class Hub:
    """A hub on its bearing."""

    axial_max_m: float
    """Largest axial displacement, m."""
    tilt_max_rad: float
    """Largest tilt, rad."""
    shock_n_s: float
    """Axial impulse of the shock, N s."""
    bearing_n_s: float
    """Axial impulse of the bearing, N s."""
    contact_n_s: float
    """Axial impulse of the ramp, N s."""
    momentum_closure: float
    """Residual of the momentum balance, a share of the largest momentum."""


@dataclass(frozen=True)
class Base:
    """A base that vibrates."""

    spindle_max_m: float
    """Largest displacement of the spindle over the base as it would move rigidly, m."""
    ramp_max_m: float
    """That of the ramp's mount, m."""
    pivot_max_m: float
    """That of the actuator's pivot, m."""
    shock_n_s: float
    """Impulse of the shock along the modes' participations, N s."""
    mounts_n_s: float
    """Impulse of springs and dampers of the modes, N s."""
    contact_n_s: float
    """Impulse of the contact between disk and ramp, N s."""
    momentum_closure: float
    """Residual of the momentum balance, a share of the largest momentum."""


@dataclass(frozen=True)
class RunWarning:
    """Something that the simulation noticed."""

    code: str
    """Stable code."""
    message: str
    """What was noticed."""


@dataclass(frozen=True)
class Cost:
    """What a simulation cost."""

    steps: int
    """Accepted steps of the head."""
    rejected: int
    """Rejected steps."""
    film_solves: int
    """Linear systems of the film solved."""
    factorisations: int
    """Matrices of the film factorised."""
    film_unknowns: int
    """Unknowns of the film."""
    structure_steps: int
    """Steps of disk and ramp."""
    wall_s: float = field(compare=False)
    """Measured time, s, left out when runs are compared: the only number that differs from run to run."""


@dataclass(frozen=True)
class Run:
    """The answer of one simulated shock. Times are on the study's axis, on which the pulse begins at ``pulse.start_ms``."""

    scene: Scene
    """What was simulated."""
    amplitude_g: float
    """Amplitude without sign, multiples of standard gravity."""
    verdict: Verdict | None
    """Whether the interface survives; ``None`` when the study asks for no verdict."""
    cause: str | None
    """Why there is no verdict."""
    t_fail_s: float | None
    """Time of the failure, s."""
    place: Place | None
    """Place of the smallest clearance then."""
    min_clearance_m: float | None
    """Smallest clearance between slider and disk, m."""
    t_min_clearance_s: float | None
    """When, s."""
    steady: Steady | None
    """Steady flight before the shock."""
    disk: DiskMotion
    """Extremes of the disk."""
    contact: RampContact
    """Contact of disk and ramp."""
    dimple: Dimple | None
    """The dimple."""
    energy: Energy
    """Energy balance."""
    complementarity: Complementarity
    """How well the contact conditions were met."""
    effects: tuple[str, ...]
    """Effects that were simulated."""
    rules: tuple[str, ...]
    """Rules by which others were left out or shared: see ``opshock explain``."""
    warnings: tuple[RunWarning, ...]
    """What the simulation noticed."""
    cost: Cost
    """What it cost."""
    limiters: Stop | None = None
    """The suspension's limiters, if there are some."""
    lift_tab: Stop | None = None
    """The lift tab, if there is one."""
    slider_contact: SliderContact | None = None
    """Contact of slider and disk, if asperities bear."""
    hub: Hub | None = None
    """The hub, of a disk on a bearing."""
    base: Base | None = None
    """The base, when it vibrates."""
    mechanism: Mechanism | None = field(default=None, compare=False)
    """Why it failed; of a shock that failed and whose history was asked for."""
    history: History | None = field(default=None, compare=False)
    """Columns over time, when they were asked for; left out when runs are compared."""

    def _repr_html_(self) -> str:
        rows = [("verdict", "none" if self.verdict is None else self.verdict.value)]
        rows += [(name, f"{value:.6g}") for name in ("t_fail_s", "min_clearance_m") if (value := getattr(self, name)) is not None]
        return _html.table(f"{self.scene.label}, {self.amplitude_g:g} G", ["", ""], rows)


class Columns(Mapping[str, "Array"]):
    """Columns of numbers on one time, by name; the name ends in the unit. The arrays are read-only."""

    def __init__(self, columns: Iterable[tuple[str, str, str, bytes]]) -> None:
        self._columns = {name: (units, description, _array(numbers)) for name, units, description, numbers in columns}

    def __getitem__(self, name: str) -> Array:
        return self._columns[name][2]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self)} columns of {len(self['time_s']) if self else 0} values>"

    def units(self, name: str) -> str:
        """Unit of a column, as ``m/s2``."""
        return self._columns[name][0]

    def description(self, name: str) -> str:
        """What a column is, in a sentence."""
        return self._columns[name][1]

    def to_pandas(self) -> pd.DataFrame:
        """A table with ``time_s`` as its index."""
        import pandas as pd

        return pd.DataFrame(dict(self)).set_index("time_s")

    def to_xarray(self) -> xr.Dataset:
        """A dataset over ``time_s``; every variable has ``units`` and ``long_name``."""
        import xarray as xr

        def variable(name: str) -> Any:
            return ("time_s", self[name], {"units": self.units(name), "long_name": self.description(name)})

        data = {name: variable(name) for name in self if name != "time_s"}
        return xr.Dataset(data, coords={"time_s": variable("time_s")})


@dataclass(frozen=True)
class PressureFields:
    """The film at the times asked for by the study's ``fields.times_ms``."""

    time_s: Array
    """Times, s."""
    y_lines_m: Array
    """Grid lines across the slider from its inner edge, m."""
    x_lines_m: Array
    """Grid lines along the slider from its leading edge, m."""
    pressure_pa: Array
    """Absolute pressure in the middle of every cell, Pa: time, y, x."""
    gap_m: Array
    """Height of the slider's surface over the disk there, m: time, y, x."""


class History(Columns):
    """Columns over the time of disk and ramp; those of the head are interpolated to it."""

    def __init__(
        self, root: Iterable[tuple[str, str, str, bytes]], head: Iterable[tuple[str, str, str, bytes]], fields: list[bytes] | None
    ) -> None:
        super().__init__(root)
        self._head = Columns(head)
        self._fields: PressureFields | None = None
        if fields:
            time, y, x, pressure, gap = map(_array, fields)
            shape = (len(time), len(y) - 1, len(x) - 1)
            self._fields = PressureFields(time, y, x, pressure.reshape(shape), gap.reshape(shape))

    @property
    def head(self) -> Columns:
        """The head at its own steps, which end at its failure; empty without one."""
        return self._head

    @property
    def fields(self) -> PressureFields | None:
        """Pressure fields, when the study asks for some."""
        return self._fields

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draws disk, ramp and clearance over time with matplotlib."""
        from ._plots import plot_history

        return plot_history(self, axes)


def _run(scene: Scene, amplitude_g: float, answer: str, history: History | None = None) -> Run:
    values = json.loads(answer)
    return record(Run, {**values, "scene": scene, "amplitude_g": float(amplitude_g), "history": history})


def simulate(scene: Scene, amplitude_g: float, *, history: bool = False) -> Run:
    """Simulates one shock of ``amplitude_g`` times standard gravity: the numbers of ``opshock run``.

    With ``history`` the columns over time are kept. An amplitude has no sign: the scene's :attr:`Scene.sign` has it. Ctrl-C
    waits for the end of the simulation.
    """
    answer, kept = _native.simulate(scene._study, amplitude_g, history)
    return _run(scene, amplitude_g, answer, History(*kept) if kept else None)


def cores(threads: int | None) -> int:
    """Threads asked for, else the cores that this process may use."""
    if threads is not None:
        if threads < 1:
            raise ValueError(f"threads = {threads}: must be at least 1")
        return threads
    return _native.cores()


def simulate_many(shocks: Iterable[tuple[Scene, float]], *, threads: int | None = None) -> list[Run]:
    """Simulates many shocks, pairs of scene and amplitude in multiples of standard gravity, on all cores.

    The answers are those of :func:`simulate`, to the bit, in the order of the shocks. Shocks of the same scene object share
    what its simulation prepares, so that a batch of them takes less time than one by one. Ctrl-C ends it, after
    the simulations at work.
    """
    pairs = [(scene, float(amplitude)) for scene, amplitude in shocks]
    distinct = list({id(scene): scene for scene, _ in pairs}.values())
    place = {id(scene): number for number, scene in enumerate(distinct)}
    natives = [scene._study for scene in distinct]
    answers = _native.simulate_many(natives, [(place[id(scene)], amplitude) for scene, amplitude in pairs], cores(threads))
    return [_run(scene, amplitude, answer) for (scene, amplitude), answer in zip(pairs, answers, strict=True)]
