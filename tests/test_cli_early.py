"""Typing mistakes are told before anything heavy is imported, in the words of those who would find them later."""

import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from fatigue.case import load_case
from fatigue.cli import cli
from fatigue.cli.early import missing_foreign, missing_tables, refuse_missing_case
from fatigue.errors import FatigueError
from fatigue.readers.foreign.read import recognise
from fatigue.readers.neutral.files import open_columns
from tests.command_line import fatigue

ROOT = Path(__file__).parents[1]
LIGHT = """
import json, sys
from tests.command_line import fatigue

heavy = {"numba", "scipy", "plotly", "jinja2"}
for line in sys.stdin:
    done = fatigue(*json.loads(line), cwd=".")
    imported = heavy & set(sys.modules)
    heavy -= imported  # it is told once, of the command that did it
    print(json.dumps([done.returncode, done.stderr, sorted(imported)]), flush=True)
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Files that are there, so that only one thing is wrong."""
    folder = tmp_path_factory.mktemp("early")
    for name in ("model.bdf", "run.op2", "q.csv", "there.csv", "there.vtp", "case.toml"):
        (folder / name).write_text("x")
    for name, file in (("result", "nodes.parquet"), ("body", "modes.csv"), ("synth", "case.toml")):
        (folder / name).mkdir()
        (folder / name / file).write_text("mine")
    return folder


