"""The folder of an analysis graph: its tables, page and record, in place of those before and of nothing else."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fatigue import __version__
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.recorded import Filled, put_in_place
from fatigue.files.whole import staged
from fatigue.results import write_json
from fatigue.results.dictionary.graph import GRAPH
from fatigue.results.plain_tables import write_csv, write_table
from fatigue.study.graph.asked import Asked
from fatigue.study.graph.page import PAGE, graph_page
from fatigue.study.graph.summary import Graph
from fatigue.study.graph.vehicle_graph import critical_rows, root_rows, stability_rows

RECORD = "graph.json"
TABLE_FILES = tuple(f"{name}.{kind}" for name in GRAPH for kind in ("parquet", "csv"))
FILLED = Filled("fatigue study graph", "graph", RECORD, (*TABLE_FILES, PAGE))


def write_graph(folder: Path, found: Graph, asked: Asked, inputs: Sequence[Path], *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    What an earlier run wrote and this one does not is removed. The record has the SHA-256 of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    with staged(folder, ".graph-") as stage:
        for name, rows in tables_of(found).items():
            write_table(stage, name, GRAPH[name], rows)
            if csv:
                write_csv(stage, name, GRAPH[name], rows)
        page = stage / PAGE
        with refused_writing(page):
            page.write_text(graph_page(found), encoding="utf-8", errors="backslashreplace", newline="\n")
        outputs = {path.name: sha256(path) for path in sorted(stage.iterdir())}
        record = {
            "program": FILLED.program,
            "version": __version__,
            "inputs": [{"file": path.name, "sha256": sha256(path)} for path in inputs],
            "outputs": outputs,
            "asked": {"speeds_km_h": asked.speeds.tolist(), "conicities": asked.conicities.tolist()},
            **{key: value for key, value in found.as_record().items() if key != "written"},
        }
        write_json(stage / RECORD, record)
        put_in_place(stage, folder, FILLED, outputs)
    return [*outputs, RECORD]


def tables_of(found: Graph) -> dict[str, list[Any]]:
    """Rows of every table."""
    return {
        "critical": [row for of in found.vehicles for row in critical_rows(of)],
        "roots": [row for of in found.vehicles for row in root_rows(of)],
        "stability": [row for of in found.vehicles for row in stability_rows(of)],
    }
