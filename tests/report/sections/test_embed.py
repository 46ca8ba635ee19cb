"""Data inside the page: nothing breaks out, nothing is lost."""

import json

import pytest

from fatigue.report.figures.style import figure
from fatigue.report.sections.embed import Figures, embedded


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


def test_figures_are_numbered_and_share_their_look():
    """One template on the page, none in the figures; heights are kept for the page."""
    figs = Figures()
    first, second = (figs.add(name, figure([], 300), name) for name in ("a", "b"))
    assert (first.number, second.number) == (1, 2)
    assert first.height == 300
    assert "template" not in json.loads(first.json)["layout"]
