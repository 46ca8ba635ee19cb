"""Close bounds of the damage of all points of a weld from the few histories that their stresses are made of.

The stresses of a weld have one source: some 10 combinations u = B q of 100 modal coordinates make all its points up to
a hundredth. So s = L u + e, and every point is multiplied with the few u in place of all modes. By ``screening``,
bounds follow from the range and from the total variation V_q of f(s) = s |s|^(q-1). Both are found for a = L u in a
loop over time; what e adds is bounded. Let a and e go straight from each sample to the next one. Then

    V_q(s) - V_q(a) <= sum int |f'(s)| |de| + |f'(s) - f'(a)| |da|
                    <= q sum |De| int |s|^(q-1) + q (q-1) sum |Da| int |e| (|a| + |e|)^(q-2),

D the step and int the mean over it, as f' = q |s|^(q-1). By the convexity of |s|^(q-1) and Cauchy-Schwarz, the first
sum is at most ``q ||De||_2 ||s||_(2q-2)^(q-1)`` with the norms ||x||_r = (sum x^r)^(1/r). In the second |e| is at most
the larger one at the ends, whose norm is at most ``sqrt(2) ||e||_2``, and what stands beside it has the norms I_2 of
``|Da| int a^2``, at most I_1 of ``|Da| int |a|``, and ``||Da||_2``, with max |e| for the other factors. As
``|Da| int a^2 = |D(a^3)| / 3``, I_2 is found in the loop, and I_1^2 <= ||Da||_2 I_2. Also ||a||_6 is found in the loop;
||s||_4^4 <= ||s||_2 ||s||_6^3 and ||e||_6^6 <= max |e|^4 ||e||_2^2. What remains, sizes of s and e and of their steps,
comes from the covariances. For the range, max |a| <= ||a||_12 is enough: a quarter too high in 30 000 samples, and
cheaper than the maximum.

Single precision: a sample of the product over m modes and b histories, and of its powers, is off by at most
``(m + b + 16) 2^-24 |L| |B| |q|``, which is a part of e.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.screening import ROUNDING, ModalExtent, PowerSums, size_bound
from fatigue.life.bounds.weld_sums import SINGLE, Combined, Sums, combined, room_for_histories, sums_in_time
from fatigue.life.counting.record import SingleRecord

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Rows = NDArray[np.intp]

TOLERANCE = 1.5e-2  # rms that the histories of a weld may miss, of the largest rms in the weld


@dataclass(frozen=True, slots=True, eq=False)
class WeldBases:
    """Modal stress of some welds and the few histories of each; see ``weld_bases``.

    Attributes
    ----------
    membrane, bending : (n, m) modal stress
    weld : (n,) number of the weld of a station, from 0
    basis : (h, m) the histories of all welds, per unit modal coordinate
    begin : (w + 1,) row of ``basis`` at which the histories of a weld begin, and how many rows there are
    membrane_part, bending_part : (n, b) the modal stress in terms of these rows, filled up with zeros
    membrane_rest, bending_rest : (n, m) what the histories miss
    room : memory for the histories, which one thread may use at a time
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
    room: Singles


