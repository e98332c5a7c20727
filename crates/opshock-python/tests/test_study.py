"""Studies and scenes: reading, changing, choosing."""

from __future__ import annotations

import copy
import pickle
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from opshock import Scene, Study, StudyError


def same(typed: object, written: object, where: str) -> int:
    """Asserts that typed attributes are what the TOML says; how many values there were."""
    if isinstance(written, Mapping):
        return sum(same(getattr(typed, key), value, f"{where}.{key}") for key, value in written.items() if key != "study_format")
    if isinstance(written, list):
        assert isinstance(typed, tuple) and len(typed) == len(written), where
        return sum(same(one, other, where) for one, other in zip(typed, written, strict=True))
    assert typed == written and type(typed) is type(written), where
    return 1


def test_attributes_are_those_of_the_toml(study: Study) -> None:
    """Every setting of the resolved study, defaults included, with its type."""
    assert same(study, tomllib.loads(study.toml), "study") > 100
    assert study.name == "small"
    assert study.pulse.widths_ms == (1.0, 2.0)
    assert study.pulse.signs == ("+",)
    assert study.disk.thickness_mm == 0.635
    assert study.disk.damping.rayleigh.beta_s == 1e-7
    assert study.resolution.film_cells == 200
    assert study.search.uncertainty is False
    assert study.search.amplitude_g.max == 1500.0
    assert study.slider.surface.rail[0].recess_um == 0.25
    assert study.hub is None


def test_a_file_and_its_text_are_the_same_study(study: Study, study_file: Path) -> None:
    """From a file, by a string or a path, and from a text."""
    assert Study(study_file).digest == Study(str(study_file)).digest == study.digest
    assert Study(study_file).toml == study.toml
    assert len(study.digest) == 64


def test_a_file_with_settings(study_file: Path, study: Study) -> None:
    """Settings are laid over the file, which stays as it is."""
    before = study_file.read_bytes()
    thin = Study(study_file, {"disk.thickness_mm": 0.5, "name": "thin"})
    assert (thin.disk.thickness_mm, thin.name) == (0.5, "thin")
    assert thin.digest != study.digest
    assert study_file.read_bytes() == before
    assert Study(study_file).disk.thickness_mm == 0.635


def test_with_settings_gives_another_study(study: Study) -> None:
    """And leaves the first."""
    digest, toml = study.digest, study.toml
    other = study.with_settings({"disk.rpm": 7200, "search.amplitude_g": {"min": 50.0, "max": 900.0}})
    assert (other.disk.rpm, other.search.amplitude_g.min, other.search.amplitude_g.max) == (7200.0, 50.0, 900.0)
    assert (study.disk.rpm, study.search.amplitude_g.min) == (5400.0, 100.0)
    assert (study.digest, study.toml) == (digest, toml)
    assert other.with_settings({"ramp.radius_mm": 32.0}).disk.rpm == 7200.0


def test_a_setting_may_be_changed_again(study: Study) -> None:
    """The last value counts, also of a scene's own coordinates."""
    fast = study.with_settings({"disk.rpm": 7200.0})
    assert fast.with_settings({"disk.rpm": 5400.0}).digest == study.digest
    assert study.scene(ramp="none", pulse_ms=2).scene(pulse_ms=1.0).pulse_ms == 1.0


def test_a_dictionary_is_the_same_study(study: Study, small_toml: str) -> None:
    """The dictionary of the TOML, without the format's number too."""
    settings = tomllib.loads(small_toml)
    assert Study.from_dict(settings).digest == study.digest
    del settings["study_format"]
    assert Study.from_dict(settings).digest == study.digest
    assert Study.from_dict(settings).toml == study.toml


def test_the_order_of_settings_does_not_matter(study: Study, small_toml: str) -> None:
    """The same digest, of dictionaries and of settings."""
    settings: dict[str, Any] = tomllib.loads(small_toml)
    backwards = {key: dict(reversed(value.items())) if isinstance(value, dict) else value for key, value in reversed(settings.items())}
    assert list(backwards) != list(settings)
    assert Study.from_dict(backwards).digest == study.digest
    changes = {"disk.rpm": 7200.0, "ramp.clearance_um": 60.0}
    assert study.with_settings(changes).digest == study.with_settings(dict(reversed(changes.items()))).digest


