"""The recount of welds under other assumptions agrees with the pipeline, and finds what is spoiled."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.results import schema
from fatigue.verify.recount import recount
from tests.older_result import without_hashes
from tests.small_case import SmallCase, small_case

SHEAR = '[multiaxial]\nmethod = "range"\n'
LOOP = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 30.0\n'
OWN_LIMIT = """
[curves.plate]
slopes = [3.0]
range_at_2e6_MPa = 60.0
applies = "structural"
source = "invented"
damage_limit = 0.4
log10_scatter = 0.2
"""
SETTINGS = {
    "one slope": {},
    "knee, upsampled": {"extension": "haibach", "knee_cycles": 3e5, "upsample": 4},
    "cut-off, vertex": {"extension": "cutoff", "knee_cycles": 1e6, "reversals": "vertex", "upsample": "auto"},
    "mean stress": {"mean_stress": "asme", "yield_MPa": 60.0, "extension": "haibach", "knee_cycles": 2e5},
    "shear decides": {"extra": SHEAR},
    "sequence": {"extra": LOOP},
    "limit of its own": {"name": "plate", "extra": OWN_LIMIT},
}


def varied_case(
    *, extra: str = "", reversals: str = "samples", upsample: object = 1, target_km: float = 2e4, **curve: object
) -> SmallCase:
    """Two welds whose forces vary along the line, which are far from their target unless it is a shorter one."""
    case = small_case(seconds=2.0)
    along = 1.0 + 0.4 * np.sin(np.arange(len(case.nodal_forces)) % 7)
    components = [c for c in case.nodal_forces if c.endswith(("_N", "_Nmm"))]
    case.nodal_forces[components] *= along[:, None]
    case.counting = {"upsample": upsample, "reversals": reversals}
    case.mission["target_km"] = target_km
    case.curve |= curve
    case.extra = extra
    return case


def assessed(folder: Path, **setting: object) -> Path:
    """Result of a varied case, without the hashes that would tell of every change."""
    assess(varied_case(**setting).write(folder / "case"), folder / "out", threads=1, report=False, histogram="none")
    return without_hashes(folder / "out")


def differing(folder: Path, **how: object) -> set[str]:
    """Name the columns of the table that do not agree."""
    found = recount(folder, **how)  # type: ignore[arg-type]
    return {column.column for column in found.columns if column.table == "sensitivity" and not column.passed}


@pytest.mark.parametrize("name", SETTINGS)
def test_all_variants_agree(tmp_path, name):
    """Every row is recounted at all toe points of its weld, and agrees to rounding or lies on its side."""
    result = assessed(tmp_path, **SETTINGS[name])
    found = recount(result, sample=None)
    assert found.passed, found.as_text()
    of_table = {column.column: column for column in found.columns if column.table == "sensitivity"}
    assert of_table["utilisation"].compared > 10
    assert of_table["utilisation"].difference < 1e-10
    assert recount(result, sample=1).passed


@pytest.fixture(scope="module")
def result(tmp_path_factory) -> Path:
    """Result of welds that fail: rows of every basis that names a point, and bounds from below."""
    return assessed(tmp_path_factory.mktemp("varied"), survival="mean-3sigma", extension="haibach", knee_cycles=3e5)


@pytest.fixture(scope="module")
def fulfilled(tmp_path_factory) -> Path:
    """Result of welds that meet their target, some of them under variants by a bound from above."""
    curve = {"survival": "mean-3sigma", "extension": "haibach", "knee_cycles": 3e5}
    return assessed(tmp_path_factory.mktemp("fulfilled"), target_km=5.0, **curve)


def spoiled(result: Path, folder: Path, rows, change) -> Path:
    """Copy a result with its inputs and change the first of some rows of the table."""
    shutil.copytree(result.parent, folder / "copy")
    path = folder / "copy" / "out" / "sensitivity.parquet"
    frame = pq.read_table(path).to_pandas()
    some = frame.index[rows(frame)]
    assert len(some)
    frame = change(frame, some[0])
    pq.write_table(pa.Table.from_pandas(frame, schema=schema("sensitivity"), preserve_index=False), path)
    return path.parent


def scaled(factor: float):
    """Change of the utilisation."""

    def change(frame: pd.DataFrame, row: int) -> pd.DataFrame:
        frame.loc[row, "utilisation"] *= factor
        return frame

    return change


def turned(column: str):
    """Change of a verdict."""

    def change(frame: pd.DataFrame, row: int) -> pd.DataFrame:
        frame.loc[row, column] = not frame.loc[row, column]
        return frame

    return change


@pytest.mark.parametrize("basis", ["exact", "recount", "as assessed"])
def test_a_thousandth_is_found(result, tmp_path, basis):
    """Of numbers that are exact, counted again, or those of the assessment."""
    folder = spoiled(result, tmp_path, lambda frame: frame["basis"] == basis, scaled(1.001))
    assert differing(folder, sample=None) == {"utilisation"}


def is_bound(frame: pd.DataFrame) -> pd.Series:
    """Rows of a variant whose bound is close to what is counted."""
    return (frame["basis"] == "bound") & (frame["variant"] == "no_knee")


@pytest.mark.parametrize("sample", [None, 1])
def test_a_bound_below_what_is_counted_is_found(fulfilled, tmp_path, sample):
    """A bound from above, of a weld that meets its target, where all points are counted again and where few are."""
    folder = spoiled(fulfilled, tmp_path, is_bound, scaled(0.5))
    assert differing(folder, sample=sample) == {"utilisation"}


def test_a_bound_above_what_is_counted_is_found(result, tmp_path):
    """A bound from below, of a weld that fails: wrong only if no point of the weld reaches it, so all are counted."""
    folder = spoiled(result, tmp_path, is_bound, scaled(2.0))
    assert differing(folder, sample=None) == {"utilisation"}


@pytest.mark.parametrize(("of", "factor"), [("fulfilled", 2.0), ("result", 0.5)])
def test_a_wide_bound_is_none_that_is_wrong(request, tmp_path, of, factor):
    """A bound that is farther from what is counted than it need be still holds."""
    folder = spoiled(request.getfixturevalue(of), tmp_path, is_bound, scaled(factor))
    assert differing(folder, sample=None) == set()


@pytest.mark.parametrize("column", ["fulfilled", "flips"])
def test_a_wrong_verdict_is_found(result, tmp_path, column):
    """In any row, also where few are counted again."""
    folder = spoiled(result, tmp_path, lambda frame: frame["fulfilled"].notna(), turned(column))
    assert differing(folder, sample=0) == {column}


def test_another_point_is_found(result, tmp_path):
    """A row that names a point which is not the worst one under its variant."""

    def moved(frame: pd.DataFrame, row: int) -> pd.DataFrame:
        by = 1 if frame.loc[row, "order"] < 4 else -1
        frame.loc[row, ["order", "node"]] += by
        return frame

    folder = spoiled(result, tmp_path, lambda frame: frame["basis"] == "exact", moved)
    assert {"order", "node"} <= differing(folder, sample=None)


def test_a_row_too_few_is_found(result, tmp_path):
    """Every weld has a row of every variant."""
    folder = spoiled(result, tmp_path, lambda frame: frame["weld"] == "A", lambda frame, row: frame.drop(index=row))
    assert differing(folder, sample=0) == {"weld, variant"}
