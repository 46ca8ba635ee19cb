"""The folder of the readings of gauges: tables, page and record, in place of those before and of nothing else."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path

from fatigue.files.recorded import Filled
from fatigue.gauges.histories.counts import Counted, GaugeSpectra
from fatigue.gauges.histories.page import PAGE, histories_page
from fatigue.gauges.histories.summary import Histories
from fatigue.gauges.histories.tables import history_table, row_table, spectrum_table
from fatigue.gauges.rows import GaugeRows
from fatigue.gauges.simulated import Reading
from fatigue.pipeline.solve.body import Body
from fatigue.results.dictionary.decided.gauges import GAUGE_TABLES, histories_columns
from fatigue.results.plain_tables import fill, table_files

RECORD = "gauges.json"
FILLED = Filled("fatigue gauges histories", "gauges", RECORD, (*table_files(tuple(GAUGE_TABLES)), PAGE))


def write_histories(
    folder: Path,
    found: Histories,
    body: Body,
    rows: GaugeRows,
    readings: Sequence[Reading],
    counts: Sequence[Counted],
    spectra: Sequence[GaugeSpectra],
    inputs: Mapping[str, str],
    *,
    csv: bool,
) -> Histories:
    """Write tables, page and record; returns what was found, with the names of the files.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every
    file, ``inputs`` by their names.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    said = {
        "title": found.title,
        "gauges": found.table,
        "events": [reading.event for reading in readings],
        "exponent": found.exponent,
        "exponent_source": found.exponent_source,
        "inputs": dict(inputs),
        "said": found.said(),
        "warnings": [asdict(problem) for problem in found.warnings],
    }
    whole = len(readings) == len(body.case.mission.event)
    tables = {
        "gauges": (GAUGE_TABLES["gauges"], found.gauges),
        "gauge_events": (GAUGE_TABLES["gauge_events"], found.events),
        "gauge_spectrum": (GAUGE_TABLES["gauge_spectrum"], spectrum_table(rows.names, counts, spectra, whole=whole)),
        "gauge_rows": (GAUGE_TABLES["gauge_rows"], row_table(body, rows)),
        "histories": (histories_columns(rows.names), history_table(rows.names, readings)),
    }
    pages = {PAGE: histories_page(found, body, readings, spectra)}
    written = fill(folder, FILLED, tables, pages, said, csv=csv)
    return replace(found, written=tuple(str(folder / name) for name in written))
