"""The folder of a basis: tables and page as the dictionary says, nothing foreign overwritten, nothing stale left."""

import json

import pyarrow.parquet as pq
import pytest

from fatigue.basis.folder import FILES
from fatigue.basis.story import basis
from fatigue.errors import CaseError, DataError
from fatigue.results.dictionary.basis import BASIS
from tests.chain_case import by_factors

TABLES = ("mass_sum", "modal_mass", "dynamic_mass")


@pytest.fixture
def case(tmp_path):
    """Case file of a chain."""
    return by_factors(tmp_path / "case").write(tmp_path / "case")


def codes(error):
    """Codes of all refusals."""
    return [problem.code for problem in error.value.problems]


def test_tables_are_as_the_dictionary_says(case, tmp_path):
    """Every column stands with its unit and meaning; rows are those of the findings."""
    answer = basis(case, into=tmp_path / "out", damping=0.02, csv=True)
    rows = {finding.table: finding.rows for finding in answer.findings}
    for name in TABLES:
        table = pq.read_table(tmp_path / "out" / f"{name}.parquet")
        assert table.column_names == [column.name for column in BASIS[name]]
        assert [field.metadata[b"unit"].decode() for field in table.schema] == [c.unit for c in BASIS[name]]
        assert table.num_rows == len(rows[name])
        lines = (tmp_path / "out" / f"{name}.csv").read_text(encoding="utf-8").splitlines()
        assert len(lines) == table.num_rows + 1
    page = (tmp_path / "out" / "basis.html").read_text(encoding="utf-8")
    assert "small case" in page
    assert "https://" not in page.split('<script type="text/plain"')[0]
    record = json.loads((tmp_path / "out" / "basis.json").read_text(encoding="utf-8"))
    assert set(record["inputs"]) == {"case.toml", "modes.csv", "participation.csv"}
    assert {*record["outputs"], "basis.json"} == {path.name for path in (tmp_path / "out").iterdir()}
    assert set(record["outputs"]) <= set(FILES)


def test_what_is_not_available_is_null(case, tmp_path):
    """A number that cannot be had is null, not NaN, with its reason beside it."""
    basis(case, into=tmp_path / "out")
    table = pq.read_table(tmp_path / "out" / "mass_sum.parquet").to_pylist()
    rz = next(row for row in table if row["direction"] == "rz")
    assert rz["summed_mass"] is None
    assert rz["enough"] is None
    assert "not given" in rz["reason"]


def test_the_same_command_again_replaces_its_files_and_removes_old_ones(case, tmp_path):
    """What a run no longer says does not stay behind."""
    out = tmp_path / "out"
    basis(case, into=out, damping=0.02, csv=True)
    (out / "notes.txt").write_text("mine", encoding="utf-8")
    basis(case, into=out)
    assert not (out / "dynamic_mass.parquet").exists()
    assert not (out / "modal_mass.csv").exists()
    assert (out / "notes.txt").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("name", ["modal_mass.parquet", "basis.html", "basis.json", "mass_sum.csv"])
def test_nothing_foreign_is_overwritten(case, tmp_path, name):
    """A file of somebody else, or ours changed by hand, is refused, and replaced with force alone."""
    out = tmp_path / "out"
    out.mkdir()
    (out / name).write_text("mine", encoding="utf-8")
    with pytest.raises(DataError) as error:
        basis(case, into=out)
    assert codes(error) == ["foreign_files"]
    assert [path.name for path in out.iterdir()] == [name]
    basis(case, into=out, force=True)
    assert (out / "basis.json").exists()
    page = out / "basis.html"
    page.write_text(page.read_text(encoding="utf-8") + "<!-- mine -->", encoding="utf-8")
    with pytest.raises(DataError) as error:
        basis(case, into=out)
    assert codes(error) == ["foreign_files"]


def test_an_input_is_never_overwritten(case, tmp_path):
    """A folder that holds the case's own file under one of our names is refused, with force too."""
    folder = case.parent
    (folder / "participation.csv").rename(folder / "modal_mass.csv")
    case.write_text(case.read_text(encoding="utf-8").replace("participation.csv", "modal_mass.csv"), encoding="utf-8")
    with pytest.raises(DataError) as error:
        basis(case, into=folder, force=True)
    assert codes(error) == ["input_in_the_way"]


def test_folders_in_the_way(case, tmp_path):
    """A file where the folder should be, and a folder where a file should be, are told."""
    with pytest.raises(DataError) as error:
        basis(case, into=case)
    assert codes(error) == ["not_a_folder"]
    (tmp_path / "out" / "basis.html").mkdir(parents=True)
    with pytest.raises(DataError) as error:
        basis(case, into=tmp_path / "out", force=True)
    assert codes(error) == ["foreign_files"]


@pytest.mark.parametrize("damping", [2, 0.0, float("nan"), "0.015"])
def test_what_is_no_damping_ratio(tmp_path, damping):
    """Percent typed for a ratio is refused, as it is by a diagnosis, before anything is read."""
    with pytest.raises(CaseError, match=r"is no damping ratio .* 1\.5 % are 0\.015"):
        basis(by_factors(tmp_path).write(tmp_path), damping=damping)
