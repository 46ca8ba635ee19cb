"""One small study, run once: its folder is copied where a test changes something."""

import shutil

import pytest

from fatigue.study.variants import story
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


@pytest.fixture
def with_page():
    """Have the page written, which takes as long as some runs."""


@pytest.fixture(autouse=True)
def _without_page(request, monkeypatch):
    """Leave the page out of studies that are run for something else."""
    if "with_page" not in request.fixturenames:
        monkeypatch.setattr(story, "study_page", lambda of: of.title)
