"""What an event brings to every station: its record ready to be counted, and its second-order statistics."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.forms import FormPair, form_pair
from fatigue.life.counting.record import CountedRecord, SingleRecord
from fatigue.life.counting.single.prepare import single_record
from fatigue.life.records.history import ModalHistory, Residue, mean_and_covariance
from fatigue.life.records.spool import Samples, Spool, create_spool
from fatigue.readers.neutral.event.event_record import EventRecord
from fatigue.spectrum.moments import MomentMatrices, Spectra, moment_matrices, spectra_above
from fatigue.spectrum.trust import TrustMatrices, trust_matrices

HELD_SINGLE = 256e6  # bytes of one record, and of all that are longer than they were given


@dataclass(frozen=True, slots=True, eq=False)
class EventLoad:
    """What an event brings to every station: the record to be counted and its second-order statistics.

    Attributes
    ----------
    counted : the kept record, upsampled as asked, on which cycles are counted; c coordinates, modes and unit loads
    single : the same prepared for the kernel in single precision; None: count in double precision
    residue : how the rest of the count is closed
    stress_factor : partial or allowance factor on all stresses of the event
    duration : duration of one pass [s]
    mean : (c,) time mean of q over the kept samples
    offset : (c,) constant of each coordinate, carried beside the samples so that ranges keep their last bit
    covariance : (c, c) covariance of q over the kept samples
    moments, trust : moment matrices of q and what judging needs; None for a record shorter than one segment
    vertex : whether reversals are read at the vertices of parabolas through their samples
    upsample : how many samples one has become; mean and covariance are of the samples as they were
    moment_pairs : matrices of orders 0 and 1, and of orders 2 and 4, ready for all stations; empty without a spectrum
    pairs_above : the same of what lies above the band of the spectrum; empty where nothing does
    top_mode_hz : highest frequency of a normal mode [Hz], None where there is none
    """

    counted: ModalHistory
    single: SingleRecord | None
    residue: Residue
    stress_factor: float
    duration: float
    mean: NDArray[np.float64]
    offset: NDArray[np.float64]
    covariance: NDArray[np.float64]
    vertex: bool
    upsample: int
    moments: MomentMatrices | None
    moment_pairs: tuple[FormPair, ...]
    pairs_above: tuple[FormPair, ...]
    trust: TrustMatrices | None
    top_mode_hz: float | None

    @property
    def level(self) -> NDArray[np.float64]:
        """Time mean of every coordinate over the kept samples, its constant included, (m,): what mean stress is of."""
        return self.mean + self.offset

    @property
    def record(self) -> CountedRecord:
        """The record as it is counted."""
        return CountedRecord(self.counted.q, self.residue, self.single, self.vertex)

    @property
    def is_upsampled(self) -> bool:
        """Whether mean and covariance are of other samples than those that are counted."""
        return self.upsample > 1

    @property
    def known(self) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Mean and covariance of the samples that are counted; None where those known are of other samples."""
        return None if self.is_upsampled else (self.mean, self.covariance)


@dataclass(frozen=True, slots=True)
class HowCounted:
    """How the record of an event is to be counted.

    ``residue``, ``stress_factor`` and ``vertex`` are the same as of ``EventLoad``; ``upsample`` is how many samples one
    of the file becomes; ``single``: by the kernel in single precision, its copy ``held`` in memory or not.
    """

    residue: Residue
    stress_factor: float = 1.0
    upsample: int = 1
    single: bool = False
    held: bool = True
    vertex: bool = False


def prepare_event(
    history: ModalHistory, how: HowCounted, spectra: Spectra | None, top_mode_hz: float | None
) -> EventLoad:
    """What all stations share of an event, from its kept record in memory."""
    record = EventRecord(history, history.duration)
    return as_counted(of_samples(record, how, spectra, top_mode_hz), record, how)


def of_samples(record: EventRecord, how: HowCounted, spectra: Spectra | None, top_mode_hz: float | None) -> EventLoad:
    """Statistics of the kept record of an event, beside its samples as they are; ``as_counted`` comes next."""
    history = record.history
    trust = None if spectra is None else trust_matrices(history, spectra)
    if trust is None:
        moments, (mean, covariance) = None, mean_and_covariance(history.q)
    else:
        moments, mean, covariance = trust.moments, trust.record.mean, trust.record.covariance
    above = None if spectra is None else spectra_above(spectra)
    return EventLoad(
        counted=history,
        single=None,
        residue=how.residue,
        stress_factor=how.stress_factor,
        duration=record.duration,
        mean=mean,
        offset=np.zeros(len(mean)),
        covariance=covariance,
        vertex=how.vertex,
        upsample=1,
        moments=moments,
        moment_pairs=() if moments is None else form_pairs(moments),
        pairs_above=() if above is None else form_pairs(moment_matrices(above)),
        trust=trust,
        top_mode_hz=top_mode_hz,
    )


def as_counted(load: EventLoad, record: EventRecord, how: HowCounted, scratch: Path | None = None) -> EventLoad:
    """The same event with its ``record`` upsampled, and prepared for the kernel in single precision, as asked.

    ``scratch``: folder for whatever is as large as the record, None: in memory.
    """
    counted = record.upsampled(how.upsample, how.residue, scratch and scratch / "upsampled")
    factor = 1 if record.is_static else max(how.upsample, record.refined)
    load = replace(load, counted=counted, upsample=factor)
    single = kept_single_record(counted.q, scratch, load.known, held=how.held) if how.single else None
    return replace(load, single=single)


def without_spectrum(load: EventLoad) -> EventLoad:
    """The event without what only the frequency domain needs: what is only counted has no use for it."""
    return replace(load, moments=None, moment_pairs=(), pairs_above=(), trust=None)


def form_pairs(moments: MomentMatrices) -> tuple[FormPair, ...]:
    """Moment matrices of orders 0 and 1, and of orders 2 and 4, ready for all stations."""
    return form_pair(*moments.matrix[:2]), form_pair(*moments.matrix[2:])


def held_copies(modes: int, given: Sequence[int], counted: Sequence[int]) -> list[bool]:
    """Whether the copy in single precision of each event is held in memory.

    ``given`` and ``counted`` are the samples of its record as it was read, and as it is counted. Copies that are no
    longer than ``HELD_SINGLE`` are held, the shortest first, as long as all of them together are no longer than that
    or than all records were.
    """
    sizes = 4.0 * modes * np.asarray(counted)
    order = np.argsort(sizes, kind="stable")
    held = np.empty(len(sizes), dtype=np.bool_)
    held[order] = np.cumsum(sizes[order]) <= max(HELD_SINGLE, 4.0 * modes * sum(given))
    return [bool(fits) for fits in held & (sizes <= HELD_SINGLE)]


def kept_single_record(
    q: Samples,
    scratch: Path | None,
    known: tuple[NDArray[np.float64], NDArray[np.float64]] | None,
    *,
    held: bool,
) -> SingleRecord:
    """Modal coordinates prepared for the kernel in single precision.

    Of a record on disk the copy in single precision is ``held`` in memory or goes to the folder ``scratch``. ``known``
    are their mean and covariance, None: to be computed.

    Raises
    ------
    NumericalError : a sample is not finite; DataError : the disk is full
    """
    if held or not isinstance(q, Spool) or scratch is None:
        return single_record(q, known=known)
    path = scratch / f"{q.path.parent.name}-{q.path.name}-normalised"  # one folder may serve several events
    return single_record(q, create_spool(path, q.shape, np.dtype(np.float32)), known)
