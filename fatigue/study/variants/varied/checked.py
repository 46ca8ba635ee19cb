"""Every value of a study tried before anything runs: whether vehicle and case can have it, alone and with others."""

import difflib
import shlex
import string
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from fatigue.case import Case
from fatigue.errors import FatigueError, Problem
from fatigue.study.study_file import TAKEN, Study, short_name
from fatigue.study.variants.runs.case_of_run import files_of_event
from fatigue.study.variants.source.builtin import body_problems
from fatigue.study.variants.varied.base_files import CASE, OWN, VEHICLE, BaseFiles
from fatigue.study.variants.varied.expansion import Aspect, Plan, Planned
from fatigue.study.variants.varied.names import shown

SEED = "vehicle.run.seed"
OF_A_SHELL = frozenset(("&&", "||", "|", ";", "&", "<", ">", ">>", "2>", "2>&1"))
PREFIXES = "vehicle.<table>.<key>, case.<table>.<key>, case, or own.<name>"


def key_problems(study: Study, files: BaseFiles, plan: Plan) -> Iterator[Problem]:
    """Refusals of keys and values: each alone on the base, then, if all are right, each variant as a whole."""
    found = list(_unique(_alone(study, files, plan)))
    if not found:
        found = list(_unique(_together(study, files, plan)))
    yield from found


def placeholder_problems(study: Study, plan: Plan) -> Iterator[Problem]:
    """Refusals of placeholders of the source that no setting has, and of values that they cannot write."""
    for key in ("command", "files"):
        text = getattr(study.source, key)
        if text is None:
            continue
        where = f"{study.path.name}: source.{key}"
        try:
            names = [name for _, name, _, _ in string.Formatter().parse(text) if name is not None]
        except ValueError as error:
            yield Problem("bad_placeholder", where, f"{text!r} has a brace alone ({error})", "Write {{ for a brace")
            continue
        if key == "command":
            yield from _shell_problems(text, where)
        known = known_placeholders(study, plan.aspects)
        for name in dict.fromkeys(name for name in names if name not in known):
            near = difflib.get_close_matches(name, known, n=1)
            remedy = f"Write {{{near[0]}}}" if near else f"Name one of {', '.join(known)}; {{{{ stands for a brace"
            yield Problem("unknown_placeholder", where, f"no setting is called {name!r}", remedy)
        if key == "files" and "run" in names:
            yield Problem(
                "unknown_placeholder", where, "{run} is made for a command only", "Name a folder that is there"
            )


def _shell_problems(command: str, where: str) -> Iterator[Problem]:
    """Refusal of what only a shell understands: a program would get it as a word, and what follows would not be run."""
    try:
        words = shlex.split(command, posix=False)  # keeps quotation marks: a word in them is meant
    except ValueError:
        return  # the source refuses it
    found = next((word for word in words if word in OF_A_SHELL), None)
    if found is not None:
        what = f"{found} is for a shell, and the command is started without one"
        yield Problem("bad_command", where, what, 'Write a script, or sh -c "..."')


def known_placeholders(study: Study, aspects: Iterable[Aspect]) -> list[str]:
    """Names of all placeholders: of settings, and those of every study."""
    of_runs = (short_name(key) for run in study.source.run for key in run.set)
    return list(dict.fromkeys((*(aspect.name for aspect in aspects), *of_runs, *TAKEN[:-1])))


def _alone(study: Study, files: BaseFiles, plan: Plan) -> Iterator[Problem]:
    """Mistakes that a value makes by itself."""
    varied: dict[str, str] = {}
    for aspect in plan.aspects:
        for key in sorted(aspect.keys):
            varied[key] = aspect.where
            yield from _unknown_kind(study, f"{study.path.name}: {aspect.where}", key)
        for level in aspect.levels:
            where = f"{study.path.name}: {aspect.where} ({aspect.name} = {shown(level.setting)})"
            yield from _tried(files, where, level.changes)
    for number, run in enumerate(study.source.run, 1):
        where = f"{study.path.name}: source.run[{number}]"
        for key in run.set:
            yield from _unknown_kind(study, where, key)
            if key in varied:
                what = f"{key!r} is varied by {varied[key]}, and every run of event {run.event!r} would set it again"
                yield Problem("contradiction", f"{where}.set", what, "Vary it, or set it for the event")
            elif key.startswith(CASE) or key == "case":
                what = f"{key!r} is of the case, which all events of a run share"
                yield Problem("contradiction", f"{where}.set", what, "Set keys of the vehicle, or of the source's own")
        yield from _tried(files, where, run.set)


