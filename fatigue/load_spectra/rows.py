"""Rows of the tables of load spectra: some points at a time, one signal at a time."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.life.load_spectrum import Cells
from fatigue.life.mission import range_at_2e6
from fatigue.load_spectra.classes import Classes
from fatigue.load_spectra.gathered import PointSpectra
from fatigue.load_spectra.signals import SignalSpectra
from fatigue.results import coded
from fatigue.why.points import Points

Floats = NDArray[np.float64]
PER_1E6_KM = 1e6
FACES = ("top", "bottom")


def rows_of_points(
    points: Points,
    spectra: Sequence[Sequence[PointSpectra]],
    exponents: Sequence[Floats],
    classes: Classes,
    target_km: float,
) -> dict[str, dict[str, Any]]:
    """Rows of every table that has points, for some points, each with its spectra, event after event."""
    named = _Named(points, spectra)
    return {
        "spectrum": _spectrum(named, classes),
        "range_mean": _matrix(named, lambda of: of.range_mean, ("range", classes.ranges), ("mean", classes.levels)),
        "from_to": _matrix(named, lambda of: of.from_to, ("from", classes.levels), ("to", classes.levels)),
        "level_crossings": _crossings(named, classes),
        "equivalent": _equivalent(named, exponents, target_km),
    }


class _Named:
    """Spectra of some points one after the other, and the key columns of their rows."""

    def __init__(self, points: Points, spectra: Sequence[Sequence[PointSpectra]]) -> None:
        self.points = points
        self.point = np.repeat(np.arange(len(points)), [len(own) for own in spectra])
        self.spectra = [of for own in spectra for of in own]

    def __iter__(self) -> Iterator[PointSpectra]:
        return iter(self.spectra)

    def columns(self, rows: NDArray[np.int64]) -> dict[str, Any]:
        """Key columns and event, so many rows for each spectrum."""
        which = np.repeat(np.arange(len(self.spectra)), rows)
        at, points = self.point[which], self.points
        return {
            "weld": _names(at, points.weld.tolist()),
            "part": points.part[at],
            "node": points.node[at],
            "order": points.order[at],
            "surface": coded(points.face[at], FACES),
            "event": _names(which, [of.event for of in self.spectra]),
        }


def _names(which: NDArray[np.int64], names: Sequence[str]) -> pa.DictionaryArray:
    """Text column ``names[which]``; a name that comes several times has one code."""
    place = {name: i for i, name in enumerate(dict.fromkeys(names))}
    return coded(np.array([place[name] for name in names], dtype=np.int32)[which], list(place))


def _spectrum(named: _Named, classes: Classes) -> dict[str, Any]:
    n, each = len(named.spectra), len(classes.ranges) - 1
    return {
        **named.columns(np.full(n, each)),
        "lower_MPa": np.tile(classes.ranges[:-1], n),
        "upper_MPa": np.tile(classes.ranges[1:], n),
        "count_per_km": np.concatenate([of.ranges.count for of in named]),
        "power_sum_per_km": np.concatenate([of.ranges.power_sum for of in named]),
        "max_MPa": np.concatenate([of.ranges.largest for of in named]),
        "exceedance_per_1e6_km": PER_1E6_KM * np.concatenate([of.ranges.reached for of in named]),
    }


def _matrix(
    named: _Named,
    matrix: Callable[[PointSpectra], Cells | None],
    row: tuple[str, Floats],
    column: tuple[str, Floats],
) -> dict[str, Any]:
    """Rows of the cells of a matrix, whose rows and columns are named and have edges."""
    nothing = np.zeros(0, dtype=np.intp)
    found = [matrix(of) or Cells(nothing, nothing, np.zeros(0)) for of in named]
    rows = np.concatenate([of.row for of in found])
    columns = np.concatenate([of.column for of in found])
    (of_row, edges), (of_column, others) = row, column
    return {
        **named.columns(np.array([len(of.row) for of in found])),
        f"{of_row}_lower_MPa": edges[:-1][rows],
        f"{of_row}_upper_MPa": edges[1:][rows],
        f"{of_column}_lower_MPa": others[:-1][columns],
        f"{of_column}_upper_MPa": others[1:][columns],
        "count_per_km": np.concatenate([of.count for of in found]),
    }


def _crossings(named: _Named, classes: Classes) -> dict[str, Any]:
    known = [of.crossings is not None for of in named]
    each = np.where(known, len(classes.levels), 0)
    return {
        **named.columns(each),
        "level_MPa": np.tile(classes.levels, sum(known)),
        "up_crossings_per_km": np.concatenate([of.crossings for of in named if of.crossings is not None]),
    }


def _equivalent(named: _Named, exponents: Sequence[Floats], target_km: float) -> dict[str, Any]:
    m = [exponents[point] for point in named.point.tolist()]
    each = np.array([len(own) for own in m])
    equivalent = np.concatenate([equivalents(of, own, target_km) for of, own in zip(named, m, strict=True)])

    def repeated(value: Callable[[PointSpectra], float]) -> Floats:
        return np.repeat([value(of) for of in named], each)

    return {
        **named.columns(each),
        "exponent": np.concatenate(m),
        "equivalent_range_2e6_MPa": equivalent,
        "equivalent_amplitude_2e6_MPa": 0.5 * equivalent,
        "del_MPa": np.concatenate([of.del_MPa for of in named]),
        "del_reference": [of.del_reference for of, n in zip(named, each, strict=True) for _ in range(n)],
        "power_sum_per_km": np.concatenate([of.power_sum for of in named]),
        "cycles_per_km": repeated(lambda of: of.cycles),
        "passes_per_km": repeated(lambda of: of.passes_per_km),
        "max_range_MPa": repeated(lambda of: of.max_range),
        "damage_per_km": repeated(lambda of: of.damage),
        "bending_ratio": repeated(lambda of: of.bending_ratio),
    }


def equivalents(of: PointSpectra, exponents: Floats, target_km: float) -> Floats:
    """Constant range [MPa] that does the same in 2e6 cycles over the target, by exponent; NaN of a sum below 0."""
    sums = np.where(of.power_sum >= 0.0, of.power_sum, np.nan)
    return np.array([float(range_at_2e6(np.array(s), m, target_km)) for s, m in zip(sums, exponents, strict=True)])


def rows_of_signal(spectra: SignalSpectra, exponent: float) -> dict[str, Any]:
    """Rows of ``signals.parquet`` of one coordinate."""
    n, each, signal = len(spectra.event), len(spectra.edges) - 1, spectra.signal
    rows = n * each
    same = np.zeros(rows, dtype=np.int32)
    return {
        "signal": coded(same, [signal.column]),
        "mode": np.full(rows, None if signal.mode < 0 else signal.mode),
        "unit_load": coded(same if signal.unit_load else same - 1, [signal.unit_load]),
        "unit": coded(same, [signal.unit]),
        "event": coded(np.repeat(np.arange(n), each), spectra.event),
        "lower": np.tile(spectra.edges[:-1], n),
        "upper": np.tile(spectra.edges[1:], n),
        "count_per_km": np.concatenate([of.count for of in spectra.ranges]),
        "exponent": np.full(rows, exponent),
        "power_sum_per_km": np.concatenate([of.power_sum for of in spectra.ranges]),
        "largest": np.concatenate([of.largest for of in spectra.ranges]),
        "exceedance_per_1e6_km": PER_1E6_KM * np.concatenate([of.reached for of in spectra.ranges]),
    }
