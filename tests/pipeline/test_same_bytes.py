"""Every table has the same bytes however a case with all kinds of checks is run."""

from concurrent.futures import ThreadPoolExecutor

import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from tests.small_case import small_case
from tests.stress_point_case import curve_text, point, stresses, write_points
from tests.throat_case import CURVES, HEAD, row

CHECKS = """
[curves.sheared]
slopes = [5.0]
knees_cycles = [1e8]
range_at_2e6_MPa = 28.0
applies = "structural"
quantity = "shear"
source = "invented"
[checks]
static_cases = "cases.csv"
endurance_lines = "lines.csv"
[[checks.interaction]]
rule = "iiw"
cv = 0.5
damage_limit = 0.5
[[checks.endurance]]
cases = "ride"
perp = "across"
shear = "along"
limit = 1.0
[multiaxial]
method = "{method}"
"""
CASES = """case,kind,group,factor,q_1,q_2,q_7
dead,static,ride,1,,,1
pitch,alternating,ride,2,1,,
roll,alternating,ride,2,,1,
"""
LINES = """line,component,R,stress_max_MPa,edition,clause
across,perp,-1,60,invented,none
across,perp,0.5,126,invented,none
along,shear,-1,35,invented,none
along,shear,0.5,70,invented,none
"""


def everything(folder, method):
    """A case of three groups of welds with throats, stress points, interaction, endurance and shear."""
    case = small_case(seconds=2.0, pairs=8)
    case.curve = {"name": "plate"}
    case.welds["curve_shear"] = "sheared"
    case.body |= {"weld_throats": "weld_throats.csv"}
    case.extra += (
        CURVES + CHECKS.format(method=method) + curve_text("plate", 60.0, "structural", slopes=(3.0, 5.0), knees=(1e7,))
    )
    case.extra += curve_text("points", 20.0) + curve_text("metal", 60.0, "parent")
    names = case.welds.weld.tolist()
    points = [point("spot", weld="A"), *(point(f"metal{i}", "parent", curve="metal") for i in range(40))]
    of = {mode: (2.0 + mode, 1.0, 0.5 * mode) for mode in (1, 2, 7)}
    tables = [stresses("spot", of, (3.2, 8.0)), *(stresses(f"metal{i}", of) for i in range(40))]
    path = write_points(case, folder, points, tables)
    throats = [row(weld, "both" if weld[0] == "A" else "top", "throat") for weld in names]
    (folder / "weld_throats.csv").write_text("\n".join([HEAD, *throats]) + "\n")
    (folder / "cases.csv").write_text(CASES)
    (folder / "lines.csv").write_text(LINES)
    return path


@pytest.mark.parametrize("method", ["report", "range"])
def test_the_bytes_do_not_depend_on_how_it_is_run(tmp_path, method):
    """One thread, three, an executor, and a run that was interrupted and goes on; whether shear decides or not."""
    case = everything(tmp_path / "case", method)
    assess(case, tmp_path / "one", threads=1, report=False)
    assess(case, tmp_path / "three", threads=3, report=False)
    with ThreadPoolExecutor(2) as executor:
        assess(case, tmp_path / "executor", executor=executor, report=False)

    def stop(label, done, total):
        raise RuntimeError

    with pytest.raises(RuntimeError):
        assess(case, tmp_path / "resumed", threads=1, report=False, progress=stop)
    resumed = assess(case, tmp_path / "resumed", threads=1, report=False)
    assert 0 < resumed.groups_reused < resumed.groups
    checks = set(pq.read_table(tmp_path / "one" / "checks.parquet")["check"].to_pylist())
    throats = {"throat_perp", "throat_par", "throat_root"}
    at_toes = {"toe_multiaxial"} if method == "range" else set()
    assert checks == throats | at_toes | {"hot_spot", "parent", "interaction", "endurance"}
    tables = sorted(path.name for path in (tmp_path / "one").glob("*.parquet"))
    assert {"checks.parquet", "sensitivity.parquet", "path_cycles.parquet", "welds.parquet"} <= {*tables}
    for run in ("three", "executor", "resumed"):
        for name in tables:
            one, other = ((tmp_path / folder / name).read_bytes() for folder in ("one", run))
            if one != other:
                first, again = (pq.read_table(tmp_path / folder / name).to_pandas() for folder in ("one", run))
                raise AssertionError(f"{name} of {run}:\n{first.compare(again)}")
