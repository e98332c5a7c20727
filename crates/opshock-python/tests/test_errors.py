"""Exceptions, the faults they carry, and warnings."""

from __future__ import annotations

import os
import shutil
import tomllib
import warnings
from pathlib import Path
from typing import Any

import opshock
import pytest
from opshock import ChoiceError, Fault, OpshockError, OpshockWarning, Scene, StoreError, Study, StudyError

UNDER_THE_RAMP = {"ramp.radius_mm": 31.9, "slider.radius_mm": 32.0, "slider.angle_deg": 0.5}


def test_the_classes() -> None:
    """One base; invalid arguments are ValueErrors, trouble with a store is an OSError."""
    assert StudyError.__mro__[1:3] == ChoiceError.__mro__[1:3] == (OpshockError, ValueError)
    assert StoreError.__mro__[1:3] == (OpshockError, OSError)
    assert OpshockError("words").faults == ()
    assert issubclass(OpshockWarning, UserWarning)


def test_an_invalid_value(small_toml: str, tmp_path: Path) -> None:
    """Its fault names file, line, key, value, and what would be valid."""
    path = tmp_path / "wrong.toml"
    path.write_text(small_toml + "[disk]\nthickness_mm = -1\n")
    with pytest.raises(StudyError) as caught:
        Study(path)
    line = small_toml.count("\n") + 2
    fault = Fault("E130", "must be > 0", str(path), line, "disk.thickness_mm", "-1", "> 0 mm", "for example 0.635")
    assert caught.value.faults == (fault,)
    assert str(caught.value).startswith(f"{path}:{line}:")
    assert "E130 disk.thickness_mm = -1: must be > 0" in str(caught.value)


def test_all_faults_are_reported(study: Study) -> None:
    """Three wrong settings, three faults; the key of each."""
    wrong = {"disk.thicknes_mm": 0.5, "dsk.rpm": 1.0, "disk.poisson": "much"}
    with pytest.raises(StudyError) as caught:
        study.with_settings(wrong)
    found = {fault.key: (fault.code, fault.file) for fault in caught.value.faults}
    assert found == {"disk.thicknes_mm": ("E110", "settings"), "dsk": ("E111", "settings"), "disk.poisson": ("E113", "settings")}
    misspelt = next(fault for fault in caught.value.faults if fault.code == "E110")
    assert misspelt.hint == "did you mean thickness_mm?"
    assert misspelt.allowed is not None and "thickness_mm" in misspelt.allowed.split(", ")


@pytest.mark.parametrize(
    ("text", "code", "line"),
    [("", "E101", 1), ('study_format = 2\nname = "x"\n[pulse\n', "E103", 3), ('study_format = 2\nname = "x"\n', "E112", None)],
)
def test_texts_that_are_no_studies(text: str, code: str, line: int | None) -> None:
    """Empty, no TOML, without what a study needs."""
    with pytest.raises(StudyError) as caught:
        Study.from_toml(text)
    assert caught.value.faults[0].code == code
    assert line is None or caught.value.faults[0].line == line
    assert caught.value.faults[0].file == "study.toml"


def test_a_missing_file(tmp_path: Path) -> None:
    """The fault names it."""
    with pytest.raises(StudyError, match="no such file") as caught:
        Study(tmp_path / "none.toml")
    assert (caught.value.faults[0].code, caught.value.faults[0].file) == ("E105", str(tmp_path / "none.toml"))


@pytest.mark.filterwarnings("ignore::opshock.OpshockWarning")
@pytest.mark.parametrize("value", [None, object(), {1, 2}, b"x"])
def test_values_that_no_study_holds(study: Study, value: Any) -> None:
    """Other types than numbers, words, truth values, lists and tables."""
    with pytest.raises(TypeError, match="a study holds numbers, words, truth values, lists and tables"):
        study.with_settings({"disk.rpm": value})


def test_free_axes(study: Study) -> None:
    """What is not chosen, its values, and the argument that chooses it."""
    with pytest.raises(ChoiceError) as caught:
        study.scene()
    assert [(fault.key, fault.allowed) for fault in caught.value.faults] == [("ramp.models", "none, rigid"), ("pulse.widths_ms", "1, 2")]
    assert str(caught.value) == (
        "ramp.models is not chosen, allowed: none, rigid, choose with ramp; "
        "pulse.widths_ms is not chosen, allowed: 1, 2, choose with pulse_ms"
    )
    wide = study.with_settings({"ramp.clearance_um": [60.0, 100.0]})
    with pytest.raises(ChoiceError, match="ramp.clearance_um is not chosen, allowed: 60, 100"):
        wide.scene(ramp="rigid", pulse_ms=2)


