"""What several tests share: results assessed once per run."""

from pathlib import Path

import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from tests.small_case import small_case

EXAMPLE = Path(__file__).parents[1] / "data" / "carbody"


@pytest.fixture(scope="session")
def small_result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Result folder of the small case; read it, never write to it."""
    folder = tmp_path_factory.mktemp("small")
    assess(load_case(small_case().write(folder / "case")), folder / "result", threads=2, report=False)
    return folder / "result"


@pytest.fixture(scope="session")
def example_result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Result folder of the shipped car body; read it, never write to it."""
    folder = tmp_path_factory.mktemp("carbody")
    assess(load_case(EXAMPLE / "case.toml"), folder / "result", threads=2)
    return folder / "result"
