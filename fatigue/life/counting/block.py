"""A block of points: what is given of it, and what is kept of its cycles."""

from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

BINS_PER_DECADE = 64
HISTOGRAM_EDGES: Floats = np.logspace(-3.0, 5.0, 8 * BINS_PER_DECADE + 1)
HISTOGRAM_BINS = HISTOGRAM_EDGES.size - 1


@dataclass(frozen=True, slots=True, eq=False)
class BlockStress:
    """Stress of n points per unit modal coordinate, and what is their own in the damage of a cycle.

    Attributes
    ----------
    membrane, bending : (n, m) membrane stress, and bending stress of the top surface [MPa per unit modal coordinate]
    size : (n,) factor of the thickness on the range
    same_ratio : (n, 2) the one bending ratio of ``BlockCount.damage_same_ratio``
    shear_factor : (n, 2) factor on dS of ``BlockCount.damage_with_shear``; None: not wanted
    offset : (n, 2) constant stress of each surface [MPa], never added to samples, so that no range loses a bit: it
        enters means and stress ratios, and f_M with them; None: 0
    """

    membrane: Floats
    bending: Floats
    size: Floats
    same_ratio: Floats
    shear_factor: Floats | None = None
    offset: Floats | None = None

    def __len__(self) -> int:
        """Count the points."""
        return len(self.size)

    def at(self, rows: slice | NDArray[np.intp]) -> Self:
        """Take some points."""
        shear = None if self.shear_factor is None else self.shear_factor[rows]
        offset = None if self.offset is None else self.offset[rows]
        of_rows = (self.membrane[rows], self.bending[rows], self.size[rows], self.same_ratio[rows])
        return type(self)(*of_rows, shear, offset)

    @property
    def level(self) -> Floats:
        """Constant stress of each surface (n, 2) [MPa], 0 where none is given."""
        return np.zeros((len(self), 2)) if self.offset is None else self.offset

    def beside(self, others: Self) -> Self:
        """Put other points behind these; a shear factor stays where both have one."""
        shear = offset = None
        if self.shear_factor is not None and others.shear_factor is not None:
            shear = np.concatenate([self.shear_factor, others.shear_factor])
        if self.offset is not None or others.offset is not None:
            offset = np.concatenate([self.level, others.level])
        return type(self)(
            np.concatenate([self.membrane, others.membrane]),
            np.concatenate([self.bending, others.bending]),
            np.concatenate([self.size, others.size]),
            np.concatenate([self.same_ratio, others.same_ratio]),
            shear,
            offset,
        )


@dataclass(frozen=True, slots=True, eq=False)
class BlockCount:
    """What is kept of the cycles of n points; every array is (n, 2): top surface, bottom surface.

    Attributes
    ----------
    damage : sum of n d(dS)
    damage_same_ratio : sum of n d(dS) with one bending ratio for all cycles of a point, without the mean-stress factor
    damage_with_shear : sum of n d(dS) with the shear factor on dS; 0 for a straight law, where damage scales with it
    damage_mean_stress : sum of n d(dS) with the mean-stress factor; NaN without a yield stress
    cycles : sum of n
    power_sum : sum of n S**k of the structural stress ranges, k the first slope of the law [MPa**k]
    max_range : largest structural stress range [MPa]
    r_largest : stress ratio min/max of the largest cycle, offset included; NaN without a cycle or where max = 0
    max_equivalent_range : largest dS
    mean : mean of the structural stress samples and the offset [MPa]; NaN without samples
    kurtosis : fourth over squared second central moment of the samples, 3 if Gaussian; NaN of a constant row
    histogram : (n, 2, HISTOGRAM_BINS, 2) sum of n and sum of n dS**k between the ``HISTOGRAM_EDGES`` of dS, ranges
        beyond them in the end bins; (n, 2, 0, 2) for a straight law, where damage scales with load**k;
        (n, 2, 2 HISTOGRAM_BINS, 2) where ranges S are asked for too, under any law: their bins follow those of dS
    """

    damage: Floats
    damage_same_ratio: Floats
    damage_with_shear: Floats
    damage_mean_stress: Floats
    cycles: Floats
    power_sum: Floats
    max_range: Floats
    r_largest: Floats
    max_equivalent_range: Floats
    mean: Floats
    kurtosis: Floats
    histogram: Floats

    def at(self, rows: slice | NDArray[np.intp]) -> Self:
        """Take some points."""
        return type(self)(*(getattr(self, field.name)[rows] for field in fields(self)))
