"""Two results of one case, the second to take the place of the first."""

import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.report.files.export import write_csv
from fatigue.report.files.vtp import write_vtp
from tests.small_case import sine_only


@pytest.fixture(scope="module")
def two_results(tmp_path_factory):
    """An old result with documents, and a finished one of the edited case that is to take its place."""
    folder = tmp_path_factory.mktemp("two")
    case = sine_only()
    path = case.write(folder / "case")
    assess(load_case(path), folder / "old", report=False)
    for write in (write_vtp, write_csv):
        write(folder / "old")
    case.mission["target_km"] = 2e6
    assess(load_case(case.write(folder / "case")), folder / "new", report=False)
    (folder / "new" / "fatigue.log").unlink()
    return folder / "old", folder / "new"
