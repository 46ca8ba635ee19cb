"""Result folders and pages shared by the tests of the report."""

import pytest

from fatigue.report.page import report_page
from tests.report.reading import Page
from tests.report.tiny_result import write_result


@pytest.fixture(scope="session")
def result_folder(tmp_path_factory):
    """Finished result of two welds and two events, the case and the histories beside it."""
    return write_result(tmp_path_factory.mktemp("tiny"))


@pytest.fixture(scope="session")
def html(result_folder):
    """Report of that result as text."""
    return report_page(result_folder)


@pytest.fixture(scope="session")
def page(html):
    """Report of that result, parsed."""
    return Page(html)
