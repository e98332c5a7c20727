"""The command line inside the package."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import opshock
import pytest
from opshock import __main__

Command = Callable[..., "subprocess.CompletedProcess[str]"]


def test_the_program_names_itself(command: Command) -> None:
    """Version, commit and physics, the same from Python and from the command line."""
    done = command("--version")
    assert (done.returncode, done.stdout.split()[:2]) == (0, opshock.program().split()[:2])
    words = opshock.program().split()
    assert (words[0], words[1]) == ("opshock", opshock.__version__)
    assert "physics" in words


def test_help_names_every_command(command: Command) -> None:
    """Those that a user of Python needs as well."""
    help_text = command("--help").stdout
    named = {line.split()[0] for line in help_text.splitlines() if line.startswith("  ") and line.strip()}
    assert {"run", "sweep", "report", "export", "schema"} <= named


def test_exit_codes(command: Command, study_file: Path, tmp_path: Path) -> None:
    """0 done, 2 command line, 3 study, 6 store; the codes of faults are those of the exceptions."""
    assert command("check", study_file).returncode == 0
    refused = command("run", study_file, "--amplitude-g", "100", "--json")
    with pytest.raises(opshock.ChoiceError) as choice:
        opshock.Study(study_file).scene()
    assert refused.returncode == 2
    assert [one["key"] for one in json.loads(refused.stderr)["errors"]] == [fault.key for fault in choice.value.faults]

    wrong = command("check", study_file, "--set", "disk.rpm=-1", "--json")
    with pytest.raises(opshock.StudyError) as invalid:
        opshock.Study(study_file, {"disk.rpm": -1})
    assert wrong.returncode == 3
    fault = json.loads(wrong.stderr)["errors"][0]
    assert (fault["code"], fault["message"], fault["allowed"]) == tuple(
        getattr(invalid.value.faults[0], name) for name in ("code", "message", "allowed")
    )

    (tmp_path / "file").write_text("mine")
    taken = command("sweep", study_file, "--store", tmp_path / "file")
    assert taken.returncode == 6
    assert "E183" in taken.stderr


def test_the_example_is_that_of_new(command: Command, tmp_path: Path) -> None:
    """The text that ``opshock new`` prints is the study of ``Study.example``."""
    path = tmp_path / "new.toml"
    path.write_text(command("new").stdout)
    assert opshock.Study(path).points == opshock.Study.example().points
    assert opshock.Study(path, {"name": "my drive"}).digest == opshock.Study.example("my drive").digest


def test_the_entry_point(monkeypatch: pytest.MonkeyPatch, study_file: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """``opshock.__main__:main`` takes the arguments of the process and leaves with its exit code."""
    handler = signal.getsignal(signal.SIGINT)
    try:
        for arguments, code in ((["check", str(study_file)], 0), (["chekc"], 2)):
            monkeypatch.setattr(sys, "argv", ["opshock", *arguments])
            with pytest.raises(SystemExit) as ended:
                __main__.main()
            assert ended.value.code == code
    finally:
        signal.signal(signal.SIGINT, handler)
    assert "chekc" in capfd.readouterr().err


def test_ctrl_c_ends_the_command_line(study_file: Path, tmp_path: Path) -> None:
    """A sweep saves and ends with the exit code of the signal, without Python's traceback."""
    words = [sys.executable, "-m", "opshock", "sweep", study_file, "--store", tmp_path / "swept", "--progress", "lines", "-j", "1"]
    child = subprocess.Popen([str(word) for word in words], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert child.stderr is not None
    for line in child.stderr:
        if line.startswith("4 points"):
            break
    child.send_signal(signal.SIGINT)
    _, rest = child.communicate(timeout=20)
    assert child.returncode == 130
    assert "Traceback" not in rest
    assert not opshock.open_store(tmp_path / "swept").is_complete
