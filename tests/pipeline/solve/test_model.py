"""Welds solved: blocks like the whole, and a number beyond all bounds names its weld."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.errors import NumericalError
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import read_model, solve_group
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.small_case import small_case


def test_a_number_beyond_all_bounds_names_its_weld(tmp_path):
    """Forces near the largest number there is on a thin plate, at the second of two welds."""
    case = small_case()
    huge = (case.nodal_forces.weld == "B") & (case.nodal_forces["mode"] == 1)
    case.nodal_forces["mx_Nmm"] = case.nodal_forces["mx_Nmm"].where(~huge, 1e308)
    case.weld_nodes.loc[case.weld_nodes.weld == "B", "thickness_mm"] = 0.2
    with pytest.raises(NumericalError, match="weld B: the structural stress per unit modal coordinate exceeds"):
        read_model(load_case(case.write(tmp_path)), strict=False)


def arrays_of(stations):
    """Every array of a table of stations, those of its parts as well."""
    for part in fields(stations):
        value = getattr(stations, part.name)
        if isinstance(value, np.ndarray):
            yield value
        elif part.name != "welds":
            yield from arrays_of(value)


def test_blocks_of_a_group_are_solved_like_the_whole(tmp_path, monkeypatch):
    """Every column of the stations, also the stress before the end treatment and where that is."""
    case = small_case(pairs=3)
    case.nodal_forces["mx_Nmm"] *= 1.0 + 0.01 * case.nodal_forces["node"] % 7
    body = read_body(load_case(case.write(tmp_path)), strict=False)
    whole = solve_group(weld_groups(body, tmp_path / "a"), 0)
    monkeypatch.setattr("fatigue.pipeline.solve.weld_groups.BLOCK", 8)
    groups = weld_groups(body, tmp_path / "b")
    assert max(len(blocks) for blocks in groups.blocks_of) > 1
    assert sum(len(blocks) for blocks in groups.blocks_of) == len(groups.blocks)
    parts = solve_group(groups, 0)
    assert whole.stations.raw_ends.rows.size > 0
    assert parts.stations.welds == whole.stations.welds
    for a, b in zip(arrays_of(whole.stations), arrays_of(parts.stations), strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-12)
    assert parts.warnings == whole.warnings
    assert parts.lines.weld == whole.lines.weld
