"""A stiffened panel of any number of shells, as a deck, and what `fatigue welds` takes of a large one."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.long_records import measured
from benchmarks.timing import Row

Integers = NDArray[np.int64]

SHELLS = 200_000

SIDE = 20.0  # of every element [mm]
BAY = 16  # elements from stiffener to stiffener
HEIGHT = 4  # elements of a stiffener


def large_mesh() -> list[Row]:
    """Weld lines of a panel of 200 000 shells, from the deck to the register: processor time and peak memory."""
    with tempfile.TemporaryDirectory() as folder:
        deck, register = Path(folder) / "panel.bdf", Path(folder) / "register.csv"
        shells, stiffeners = write_panel(deck, SHELLS)
        code, cpu, peak, _ = min(measured(["welds", str(deck), "-o", str(register), "--force"]) for _ in range(3))
        if code:
            raise SystemExit(f"fatigue welds ended with {code}")
        welds = len(register.read_text().splitlines()) - 1
    what = f"fatigue welds, {shells:,} shells, {stiffeners} stiffeners, {welds:,} plate sides of welds"
    return [(what, f"{cpu:.1f} s of processor time, peak {peak:.0f} MB")]


def write_panel(path: Path, shells: int) -> tuple[int, int]:
    """Write a plate with stiffeners both ways as bulk data of NASTRAN; returns shells and stiffeners.

    The plate is a square of whole bays. Stiffeners along x and along y cross and share their nodes there.
    """
    bays = max(1, round(np.sqrt(shells / (BAY**2 + 2 * BAY * HEIGHT))))
    xyz, corners, part = panel(bays)
    with path.open("w", encoding="ascii") as deck:
        deck.write("CEND\nBEGIN BULK\nMAT1,1,70000.,,0.33,2.7-9\n")
        deck.writelines(f"PSHELL,{number},1,{8.0 if number == 1 else 6.0},1\n" for number in np.unique(part))
        deck.writelines(_grids(xyz))
        deck.writelines(
            f"CQUAD4  {number:8d}{of:8d}{a:8d}{b:8d}{c:8d}{d:8d}\n"
            for number, (of, (a, b, c, d)) in enumerate(zip(part.tolist(), (corners + 1).tolist(), strict=True), 1)
        )
        deck.write("ENDDATA\n")
    return len(corners), len(np.unique(part)) - 1


def panel(bays: int) -> tuple[NDArray[np.float64], Integers, Integers]:
    """Nodes (n, 3) [mm], corners of the shells (e, 4), and their part (e,): 1 the plate, a number each stiffener."""
    cells = BAY * bays
    grid = np.arange(cells + 1)
    plate = np.stack([*np.meshgrid(grid, grid, indexing="ij"), np.zeros((cells + 1, cells + 1), int)], axis=-1)
    quads = [_quads(plate)]
    parts = [1]
    up, along = np.meshgrid(np.arange(HEIGHT + 1), grid)
    for place in range(BAY // 2, cells, BAY):  # in the middle of a bay, so that the edges of the plate are free
        fixed = np.full_like(up, place)
        quads += [_quads(np.stack([along, fixed, up], axis=-1)), _quads(np.stack([fixed, along, up], axis=-1))]
        parts += [parts[-1] + 1, parts[-1] + 2]
    places = np.concatenate(quads)
    points, corners = np.unique(places.reshape(-1, 3), axis=0, return_inverse=True)
    part = np.repeat(parts, [len(some) for some in quads])
    return SIDE * points.astype(float), corners.reshape(-1, 4), part


def _quads(grid: Integers) -> Integers:
    """Corners (e, 4, 3) of the quadrilaterals of a grid of places (i, j, 3)."""
    around = (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:])
    return np.stack([corner.reshape(-1, 3) for corner in around], axis=1)


def _grids(xyz: NDArray[np.float64]) -> Iterator[str]:
    for number, (x, y, z) in enumerate(xyz.tolist(), 1):
        yield f"GRID    {number:8d}        {x:8.1f}{y:8.1f}{z:8.1f}\n"
