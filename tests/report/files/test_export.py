"""Workbook and CSV: the numbers of the tables, formulas as texts, filters and frozen headers."""

import builtins
import zipfile
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pytest
from pyarrow import csv

from fatigue.errors import DataError
from fatigue.report.files.export import CSV_TABLES, write_csv, write_xlsx
from fatigue.results import NODES
from tests.report.tiny_result import Recipe, write_result

NS = {"m": "http://schemas.openxmlformats.org/spreadsheetml/2006/main"}


def sheet(path, number=1):
    """A sheet of a workbook: its XML, and its cells by address (texts resolved)."""
    with zipfile.ZipFile(path) as book:
        root = ET.fromstring(book.read(f"xl/worksheets/sheet{number}.xml"))
        shared = []
        if "xl/sharedStrings.xml" in book.namelist():
            shared = ["".join(t.itertext()) for t in ET.fromstring(book.read("xl/sharedStrings.xml"))]
    cells = {}
    for cell in root.iter(f"{{{NS['m']}}}c"):
        value, inline = cell.find("m:v", NS), cell.find("m:is", NS)
        if cell.get("t") == "s":
            cells[cell.get("r")] = shared[int(value.text)]
        elif inline is not None:
            cells[cell.get("r")] = "".join(inline.itertext())
        elif value is not None:
            cells[cell.get("r")] = float(value.text)
    return root, cells


def test_numbers_are_those_of_the_table(result_folder):
    """Every number of every column, to the 16 digits of the format."""
    pytest.importorskip("xlsxwriter")
    _, cells = sheet(write_xlsx(result_folder))
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    letters = [*"ABCDEFGHIJKLMNOPQRSTUVWXYZ", *("A" + c for c in "ABCDEFGHIJKLMNOPQRSTUVWXYZ")]
    for letter, column in zip(letters, NODES, strict=False):
        head = column.name if column.unit == "-" else f"{column.name}\n[{column.unit}]"
        assert cells[f"{letter}1"] == head
        if column.type in ("float", "int"):
            found = [cells.get(f"{letter}{i}", np.nan) for i in range(2, len(nodes) + 2)]
            expected = nodes[column.name].to_numpy(dtype=float)
            np.testing.assert_allclose(found, expected, rtol=1e-15, err_msg=column.name)  # 16 digits in the file


def test_headers_stay_and_columns_filter(result_folder):
    """The first row is frozen and carries the filter over all rows."""
    pytest.importorskip("xlsxwriter")
    root, _ = sheet(write_xlsx(result_folder))
    pane = root.find("m:sheetViews/m:sheetView/m:pane", NS)
    assert (pane.get("ySplit"), pane.get("state")) == ("1", "frozen")
    assert root.find("m:autoFilter", NS).get("ref").startswith("A1:")


def test_formulas_stay_texts(tmp_path):
    """No name becomes a formula or a link, neither in the workbook nor in CSV."""
    pytest.importorskip("xlsxwriter")
    names = ("=1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "https://example.org", "-2")
    folder = write_result(tmp_path, Recipe(welds=names, stations=2))
    root, cells = sheet(write_xlsx(folder))
    assert not list(root.iter(f"{{{NS['m']}}}f"))
    assert root.find("m:hyperlinks", NS) is None
    assert set(names) <= set(cells.values())
    written = {path.name: path for path in write_csv(folder)}
    assert set(pd.read_csv(written["nodes.csv"], dtype={"weld": str})["weld"]) == {
        f"'{n}" if n[0] in "=+-@" else n for n in names
    }


def test_infinite_and_missing_values(tmp_path):
    """An infinite life says so, what is missing is an empty cell."""
    pytest.importorskip("xlsxwriter")
    _, cells = sheet(write_xlsx(write_result(tmp_path, Recipe(level=0.0, stations=2))))
    assert "> 1e+12" in cells.values()
    assert not {"nan", "inf", "NaN"} & {v for v in cells.values() if isinstance(v, str)}


def test_the_same_result_gives_the_same_workbook(result_folder):
    """No clock in the workbook."""
    pytest.importorskip("xlsxwriter")
    assert write_xlsx(result_folder).read_bytes() == write_xlsx(result_folder).read_bytes()


def test_csv_files_read_back_as_the_tables(result_folder):
    """All values of all tables survive."""
    paths = write_csv(result_folder)
    assert [path.stem for path in paths] == [n for n in CSV_TABLES if (result_folder / f"{n}.parquet").exists()]
    for path in paths:
        expected = pd.read_parquet(path.with_suffix(".parquet"))
        found = csv.read_csv(path).to_pandas()  # every digit counts; pandas 2 wants to be asked, pandas 3 not to be
        for column in expected.select_dtypes("number"):
            np.testing.assert_array_equal(
                found[column].astype(float), expected[column], err_msg=f"{path.name} {column}"
            )


def test_without_the_extra_the_message_names_it(result_folder, monkeypatch):
    """How to install it, and that CSV needs nothing."""
    real = builtins.__import__

    def missing(name, *args, **kwargs):
        if name == "xlsxwriter":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(DataError, match=r'pip install "xlsxwriter>=[\d.]+", or write CSV'):
        write_xlsx(result_folder)


def test_too_many_points_for_a_sheet(result_folder, monkeypatch):
    """The limit of the format is told before anything is written."""
    pytest.importorskip("xlsxwriter")
    monkeypatch.setattr("fatigue.report.files.export._MOST_ROWS", 10)
    with pytest.raises(DataError, match="do not fit into a sheet of 10 rows"):
        write_xlsx(result_folder)


def test_a_folder_without_result_is_refused(tmp_path):
    """CSV of nothing is refused with what to do."""
    with pytest.raises(DataError, match="no finished result"):
        write_csv(tmp_path)
