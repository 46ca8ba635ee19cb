"""CSV: the values of the tables, texts that are no formulas, and a byte order mark for who asks for one."""

import pandas as pd
import pytest
from pyarrow import csv

from fatigue.errors import DataError
from fatigue.report.files.export import CSV_TABLES, write_csv
from tests.report.tiny_result import Recipe, write_result


def test_formulas_get_an_apostrophe(tmp_path):
    """No name becomes a formula in a spreadsheet."""
    names = ("=1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "https://example.org", "-2")
    folder = write_result(tmp_path, Recipe(welds=names, stations=2))
    written = {path.name: path for path in write_csv(folder)}
    assert set(pd.read_csv(written["nodes.csv"], dtype={"weld": str})["weld"]) == {
        f"'{n}" if n[0] in "=+-@" else n for n in names
    }


def test_csv_files_read_back_as_the_tables(result_folder):
    """All values of all tables survive."""
    paths = write_csv(result_folder)
    assert [path.stem for path in paths] == [n for n in CSV_TABLES if (result_folder / f"{n}.parquet").exists()]
    for path in paths:
        expected = pd.read_parquet(path.with_suffix(".parquet"))
        found = csv.read_csv(path).to_pandas()  # every digit counts; pandas 2 wants to be asked, pandas 3 not to be
        for column in expected.select_dtypes("number"):
            pd.testing.assert_series_equal(
                found[column].astype(float), expected[column].astype(float), check_exact=True, obj=path.name
            )


def test_a_byte_order_mark_stands_once_at_the_beginning(result_folder, tmp_path):
    """For who asks for it; the rest is the same bytes."""
    plain, marked = tmp_path / "plain", tmp_path / "marked"
    for folder, bom in ((plain, False), (marked, True)):
        folder.mkdir()
        write_csv(result_folder, folder, bom=bom)
    for path in sorted(plain.iterdir()):
        assert (marked / path.name).read_bytes() == b"\xef\xbb\xbf" + path.read_bytes()
        assert not path.read_bytes().startswith(b"\xef\xbb\xbf")


def test_a_folder_without_result_is_refused(tmp_path):
    """CSV of nothing is refused with what to do."""
    with pytest.raises(DataError, match="no finished result"):
        write_csv(tmp_path)
