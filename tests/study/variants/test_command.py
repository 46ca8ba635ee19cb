"""A command as a source: what it is told, what it has to leave, and what is said where it does not."""

import json
import sys
import time
from pathlib import Path
from threading import Event, Thread

import pytest

from fatigue.errors import DataError
from fatigue.study.study_file import load_study
from fatigue.study.variants.source.command import commanded, read_by, told, words_of
from fatigue.study.variants.source.made import Asked
from fatigue.study.variants.story import run_study
from tests.study.variants.small_study import without_case

PYTHON = Path(sys.executable).as_posix()
FILES = {"worn": ("worn.csv", "sub/channels.csv")}


def asked(**changes):
    """One run of a command that has to leave two files."""
    given = {"variant": "fe=14", "seed": 3, "event": "", "files": FILES, "changes": {"vehicle.converter.fe_hz": 14.0}}
    return Asked(**(given | {"settings": {"fe": 14.0}} | changes))


def run(folder, script, of=None, stop=None):
    """Run a script of Python as the command of a study, in a folder of its own."""
    study = load_study(without_case(folder, f"{PYTHON} {{study}}/script.py {{fe}} {{seed}} {{run}}"))
    (folder / "script.py").write_text(script)
    place = folder / "run"
    place.mkdir()
    return commanded(study, of or asked(), place, stop or Event()), place


def refused(folder, script, of=None):
    """Problems of a script that is refused, as text."""
    with pytest.raises(DataError) as found:
        run(folder, script, of)
    return str(found.value)


def test_what_a_command_is_told(tmp_path):
    """Words with settings, the folder of the run as the working folder, and all of it in settings.json."""
    script = """\
import os, sys, pathlib
assert sys.argv[1:3] == ["14", "3"], sys.argv
assert pathlib.Path(sys.argv[3]) == pathlib.Path.cwd()
os.mkdir("sub")
for name in ("worn.csv", "sub/channels.csv"):
    pathlib.Path(name).write_text("x")
numbers = '{"a": 1, "b": {"value": null, "unit": "Hz", "reason": "none"}, "c": {"value": 2}}'
pathlib.Path("numbers.json").write_text(numbers)
"""
    made, place = run(tmp_path, script)
    assert made.files["worn"]["sub/channels.csv"] == place / "sub" / "channels.csv"
    assert [(n.quantity, n.unit, n.reason) for n in made.numbers] == [("a", "", ""), ("b", "Hz", "none"), ("c", "", "")]
    record = json.loads((place / "settings.json").read_text())
    assert record["settings"] == {"fe": 14.0}
    assert record["changes"] == {"vehicle.converter.fe_hz": 14.0}
    assert (record["seed"], record["files"]) == (3, {"worn": ["worn.csv", "sub/channels.csv"]})


def test_files_that_are_not_left(tmp_path):
    """Each is named, with the last lines of stderr; an empty file is none."""
    text = refused(tmp_path, "import sys; open('worn.csv', 'w'); print('first\\n\\nno licence', file=sys.stderr)")
    assert "variant 'fe=14', seed 3, event 'worn': the command left an empty worn.csv" in text
    assert "the command left no sub/channels.csv; its stderr ends with: first | no licence" in text


def test_a_command_that_fails(tmp_path):
    """With its exit code and its stderr, of which the last lines are shown, and where the rest is."""
    lines = "".join(f"line {number}\n" for number in range(50))
    text = refused(tmp_path, f"import sys; sys.stderr.write({lines!r} + '\\x1b[31mred'); sys.exit(7)")
    assert "ended with exit code 7; its stderr ends with: line 46 | line 47 | line 48 | line 49 | \\x1b[31mred" in text
    assert str(tmp_path / "run" / "stderr.txt") in text


@pytest.mark.parametrize("numbers", ["[1]", "{", '{"a": "fast"}', '{"a": {}}'])
def test_numbers_that_are_none(tmp_path, numbers):
    """The remedy has the form that is read."""
    of = asked(files={})
    text = refused(tmp_path, f"open('numbers.json', 'w').write({numbers!r})", of)
    assert "a numbers.json that cannot be read" in text
    assert '{"name": 1.5}' in text


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("no-such-program --fe {fe}", "'no-such-program' cannot be started (No such file or directory)"),
        ("{study}/study.toml", "cannot be started (Permission denied)"),
        ('python "x', "No closing quotation"),
        ("echo {fe:03d}", "cannot be filled in"),
    ],
)
def test_commands_that_cannot_be_started(tmp_path, command, words):
    """Each run says so, and the study ends with exit code 3."""
    found = run_study(without_case(tmp_path, command), tmp_path / "out", threads=1)
    assert found.exit_code == 3
    assert all(words in problem.what for problem in found.failures)
    assert {run.state for run in found.runs} == {"failed"}
    assert found.as_text()


def test_what_a_command_starts_ends_with_the_study(tmp_path):
    """Also what its shell left behind."""
    script = f"""\
import subprocess, sys, time
late = "import time, pathlib; time.sleep(1.5); pathlib.Path('late').touch()"
child = subprocess.Popen([{sys.executable!r}, "-c", late])
open("started", "w")
child.wait()
"""
    stop = Event()
    errors = []

    def work():
        try:
            run(tmp_path, script, stop=stop)
        except DataError as error:
            errors.append(str(error))

    thread = Thread(target=work)
    thread.start()
    while not (tmp_path / "run" / "started").exists():
        time.sleep(0.02)
    stop.set()
    thread.join(5.0)
    assert errors
    assert "the study was stopped" in errors[0]
    time.sleep(1.6)
    assert not (tmp_path / "run" / "late").exists()


def test_words_of_a_command_that_are_files_are_inputs(tmp_path):
    """And what the study lists."""
    path = without_case(tmp_path, "{study}/a.py x {study}/none", 'title = "x"\n')
    text = path.read_text().replace("command =", 'inputs = ["b.dat"]\ncommand =').replace('title = "x"\n', "")
    path.write_text(text)
    (tmp_path / "a.py").write_text("")
    (tmp_path / "b.dat").write_text("")
    study = load_study(path)
    words = words_of(study, asked(), tmp_path)
    assert read_by(study, words) == [tmp_path / "a.py", tmp_path / "b.dat"]


def test_what_is_of_the_case_alone_is_not_told_unless_it_is_asked_for(tmp_path):
    """So that variants of a curve share their histories."""
    path = without_case(tmp_path, "run {fe}", '[[vary]]\nkey = "case.curve.survival"\nvalues = ["mean"]\n')
    of = asked(settings={"fe": 14.0, "survival": "mean"}, changes={"case.curve.survival": "mean"})
    assert told(load_study(path), of)["settings"] == {"fe": 14.0}
    assert told(load_study(path), of)["changes"] == {}
    path.write_text(path.read_text().replace("{fe}", "{survival}"))
    assert told(load_study(path), of)["settings"] == {"fe": 14.0, "survival": "mean"}
