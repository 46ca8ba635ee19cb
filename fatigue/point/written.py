"""The history of any point of a finished result as a file, as a story: the point, its inputs, event after event.

The stress is recovered from the inputs, which may not have changed, at the instants that were counted: of a record that
was upsampled all of them. Some samples are in memory at a time, whatever the length of the records.
"""

import logging
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.files.whole import replacing, staged
from fatigue.point.formats import EXCEL_ROWS, FORMATS, MOST_IN_MAT, Write, history_schema
from fatigue.point.found import Station, find_station
from fatigue.point.history import (
    EventHistory,
    Instants,
    Piece,
    columns_of,
    event_histories,
    piece_columns,
    reads_vertices,
    refuse_unknown_instants,
)
from fatigue.point.in_the_way import in_the_way
from fatigue.point.reopened import Reopened, event_numbers, reopened
from fatigue.point.summary import EventExtent, WrittenHistory
from fatigue.results import ASSESSED, coded, finished_result
from fatigue.stages import stage

Floats = NDArray[np.float64]

log = logging.getLogger(__name__)


def write_history(
    folder: Path | str,
    weld: str,
    output: Path | str,
    *,
    order: int | None = None,
    node: int | None = None,
    part: int | None = None,
    event: str | None = None,
    instants: Instants = "counted",
    case_file: Path | str | None = None,
    force: bool = False,
    no_lock: bool = False,
) -> WrittenHistory:
    """Write the stress history of a station of a weld to a file: membrane, bending, shears, both faces, event by event.

    Parameters
    ----------
    folder : result of an assessment
    weld : its name
    output : file to write, ``.csv``, ``.parquet`` or ``.mat``
    order, node, part : where along the weld; with neither order nor node at its worst point
    event : one event; by default all, one above the other
    instants : ``counted``, or the samples of the ``file`` where the record was upsampled
    case_file : the case it was made from; by default where the provenance of the result says
    force : overwrite a file that is there already
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    DataError : no finished result, no such point or event, changed inputs, a file in the way
    CaseError : arguments that make no sense
    """
    folder, output = given_path(folder, "folder"), given_path(output, "output")
    named = None if case_file is None else given_path(case_file, "case_file")
    refuse_unknown_instants(instants)
    write = format_of(output)
    stage("reading the result and its case")
    record = finished_result(folder, ASSESSED, ("nodes", "welds"), no_lock=no_lock)
    station = find_station(folder, weld, order=order, node=node, part=part)
    refuse(DataError, in_the_way(output, folder, record, named, force=force))
    limited = threadpool_limits(limits=1, user_api="blas")  # as the assessment does: the same bits
    with limited, staged(output.absolute().parent, ".fatigue-history-") as scratch:
        inputs = reopened(folder, record, scratch, named)
        samples = _samples(inputs, event, instants)
        _refuse_large_mat(output, samples)
        warnings = _excel_warnings(output, samples)
        for problem in warnings:
            log.warning("%s", problem)
        stage("writing the history")
        extents: list[EventExtent] = []
        at_vertices = reads_vertices(inputs, instants)
        schema = history_schema(columns_of(at_vertices=at_vertices))
        tables = _tables(event_histories(inputs, station, event, instants=instants), schema, extents)
        with replacing(output) as unfinished:
            write(unfinished, schema, tables, lambda: _said(inputs, station, instants, extents))
    return WrittenHistory(
        title=str(record["title"]),
        file=output,
        station=station,
        instants=instants,
        columns=tuple(schema.names),
        events=tuple(extents),
        warnings=tuple(warnings),
    )


def format_of(output: Path) -> Write:
    """Writer of a file by the ending of its name.

    Raises
    ------
    CaseError : a history is not written in this format
    """
    ending = output.suffix.lower()
    if ending in FORMATS:
        return FORMATS[ending]
    what = f"a history is not written as '{ending}'" if ending else "the name of the file has no ending"
    remedy = "End it in .csv, .parquet or .mat"
    if ending in (".xlsx", ".xls", ".txt", ".tsv"):
        remedy = "End it in .csv, which Excel opens, or in .parquet or .mat"
    raise CaseError(Problem("unknown_format", str(output), what, remedy))


