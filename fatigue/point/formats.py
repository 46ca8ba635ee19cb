"""The table of a history as a file: CSV and Parquet as it comes, MAT for MATLAB once all of it is there."""

import base64
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
from scipy.io import savemat

from fatigue.results import Column
from fatigue.results.plain_tables import harmless

Said = Callable[[], Mapping[str, Any]]  # what is said of the table and, under "events", of each event, once it is known
Write = Callable[[Path, pa.Schema, Iterator[pa.Table], Said], None]

MOST_IN_MAT = 5_000_000  # samples: 0.4 GB of memory
EXCEL_ROWS = 1_048_575  # below the line of names

_TYPES = {"text": pa.string(), "float": pa.float64()}


def history_schema(columns: tuple[Column, ...]) -> pa.Schema:
    """Arrow schema of the table, with unit and meaning of each column in its field."""
    return pa.schema(
        [pa.field(c.name, _TYPES[c.type], metadata={"unit": c.unit, "description": c.meaning}) for c in columns],
        metadata={"program": "fatigue", "table": "history"},
    )


def write_csv(path: Path, schema: pa.Schema, tables: Iterator[pa.Table], said: Said) -> None:
    """A line of names and one for each sample, UTF-8 with decimal points; each number with all its digits."""
    with pa_csv.CSVWriter(path, schema, write_options=pa_csv.WriteOptions(quoting_style="needed")) as file:
        for table in tables:
            file.write_table(harmless(table))


def write_parquet(path: Path, schema: pa.Schema, tables: Iterator[pa.Table], said: Said) -> None:
    """Parquet as MATLAB and pandas read it; what is said of the table is in the metadata of the file."""
    with pq.ParquetWriter(path, schema, compression="snappy", use_dictionary=["event"], store_schema=False) as file:
        for table in tables:
            file.write_table(table)
        words = {key: value if isinstance(value, str) else json.dumps(value) for key, value in said().items()}
        whole = schema.with_metadata({**schema.metadata, **words})  # what readers take the metadata from
        file.add_key_value_metadata({**whole.metadata, "ARROW:schema": base64.b64encode(whole.serialize())})


def write_mat(path: Path, schema: pa.Schema, tables: Iterator[pa.Table], said: Said) -> None:
    """MATLAB 5: ``history``, a struct array with an element for each event, and ``point``, ``units`` and ``meaning``.

    An element has what is said of its event and the columns of the table (t, 1).
    """
    columns = [name for name in schema.names if name != "event"]
    pieces: dict[str, list[pa.Table]] = {}
    for table in tables:
        pieces.setdefault(table["event"][0].as_py(), []).append(table)
    words = dict(said())
    elements = []
    for of_event in words.pop("events"):
        values = pa.concat_tables(pieces.pop(of_event["event"]))
        elements.append(of_event | {name: values[name].to_numpy() for name in columns})
    history = np.empty(len(elements), dtype=[(name, object) for name in elements[0]])
    for i, element in enumerate(elements):
        history[i] = tuple(element.values())
    described = {
        "history": history,
        "point": words,
        "units": {name: schema.field(name).metadata[b"unit"].decode() for name in columns},
        "meaning": {name: schema.field(name).metadata[b"description"].decode() for name in columns},
    }
    with path.open("wb") as file:
        savemat(file, described, long_field_names=True, oned_as="column", do_compression=True)


FORMATS: dict[str, Write] = {".csv": write_csv, ".parquet": write_parquet, ".mat": write_mat}
