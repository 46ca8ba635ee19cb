"""A small body, and what it is reduced to, once for all tests of the room."""

import pytest

from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from tests.reduce.small_body import write_model


@pytest.fixture(scope="session")
def model(tmp_path_factory):
    """Folder of the small body; read it, never write to it."""
    return write_model(tmp_path_factory.mktemp("small_body"))


@pytest.fixture(scope="session")
def body(model, tmp_path_factory):
    """The small body with a residual basis, all modes up to 400 Hz; read it, never write to it."""
    return reduce(model, model / "interface.csv", tmp_path_factory.mktemp("reduced") / "body", Recipe(cut_hz=400.0))
