"""The folder of a reduced body: its tables, its first case and its record, in place of those before and no others."""

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from fatigue import __version__
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.recorded import Filled, put_in_place
from fatigue.files.whole import staged
from fatigue.reduce.case_text import CASE
from fatigue.reduce.tables import ELEMENTS, FLEXIBILITY, FORCES, MODES, NODES, OBSERVED_SHAPES, POINTS, SHAPES
from fatigue.results import write_json

RECORD = "reduce.json"
OF_WELDS = tuple(f"{name}{ending}" for name in ("welds", "weld_nodes") for ending in (".csv", ".parquet"))
FILLED = Filled(
    "fatigue reduce",
    "reduced body",
    RECORD,
    (MODES, POINTS, SHAPES, OBSERVED_SHAPES, FLEXIBILITY, FORCES, NODES, ELEMENTS, *OF_WELDS, CASE),
)
EDITABLE = (CASE,)

Content: TypeAlias = pa.Table | str | Path


def edited_case(folder: Path) -> bool:
    """Whether the case that an earlier run wrote was edited since: it then stays as it is."""
    known = (FILLED.outputs(folder) or {}).get(CASE)
    path = folder / CASE
    return known is not None and path.is_file() and sha256(path) != known


def write_folder(
    folder: Path, files: Mapping[str, Content], record: Mapping[str, Any], *, keep_case: bool
) -> tuple[str, ...]:
    """Write tables (by suffix), texts and copies of files, and the record; returns their names.

    What an earlier run wrote and this one does not is removed, but for a case that is kept. The record has the SHA-256
    of every file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    kept = (CASE,) if keep_case else ()
    written = {name: content for name, content in files.items() if name not in kept}
    before = FILLED.outputs(folder) or {}
    with staged(folder, ".reduce-") as stage:
        for name, content in written.items():
            with refused_writing(folder / name):
                _write(stage / name, content)
        outputs = {path.name: sha256(path) for path in sorted(stage.iterdir())}
        recorded = outputs | {name: before[name] for name in kept}
        write_json(stage / RECORD, {"program": FILLED.program, "version": __version__, **record, "outputs": recorded})
        put_in_place(stage, folder, FILLED, outputs, kept)
    return (*sorted(recorded), RECORD)


def _write(path: Path, content: Content) -> None:
    if isinstance(content, Path):
        shutil.copyfile(content, path)
    elif isinstance(content, str):
        path.write_text(content, "utf-8", newline="\n")
    elif path.suffix == ".csv":
        pa_csv.write_csv(content, path, pa_csv.WriteOptions(quoting_style="needed"))
    else:
        pq.write_table(content, path, compression="zstd", write_page_checksum=True)
