"""Rows of two tables of a study: what every variant sets, and how every run ended."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fatigue.results.dictionary.column import Column
from fatigue.study.quantities import StudyRun
from fatigue.study.variants.varied.expansion import Plan
from fatigue.study.variants.varied.names import shown

Tables = Mapping[str, tuple[tuple[Column, ...], Sequence[Any]]]


@dataclass(frozen=True, slots=True)
class VariantRow:
    """One setting of one variant; fields are columns of ``variants.parquet``."""

    variant: str
    setting: str
    keys: str
    value: float | None
    text: str
    differs: bool


@dataclass(frozen=True, slots=True)
class RunRow:
    """One run; fields are columns of ``runs.parquet``."""

    variant: str
    seed: int
    folder: str
    state: str
    reason: str


def variant_rows(plan: Plan) -> Iterator[VariantRow]:
    """Every setting of every variant; a study that varies nothing has a row without one."""
    base = plan.variants[0].variant.settings
    keys = {aspect.name: ", ".join(sorted(aspect.keys)) for aspect in plan.aspects}
    for planned in plan.variants:
        variant = planned.variant
        if not variant.settings:
            yield VariantRow(variant.name, "", "", None, "", differs=False)
        for name, value in variant.settings.items():
            number = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
            yield VariantRow(variant.name, name, keys[name], number, shown(value), differs=value != base[name])


def run_rows(runs: Sequence[StudyRun], folder: Path) -> list[RunRow]:
    """Every run with the way to its folder."""
    return [RunRow(r.variant, r.seed, r.folder.relative_to(folder).as_posix(), r.state, r.reason) for r in runs]