def test_words_and_numbers_of_a_scene(study: Study) -> None:
    """A wrong ramp, a wrong sign, a width that is none."""
    with pytest.raises(ChoiceError, match='ramp = "wood", allowed: none, rigid or deformable') as caught:
        study.scene(ramp="wood", pulse_ms=2)
    assert (caught.value.faults[0].key, caught.value.faults[0].value) == ("ramp", "wood")
    with pytest.raises(ChoiceError, match=r'sign = "up", allowed: \+ or -'):
        study.scene(ramp="none", pulse_ms=2, sign="up")
    for width in (0.0, -1.0, float("nan")):
        with pytest.raises(ChoiceError, match="pulse_ms .* finite number > 0"):
            study.scene(ramp="none", pulse_ms=width)


@pytest.mark.parametrize("amplitude_g", [-5.0, float("nan"), float("inf")])
def test_amplitudes_that_are_none(free: Scene, amplitude_g: float) -> None:
    """Refused alone and in a batch, by the argument's name."""
    for simulated in (lambda: opshock.simulate(free, amplitude_g), lambda: opshock.simulate_many([(free, 100.0), (free, amplitude_g)])):
        with pytest.raises(ChoiceError, match="^amplitude_g .*finite number >= 0; the direction is chosen with sign") as caught:
            simulated()
        assert "--" not in str(caught.value)
        assert len(caught.value.faults) == 1


def test_a_study_of_several_points_is_not_simulated(study: Study) -> None:
    """Neither alone nor in a batch."""
    several: Any = study
    with pytest.raises(ChoiceError, match="choose with ramp"):
        opshock.simulate(several, 100)
    with pytest.raises(ChoiceError, match="choose with ramp"):
        opshock.simulate_many([(several, 100)])


def test_a_slider_that_cannot_fly(study: Study) -> None:
    """A disk that hardly turns carries nothing: reported with the load that it would carry."""
    settings = {"disk.rpm": 50.0, "resolution.film_cells": 50, "resolution.film_correction_cells": 50}
    with pytest.warns(OpshockWarning, match="^W201.*rev/min"):
        scene = study.scene(ramp="none", pulse_ms=2, settings=settings)
    with pytest.raises(StudyError, match="the slider cannot fly") as caught:
        opshock.simulate(scene, 100)
    fault = caught.value.faults[0]
    assert (fault.code, fault.key, fault.value) == ("E192", "suspension.gram_load_gf", "2.2000 gf")
    assert fault.allowed is not None and fault.allowed.startswith("a gram load below 0.0")


def test_missing_stores(tmp_path: Path) -> None:
    """A folder that is not there, and an empty one."""
    with pytest.raises(StoreError, match="holds no results") as caught:
        opshock.open_store(tmp_path / "none")
    assert caught.value.faults[0].code == "E187"
    assert isinstance(caught.value, OSError)
    (tmp_path / "empty").mkdir()
    with pytest.raises(StoreError, match="E187"):
        opshock.open_store(tmp_path / "empty")


def test_damaged_stores(tmp_path: Path, study: Study, store: opshock.Store, capsys: pytest.CaptureFixture[str]) -> None:
    """Read from what is whole, with a warning; refused where nothing is. A sweep keeps what is damaged beside."""
    damaged = tmp_path / "damaged"
    shutil.copytree(store.path, damaged)
    (damaged / "results.h5").write_bytes(b"no results")
    read = opshock.open_store(damaged)
    assert list(read) == list(store)
    assert len(read.warnings) == 1 and "results.h5: not HDF5, or cut short" in read.warnings[0]
    (damaged / "journal").unlink()
    with pytest.raises(StoreError, match="not HDF5") as caught:
        opshock.open_store(damaged)
    assert caught.value.faults[0].code == "E182"

    wrong = tmp_path / "wrong"
    wrong.mkdir()
    (wrong / "journal").write_bytes(b"no journal")
    with pytest.raises(StoreError, match="E182"):
        opshock.open_store(wrong)
    with pytest.warns(OpshockWarning, match="journal: 10 bytes at 0 are damaged"):
        assert not opshock.sweep(study, wrong, threads=1, budget_s=0).is_complete
    assert (wrong / "journal.damaged").read_bytes() == b"no journal"


