"""One run of a study from its settings to its numbers: histories, case, assessment, ride, diagnosis.

A record in the folder of the run has the key of everything its numbers depend on. It is written last; a run with it is
not computed again as long as the key is the same and its files are as they were.
"""

import json
from collections.abc import Collection, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from fatigue.assess import assess
from fatigue.case import Case
from fatigue.diagnose import diagnose
from fatigue.errors import FatigueError, Problem
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import replacing
from fatigue.pipeline.solve.body import conversion_file, register_file
from fatigue.results import read_provenance, write_json
from fatigue.results.provenance import PROVENANCE
from fatigue.ride.story import ride
from fatigue.study.quantities import Number
from fatigue.study.variants.runs.case_of_run import CASE_FILE, body_files, run_case_text
from fatigue.study.variants.runs.collected import diagnosis_numbers, ride_numbers, weld_numbers
from fatigue.study.variants.runs.hashes import Hashes, as_json, file_hash, from_json, key_of
from fatigue.study.variants.runs.planned_runs import PlannedRun
from fatigue.study.variants.source.made import Made, SourceNumber

RECORD, RESULT = "run.json", "result"


@dataclass(frozen=True, slots=True)
class Done:
    """A run that is done: its numbers, warnings, and the hashes of its histories by event."""

    numbers: tuple[Number, ...]
    warnings: tuple[Problem, ...]
    histories: Mapping[str, str]
    reused: bool = False


def source_numbers(run: PlannedRun, made: Mapping[str, Made]) -> Iterator[Number]:
    """Numbers that the source says; where events have runs of their own each has the name of its event."""
    for event, one in made.items():
        for number in one.numbers:
            yield _number(run, number, f"@{event}" if event else "")


def _number(run: PlannedRun, of: SourceNumber, behind: str) -> Number:
    return Number(run.variant, run.seed, f"{of.quantity}{behind}", "", of.value, of.unit, of.reason)


def known(run: PlannedRun, made: Mapping[str, Made], hashes: Hashes, *, diagnosed: bool) -> Done | None:
    """A run as an earlier command left it; None where it is not finished, or anything it depends on has changed.

    ``made`` is what the source gave, by event. A run without case is known as soon as its source is.

    Raises
    ------
    DataError : a file that it depends on cannot be read
    """
    numbers, histories = tuple(source_numbers(run, made)), _histories(made)
    if run.case is None:
        return Done(numbers, (), histories, reused=all(one.reused for one in made.values()))
    before = finished(run, _key(run, made, hashes, diagnosed=diagnosed), _case_text(run, made))
    return None if before is None else replace(before, numbers=(*numbers, *before.numbers), histories=histories)


def completed(run: PlannedRun, made: Mapping[str, Made], hashes: Hashes, threads: int, *, diagnosed: bool) -> Done:
    """Take a run whose histories are there to its numbers, unless it is known; ``made`` as of ``known``.

    Raises
    ------
    CaseError, DataError, NumericalError : what assessment or case say
    """
    before = known(run, made, hashes, diagnosed=diagnosed)
    if before is not None or run.case is None:
        return before or Done((), (), {})
    case_file = run.folder / CASE_FILE
    with refused_writing(run.folder):
        run.folder.mkdir(parents=True, exist_ok=True)
        (run.folder / RECORD).unlink(missing_ok=True)
    with replacing(case_file) as unfinished:
        unfinished.write_text(_case_text(run, made), encoding="utf-8", newline="\n")
    done = _assessed(run, case_file, threads, diagnosed=diagnosed)
    _record(run, _key(run, made, hashes, diagnosed=diagnosed), done)
    return replace(done, numbers=(*source_numbers(run, made), *done.numbers), histories=_histories(made))


