"""The folder of a correlation: its tables, its page and its record, in place of those before and of nothing else."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from fatigue.files.recorded import Filled
from fatigue.gauges.correlated.page.page import PAGE, correlation_page
from fatigue.gauges.correlated.summary import Correlation
from fatigue.gauges.correlated.tables import tables_of
from fatigue.results.dictionary.decided.correlation import CORRELATED
from fatigue.results.plain_tables import fill, table_files

RECORD = "correlation.json"
FILLED = Filled("fatigue gauges correlate", "correlation", RECORD, (*table_files(tuple(CORRELATED)), PAGE))


def write_correlation(folder: Path, found: Correlation, inputs: Mapping[str, str], *, csv: bool) -> list[str]:
    """Write tables, page and record, which has ``inputs`` by their SHA-256; returns their names.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    said = {
        "title": found.title,
        "inputs": dict(inputs),
        **found.settings(),
        "case_line": asdict(found.line),
        "verdicts": {one.channel.name: one.verdict for one in found.comparisons},
        "warnings": [asdict(problem) for problem in found.warnings],
    }
    return fill(folder, FILLED, tables_of(found), {PAGE: correlation_page(found)}, said, csv=csv)
