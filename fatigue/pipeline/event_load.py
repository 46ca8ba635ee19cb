"""What an event brings to every station: its record ready to be counted, and its second-order statistics."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.history import ModalHistory, Residue, upsampled
from fatigue.life.rainflow_fast import Record, record_of
from fatigue.spectrum.diagnosis import DiagnosisMatrices, diagnosis_matrices
from fatigue.spectrum.moments import MomentMatrices, Spectra, moment_matrices


@dataclass(frozen=True, slots=True, eq=False)
class EventLoad:
    """What an event brings to every station: the record to be counted and its second-order statistics.

    Attributes
    ----------
    counted : the kept record, upsampled as asked, on which cycles are counted
    single : the same prepared for the kernel in single precision; None: count in double precision
    residue : how the rest of the count is closed
    stress_factor : partial or allowance factor on all stresses of the event
    duration : duration of one pass [s]
    mean : (m,) time mean of q over the kept samples
    covariance : (m, m) covariance of q over the kept samples
    moments, diagnosis : moment matrices of q and what the diagnosis needs, None for a record shorter than one segment
    top_mode_hz : highest frequency of a normal mode [Hz], None where there is none
    """

    counted: ModalHistory
    single: Record | None
    residue: Residue
    stress_factor: float
    duration: float
    mean: NDArray[np.float64]
    covariance: NDArray[np.float64]
    moments: MomentMatrices | None
    diagnosis: DiagnosisMatrices | None
    top_mode_hz: float | None


def prepare_event(
    history: ModalHistory,
    residue: Residue,
    stress_factor: float,
    upsample: int,
    spectra: Spectra | None,
    top_mode_hz: float | None,
    *,
    single: bool = False,
) -> EventLoad:
    """Compute once per event what all stations share, from its kept record; ``single``: for the fast kernel."""
    q = history.q.astype(np.float64)
    centred = q - q[:, :1]  # from the first sample, so that a record at rest has exactly no variance
    offset = centred.mean(axis=1)
    mean = q[:, 0] + offset
    centred -= offset[:, None]
    counted = upsampled(history, upsample, residue)
    return EventLoad(
        counted=counted,
        single=record_of(counted.q) if single else None,
        residue=residue,
        stress_factor=stress_factor,
        duration=history.duration,
        mean=mean,
        covariance=centred @ centred.T / q.shape[1],
        moments=None if spectra is None else moment_matrices(spectra),
        diagnosis=None if spectra is None else diagnosis_matrices(history, spectra),
        top_mode_hz=top_mode_hz,
    )
