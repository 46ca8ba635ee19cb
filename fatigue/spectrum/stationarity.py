"""Is an event one stationary Gaussian case? Its variance over time, beside the scatter that chance allows.

The record is cut into periods. The variance of a point's stress in each period is a quadratic form in its modal
stress, and the scatter to be expected of that variance is a sum of squared ones, see ``scatter``. Both need matrices of
the modal coordinates only.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import ModalHistory
from fatigue.quotient import quotient
from fatigue.spectrum.moments import (
    DIRLIK_ORDERS,
    MomentMatrices,
    Spectra,
    moments_by_chunk,
    pair_densities,
    point_moments,
    samples_per_segment,
    segment_spectra,
)
from fatigue.spectrum.pairs import pair_forms, pairs, weights_of_pairs
from fatigue.spectrum.scatter import period_taper, principal_scatter

FEWEST_PERIODS = 8  # below, a scatter between periods says nothing
LARGEST_EXPONENT = 40  # of 2: stresses of 1e12 MPa, whose squares are far below 3e38
CANCELLED = 1e-3  # of the variances of its modes: of a smaller variance single precision leaves three digits at most
MOST_PERIODS = 32  # into which a long record is cut: more would cost time and tell no more


@dataclass(frozen=True, slots=True, eq=False)
class PeriodMatrices:
    """Variance of the modal coordinates period by period, and the scatter to be expected of it by chance.

    The forms belong to coordinates scaled to unit variance: they take ``modal_stress * rms``.
    Each is a row of ``forms``, its weights of the ``pairs`` of modes: first the variance of each period, then the
    variance of the record, then the principal spectra of the scatter. The expected squared coefficient of variation of
    a point's variance from period to period, were the record Gaussian and stationary, is
    ``sum of scatter**2 / mean**2``.

    Attributes
    ----------
    rms : (m,) [unit modal coordinate]
    forms : (periods + 1 + r, pairs)
    periods : how many there are
    period_s : effective length of a period under its taper [s]
    segments : segments of the spectrum in one period
    """

    rms: NDArray[np.float64]
    forms: NDArray[np.float64]
    periods: int
    period_s: float
    segments: int


@dataclass(frozen=True, slots=True, eq=False)
class Stationarity:
    """How the variance of every point behaves over time; arrays are (n,), (p, n) for ``relative_variance``.

    Attributes
    ----------
    relative_variance : variance of each period over their mean
    modulation_index : coefficient of variation of the variance over that expected by chance: 1 in the mean
    lower, upper : bounds between which chance keeps the modulation index in 98 of 100 records
    bandwidth_hz : statistical bandwidth B_s: the variance over a time T scatters by ``1 / sqrt(T B_s)`` [Hz]
    expected_cov : coefficient of variation of the variance of one period expected by chance
    """

    relative_variance: NDArray[np.float64]
    modulation_index: NDArray[np.float64]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    bandwidth_hz: NDArray[np.float64]
    expected_cov: NDArray[np.float64]


def moments_and_variances(spectra: Spectra) -> tuple[MomentMatrices, NDArray[np.float64]]:
    """Moment matrices of an event, and from the same transforms the variance matrix of each period, (p, m, m)."""
    size = segments_per_period(spectra)
    total, variances = np.zeros(()), []
    for chunk in moments_by_chunk(spectra, DIRLIK_ORDERS, size):
        total = total + chunk.segments * chunk.matrix
        if chunk.segments == size:
            variances.append(chunk.matrix[0].copy())
    segments = len(spectra.starts)
    return replace(chunk, matrix=total / segments, segments=segments), np.stack(variances)


def period_matrices(history: ModalHistory, spectra: Spectra, variances: NDArray[np.float64]) -> PeriodMatrices | None:
    """Matrices of the periods of an event, of one segment or, in a long record, some; None for fewer than eight.

    ``variances`` is (p, m, m), see ``moments_and_variances``.
    """
    if len(spectra.starts) < FEWEST_PERIODS:
        return None
    long = segment_spectra(history, 2 * spectra.segment_s, spectra.upper_hz)
    first, second = pairs(len(history.mode))
    density = pair_densities(long)
    mean = long.weight @ density
    rms = np.sqrt(mean[first == second])
    scale = np.where(rms > 0, rms, 1.0)  # a mode that is never excited stays zero

    segments = segments_per_period(spectra)
    taper = period_taper(samples_per_segment(history.step, spectra.segment_s), segments)
    period_s = history.step / float(np.sum(taper**2))
    unit = weights_of_pairs(len(scale)) / (scale[first] * scale[second])
    known = np.concatenate([variances[:, first, second], mean[None]]) * unit
    scatter = principal_scatter(long, density, scale, taper)
    scatter /= np.sqrt(1 + period_s / history.duration)  # the autocovariances have their own scatter, which adds
    return PeriodMatrices(rms, np.concatenate([known, scatter]), len(variances), period_s, segments)


def segments_per_period(spectra: Spectra) -> int:
    """Segments that make one period, so that there are no more than ``MOST_PERIODS``."""
    return -(-len(spectra.starts) // MOST_PERIODS)


def moments_by_period(spectra: Spectra, orders: tuple[float, ...]) -> list[MomentMatrices]:
    """Moment matrices of each period; segments that do not fill a last period are left out."""
    size = segments_per_period(spectra)
    return [chunk for chunk in moments_by_chunk(spectra, orders, size) if chunk.segments == size]


def stationarity(modal_stress: NDArray[np.float64], periods: PeriodMatrices) -> Stationarity:
    """Variance over time of the stress at every point, judged; NaN where the stress is zero.

    ``modal_stress`` is (n, m) [MPa per unit modal coordinate].
    """
    forms = _forms(_squarable(modal_stress * periods.rms), periods)
    forms[: periods.periods + 1] = np.maximum(forms[: periods.periods + 1], 0.0)  # rounding may leave less
    variance, mean = forms[: periods.periods], forms[periods.periods]
    scatter = np.sqrt(np.sum(forms[periods.periods + 1 :] ** 2, axis=0))
    expected_cov = quotient(scatter, mean)
    relative = quotient(variance, variance.mean(axis=0))
    count = len(relative)
    # The variance of a sample variance grows with the kurtosis of what is sampled, here close to a chi-square variable:
    # its upper tail gets heavier, the lower one stays.
    freedom = (count - 1) / (1 + 3 * expected_cov**2 * (count - 1) / count)
    return Stationarity(
        relative_variance=relative,
        modulation_index=quotient(relative.std(axis=0, ddof=1), expected_cov),
        lower=np.sqrt(_chi_square_over_freedom(-2.576, np.full_like(freedom, count - 1))),  # normal quantile of 0.5 %
        upper=np.sqrt(_chi_square_over_freedom(2.326, freedom)),  # 99 %
        bandwidth_hz=quotient(1.0 / periods.period_s, expected_cov**2),
        expected_cov=expected_cov,
    )


def modulation_factor(of: Stationarity, k: float) -> NDArray[np.float64]:
    """Damage of the periods, each at its own variance, over the damage at their mean variance: (n,), 1 when stationary.

    ``mean(v**(k/2)) / mean(v)**(k/2)``, over the value it has by chance, ``1 + (k/2)(k/2 - 1)/2 cov**2``.
    """
    by_chance = 1 + 0.5 * (k / 2) * (k / 2 - 1) * of.expected_cov**2
    return np.asarray(np.mean(of.relative_variance ** (k / 2), axis=0) / by_chance)


def damage_rate_by_period(
    modal_stress: NDArray[np.float64],
    spectra: Spectra,
    damage_rate: Callable[[NDArray[np.float64]], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Mean over the periods of the damage rate of each: (n,) [1/s], for points where modulation is what is wrong.

    ``damage_rate`` maps moments (4, n) of orders 0, 1, 2, 4 of one period to damage per second. A sum over Gaussian
    chunks in the sense of Wolfsteiner (2017); short chunks scatter, which adds some per cent of damage.
    """
    rates = [damage_rate(point_moments(modal_stress, m)) for m in moments_by_period(spectra, (0.0, 1.0, 2.0, 4.0))]
    return np.asarray(np.mean(rates, axis=0))


