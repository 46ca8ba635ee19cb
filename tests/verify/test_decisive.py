"""The recount takes the verdict of a weld from its toes and from the checks that count."""

import shutil
from pathlib import Path

import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.verify.recount.folder import recount
from tests.older_result import without_hashes
from tests.small_case import small_case
from tests.throat_case import row, with_throats

COUNTS = '[checks]\ncounts = ["throat_root"]\n'


@pytest.fixture(scope="module")
def failed_by_a_root(tmp_path_factory):
    """A result whose toes last, and in which the root of weld B decides."""
    folder = tmp_path_factory.mktemp("decisive")
    case = small_case(seconds=4.0)
    case.mission["target_km"] = 50.0
    path = with_throats(case, folder / "case", [row("A", "both"), row("B", "top", "throat")], COUNTS)
    assert not assess(path, folder / "out", threads=1, report=False).fulfilled
    return folder


def verdicts(folder: Path):
    """Verdicts of the welds, and the checks of the recount that did not pass."""
    welds = pd.read_parquet(folder / "welds.parquet").set_index("weld")
    failed = [check.column for check in recount(folder, sample=None).columns if not check.passed]
    return welds.fulfilled.to_dict(), failed


def test_a_verdict_by_a_check_agrees(failed_by_a_root):
    """The toes of both welds are fulfilled, and the root of B is not: nothing differs."""
    assert verdicts(failed_by_a_root / "out") == ({"A": True, "B": False}, [])


def test_a_verdict_without_its_check_is_found(failed_by_a_root, tmp_path):
    """A weld called fulfilled although its check failed is told, also where only the tables are compared."""
    shutil.copytree(failed_by_a_root, tmp_path / "copy")
    folder = tmp_path / "copy" / "out"
    table = pq.read_table(folder / "welds.parquet")
    place = table.column_names.index("fulfilled")
    spoilt = table.set_column(place, table.schema.field("fulfilled"), [[True, True]])
    pq.write_table(spoilt, folder / "welds.parquet")
    without_hashes(folder)
    assert verdicts(folder)[1] == ["fulfilled"]
    few = recount(folder, sample=2, most_samples=0)
    assert "fulfilled" in [check.column for check in few.columns if not check.passed]
