"""The recount of shear where it counts the paths of few points only."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.case import Case, load_case
from fatigue.verify.recount import recount, sheared
from tests.older_result import without_hashes
from tests.verify.test_recount import differing, edit
from tests.verify.tiny_case import TinyCase, write_case

METHOD = '[multiaxial]\nmethod = "{method}"\n'


def written(folder: Path, method: str) -> Case:
    """Write a case of two welds and short records."""
    tiny = TinyCase(
        curves=METHOD.format(method=method),
        welds=("short", "seam"),
        samples=120,
        spectrum="segment_s = 0.3",
        counting="upsample = 1",
        scale=(0.05,) * 4,
    )
    return load_case(write_case(folder, tiny))


@pytest.fixture(scope="module", params=["report", "range"])
def result(request, tmp_path_factory) -> Path:
    """Result whose paths stand beside, or decide."""
    folder = tmp_path_factory.mktemp(request.param)
    assess(written(folder / "case", request.param), folder / "result", threads=1, report=False)
    return folder / "result"


@pytest.fixture
def few_paths(monkeypatch) -> None:
    """Have no more than two paths counted again where points are drawn."""
    monkeypatch.setattr(sheared, "PATH_SAMPLES", 0)


def spoil(result: Path, folder: Path, column: str, factor: float) -> Path:
    """Copy a result and change a column at the last toe point that has sums of its path."""
    shutil.copytree(result.parent, folder / "copy")
    copy = without_hashes(folder / "copy" / "result")

    def change(frame: pd.DataFrame) -> pd.DataFrame:
        row = frame.index[frame["toe"] & frame["utilisation_path_range"].notna()][-1]
        frame.loc[row, column] *= factor
        return frame

    edit(copy, "nodes", change)
    return copy


def test_sums_beyond_the_cap_are_believed(result, few_paths):
    """Points whose paths are not counted again agree in all that does not need them."""
    nodes = pq.read_table(result / "nodes.parquet").to_pandas()
    found = recount(result, sample=1000)
    assert found.passed, found.as_text()
    compared = {column.column: column.compared for column in found.columns if column.table == "nodes"}
    assert compared["utilisation_asme"] == len(nodes)
    assert compared["utilisation_path_range"] == 2 + np.count_nonzero(~nodes["toe"])
    assert nodes["utilisation_path_range"].notna().sum() > 2


def test_sums_of_screened_points_are_believed(few_paths, tmp_path):
    """Points whose normal stress was not counted, and whose path was, agree with their paths counted again and not."""
    assess(written(tmp_path / "case", "report"), tmp_path / "result", threads=1, report=False, share=0.5)
    nodes = pq.read_table(tmp_path / "result" / "nodes.parquet").to_pandas()
    assert np.count_nonzero((nodes["screened"] != "") & nodes["utilisation_path_range"].notna()) > 2
    for sample in (None, 1000):
        found = recount(tmp_path / "result", sample=sample)
        assert found.passed, found.as_text()


@pytest.mark.parametrize(("column", "factor"), [("multiaxial_bound", 0.1), ("utilisation_asme", 1.001)])
def test_what_needs_no_path_is_found_beyond_the_cap(result, few_paths, tmp_path, column, factor):
    """A bound below that of the exact path, and a sum by the ASME factor, at a point whose path is not counted."""
    assert f"nodes.{column}" in differing(recount(spoil(result, tmp_path, column, factor), sample=1000))


def test_what_a_believed_sum_decides_is_found(result, few_paths, tmp_path):
    """A utilisation that is not the larger one of two sums, one of which is believed."""
    assert "nodes.utilisation" in differing(recount(spoil(result, tmp_path, "utilisation", 1.001), sample=1000))