def _forms(modal_stress: NDArray[np.float64], periods: PeriodMatrices) -> NDArray[np.float64]:
    """Forms (periods + 1 + r, n) in single precision, but for points whose modes cancel."""
    forms = pair_forms(modal_stress, periods.forms.astype(np.float32)).astype(np.float64)
    cancelled = np.flatnonzero(forms[periods.periods] < CANCELLED * np.sum(modal_stress**2, axis=1))
    if cancelled.size:
        forms[:, cancelled] = pair_forms(modal_stress[cancelled], periods.forms)
    return forms


def _squarable(modal_stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows (n, m) whose squares single precision can hold: those far beyond are divided by a power of 2, exactly.

    Only ratios are made of the forms, and a damaged value of 1e30 must not break the run.
    """
    _, exponent = np.frexp(np.abs(modal_stress).max(axis=1, initial=0.0))
    return np.asarray(np.ldexp(modal_stress, -np.maximum(exponent - LARGEST_EXPONENT, 0)[:, np.newaxis]))


def _chi_square_over_freedom(normal: float, freedom: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quantile of chi-square over its degrees of freedom, from the normal quantile (Wilson and Hilferty, 1931)."""
    spread = 2 / (9 * freedom)
    return np.asarray(np.maximum(1 - spread + normal * np.sqrt(spread), 0) ** 3)
