"""One simulated shock: its numbers, its history, and that neither changes."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import opshock
import pytest
from opshock import Columns, History, PressureFields, Run, Verdict


@pytest.fixture(scope="module")
def equipped(study: opshock.Study) -> Run:
    """A shock of a drive with all that is optional: hub, base, limiters, lift tab, pressure fields."""
    mode = {"frequency_hz": 900.0, "damping_ratio": 0.02, "participation_sqrt_kg": 0.25}
    mode |= {"spindle_per_sqrt_kg": 2.0, "ramp_per_sqrt_kg": 2.4, "pivot_per_sqrt_kg": 1.6}
    settings = {
        "outputs": ["critical_shock", "pressure_field"],
        "fields.times_ms": [0.6, 0.8],
        "hub": {"axial_stiffness_n_per_m": 8e6, "tilt_stiffness_n_m_per_rad": 300.0, "mass_mg": 15000.0},
        "base.modes": [mode],
        "suspension.limiters.gap_um": 20.0,
        "suspension.lift_tab.gap_um": 20.0,
    }
    return opshock.simulate(study.scene(ramp="rigid", pulse_ms=2, settings=settings), 400, history=True)


def held(run: Run) -> History:
    """The history of a run that has one."""
    assert run.history is not None
    return run.history


def test_a_shock_that_is_survived(survived: Run, rigid: opshock.Scene) -> None:
    """It clears the disk, and touches the ramp from above."""
    assert survived.scene is rigid
    assert survived.amplitude_g == 400.0 and type(survived.amplitude_g) is float
    assert (survived.verdict, survived.cause) == (Verdict.SURVIVES, None)
    assert (survived.t_fail_s, survived.place) == (None, None)
    assert survived.steady is not None and survived.min_clearance_m is not None
    assert 0 < survived.min_clearance_m < survived.steady.min_clearance_m
    assert survived.contact.top.first_touch_s is not None and survived.contact.bottom.first_touch_s is None
    assert survived.disk.ramp_max_m == pytest.approx(100e-6, rel=0.01), "the ramp is 100 um away"
    assert survived.warnings == ()


def test_what_comes_after_the_touch_of_rough_surfaces(study: opshock.Study) -> None:
    """The slider bounces on the disk, which never bears more than the yield pressure."""
    settings = {"outputs": ["critical_shock", "slider_contact"], "asperity_contact.roughness_nm": 0.5}
    run = opshock.simulate(study.scene(ramp="none", pulse_ms=2, settings=settings), 900)
    assert run.verdict is Verdict.FAILS and run.t_fail_s is not None
    contact: opshock.SliderContact | None = run.slider_contact
    assert contact is not None and contact.end in ("flying", "in_contact") and contact.yielded_j > 0
    assert contact.touch_s == run.t_fail_s, "a touch is the failure"
    assert len(contact.episodes) > 3, "it bounces"
    first: opshock.SliderEpisode = contact.episodes[0]
    assert first.on_s < first.off_s and abs(first.on_s - run.t_fail_s) < 0.3e-3
    assert all(episode.off_s <= later.on_s for episode, later in zip(contact.episodes, contact.episodes[1:], strict=False))
    for episode in contact.episodes:
        assert 0 < episode.peak_pressure_pa <= 12e9 and episode.peak_force_n > 0 and episode.impulse_n_s > 0
        # Friction: 0.3 of the impulse, at the disk's speed under the slider.
        assert 2 < episode.friction_j / (0.3 * episode.impulse_n_s) < 30
        # Up to what the integration over steps is off by, no contact gives back more than it took.
        work: opshock.ContactWork | None = episode.work
        assert work is not None and work.loading_j > 0 and 0 <= work.unloading_j < 1.1 * work.loading_j
        assert 0 <= episode.place.x_m <= 0.85e-3 and episode.closest_m < 5e-9
        assert 0 < episode.mean_pressure_pa <= episode.peak_pressure_pa
    assert max(episode.approach_m_per_s for episode in contact.episodes) > 0
    energy: opshock.HeadEnergy | None = contact.energy
    assert energy is not None and energy.shock_work_j > 0
    works = energy.shock_work_j + energy.film_work_j + energy.contact_work_j + energy.friction_work_j
    left = works - energy.damping_loss_j - energy.kinetic_j - energy.elastic_j
    assert left == pytest.approx(-energy.imbalance_j, abs=1e-9 * energy.peak_j), "the shock starts from rest"
    assert abs(energy.imbalance_j) < 0.5 * energy.peak_j, "impacts are shorter than the steps of the preset coarse"


def test_a_shock_that_is_not(failed: Run) -> None:
    """The slider touches at a place on it, in time."""
    assert failed.verdict is Verdict.FAILS
    place: opshock.Place | None = failed.place
    assert failed.t_fail_s is not None and place is not None
    assert 0.5e-3 < failed.t_fail_s <= 3e-3
    assert failed.t_fail_s == failed.t_min_clearance_s
    assert failed.min_clearance_m == 0.0
    assert 0 <= place.x_m <= 0.85e-3 and 0 <= place.y_m <= 0.70e-3
    mechanism: opshock.Mechanism | None = failed.mechanism
    assert mechanism is not None and mechanism.name == "ramp_impact", "600 G is far beyond first touch"
    assert mechanism.ramp_contact_before_s is not None and mechanism.ramp_began_before_s is not None
    assert mechanism.ramp_contact_before_s < 1e-4 and mechanism.ramp_contact_before_s <= mechanism.ramp_began_before_s
    assert mechanism.bearing_range_over_steady > 0.25 and 0 < mechanism.dimple_over_steady < 10
    others = (mechanism.dimple_open_before_s, mechanism.limiter_before_s, mechanism.lift_tab_before_s)
    assert others[1:] == (None, None), "it has neither"
    assert others[0] is None or others[0] > 2e-5
    head = held(failed)["bearing_force_n"]
    assert mechanism.bearing_over_steady == pytest.approx(head[~np.isnan(head)][-1] / held(failed)["dimple_force_n"][0], rel=0.2)


def test_contact_and_energy(failed: Run) -> None:
    """Impulses of episodes add up, the contact does not attract, and the energy balances."""
    episodes: tuple[opshock.ContactEpisode, ...] = failed.contact.top.episodes
    arm: opshock.ArmContact = failed.contact.top
    both: opshock.RampContact = failed.contact
    assert arm.impulse_n_s == pytest.approx(sum(one.impulse_n_s for one in episodes), rel=1e-9)
    assert arm.impulse_n_s > 0
    assert arm.first_touch_s == episodes[0].on_s
    assert all(one.on_s < one.off_s and one.peak_20us_n > 0 for one in episodes)
    assert both.bottom.impulse_n_s == 0.0
    energy: opshock.Energy = failed.energy
    assert abs(energy.closure) < 1e-10
    left = energy.shock_work_j + energy.algorithmic_j - energy.damping_loss_j - energy.impact_loss_j
    assert energy.h_end_j == pytest.approx(left, rel=1e-9)
    assert energy.spindle_work_j > 0, "the ramp brakes the disk's waves"
    assert energy.h_peak_j > energy.h_end_j > 0
    conditions: opshock.Complementarity = failed.complementarity
    assert conditions.max_product_n_s_m < 1e-9 and conditions.min_multiplier_n_s >= 0 and conditions.max_penetration_m < 1e-6


def test_a_stronger_shock_bends_the_disk_more(free: opshock.Scene) -> None:
    """Without contact the disk is linear; no shock is survived, and does nothing."""
    once, twice, none = (opshock.simulate(free, amplitude_g) for amplitude_g in (100, 200, 0))
    assert once.disk.rim_max_m is not None
    assert twice.disk.rim_max_m == pytest.approx(2 * once.disk.rim_max_m, rel=1e-9)
    ends = once.energy
    assert ends.kinetic_j + ends.elastic_j == pytest.approx(ends.h_end_j, rel=1e-6)
    assert twice.energy.elastic_j == pytest.approx(4 * ends.elastic_j, rel=1e-6)
    assert none.verdict is Verdict.SURVIVES
    still: opshock.DiskMotion = none.disk
    assert (still.rim_max_m, still.slider_min_m) == (0.0, 0.0)
    steady: opshock.Steady | None = none.steady
    assert steady == once.steady


def test_the_optional_parts(equipped: Run, survived: Run) -> None:
    """Each has its record, whose numbers balance; without the part there is none."""
    assert (survived.hub, survived.base, survived.limiters, survived.lift_tab) == (None,) * 4
    assert survived.slider_contact is None
    hub, base, tab = equipped.hub, equipped.base, equipped.lift_tab
    assert isinstance(hub, opshock.Hub) and isinstance(base, opshock.Base) and isinstance(tab, opshock.Stop)
    assert abs(hub.momentum_closure) < 1e-9 and abs(base.momentum_closure) < 1e-9
    assert hub.contact_n_s == pytest.approx(-equipped.contact.top.impulse_n_s, rel=1e-9)
    assert base.ramp_max_m / base.spindle_max_m == pytest.approx(1.2, rel=1e-6), "one mode: 2.4 to 2.0"
    assert base.pivot_max_m / base.spindle_max_m == pytest.approx(0.8, rel=1e-6)
    assert hub.shock_n_s > 0 > hub.bearing_n_s and base.shock_n_s > 0 > base.mounts_n_s
    assert hub.axial_max_m == pytest.approx(abs(held(equipped)["hub_axial_m"]).max(), rel=1e-3)
    tilt = np.hypot(held(equipped)["hub_tilt_ramp_rad"], held(equipped)["hub_tilt_across_rad"])
    assert hub.tilt_max_rad == pytest.approx(tilt.max(), rel=1e-3)
    assert tab.first_s is not None and tab.max_force_n > 0 and 0 < tab.closed_s < 2.5e-3
    assert equipped.limiters is not None
    dimple: opshock.Dimple | None = equipped.dimple
    assert dimple is not None and dimple.open_s == 0.0
    assert {"disk.hub", "base.modes", "head.limiters", "head.lift_tab"} <= set(equipped.effects)
    assert not {"disk.hub", "base.modes"} & set(survived.effects)
    assert {"hub_axial_m", "base_spindle_m", "lift_tab_force_n"} <= set(held(equipped)) - set(held(survived))


def test_pressure_fields(equipped: Run, survived: Run) -> None:
    """Two times; cells between the lines; pressures around the ambient one."""
    assert held(survived).fields is None
    found = held(equipped).fields
    assert isinstance(found, PressureFields)
    assert found.time_s.tolist() == [0.6e-3, 0.8e-3]
    assert found.pressure_pa.shape == found.gap_m.shape == (2, len(found.y_lines_m) - 1, len(found.x_lines_m) - 1)
    assert (found.x_lines_m[0], found.x_lines_m[-1]) == pytest.approx((0, 0.85e-3))
    assert (found.y_lines_m[0], found.y_lines_m[-1]) == pytest.approx((0, 0.70e-3))
    assert 1e4 < found.pressure_pa.min() < 101325 < 3e5 < found.pressure_pa.max()
    assert 0 < found.gap_m.min() < 50e-9
    for name in ("time_s", "y_lines_m", "x_lines_m", "pressure_pa", "gap_m"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(found, name)[0] = 0.0


def test_columns(failed: Run) -> None:
    """A mapping of columns on one time, whose extremes are those of the run."""
    history = held(failed)
    assert list(history)[:3] == ["time_s", "shock_m_per_s2", "disk_slider_m"]
    assert {len(column) for column in history.values()} == {len(history["time_s"])} == {2501}
    assert all(column.dtype == np.float64 for column in history.values())
    assert len(history) == len(list(history)) == 21
    assert history["time_s"][[0, -1]] == pytest.approx([0.5e-3, 3e-3])
    assert history["shock_m_per_s2"].max() == pytest.approx(600 * 9.80665, rel=1e-6)
    disk = failed.disk
    assert history["disk_rim_m"].max() == pytest.approx(disk.rim_max_m, abs=1e-9)
    assert history["disk_slider_m"].max() == pytest.approx(disk.slider_max_m, abs=1e-9)
    assert history["disk_slider_m"].min() == pytest.approx(disk.slider_min_m, abs=1e-9)
    assert history["disk_ramp_m"].min() == pytest.approx(disk.ramp_min_m, abs=1e-9)
    assert (history.units("shock_m_per_s2"), history.units("time_s"), history.units("contact_top_n")) == ("m/s2", "s", "N")
    assert history.description("disk_slider_m") == "disk displacement under the slider, relative to the base"
    with pytest.raises(KeyError):
        history["nothing"]


def test_the_head_at_its_own_steps(failed: Run, survived: Run) -> None:
    """It ends at touch; on the time of the structure nothing follows."""
    head: Columns = held(failed).head
    assert head["time_s"][-1] == failed.t_fail_s
    assert failed.steady is not None and failed.dimple is not None
    assert (head["slider_pitch_rad"][0], head["slider_roll_rad"][0]) == (failed.steady.pitch_rad, failed.steady.roll_rad)
    assert head["dimple_force_n"].min() == pytest.approx(failed.dimple.min_force_n, rel=0.05)
    assert len(head["time_s"]) <= failed.cost.steps + 1
    after = held(failed)["time_s"] > head["time_s"][-1]
    clearance = held(failed)["min_clearance_m"]
    assert after.any() and np.isnan(clearance[after]).all() and not np.isnan(clearance[~after]).any()
    assert held(survived).head["min_clearance_m"].min() == pytest.approx(survived.min_clearance_m, abs=2e-10)
    assert held(survived).head.units("dimple_force_n") == "N"


def test_without_a_head(study: opshock.Study) -> None:
    """A study of the disk alone asks for no verdict: ``None``, no head, no clearance."""
    scene = study.scene(ramp="rigid", pulse_ms=2, settings={"outputs": ["disk_displacement"]})
    run = opshock.simulate(scene, 300, history=True)
    assert (run.verdict, run.steady, run.dimple, run.min_clearance_m) == (None,) * 4
    assert (run.cost.film_solves, run.cost.steps) == (0, 0)
    assert len(held(run).head) == 0
    assert "min_clearance_m" not in held(run) and "disk_ramp_m" in held(run)
    assert ">none<" in run._repr_html_()


def test_tables(survived: Run) -> None:
    """Of pandas and of xarray: the same numbers, with units."""
    history = held(survived)
    frame = history.to_pandas()
    assert frame.index.name == "time_s"
    assert list(frame.columns) == list(history)[1:]
    dataset = history.to_xarray()
    assert set(dataset.data_vars) == set(history) - {"time_s"}
    for name in list(history)[1:]:
        assert np.array_equal(frame[name].to_numpy(), history[name], equal_nan=True)
        assert np.array_equal(dataset[name].to_numpy(), history[name], equal_nan=True)
        assert dataset[name].attrs == {"units": history.units(name), "long_name": history.description(name)}
    assert np.array_equal(dataset["time_s"].to_numpy(), history["time_s"])
    assert list(history.head.to_pandas().columns) == list(history.head)[1:]


def records(value: Any) -> Iterator[Any]:
    """All records within a record."""
    if dataclasses.is_dataclass(value) and not isinstance(value, (type, opshock.Study)):
        yield value
        for field in dataclasses.fields(value):
            yield from records(getattr(value, field.name))
    elif isinstance(value, tuple):
        for one in value:
            yield from records(one)


def test_a_run_never_changes(equipped: Run) -> None:
    """No field of it or of what it holds can be assigned; columns are read-only for good."""
    found = list(records(equipped))
    kinds = {type(one).__name__ for one in found}
    assert {"Run", "Steady", "DiskMotion", "ContactEpisode", "Energy", "Complementarity", "Hub", "Base", "Stop", "Dimple", "Cost"} <= kinds
    for one in found:
        for field in dataclasses.fields(one):
            with pytest.raises(dataclasses.FrozenInstanceError):
                setattr(one, field.name, None)
    history: Any = held(equipped)
    with pytest.raises(TypeError):
        history["time_s"] = history["energy_j"]
    for columns in (history, history.head):
        for column in columns.values():
            with pytest.raises(ValueError, match="read-only"):
                column[0] = 1.0
            with pytest.raises(ValueError, match="WRITEABLE"):
                column.setflags(write=True)


def test_a_history_never_changes(free: opshock.Scene) -> None:
    """As every other result."""
    history: Any = held(opshock.simulate(free, 100, history=True))
    with pytest.raises(AttributeError):
        history.head = None


def test_cost_and_rules(survived: Run) -> None:
    """What a simulation cost, and the names of effects and rules."""
    cost: opshock.Cost = survived.cost
    assert cost.structure_steps == 2500, "2.5 ms by 1 us"
    assert cost.steps > 100 and cost.rejected >= 0 and cost.film_solves > cost.steps
    assert cost.film_unknowns == 231 and 0 < cost.factorisations < cost.film_solves
    assert 0 < cost.wall_s < 60
    assert "head.film" in survived.effects and "ramp.contact" in survived.effects
    assert all(rule.startswith("R") and rule[1:].isdigit() for rule in survived.rules)


def test_a_warning_of_a_run(survived: Run) -> None:
    """It has a code and words, and never changes."""
    warning = opshock.RunWarning(code="W301", message="words")
    mapping: Mapping[str, object] = vars(warning)
    assert dict(mapping) == {"code": "W301", "message": "words"}
    with pytest.raises(dataclasses.FrozenInstanceError):
        warning.code = ""  # type: ignore[misc]  # pyright: ignore[reportAttributeAccessIssue]
    assert not any(isinstance(one, opshock.RunWarning) for one in records(survived))


@pytest.mark.parametrize("threads", [0, -1])
def test_threads_are_at_least_one(free: opshock.Scene, threads: int) -> None:
    """No number of threads stands for all of them but None."""
    with pytest.raises(ValueError, match=f"threads = {threads}: must be at least 1"):
        opshock.simulate_many([(free, 100.0)], threads=threads)