def test_the_resolved_text_is_the_same_study(study: Study, tmp_path: Path) -> None:
    """Read again, from a text or a file; a relative file name starts in the folder given."""
    assert Study.from_toml(study.toml).digest == study.digest
    rail = '[[rail]]\nkind = "rect"\nx_um = [20, 800]\ny_um = [30, 670]\nrecess_um = 0\n'
    (tmp_path / "surface.toml").write_text("base_recess_um = 1.5\n" + rail)
    text = 'study_format = 2\nname = "s"\npulse.widths_ms = [1.0]\nramp.models = ["none"]\nslider.surface.file = "surface.toml"\n'
    read = Study.from_toml(text, folder=tmp_path)
    assert [one.x_um for one in read.slider.surface.rail] == [(20.0, 800.0)]
    assert Study.from_toml(read.toml).digest == read.digest
    settings: dict[str, Any] = {"name": "s", "pulse": {"widths_ms": [1.0]}, "ramp": {"models": ["none"]}}
    settings["slider"] = {"surface": {"file": Path("surface.toml")}}
    assert Study.from_dict(settings, folder=tmp_path).digest == read.digest


def test_the_example_is_the_drive_to_start_from() -> None:
    """A valid study by the name given."""
    example = Study.example("drive 7")
    assert example.name == "drive 7"
    assert Study.example().name == "my drive"
    assert example.ramp.models == ("none", "rigid", "deformable")
    assert example.pulse.widths_ms == (0.5, 1.0, 2.0) and example.pulse.signs == ("+", "-")
    assert len(example.points) == 3 * 3 * 2


def test_values_of_numpy(study: Study) -> None:
    """Scalars, arrays and truth values, as settings and in a dictionary."""
    changed = study.with_settings(
        {
            "disk.thickness_mm": np.float64(0.5),
            "pulse.widths_ms": np.array([0.5, 1.5]),
            "resolution.film_cells": np.int64(150),
            "search.uncertainty": np.bool_(True),
        }
    )
    plain = {"disk.thickness_mm": 0.5, "pulse.widths_ms": [0.5, 1.5], "resolution.film_cells": 150, "search.uncertainty": True}
    assert changed.digest == study.with_settings(plain).digest
    assert changed.pulse.widths_ms == (0.5, 1.5)
    assert study.scene(ramp="rigid", pulse_ms=np.linspace(1, 2, 3)[1]).pulse_ms == 1.5


def test_axes_and_points(study: Study) -> None:
    """A list of values where one is expected is an axis: a tuple, a column, and twice the points."""
    assert study.axes == {}
    assert study.points == ("none 1 ms +", "none 2 ms +", "rigid 1 ms +", "rigid 2 ms +")
    wide = study.with_settings({"ramp.clearance_um": [60.0, 100.0]})
    assert wide.ramp.clearance_um == (60.0, 100.0)
    assert wide.axes == {"clearance_um": "ramp.clearance_um"}
    assert len(wide.points) == 8
    assert wide.points[-1] == "rigid 2 ms + clearance_um=100"
    assert repr(wide) == "<Study 'small', 8 points>"


def test_scenes_are_the_points(study: Study) -> None:
    """As many, in their order, by their labels."""
    scenes = study.scenes()
    assert tuple(scene.label for scene in scenes) == study.points
    assert [(scene.ramp_model, scene.pulse_ms, scene.sign) for scene in scenes[1:3]] == [("none", 2.0, "+"), ("rigid", 1.0, "+")]
    assert repr(scenes[0]) == "<Scene 'small': none 1 ms +>"
    assert all(scene.points == (scene.label,) for scene in scenes)
    assert scenes[3].digest == study.scene(ramp="rigid", pulse_ms=2).digest


def test_scenes_of_axes_and_heads(small_toml: str) -> None:
    """Of a study whose text has an axis, and of one with two heads."""
    wide = Study.from_toml(small_toml + "[disk]\nthickness_mm = [0.5, 0.635]\n")
    assert [scene.disk.thickness_mm for scene in wide.scenes()] == 4 * [0.5] + 4 * [0.635]
    assert [scene.label for scene in wide.scenes()] == list(wide.points)
    heads = Study.from_toml(small_toml + '[[heads]]\nhead = "up"\n[[heads]]\nhead = "down"\nslider.radius_mm = 22.0\n')
    assert heads.axes == {"head": "head"}
    assert [scene.head for scene in heads.scenes()] == 4 * ["up"] + 4 * ["down"]
    assert heads.scene(ramp="none", pulse_ms=1, settings={"head": "down"}).label == "none 1 ms + head=down"


