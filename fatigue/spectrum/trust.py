"""Verdict on the frequency domain: may Dirlik's damage be trusted at a point in an event, and if not, why not.

A spectrum describes a stationary Gaussian process sampled densely and long enough. Each of these words is measured, for
all points at once, and the first one that fails gives the verdict. Time domain damage stays the result either way: the
estimate from the spectrum screens and explains.

The order of the rule and its limits were calibrated on synthetic records (stationary, stepped and modulated, with
tones, bursts, impacts, a spike, quasi-static parts, non-linear); where chance in a short record exceeds a limit, the
limit gives way to what chance allows.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import ModalHistory
from fatigue.quotient import quotient
from fatigue.spectrum.methods import SpectralShape, dirlik_over_narrow_band, spectral_shape
from fatigue.spectrum.moments import MomentMatrices, Spectra, quadratic_forms
from fatigue.spectrum.stationarity import (
    PeriodMatrices,
    Stationarity,
    modulation_factor,
    moments_and_variances,
    period_matrices,
    stationarity,
)
from fatigue.spectrum.whole_record import RecordMatrices, record_matrices

VERDICTS = (
    "not_assessed",
    "valid",
    "outside_band",
    "sampling",
    "quasi_static",
    "single_event",
    "non_stationary",
    "harmonic",
    "non_gaussian",
    "bandwidth",
)

FEW_SAMPLES_PER_PEAK = 10.0  # worth a warning
FEWEST_SAMPLES_PER_PEAK = 6.0  # below, the rainflow count is no reference: it loses 16 % of the damage at k = 3.6
HIGHEST_PEAK_RATE = 3.0  # over the highest mode: more peaks than modes can make are noise
SLOW_SHARE = 0.20  # of the variance
TOP_CYCLE_SHARE, HALF_OF_DAMAGE = 0.10, 0.50  # half of it in one cycle is an event, however few cycles there are
TOP_CYCLE_QUANTILE = 4.6  # -ln(-ln 0.99): 99 of 100 largest values of N exponential variables stay below ln N + 4.6
MODULATED, STEADY = 1.4, 0.6  # modulation index; Gaussian records of 51 s keep 0.7 to 1.35
MODULATION_MATTERS = 1.1  # factor on the damage
EXPLAINED_KURTOSIS = 0.25  # share of the excess that modulation must make; with less, high peaks scatter the variance
NO_LIFE = 0.90  # of the damage missed by the band: a life by the spectrum would be off by a decade
LINE_SHARE = 0.30  # of the variance, in tones
STEADIER_THAN_CHANCE = 0.8  # modulation index: a tone is steady, a lightly damped mode as sharp is not
NARROW_PEAK = 0.2  # statistical bandwidth over crossing rate, of a mode with 3 % damping: a tone is narrower
KURTOSIS_OFF = 0.5  # from what the modulation found explains
RATIO_BAND = {4.0: (0.80, 1.25), 5.0: (0.65, 1.35)}  # of Dirlik / rainflow on Gaussian records, by slope k
CONFIDENT = 0.25  # coefficient of variation of the damage from one record to the next
RATIO_SCATTER = 0.5  # of ln(Dirlik / rainflow) over the scatter of each damage (Monte Carlo): errors are common


@dataclass(frozen=True, slots=True, eq=False)
class TrustMatrices:
    """Matrices of an event that the judgement of all its points needs, computed once.

    ``moments`` are the moment matrices of the event, from the same transforms as the periods. ``periods`` is None if
    the record holds too few segments to judge its scatter.
    """

    moments: MomentMatrices
    record: RecordMatrices
    periods: PeriodMatrices | None
    duration: float
    segments: int


@dataclass(frozen=True, slots=True, eq=False)
class Judgement:
    """Verdict and the numbers behind it; every array is (n,). What could not be measured is NaN.

    Attributes
    ----------
    verdict : index into ``VERDICTS``
    record_too_short : the damage would scatter by more than ``CONFIDENT`` from record to record, or that is unknown
    dirlik_ratio, tb_ratio : damage of Dirlik and of Tovo-Benasciutti over rainflow damage
    ratio_low, ratio_high : band in which the ratio means agreement
    outside_share : of the variance of the whole spectrum, above ``upper_hz``
    missed_damage, missed_limit : share of the damage that the band misses, and from where on it is too much
    alpha2 : irregularity
    samples_per_peak : of the record that was counted
    peaks_over_top_mode : rate of peaks over the highest frequency of a mode
    slow_share : of the variance, below ``slow_hz``
    top_cycle_share : of the rainflow damage, in the largest cycle
    top_cycle_limit : share that chance allows
    modulation_index, modulation_low, modulation_high : see ``Stationarity``
    modulation_factor : damage that the modulation found adds
    line_share : of the variance, in spectral lines
    line_factor : damage that lines take away: of tone plus noise over Gaussian of the same variance
    kurtosis, expected_kurtosis, kurtosis_tolerance : Gaussian 3, more when modulated
    bandwidth_hz, relative_bandwidth : statistical bandwidth B_s [Hz], and over the rate of zero crossings
    damage_cov : coefficient of variation of the damage, of either domain, from one record of this length to the next
    slope : k the limits were chosen for
    slow_hz : frequency below which the record holds too few cycles [Hz]
    upper_hz : upper limit of the band of the spectrum [Hz]
    segments : spectral segments of the record
    """

    verdict: NDArray[np.int8]
    record_too_short: NDArray[np.bool_]
    dirlik_ratio: NDArray[np.float64]
    tb_ratio: NDArray[np.float64]
    ratio_low: NDArray[np.float64]
    ratio_high: NDArray[np.float64]
    outside_share: NDArray[np.float64]
    missed_damage: NDArray[np.float64]
    missed_limit: NDArray[np.float64]
    alpha2: NDArray[np.float64]
    samples_per_peak: NDArray[np.float64]
    peaks_over_top_mode: NDArray[np.float64]
    slow_share: NDArray[np.float64]
    top_cycle_share: NDArray[np.float64]
    top_cycle_limit: NDArray[np.float64]
    modulation_index: NDArray[np.float64]
    modulation_low: NDArray[np.float64]
    modulation_high: NDArray[np.float64]
    modulation_factor: NDArray[np.float64]
    line_share: NDArray[np.float64]
    line_factor: NDArray[np.float64]
    kurtosis: NDArray[np.float64]
    expected_kurtosis: NDArray[np.float64]
    kurtosis_tolerance: NDArray[np.float64]
    bandwidth_hz: NDArray[np.float64]
    relative_bandwidth: NDArray[np.float64]
    damage_cov: NDArray[np.float64]
    slope: float
    slow_hz: float
    upper_hz: float
    segments: int


@dataclass(frozen=True, slots=True, eq=False)
class RecordScatter:
    """How much the damage of a record scatters, and whether its variance changes over time; every array is (n,).

    Attributes
    ----------
    time : the variance over time
    lower, upper : modulation index below which the stress is steadier than chance, above which it is not stationary
    variance_cov, damage_cov : coefficients of variation from one record of this length to the next; NaN: unknown
    """

    time: Stationarity
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    variance_cov: NDArray[np.float64]
    damage_cov: NDArray[np.float64]

    @property
    def record_too_short(self) -> NDArray[np.bool_]:
        """Whether the damage scatters by more than ``CONFIDENT`` from record to record, or that is unknown."""
        return ~(self.damage_cov <= CONFIDENT)

    @property
    def is_modulated(self) -> NDArray[np.bool_]:
        """Whether the modulation index is above what chance allows."""
        return self.time.modulation_index > self.upper


def trust_matrices(history: ModalHistory, spectra: Spectra) -> TrustMatrices:
    """Matrices for the judgement of an event, from its kept record and the segment spectra of it."""
    moments, variances = moments_and_variances(spectra)
    return TrustMatrices(
        moments=moments,
        record=record_matrices(history, spectra.upper_hz),
        periods=period_matrices(history, spectra, variances),
        duration=history.duration,
        segments=len(spectra.starts),
    )


def judge(
    modal_stress: NDArray[np.float64],
    moments: NDArray[np.float64],
    matrices: TrustMatrices,
    *,
    slope: float,
    dirlik_ratio: NDArray[np.float64],
    tb_ratio: NDArray[np.float64],
    kurtosis: NDArray[np.float64],
    top_cycle_share: NDArray[np.float64],
    samples_per_peak: NDArray[np.float64],
    top_mode_hz: float | None,
    outside_share: NDArray[np.float64] | None = None,
    missed_damage: NDArray[np.float64] | None = None,
) -> Judgement:
    """Judgement on all points of one event: the verdict and the numbers behind it.

    Parameters
    ----------
    modal_stress : (n, m) stress per unit modal coordinate [MPa]
    moments : (4, n) spectral moments of that stress, orders 0, 1, 2, 4
    matrices : of the event
    slope : k of the S-N curve where the damage is done
    dirlik_ratio, tb_ratio : (n,) frequency-domain over rainflow damage, same bending ratio in both
    kurtosis : (n,) of the stress samples, Gaussian 3
    top_cycle_share : (n,) damage of the largest cycle over all
    samples_per_peak : (n,) sampling rate of the counted record over the rate of peaks
    top_mode_hz : highest frequency of a normal mode [Hz]; None: unknown
    outside_share, missed_damage : (n,) shares of variance and damage above the band, see ``outside``; None: unknown
    """
    shape = spectral_shape(moments)
    record = matrices.record
    total, slow, lines = (
        quadratic_forms(modal_stress, M[None])[0] for M in (record.covariance, record.slow, record.lines)
    )
    line_share = np.clip(quotient(lines, total), 0.0, 1.0)
    scatter = record_scatter(modal_stress, matrices, slope)
    time, damage_cov = scatter.time, scatter.damage_cov
    low, high = _ratio_band(slope)
    unknown = np.full(len(modal_stress), np.nan)
    chance = np.exp(1.645 * RATIO_SCATTER * np.where(np.isnan(damage_cov), 2 * CONFIDENT, damage_cov))
    judgement = Judgement(
        verdict=np.zeros(len(modal_stress), dtype=np.int8),
        record_too_short=scatter.record_too_short,
        dirlik_ratio=dirlik_ratio,
        tb_ratio=tb_ratio,
        ratio_low=low / chance,
        ratio_high=high * chance,
        outside_share=unknown if outside_share is None else outside_share,
        missed_damage=unknown if missed_damage is None else missed_damage,
        missed_limit=np.full(len(modal_stress), missed_limit(slope)),
        alpha2=shape.alpha2,
        samples_per_peak=samples_per_peak,
        peaks_over_top_mode=shape.peaks / (np.nan if top_mode_hz is None else top_mode_hz),
        slow_share=quotient(slow, total),
        top_cycle_share=top_cycle_share,
        top_cycle_limit=np.clip(
            _top_cycle_share(_rayleigh_cycles(shape, time, matrices.duration, slope), slope),
            TOP_CYCLE_SHARE,
            HALF_OF_DAMAGE,
        ),
        modulation_index=time.modulation_index,
        modulation_low=scatter.lower,
        modulation_high=scatter.upper,
        modulation_factor=modulation_factor(time, slope),
        line_share=line_share,
        line_factor=tone_damage_factor(line_share, slope),
        kurtosis=kurtosis,
        expected_kurtosis=3 * (1 + time.relative_variance.var(axis=0)) / (1 + time.expected_cov**2),
        # A Gaussian record's kurtosis has the variance 24/T times the integral of rho^4, at most 8 / (T B_s).
        kurtosis_tolerance=np.maximum(KURTOSIS_OFF, 2.6 * np.sqrt(8.0) * scatter.variance_cov),
        bandwidth_hz=time.bandwidth_hz,
        relative_bandwidth=quotient(time.bandwidth_hz, shape.zero_crossings),
        damage_cov=damage_cov,
        slope=slope,
        slow_hz=matrices.record.slow_hz,
        upper_hz=matrices.moments.upper_hz,
        segments=matrices.segments,
    )
    judgement.verdict[:] = _verdict(judgement)
    return judgement


def record_scatter(
    modal_stress: NDArray[np.float64], matrices: TrustMatrices, slope: NDArray[np.float64] | float
) -> RecordScatter:
    """How a record scatters at all points, from its spectrum and its variance over time; (n, m) as of ``judge``.

    ``slope`` is k where the damage is done, of all points or (n,) of each. The variance over T scatters by
    ``1 / sqrt(T B)``, the damage k / 2 times as much.
    """
    time = _stationarity(modal_stress, matrices.periods)
    lower, upper = np.minimum(STEADY, time.lower), np.maximum(MODULATED, time.upper)
    variance_cov = np.sqrt(quotient(1.0, matrices.duration * time.bandwidth_hz))
    steadier = np.where(time.modulation_index < lower, time.modulation_index, 1.0)
    return RecordScatter(time, lower, upper, variance_cov, np.asarray(0.5 * slope * variance_cov * steadier))


def missed_limit(slope: float) -> float:
    """Share of the damage that the band may miss before the spectrum is wrong for that alone: what agreement allows.

    >>> round(missed_limit(3.6), 2), round(missed_limit(5.0), 2)
    (0.2, 0.35)
    """
    return 1.0 - _ratio_band(slope)[0]


def vertex_sampling_loss(samples_per_peak: NDArray[np.float64], k: float) -> NDArray[np.float64]:
    """Share of the damage lost where reversals are read at their vertices, Eq. 6: ``17 k (pi / samples)^4 / 120``.

    Of a sine, whose peak lies at phi from a sample and theta = 2 pi / samples from there to the next one, the vertex
    is ``phi^2 (theta^2 - phi^2) / 8`` low; this is its mean over all phi, at most half of theta.

    >>> float(vertex_sampling_loss(np.array(10.0), k=3.6).round(4))
    0.005
    """
    return np.asarray(np.minimum(17.0 * k * (np.pi / samples_per_peak) ** 4 / 120.0, 1.0))


def sampling_loss(samples_per_peak: NDArray[np.float64], k: float) -> NDArray[np.float64]:
    """Share of the damage lost because peaks fall between samples: ``k (pi / samples per peak)**2 / 6`` (Eq. 6).

    >>> float(sampling_loss(np.array(10.0), k=3.6).round(3))
    0.059
    """
    return np.asarray(np.minimum(k * (np.pi / samples_per_peak) ** 2 / 6, 1.0))


def tone_damage_factor(share: NDArray[np.float64], k: float) -> NDArray[np.float64]:
    """Damage of a tone that holds ``share`` of the variance, plus narrow-band noise, over all-Gaussian damage.

    Mean of a Rice-distributed amplitude to the power k: ``1F1(-k/2; 1; -s) / (1 + s)**(k/2)`` with s the variance of
    the tone over the variance of the noise (Rice, 1945); ``1 / Gamma(1 + k/2)`` for a pure tone.

    >>> float(tone_damage_factor(np.array(0.0), k=3.6))
    1.0
    """
    from scipy.special import hyp1f1  # noqa: PLC0415 - slow to import

    over_noise = np.minimum(share, 0.999) / (1 - np.minimum(share, 0.999))
    return np.asarray(hyp1f1(-k / 2, 1.0, -over_noise) / (1 + over_noise) ** (k / 2))


def _verdict(of: Judgement) -> NDArray[np.int8]:
    """Verdict by the rule: the first finding that holds; a number that could not be had accuses nobody."""
    modulated = (of.modulation_index > of.modulation_high) & (of.modulation_factor > MODULATION_MATTERS)
    high_peaks = of.expected_kurtosis - 3 < EXPLAINED_KURTOSIS * (of.kurtosis - 3)
    narrow = of.relative_bandwidth < NARROW_PEAK
    steady = (of.modulation_index < of.modulation_low) & narrow
    tones = (of.modulation_index < STEADIER_THAN_CHANCE) & (of.line_share > LINE_SHARE)
    findings = {
        "not_assessed": ~np.isfinite(of.dirlik_ratio),
        "outside_band": of.missed_damage > of.missed_limit,
        "sampling": (of.samples_per_peak < FEWEST_SAMPLES_PER_PEAK) | (of.peaks_over_top_mode > HIGHEST_PEAK_RATE),
        "quasi_static": of.slow_share > SLOW_SHARE,
        "single_event": of.top_cycle_share > of.top_cycle_limit,
        "non_stationary": modulated & ~high_peaks,
        "harmonic": steady | tones,
        "non_gaussian": np.abs(of.kurtosis - of.expected_kurtosis) > of.kurtosis_tolerance,
        "bandwidth": (of.dirlik_ratio < of.ratio_low) | (of.dirlik_ratio > of.ratio_high),
    }
    verdict = np.full(len(of.verdict), VERDICTS.index("valid"), dtype=np.int8)
    for name, found in reversed(findings.items()):  # the first one is written last
        verdict[found] = VERDICTS.index(name)
    return verdict


def _stationarity(modal_stress: NDArray[np.float64], periods: PeriodMatrices | None) -> Stationarity:
    """Variance over time, judged; NaN for a record too short for it."""
    if periods is not None:
        return stationarity(modal_stress, periods)
    unknown = np.full(len(modal_stress), np.nan)
    return Stationarity(unknown[None], unknown, unknown, unknown, unknown, unknown)


def _ratio_band(slope: float) -> tuple[float, float]:
    """Band of agreement for a slope: methods differ more at steep curves."""
    slopes, bands = list(RATIO_BAND), np.array(list(RATIO_BAND.values()))
    return float(np.interp(slope, slopes, bands[:, 0])), float(np.interp(slope, slopes, bands[:, 1]))


def _rayleigh_cycles(shape: SpectralShape, time: Stationarity, duration: float, k: float) -> NDArray[np.float64]:
    """Number of Rayleigh cycles that would do Dirlik's damage, in the periods which do it only."""
    variance = time.relative_variance
    damage = np.where(np.isnan(variance), 1.0, variance) ** (k / 2)
    busy = damage.mean(axis=0) ** 2 / np.mean(damage**2, axis=0)
    return np.asarray(shape.zero_crossings * duration * dirlik_over_narrow_band(shape, k) * busy)


def _top_cycle_share(cycles: NDArray[np.float64], k: float) -> NDArray[np.float64]:
    """Share of the damage that the largest of ``cycles`` Rayleigh cycles exceeds in one record of a hundred."""
    n = np.maximum(cycles, 1.0)
    return np.asarray((np.log(n) + TOP_CYCLE_QUANTILE) ** (k / 2) / (n * math.gamma(1 + k / 2)))
