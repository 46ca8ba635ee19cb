"""One small study, run once: its folder is copied where a test changes something."""

import shutil

import pytest

from fatigue.study.variants.story import run_study
from tests.study.variants.small_study import small_study


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """Folder with the small study and its output ``out``, and what was found."""
    folder = tmp_path_factory.mktemp("study")
    found = run_study(small_study(folder), folder / "out", threads=2)
    return folder, found


@pytest.fixture
def copied(finished, tmp_path):
    """The same folder, to be changed."""
    return shutil.copytree(finished[0], tmp_path / "study")
