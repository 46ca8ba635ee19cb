"""What a cell of a table says, and the value it is sorted by."""

import numpy as np
import pandas as pd

from fatigue.report.sections.cells import Cell, integer, linked, num, percent, span, text, verdict
from fatigue.report.wording import NOT_AVAILABLE


def test_what_is_missing_is_a_dash():
    """Missing numbers sort after every number, an infinite one included; missing texts are dashes."""
    assert num(None).text == num(np.nan).text == integer(pd.NA).text == text("").text == NOT_AVAILABLE
    assert num(1e9).value < num(np.inf).value < num(np.nan).value
    assert percent(np.nan).value < percent(-1.0).value


def test_cells_are_sorted_by_their_numbers():
    """The text is rounded and grouped, the value is not."""
    assert num(0.62561) == Cell("0.6256", 0.62561)
    assert integer(12345, grouped=True).text != integer(12345).text == "12345"
    assert verdict(True).value > verdict(False).value


def test_a_span_is_one_number_where_both_ends_are_equal():
    """It is sorted by its lower end."""
    assert span(8.0, 8.0).text == "8.000"
    assert span(8.0, 10.0) == Cell("8.000 to 10.00", 8.0)
    assert span(np.nan, np.nan).text == NOT_AVAILABLE


def test_only_welds_with_a_page_are_linked():
    """Another weld has its name and no link."""
    assert linked("W1", {"W1": "weld-1"}).link == "weld-1"
    assert not linked("W2", {"W1": "weld-1"}).link