@pytest.fixture(scope="module")
def early(folder):
    """Run a command that is mistaken; give exit code, the error lines and which heavy packages it imported.

    One process runs them all, as none of them may leave more in it than it found.
    """
    with subprocess.Popen(
        [sys.executable, "-c", LIGHT],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as light:

        def run(*arguments):
            print(json.dumps(arguments), file=light.stdin, flush=True)
            code, said, imported = json.loads(light.stdout.readline())
            return code, [line for line in said.splitlines() if line.startswith(("error", "Error"))], imported

        yield run
        light.stdin.close()


CONVERT = ("convert", "--mesh", "model.bdf", "--forces", "run.op2", "-o", "out")
MISTAKES = {
    "check": (("check", "none.toml"), 3, "none.toml: there is no such file"),
    "assess": (("assess", "none.toml", "-o", "out"), 3, "none.toml: there is no such file"),
    "show": (("show", "none"), 3, "none: no finished result in this folder"),
    "report": (("report", "none"), 3, "none: no finished result in this folder"),
    "diagnose": (("diagnose", "none"), 3, "none: no finished result in this folder"),
    "spectra": (("spectra", "none"), 3, "none: no finished result in this folder"),
    "verify": (("verify", "--results", "none"), 3, "none: no finished result in this folder"),
    "welds": (("welds", "none.bdf"), 3, "none.bdf: there is no such file"),
    "welds register": (("welds", "model.bdf", "--register", "none.csv"), 3, "none.csv: there is no such file"),
    "welds output": (("welds", "model.bdf", "-o", "there.csv"), 3, "there.csv: the file exists"),
    "welds picture": (("welds", "model.bdf", "--vtp", "there.vtp"), 3, "there.vtp: is there already"),
    "welds units": (("welds", "model.bdf", "--units", "mm-kg"), 3, "units: unknown unit system 'mm-kg'"),
    "convert mesh": ((*CONVERT, "--mesh", "none.bdf"), 3, "none.bdf: there is no such file"),
    "convert coordinates": ((*CONVERT, "--coordinates", "none.csv"), 3, "none.csv: there is no such file"),
    "convert columns": ((*CONVERT, "--columns", "none.csv"), 3, "none.csv: there is no such file"),
    "convert units": ((*CONVERT, "--coordinate-units", "SI"), 3, "coordinate units: unknown unit system 'SI'"),
    "convert modes": ((*CONVERT, "--ignore-modes", "1-6;9"), 3, "'1-6;9' is no mode or range"),
    "convert range": ((*CONVERT, "--interface-modes", "5-2"), 3, "--interface-modes: '5-2' is no mode or range"),
    "convert unit loads": ((*CONVERT, "--unit-loads", "none.op2"), 3, "none.op2: there is no such file"),
    "convert displacement": ((*CONVERT, "--displacement", "no.csv", "3", "z"), 3, "no.csv: there is no such file"),
    "convert target": ((*CONVERT, "--target-km", "inf"), 2, "'inf' is not a finite number"),
    "convert step": ((*CONVERT, "--resample", "nan"), 2, "'nan' is not a finite number"),
    "diagnose bin": (("diagnose", "result", "--bin-km", "0"), 2, "Invalid value for '--bin-km'"),
    "diagnose share": (("diagnose", "result", "--share-of-limit", "nan"), 2, "'nan' is not a finite number"),
    "spectra distance": (("spectra", "result", "--compare-km", "0"), 2, "Invalid value for '--compare-km'"),
    "verify all": (("verify", "--all"), 2, "--all recounts the points of a result"),
    "synth rate": (("synth", "new", "--rate", "-1"), 2, "Invalid value for '--rate'"),
    "convert curve": ((*CONVERT, "--curve", "master-alu"), 3, "--curve: there is no curve 'master-alu'"),
    "convert speed": ((*CONVERT, "--speed", "0"), 2, "Invalid value for '--speed'"),
    "convert folder": ((*CONVERT, "-o", "body"), 3, "modes.csv: the file exists and is not the work of an earlier"),
    "tension patch": (("tension-patch", "there.csv"), 3, "there.csv: is there already"),
    "patch results": (("tension-patch", "none.op2", "--results"), 3, "none.op2: there is no such file"),
    "synth": (("synth", "synth"), 3, "case.toml: is there already"),
    "example": (("example", "synth"), 3, "case.toml: is there already"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_typing_mistake_is_told_before_the_imports(early, name):
    """Exit code and one line as ever, and neither numba nor scipy nor plotly was waited for."""
    arguments, code, said = MISTAKES[name]
    found, errors, imported = early(*arguments)
    assert (found, imported) == (code, [])
    (line,) = errors
    assert said in line


def refusal_of(do, *arguments):
    """Problems that a call raises."""
    with pytest.raises(FatigueError) as refused:
        do(*arguments)
    return refused.value.problems


def test_the_words_are_those_of_the_readers(tmp_path):
    """Who finds the mistake, early or late, makes no difference."""
    for name in ("case.toml", "run.op2", "there.csv"):
        (tmp_path / name).write_text("x")
    for path in (tmp_path / "none.toml", tmp_path, tmp_path / "CASE.toml", tmp_path / "none" / "case.toml"):
        assert refusal_of(refuse_missing_case, path) == refusal_of(load_case, path)
    for path in (tmp_path / "none.op2", tmp_path, tmp_path / "Run.op2", tmp_path / "run.op2" / "x"):
        assert tuple(missing_foreign(path)) == refusal_of(recognise, path)
    for path in (tmp_path / "none.csv", tmp_path, tmp_path / "There.csv"):
        assert tuple(missing_tables(path)) == refusal_of(open_columns, path, ())


def test_all_missing_files_are_named_at_once(early):
    """Two of them, two lines."""
    code, errors, _ = early("convert", "--mesh", "a.bdf", "--forces", "b.op2", "-o", "out")
    assert code == 3
    assert len(errors) == 2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("tension-patch", "nowhere/patch.bdf"), "nowhere/patch.bdf: there is no folder nowhere. Make it"),
        (("synth", "there.csv/big", "--nodes", "20"), "there.csv/big: cannot be written (Not a directory)"),
        (("show", "x" * 300), "cannot be read or written (File name too long)"),
        (("check", "x" * 300), "cannot be read or written (File name too long)"),
        (("example", "x" * 300), "cannot be read or written (File name too long)"),
    ],
    ids=["no folder", "below a file", "result too long", "case too long", "folder too long"],
)
def test_what_the_system_refuses_is_told(early, arguments, words):
    """It is no fault of the program: one line with place and reason, and the exit code of bad data."""
    code, lines, _ = early(*arguments)
    assert code == 3
    assert len(lines) == 1
    assert words in lines[0]


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT])
def test_a_full_disk_is_told(code, monkeypatch):
    """What to do is to make room; the system often names no file."""

    def full(**_):
        raise OSError(code, "No space left on device")

    monkeypatch.setattr(cli, "main", full)
    done = fatigue("show")
    assert done.returncode == 3
    said = "error: a file: cannot be written (No space left on device). Make room, and give the same command again.\n"
    assert done.stderr == said
