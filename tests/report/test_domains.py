"""Time and frequency domain at all points, read without reading all of the tables."""

import numpy as np
import pandas as pd
import pytest

from fatigue.report import domains
from fatigue.report.domains import read_domains
from tests.report.tiny_result import Recipe, write_result


def test_points_have_the_kurtosis_of_their_governing_event(result_folder):
    """Row by row that of the table of damage."""
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    damage = pd.read_parquet(result_folder / "damage.parquet")
    found = read_domains(result_folder, ["tangent", "curve"])
    key = ["weld", "node", "surface"]
    expected = nodes[[*key, "governing_event"]].merge(
        damage[[*key, "event", "kurtosis"]], left_on=[*key, "governing_event"], right_on=[*key, "event"]
    )
    np.testing.assert_array_equal(found.drawn["kurtosis"], expected["kurtosis"])
    np.testing.assert_array_equal(found.ratio, nodes["dirlik_ratio"])


def test_verdicts_are_counted_most_first(result_folder):
    """Every point has one."""
    found = read_domains(result_folder, ["tangent", "curve"])
    counts = pd.read_parquet(result_folder / "nodes.parquet")["dirlik_verdict"].value_counts()
    assert dict(found.verdicts) == counts.to_dict()
    assert [count for _, count in found.verdicts] == sorted(counts, reverse=True)


def test_of_very_many_points_a_part_is_read(result_folder, monkeypatch):
    """The ratio is that of all points, the rows are those that are drawn."""
    all_drawn = domains.drawn_points
    monkeypatch.setattr(domains, "drawn_points", lambda points: all_drawn(points, most=5))
    found = read_domains(result_folder, ["tangent", "curve"])
    assert (len(found.drawn), len(found.ratio)) == (5, 24)


@pytest.mark.parametrize("recipe", [Recipe(level=0.0), Recipe(spectrum=False)])
def test_without_an_estimate_there_is_nothing_to_draw(tmp_path, recipe):
    """Nothing damages, or no event has a spectrum."""
    found = read_domains(write_result(tmp_path, recipe), ["tangent", "curve"])
    assert (len(found.drawn), len(found.ratio)) == (0, 0)
