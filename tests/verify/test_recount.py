"""The recount agrees with what the pipeline writes, finds what is spoiled in it, and refuses other inputs."""

import json
import shutil
import subprocess
import sys
from itertools import zip_longest
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.results import TABLES, json_ready, schema
from fatigue.verify.recount import Recount, recount
from tests.older_result import without_hashes
from tests.verify.tiny_case import TinyCase, write_case

OWN_CURVE = """[curves.mine]
slopes = [3.0, 5.0]
knees_cycles = [1e7, 1e8]
range_at_2e6_MPa = 18.0
applies = "structural"
source = "a test"
thickness_reference_mm = 25.0
thickness_exponent = 0.3
"""
SCATTERED_CURVE = """[curves.mine]
slopes = [3.0, 4.0, 5.0]
knees_cycles = [1e5, 1e7]
range_at_2e6_MPa = 18.0
applies = "dS"
source = "a test"
log10_scatter = 0.2
"""
CASES = {
    "straight": TinyCase(),
    "haibach, mean stress, asme thickness, half, upsampled": TinyCase(
        curve='name = "master-steel"\nsurvival = "mean-3sigma"\nthickness_rule = "asme"\nextension = "haibach"\n'
        'knee_cycles = 1e6\nmean_stress = "asme"\nyield_MPa = 12.0',
        counting='residue = "half"\nupsample = 4',
        dead_load=3.0,
    ),
    "own curve with cut-off, on_node, scales, ignored mode, auto upsampling, csv": TinyCase(
        body='force_convention = "on_node"\nignore_modes = [99]',
        curve='name = "mine"',
        curves=OWN_CURVE,
        seam_curve="iiw-aluminium-40",
        counting='upsample = "auto"',
        spectrum="segment_s = 1.2",
        scale=(1.0, 2.0, -0.5, 1.0),
        extra_mode=True,
        files="csv",
        samples=241,
    ),
    "element forces, kinks, cut-off extension": TinyCase(
        curve='name = "master-aluminium"\nextension = "cutoff"\nsurvival = "mean"',
        spectrum="segment_s = 1.0\nupper_hz = 21.0",
        by_element=True,
        welds=("angle", "square", "curved"),
    ),
    "own curve in dS with scatter, a weld without forces, an event at rest": TinyCase(
        curve='name = "mine"\nsurvival = "mean-1sigma"',
        curves=SCATTERED_CURVE,
        welds=("curved", "ring", "short"),
        dead="ring",
        still="smooth",
    ),
}


OF_SMALL_CYCLES = 1e-8  # a class below 1e-3 MPa holds small cycles alone: 1e-14 of the largest is as much of them


def assessed(folder: Path, tiny: TinyCase) -> Path:
    """Assess a tiny case; return its result folder."""
    assess(load_case(write_case(folder / "case", tiny)), folder / "result", threads=1, report=False)
    return folder / "result"


def differing(found: Recount) -> set[str]:
    """Name the columns that do not agree."""
    return {f"{column.table}.{column.column}" for column in found.columns if not column.passed}


@pytest.mark.parametrize("name", CASES)
def test_pipeline_and_recount_agree(tmp_path, name):
    """Two programs that share no code agree to rounding in every column of every point, whatever the rules."""
    result = assessed(tmp_path, CASES[name])
    found = recount(result, sample=None)
    assert found.passed, found.as_text()
    of_few = recount(result, sample=1, most_samples=1)  # and all rows belong together
    assert of_few.passed, of_few.as_text()
    assert {"nodes, all rows", "damage, all rows", "welds, all rows"} <= {column.table for column in of_few.columns}
    assert found.points == found.points_in_all > 40
    wider = ("load_factor", "power_sum_per_pass", "multiaxial_bound")  # the last is raised by 1e-9 of the range
    rounding = {c.column: c.difference for c in found.columns if c.column not in wider}
    assert max(rounding.values()) < 1e-10, rounding
    assert all(c.difference < OF_SMALL_CYCLES for c in found.columns if c.column == "power_sum_per_pass")
    load_factors = [c for c in found.columns if c.column == "load_factor"]
    assert all(c.difference < (1e-10 if name == "straight" else 0.02) for c in load_factors)


def test_the_shipped_example_agrees(example_result):
    """The worst point of every weld of the car body, and five others, agree to 1e-9."""
    found = recount(example_result, sample=5)
    assert found.passed, found.as_text()
    assert 14 + 5 <= found.points < found.points_in_all
    looser = ("power_sum_per_pass", "multiaxial_bound")  # the bound is raised by more than its rounding
    assert max(column.difference for column in found.columns if column.column not in looser) < 1e-9
    assert all(c.difference < OF_SMALL_CYCLES for c in found.columns if c.column == "power_sum_per_pass")


