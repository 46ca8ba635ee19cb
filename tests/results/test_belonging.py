"""Which result a file belongs to."""

import json
import shutil

import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.report.files.export import write_csv
from fatigue.report.files.vtp import write_vtp
from fatigue.report.files.workbook.book import write_xlsx
from fatigue.report.page import write_report
from fatigue.results import is_derived, read_provenance, refuse_foreign, refuse_mixed, strangers, write_json
from fatigue.results.belonging import carried, listed


@pytest.fixture
def folder(small_result, tmp_path):
    """A copy of a result with every document that needs no browser."""
    shutil.copytree(small_result, tmp_path / "result")
    for write in (write_report, write_vtp, write_xlsx, write_csv):
        write(tmp_path / "result")
    return tmp_path / "result"


def names_of(problems):
    """Files that problems are about."""
    return [problem.where.rsplit("/", 1)[-1] for problem in problems]


def test_everything_written_of_a_result_belongs_to_it(folder):
    """Tables and documents carry the hash, CSV files stand in the list; nothing is a stranger."""
    record = read_provenance(folder)
    for name in ("nodes.parquet", "cycles.parquet", "report.html", "weld_lines.vtp", "nodes.xlsx"):
        assert carried(folder / name) == record["result"], name
    assert carried(folder / "nodes.csv") is None
    assert set(listed(folder)) == {
        "report.html", "weld_lines.vtp", "nodes.xlsx", "nodes.csv", "damage.csv", "cycles.csv", "welds.csv",
        "histogram.csv", "band.csv", "sensitivity.csv", "path_cycles.csv",
    }  # fmt: skip
    assert not strangers(folder, record)
    assert all(is_derived(folder, name, record) for name in listed(folder))


def test_equal_inputs_give_the_equal_hash(small_result, tmp_path):
    """It is one of inputs and program: 32 hexadecimal digits, the same wherever the folder lies."""
    result = read_provenance(small_result)["result"]
    assert len(result) == 32
    assert int(result, 16)
    shutil.copytree(small_result, tmp_path / "elsewhere")
    assert not strangers(tmp_path / "elsewhere", read_provenance(small_result))


def test_readers_of_csv_see_nothing_new(folder):
    """No comment line and no column is added for the hash."""
    assert list(pd.read_csv(folder / "nodes.csv").columns) == pq.read_schema(folder / "nodes.parquet").names


@pytest.mark.parametrize("name", ["nodes.csv", "nodes.xlsx", "report.html", "weld_lines.vtp"])
def test_a_document_that_was_changed_is_named_and_not_ours(folder, name):
    """Somebody wrote into it: it is his now, and no longer what the result says."""
    record = read_provenance(folder)
    with (folder / name).open("ab") as file:
        file.write(b"\n ")
    (stranger,) = strangers(folder, record)
    assert names_of([stranger]) == [name]
    assert "was changed since it was written" in stranger.what
    assert not is_derived(folder, name, record)


@pytest.mark.parametrize("name", ["nodes.parquet", "report.html", "weld_lines.vtp", "nodes.xlsx", "nodes.csv"])
def test_a_file_of_another_result_is_named(folder, name):
    """As when the provenance was replaced: each file that carries the other hash, and the list."""
    record = read_provenance(folder) | {"result": "0" * 32}
    assert name in names_of(strangers(folder, record, [name]))


def test_a_file_the_list_does_not_know_is_not_ours(folder):
    """A workbook or CSV file of the user's own at the name of an export; a page carries its hash and may be ours."""
    (folder / "exports.json").unlink()
    record = read_provenance(folder) | {"outputs": []}  # nor does the provenance
    ours = {name: is_derived(folder, name, record) for name in ("nodes.xlsx", "nodes.csv", "report.html")}
    assert ours == {"nodes.xlsx": False, "nodes.csv": False, "report.html": True}
    (folder / "report.html").write_text("<p>my own page")
    assert not is_derived(folder, "report.html", record)


def test_a_list_of_somebody_else_counts_for_nothing(folder):
    """A file exports.json of another program, or one cut short."""
    for text in ("[1, 2]", '{"files": {"nodes.csv": "x"}}', "{"):
        (folder / "exports.json").write_text(text)
        assert listed(folder) == {}


def test_results_from_before_there_were_hashes(folder):
    """Page and picture are ours, tables are taken as they are."""
    record = {key: value for key, value in read_provenance(folder).items() if key != "result"}
    record["outputs"] = ["nodes.parquet", "report.html"]
    write_json(folder / "provenance.json", record)
    (folder / "exports.json").unlink()
    assert is_derived(folder, "report.html", record)
    assert not is_derived(folder, "nodes.csv", record)


def test_mixed_tables_are_refused(folder):
    """A table from elsewhere beside this provenance: its name, both hashes, what to do."""
    record = json.loads((folder / "provenance.json").read_text()) | {"result": "f" * 32}
    with pytest.raises(DataError, match=r"nodes\.parquet: belongs to the result .* not to that of .*, f{12}"):
        refuse_mixed(folder, record)


@pytest.mark.parametrize("table", ["alarm", "levers", "watch", "signals", "shift", "bench_blocks"])
def test_a_table_of_somebody_else_is_not_overwritten(tmp_path, table):
    """Whatever command would write it: the file is named, and stays."""
    pd.DataFrame({"mine": [1]}).to_parquet(tmp_path / f"{table}.parquet")
    with pytest.raises(DataError, match=f"{table}.parquet: is there already and was not written by fatigue"):
        refuse_foreign(tmp_path, ["nodes", table], {})
    assert list(pd.read_parquet(tmp_path / f"{table}.parquet")) == ["mine"]
    refuse_foreign(tmp_path, ["nodes"], {})
