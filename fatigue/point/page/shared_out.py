"""Whose the damage of one point is: the diagnosis of ``fatigue.diagnose`` for a point that it may not have chosen.

Bands, bins of the track and the assumed damping are those of the diagnosis in the folder, where there is one, so that
the numbers of a point that it has are the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body
from fatigue.report.of_record import Record
from fatigue.report.sections.formation.read import ShownFormation
from fatigue.report.sections.why import TABLES as WHY
from fatigue.report.sections.why import Why
from fatigue.results import DIAGNOSED, read_rows, read_table, refuse_mixed, rows_of_welds, table_writer
from fatigue.results.dictionary.resonance import FORMED
from fatigue.results.tables import table_path
from fatigue.spectrum.bands import third_octaves
from fatigue.why.across_events import attribute_loops
from fatigue.why.attribute import BIN_KM, Attribution, Bins, attribute_event
from fatigue.why.evidence import Evidence
from fatigue.why.formation.damping import damping_of
from fatigue.why.formation.formation import formation
from fatigue.why.formation.watch import WORTH_COUNTING
from fatigue.why.levers import best_levers
from fatigue.why.points import Points
from fatigue.why.rows import rows_of_tables
from fatigue.why.verdicts import event_verdicts

KEY = ("part", "order", "surface")


@dataclass(frozen=True, slots=True, eq=False)
class Settings:
    """How a diagnosis sorts the damage: its bins, and the damping ratio of modes without one, None: they have none."""

    bins: Bins
    damping: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Diagnosed:
    """What the diagnosis in a folder says of a point; no rows where it has not chosen it."""

    attribution: pd.DataFrame
    settings: Settings


AS_USUAL = Settings(Bins(third_octaves(), BIN_KM), None)


def diagnosed(folder: Path, record: Record, weld: str, key: tuple[int, int, str]) -> Diagnosed | None:
    """What the diagnosis in a folder has of a point, by part, order and surface; None where there is no diagnosis.

    Raises
    ------
    DataError : a table is damaged or of another result
    """
    if not all(table_path(folder, name).is_file() for name in DIAGNOSED):
        return None
    refuse_mixed(folder, record, DIAGNOSED, read=("attribution", "track"))
    own, track = (_rows_of(folder, name, weld) for name in ("attribution", "track"))
    damping = (record.get("diagnosis") or {}).get("assumed_damping_ratio")
    is_point = np.logical_and.reduce([(own[name] == value).to_numpy() for name, value in zip(KEY, key, strict=True)])
    return Diagnosed(own[is_point], Settings(Bins(_edges_hz(own), _bin_km(track)), damping))


def share_out(
    body: Body, points: Points, loads: Sequence[EventLoad], plan: Plan, assessed: Sequence[pd.DataFrame], how: Settings
) -> Evidence:
    """The damage of the only one of the ``points``, shared out and judged.

    ``assessed`` has its row of ``damage.parquet`` for each event.
    """
    modes = replace(body.modes, damping_ratio=damping_of(body.modes, how.damping).ratio)
    events = [attribute_event(points, load, one, modes, how.bins) for load, one in zip(loads, plan.passes, strict=True)]
    attribution = Attribution(points, (*events, *attribute_loops(points, loads, plan)))
    governing, only = int(attribution.event_share[0, : len(events)].argmax()), np.zeros(1, dtype=np.int64)
    verdicts = tuple(
        event_verdicts(body, load, points, event, said, only if number == governing else only[:0])
        for number, (load, event, said) in enumerate(zip(loads, events, assessed, strict=True))
    )
    damaged = only[attribution.damage > 0.0]
    levers = best_levers(attribution, loads, plan, damaged)
    formed = formation(body, attribution, loads, plan, damaged, how.damping)
    return Evidence(body, plan, attribution, levers, verdicts, formed)


def tables_of(evidence: Evidence, scratch: Path) -> Why:
    """The tables of a diagnosis for its only point, written to a folder and read as the report reads them."""
    for name, blocks in rows_of_tables(evidence).items():
        with table_writer(scratch, name) as table:
            for rows in blocks:
                table.write(rows)
    found = {name: read_table(scratch, name).to_pandas() for name in (*WHY, *FORMED)}
    watch = found["watch"].sort_values("rank", kind="stable")
    formed = ShownFormation(found["resonance"], found["weld_resonance"], watch, WORTH_COUNTING)
    return Why(found["attribution"], found["track"], found["diagnosis"], found["levers"], formed)


def _rows_of(folder: Path, table: str, weld: str) -> pd.DataFrame:
    return read_rows(folder, table, rows_of_welds(folder, table, [weld])[weld]).to_pandas()


def _edges_hz(attribution: pd.DataFrame) -> NDArray[np.float64]:
    """Edges between the frequency bands of a diagnosis; the usual ones where no event has bands."""
    low = attribution.loc[attribution["kind"] == "band", "low_hz"]
    edges = np.unique(low[low > 0.0].to_numpy())
    return edges if edges.size else third_octaves()


def _bin_km(track: pd.DataFrame) -> float:
    """Length of a bin of the track [km]: where the second one begins; as long as the longest event where none does."""
    second, end = track.loc[track["start_km"] > 0.0, "start_km"], track["end_km"].max()
    return float(second.min()) if len(second) else BIN_KM if np.isnan(end) else float(end)
