"""A command of the user as a source: it is run in the folder of the run and leaves the files that the case names."""

import json
import math
import os
import shlex
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from threading import Event
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.mishaps import reason, refused_writing
from fatigue.results import write_json
from fatigue.shown import visible
from fatigue.study.study_file import Study
from fatigue.study.variants.source.made import Asked, Made, SourceNumber
from fatigue.study.variants.source.placeholders import filled, names_in, values_of
from fatigue.study.variants.varied.base_files import CASE

SETTINGS, NUMBERS = "settings.json", "numbers.json"
STDOUT, STDERR = "stdout.txt", "stderr.txt"
LAST_LINES = 5  # of stderr, in a message
POLL_S = 0.1


def told(study: Study, asked: Asked) -> dict[str, Any]:
    """What a command is told, in ``settings.json``: settings and changes but those of the case it does not ask for.

    A run whose variant differs only in what its command is not told is the same run.
    """
    named = names_in(study.source.command or "")
    keys_of = {vary.short_name: {key for one in vary.given for key in one} for vary in study.vary}
    of_case = {name for name, keys in keys_of.items() if all(key.startswith(CASE) or key == "case" for key in keys)}
    return {
        "settings": {name: value for name, value in asked.settings.items() if name in named or name not in of_case},
        "changes": {key: value for key, value in asked.changes.items() if not key.startswith(CASE) and key != "case"},
        "seed": asked.seed,
        "event": asked.event,
        "files": {event: list(files) for event, files in asked.files.items()},
    }


def words_of(study: Study, asked: Asked, folder: Path) -> list[str]:
    """Words of the command of one run.

    Raises
    ------
    DataError : a quotation mark that does not end, or a format that a value does not have
    """
    text = study.source.command or ""
    try:
        words = shlex.split(text, posix=os.name != "nt")
    except ValueError as error:
        where = f"{study.path.name}: source.command"
        raise DataError(Problem("bad_command", where, f"{text!r}: {error}", "Close the quotation mark")) from None
    values = values_of(asked, study.path.parent.resolve(), folder.resolve())
    return [filled(word, values) for word in words]


def read_by(study: Study, words: Sequence[str]) -> list[Path]:
    """Files that a command reads, as far as the study tells: those among its words, and ``inputs``."""
    named = [Path(word) for word in words if os.sep in word or "/" in word]
    return sorted({*(path for path in named if path.is_file()), *map(study.resolve, study.source.inputs)})


def commanded(study: Study, asked: Asked, folder: Path, stop: Event) -> Made:
    """Run the command in a folder that is there and empty.

    Raises
    ------
    DataError : the command cannot be started, fails, is stopped, or does not leave what the case names
    """
    words = words_of(study, asked, folder)
    write_json(folder / SETTINGS, told(study, asked))
    code = _run(words, asked, folder, stop)
    if code != 0:
        what = f"the command ended with exit code {code}{_said(folder)}"
        raise DataError(Problem("command_failed", asked.place, what, f"See {folder / STDERR}"))
    refuse(DataError, _not_left(asked, folder))
    files = {event: {name: folder / name for name in names} for event, names in asked.files.items()}
    return Made(files, numbers=tuple(_numbers(folder, asked)))


def _run(words: Sequence[str], asked: Asked, folder: Path, stop: Event) -> int:
    """Exit code of a command; it is ended, with all that it started, when the study is stopped."""
    with refused_writing(folder), (folder / STDOUT).open("wb") as out, (folder / STDERR).open("wb") as err:
        try:
            process = subprocess.Popen(
                words, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True
            )
        except (OSError, ValueError, IndexError) as error:
            why = reason(error) if isinstance(error, OSError) else str(error)
            what = f"the command {words[0] if words else ''!r} cannot be started ({why})"
            remedy = "Correct [source] command; a program that is not on PATH needs its whole path, as {study}/run.sh"
            raise DataError(Problem("command_failed", asked.place, what, remedy)) from None
        while True:
            try:
                return process.wait(POLL_S)
            except subprocess.TimeoutExpired:
                if stop.is_set():
                    _end(process)
                    what = "the study was stopped"
                    raise DataError(Problem("stopped", asked.place, what, "Give the same command again")) from None


def _end(process: "subprocess.Popen[bytes]") -> None:
    """End a command and what it started."""
    if os.name == "nt":
        process.kill()
    else:
        os.killpg(process.pid, 9)
    process.wait()


def _not_left(asked: Asked, folder: Path) -> Iterator[Problem]:
    """Refusals of files that a command did not leave, and of such as have nothing in them."""
    for event, names in asked.files.items():
        for name in names:
            path = folder / name
            where = asked.place if asked.event else f"{asked.place}, event '{event}'"
            if not path.is_file():
                what = f"the command left no {name}{_said(folder)}"
                yield Problem("missing_history", where, what, f"Have it write {path}")
            elif path.stat().st_size == 0:
                yield Problem(
                    "missing_history", where, f"the command left an empty {name}", "Have it write the history"
                )


def _said(folder: Path) -> str:
    """The last lines of stderr, behind what happened."""
    try:
        text = (folder / STDERR).read_bytes().decode("utf-8", "replace")
    except OSError:
        return ""
    lines = [line.rstrip() for line in text.splitlines() if line.strip()][-LAST_LINES:]
    return f"; its stderr ends with: {visible(' | '.join(lines))}" if lines else "; its stderr is empty"


def _numbers(folder: Path, asked: Asked) -> Iterator[SourceNumber]:
    """Numbers of the run that a command may leave: ``{"name": 1.5}``, or ``{"name": {"value": 1.5, "unit": "Hz"}}``.

    Raises
    ------
    DataError : the file is none of these
    """
    path = folder / NUMBERS
    if not path.is_file():
        return
    remedy = 'Write {"name": 1.5}, or {"name": {"value": 1.5, "unit": "Hz"}}'
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        for name, given in record.items():
            table = given if isinstance(given, Mapping) else {"value": given}
            value = table["value"]
            number = math.nan if value is None else float(value)
            missing = "the command gave none" if math.isnan(number) else ""
            yield SourceNumber(str(name), number, str(table.get("unit", "")), str(table.get("reason", missing)))
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        what = f"the command left a {NUMBERS} that cannot be read ({type(error).__name__}: {error})"
        raise DataError(Problem("bad_numbers", asked.place, what, remedy)) from None
