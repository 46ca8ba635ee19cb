"""What a study would run: every run with what it sets, without running it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fatigue.shown import shortened, visible
from fatigue.study.study_file import Study
from fatigue.study.variants.runs.planned_runs import PlannedRun
from fatigue.study.variants.runs.run import RECORD
from fatigue.study.variants.runs.simulation import RECORD as SIMULATED
from fatigue.study.variants.varied.names import shown


@dataclass(frozen=True, slots=True)
class DryRun:
    """The runs of a study as they are planned."""

    title: str
    runs: tuple[dict[str, Any], ...]

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return {"title": self.title, "runs": list(self.runs)}

    def as_text(self) -> str:
        """Text for people: a line for each run, and below each variant what it sets."""
        lines = [f"{visible(self.title)}: {len(self.runs)} runs"]
        before = None
        for run in self.runs:
            if run["variant"] != before:
                before = run["variant"]
                sets = ", ".join(f"{key} = {shown(value)}" for key, value in run["sets"].items())
                lines += ["", f"{visible(before)}: {visible(sets) or 'as the files have it'}"]
                lines += [
                    f"  event '{shortened(visible(event))}': {', '.join(f'{k} = {shown(v)}' for k, v in own.items())}"
                    for event, own in run["events"].items()
                ]
            there = "; a run is there, and is made anew if anything it depends on has changed" if run["there"] else ""
            lines.append(f"  seed {run['seed']}: {visible(run['folder'])}{there}")
        return "\n".join(lines)


def dry_run(study: Study, runs: Sequence[PlannedRun]) -> DryRun:
    """The planned runs of a study."""
    return DryRun(study.title, tuple(_listed(study, run) for run in runs))


def _listed(study: Study, run: PlannedRun) -> dict[str, Any]:
    records = [run.folder / RECORD] if run.case is not None else [folder / SIMULATED for folder in run.asked]
    return {
        "variant": run.variant,
        "seed": run.seed,
        "folder": str(run.folder),
        "settings": dict(run.planned.variant.settings),
        "sets": dict(run.planned.changes),
        "events": {one.event: dict(one.set) for one in study.source.run},
        "there": all(path.is_file() for path in records),
    }