def weld_bases(S_m: Floats, S_b: Floats, weld: NDArray[np.integer], extents: Sequence[ModalExtent]) -> WeldBases:
    """Find the histories of each weld that serve all events, once per group of welds.

    They are the combinations of its membrane and bending stresses with the largest variances, summed over the events in
    units of the mean over all stations. ``S_m``, ``S_b`` (n, m) are the modal stress of whole welds, ``weld`` (n,)
    tells them apart, stations of one weld side by side; ``extents`` has all events.
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

    welds = _equal_side_by_side(weld)
    leading = [_leading_directions(np.concatenate([S_m[one], S_b[one]]) @ root) for one in welds]
    parts = np.zeros((2, len(S_m), max(U.shape[1] for U in leading)))
    rests = np.empty((2, *S_m.shape))
    basis = []
    for one, U in zip(welds, leading, strict=True):
        S = np.concatenate([S_m[one], S_b[one]])
        B = U.T @ S
        basis.append(B)
        parts[:, one, : len(B)] = np.split(U, 2)
        rests[:, one] = np.split(S - U @ B, 2)
    return WeldBases(
        membrane=S_m,
        bending=S_b,
        weld=np.repeat(np.arange(len(welds)), [one.stop - one.start for one in welds]),
        basis=np.concatenate(basis),
        begin=np.cumsum([0] + [len(B) for B in basis]),
        membrane_part=parts[0],
        bending_part=parts[1],
        membrane_rest=rests[0],
        bending_rest=rests[1],
        room=room_for_histories(sum(len(B) for B in basis)),
    )


def reduced_bound(bases: WeldBases, rows: Rows, record: SingleRecord, extent: ModalExtent) -> tuple[Floats, PowerSums]:
    """Bound range (r, 2) and sum n S^q, q = 3 and 4, (r, 2) each, of top and bottom stress at some stations.

    Parameters
    ----------
    bases : of whole welds
    rows : (r,) stations among them, ascending, at least one
    record, extent : of one event, both of the same modal coordinates and the latter with the residue of the count
    """
    root_samples = np.sqrt(extent.samples)
    _, s, s_step = size_bound(bases.membrane[rows], bases.bending[rows], extent)
    peak, e, e_step = size_bound(bases.membrane_rest[rows], bases.bending_rest[rows], extent)
    rms = (s + e) / root_samples  # not below the rms of a
    scale = np.where(rms > 0.0, rms, 1.0)  # of the loop, so that no power leaves single precision
    stresses, rounding = _combined(bases, rows, scale, record, extent)
    rounding_norm = rounding[..., 1] * root_samples
    s, s_step, peak = s / scale, s_step / scale, peak / scale + rounding[..., 0]
    e, e_step = e / scale + rounding_norm, e_step / scale + 2.0 * rounding_norm
    sums = sums_in_time(stresses, record.q, extent.samples, bases.room, recurs=extent.steps == extent.samples)
    of_a = Sums(*(of_stress[stresses.places].reshape(scale.shape) for of_stress in sums))

    e_ends, a_step = np.sqrt(2.0) * e, s_step + e_step
    I_2 = (np.sqrt(of_a.steps) + 32.0 * SINGLE * np.sqrt(of_a.sixth)) / 3.0  # a^3 and a^4 are rounded apart
    I_1 = np.sqrt(a_step * I_2)
    s_6 = of_a.sixth ** (1 / 6) + (peak**2 * e) ** (1 / 3)
    third = of_a.third + 3.0 * e_step * np.sqrt(s * s_6**3) + 6.0 * e_ends * (I_1 + peak * a_step)
    fourth = of_a.fourth + 4.0 * e_step * s_6**3 + 12.0 * e_ends * (I_2 + 2.0 * peak * I_1 + peak**2 * a_step)
    above = 1.0 + ROUNDING
    largest = 2.0 * scale * (of_a.twelfth ** (1 / 12) + peak)
    return largest * above, {3: 2.0 * scale**3 * third * above, 4: 4.0 * scale**4 * fourth * above}


def _combined(
    bases: WeldBases, rows: Rows, scale: Floats, record: SingleRecord, extent: ModalExtent
) -> tuple[Combined, Floats]:
    """Prepare some stations, over their scale, for the loop over time: top beside bottom, weld by weld.

    Beside them the largest errors of a sample in single precision and of its rms, (r, 2, 2).
    """
    modal = np.stack([extent.ranges, np.sqrt(np.diagonal(extent.covariance))], axis=1) / record.scale[:, None]
    B = bases.basis * record.scale
    unit = np.abs(B).max(axis=1)
    unit = np.where(unit > 0.0, unit, 1.0)
    B /= unit[:, None]
    largest = np.abs(B) @ modal
    rounding = np.empty((*scale.shape, 2))
    histories: list[Floats] = []
    matrices: list[Floats] = []
    for one in _equal_side_by_side(bases.weld[rows]):
        weld = bases.weld[rows[one.start]]
        of_weld = slice(bases.begin[weld], bases.begin[weld + 1])
        h, m = B[of_weld].shape
        L_m, L_b = bases.membrane_part[rows[one], :h], bases.bending_part[rows[one], :h]
        L = np.stack([L_m + L_b, L_m - L_b], axis=1) * unit[of_weld] / scale[one, :, None]
        rounding[one] = (m + h + 16) * SINGLE * (np.abs(L) @ largest[of_weld])
        histories.append(B[of_weld])
        matrices.append(L.reshape(2 * len(L), h))
    return combined(histories, matrices), rounding


def _leading_directions(X: Floats) -> Floats:
    """Left singular vectors (n, b) of X (n, m) whose values exceed ``TOLERANCE`` times its longest row."""
    longest = np.sqrt(np.einsum("nm,nm->n", X, X).max())
    wide = X.shape[0] <= X.shape[1]
    values, vectors = np.linalg.eigh(X @ X.T if wide else X.T @ X)  # the smaller one
    sizes = np.sqrt(np.maximum(values, 0.0))
    kept = sizes > TOLERANCE * longest
    return np.asarray(vectors[:, kept] if wide else X @ vectors[:, kept] / sizes[kept])


def _equal_side_by_side(label: NDArray[np.integer]) -> list[slice]:
    """Slices of equal labels side by side."""
    edges = [0, *(np.flatnonzero(np.diff(label)) + 1).tolist(), len(label)]
    return [slice(a, b) for a, b in pairwise(edges) if b > a]
