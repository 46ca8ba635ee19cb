"""Totals of grids: sums of rows, loads less forces on elements, or sums that hide an inertia force."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.readers.convert.audit.grid_totals import check_totals
from fatigue.readers.foreign.fe.results import TOTALS
from tests.readers.convert.audit.test_audit import only
from tests.readers.tee_model import tee


def as_on_element(results, hides_inertia):
    """The rows and totals as a solver writes them that gives forces on elements.

    Totals are loads less forces on elements, with ``hides_inertia`` less the inertia force that has no row, too.
    """
    is_total = results.kind == TOTALS
    force = np.where(is_total[:, None], 0.0 if hides_inertia else 1.0, -1.0) * results.force
    return replace(results, force=force)


def spoiled(results, mode, row):
    """One number of the results changed by two hundredths of the largest."""
    force = results.force.copy()
    force[mode, row, 2] += 0.02 * np.nanmax(np.abs(force[mode, :, :3]))
    return replace(results, force=force)


@pytest.mark.parametrize("convention", ["on_node", "on_element", None])
def test_sums_of_rows_and_differences_are_met(convention):
    """Either rule is found, whatever is known of the sign."""
    for results in (tee().results, as_on_element(tee().results, hides_inertia=False)):
        found = check_totals(results, convention)
        assert found.is_met
        assert found.residual < 1e-9


def test_totals_with_a_hidden_inertia_are_no_checksum():
    """They vanish, or belong to forces on elements; a static case has no inertia to hide."""
    modal = as_on_element(tee().results, hides_inertia=True)
    for convention in ("on_element", None):
        found = check_totals(modal, convention)
        assert not found.is_met
        assert not found.is_checksum
    assert check_totals(replace(modal, analysis="static"), "on_element").is_checksum


@pytest.mark.parametrize("row", [0, 40, 200])
def test_a_spoiled_number_is_found_where_it_is(row):
    """In a file with either rule that can be met, the grid and mode are named."""
    static = replace(as_on_element(tee().results, hides_inertia=False), analysis="static")
    for results, convention in ((tee().results, "on_node"), (static, "on_element")):
        found = check_totals(spoiled(results, 2, row), convention)
        assert not found.is_met
        assert found.is_checksum
        assert (found.grid, found.mode) == (results.node[row], 3)


def test_static_totals_must_vanish():
    """A rest at one grid means that the solver's forces do not balance its loads, although rows and totals agree."""
    hidden = replace(as_on_element(tee().results, hides_inertia=True), analysis="static")
    assert check_totals(hidden, "on_element").is_in_balance
    open_ = replace(as_on_element(tee().results, hides_inertia=False), analysis="static")
    found = check_totals(open_, "on_element")
    assert found.is_met
    assert not found.is_in_balance
    assert check_totals(tee().results, "on_node").is_in_balance  # in a mode it is the inertia force


def test_totals_with_inertia_must_vanish_but_for_round_off():
    """Modes of forces on elements; a rigid mode, which is all round-off, tells nothing."""
    hidden = as_on_element(tee().results, hides_inertia=True)
    at = np.flatnonzero(hidden.kind == TOTALS)[20]
    for mode, factor, is_balanced in ((2, 1.0, False), (0, 1e-9, True)):
        force = hidden.force.copy()
        force[mode] *= factor
        force[mode, at, 1] = 0.1 * np.abs(force[mode]).max()
        found = check_totals(replace(hidden, force=force), "on_element")
        assert found.is_in_balance == is_balanced
        assert is_balanced or (found.rest_grid, found.rest_mode) == (hidden.node[at], mode + 1)


def test_moments_that_are_round_off_need_not_vanish():
    """A plate that is only pulled has no moments but round-off, and totals as large as these."""
    hidden = replace(as_on_element(tee().results, hides_inertia=True), analysis="static")
    force = hidden.force.copy()
    force[:, :, 3:] = 1e-9 * np.random.default_rng(0).normal(size=force[:, :, 3:].shape)
    assert check_totals(replace(hidden, force=force), "on_element").is_in_balance


def test_rows_of_other_modes_count_nothing():
    """A load that only one mode has, and a total that another lacks."""
    results = tee().results
    rows = np.concatenate([results.force, np.full((5, 1, 6), np.nan)], axis=1)
    rows[1, -1] = np.arange(6.0)
    at = int(np.flatnonzero((results.kind == TOTALS) & (results.node == 7))[0])
    rows[1, at] += np.arange(6.0)
    rows[3, at] = np.nan
    mixed = replace(
        results,
        node=np.append(results.node, 7),
        element=np.append(results.element, 0),
        kind=np.append(results.kind, "APP-LOAD"),
        force=rows,
    )
    assert check_totals(mixed, "on_node").residual < 1e-9


def test_without_totals_there_is_nothing_to_check():
    """No row states one."""
    assert check_totals(only(tee().results, tee().results.kind != TOTALS), "on_node") is None
