"""The folder of a comparison: its tables, its page and its record, in place of those before and of nothing else."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fatigue.decide.compare.finished import READ, Finished
from fatigue.decide.compare.page import PAGE, compare_page
from fatigue.decide.compare.summary import Comparison, match_rows, result_rows
from fatigue.files.recorded import Filled
from fatigue.results.dictionary.decided.compare import COMPARED
from fatigue.results.plain_tables import fill, table_files

RECORD = "compare.json"
FILLED = Filled("fatigue compare", "comparison", RECORD, (*table_files(tuple(COMPARED)), PAGE))


def write_compare(folder: Path, found: Comparison, *, csv: bool) -> list[str]:
    """Write tables, page and record; returns their names.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    tables = {name: (COMPARED[name], rows) for name, rows in tables_of(found).items()}
    said = found.as_record()
    said = {
        "results": said["results"],
        "compared": [{k: one[k] for k in ("result", "said", "notes")} for one in said["compared"]],
    }
    return fill(folder, FILLED, tables, {PAGE: compare_page(found)}, said, csv=csv)


def tables_of(found: Comparison) -> dict[str, pd.DataFrame]:
    """Rows of every table, those of all pairs behind each other."""
    differences = [one for pair in found.pairs for one in pair.differences]
    return {
        "compare_results": result_rows(found.results),
        "compare": pd.concat([pair.points for pair in found.pairs], ignore_index=True),
        "compare_welds": pd.concat([pair.welds for pair in found.pairs], ignore_index=True),
        "compare_causes": pd.concat([pair.causes for pair in found.pairs], ignore_index=True),
        "compare_matches": pd.concat([match_rows(pair) for pair in found.pairs], ignore_index=True),
        "compare_differences": pd.DataFrame(differences, columns=[c.name for c in COMPARED["compare_differences"]]),
    }


def inputs_of(results: Sequence[Finished]) -> list[Path]:
    """Tables that are read: none of them is overwritten."""
    return [one.folder / f"{name}.parquet" for one in results for name in READ]
