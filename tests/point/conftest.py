"""Results of the cases whose histories are looked at, each assessed once."""

from pathlib import Path

import pytest

from tests.point.cases import CASES, result_of


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Result folders by the names of their cases, assessed when first asked for."""
    made: dict[str, Path] = {}

    def of(name: str) -> Path:
        if name not in made:
            folder = tmp_path_factory.mktemp("history")
            made[name] = result_of(CASES[name](folder / "case"), folder / "result")
        return made[name]

    return of
