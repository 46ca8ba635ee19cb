"""``upsample = "auto"``: by how much each record is upsampled, so that a count of samples does not lose damage.

A record needs the power of 2 that gives the fastest point of the body ``SAMPLES_PER_PEAK`` samples per peak, or
``SAMPLES_AT_VERTICES`` where reversals are read at their vertices. The rate
of peaks of a point is ``sqrt(m_4 / m_2)``, from quadratic forms of its stress (Eq. 18), so no stress at all is faster
than the largest nu with ``det(M_4 - nu^2 M_2) = 0``. Where this bound asks for no upsampling no weld is solved, and
else welds are solved until one of them asks for as much as the bound does.
"""

import logging
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.case import LARGEST_UPSAMPLE
from fatigue.life.bounds.forms import FormPair, face_forms, form_pair
from fatigue.pipeline.mission.event_load import EventLoad, form_pairs
from fatigue.pipeline.mission.record_units import FEWEST_SAMPLES
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.weld_groups import WeldGroups
from fatigue.side_by_side import in_order
from fatigue.spectrum.moments import moment_matrices, segment_spectra
from fatigue.spectrum.outside import peak_rate
from fatigue.weld.structural_stress import StructuralStress

log = logging.getLogger(__name__)

Floats = NDArray[np.float64]
Pairs = tuple[FormPair, ...]  # of orders 0 and 1, and of orders 2 and 4; none of what has no spectrum

SAMPLES_PER_PEAK = 20.0  # 1.5 % of the damage is lost at a slope of 3.6
SAMPLES_AT_VERTICES = 8.0  # the same where reversals are read at their vertices: 1.2 %
LONGEST_SEGMENT = 4096  # samples of a spectrum of a record that is shorter than a segment of the case


def factor_for(peaks_per_s: float, step: float, *, vertex: bool = False) -> int:
    """Smallest power of 2 that gives enough samples to peaks at this rate [1/s], from samples ``step`` [s] apart.

    ``vertex`` says whether reversals are read at their vertices.

    >>> [factor_for(rate, 0.004) for rate in (0.0, 12.5, 12.6, 40.0)]
    [1, 1, 2, 4]
    """
    wanted = (SAMPLES_AT_VERTICES if vertex else SAMPLES_PER_PEAK) * peaks_per_s * step
    return min(LARGEST_UPSAMPLE, 2 ** max(0, math.ceil(math.log2(wanted)))) if wanted > 0.0 else 1


@dataclass(frozen=True, slots=True, eq=False)
class PeakForms:
    """What the rates of peaks of all stresses of an event follow from, and by it the factor that they need.

    ``band`` and ``above`` are its moments up to ``upper_hz`` [Hz] and from there to half the sampling rate, ``step`` is
    that of its samples as they are [s], ``vertex`` says whether reversals are read at their vertices.
    """

    step: float
    vertex: bool
    upper_hz: float
    band: Pairs
    above: Pairs

    def fastest(self, stress: StructuralStress) -> float:
        """Highest rate of peaks among both faces of some stations [1/s], 0 where nothing moves."""
        band, above = (_face_moments(stress, pairs) for pairs in (self.band, self.above))
        return float(np.nanmax(peak_rate(band, above), initial=0.0))

    def factor(self, peaks_per_s: float) -> int:
        """Factor that peaks at this rate [1/s] need."""
        return factor_for(peaks_per_s, self.step, vertex=self.vertex)

    def fastest_of_any(self) -> float:
        """Rate of peaks that no stress exceeds [1/s], whatever it takes of each modal coordinate."""
        if not self.band:
            return 0.0
        of_band = _root(self.band[1], self.upper_hz)
        if not self.above:
            return of_band
        whole = form_pair(*(_matrices(self.band[1]) + _matrices(self.above[1])))
        return max(of_band, _root(whole, 0.5 / self.step))


def peak_forms(load: EventLoad) -> PeakForms:
    """Moments of an event whose samples are as they were given; none of load cases: see ``automatic_factors``."""
    record, highest_hz = load.counted, 0.5 / load.counted.step
    if record.q.shape[1] < FEWEST_SAMPLES:
        return PeakForms(record.step, load.vertex, highest_hz, (), ())
    if load.moments is not None:
        return PeakForms(record.step, load.vertex, load.moments.upper_hz, load.moment_pairs, load.pairs_above)
    segment_s = min(record.q.shape[1], LONGEST_SEGMENT) * record.step
    moments = moment_matrices(segment_spectra(record, segment_s, highest_hz))
    return PeakForms(record.step, load.vertex, highest_hz, form_pairs(moments), ())


def automatic_factors(groups: WeldGroups, loads: Sequence[EventLoad], threads: int | None = None) -> list[int]:
    """Factor of each event, whose records are as they were given; see the module.

    A record of fewer than ``FEWEST_SAMPLES`` is a list of load cases, not the samples of a signal, and is counted as it
    is. One that is shorter than a segment of the case is judged by shorter segments.
    """
    forms = [peak_forms(load) for load in loads]
    enough = np.array([one.factor(one.fastest_of_any()) for one in forms])
    factors = np.ones_like(enough)
    looked_at, at_once = 0, threads or os.cpu_count() or 1
    while looked_at < len(groups) and (unsettled := np.flatnonzero(factors < enough).tolist()):

        def needed(number: int, events: Sequence[int] = unsettled) -> list[int]:
            stress = solve_group(groups, number).stations.treated
            return [forms[i].factor(forms[i].fastest(stress)) for i in events]

        some = range(looked_at, min(looked_at + at_once, len(groups)))
        of_groups = in_order(needed, some, threads)
        factors[unsettled] = np.maximum(factors[unsettled], np.max(of_groups, axis=0))
        looked_at = some.stop
    log.info("%d of %d groups of welds were solved to find by how much to upsample", looked_at, len(groups))
    return [int(factor) for factor in factors]


def _root(pair: FormPair, upper_hz: float) -> float:
    """Square root of the largest ratio m_4 / m_2 of any stress, at most the highest frequency of the spectrum."""
    m2, m4 = pair.weights.T
    ratio = np.divide(m4, m2, out=np.full_like(m2, np.inf), where=m2 > 0.0)
    return min(upper_hz, math.sqrt(ratio.max(initial=0.0)))


def _matrices(pair: FormPair) -> Floats:
    """Put two matrices (m, m) together from their common directions."""
    T = pair.directions
    return np.stack([(T * weights) @ T.T for weights in pair.weights.T])


def _face_moments(stress: StructuralStress, pairs: Pairs) -> Floats:
    """Moments of orders 0, 1, 2, 4 of both faces, (4, n, 2); 0 without a spectrum."""
    if not pairs:
        return np.zeros((4, len(stress.membrane), 2))
    return np.concatenate([face_forms(stress.membrane, stress.bending, pair) for pair in pairs])
