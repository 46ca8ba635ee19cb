"""Runs of a study as they are planned: which histories each needs, what makes them, and where everything will be."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from fatigue.case import Case
from fatigue.study.study_file import Study, short_name
from fatigue.study.variants.runs.case_of_run import files_of_event
from fatigue.study.variants.source.made import NO_EVENT, Asked
from fatigue.study.variants.varied.base_files import BaseFiles, ChangedCase
from fatigue.study.variants.varied.expansion import Plan, Planned
from fatigue.study.variants.varied.names import folder_names

RUNS, SIMULATION = "runs", "simulation"


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """One variant under one seed: its case, its folder, and what is asked of the source with the folder of each."""

    planned: Planned
    seed: int
    case: ChangedCase | None
    folder: Path
    asked: Mapping[Path, Asked]

    @property
    def variant(self) -> str:
        """Name of its variant."""
        return self.planned.variant.name

    @property
    def place(self) -> str:
        """The run in words."""
        return f"variant '{self.variant}', seed {self.seed}"


def planned_runs(study: Study, files: BaseFiles, plan: Plan, folder: Path) -> list[PlannedRun]:
    """Every run of a study, variant after variant, under all seeds."""
    runs = []
    for planned in plan.variants:
        case = files.changed_case(planned.changes)
        for seed in study.seeds:
            place = folder / RUNS / planned.folder / f"seed_{seed}"
            runs.append(PlannedRun(planned, seed, case, place, _asked(study, planned, seed, case, place)))
    return runs


def events_of(study: Study, case: Case) -> list[str]:
    """Events of a case that get their histories from the source."""
    named = [run.event for run in study.source.run] or list(study.source.events)
    return named or [event.name for event in case.mission.event if event.history is not None]


def has_source(study: Study) -> bool:
    """Whether histories come from a source, and not from where the case says."""
    return study.is_builtin or study.source.command is not None or study.source.files is not None


def _asked(study: Study, planned: Planned, seed: int, case: ChangedCase | None, folder: Path) -> Mapping[Path, Asked]:
    """What is asked of the source for a run: once, or for each event that has a run of its own."""
    if not has_source(study):
        return {}
    name, settings = planned.variant.name, planned.variant.settings
    files = {} if case is None else _files(case.case, events_of(study, case.case))
    if not study.source.run:
        return {folder / SIMULATION: Asked(name, seed, NO_EVENT, files, planned.changes, settings)}
    asked = {}
    places = folder_names([run.event for run in study.source.run])
    for run, place in zip(study.source.run, places, strict=True):
        changes = {**planned.changes, **run.set}
        own = {**settings, **{short_name(key): value for key, value in run.set.items()}}
        of_event = {run.event: files[run.event]} if files else {}
        asked[folder / SIMULATION / place] = Asked(name, seed, run.event, of_event, changes, own)
    return asked


def _files(case: Case, names: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Files of some events by their names."""
    return {event.name: files_of_event(event) for event in case.mission.event if event.name in names}