def _together(study: Study, files: BaseFiles, plan: Plan) -> Iterator[Problem]:
    """Mistakes that values make with each other."""
    for planned in plan.variants:
        where = f"{study.path.name}: variant '{planned.variant.name}'"
        yield from _tried(files, where, planned.changes)
        for run in study.source.run:
            yield from _tried(files, f"{where}, event '{run.event}'", {**planned.changes, **run.set})
        yield from _events(study, files, planned, where)
        if study.is_builtin:
            yield from _bodies(files, planned, where)


def _events(study: Study, files: BaseFiles, planned: Planned, where: str) -> Iterator[Problem]:
    """Refusals of events that the case of a variant does not have, or whose history no source can make."""
    changed = files.changed_case(planned.changes)
    if changed is None:
        return
    events = {event.name: event for event in changed.case.mission.event}
    named = [("source.run", run.event) for run in study.source.run]
    named += [("source.events", event) for event in study.source.events]
    for key, name in named:
        place = f"{study.path.name}: {key}"
        if name not in events:
            near = difflib.get_close_matches(name, events, n=1)
            remedy = f"Write {near[0]!r}" if near else f"Name one of {', '.join(map(repr, events))}"
            yield Problem("unknown_event", place, f"{changed.case.path.name} has no event {name!r}", remedy)
        elif events[name].history is None:
            what = f"event {name!r} is a static load case, which has no history"
            yield Problem("contradiction", place, what, "Remove it")
    if study.source.command is not None:
        yield from _out_of_reach(changed.case, [name for _, name in named] or list(events), where)
    with_history = [name for name, event in events.items() if event.history is not None]
    if study.is_builtin and not named and len(with_history) != 1:
        what = (
            f"{changed.case.path.name} has {len(with_history)} events with a history, and nothing says which of them "
        )
        what += "a ride is"
        remedy = "Give [[source.run]] with the event and what it sets, or events under [source]"
        yield Problem("ambiguous_event", f"{where}: source", what, remedy)


def _bodies(files: BaseFiles, planned: Planned, where: str) -> Iterator[Problem]:
    """Refusals of a case that is not of the body that rides."""
    vehicle, changed = files.changed_vehicle(planned.changes), files.changed_case(planned.changes)
    if vehicle is not None and changed is not None:
        yield from body_problems(vehicle, changed.case, where)


def _out_of_reach(case: Case, names: Collection[str], where: str) -> Iterator[Problem]:
    """Refusals of files that a command would have to leave outside the folder of its run."""
    for event in case.mission.event:
        for name in files_of_event(event) if event.name in names else ():
            if Path(name).is_absolute() or ".." in Path(name).parts:
                what = f"event {event.name!r} has {name}, which a command in the folder of its run cannot leave there"
                remedy = (
                    f"Name it {Path(name).name} in {case.path.name}, or name the events it makes under [source] events"
                )
                yield Problem("contradiction", f"{where}: source.command", what, remedy)


def _unknown_kind(study: Study, where: str, key: str) -> Iterator[Problem]:
    """Refusal of a key that belongs to nothing the study has."""
    if key == SEED:
        yield Problem("contradiction", where, f"{key!r} is what seeds are for", "Give a list of seeds")
    elif key.startswith(VEHICLE):
        if study.base.vehicle is None:
            yield Problem("unknown_key", where, f"{key!r} is of a vehicle, and the study has none", "Give base.vehicle")
    elif key.startswith(CASE) or key == "case":
        if study.base.case is None:
            yield Problem("unknown_key", where, f"{key!r} is of a case, and the study has none", "Give base.case")
    elif not key.startswith(OWN) or not key.removeprefix(OWN).isidentifier():
        yield Problem("unknown_key", where, f"{key!r} is no key that can be varied", f"Write {PREFIXES}")
    elif study.is_builtin:
        what = f"{key!r} is known to a source of your own only, and histories are rides of the vehicle"
        yield Problem("unknown_key", where, what, "Write vehicle.<table>.<key> or case.<table>.<key>")


def _tried(files: BaseFiles, where: str, changes: Mapping[str, Any]) -> Iterator[Problem]:
    """What vehicle and case say of changes."""
    study = files.study
    tries = []
    if any(key.startswith(VEHICLE) for key in changes) and study.base.vehicle is not None:
        tries.append(files.changed_vehicle)
    if any(key.startswith(CASE) or key == "case" for key in changes) and study.base.case is not None:
        tries.append(files.changed_case)  # type: ignore[arg-type]
    for attempt in tries:
        try:
            attempt(changes)
        except FatigueError as error:
            for problem in error.problems:
                yield Problem(problem.code, where, f"{problem.where}: {problem.what}", problem.remedy)


def _unique(problems: Iterable[Problem]) -> Iterator[Problem]:
    """Problems without those that were said before, wherever they stand."""
    seen: set[tuple[str, str]] = set()
    for problem in problems:
        if (problem.code, problem.what) not in seen:
            seen.add((problem.code, problem.what))
            yield problem
