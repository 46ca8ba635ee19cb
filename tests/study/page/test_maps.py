"""Weld maps of two variants beside each other."""

import dataclasses

import pytest

from fatigue.assess import assess
from fatigue.study.page.lives import lives_of
from fatigue.study.page.maps import weld_maps
from fatigue.study.quantities import StudyRun, Variant
from tests.small_case import small_case
from tests.study.page.studied_example import studied

VARIANTS = (Variant("base", {"factor": 1.0}), Variant("factor=2", {"factor": 2.0}))


@pytest.fixture(scope="module")
def of(tmp_path_factory):
    """A study of two variants, each assessed: the second with twice the force."""
    runs = []
    for variant in VARIANTS:
        folder = tmp_path_factory.mktemp("run")
        case = small_case()
        for event in case.events:
            event["stress_factor"] = variant.settings["factor"]
        case.write(folder)
        assess(folder / "case.toml", folder / "result", threads=1, report=False)
        runs.append(StudyRun(variant.name, 1, folder, {}, "done"))
    return studied(seeds=(1,), variants=VARIANTS, claims=(), case="case.toml", runs=runs)


def coloured(maps):
    """Marks of the weld lines in both views of each map."""
    return [trace.marker for one in maps for trace in one.drawn.plotly().data if trace.marker.cmin is not None]


def test_maps_of_two_variants_have_one_colour_scale_that_begins_at_the_shortest_life(of):
    """Side view and plan of both, in one scale, the shortest life of both in its first decade."""
    maps = weld_maps(of)
    assert [one.variant for one in maps] == ["base", "factor=2"]
    ((low, high),) = {(marker.cmin, marker.cmax) for marker in coloured(maps)}
    shortest = min(float(10.0 ** min(marker.color)) for marker in coloured(maps))
    assert 10.0**low <= shortest < 10.0 ** (low + 1)
    assert high == low + 5


def test_no_map_without_result_or_case(of, tmp_path):
    """A run whose result is gone, or a study without a case, has no maps."""
    gone = dataclasses.replace(of.runs[1], folder=tmp_path)
    assert weld_maps(dataclasses.replace(of, runs=[of.runs[0], gone])) == []
    assert weld_maps(dataclasses.replace(of, case=None)) == []


def test_lives_have_geometric_means():
    """Lives scatter by their logarithm, infinite ones as the longest that is drawn."""
    found = lives_of(studied())
    of_weld = found["base", "hanger 1"]
    assert of_weld.low < of_weld.mean < of_weld.high
    assert of_weld.mean == pytest.approx((of_weld.low * of_weld.high) ** 0.5)
    assert found["base", "roof <b>bracket</b>"].mean == 1e12