def _samples(inputs: Reopened, event: str | None, instants: Instants) -> int:
    """Samples of the history, so far as the record of the result tells."""
    of_events = inputs.record["mission"]["events"]
    numbers = event_numbers(inputs, event)
    return sum(of_events[i]["samples"] * (inputs.factors[i] if instants == "counted" else 1) for i in numbers)


def _refuse_large_mat(output: Path, samples: int) -> None:
    """Refuse more samples than are held in memory for a MAT file."""
    if output.suffix.lower() == ".mat" and samples > MOST_IN_MAT:
        what = f"would have {samples} samples, and {MOST_IN_MAT} at most go into a MAT file"
        remedy = "Write .parquet, which MATLAB reads with parquetread, or one event with --event"
        raise DataError(Problem("too_many_samples", str(output), what, remedy))


def _excel_warnings(output: Path, samples: int) -> list[Problem]:
    """Warning about more rows than Excel opens."""
    if output.suffix.lower() != ".csv" or samples <= EXCEL_ROWS:
        return []
    what = f"has {samples} rows, and Excel opens the first {EXCEL_ROWS} of them"
    remedy = "Write one event with --event, the samples of the file with --instants file, or .parquet"
    return [Problem("excel_rows", str(output), what, remedy)]


def _tables(histories: Iterator[EventHistory], schema: pa.Schema, extents: list[EventExtent]) -> Iterator[pa.Table]:
    """Tables of all pieces, one after the other; ``extents`` are filled on the way."""
    at_vertices = "counted_top_MPa" in schema.names
    for history in histories:
        low, high, last = np.full(2, np.inf), np.full(2, -np.inf), np.nan
        for piece in history.pieces():
            low, high = np.minimum(low, piece.counted.min(axis=1)), np.maximum(high, piece.counted.max(axis=1))
            last = float(piece.time[-1])
            yield _table(history, piece, schema, at_vertices=at_vertices)
        extents.append(_extent(history, low, high, last))


def _table(history: EventHistory, piece: Piece, schema: pa.Schema, *, at_vertices: bool) -> pa.Table:
    event = coded(np.zeros(len(piece.time), dtype=np.int32), [history.event]).cast(pa.string())
    columns = piece_columns(history, piece, at_vertices=at_vertices)
    return pa.table([event, *columns.values()], schema=schema)


def _extent(history: EventHistory, low: Floats, high: Floats, last: float) -> EventExtent:
    load, (membrane, bending, *_) = history.load, history.constant.tolist()
    return EventExtent(
        event=history.event,
        is_static=history.is_static,
        samples=history.samples,
        step_s=history.step,
        start_s=load.counted.start,
        end_s=last,
        upsample=load.upsample // history.every,
        residue=load.residue,
        stress_factor=load.stress_factor,
        constant_top_MPa=membrane + bending,
        constant_bottom_MPa=membrane - bending,
        min_top_MPa=float(low[0]),
        max_top_MPa=float(high[0]),
        range_top_MPa=float(high[0] - low[0]),
        min_bottom_MPa=float(low[1]),
        max_bottom_MPa=float(high[1]),
        range_bottom_MPa=float(high[1] - low[1]),
    )


def _said(inputs: Reopened, station: Station, instants: Instants, extents: list[EventExtent]) -> Mapping[str, Any]:
    """What a file says of its history beside the columns."""
    return {
        "title": str(inputs.record["title"]),
        "result": str(inputs.record.get("result", "")),
        "weld": station.weld,
        "part": station.part,
        "order": station.order,
        "node": station.node,
        "instants": instants,
        "reversals": str(inputs.record["rules"].get("reversals", "samples")),
        "included": "stress factor of the event, constants of unit loads, removed means; weld ends treated",
        "events": [asdict(extent) for extent in extents],
    }
