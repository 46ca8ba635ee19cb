"""Where stress vanishes to rounding the recount raises no alarm; of ordinary stress it misses nothing."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.verify.recount import recount
from fatigue.verify.recount.anew.rounding import UNIT, stress_bound
from tests.older_result import without_hashes
from tests.verify.vanishing import ABOUT_DEAD_LOAD, CASES

SMALLEST = 3e-6  # relative; the tolerance is 1e-6


def result_of(case, folder, suffix="csv"):
    """Result of a case."""
    assess(load_case(case.write(folder / "case", suffix)), folder / "result", threads=1, report=False)
    return folder / "result"


@pytest.mark.parametrize("name", CASES)
def test_no_false_alarm(tmp_path, name):
    """All points recounted: nothing differs but rounding."""
    suffix = "parquet" if "single precision" in name else "csv"
    found = recount(result_of(CASES[name], tmp_path, suffix), sample=None)
    assert found.passed, found.as_text()


@pytest.fixture(scope="module")
def ordinary(tmp_path_factory):
    """Result without hashes, which would tell all."""
    return without_hashes(result_of(ABOUT_DEAD_LOAD, tmp_path_factory.mktemp("ordinary")))


COLUMNS = {
    "nodes": [
        *("damage_per_km", "life_km", "life_years", "utilisation", "load_factor", "life_km_dirlik", "life_km_tb"),
        *("life_km_same_ratio", "dirlik_ratio", "max_range_MPa", "equivalent_range_2e6_MPa", "life_km_raw_end"),
        *("path_factor_largest", "path_moment_largest", "multiaxial_bound", "utilisation_asme"),
        *("utilisation_path_range", "utilisation_path_length", "utilisation_path_mlp"),
    ],
    "damage": [
        *(
            "damage_per_pass",
            "damage_per_km",
            "damage_dirlik_per_pass",
            "damage_tb_per_km",
            "max_range_MPa",
            "kurtosis",
        ),
        *("damage_same_ratio_per_pass", "peaks_per_s", "samples_per_peak", "max_equivalent_range_dS"),
    ],
    "path_cycles": [
        *("range_MPa", "path_factor", "path_moment", "normal_range_MPa", "shear_range_MPa", "equivalent_range_dS"),
        *("damage", "end_s"),
    ],
    "cycles": ["range_MPa", "membrane_range_MPa", "equivalent_range_dS", "damage"],
    "structural_stress": ["membrane_MPa", "bending_raw_MPa"],
    "welds": ["life_km", "utilisation", "load_factor"],
}


def test_small_errors_are_found(ordinary):
    """The largest value of every column, changed by three millionths of itself."""
    spoiled = {ordinary / f"{table}.parquet": columns for table, columns in COLUMNS.items()}
    before = {path: path.read_bytes() for path in spoiled}
    try:
        for path, columns in spoiled.items():
            for column in columns:
                spoil(path, column)
        found = recount(ordinary, sample=None)
    finally:
        for path, content in before.items():
            path.write_bytes(content)
    wrong = {f"{check.table}.{check.column}" for check in found.columns if not check.passed}
    assert wrong >= {f"{table}.{column}" for table, columns in COLUMNS.items() for column in columns}


def spoil(path, column):
    """Change the largest value of a column."""
    content = pq.read_table(path)
    values = content[column].to_numpy().copy()
    values[np.argmax(np.where(np.isfinite(values), np.abs(values), -1.0))] *= 1.0 + SMALLEST
    at = content.schema.get_field_index(column)
    pq.write_table(content.set_column(at, content.schema.field(at), pa.array(values)), path)


def test_bound_on_a_stress_holds_and_is_not_idle():
    """Sums in two orders differ by less than the bound, and by more than a ten-thousandth of it."""
    rng = np.random.default_rng(3)
    worst = 0.0
    for _ in range(50):
        sigma, q = rng.normal(size=40), 1e6 * rng.normal(size=(40, 200))
        q[-1] = -(sigma[:-1] @ q[:-1]) / sigma[-1]  # the modes cancel
        bound = stress_bound(np.abs(sigma), np.abs(q).max(axis=1), 1.0)
        apart = np.abs(sigma @ q - np.add.reduce((sigma[:, None] * q)[::-1], axis=0)).max()
        assert apart <= bound
        worst = max(worst, apart / bound)
    assert worst > 1e-4
    assert stress_bound(np.ones(2), np.array([1.0, 2.0]), -2.0) == pytest.approx(102 * UNIT * 6.0)


def test_nothing_is_forgiven_of_a_point_without_any_stress(tmp_path):
    """Zero forces: no rounding, so that the smallest damage in the table is an error."""
    folder = without_hashes(result_of(CASES["no forces of a weld"], tmp_path))
    path = folder / "nodes.parquet"
    content = pq.read_table(path)
    damage = content["damage_per_km"].to_numpy().copy()
    damage[content["weld"].to_numpy() == "B"] = 1e-80
    at = content.schema.get_field_index("damage_per_km")
    pq.write_table(content.set_column(at, content.schema.field(at), pa.array(damage)), path)
    assert not recount(folder, sample=None).passed
