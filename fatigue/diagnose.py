"""The diagnosis as a story: a finished result, its records once more, and what makes the damage, where and when."""

import logging
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.attribute import Attribution, Points, attribute_event
from fatigue.case import Case, load_case
from fatigue.checkpoint import locked
from fatigue.diagnosis_summary import Diagnosis, findings
from fatigue.diagnosis_tables import ATTRIBUTION, LEVERS, TRACK, attribution_rows, lever_rows, track_rows
from fatigue.errors import DataError, Problem, refuse
from fatigue.events import event_load, mission_plan
from fatigue.levers import best_levers
from fatigue.life.mission import Plan
from fatigue.model import Model, read_model
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
    model, plan = _same_case(folder, case_file)
    edges = third_octaves() if edges_hz is None else np.asarray(edges_hz, dtype=np.float64)
    with locked(folder), threadpool_limits(limits=1, user_api="blas"):
        points, worst, which = choose_points(model, plan, folder, share_of_limit)
        log.info("diagnosing %s", which)
        events = []
        for event, one_pass in zip(model.case.mission.event, plan.passes, strict=True):
            progress("diagnosis", len(events), len(plan.passes))
            events.append(attribute_event(model, event_load(model, event), one_pass, points, edges, bin_km))
        progress("diagnosis", len(plan.passes), len(plan.passes))
        attribution = Attribution(points, tuple(events))
        levers = best_levers(model, plan, attribution, [i for i in worst if attribution.damage[i] > 0.0])
        _write(
            folder,
            {
                "attribution": (ATTRIBUTION, [attribution_rows(model, attribution, event) for event in events]),
                "track": (TRACK, [track_rows(model, points, event) for event in events]),
                "levers": (LEVERS, [lever_rows(model, plan, attribution, levers)]),
            },
        )
    return findings(model, plan, attribution, levers, which)


def choose_points(
    model: Model, plan: Plan, folder: Path, share_of_limit: float
) -> tuple[Points, NDArray[np.int64], str]:
    """Choose all points if that is affordable, else the worst of every weld and those above a share of the limit.

    Returns the points, where among them the worst of every weld is, and the choice in words.
    """
    stations = model.stations
    nodes = read_table(folder, "nodes", ["node", "utilisation", "toe"])
    if not np.array_equal(nodes["node"].to_numpy(), np.repeat(stations.node, 2)):
        raise DataError(
            Problem("other_points", str(folder / "nodes.parquet"), "has other points than the case", "Assess again")
        )
    utilisation = np.where(nodes["toe"].to_numpy(), nodes["utilisation"].to_numpy(), -1.0)  # no toe never governs
    weld = np.repeat(stations.weld, 2)
    worst = np.array([np.flatnonzero(weld == w)[utilisation[weld == w].argmax()] for w in range(len(model.welds))])

    upsample = model.case.counting.upsample
    samples = sum(one.samples for one in plan.passes) * (upsample if isinstance(upsample, int) else 1)
    if utilisation.size * samples <= MOST_SAMPLES:
        chosen = np.full(utilisation.size, "all", dtype=object)
        which = f"all {utilisation.size} points"
    else:
        above = f"above {share_of_limit:g} of the limit"
        chosen = np.where(utilisation >= share_of_limit, above, "").astype(object)
        chosen[worst] = "worst of its weld"
        which = (
            f"the worst point of every weld and the points {above}, {np.count_nonzero(chosen)} of {utilisation.size}: "
            "all of them would take long"
        )
    index = np.flatnonzero(chosen)
    return Points(index // 2, index % 2, chosen[index]), np.searchsorted(index, worst), which


def _same_case(folder: Path, case_file: Path | None) -> tuple[Model, Plan]:
    """Read the case of a result again and make sure that nothing in it has changed since."""
    record = read_provenance(folder)
    path = case_file or folder / record.get("case_path", record["case_file"])
    if not path.is_file():
        raise DataError(
            Problem("no_case", str(path), "the case of this result is not there any more", "Give the case file")
        )
    case = load_case(path)
    refuse(DataError, _changed_inputs(case, record))
    model = read_model(case, strict=False)
    return model, mission_plan(model)[0]


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
