"""The tables of a result as CSV files, for programs that read nothing else."""

from pathlib import Path

import pandas as pd
import pyarrow as pa

from fatigue.errors import given_path
from fatigue.files.mishaps import refused_writing
from fatigue.results import ASSESSED, CSV_TABLES, TABLES, enlist, read_provenance, row_groups
from fatigue.results.tables import table_path


def write_csv(folder: Path | str, into: Path | None = None, *, bom: bool = False) -> list[Path]:
    """Write tables of points, events, cycles, welds and, where they are, ranges, load spectra, bench programmes as CSV.

    They are UTF-8 with decimal points. Infinite lives are written as ``inf``, what is not available is empty. A text
    that a spreadsheet would take for a formula gets an apostrophe before it. ``into`` is another folder to write to,
    where they are not listed as documents of the result. ``bom`` begins them with a byte order mark, by which Excel
    tells UTF-8; other programs may take it for a part of the first name.

    Raises
    ------
    DataError : no finished result in the folder
    """
    folder = given_path(folder, "folder")
    read_provenance(folder)
    paths, encoding = [], "utf-8-sig" if bom else "utf-8"
    for name in CSV_TABLES:
        if name not in ASSESSED and not table_path(folder, name).exists():
            continue
        texts = [column.name for column in TABLES[name] if column.type == "text"]
        paths.append((into or folder) / f"{name}.csv")
        with refused_writing(paths[-1]), paths[-1].open("w", encoding=encoding, newline="") as file:
            for number, group in enumerate(row_groups(folder, name)):
                frame = group.to_pandas(types_mapper={pa.int64(): pd.Int64Dtype()}.get)  # "33", not "33.0", beside none
                for text in texts:
                    frame[text] = frame[text].map(_harmless, na_action="ignore")
                frame.to_csv(file, index=False, header=number == 0, lineterminator="\n")
    if into is None:
        enlist(folder, *paths)
    return paths


def _harmless(text: str) -> str:
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text
