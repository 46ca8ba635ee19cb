"""Histories that are there already as a source: a pattern says which file, or which folder of files, a run has."""

from collections.abc import Iterator
from pathlib import Path

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.naming import missing_file
from fatigue.study.study_file import Study
from fatigue.study.variants.source.made import Asked, Made
from fatigue.study.variants.source.placeholders import filled, names_in, values_of


def found(study: Study, asked: Asked) -> Made:
    """Where the files of a run are.

    Raises
    ------
    DataError : files that are not there, or a file that cannot stand for several
    """
    problems: list[Problem] = []
    files = {event: dict(_of_event(study, asked, event, problems)) for event in asked.files}
    refuse(DataError, problems)
    return Made(files)


def _of_event(study: Study, asked: Asked, event: str, problems: list[Problem]) -> Iterator[tuple[str, Path]]:
    """Every file of one event with its place."""
    pattern = study.source.files or ""
    values = values_of(asked, study.path.parent.resolve()) | {"event": asked.event or event}
    path, names = study.resolve(filled(pattern, values)), asked.files[event]
    where = f"{study.path.name}: source.files ({asked.place}{'' if asked.event else f', event {event!r}'})"
    if path.is_dir():
        for name in names:
            if (path / name).is_file():
                yield name, path / name
            else:
                problems.append(missing_file(path / name, where, base=study.path.parent))
    elif not path.is_file():
        problems.append(missing_file(path, where, base=study.path.parent))
    elif len(names) > 1:
        what = f"{path} is one file, and the event has {', '.join(names)}"
        problems.append(Problem("contradiction", where, what, "Name the folder that has all of them"))
    elif len(asked.files) > 1 and "event" not in names_in(pattern):
        what = f"{path} is one file, and {len(asked.files)} events have a history"
        remedy = "Name a folder, write {event}, or name the events that get it under [source] events"
        problems.append(Problem("contradiction", where, what, remedy))
    else:
        yield names[0], path
