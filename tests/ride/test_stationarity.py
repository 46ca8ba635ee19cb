"""Rows of stationarity: what violates the assumptions of the frequency domain, and what cannot be told."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.results.columns import TABLES
from fatigue.ride.stationarity import StationarityRow, stationarity_row
from tests.ride.channels import hunting, record


def test_rows_have_the_columns():
    """Every column of the table is a field of the row, in order."""
    assert [f.name for f in fields(StationarityRow)] == [c.name for c in TABLES["stationarity"]]


def test_noise_holds():
    """Stationary noise is what the frequency domain assumes."""
    row = stationarity_row(record(hunting(rms=0.0)))
    assert (row.segments, row.segment_s, row.assumptions, row.reason) == (30, 2.0, "hold", None)
    assert row.dispersion_ratio == pytest.approx(1.0, abs=0.8)
    assert row.p > 0.01
    assert row.kurtosis == pytest.approx(3.0, abs=0.3)


def test_a_burst_violates():
    """A burst of hunting scatters the mean squares far beyond chance."""
    row = stationarity_row(record(hunting()))
    assert row.assumptions == "violated"
    assert row.dispersion_ratio > 8
    assert row.p < 1e-10
    assert "times as much as by chance" in row.reason


def test_a_sine_violates():
    """A sine is stationary, and not Gaussian."""
    row = stationarity_row(record(np.sin(0.3 * np.arange(12_000))))
    assert row.assumptions == "violated"
    assert row.reason == "kurtosis 1.5 below 2: more of a sine, 1.5, than of noise"


def test_peaks_violate():
    """Blows of a flange show in kurtosis and crest."""
    values = hunting(rms=0.0)
    values[::400] += 12.0
    row = stationarity_row(record(values))
    assert row.assumptions == "violated"
    assert "kurtosis" in row.reason
    assert "crest" in row.reason
    assert row.crest > 1.3 * row.expected_crest


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        (np.zeros(6000), "the channel is silent"),
        (np.full(6000, 9.81), "the channel is silent"),
        (hunting(rms=0.0)[:3000], "the record holds fewer than 8 segments"),
    ],
    ids=["zeros", "constant", "short"],
)
def test_what_cannot_be_told(values, reason):
    """Silence and a short record have no ratio, and the reason."""
    row = stationarity_row(record(values))
    assert row.assumptions is None
    assert row.segments == 0
    assert np.isnan([row.dispersion_ratio, row.p]).all()
    assert row.reason.startswith(reason)
