"""Every verdict in words."""

import numpy as np
import pytest

from fatigue.spectrum.reasons import reason
from fatigue.spectrum.trust import VERDICTS, Judgement

MEASURED = {
    "dirlik_ratio": 1.02,
    "tb_ratio": 0.97,
    "ratio_low": 0.75,
    "ratio_high": 1.33,
    "outside_share": 0.082,
    "missed_damage": 0.46,
    "missed_limit": 0.2,
    "alpha2": 0.41,
    "samples_per_peak": 20.0,
    "peaks_over_top_mode": 0.9,
    "slow_share": 0.02,
    "top_cycle_share": 0.34,
    "top_cycle_limit": 0.10,
    "modulation_index": 1.04,
    "modulation_low": 0.6,
    "modulation_high": 1.4,
    "modulation_factor": 1.33,
    "line_share": 0.55,
    "line_factor": 0.9,
    "kurtosis": 5.4,
    "expected_kurtosis": 3.1,
    "kurtosis_tolerance": 0.5,
    "bandwidth_hz": 2.4,
    "relative_bandwidth": 0.3,
    "damage_cov": 0.08,
}


def of(verdict, too_short=False, **measured):
    """Make a judgement on one point."""
    values = {name: np.array([value]) for name, value in (MEASURED | measured).items()}
    return Judgement(
        verdict=np.array([VERDICTS.index(verdict)], dtype=np.int8),
        record_too_short=np.array([too_short]),
        slope=3.6,
        slow_hz=0.345,
        upper_hz=60.0,
        segments=13,
        **values,
    )


@pytest.mark.parametrize(
    ("verdict", "measured", "words"),
    [
        ("not_assessed", {}, ["Nothing to compare"]),
        ("valid", {}, ["1.02", "0.75 to 1.33", "stationary (modulation index 1.04", "2% below 0.34 Hz"]),
        ("valid", {"modulation_index": 1.6, "modulation_factor": 1.04}, ["modulated over time", "1.04"]),
        ("valid", {"modulation_index": np.nan}, ["unknown (13 spectral segments, 8 are needed)"]),
        ("outside_band", {}, ["8.2% of the variance", "60 Hz", "46% of the damage", "limit 20%", "Raise upper_hz"]),
        ("outside_band", {"outside_share": 0.99998}, ["99.99% of the variance"]),
        ("sampling", {"samples_per_peak": 4.0}, ["4.0 samples per peak", "37%", "Upsample"]),
        ("sampling", {"peaks_over_top_mode": 3.4}, ["3.4 times as often", "Lower upper_hz"]),
        ("quasi_static", {"slow_share": 0.92}, ["92%", "0.34 Hz", "two errors that cancel"]),
        ("quasi_static", {"slow_share": 0.92, "dirlik_ratio": 0.4}, ["Use rainflow."]),
        ("single_event", {}, ["34%", "chance allows 10%"]),
        ("non_stationary", {"modulation_index": 3.5}, ["3.5 times", "1.33", "event of its own"]),
        ("harmonic", {"modulation_index": 0.3}, ["0.30", "55%", "limit cycle", "1.68 at most"]),
        ("non_gaussian", {}, ["Kurtosis 5.4", "impacts", "underestimates"]),
        ("non_gaussian", {"kurtosis": 1.6}, ["bump stops", "overestimates"]),
        ("bandwidth", {"dirlik_ratio": 0.6}, ["0.60", "alpha2 0.41", "Tovo-Benasciutti gives 0.97"]),
    ],
)
def test_reason_names_the_numbers(verdict, measured, words):
    """Each sentence carries the value, its limit and what to do."""
    text = reason(of(verdict, **measured), 0)
    for word in words:
        assert word in text
    assert text.endswith(".")
    assert "nan" not in text


def test_every_verdict_has_a_sentence():
    """No verdict without words."""
    assert all(reason(of(verdict), 0) for verdict in VERDICTS)


def test_the_rider_of_a_short_record():
    """A record too short says so behind any verdict, with the scatter or with why it is unknown."""
    assert "scatters by 31%" in reason(of("harmonic", too_short=True, damage_cov=0.31), 0)
    assert "unknown: 13 spectral segments" in reason(of("valid", too_short=True, damage_cov=np.nan), 0)
    assert "scatter" not in reason(of("not_assessed", too_short=True), 0)
