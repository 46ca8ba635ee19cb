"""Sums over time of combined histories, against numpy in double precision."""

import numpy as np
import pytest
from numpy.typing import NDArray

from fatigue.life.bounds.weld_sums import Sums, combined, room_for_histories, sums_in_time
from fatigue.life.counting.single.kernels.product import (
    CACHE_LINE,
    TILE,
    block_for,
    multiply_rows,
    rows_by_blas,
    rows_in_tiles,
)
from fatigue.life.counting.single.prepare import single_record

Floats = NDArray[np.float64]


def expected(a: Floats, *, recurs: bool) -> Sums:
    """What `Sums` says of stresses a (n, t)."""
    closed = np.concatenate([a[:, -1:], a], axis=1) if recurs else a
    step = np.diff(closed**3, axis=1)
    return Sums(
        third=np.abs(step).sum(axis=1),
        fourth=np.abs(np.diff(closed**3 * np.abs(closed), axis=1)).sum(axis=1),
        steps=(step**2).sum(axis=1),
        sixth=(a**6).sum(axis=1),
        twelfth=(a**12).sum(axis=1),
    )


@pytest.mark.parametrize("recurs", [False, True])
@pytest.mark.parametrize("samples", [1, 2, 33, 2048, 2049, 5000])
def test_sums_are_those_of_the_combined_histories(samples: int, recurs: bool) -> None:
    """Three welds of 5, 1 and 14 stresses from 3, no and 13 histories, in chunks that end anywhere."""
    rng = np.random.default_rng(samples)
    q = rng.normal(size=(8, samples)).cumsum(axis=1)
    record = single_record(q)
    stresses, histories, shapes, places = [], [], [], []
    first = 0
    for n, b in ((5, 3), (1, 0), (14, 13)):
        B, L = rng.normal(size=(b, 8)), rng.normal(size=(n, b)) / 30.0
        histories.append(B * record.scale)
        shapes.append(L)
        stresses.append(L @ B @ (q - record.mean[:, None]))
        places.append(np.arange(first, first + n))
        first += -(-n // TILE) * TILE
    found = sums_in_time(combined(histories, shapes), record.q, samples, room_for_histories(20), recurs=recurs)
    a = np.concatenate(stresses)
    size = np.abs(a).max()
    for power, one, other in zip((3, 4, 6, 6, 12), found, expected(a, recurs=recurs), strict=True):
        assert len(one) == first
        assert one[np.concatenate(places)] == pytest.approx(other, rel=1e-3, abs=1e-4 * size**power)
        assert (np.delete(one, np.concatenate(places)) == 0.0).all()


@pytest.mark.parametrize("columns", [1, 2, 33, 34, 100])
@pytest.mark.parametrize("histories", [0, 1, 7, 30])
def test_the_product_of_a_tile(histories: int, columns: int) -> None:
    """By BLAS, and as it is chosen for the processor: the same columns, to single precision."""
    rng = np.random.default_rng(histories)
    L = rng.normal(size=(5, histories)).astype(np.float32)
    u = block_for(max(1, histories), columns + 32, np.float32)[:histories]
    u[:] = rng.normal(size=u.shape)
    stress = block_for(TILE, u.shape[1], np.float32)
    stress[:] = 7.0
    multiply_rows(rows_in_tiles(L), u, columns, stress)
    assert stress[:5, :columns] == pytest.approx(L @ u[:, :columns], abs=1e-5)
    assert (stress[5:, :columns] == 0.0).all()
    padded = np.concatenate([L, np.zeros((TILE - 5, histories), np.float32)])
    rows_by_blas(padded.ravel(), np.ascontiguousarray(u), columns, stress)
    assert stress[:, :columns] == pytest.approx(padded @ u[:, :columns], abs=1e-5)


@pytest.mark.parametrize("precision", [np.float32, np.float64])
@pytest.mark.parametrize(("shapes", "width"), [(1, 34), (13, 100), (40, 2082)])
def test_products_are_written_to_whole_lines_of_the_cache(
    shapes: int, width: int, precision: type[np.floating]
) -> None:
    """From column 1 on, in every row; there are rows for whole tiles."""
    block = block_for(shapes, width, precision)
    rows, columns = block.shape
    assert rows % TILE == 0
    assert rows >= shapes
    assert columns >= width
    assert all(block[row, 1:].ctypes.data % CACHE_LINE == 0 for row in range(rows))
