"""Rows of the tables of a correlation."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from fatigue.gauges.correlated.compared import Comparison
from fatigue.gauges.correlated.summary import Correlation
from fatigue.gauges.measured.band import band_edges
from fatigue.results.dictionary.column import Column
from fatigue.results.dictionary.decided.correlation import (
    CHANNEL_FLAGS,
    GAUGE_EXCEEDANCE,
    GAUGE_SPECTRA,
    band_ratio,
    correlation_columns,
)

Tables = dict[str, tuple[Sequence[Column], Any]]


def tables_of(found: Correlation) -> Tables:
    """Every table by its name, with its columns."""
    columns = correlation_columns(band_edges(*found.band_hz))
    rows = pd.DataFrame([_row(found.event, one) for one in found.comparisons])
    return {
        "correlation": (columns, rows),
        "channel_flags": (CHANNEL_FLAGS, [row for one in found.comparisons for row in one.flags]),
        "gauge_exceedance": (GAUGE_EXCEEDANCE, pd.concat([_exceedance(found.event, one) for one in found.comparisons])),
        "gauge_spectra": (GAUGE_SPECTRA, pd.concat([_spectra(found.event, one) for one in found.comparisons])),
    }


def _row(event: str, one: Comparison) -> dict[str, Any]:
    """One row of ``correlation``; what cannot be had is null."""
    numbers, alignment = one.numbers, one.alignment
    return {
        **_key(event, one),
        "verdict": one.verdict,
        "km": one.km,
        "lost_km": one.km_lost,
        "kept_share": one.kept_share,
        "flags": one.said_flags,
        "bridged_samples": one.bridged,
        "rms_measured_ue": numbers.rms_measured,
        "rms_simulated_ue": numbers.rms_simulated,
        "rms_ratio": numbers.rms_ratio,
        **{band_ratio(*edges): ratio for edges, ratio in numbers.band_ratios.items()},
        **{f"range_ratio_{n}_per_km": ratio for n, ratio in numbers.range_ratios.items()},
        "k": numbers.k,
        "pseudo_damage_measured_per_km": numbers.damage_measured,
        "pseudo_damage_simulated_per_km": numbers.damage_simulated,
        "damage_ratio": numbers.damage_ratio,
        "equivalent_range_ratio": numbers.equivalent_range_ratio,
        "lost_share": one.lost_share,
        "lag_s": np.nan if alignment is None else alignment.lag_s,
        "correlation": np.nan if alignment is None else alignment.correlation,
        "coherence_band": one.coherence,
    }


def _exceedance(event: str, one: Comparison) -> pd.DataFrame:
    drawn = one.drawn
    return pd.DataFrame(
        {
            **_key(event, one),
            "range_ue": drawn.level,
            "measured_per_km": drawn.measured_reached,
            "simulated_per_km": drawn.simulated_reached,
        }
    )


def _spectra(event: str, one: Comparison) -> pd.DataFrame:
    drawn = one.drawn
    return pd.DataFrame(
        {
            **_key(event, one),
            "frequency_hz": drawn.frequency,
            "measured_ue2_per_hz": drawn.measured_density,
            "simulated_ue2_per_hz": drawn.simulated_density,
        }
    )


def _key(event: str, one: Comparison) -> dict[str, str]:
    return {"gauge": one.channel.gauge, "channel": one.channel.name, "event": event}
