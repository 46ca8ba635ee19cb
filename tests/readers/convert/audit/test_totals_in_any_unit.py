"""Totals of grids compared with their rows: the same finding whatever unit the forces are in."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.readers.convert.audit.grid_totals import check_totals
from fatigue.readers.foreign.fe.results import TOTALS, FeResults


def results(spoilt=0.0, scale=1.0):
    """Two modes, three grids with two element rows, a load and a total each; one total may be off by a share."""
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(2, 3, 3, 6)) * [1, 1, 1, 20, 20, 20]
    total = rows.sum(axis=2, keepdims=True)
    total[1, 2, 0, 1] += spoilt * np.abs(rows[1, 2, :, :3]).max()
    force = scale * np.concatenate([rows, total], axis=2).reshape(2, 12, 6)
    return FeResults(
        source="run.pch",
        solver="",
        analysis="static",
        mode=np.array([1, 2]),
        frequency=np.full(2, np.nan),
        modal_mass=np.full(2, np.nan),
        node=np.repeat([11, 12, 13], 4),
        element=np.tile([21, 22, 0, 0], 3),
        kind=np.array(["QUAD4", "QUAD4", "APP-LOAD", TOTALS] * 3),
        force=force,
        shape_node=np.zeros(0, np.int64),
        shape=np.zeros((2, 0, 6)),
    )


@pytest.mark.parametrize("spoilt", [0.0, 0.02, 0.5])
def test_forces_in_another_unit_are_judged_alike(spoilt):
    """Every number of the finding but the sizes of forces; a damaged total is found with its grid and mode."""
    found = check_totals(results(spoilt), None)
    for scale in (1e-6, 1e6):
        other = check_totals(results(spoilt, scale), None)
        assert (other.rule, other.is_checksum, other.is_met) == (found.rule, found.is_checksum, found.is_met)
        assert other.residual == pytest.approx(found.residual, rel=1e-6, abs=1e-12)
        assert (other.rest, other.rest_grid) == (pytest.approx(found.rest, rel=1e-6), found.rest_grid)
    assert found.is_met == (spoilt == 0.0)
    sound, forces = results().force[1, 8:, :3], results(spoilt).force[1, 8:, :3]  # of grid 13 in mode 2, its total too
    assert found.residual == pytest.approx(np.abs(forces - sound).max() / np.abs(forces).max(), rel=1e-9, abs=1e-12)
    if spoilt:
        assert (found.grid, found.mode) == (13, 2)


def test_without_totals_there_is_nothing_to_compare():
    """Rows of elements and loads alone."""
    some = results()
    kept = ~some.of_total
    without = replace(
        some, node=some.node[kept], element=some.element[kept], kind=some.kind[kept], force=some.force[:, kept]
    )
    assert check_totals(without, None) is None
