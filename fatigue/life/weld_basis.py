"""Close bounds of the damage of all points of a weld from the few histories that their stresses are made of.

The stresses of a weld have one source: some 5 combinations u = B q of 100 modal coordinates make all its points up to a
thousandth. So s = L u + e, and the product of every point with every mode is replaced by that of every point with u.
By `screening`, bounds follow from the range and from the total variation V_q of f(s) = s |s|^(q-1). Those of a = L u
are found in a loop over time; what e adds is bounded. Every step is off by the errors at its two ends,

    V_q(s) <= V_q(a) + 2 sum |f(s) - f(a)| <= V_q(a) + 2 q sum |e| x^(q-1) <= V_q(a) + 2 q ||e||_2 ||x||_(2q-2)^(q-1)

with x the larger of |s| and |a|, the norms ||x||_r = (sum x^r)^(1/r) over the samples, and Cauchy-Schwarz. That with
r = 6 is found in the loop; ||x||_4^4 <= ||x||_2 ||x||_6^3. Largest value and norm of e come from the covariance of q.
For the range, max |a| <= ||a||_12 is enough: a quarter too high in 30 000 samples, and cheaper than the maximum.

Single precision: a sample of the product over m modes and b histories, and of its powers, is off by at most
``(m + b + 16) 2^-24 |L| |B| |q|``, which is a part of e.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.rainflow_fast import Record
from fatigue.life.rainflow_product import (
    STEP,
    block_for,
    is_in_panels,
    multiply,
    prepared_shapes,
    samples_of,
    space_for_samples,
)
from fatigue.life.screening import ROUNDING, ModalExtent, size_bound
from fatigue.life.spool import Samples

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Rows = NDArray[np.intp]

TOLERANCE = 3e-3  # rms that the histories of a weld may miss, of the largest rms in the weld
CHUNK = 2048  # samples at a time, a multiple of `rainflow_product.STEP`
POINTS = 32  # stresses at a time: more would not stay in the cache
HISTORIES = 4_000_000  # numbers of u at a time: 16 MB
POWERS = (1, 2, 3, 4)  # of the bounded sums; the master curves have slopes between 3 and 4
SINGLE = 2.0**-24  # relative rounding error


@dataclass(frozen=True, slots=True, eq=False)
class WeldBases:
    """Stress shapes of some welds and the few histories of each; see `weld_bases`.

    Attributes
    ----------
    membrane, bending : (n, m) stress shapes
    weld : (n,) number of the weld of a station, from 0
    basis : (h, m) shapes of the histories of all welds
    begin : (w + 1,) row of ``basis`` at which those of a weld begin, and their number
    membrane_part, bending_part : (n, b) the stress shapes in terms of these rows, filled up with zeros
    membrane_rest, bending_rest : (n, m) what the histories miss
    """

    membrane: Floats
    bending: Floats
    weld: Rows
    basis: Floats
    begin: Rows
    membrane_part: Floats
    bending_part: Floats
    membrane_rest: Floats
    bending_rest: Floats


def weld_bases(S_m: Floats, S_b: Floats, weld: NDArray[np.integer], extents: Sequence[ModalExtent]) -> WeldBases:
    """Find the histories of each weld that serve all events, once per group of welds.

    They are the combinations of its membrane and bending stresses with the largest variances, summed over the events in
    units of the mean over all stations. ``S_m``, ``S_b`` (n, m) are the shapes of whole welds, ``weld`` (n,) tells them
    apart, stations of one weld side by side; ``extents`` are those of all events.
    """
    products = S_m.T @ S_m + S_b.T @ S_b
    metric = np.zeros_like(products)
    for extent in extents:
        total = np.sum(products * extent.covariance)
        metric += extent.covariance / total if total > 0.0 else 0.0
    deviation = np.sqrt(np.diagonal(metric))
    deviation = np.where(deviation > 0.0, deviation, 1.0)
    values, directions = np.linalg.eigh(metric / np.outer(deviation, deviation))
    root = deviation[:, None] * directions * np.sqrt(np.maximum(values, 0.0))

    runs = _runs(weld)
    leading = [_leading_directions(np.concatenate([S_m[run], S_b[run]]) @ root) for run in runs]
    parts = np.zeros((2, len(S_m), max(U.shape[1] for U in leading)))
    rests = np.empty((2, *S_m.shape))
    basis = []
    for run, U in zip(runs, leading, strict=True):
        S = np.concatenate([S_m[run], S_b[run]])
        B = U.T @ S
        basis.append(B)
        parts[:, run, : len(B)] = np.split(U, 2)
        rests[:, run] = np.split(S - U @ B, 2)
    return WeldBases(
        membrane=S_m,
        bending=S_b,
        weld=np.repeat(np.arange(len(runs)), [run.stop - run.start for run in runs]),
        basis=np.concatenate(basis),
        begin=np.cumsum([0] + [len(B) for B in basis]),
        membrane_part=parts[0],
        bending_part=parts[1],
        membrane_rest=rests[0],
        bending_rest=rests[1],
    )


def reduced_bound(bases: WeldBases, rows: Rows, record: Record, extent: ModalExtent) -> tuple[Floats, Floats]:
    """Bound range (r, 2) and sum n S^q, q = 1 ... 4, (4, r, 2) of top and bottom stress at some stations.

    Parameters
    ----------
    bases : of whole welds
    rows : (r,) stations among them, ascending, at least one
    record, extent : of one event, both of the same modal coordinates and the latter with the residue of the count
    """
    root_samples = np.sqrt(extent.samples)
    _, s = size_bound(bases.membrane[rows], bases.bending[rows], extent)
    peak, e = size_bound(bases.membrane_rest[rows], bases.bending_rest[rows], extent)
    rms = (s + e) / root_samples  # not below that of a
    scale = np.where(rms > 0.0, rms, 1.0)  # of the loop, so that no power leaves single precision
    s, peak, e = s / scale, peak / scale, e / scale
    reduced = _reduced(bases, rows, scale, record, extent)
    peak += reduced.rounding[..., 0]
    e += reduced.rounding[..., 1] * root_samples
    *variations, sixth, twelfth = np.moveaxis(_in_time(reduced, record, extent), 2, 0)

    norm_2 = s + e
    # Twice the norm of e, ||e||_6^6 <= max |e|^4 ||e||_2^2, as the samples at a seam of the loop are computed twice.
    norm_6 = sixth ** (1 / 6) + 2.0 * (peak**2 * e) ** (1 / 3)
    norms = root_samples, norm_2, np.sqrt(norm_2 * norm_6**3), norm_6**3
    sums = [
        2.0 ** (q - 2) * scale**q * (variation + 2.0 * q * e * norm)
        for q, variation, norm in zip(POWERS, variations, norms, strict=True)
    ]
    largest = 2.0 * scale * (twelfth ** (1 / 12) + peak)
    return largest * (1.0 + ROUNDING), np.stack(sums) * (1.0 + ROUNDING)


class _Reduced(NamedTuple):
    """Some stresses in terms of the histories of their welds, over their scale, and in single precision.

    ``histories`` (h, m) turns the record into u; ``shapes`` are the numbers of the matrices (2 r, b) of all welds, one
    after the other, top beside bottom; ``begin`` (2, w + 1) is where histories and points of each weld begin;
    ``rounding`` (r, 2, 2) is the largest error of a sample and that of its rms.
    """

    histories: Singles
    shapes: Singles
    begin: Rows
    rounding: Floats


def _reduced(bases: WeldBases, rows: Rows, scale: Floats, record: Record, extent: ModalExtent) -> _Reduced:
    """Prepare some stations for the loop over time."""
    modal = np.stack([extent.ranges, np.sqrt(np.diagonal(extent.covariance))], axis=1) / record.scale[:, None]
    rounding = np.empty((*scale.shape, 2))
    histories: list[Floats] = []
    shapes: list[Floats] = []
    for run in _runs(bases.weld[rows]):
        weld = bases.weld[rows[run.start]]
        B = bases.basis[bases.begin[weld] : bases.begin[weld + 1]] * record.scale
        h, m = B.shape
        unit = np.abs(B).max(axis=1)
        unit = np.where(unit > 0.0, unit, 1.0)
        B /= unit[:, None]
        L_m, L_b = bases.membrane_part[rows[run], :h], bases.bending_part[rows[run], :h]
        L = np.stack([L_m + L_b, L_m - L_b], axis=1) * unit / scale[run, :, None]
        rounding[run] = (m + h + 16) * SINGLE * (np.abs(L) @ (np.abs(B) @ modal))
        histories.append(B)
        shapes.append(L.reshape(2 * len(L), h))
    return _Reduced(
        histories=np.concatenate(histories).astype(np.float32),
        shapes=np.concatenate([L.ravel() for L in shapes]).astype(np.float32),
        begin=np.cumsum([[0, *(len(B) for B in histories)], [0, *(len(L) for L in shapes)]], axis=1),
        rounding=rounding,
    )


def _in_time(reduced: _Reduced, record: Record, extent: ModalExtent) -> Floats:
    """Find V_1 to V_4, sum a^6 and sum a^12 of the reduced stress of every point, (r, 2, 6)."""
    modes, samples = record.exact.shape
    B = prepared_shapes(reduced.histories)
    histories = len(reduced.histories)
    width = min(CHUNK, max(STEP, HISTORIES // max(1, histories) // STEP * STEP))
    space = space_for_samples(modes, width, np.float32)
    found = np.zeros((2 * len(reduced.rounding), 6))
    u = block_for(histories, 1 + width + STEP, np.float32)
    u[:] = 0.0  # so that no sample behind the last one is a number that takes long
    before = samples - 1 if extent.steps == samples else 0  # what recurs steps from its last sample to its first one
    start = before - before % STEP
    multiply(B, samples_of(record.q, start, samples if before else 1, space), u)
    u[:, 0] = u[:, 1 + before - start]
    room = np.empty((POINTS, u.shape[1]), np.float32)
    add_all = add_in_memory if is_in_panels(record.q) else add_record
    add_all(record.q, B, reduced.shapes, reduced.begin, (samples, width), u, space, room, found)
    found /= 1.0 - (width + 2) * SINGLE  # sums of a chunk in single precision
    return found.reshape(-1, 2, 6)


def add_record(
    q: Samples,
    histories: Singles,
    shapes: Singles,
    begin: Rows,
    sizes: tuple[int, int],
    u: Singles,
    space: Singles,
    room: Singles,
    found: Floats,
) -> None:
    """Add what `add_sums` finds in a record, ``sizes`` samples long, so many of them at a time.

    As in `rainflow_run` the loop is compiled where the record and the product allow that: `add_in_memory`.
    """
    samples, width = sizes
    for start in range(0, samples, width):
        end = min(start + width, samples)
        columns = 1 + end - start
        multiply(histories, samples_of(q, start, end, space), u)
        add_sums(u, columns, shapes, begin, room, found)
        u[:, 0] = u[:, columns - 1]


@compiled("reassoc", "nsz", "nnan", "contract")
def sums_of_steps(s: Singles) -> tuple[np.floating, ...]:
    """Total variations of s, s |s|, s^3 and s^3 |s|, and the sums of s^6 and s^12 without the first sample."""
    first = second = third = fourth = sixth = twelfth = np.float32(0.0)
    for i in range(1, s.size):
        before, x = s[i - 1], s[i]
        square_before, square = before * abs(before), x * abs(x)
        cube_before, cube = square_before * abs(before), square * abs(x)
        first += abs(x - before)
        second += abs(square - square_before)
        third += abs(cube - cube_before)
        fourth += abs(cube * abs(x) - cube_before * abs(before))
        sixth += cube * cube
        twelfth += (cube * cube) * (cube * cube)
    return first, second, third, fourth, sixth, twelfth


@compiled()
def add_sums(u: Singles, columns: int, shapes: Singles, begin: Rows, room: Singles, found: Floats) -> None:
    """Add what `sums_of_steps` finds in some samples of all points, in column 0 of u (h, w) the last one before them.

    ``shapes`` and ``begin`` are those of `_Reduced`; ``room`` (n, w) is for the stress of some points, by BLAS.
    """
    done = 0
    for weld in range(begin.shape[1] - 1):
        b = begin[0, weld + 1] - begin[0, weld]
        of_weld = u[begin[0, weld] : begin[0, weld + 1]]
        for first in range(begin[1, weld], begin[1, weld + 1], len(room)):
            n = min(len(room), begin[1, weld + 1] - first)
            stress = room[:n]
            np.dot(shapes[done : done + n * b].reshape(n, b), of_weld, stress)
            done += n * b
            for row in range(n):
                sums = sums_of_steps(stress[row, :columns])
                for k in range(len(sums)):
                    found[first + row, k] += sums[k]


add_in_memory = compiled()(add_record)


def _leading_directions(X: Floats) -> Floats:
    """Left singular vectors (n, b) of X (n, m) whose values exceed ``TOLERANCE`` times its longest row."""
    longest = np.sqrt(np.einsum("nm,nm->n", X, X).max())
    wide = X.shape[0] <= X.shape[1]
    values, vectors = np.linalg.eigh(X @ X.T if wide else X.T @ X)  # the smaller one
    sizes = np.sqrt(np.maximum(values, 0.0))
    kept = sizes > TOLERANCE * longest
    return np.asarray(vectors[:, kept] if wide else X @ vectors[:, kept] / sizes[kept])


def _runs(label: NDArray[np.integer]) -> list[slice]:
    """Slices of equal labels side by side."""
    edges = [0, *(np.flatnonzero(np.diff(label)) + 1).tolist(), len(label)]
    return [slice(a, b) for a, b in pairwise(edges) if b > a]
