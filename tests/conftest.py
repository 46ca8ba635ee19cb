"""What several tests share: results assessed once per run."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.report.figures import Figure
from tests.small_case import small_case

MOST_WORKERS = 8  # each of them holds up to 1 GB

EXAMPLE = Path(__file__).parents[1] / "data" / "carbody"


settings.register_profile("no deadline", deadline=None)  # a busy machine is no fault, nor is what compiles first
settings.load_profile("no deadline")


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """Run the whole suite on all processors, what is named on the command line in one process: that begins sooner."""
    is_whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS and "PYTEST_XDIST_WORKER" not in os.environ
    can_share = config.pluginmanager.hasplugin("xdist") and not config.option.usepdb
    if is_whole and can_share and config.option.numprocesses is None:
        processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        config.option.numprocesses, config.option.dist = min(MOST_WORKERS, processors), "worksteal"


@pytest.fixture(scope="session", autouse=True)
def checked_figures() -> Iterator[None]:
    """Every figure that any test puts on a page is checked by plotly: an attribute or value it does not know fails."""
    content = Figure.content

    def checked(figure: Figure) -> dict[str, Any]:
        figure.plotly()
        return content(figure)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "content", checked)
        yield


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
