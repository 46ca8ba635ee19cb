"""The recount of checks beside the toe agrees with what the pipeline writes, and finds what is spoiled in it."""

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
from tests.compared_case import CASES, LINES, compared_case
from tests.older_result import without_hashes
from tests.small_case import small_case
from tests.stress_point_case import curve_text, point, stresses, write_points
from tests.unit_load_case import as_unit_load

CHECKS = """
[checks]
static_cases = "cases.csv"
endurance_lines = "lines.csv"
counts = ["endurance"]
[[checks.interaction]]
rule = "iiw"
cv = 0.5
damage_limit = 0.5
[[checks.interaction]]
rule = "en1993"
[[checks.endurance]]
cases = "ride"
perp = "across"
shear = "sheared"
limit = 1.0
[[checks.endurance]]
cases = "stops"
curve = "knee-36"
[multiaxial]
method = "range"
"""
OF_THROATS = """
[curves.throat]
slopes = [3.0]
range_at_2e6_MPa = 25.0
applies = "throat"
source = "invented for a test"
gamma_Mf = 1.1
[curves.throat-shear]
slopes = [5.0]
knees_cycles = [1e8]
range_at_2e6_MPa = 28.0
applies = "throat"
quantity = "shear"
source = "invented for a test"
damage_limit = 0.6
[curves.root]
slopes = [3.0, 5.0]
knees_cycles = [1e7]
range_at_2e6_MPa = 36.0
applies = "throat"
mean_stress = "iiw_low"
source = "invented for a test"
"""
COUNTED = ("range_max_MPa", "damage_per_km", "life_km", "damage_sum", "damage_limit", "utilisation_stress", "fulfilled")


@pytest.fixture(scope="module")
def result(tmp_path_factory) -> Path:
    """Result of a weld with a throat, three kinds of stress points, interactions, endurance checks and a method."""
    folder = tmp_path_factory.mktemp("checks") / "case"
    random = np.random.default_rng(3)
    case = compared_case(CHECKS)
    case.extra += OF_THROATS + curve_text("spot", 18.0, slopes=(3.0, 5.0), knees=(1e7, 1e8))
    case.extra += curve_text("metal", 60.0, "parent") + curve_text("metal-shear", 20.0, "parent", quantity="shear")
    case.body |= {"weld_throats": "throats.csv"}
    points = [
        point("spot", weld="W", curve="spot", x_mm=10.0, thickness_mm=6.0),
        point("edge", "hot_spot_b", curve="spot"),
        point("metal", "parent", curve="metal", curve_shear="metal-shear"),
    ]
    modes = (1, 2, 3)
    tables = [
        stresses("spot", {m: random.normal(0.0, 3.0, (2, 3)) for m in modes}, (2.4, 6.0), ("top", "bottom")),
        stresses("edge", {m: random.normal(0.0, 3.0, (3, 3)) for m in modes}, (4.0, 8.0, 12.0), ("edge",)),
        stresses("metal", {m: random.normal(0.0, 3.0, 3) for m in modes}),
    ]
    path = write_points(case, folder, points, tables)
    throat = {"weld": "W", "joint": "tee", "sides": "top", "throat_mm": 4.0, "penetration_mm": 0.5}
    throat |= {"line_offset_mm": -2.0, "curve": "throat", "curve_shear": "throat-shear", "curve_root": "root"}
    pd.DataFrame([throat | {"ended_plate": "true"}]).to_csv(folder / "throats.csv", index=False)
    (folder / "cases.csv").write_text(CASES, encoding="utf-8")
    (folder / "lines.csv").write_text(LINES, encoding="utf-8")
    assess(path, folder.parent / "out", threads=1, report=False)
    return without_hashes(folder.parent / "out")


def differing(folder: Path, **how: object) -> set[str]:
    """Name the columns that do not agree."""
    found = recount(folder, **how)  # type: ignore[arg-type]
    return {f"{column.table}.{column.column}" for column in found.columns if not column.passed}


def test_all_kinds_of_checks_agree(result):
    """Every kind of row is counted again by other code, all of them and a sample, and agrees to rounding."""
    found = recount(result, sample=None)
    assert found.passed, found.as_text()
    of_checks = {column.column: column.compared for column in found.columns if column.table == "checks"}
    kinds = set(pq.read_table(result / "checks.parquet")["check"].to_pylist())
    assert kinds == {
        *("toe_multiaxial", "throat_perp", "throat_par", "throat_root", "hot_spot", "parent"),
        *("interaction", "endurance"),
    }
    assert {"direction_deg", "value", "R", "plane_range_MPa", *COUNTED} <= set(of_checks)
    assert recount(result, sample=1).passed