def _assessed(run: PlannedRun, case_file: Path, threads: int, *, diagnosed: bool) -> Done:
    """Assess a case and look at its channels; what these cannot say is a warning, the lives stay."""
    result = run.folder / RESULT
    found = assess(case_file, result, threads=threads, force=True, report=False)
    warnings: list[Problem] = list(found.warnings)
    numbers = list(weld_numbers(run.variant, run.seed, result))
    has_channels = "[[mission.event.channel]]" in case_file.read_text(encoding="utf-8")
    if has_channels:
        try:
            ridden = ride(result, case_file=case_file, threads=threads)
            warnings += ridden.warnings
            numbers += ride_numbers(run.variant, run.seed, ridden)
        except FatigueError as error:
            warnings += error.problems
    if diagnosed:
        try:
            numbers += diagnosis_numbers(run.variant, run.seed, diagnose(result, case_file=case_file))
        except FatigueError as error:
            warnings += error.problems
    return Done(tuple(numbers), tuple(warnings), {})


def _case_text(run: PlannedRun, made: Mapping[str, Made]) -> str:
    """Text of the case of a run; it names files by their way, so that a folder that moved alone has another one."""
    assert run.case is not None
    given = {event: files for one in made.values() for event, files in one.files.items()}
    added = {event: keys for one in made.values() for event, keys in one.added.items()}
    return run_case_text(run.case.tables, run.case.case, run.folder, given, added)


def finished(run: PlannedRun, key: str, case_text: str) -> Done | None:
    """What a finished run found; None where it is not finished, or its case or result is not as it would be now."""
    try:
        if (run.folder / CASE_FILE).read_text(encoding="utf-8") != case_text:
            return None
        record = json.loads((run.folder / RECORD).read_text(encoding="utf-8"))
        if record["key"] != key or record["result"] != sha256(run.folder / RESULT / PROVENANCE):
            return None
        read_provenance(run.folder / RESULT)
        numbers = tuple(_read(run, *row) for row in record["numbers"])
        warnings = tuple(_problem(**one) for one in record["warnings"])
    except (OSError, ValueError, LookupError, TypeError, FatigueError):
        return None
    return Done(numbers, warnings, {}, reused=True)


def _read(run: PlannedRun, quantity: str, weld: str, value: float | str | None, unit: str, reason: str) -> Number:
    return Number(run.variant, run.seed, quantity, weld, from_json(value), unit, reason)


def _problem(code: str, where: str, what: str, remedy: str, count: int) -> Problem:
    return Problem(code, where, what, remedy, count)


def _record(run: PlannedRun, key: str, done: Done) -> None:
    """Write what a run found, and with it that it is finished."""
    record = {
        "key": key,
        "variant": run.variant,
        "seed": run.seed,
        "changes": dict(run.planned.changes),
        "result": sha256(run.folder / RESULT / PROVENANCE),
        "numbers": [[n.quantity, n.weld, as_json(n.value), n.unit, n.reason] for n in done.numbers],
        "warnings": [asdict(problem) for problem in done.warnings],
    }
    with replacing(run.folder / RECORD) as unfinished:
        write_json(unfinished, record)


def _histories(made: Mapping[str, Made]) -> dict[str, str]:
    """Hash of every file that the source gave, by event and name."""
    files = {
        (event, name): path for one in made.values() for event, of in one.files.items() for name, path in of.items()
    }
    return {f"{event}: {name}": file_hash(path) for (event, name), path in files.items()}


def _key(run: PlannedRun, made: Mapping[str, Made], hashes: Hashes, *, diagnosed: bool) -> str:
    """Key of everything the numbers of an assessed run depend on."""
    assert run.case is not None
    events = {event for one in made.values() for event in one.files}
    return key_of(
        {
            "case": run.case.tables,
            "inputs": hashes.of_all(_inputs(run.case.case, events)),
            "histories": _histories(made),
            "added": {event: keys for one in made.values() for event, keys in one.added.items()},
            "diagnosed": diagnosed,
        }
    )


def _inputs(case: Case, events: Collection[str]) -> dict[str, Path]:
    """Every file that a run reads but those of the events that the source gives."""
    table = case.ride.vibration_table
    more = {
        "beside: register": register_file(case),
        "beside: conversion": conversion_file(case),
        "ride.vibration_table": None if table is None else case.resolve(table),
    }
    return body_files(case, events) | {name: path for name, path in more.items() if path is not None}