def test_scenes_of_an_axis_that_was_a_setting(study: Study) -> None:
    """As of one in the text."""
    wide = study.with_settings({"disk.thickness_mm": [0.5, 0.635]})
    assert [scene.disk.thickness_mm for scene in wide.scenes()] == 4 * [0.5] + 4 * [0.635]


def test_a_scene_beside_the_study(study: Study) -> None:
    """Width, ramp, sign and further settings need not be the study's."""
    scene = study.scene(ramp="deformable", pulse_ms=1.25, sign="-", settings={"ramp.clearance_um": 61.0})
    assert scene.label == "deformable 1.25 ms -"
    assert (scene.ramp_model, scene.pulse_ms, scene.sign) == ("deformable", 1.25, "-")
    assert (scene.pulse.widths_ms, scene.ramp.clearance_um) == ((1.25,), 61.0)


def test_a_scene_is_one_point(small_toml: str) -> None:
    """A text of several is refused."""
    with pytest.raises(ValueError, match="a scene is one point, here are 4"):
        Scene.from_toml(small_toml)
    one = Scene.from_toml(small_toml.replace('["none", "rigid"]', '["rigid"]').replace("[1.0, 2.0]", "[2.0]"))
    assert isinstance(one, Scene)
    assert one.label == "rigid 2 ms +"


def test_a_scene_of_a_file_is_one_point(study_file: Path) -> None:
    """As of a text."""
    with pytest.raises(ValueError, match="a scene is one point, here are 4"):
        Scene(study_file)


def test_a_changed_scene_is_a_scene(free: Scene) -> None:
    """It can be simulated."""
    assert isinstance(free.with_settings({"disk.rpm": 7200.0}), Scene)


def test_a_study_never_changes(study: Study) -> None:
    """Settings, tables and properties refuse assignment; so does the mapping of axes."""
    for owner, name in [(study, "name"), (study, "disk"), (study.disk, "rpm"), (study.pulse, "widths_ms"), (study, "digest")]:
        before = getattr(owner, name)
        with pytest.raises(AttributeError):
            setattr(owner, name, before)
        assert getattr(owner, name) is before or getattr(owner, name) == before
    with pytest.raises(TypeError):
        study.axes["x"] = "y"  # type: ignore[index]  # pyright: ignore[reportIndexIssue]


def test_a_misspelt_setting_cannot_be_assigned(study_file: Path) -> None:
    """It would be without effect."""
    with pytest.raises(AttributeError):
        Study(study_file).thickness_mm = 0.5


def test_names_of_any_language(small_toml: str, study: Study) -> None:
    """Characters beyond the basic plane, quotes, and those that TOML escapes."""
    for name in ("Laufwerk 😀", 'a "drive"', "back\\slash"):
        named = study.with_settings({"name": name})
        assert named.name == name
        assert Study.from_toml(named.toml).digest == named.digest
    with pytest.raises(StudyError, match="E159"):
        study.with_settings({"name": "del\x7fete"})


def test_studies_can_be_copied_and_sent(study_file: Path) -> None:
    """To another process, with their settings."""
    thin = Study(study_file, {"disk.thickness_mm": 0.5}).scene(ramp="rigid", pulse_ms=2)
    again = pickle.loads(pickle.dumps(thin))
    assert isinstance(again, Scene)
    assert (again.digest, again.label, again.disk.thickness_mm) == (thin.digest, "rigid 2 ms +", 0.5)
    assert copy.deepcopy(thin).with_settings({"disk.thickness_mm": 0.6}).disk.thickness_mm == 0.6


def test_equal_studies_are_those_with_equal_settings(study: Study) -> None:
    """Equality and hash are of all settings; a scene is no study, and nothing else is one."""
    other = Study.from_toml(study.toml)
    assert other == study and hash(other) == hash(study)
    assert study.with_settings({"disk.rpm": 7200.0}) != study
    assert study != study.toml
    assert study.scenes()[0] != study


def test_settings_are_listed_and_unknown_ones_are_none(study: Study) -> None:
    """Settings are made when one is read: before that they are listed, and what is no setting is refused."""
    fresh = Study.from_toml(study.toml)
    assert {"disk", "ramp", "pulse", "with_settings"} <= set(dir(fresh))
    fresh = Study.from_toml(study.toml)
    assert not hasattr(fresh, "dsik")
    assert fresh.disk == study.disk