def test_the_recount_shares_no_code_with_the_pipeline():
    """Importing it loads nothing of the line solver, the counting, the spectra, the case models or the pipeline."""
    code = (
        "import sys, fatigue.verify.recount\n"
        "allowed = ('fatigue.errors', 'fatigue.shown', 'fatigue.files', 'fatigue.results', 'fatigue.verify',\n"
        "           'fatigue.side_by_side')\n"  # threads that log, and no number
        "print([m for m in sys.modules if m.startswith('fatigue.') and not m.startswith(allowed)])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# ------------------------------------------------------------------------------------------------ spoiled results

POINT = {"weld", "part", "order", "surface"}
NOT_RECOUNTED = {  # keys of the rows, which a test below spoils, and what no number stands behind
    "nodes": POINT | {"dirlik_verdict", "screened"},
    "damage": POINT | {"event", "node", "verdict"},
    "structural_stress": POINT | {"mode"},
    "cycles": POINT | {"event", "node"},
    "histogram": POINT | {"event", "node", "kind", "bin"},
    "band": {column.name for column in TABLES["band"]} - {"life_km"},  # no band by so short a record
    "path_cycles": POINT | {"event", "node"},
    "sensitivity": {"variant", "weld", "basis", "recounted", "note"},
    "welds": {"weld", "status", "reason", "description", "survival"},
}
CHECKED = {
    table: [column.name for column in TABLES[table] if column.name not in others]
    for table, others in NOT_RECOUNTED.items()
}
ROUNDS = [
    [(table, name) for table, name in zip(CHECKED, names, strict=True) if name]
    for names in zip_longest(*CHECKED.values())
]


@pytest.fixture(scope="module")
def short_result(tmp_path_factory) -> Path:
    """Result of one short open weld, which meets its target by normal stress alone, so that its paths are counted."""
    tiny = TinyCase(welds=("short",), samples=120, spectrum="segment_s = 0.3", scale=(0.05,) * 4)
    return assessed(tmp_path_factory.mktemp("short"), tiny)


@pytest.fixture
def copy_of_short(tmp_path, short_result) -> Path:
    """Copy the result and its inputs, to be spoiled."""
    shutil.copytree(short_result.parent, tmp_path / "short")
    return without_hashes(tmp_path / "short" / "result")  # which would tell of every change


def edit(folder: Path, table: str, change) -> None:
    """Change a result table through pandas, keeping its schema and metadata."""
    frame = pq.read_table(folder / f"{table}.parquet").to_pandas()
    frame = change(frame)
    pq.write_table(pa.Table.from_pandas(frame, schema=schema(table), preserve_index=False), folder / f"{table}.parquet")


def spoil(folder: Path, table: str, column: str) -> None:
    """Change one value of a column, a number by a thousandth of itself."""

    def change(frame: pd.DataFrame) -> pd.DataFrame:
        values = frame[column]
        if values.dtype == bool or any(isinstance(value, bool) for value in values):
            row = values.first_valid_index()
            frame.loc[row, column] = not values[row]
        elif pa.types.is_integer(schema(table).field(column).type):  # with empty cells pandas has floats
            row = values.first_valid_index()
            frame.loc[row, column] = values[row] + 1
        elif values.dtype.kind == "f":
            known = values[np.isfinite(values) & (values != 0.0)]
            if column == "multiaxial_bound":  # exact where the path was counted; elsewhere it may be larger
                known = known[frame["utilisation_path_range"].notna()]
            row = known.abs().idxmax() if len(known) else 0
            frame.loc[row, column] = known[row] * 1.001 if len(known) else 7.0
        else:
            frame.loc[0, column] = f"not {values[0]}"
        return frame

    edit(folder, table, change)


def test_the_unspoiled_result_agrees(short_result):
    """What the next test spoils is in order before; every column it spoils is recounted."""
    found = recount(short_result, sample=None)
    assert found.passed, found.as_text()
    recounted = [(c.table, c.column) for c in found.columns if c.unit != "rows"]
    assert sorted(recounted) == sorted((table, name) for table, names in CHECKED.items() for name in names)


@pytest.mark.parametrize("spoiled", ROUNDS, ids=lambda spoiled: ",".join(".".join(column) for column in spoiled))
def test_one_spoiled_value_is_found(copy_of_short, spoiled):
    """A single changed value in a table is found in exactly its column, and named with its place.

    One value is spoiled in each table at a time, so that every column has its turn in few recounts.
    """
    for table, column in spoiled:
        spoil(copy_of_short, table, column)
    found = recount(copy_of_short, sample=None)
    assert differing(found) == {f"{table}.{column}" for table, column in spoiled}
    lines = found.as_text().splitlines()
    for table, column in spoiled:
        (line,) = (line for line in lines if line.startswith(f"  {table}.{column}: "))
        assert " where the recount has " in line
        assert "weld short" in line


@pytest.mark.parametrize("table", ["nodes", "damage", "structural_stress", "welds", "sensitivity"])
@pytest.mark.parametrize("fault", ["dropped", "twice"])
def test_a_row_too_few_or_too_many_is_found(copy_of_short, table, fault):
    """No row of a table may be missing or be there twice."""
    edit(copy_of_short, table, lambda frame: frame[1:] if fault == "dropped" else pd.concat([frame, frame[:1]]))
    found = recount(copy_of_short, sample=None)
    (wrong,) = (column for column in found.columns if not column.passed)
    assert (wrong.table, wrong.difference, wrong.unit) == (table, 1.0, "rows")
    assert wrong.found == wrong.expected + (-1 if fault == "dropped" else 1)
    assert "short" in wrong.where


def test_a_dropped_cycle_is_found(copy_of_short):
    """A cycle that is missing shows in every column but those that loops alone fill."""
    edit(copy_of_short, "cycles", lambda frame: frame.drop(index=frame["range_MPa"].idxmax()))
    assert differing(recount(copy_of_short, sample=None)) == {
        f"cycles.{column}" for column in CHECKED["cycles"] if column not in ("start_event", "end_event")
    }


def test_a_weld_without_cycles_is_found(copy_of_short):
    """An empty table of cycles does not pass for one without differences."""
    edit(copy_of_short, "cycles", lambda frame: frame[:0])
    assert "cycles.range_MPa" in differing(recount(copy_of_short, sample=0))


def test_a_bound_below_the_counted_sum_is_found(copy_of_short):
    """A bound of the sum by path range below this sum is found, wherever it is."""

    def lowered(frame: pd.DataFrame) -> pd.DataFrame:
        row = frame.index[frame["toe"]][-1]
        frame.loc[row, "multiaxial_bound"] *= 0.1
        return frame

    edit(copy_of_short, "nodes", lowered)
    assert "nodes.multiaxial_bound" in differing(recount(copy_of_short, sample=None))


@pytest.mark.parametrize("fault", ["dropped", "swapped ends"])
def test_faults_in_half_cycles_are_found(copy_of_short, fault):
    """A half cycle that is missing, and one between other instants, show."""

    def change(frame: pd.DataFrame) -> pd.DataFrame:
        row = frame["range_MPa"].idxmax()
        if fault == "dropped":
            return frame.drop(index=row)
        frame.loc[row, ["start_s", "end_s"]] = frame.loc[row, ["end_s", "start_s"]].to_numpy()
        return frame

    edit(copy_of_short, "path_cycles", change)
    found = differing(recount(copy_of_short, sample=None))
    assert "path_cycles.start_s" in found
    assert ("path_cycles.range_MPa" in found) == (fault == "dropped")


# ------------------------------------------------------------------------------------------------- what is chosen


def test_the_sample_holds_every_worst_point(tmp_path):
    """The worst points, and that with half cycles, are always recounted; the seed draws the others, always the same."""
    result = assessed(tmp_path, TinyCase(welds=("seam", "curved", "short"), samples=150, spectrum="segment_s = 0.3"))
    none = recount(result, sample=0)
    assert none.passed
    assert none.points == 3 + 1
    assert recount(result, sample=4, seed=1).points == 4 + 4
    assert recount(result, sample=1000).points == none.points_in_all == 30

    def place(seed: int) -> list[str]:
        found = recount(result, sample=4, seed=seed)
        return [c.where for c in found.columns if c.column in ("max_range_MPa", "life_km_tb", "kurtosis")]

    assert place(1) == place(1)


# ------------------------------------------------------------------------------------------------ screened points

BOUNDS = {"damage_per_km": 2.0, "life_km": 0.5, "life_years": 0.5, "utilisation": 2.0, "max_range_MPa": 1.5}
EMPTY = ["R_largest_cycle", "mean_stress_MPa", "governing_event", "load_factor", "life_km_same_ratio", "dirlik_ratio"]


def screen(folder: Path, factor: float) -> None:
    """Turn the first point into a screened one, its bounds safe with the factor 1, unsafe with -1."""

    def nodes(frame: pd.DataFrame) -> pd.DataFrame:
        frame.loc[0, "screened"] = "range"
        for column, bound in BOUNDS.items():
            frame.loc[0, column] *= bound**factor
        frame.loc[0, EMPTY] = None
        return frame

    def damage(frame: pd.DataFrame) -> pd.DataFrame:
        key = ["weld", "part", "order", "surface"]
        rows = (frame[key] == frame.loc[0, key]).all(axis=1)
        frame.loc[rows, ["damage_per_km", "damage_per_pass", "max_range_MPa"]] *= 2.0**factor
        frame.loc[rows, ["cycles_per_pass", "cycles_per_km", "kurtosis", "damage_same_ratio_per_pass"]] = None
        return frame

    edit(folder, "nodes", nodes)
    edit(folder, "damage", damage)


def test_bounds_of_a_screened_point_may_be_wide(copy_of_short):
    """A screened row may be on the safe side of the recount, and empty where it knows nothing."""
    screen(copy_of_short, 1.0)
    found = recount(copy_of_short, sample=None)
    assert found.passed, found.as_text()


def test_bounds_of_a_screened_point_must_hold(copy_of_short):
    """A bound on the wrong side of the recount is found, for damage, life and range."""
    screen(copy_of_short, -1.0)
    assert differing(recount(copy_of_short, sample=None)) == {
        *(f"nodes.{column}" for column in BOUNDS),
        *(f"damage.{column}" for column in ("damage_per_km", "damage_per_pass", "max_range_MPa")),
    }


def test_dirlik_of_a_screened_point_is_exact(copy_of_short):
    """The frequency domain is computed for every point, so it has no safe side."""
    screen(copy_of_short, 1.0)
    edit(copy_of_short, "nodes", lambda frame: frame.assign(dirlik_ratio=frame["dirlik_ratio"] * 0.99))
    assert differing(recount(copy_of_short, sample=None)) == {"nodes.dirlik_ratio"}


# --------------------------------------------------------------------------------------------------------- inputs


def test_changed_and_missing_inputs_are_refused_by_name(copy_of_short):
    """Every input that is not what it was is named; nothing is compared then."""
    case = copy_of_short.parent / "case"
    with (case / "modes.csv").open("a") as file:
        file.write("\n")
    (case / "q_load.csv").unlink()
    with pytest.raises(DataError) as refusal:
        recount(copy_of_short)
    changed, missing = refusal.value.problems
    assert (changed.code, Path(changed.where).name) == ("changed_input", "modes.csv")
    assert "SHA-256" in changed.what
    assert (missing.code, Path(missing.where).name) == ("missing_input", "q_load.csv")
    assert missing.remedy == "Put the file back, or assess again"


def test_a_case_that_moved_is_asked_for_and_may_be_named(copy_of_short, tmp_path):
    """Without the case at its old place the refusal says so; with its new place the recount goes on."""
    moved = tmp_path / "elsewhere"
    (copy_of_short.parent / "case").rename(moved)
    with pytest.raises(DataError, match=r"case\.toml: the case of this result is not there\. Name the case file"):
        recount(copy_of_short)
    assert recount(copy_of_short, sample=0, case_file=moved / "case.toml").passed


def test_a_folder_without_result_is_refused(tmp_path):
    """There is nothing to recount in an empty folder."""
    with pytest.raises(DataError, match="no finished result in this folder"):
        recount(tmp_path)


# -------------------------------------------------------------------------------------------------- what it tells


def test_text_and_record_of_a_recount(short_result, copy_of_short):
    """The text names points, tables and largest differences; the record says the same to machines."""
    good = recount(short_result, sample=2)
    head, *tables = good.as_text().splitlines()
    assert head.endswith(f": {good.points} of 4 points recounted from the input files: agree with the recount")
    assert [line.split(":")[0].strip() for line in tables] == [
        "nodes",
        "damage",
        "structural_stress",
        "welds",
        "cycles",
        "histogram",
        "band",
        "path_cycles",
        "sensitivity",
    ]
    spoil(copy_of_short, "nodes", "life_km")
    bad = recount(copy_of_short, sample=None)
    record = json.loads(json.dumps(json_ready(bad.as_record()), allow_nan=False))
    assert record["passed"] is False
    (wrong,) = (column for column in record["columns"] if not column["passed"])
    assert (wrong["table"], wrong["column"], wrong["unit"]) == ("nodes", "life_km", "km")
    assert wrong["difference"] == pytest.approx(1e-3, rel=1e-6)
    assert wrong["found"] == pytest.approx(1.001 * wrong["expected"])
    text = bad.as_text().splitlines()
    assert text[0].endswith(f"1 of {len(bad.columns)} columns differ")
    assert f"{wrong['expected']:.10g} km (difference 0.001, weld short, part 1" in text[1]