def test_what_the_user_wrote_is_quoted_as_it_is(study: Study, tmp_path: Path) -> None:
    """Options of the command line are translated in what the program says, not in names of files and values."""
    folder = tmp_path / "--set"
    folder.mkdir()
    with pytest.raises(StudyError) as caught:
        Study(folder / "none.toml")
    assert str(folder) in str(caught.value)
    assert caught.value.faults[0].file == str(folder / "none.toml")
    with pytest.raises(StudyError, match='preset = "--only-this"') as caught:
        study.with_settings({"resolution.preset": "--only-this"})
    assert caught.value.faults[0].value == '"--only-this"'


def test_a_study_of_a_text_is_of_no_file(study: Study, small_toml: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It does not take over the store of a study file that happens to lie in the working directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(small_toml)
    opshock.sweep(Study("study.toml"), "swept", threads=1, budget_s=0)
    with pytest.raises(StoreError, match="E188"):
        opshock.sweep(Study.from_toml(small_toml.replace('"small"', '"another design"')), "swept", threads=1, budget_s=0)
    assert len(opshock.sweep(Study("study.toml"), "swept", threads=1, budget_s=0)) == 4


def test_a_study_without_a_verdict_is_not_swept(study: Study, tmp_path: Path) -> None:
    """Its simulations say nothing of a critical shock."""
    with pytest.raises(StudyError, match="E158"):
        opshock.sweep(study.with_settings({"outputs": ["disk_displacement"]}), tmp_path / "swept", threads=1)


def test_a_store_that_cannot_be_made(tmp_path: Path, study: Study) -> None:
    """A file is in its place, and stays."""
    path = tmp_path / "file"
    path.write_text("mine")
    with pytest.raises(StoreError, match="E183"):
        opshock.sweep(study, path, threads=1)
    assert path.read_text() == "mine"


def test_a_warning_at_reading(study: Study, small_toml: str) -> None:
    """Of a text, a dictionary or settings, the code first; a sound study has none."""
    with pytest.warns(OpshockWarning, match="^W203.*contact point lies under the slider"):
        study.with_settings(UNDER_THE_RAMP)
    with pytest.warns(OpshockWarning, match="^W201.*0.1 to 3 mm"):
        Study.from_toml(small_toml + "[disk]\nthickness_mm = 20.0\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Study.from_toml(small_toml)


@pytest.mark.parametrize("way", ["text", "settings", "file", "dictionary"])
def test_a_warning_names_the_line_that_reads(way: str, tmp_path: Path, small_toml: str, study: Study) -> None:
    """The caller's file, not the package's or that of its caller, whichever way the study comes."""
    thick = small_toml + "[disk]\nthickness_mm = 20.0\n"
    (tmp_path / "thick.toml").write_text(thick)
    with pytest.warns(OpshockWarning) as caught:
        if way == "text":
            Study.from_toml(thick)
        elif way == "settings":
            study.with_settings({"disk.thickness_mm": 20.0})
        elif way == "file":
            Study(tmp_path / "thick.toml")
        else:
            Study.from_dict(tomllib.loads(thick))
    assert [os.path.samefile(one.filename, __file__) for one in caught] == [True]


def test_a_warning_names_the_setting(study: Study) -> None:
    """And its value."""
    with pytest.warns(OpshockWarning) as caught:
        study.with_settings({"disk.thickness_mm": 20.0})
    assert "disk.thickness_mm = 20" in str(caught[0].message)


def test_a_doubtful_study_is_swept_when_its_warning_is_accepted(study: Study, tmp_path: Path) -> None:
    """Refused otherwise, also where another code is accepted; then nothing is written."""
    with pytest.warns(OpshockWarning):
        doubtful = study.with_settings(UNDER_THE_RAMP)
        scene = doubtful.scene(ramp="rigid", pulse_ms=2)
    for accept in ((), ("W201",)):
        with pytest.raises(StudyError) as caught:
            opshock.sweep(doubtful, tmp_path / "swept", accept=accept, threads=1)
        assert [fault.code for fault in caught.value.faults] == ["W203"]
        with pytest.raises(StudyError, match="W203"):
            opshock.critical_shock(scene, store=tmp_path / "swept", accept=accept)
    assert list(tmp_path.iterdir()) == []
    begun = opshock.sweep(doubtful, tmp_path / "swept", accept={"W203"}, threads=1, budget_s=0)
    assert (len(begun), begun.is_complete) == (4, False)


def test_a_fault_never_changes() -> None:
    """Nor does it need more than code and message."""
    fault = Fault("E130", "wrong")
    assert (fault.file, fault.line, fault.key, fault.value, fault.allowed, fault.hint) == (None,) * 6
    with pytest.raises(AttributeError):
        fault.code = "E131"  # type: ignore[misc]  # pyright: ignore[reportAttributeAccessIssue]
