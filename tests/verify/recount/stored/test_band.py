"""Bands of the recount beside bands of the program, and a small error in any column."""

import numpy as np
import pytest

from fatigue.life.band.load import LoadScatter, mission_scatter, record_error
from fatigue.verify.recount.anew.cycles import PIECES, RecountCycles, in_pieces
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass
from fatigue.verify.recount.stored.band import band_row
from fatigue.verify.recount.stored.compare import compare

KEY = ("A", 1, 10, "top")
LIFE = 2e6


def one_pass(pieces):
    """A pass with the damage of some pieces."""
    nothing = np.zeros(0)
    damage = {"damage_per_pass": float(pieces.sum())}
    return OnePass(damage, nothing, nothing, nothing, nothing, {}, {}, {}, None, pieces)


def result(shares=(0.7, 0.3), lengths=(1.0, 1.0), reason=None, known=(True, True)):
    """Events, passes and the row that the program writes of them."""
    rng = np.random.default_rng(3)
    pieces = [share * rng.lognormal(0.0, 0.5, PIECES) for share in shares]
    total = sum(p.sum() for p in pieces)
    errors = np.array([record_error(p) if is_known else 1.0 for p, is_known in zip(pieces, known, strict=True)])
    scatter = mission_scatter(np.array([[p.sum() / total] for p in pieces]), errors[:, None])
    half = LoadScatter(scatter.se, scatter.dof).log_half_width[0]
    row = {
        "life_km": LIFE,
        "se_load": float(scatter.se[0]),
        "dof": float(scatter.dof[0]),
        "life_km_load_low": LIFE * np.exp(-half),
        "life_km_load_high": LIFE * np.exp(half),
        "band_reason": reason,
    }
    events = [RecountEvent(str(i), length, 1.0) for i, length in enumerate(lengths)]
    return events, [one_pass(p) for p in pieces], row


def wrong(events, passes, row, bound=0.0):
    """Columns that differ by more than rounding may do, ``bound`` of the inverse of the life."""
    rows = [band_row(KEY, events, passes, LIFE, bound, row)]
    return {check.column for check in compare("band", rows, {}) if not check.passed}


def test_bands_of_the_program_agree():
    """By two events, one event, and one that is counted by number and has little of the damage."""
    assert wrong(*result()) == set()
    assert wrong(*result(shares=(1.0,), lengths=(1.0,), known=(True,))) == set()
    assert wrong(*result(shares=(0.97, 0.03), lengths=(1.0, None), known=(True, False))) == set()
    assert wrong(*result(reason="non_stationary")) == set()


def test_a_small_event_may_scatter_by_all_of_its_damage():
    """Whether its record is too short is not recounted; a large one may not."""
    assert wrong(*result(shares=(0.97, 0.03), known=(True, False))) == set()
    assert "se_load" in wrong(*result(shares=(0.7, 0.3), known=(True, False)))


@pytest.mark.parametrize("column", ["life_km", "se_load", "dof", "life_km_load_low", "life_km_load_high"])
def test_a_small_error_in_any_column_is_found(column):
    """By a hundred-thousandth of itself."""
    events, passes, row = result()
    row[column] *= 1.00001
    assert column in wrong(events, passes, row)


def test_what_rounding_may_do_is_no_error():
    """Where the damage is known to a thousandth only, another sum of the pieces is as right, and a hundredth is not."""
    events, passes, row = result()
    moved = np.random.default_rng(5).normal(0.0, 1e-5, PIECES) * passes[0].pieces.sum()
    other = [one_pass(passes[0].pieces + moved), passes[1]]
    row["life_km"] *= 1.0005
    assert wrong(events, other, row, bound=1e-3 / LIFE) == set()
    assert {"life_km", "se_load"} <= wrong(events, other, row)
    row["se_load"] *= 1.1
    assert "se_load" in wrong(events, other, row, bound=1e-3 / LIFE)


def test_without_a_band_only_the_life_is_compared():
    """Nothing is expected of columns that are empty."""
    events, passes, row = result(reason="short_record")
    row |= dict.fromkeys(("se_load", "dof", "life_km_load_low", "life_km_load_high"), float("nan"))
    assert wrong(events, passes, row) == set()


def test_every_cycle_is_laid_half_and_half():
    """In the pieces of its two instants, and all of it."""
    cycles = RecountCycles(np.array([0, 299, 150]), np.array([10, 0, 150]), np.ones(3))
    pieces = in_pieces(cycles, np.array([2.0, 4.0, 8.0]), 300)
    expected = np.zeros(PIECES)
    expected[[0, 1, 15, 29]] = [1.0 + 2.0, 1.0, 8.0, 2.0]
    assert pieces == pytest.approx(expected)
