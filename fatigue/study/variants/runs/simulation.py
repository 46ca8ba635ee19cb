"""One run of the source: made in a folder of its own, or taken from there if it was finished before.

A record in the folder has the key of everything the run depends on and the hash of every file it left; it is written
last, so that a run that was cut off is none.
"""

import json
import shutil
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from threading import Event
from typing import Any

from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import replacing
from fatigue.results import write_json
from fatigue.study.study_file import Study
from fatigue.study.variants.runs.hashes import Hashes, are_unchanged, as_json, file_hash, files_below, from_json, key_of
from fatigue.study.variants.source import command
from fatigue.study.variants.source.builtin import Bodies, body_inputs, ridden
from fatigue.study.variants.source.files import found
from fatigue.study.variants.source.made import Asked, Made, SourceNumber
from fatigue.study.variants.varied.base_files import BaseFiles, ChangedCase

RECORD = "simulation.json"


@dataclass(frozen=True, slots=True)
class Simulation:
    """A run of the source: what is asked for, the case it is for, its key, and its folder.

    The folder is that of the first run with the same key, as of variants that differ in their case only.
    """

    asked: Asked
    case: ChangedCase | None
    key: str
    folder: Path


def simulation_of(
    study: Study, files: BaseFiles, asked: Asked, case: ChangedCase | None, folder: Path, hashes: Hashes
) -> Simulation:
    """The simulation that makes what is asked for.

    Raises
    ------
    DataError : a file that it depends on cannot be read
    """
    if study.source.files is not None:
        return Simulation(asked, case, "", folder)
    record: dict[str, Any]
    if study.is_builtin:
        vehicle = files.changed_vehicle(asked.changes)
        assert vehicle is not None
        vehicle = replace(vehicle, run=replace(vehicle.run, seed=asked.seed))
        body = {path.name: hashes.of(path) for path in body_inputs(vehicle)}
        tables = asdict(vehicle)
        tables["car"].pop("body")
        record = {"vehicle": tables, "body": body, "rate_hz": study.source.rate_hz, "has_case": case is not None}
    else:
        words = command.words_of(study, asked, folder)
        inputs = sorted((path.name, hashes.of(path)) for path in command.read_by(study, words))
        record = {"command": study.source.command, "inputs": inputs, "told": command.told(study, asked)}
    return Simulation(asked, case, key_of({"simulation": record}), folder)


def simulated(study: Study, files: BaseFiles, bodies: Bodies, simulation: Simulation, stop: Event) -> Made:
    """What a run of the source gave: as it was left if it is finished, else made now.

    Raises
    ------
    CaseError, DataError, NumericalError : what the source says
    """
    asked, folder = simulation.asked, simulation.folder
    if study.source.files is not None:
        return found(study, asked)
    if (earlier := finished(simulation)) is not None:
        return earlier
    with refused_writing(folder):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
    if study.is_builtin:
        vehicle = files.changed_vehicle(asked.changes)
        assert vehicle is not None
        case = None if simulation.case is None else simulation.case.case
        made = ridden(vehicle, bodies.of(vehicle), study.source.rate_hz, asked, case, folder)
    else:
        made = command.commanded(study, asked, folder, stop)
    _record(simulation, made)
    return made


def before(study: Study, simulation: Simulation) -> Made | None:
    """What an earlier command left; None where there is nothing.

    Raises
    ------
    DataError : files are not where the pattern of the study says
    """
    return found(study, simulation.asked) if study.source.files is not None else finished(simulation)


def finished(simulation: Simulation) -> Made | None:
    """What a finished run left; None where it is not finished, or anything is not as it was left."""
    folder = simulation.folder
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        if record["key"] != simulation.key or not are_unchanged(folder, record["left"]):
            return None
        files = {event: {name: folder / path for name, path in of.items()} for event, of in record["files"].items()}
        numbers = tuple(SourceNumber(n, from_json(v), u, r) for n, v, u, r in record["numbers"])
        return Made(files, record["added"], numbers, reused=True)
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return None


def _record(simulation: Simulation, made: Made) -> None:
    """Write what a run left, and with it that it is finished."""
    folder = simulation.folder
    left = {path.relative_to(folder).as_posix(): file_hash(path) for path in files_below(folder)}
    record = {
        "key": simulation.key,
        "files": _names(made.files, lambda path: path.relative_to(folder).as_posix()),
        "added": made.added,
        "numbers": [[n.quantity, as_json(n.value), n.unit, n.reason] for n in made.numbers],
        "left": left,
    }
    with replacing(folder / RECORD) as unfinished:
        write_json(unfinished, record)


def _names(files: Mapping[str, Mapping[str, Path]], of: Callable[[Path], str]) -> dict[str, dict[str, str]]:
    return {event: {name: of(path) for name, path in own.items()} for event, own in files.items()}
