"""Superposition, rainflow counting and damage of a block of points in one pass over time, in single precision.

The stress histories come out of a matrix product, some thousand samples at a time, and are used up before the next
product. Three steps follow per point and surface:

1. `write_reversals` appends the turning points, z = stress at a peak and minus the stress at a valley, so that every
   z[i] + z[i + 1] is a range. The membrane stress carries the same sign.
2. `close_cycles` takes out every range that is smaller than the one before it and not larger than the one after it, all
   of them at once: two neighbours never both qualify, and taking one never disqualifies another, so the cycles are those
   of the stack machine in `rainflow`, in another order. What is left after a few passes, some tens of points, waits for
   the next samples; at the end of the record the stack finishes it.
3. `raise_to_slope` has S^k of all cycles from polynomials for log2 and exp2, and I(r)^(-k/m) from a polynomial in r.

Where single precision cannot tell which of two samples is the extreme, and the choice would show in the damage, the
point is counted again in double precision by `count_block`, and so is every point the shortcuts here do not cover.
`rainflow_simd` has steps 1 and 2 in vector instructions; without that file the plain loops below do the same, bit for bit.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray

from fatigue.life import damage
from fatigue.life.curves import DamageLaw
from fatigue.life.history import Residue
from fatigue.life.rainflow import BlockCount, compiled, count_block

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

CHUNK = 8192  # samples of a block recovered at once
PAD = 32  # room behind a row for vector instructions that write more than they keep
RESIDUE = 1024  # reversals of a point that may wait for the next chunk
FEW = 32  # reversals that are not worth another pass

STEEPEST = 12.0  # slope up to which S^k stays within single precision
FLAT = 1e-6  # stress difference lost to rounding, in units of the rms of the modal stresses
CANCELLATION = 16.0  # modal stresses over their sum from which on single precision is not enough
DOUBT = 2e-7  # relative doubt about the damage that is let pass
