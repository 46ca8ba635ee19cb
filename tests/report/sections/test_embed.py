"""Data inside the page: nothing breaks out, nothing is lost."""

import json

import numpy as np
import pytest

from fatigue.report.figures.style import figure
from fatigue.report.sections.embed import Figures, embedded, packed
from tests.report.reading import values


@pytest.mark.parametrize("text", ["</script>", "<!--", "]]>", "a & b", "\u2028\u2029", "שלום", '"quoted" \\ back'])
def test_no_text_breaks_out_of_its_element(text):
    """The JSON has no markup in it and reads back as it was."""
    written = embedded({"name": text})
    assert not set("<>&") & set(written)
    assert written.isascii()
    assert json.loads(written) == {"name": text}


def test_numbers_that_json_cannot_say_are_refused():
    """Infinite and missing numbers travel in arrays only."""
    with pytest.raises(ValueError, match="not JSON compliant"):
        embedded({"life": float("inf")})


@pytest.mark.parametrize(
    ("array", "dtype"),
    [
        (np.array([0, 255]), "u1"),
        (np.array([0, 256]), "u2"),
        (np.array([-1, 70_000]), "i4"),
        (np.array([2**40]), "f8"),
        (np.array([1.5, np.inf, np.nan]), "f4"),
        (np.zeros(0, dtype=np.int64), "u1"),
    ],
)
def test_arrays_take_the_smallest_type_that_holds_them(array, dtype):
    """And read back unchanged, infinite and missing values included."""
    written = packed(array)
    assert written["dtype"] == dtype
    np.testing.assert_array_equal(values(written), array)


def test_figures_are_numbered_and_share_their_look():
    """One template on the page, none in the figures; heights are kept for the page."""
    figs = Figures()
    first, second = (figs.add(name, figure([], 300), name) for name in ("a", "b"))
    assert (first.number, second.number) == (1, 2)
    assert first.height == 300
    assert "template" not in json.loads(first.json)["layout"]