def spoiled(result: Path, folder: Path, check: str, component: str, column: str) -> Path:
    """Copy a result with its inputs and change one column of the worst row of a check."""
    shutil.copytree(result.parent, folder / "copy")
    path = folder / "copy" / "out" / "checks.parquet"
    frame = pq.read_table(path).to_pandas()
    rows = frame[(frame["check"] == check) & frame["component"].str.contains(component, regex=False)]
    rows = rows[rows[column].notna()]
    row = rows["utilisation_stress"].idxmax()
    value = frame.loc[row, column]
    frame.loc[row, column] = (not value) if isinstance(value, bool | np.bool_) else value * 1.001 + 5.0 * (value == 0)
    pq.write_table(pa.Table.from_pandas(frame, schema=schema("checks"), preserve_index=False), path)
    return path.parent


FAULTS = [
    *(("throat_perp", "", column) for column in (*COUNTED, "direction_deg")),
    *(("throat_par", "", column) for column in ("damage_per_km", "damage_limit")),
    *(("throat_root", "", column) for column in ("range_max_MPa", "damage_per_km")),
    *(("hot_spot", "planes_60", column) for column in ("damage_per_km", "direction_deg", "utilisation_stress")),
    *(("hot_spot", "normal", column) for column in ("damage_per_km", "range_max_MPa")),
    *(("parent", "shear", column) for column in ("damage_per_km", "direction_deg")),
    *(("interaction", "iiw", column) for column in ("value", "normal_part", "shear_part", "utilisation_stress")),
    *(("interaction", "en1993", column) for column in ("damage_per_km", "value", "shear_part")),
    *(("endurance", "perp", column) for column in ("range_max_MPa", "R", "amplitude_MPa", "allowed_amplitude_MPa")),
    *(("endurance", "combination", column) for column in ("value", "utilisation_stress", "plane_range_MPa")),
]


@pytest.mark.parametrize(("check", "component", "column"), FAULTS, ids=lambda value: value)
def test_one_spoiled_value_is_found(result, tmp_path, check, component, column):
    """A thousandth in one column of one row of any check is found there."""
    folder = spoiled(result, tmp_path, check, component, column)
    found = differing(folder, sample=0)
    assert found & {f"checks.{column}", f"checks, all rows.{column}"}, found


@pytest.mark.parametrize("check", ["throat_perp", "hot_spot"])
def test_a_row_too_few_is_found(result, tmp_path, check):
    """No row of a throat or of a stress point may be missing."""
    folder = spoiled(result, tmp_path, check, "", "damage_per_km")
    path = folder / "checks.parquet"
    frame = pq.read_table(path).to_pandas()
    frame = frame.drop(index=frame.index[frame["check"] == check][0])
    pq.write_table(pa.Table.from_pandas(frame, schema=schema("checks"), preserve_index=False), path)
    assert any(name.startswith("checks.check") for name in differing(folder, sample=0))


def test_a_verdict_that_is_not_that_of_its_row_is_found(result, tmp_path):
    """A row that says fulfilled with a sum above its limit, or the other way round, is found in rows not counted."""
    shutil.copytree(result.parent, tmp_path / "copy")
    path = tmp_path / "copy" / "out" / "checks.parquet"
    frame = pq.read_table(path).to_pandas()
    row = frame.index[(frame["check"] == "toe_multiaxial")][-1]
    frame.loc[row, "fulfilled"] = not frame.loc[row, "fulfilled"]
    pq.write_table(pa.Table.from_pandas(frame, schema=schema("checks"), preserve_index=False), path)
    assert "checks, all rows.fulfilled" in differing(path.parent, sample=0)


@pytest.fixture(scope="module", params=["csv", "parquet"])
def of_a_load(request, tmp_path_factory) -> Path:
    """Result of stress points whose stress is that of modes and of a unit load, in whose rows the mode is empty."""
    folder = tmp_path_factory.mktemp("load") / "case"
    case = small_case(seconds=2.0)
    forces = as_unit_load(case, 7, "press", request.param)
    case.mission["target_km"] = 2e4
    case.extra += curve_text("points", 20.0) + curve_text("metal", 60.0, "parent")
    tensors = {1: (1.0, 2.0, 0.5), 2: (0.3, -1.5, 0.2), "press": (2.0, 4.0, -1.0)}
    points = [point("spot", weld="A", curve="points"), point("metal", "parent", curve="metal")]
    tables = [stresses("spot", tensors, (3.2, 8.0)), stresses("metal", tensors)]
    path = write_points(case, folder, points, tables, request.param)
    (forces.to_csv if request.param == "csv" else forces.to_parquet)(folder / f"loads.{request.param}", index=False)
    assess(path, folder.parent / "out", threads=1, report=False)
    return without_hashes(folder.parent / "out")


def test_stress_of_unit_loads_is_counted_again(of_a_load, tmp_path):
    """Rows of a unit load have no mode; what they add is recounted, and a wrong value at such a point is found."""
    found = recount(of_a_load, sample=None)
    assert found.passed, found.as_text()
    assert {column.column: column.compared for column in found.columns if column.table == "checks"}["damage_per_km"] > 2
    assert "checks.damage_per_km" in differing(spoiled(of_a_load, tmp_path, "parent", "", "damage_per_km"), sample=0)
