"""Sums over time of the stresses of many welds, each the combination of a few histories: the loop of ``weld_basis``."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.single.kernels.power import widest_vectors
from fatigue.life.counting.single.kernels.product import (
    STEP,
    TILE,
    block_for,
    is_in_panels,
    multiply,
    multiply_rows,
    prepared_rows,
    rows_in_tiles,
    samples_of,
    space_for_samples,
)
from fatigue.life.records.spool import Samples

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Rows = NDArray[np.intp]

CHUNK = 2048  # samples at a time, a multiple of ``product.STEP``
HISTORIES = 4_000_000  # numbers of u at a time: 16 MB
SINGLE = 2.0**-24  # relative rounding error


class Sums(NamedTuple):
    """What is known of each stress a, arrays (n,), never below the truth but for the rounding of a itself.

    ``third`` and ``fourth`` are the total variations of a^3 and a^3 |a|, ``steps`` is the sum of the squared steps of
    a^3, ``sixth`` and ``twelfth`` are the sums of these powers.
    """

    third: Floats
    fourth: Floats
    steps: Floats
    sixth: Floats
    twelfth: Floats


class Combined(NamedTuple):
    """Stresses a = L u of some welds and their histories u = B q.

    ``histories`` (h, m) are the rows B of all welds; ``matrices`` L of all welds, laid out one after the
    other; ``begin`` (2, w + 1) says where the histories and the tiles of each weld begin; ``places`` (n,) are the rows
    of the tiles that hold the stresses; a weld begins with a tile.
    """

    histories: Singles
    matrices: Singles
    begin: Rows
    places: Rows


def combined(histories: list[Floats], matrices: list[Floats]) -> Combined:
    """Lay out the histories (b, m) and the matrices (n, b) of each weld."""
    tiles = [-(-len(L) // TILE) for L in matrices]
    begin = np.cumsum([[0, *(len(B) for B in histories)], [0, *tiles]], axis=1)
    return Combined(
        histories=np.concatenate(histories).astype(np.float32),
        matrices=np.concatenate([rows_in_tiles(L.astype(np.float32)) for L in matrices]),
        begin=begin,
        places=np.concatenate([TILE * first + np.arange(len(L)) for first, L in zip(begin[1], matrices, strict=False)]),
    )


def room_for_histories(histories: int) -> Singles:
    """Memory for some samples of so many histories at a time, to be used for one record after the other."""
    width = min(CHUNK, max(STEP, HISTORIES // max(1, histories) // STEP * STEP))
    u = block_for(histories, 1 + width + STEP, np.float32)
    u[:] = 0.0  # so that no sample behind the last one is a number that takes long
    return u


def sums_in_time(stresses: Combined, record: Samples, samples: int, u: Singles, *, recurs: bool) -> Sums:
    """Sum up a record of modal coordinates, which may recur, for all stresses, tile by tile: those that fill up are 0.

    ``record`` is in single precision, laid out for the product or on disk, ``samples`` long; ``u`` is room for no fewer
    histories.
    """
    modes = stresses.histories.shape[1]
    B = prepared_rows(stresses.histories)
    width = (u.shape[1] - 1 - STEP) // STEP * STEP
    space = space_for_samples(modes, width, np.float32)
    found = np.zeros((TILE * stresses.begin[1, -1], len(Sums._fields)))
    before = samples - 1 if recurs else 0  # what recurs steps from its last sample to its first one
    start = before - before % STEP
    multiply(B, samples_of(record, start, samples if before else 1, space), u)
    u[:, 0] = u[:, 1 + before - start]
    room = block_for(TILE, u.shape[1], np.float32)
    add_all = add_in_memory if is_in_panels(record) else add_record
    add_all(record, B, stresses.matrices, stresses.begin, (samples, width), u, space, room, found)
    found /= 1.0 - (width + 2) * SINGLE  # sums of a chunk in single precision
    return Sums(*found.T)


def add_record(
    q: Samples,
    histories: Singles,
    matrices: Singles,
    begin: Rows,
    sizes: tuple[int, int],
    u: Singles,
    space: Singles,
    room: Singles,
    found: Floats,
) -> None:
    """Add what ``add_sums`` finds in a record, ``sizes`` samples long, so many of them at a time.

    As in ``kernels.over_time`` the loop is compiled where the record and the product allow that: ``add_in_memory``.
    """
    samples, width = sizes
    for start in range(0, samples, width):
        end = min(start + width, samples)
        columns = 1 + end - start
        multiply(histories, samples_of(q, start, end, space), u)
        add_sums(u, columns, matrices, begin, room, found)
        u[:, 0] = u[:, columns - 1]


@compiled()
def add_sums(u: Singles, columns: int, matrices: Singles, begin: Rows, room: Singles, found: Floats) -> None:
    """Add what ``sums_of_steps`` finds in some samples of all stresses.

    Column 0 of u (h, w) is the last sample before them. ``matrices`` and ``begin`` are as in ``Combined``; ``room``
    (12, w) is for the stresses of a tile.
    """
    done = 0
    for weld in range(begin.shape[1] - 1):
        of_weld = u[begin[0, weld] : begin[0, weld + 1]]
        numbers = TILE * len(of_weld)
        for tile in range(begin[1, weld], begin[1, weld + 1]):
            multiply_rows(matrices[done : done + numbers], of_weld, columns, room)
            done += numbers
            for row in range(TILE):
                sums = sums_of_steps(room[row, :columns])
                for k in range(len(sums)):
                    found[TILE * tile + row, k] += sums[k]


@compiled("reassoc", "nsz", "nnan", "contract")
def sums_of_steps(a: Singles) -> tuple[np.floating, ...]:
    """``sum |d(a^3)|``, ``sum |d(a^3 |a|)|``, ``sum d(a^3)^2``, ``sum a^6``, ``sum a^12``: ``Sums``, in its order.

    Of the steps d of a and of its samples but the first.
    """
    widest_vectors()
    third = fourth = steps = sixth = twelfth = np.float32(0.0)
    cube_before = a[0] * a[0] * a[0]
    fourth_before = cube_before * abs(a[0])
    for i in range(1, a.size):
        cube = a[i] * a[i] * a[i]
        fourth_power = cube * abs(a[i])
        step = cube - cube_before
        third += abs(step)
        fourth += abs(fourth_power - fourth_before)
        steps += step * step
        sixth += cube * cube
        twelfth += (cube * cube) * (cube * cube)
        cube_before, fourth_before = cube, fourth_power
    return third, fourth, steps, sixth, twelfth


add_in_memory = compiled()(add_record)
