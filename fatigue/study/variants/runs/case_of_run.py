"""The case file of one run: that of its variant, with histories of the run and the way to all other files."""

import os
from collections.abc import Collection, Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

from fatigue.case import Case, Event
from fatigue.case.checks import CHECK_FILES
from fatigue.case.tables import BASIS_FILES, BODY_FILES, GAUGE_FILES
from fatigue.study.variants.varied.toml_text import toml_text

CASE_FILE = "case.toml"


def files_of_event(event: Event) -> tuple[str, ...]:
    """Files of an event as the case names them: its history, those of unit loads and of channels, each once."""
    loads = (load.history for load in event.unit_load)
    channels = (channel.history for channel in event.channel)
    return tuple(dict.fromkeys(filter(None, (event.history, *loads, *channels))))


def run_case_text(
    tables: Mapping[str, Any],
    case: Case,
    folder: Path,
    given: Mapping[str, Mapping[str, Path]],
    added: Mapping[str, Mapping[str, Any]],
) -> str:
    """Text of the case file of a run in its folder; all files in it are named by their way from there.

    Parameters
    ----------
    tables, case : the case of the variant
    folder : where the case file will be
    given : by event, where each of its files is, by the name that the case has for it
    added : by event, keys that are set for it, as the speed of a ride; its channels come before those of the case
    """
    written = deepcopy(dict(tables))
    for table, key in _places(written):
        table[key] = way(case.resolve(table[key]), folder)
    for event, own in zip(written["mission"]["event"], case.mission.event, strict=True):
        files = given.get(own.name, {})
        for table, key, name in _places_of_event(event, own):
            table[key] = way(files.get(name, case.resolve(name)), folder)
        keys = added.get(own.name, {})
        there = {channel["name"] for channel in event.get("channel", ())}
        channels = [one for one in keys.get("channel", ()) if one["name"] not in there]
        for key, value in keys.items():
            if value is None:
                event.pop(key, None)
            elif key != "channel":
                event[key] = value
        if channels:
            event["channel"] = [*channels, *event.get("channel", ())]
    return toml_text(written)


def way(path: Path, folder: Path) -> str:
    """Path as seen from a folder, so that both can be moved together; on another drive the whole path."""
    path, folder = path.parent.resolve() / path.name, folder.resolve()
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:  # Windows: no way from one drive to another
        return path.as_posix()


def body_files(case: Case, events: Collection[str]) -> dict[str, Path]:
    """Every file that a case names but those of some events, by its key."""
    numbers = [i for i, event in enumerate(case.mission.event, 1) if event.name in events]
    skipped = tuple(f"mission.event[{i}]." for i in numbers)
    return {key: path for key, path in case.input_files().items() if not key.startswith(skipped)}


def _places(tables: dict[str, Any]) -> Iterator[tuple[dict[str, Any], str]]:
    """Every table and key that names a file, outside the events."""
    body = tables["body"]
    yield from ((body, key) for key in (*BODY_FILES, *BASIS_FILES, *GAUGE_FILES, "register") if key in body)
    for load in body.get("unit_load", ()):
        yield from ((load, key) for key in ("nodal_forces", "element_forces", "gauge_forces") if key in load)
    checks = tables.get("checks", {})
    yield from ((checks, key) for key in CHECK_FILES if key in checks)
    ride = tables.get("ride", {})
    yield from ((ride, key) for key in ("vibration_table",) if key in ride)


def _places_of_event(event: dict[str, Any], own: Event) -> Iterator[tuple[dict[str, Any], str, str]]:
    """Tables and keys of an event that name a file, with the name that the case has for it."""
    if own.history is not None:
        yield event, "history", own.history
    for kind, named in (
        ("unit_load", [o.history for o in own.unit_load]),
        ("channel", [o.history for o in own.channel]),
    ):
        for table, name in zip(event.get(kind, ()), named, strict=True):
            if name is not None:
                yield table, "history", name
