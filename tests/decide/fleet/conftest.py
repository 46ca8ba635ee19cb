"""What the tests of a fleet share."""

from pathlib import Path

import pytest

from tests.decide.fleet.fleet_case import fleet_folder


@pytest.fixture(scope="package")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The fleet of the docs with its results; read it, never write to it."""
    return fleet_folder(tmp_path_factory.mktemp("fleet"))
