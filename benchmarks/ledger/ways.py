"""Who counts, and how: ours and every rival, each with the fastest use that its documentation tells.

A way is made ready once, then called on signals (n, t) in double precision, and says what it found. Loops over signals
are part of a way where its package takes one signal at a time.
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.ledger.signals import RATE

Floats = NDArray[np.float64]

SLOPE = 5.0
CLASSES = 4096


@dataclass(frozen=True, slots=True)
class Found:
    """Cycles of all signals: their number, ``sum n S^k``, the largest range, and all ranges where a way has them.

    ``halves`` ascend; a full cycle stands twice, a half cycle once.
    """

    cycles: float
    power_sum: float
    largest: float
    halves: Floats | None = None


@dataclass(frozen=True, slots=True)
class Way:
    """One use of one package.

    ``residue``: "half" or "repeat", as of ``fatigue``; ``ready`` imports what is needed and returns the call.
    """

    name: str
    package: str
    precision: str
    residue: str
    ready: Callable[[], Callable[..., Any]]
    found: Callable[[Any], Any]
    remark: str = ""


def listed(each: Iterable[tuple[Floats, Floats]]) -> Found:
    """What lists of ranges and counts, one for each signal, say."""
    ranges, counts = (np.concatenate(some) for some in zip(*each, strict=True))
    halves = np.repeat(ranges, np.rint(2.0 * counts).astype(int))
    largest = float(ranges.max(initial=0.0))
    return Found(float(counts.sum()), float((counts * ranges**SLOPE).sum()), largest, np.sort(halves))


def summed(block: Any) -> Found:
    """What a block of points counted by ``fatigue`` says."""
    return Found(float(block.cycles.sum()), float(block.power_sum.sum()), float(block.max_range.max()))


def _ours_listed() -> Callable[[Floats], Any]:
    from fatigue.life.counting.rainflow import rainflow

    return lambda signals: [(c.range, c.count) for c in (rainflow(x, "half") for x in signals)]


def _ours_summed(single: bool) -> Callable[[Floats], Any]:
    """Signals as modes; a point has two of them, on its top and on its bottom surface."""
    from fatigue.life.counting.block import BlockStress
    from fatigue.life.counting.count import count
    from fatigue.life.counting.record import CountedRecord
    from fatigue.life.counting.single.prepare import single_record
    from fatigue.life.curves import DamageLaw
    from fatigue.life.rule import CycleRule

    law = DamageLaw(np.array([SLOPE]), np.array([0.0]), np.array([]), 0.0)
    rule = CycleRule(law, uses_bending_ratio=False)

    def counted(signals: Floats) -> Any:
        points = len(signals) // 2
        half = 0.5 * np.eye(points)
        stress = BlockStress(np.hstack([half, half]), np.hstack([half, -half]), np.ones(points), np.zeros((points, 2)))
        return count(stress, CountedRecord(signals, "half", single_record(signals) if single else None), rule)

    return counted


def _rainflow() -> Callable[[Floats], Any]:
    import rainflow

    def counted(signals: Floats) -> Any:
        each = (np.array([(c[0], c[2]) for c in rainflow.extract_cycles(x.tolist())]) for x in signals)
        return [(cycles[:, 0], cycles[:, 1]) for cycles in each]

    return counted


def _pyyeti() -> Callable[[Floats], Any]:
    from pyyeti import cyclecount

    def counted(signals: Floats) -> Any:
        each = (cyclecount.rainflow(x[cyclecount.findap(x)], use_pandas=False) for x in signals)
        return [(2.0 * cycles[:, 0], cycles[:, 2]) for cycles in each]

    return counted


def _pylife() -> Callable[[Floats], Any]:
    from pylife.stress import rainflow

    def counted(signals: Floats) -> Any:
        each = []
        for x in signals:
            loops = rainflow.LoopValueRecorder()
            left = rainflow.FourPointDetector(recorder=loops).process(x).residuals
            closed, residue = np.abs(loops.values_to - loops.values_from), np.abs(np.diff(left))
            counts = np.repeat([1.0, 0.5], [closed.size, residue.size])
            each.append((np.concatenate([closed, residue]), counts))
        return each

    return counted


def _fatpack(classes: int) -> Callable[[Floats], Any]:
    import fatpack

    def counted(signals: Floats) -> Any:
        return [(S, np.ones(S.size)) for S in (fatpack.find_rainflow_ranges(x, k=classes) for x in signals)]

    return counted


def _flife() -> Callable[[Floats], Any]:
    import FLife

    def counted(signals: Floats) -> Any:
        total = 0.0
        for x in signals:
            data = FLife.SpectralData(input={"time_history": x, "dt": 1.0 / RATE})
            total += x.size / RATE / FLife.Rainflow(data).get_life(1.0, SLOPE, range=True)
        return total

    return counted


def _ours_spectral(method: str) -> Callable[[Floats, Floats], Any]:
    from fatigue.life.curves import DamageLaw
    from fatigue.spectrum import methods

    law = DamageLaw(np.array([SLOPE]), np.array([0.0]), np.array([]), 0.0)
    rate = {"Dirlik": methods.dirlik_damage_rate, "Tovo-Benasciutti": methods.tovo_benasciutti_damage_rate}[method]
    return lambda f, densities: rate(np.trapezoid(_weighted(f, densities), f, axis=2), law)


def _weighted(f: Floats, densities: Floats) -> Floats:
    return np.stack([f**order * densities for order in (0, 1, 2, 4)])


def _flife_spectral(method: str) -> Callable[[Floats, Floats], Any]:
    import FLife

    named = {"Dirlik": FLife.Dirlik, "Tovo-Benasciutti": FLife.TovoBenasciutti}[method]
    constant = 2.0**-SLOPE  # its lives are of amplitudes

    def rates(f: Floats, densities: Floats) -> Floats:
        each = (named(FLife.SpectralData(input={"PSD": density, "f": f})) for density in densities)
        return np.array([1.0 / estimator.get_life(constant, SLOPE) for estimator in each])

    return rates


OURS = "modal-weld-fatigue"

COUNTING = (
    Way(
        "fatigue, sums in single precision",
        *(OURS, "float32", "half"),
        lambda: _ours_summed(single=True),
        summed,
        "all signals in one call; the copy of the records in single precision is included",
    ),
    Way(
        "fatigue, sums in double precision",
        *(OURS, "float64", "half"),
        lambda: _ours_summed(single=False),
        summed,
        "all signals in one call",
    ),
    Way("fatigue, every cycle", OURS, "float64", "half", _ours_listed, listed, "ranges, means, counts and instants"),
    Way(
        "pyyeti",
        "pyyeti",
        "float64",
        "half",
        _pyyeti,
        listed,
        "`findap`, which takes steps within its tolerance for level, then `rainflow`",
    ),
    Way(
        "pyLife",
        *("pylife", "float64", "half"),
        _pylife,
        listed,
        "`FourPointDetector`; it leaves the residue, whose ranges are counted here as half cycles",
    ),
    Way(
        "fatpack, 64 classes",
        *("fatpack", "float64", "repeat"),
        lambda: _fatpack(64),
        listed,
        "`find_rainflow_ranges` as by default: samples are rounded to classes; the residue is counted twice over",
    ),
    Way(
        f"fatpack, {CLASSES} classes",
        "fatpack",
        "float64",
        "repeat",
        lambda: _fatpack(CLASSES),
        listed,
        "finer classes",
    ),
    Way(
        "FLife",
        *("FLife", "float64", "repeat"),
        _flife,
        lambda total: Found(math.nan, float(total), math.nan),
        "`Rainflow.get_life`: fatpack with 512 classes; it tells the life alone, and makes a spectrum before",
    ),
    Way("rainflow", "rainflow", "float64", "half", _rainflow, listed, "`extract_cycles`"),
)
"""Ways of cycle counting."""

METHODS = ("Dirlik", "Tovo-Benasciutti")
SPECTRAL = tuple(
    way
    for method in METHODS
    for way in (
        Way(
            f"fatigue, {method}",
            *(OURS, "float64", ""),
            lambda method=method: _ours_spectral(method),  # type: ignore[misc]
            np.asarray,
            "all spectra in one call",
        ),
        Way(
            f"FLife, {method}",
            *("FLife", "float64", ""),
            lambda method=method: _flife_spectral(method),  # type: ignore[misc]
            np.asarray,
            "`SpectralData`, then `get_life` of each spectrum",
        ),
    )
)
"""Ways of estimating damage from spectra."""

NOT_ASKED = {
    "pyyeti": "no estimate of damage from a spectrum by Dirlik or Tovo-Benasciutti",
    "pylife": "no estimate of damage from a spectrum by Dirlik or Tovo-Benasciutti",
    "fatpack": "no frequency domain",
    "rainflow": "no frequency domain",
}
"""Packages that the second table cannot have, and why."""
