"""The page of a what-if: what is changed, verdicts that flip, lives with their band, and what the numbers rest on."""

import re

import pytest

from fatigue.decide.whatif.figures import lives_figure
from fatigue.decide.whatif.page import whatif_page
from fatigue.decide.whatif.story import whatif
from tests.decide.whatif.reruns import base_case, run


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result whose welds just meet their target."""
    case = base_case("straight")
    case.mission["target_km"] = 500.0
    return run(case, tmp_path_factory.mktemp("page"), histogram="worst")


def test_flips_and_bases_stand_on_the_page(result):
    """Knobs in words, a table of verdicts that change, all bases with their meaning; nothing from outside."""
    page = whatif_page(whatif(result, ["load=2", "curve.extension=haibach"]))
    text = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert "load: all stresses times 2" in text
    assert "curve.extension from none to haibach" in text
    assert 'id="flips"' in text
    assert "✕ misses" in text
    assert "stored ranges, in classes, entered into the new curve" in text
    assert not re.findall(r'(?:src|href)="(?!#)', text)


def test_a_change_without_numbers_has_a_page(result):
    """Nothing is drawn as a life that is not known; the reason is told."""
    found = whatif(result, ["counting.residue=half"])
    page = whatif_page(found)
    assert "Nothing that is stored says what comes of" in page
    assert "counting.residue from repeat to half" in page
    assert "? not proven" in page
    figure = lives_figure(found.welds, 500.0, 500.0).plotly()
    assert [trace.name for trace in figure.data] == ["as assessed"]


def test_the_figure_has_the_band_of_every_weld(result):
    """From low to high around the life, the target and that before as lines."""
    found = whatif(result, ["load=1.5", "curve.extension=cutoff", "mission.target_km=400"])
    figure = lives_figure(found.welds, found.target_km, found.target_km_before).plotly()
    assert [shape.x0 for shape in figure.layout.shapes] == [400.0, 500.0]
    after = [trace for trace in figure.data if trace.name != "as assessed"]
    assert sum(len(trace.x) for trace in after) == len(found.welds)
    assert all((trace.error_x.array >= 0.0).all() and (trace.error_x.arrayminus >= 0.0).all() for trace in after)
