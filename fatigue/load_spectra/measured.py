"""A range spectrum from elsewhere, measured or of a standard, beside those of the mission: what it does at a point."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.life.load_spectrum import LoadCycles, damage_equivalent, power_sums, range_spectrum
from fatigue.life.rule import cycle_damage, equivalent_range
from fatigue.load_spectra.classes import Classes
from fatigue.load_spectra.gathered import PointSpectra, exponents_of, first_slope
from fatigue.load_spectra.points import rows_of_keys
from fatigue.readers.neutral.tables import open_table
from fatigue.why.points import Points

Floats = NDArray[np.float64]

MEASURED = "(measured)"
TIMES_APART = 20.0  # largest ranges further apart are rather units than loads
LARGE_MPA = 1000.0  # a range that no weld survives many cycles of: Pa, or amplitudes in another unit


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """A spectrum to compare with, a row for each class of it.

    Attributes
    ----------
    range, count : (r,) structural stress range [MPa], and how often in ``km``
    km : distance it stands for [km]
    bending_ratio : (r,) ratio of its damage; None: that of the point's own cycles is taken
    row : (r,) row of its point in ``nodes.parquet``, -1: of every point
    file : name
    warnings : of the file, columns that are not known
    """

    range: Floats
    count: Floats
    km: float
    bending_ratio: Floats | None
    row: NDArray[np.int64]
    file: str
    warnings: tuple[Problem, ...] = ()

    def at(self, row: int) -> "Measured | None":
        """What it says of the point in a row of ``nodes.parquet``; None: nothing."""
        own = (self.row == row) | (self.row < 0)
        if not own.any():
            return None
        ratio = None if self.bending_ratio is None else self.bending_ratio[own]
        return replace(self, range=self.range[own], count=self.count[own], bending_ratio=ratio, row=self.row[own])


def read_measured(folder: Path, path: Path, km: float) -> Measured:
    """A table of ``range_MPa`` and ``count``, with ``bending_ratio`` and the key of a point if it has them.

    Raises
    ------
    DataError : no such columns, values that make no sense, or unknown points
    """
    table = open_table(path, texts=("weld", "surface"))
    has_points = "weld" in table.position
    key = ("weld", "part", "order", "node", "surface") if has_points else ()
    table.expect(("range_MPa", "count"), ("bending_ratio", *key), strict=False)
    S = table.numbers("range_MPa", least=0.0).astype(np.float64)
    n = table.numbers("count", least=0.0).astype(np.float64)
    ratio: Floats | None = None
    if "bending_ratio" in table.position:
        ratio = table.numbers("bending_ratio", least=0.0).astype(np.float64)
        table.report(ratio > 1.0, "bad_value", "bending_ratio", "a ratio is above 1", "Give r from 0 to 1")
    if not table.rows:
        table.problems.append(Problem("no_rows", path.name, "has no rows", "Give at least one range and its count"))
    table.refuse()
    beside = ("range_MPa", "count", *(("bending_ratio",) if ratio is not None else ()))
    row = rows_of_keys(folder, table, beside) if has_points else np.full(table.rows, -1, dtype=np.int64)
    return Measured(S, n, km, ratio, row, path.name, tuple(table.warnings))


def refuse_absent(measured: Measured, rows: NDArray[np.int64]) -> None:
    """Refuse a spectrum of points that are not among those chosen, given by their rows in ``nodes.parquet``.

    Raises
    ------
    DataError : none of its points is
    """
    if not ((measured.row < 0) | np.isin(measured.row, rows)).any():
        what, remedy = "none of its points is among those chosen", "Name them in a table for --points"
        raise DataError(Problem("no_common_point", measured.file, what, remedy))


def measured_spectra(
    measured: Measured, points: Points, i: int, mission: PointSpectra, classes: Classes, given: Floats | None
) -> PointSpectra:
    """Range spectrum and damage of a measured spectrum at a point, as an event of its own, per km.

    Without a ratio of its own its damage is with the ``bending_ratio`` of the mission there, and 0 where nothing
    damages; f_M of a mean stress is not in it.
    """
    S, per_km = measured.range, measured.count / measured.km
    cycles = LoadCycles(np.zeros_like(S), S, S, per_km)
    exponents, rule = exponents_of(points, i, given), points.rule[i]
    own = np.nan_to_num(mission.bending_ratio)
    r = np.full(len(S), own) if measured.bending_ratio is None else measured.bending_ratio
    damage = per_km * cycle_damage(equivalent_range(S, points.size[i], rule.ratio_factor(r), 1.0), rule.law)
    power_sum = power_sums(cycles, exponents)
    return PointSpectra(
        event=MEASURED,
        passes_per_km=np.nan,
        ranges=range_spectrum(cycles, classes.ranges, first_slope(points, i)),
        range_mean=None,
        from_to=None,
        crossings=None,
        cycles=float(per_km.sum()),
        power_sum=power_sum,
        del_MPa=damage_equivalent(power_sum, exponents, 1.0),
        del_reference="1 per km",
        damage=float(damage.sum()),
        damage_ratio=float(damage @ r),
    )


def doubts(measured: Measured, points: Points, rows: NDArray[np.int64], largest: float) -> list[Problem]:
    """What cannot be told of a measured spectrum from its file, each once; ``largest``: range of the mission [MPa]."""
    found: list[Problem] = []
    if (measured.row < 0).any() and len(points) > 1:
        what = f"names no point, so it stands beside each of {len(points)} points, though it was measured at one place"
        remedy = "Give the columns weld, order and surface, and part where a weld has several"
        found.append(Problem("measured_point", measured.file, what, remedy))
    uses_ratio = [bool(rule.depends_on_bending) for rule in points.rule]
    if measured.bending_ratio is None and any(uses_ratio):
        what = "has no bending ratio, so its damage is with the one of the mission's own damage at each point"
        remedy = "Give a column bending_ratio, from gauges on both faces"
        found.append(Problem("measured_ratio", measured.file, what, remedy))
    if any(rule.mean_stress or rule.stress_ratio != "none" for rule in points.rule):
        what = "has no mean stress, so that f_M or f(R) is not in its damage, as it is in that of the mission"
        found.append(Problem("measured_mean", measured.file, what, 'Compare with mean_stress = "none"'))
    top = float(measured.range.max(initial=0.0))
    if top > LARGE_MPA or (largest > 0.0 and top > TIMES_APART * largest):
        what = f"reaches a range of {top:.4g} MPa, the mission {largest:.4g} MPa"
        found.append(Problem("measured_unit", measured.file, what, "Check its unit, MPa, and that it gives ranges"))
    elif 0.0 < top < largest / TIMES_APART:
        what = f"reaches a range of {top:.4g} MPa only, the mission {largest:.4g} MPa"
        found.append(Problem("measured_unit", measured.file, what, "Check its unit, MPa, and that it gives ranges"))
    here = np.isin(rows, measured.row) | (measured.row < 0).any()
    if not here.all():
        what = f"says nothing of {int((~here).sum())} of the {len(points)} points"
        found.append(
            Problem("measured_point", measured.file, what, "Give rows for them, or leave them out of --points")
        )
    return found
