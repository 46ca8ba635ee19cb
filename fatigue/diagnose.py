"""The diagnosis as a story: a finished result, its records once more, and what makes the damage, where and when."""

import logging
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.attribute import Attribution, EventAttribution, Points, attribute_event, points_of
from fatigue.body import Body, read_body
from fatigue.case import Case, load_case
from fatigue.checkpoint import locked
from fatigue.diagnosis_summary import Diagnosis, findings
from fatigue.diagnosis_tables import ATTRIBUTION, LEVERS, TRACK, attribution_rows, lever_rows, track_rows
from fatigue.errors import DataError, Problem, refuse
from fatigue.events import event_loads, mission_plan
from fatigue.levers import best_levers
from fatigue.life.mission import Plan
from fatigue.model import solve_welds, weld_groups
from fatigue.results import _ARROW_TYPE, Column, read_provenance, read_table, sha256
from fatigue.spectrum.bands import third_octaves

log = logging.getLogger(__name__)

Progress = Callable[[str, int, int], None]

MOST_SAMPLES = 100_000_000  # stress samples up to which all points are worth a minute
SHARE_OF_LIMIT = 0.1  # utilisation from which a point is shared out when not all points are
BIN_KM = 0.1
_STAGING = ".fatigue-diagnosis"


def diagnose(
    folder: Path,
    *,
    case_file: Path | None = None,
    share_of_limit: float = SHARE_OF_LIMIT,
    edges_hz: Sequence[float] | None = None,
    bin_km: float = BIN_KM,
    progress: Progress = lambda label, done, total: None,
) -> Diagnosis:
    """Say what makes the damage of a finished result, and write the tables that show it into its folder.

    Parameters
    ----------
    folder : result of an assessment
    case_file : the case it was made from; by default where the provenance of the result says
    share_of_limit : utilisation from which a point is included when there are too many for all of them
    edges_hz : ascending edges between frequency bands [Hz]; by default one-third octaves from 1 to 80 Hz
    bin_km : length of a bin of the track [km]
    progress : called with a label, events done and events in all

    Raises
    ------
    DataError : no finished result in the folder, or its inputs are gone or have changed
    """
    body = _same_body(folder, case_file)
    plan, _ = mission_plan(body)
    edges = third_octaves() if edges_hz is None else np.asarray(edges_hz, dtype=np.float64)
    with locked(folder), threadpool_limits(limits=1, user_api="blas"):
        chosen, worst, which = choose_points(folder, body, plan, share_of_limit)
        points = gather_points(folder, body, chosen)
        loads = event_loads(body)
        log.info("diagnosing %s", which)
        events: list[EventAttribution] = []
        for load, one_pass in zip(loads, plan.passes, strict=True):
            progress("diagnosis", len(events), len(loads))
            events.append(attribute_event(points, load, one_pass, body.modes, edges, bin_km))
        progress("diagnosis", len(loads), len(loads))
        attribution = Attribution(points, tuple(events))
        levers = best_levers(attribution, loads, plan, worst[attribution.damage[worst] > 0.0])
        _write(
            folder,
            {
                "attribution": (ATTRIBUTION, [attribution_rows(body.modes, attribution, event) for event in events]),
                "track": (TRACK, [track_rows(points, event) for event in events]),
                "levers": (LEVERS, [lever_rows(body.modes, plan, attribution, levers)]),
            },
        )
    return findings(body, plan, attribution, levers, which)


def choose_points(
    folder: Path, body: Body, plan: Plan, share_of_limit: float
) -> tuple[NDArray[np.object_], NDArray[np.int64], str]:
    """Choose all points if that is affordable, else the worst of every weld and those above a share of the limit.

    Returns for every row of ``nodes.parquet`` why it is chosen, empty if it is not; where among the chosen rows the
    worst of every weld is; and the choice in words.
    """
    nodes = read_table(folder, "nodes", ["weld", "utilisation", "toe"]).to_pandas()
    utilisation = nodes["utilisation"].where(nodes["toe"], -1.0)  # a face without a toe never governs
    worst = np.sort(utilisation.groupby(nodes["weld"]).idxmax().to_numpy())

    upsample = body.case.counting.upsample
    samples = sum(one.samples for one in plan.passes) * (upsample if isinstance(upsample, int) else 1)
    if len(nodes) * samples <= MOST_SAMPLES:
        return np.full(len(nodes), "all", dtype=object), worst, f"all {len(nodes)} points"
    above = f"above {share_of_limit:g} of the limit"
    chosen = np.where(utilisation >= share_of_limit, above, "").astype(object)
    chosen[worst] = "worst of its weld"
    rows = np.flatnonzero(chosen)
    which = f"the worst point of every weld and those {above}, {len(rows)} of {len(nodes)}: all would take long"
    return chosen, np.searchsorted(rows, worst), which


def gather_points(folder: Path, body: Body, chosen: NDArray[np.object_]) -> Points:
    """Solve the welds group by group and keep the stress shapes of the chosen points only."""
    node = read_table(folder, "nodes", ["node"])["node"].to_numpy()
    pieces, first = [], 0
    for group in weld_groups(body):
        model = solve_welds(body, group)
        here = slice(first, first + 2 * len(model.stations))
        if not np.array_equal(node[here], np.repeat(model.stations.node, 2)):
            raise DataError(
                Problem("other_points", str(folder / "nodes.parquet"), "has other points than the case", "Assess again")
            )
        rows = np.flatnonzero(chosen[here])
        pieces.append(points_of(model, rows // 2, rows % 2, chosen[here][rows]))
        first = here.stop
    return Points(*(np.concatenate([getattr(piece, f.name) for piece in pieces]) for f in fields(Points)))


def _same_body(folder: Path, case_file: Path | None) -> Body:
    """Read the body of a result again and make sure that none of its files has changed since."""
    record = read_provenance(folder)
    path = case_file or folder / record["case_path"]
    if not path.is_file():
        raise DataError(
            Problem("no_case", str(path), "the case of this result is not there any more", "Give the case file")
        )
    case = load_case(path)
    refuse(DataError, _changed_inputs(case, record))
    return read_body(case, strict=False)


def _changed_inputs(case: Case, record: Mapping[str, Any]) -> list[Problem]:
    """Compare every input file with the hash the result recorded."""
    problems = []
    for given in record["inputs"]:
        path = case.path.parent / given["file"]
        if not path.is_file() or sha256(path) != given["sha256"]:
            what = "has changed since the assessment" if path.is_file() else "is not there any more"
            problems.append(Problem("changed_input", str(path), what, "Run the assessment again"))
    return problems


def _write(folder: Path, tables: Mapping[str, tuple[tuple[Column, ...], Sequence[Mapping[str, Any]]]]) -> None:
    """Write all tables beside the result first, then move them in, so that a broken run leaves no part of a table."""
    staging = folder / _STAGING
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir()
    try:
        for name, (columns, pieces) in tables.items():
            schema = pa.schema(
                [
                    pa.field(c.name, _ARROW_TYPE[c.type], metadata={"unit": c.unit, "description": c.meaning})
                    for c in columns
                ],
                metadata={"program": "fatigue", "table": name},
            )
            with pq.ParquetWriter(staging / f"{name}.parquet", schema, compression="zstd") as writer:
                for piece in pieces:
                    arrays = [pa.array(piece[f.name], type=f.type, from_pandas=True) for f in schema]
                    writer.write_table(pa.Table.from_arrays(arrays, schema=schema))
        for path in sorted(staging.iterdir()):
            with path.open("rb+") as file:
                os.fsync(file.fileno())
            path.replace(folder / path.name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
