"""The verdict on a point in words, with its numbers."""

import math
from collections.abc import Callable

from fatigue.spectrum.outside import in_percent
from fatigue.spectrum.stationarity import FEWEST_PERIODS
from fatigue.spectrum.trust import (
    CONFIDENT,
    FEWEST_SAMPLES_PER_PEAK,
    HIGHEST_PEAK_RATE,
    SLOW_SHARE,
    VERDICTS,
    Judgement,
    sampling_loss,
)


def reason(of: Judgement, i: int) -> str:
    """Why point i has its verdict, and how far the record can be trusted, in one or two sentences."""
    verdict = VERDICTS[of.verdict[i]]
    sentence = _SENTENCES[verdict](of, i)
    return sentence if verdict == "not_assessed" else f"{sentence} {_confidence(of, i)}".rstrip()


def _not_assessed(of: Judgement, i: int) -> str:
    return "Nothing to compare: the stress has no spectrum here or the counted damage is zero."


def _valid(of: Judgement, i: int) -> str:
    return (
        f"Dirlik over rainflow {of.dirlik_ratio[i]:.2f} lies within {_band(of, i)}; {_modulation(of, i)}, kurtosis "
        f"{of.kurtosis[i]:.1f}, {of.line_share[i]:.0%} of the variance in tones, {of.slow_share[i]:.0%} below "
        f"{of.slow_hz:.2g} Hz."
    )


def _outside_band(of: Judgement, i: int) -> str:
    return (
        f"{in_percent(of.outside_share[i])}% of the variance lies above upper_hz ({of.upper_hz:g} Hz) and makes "
        f"{in_percent(of.missed_damage[i])}% of the damage (limit {of.missed_limit[i]:.0%}): it is in the cycles and "
        f"not in the spectrum (Dirlik over rainflow {of.dirlik_ratio[i]:.2g}). Raise upper_hz if this stress is real, "
        "keep it out of the simulation if it is noise, and trust rainflow."
    )


def _sampling(of: Judgement, i: int) -> str:
    if of.samples_per_peak[i] < FEWEST_SAMPLES_PER_PEAK:
        loss = sampling_loss(of.samples_per_peak[i], of.slope)
        return (
            f"Only {of.samples_per_peak[i]:.1f} samples per peak: the rainflow count itself loses about {loss:.0%} of "
            f"the damage. Upsample the record or write it out more often, {FEWEST_SAMPLES_PER_PEAK:.0f} is the least."
        )
    return (
        f"Stress peaks come {of.peaks_over_top_mode[i]:.1f} times as often as the highest mode swings, more than "
        f"{HIGHEST_PEAK_RATE:.0f} is noise. Lower upper_hz."
    )


def _quasi_static(of: Judgement, i: int) -> str:
    return (
        f"{of.slow_share[i]:.0%} of the variance lies below {of.slow_hz:.2g} Hz, fewer than ten cycles in this record "
        f"(limit {SLOW_SHARE:.0%}): loads so slow are a sequence, not a spectrum. Use rainflow"
        f"{_cancelling(of, i)}."
    )


def _single_event(of: Judgement, i: int) -> str:
    return (
        f"The largest cycle alone does {of.top_cycle_share[i]:.0%} of the damage, chance allows "
        f"{of.top_cycle_limit[i]:.0%}: a single event governs, and no spectrum knows it. Dirlik over rainflow "
        f"{of.dirlik_ratio[i]:.2f}."
    )


def _non_stationary(of: Judgement, i: int) -> str:
    return (
        f"The variance changes over time {of.modulation_index[i]:.1f} times as much as chance lets it, "
        f"{of.modulation_high[i]:.1f} is allowed. One spectrum for all of it misses a factor of about "
        f"{of.modulation_factor[i]:.2f} in damage (Dirlik over rainflow {of.dirlik_ratio[i]:.2f}): make each operating "
        "condition an event of its own."
    )


def _harmonic(of: Judgement, i: int) -> str:
    return (
        f"The variance is steadier than noise can be (modulation index {of.modulation_index[i]:.2f}), "
        f"{of.line_share[i]:.0%} of it in tones: a limit cycle. Its peaks all have the same height, so Dirlik "
        f"overestimates, by {math.gamma(1 + of.slope / 2):.2f} at most (here {of.dirlik_ratio[i]:.2f})."
    )


def _non_gaussian(of: Judgement, i: int) -> str:
    sharper = of.kurtosis[i] > of.expected_kurtosis[i]
    kind = "peaks higher than Gaussian, as from impacts or play" if sharper else "clipped peaks, as from bump stops"
    side = "underestimates" if sharper else "overestimates"
    return (
        f"Kurtosis {of.kurtosis[i]:.1f}, where {of.expected_kurtosis[i]:.1f} within {of.kurtosis_tolerance[i]:.1f} is "
        f"to be expected: {kind}. Dirlik {side} (ratio {of.dirlik_ratio[i]:.2f}); use rainflow."
    )


def _bandwidth(of: Judgement, i: int) -> str:
    return (
        f"Dirlik over rainflow {of.dirlik_ratio[i]:.2f} lies outside {_band(of, i)} although the record is stationary "
        f"and Gaussian: an error of the formula at this bandwidth (alpha2 {of.alpha2[i]:.2f}). Tovo-Benasciutti gives "
        f"{of.tb_ratio[i]:.2f}."
    )


def _band(of: Judgement, i: int) -> str:
    return f"{of.ratio_low[i]:.2f} to {of.ratio_high[i]:.2f}"


def _modulation(of: Judgement, i: int) -> str:
    if math.isnan(of.modulation_index[i]):
        return f"whether it is stationary is unknown ({of.segments} spectral segments, {FEWEST_PERIODS} are needed)"
    if of.modulation_index[i] > of.modulation_high[i]:
        return f"modulated over time, worth a factor of {of.modulation_factor[i]:.2f} in damage"
    return (
        f"stationary (modulation index {of.modulation_index[i]:.2f}, chance allows {of.modulation_low[i]:.2f} to "
        f"{of.modulation_high[i]:.2f})"
    )


def _cancelling(of: Judgement, i: int) -> str:
    agrees = of.ratio_low[i] <= of.dirlik_ratio[i] <= of.ratio_high[i]
    return f"; that both agree here ({of.dirlik_ratio[i]:.2f}) is two errors that cancel" if agrees else ""


def _confidence(of: Judgement, i: int) -> str:
    if not of.record_too_short[i]:
        return ""
    if math.isnan(of.damage_cov[i]):
        return (
            f"How far the damage would scatter from record to record is unknown: {of.segments} spectral segments, "
            f"{FEWEST_PERIODS} are needed."
        )
    return (
        f"The record is short: the damage scatters by {of.damage_cov[i]:.0%} from one record of this length to the "
        f"next, more than {CONFIDENT:.0%}."
    )


_SENTENCES: dict[str, Callable[[Judgement, int], str]] = {
    "not_assessed": _not_assessed,
    "valid": _valid,
    "outside_band": _outside_band,
    "sampling": _sampling,
    "quasi_static": _quasi_static,
    "single_event": _single_event,
    "non_stationary": _non_stationary,
    "harmonic": _harmonic,
    "non_gaussian": _non_gaussian,
    "bandwidth": _bandwidth,
}
