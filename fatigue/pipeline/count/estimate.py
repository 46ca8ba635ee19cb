"""What the second-order statistics of an event say of every station, before any cycle is counted."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.forms import FormPair, face_forms
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.quotient import quotient
from fatigue.spectrum.methods import dirlik_damage_rate, tovo_benasciutti_damage_rate
from fatigue.spectrum.moments import quadratic_forms
from fatigue.spectrum.outside import missed_damage, peak_rate, share_above
from fatigue.spectrum.trust import missed_limit


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """One pass of one event at a block of stations in the frequency domain; arrays are (n, 2), top and bottom face.

    ``bending_ratio`` is ``std(sigma_b) / (std(sigma_m) + std(sigma_b))``, NaN where nothing varies; ``mean`` [MPa] the
    time mean of the stress, its constant part included; ``moments`` (4, n, 2) are the spectral moments of orders 0, 1,
    2, 4 [MPa^2 Hz^p]; ``dirlik`` and ``tb`` damages of one pass, ``tb_whole`` that of the spectrum up to half the
    sampling rate, and ``outside_share`` the share of its variance above the band. What needs a spectrum is NaN without
    one.
    """

    bending_ratio: NDArray[np.float64]
    mean: NDArray[np.float64]
    moments: NDArray[np.float64]
    dirlik: NDArray[np.float64]
    tb: NDArray[np.float64]
    tb_whole: NDArray[np.float64]
    outside_share: NDArray[np.float64]
    irregularity: NDArray[np.float64]
    peaks_per_s: NDArray[np.float64]
    samples_per_peak: NDArray[np.float64]

    @property
    def one_ratio(self) -> NDArray[np.float64]:
        """The bending ratio for formulas: 0 where nothing varies, so that there is nothing to count either."""
        return np.nan_to_num(self.bending_ratio)

    def likely_damage(self, slope: float) -> NDArray[np.float64]:
        """Damage of a pass on a curve of this slope, (n, 2): Dirlik's, unless the band misses too much."""
        outside = missed_damage(self.tb, self.tb_whole) > missed_limit(slope)
        return np.where(outside, self.tb_whole, self.dirlik)

    def at(self, rows: NDArray[np.intp]) -> Self:
        """Take some stations."""
        return type(self)(
            bending_ratio=self.bending_ratio[rows],
            mean=self.mean[rows],
            moments=self.moments[:, rows],
            dirlik=self.dirlik[rows],
            tb=self.tb[rows],
            tb_whole=self.tb_whole[rows],
            outside_share=self.outside_share[rows],
            irregularity=self.irregularity[rows],
            peaks_per_s=self.peaks_per_s[rows],
            samples_per_peak=self.samples_per_peak[rows],
        )


def mean_stress(stress: ModalStress, load: EventLoad) -> NDArray[np.float64]:
    """Time mean of the stress at both faces of every station, its constant part included, (n, 2) [MPa]."""
    mean_m, mean_b = (load.stress_factor * (S @ load.level) for S in (stress.membrane, stress.bending))
    return np.stack([mean_m + mean_b, mean_m - mean_b], axis=1)


def member_variances(stress: ModalStress, load: EventLoad) -> NDArray[np.float64]:
    """Variances of membrane and of bending stress over the kept samples, (n, 2), stress factor left out [MPa^2]."""
    C = load.covariance[None]
    return np.stack([np.maximum(quadratic_forms(S, C)[0], 0.0) for S in (stress.membrane, stress.bending)], axis=1)


def estimate_event(stress: ModalStress, load: EventLoad, variances: NDArray[np.float64]) -> Estimate:
    """Estimate of one pass of an event at every station of a block, from the spectrum of its record.

    ``variances`` (n, 2) are the ``member_variances``. The estimates, and the rainflow damage that they are compared
    with, use one bending ratio per station.
    """
    f = load.stress_factor
    std_m, std_b = f * np.sqrt(variances.T)
    bending_ratio = np.repeat(quotient(std_b, std_m + std_b)[:, None], 2, axis=1)
    mean = mean_stress(stress, load)
    if load.moments is None:
        nothing = np.full(mean.shape, np.nan)
        return Estimate(bending_ratio, mean, np.full((4, *mean.shape), np.nan), *(nothing,) * 7)

    moments, above = (_moments(stress, pairs, f) for pairs in (load.moment_pairs, load.pairs_above))
    I_s = stress.rule.ratio_factor(np.nan_to_num(bending_ratio))
    squared_size = (stress.size[:, None] / I_s) ** 2
    equivalent = (moments * squared_size).reshape(4, -1)
    tb = load.duration * tovo_benasciutti_damage_rate(equivalent, stress.rule.law).reshape(mean.shape)
    tb_whole = tb
    if load.pairs_above:
        whole = ((moments + above) * squared_size).reshape(4, -1)
        tb_whole = load.duration * tovo_benasciutti_damage_rate(whole, stress.rule.law).reshape(mean.shape)
    m0, _, m2, m4 = moments
    peaks_per_s = peak_rate(moments, above)
    return Estimate(
        bending_ratio=bending_ratio,
        mean=mean,
        moments=moments,
        dirlik=load.duration * dirlik_damage_rate(equivalent, stress.rule.law).reshape(mean.shape),
        tb=tb,
        tb_whole=tb_whole,
        outside_share=share_above(moments, above),
        irregularity=quotient(m2, np.sqrt(m0 * m4)),
        peaks_per_s=peaks_per_s,
        samples_per_peak=quotient(np.full_like(m0, 1.0 / load.counted.step), peaks_per_s),
    )


def _moments(stress: ModalStress, pairs: tuple[FormPair, ...], factor: float) -> NDArray[np.float64]:
    """Spectral moments of orders 0, 1, 2, 4 at both faces of every station, (4, n, 2) [MPa^2 Hz^p]; 0 of none."""
    if not pairs:
        return np.zeros((4, len(stress), 2))
    return factor**2 * np.concatenate([face_forms(stress.membrane, stress.bending, pair) for pair in pairs])
