"""The folder of an analysis graph: its tables, page and record, in place of those before and of nothing else."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fatigue.files.hashes import sha256
from fatigue.files.recorded import Filled
from fatigue.results.dictionary.graph import GRAPH
from fatigue.results.plain_tables import fill, table_files
from fatigue.study.graph.asked import Asked
from fatigue.study.graph.page import PAGE, graph_page
from fatigue.study.graph.summary import Graph
from fatigue.study.graph.vehicle_graph import critical_rows, root_rows, stability_rows

RECORD = "graph.json"
FILLED = Filled("fatigue study graph", "graph", RECORD, (*table_files(tuple(GRAPH)), PAGE))


def write_graph(folder: Path, found: Graph, asked: Asked, inputs: Sequence[Path], *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    said = {
        "inputs": [{"file": path.name, "sha256": sha256(path)} for path in inputs],
        "asked": {"speeds_km_h": asked.speeds.tolist(), "conicities": asked.conicities.tolist()},
        **{key: value for key, value in found.as_record().items() if key != "written"},
    }
    tables = {name: (GRAPH[name], rows) for name, rows in tables_of(found).items()}
    return fill(folder, FILLED, tables, {PAGE: graph_page(found)}, said, csv=csv)


def tables_of(found: Graph) -> dict[str, list[Any]]:
    """Rows of every table."""
    return {
        "critical": [row for of in found.vehicles for row in critical_rows(of)],
        "roots": [row for of in found.vehicles for row in root_rows(of)],
        "stability": [row for of in found.vehicles for row in stability_rows(of)],
    }
