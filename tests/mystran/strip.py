"""A strip held at one end: elements turned and flipped at random, and loads whose stress is known in closed form.

``tests/data/nastran/mystran`` holds what MYSTRAN made of it: ``python -m tests.mystran.strip FOLDER`` writes it again.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from tests.mystran.decks import plain
from tests.mystran.plates import X, Y, assembled, distorted, sheet, with_triangles
from tests.mystran.solver import solve_text

LENGTH, WIDTH, T = 80.0, 40.0, 5.0
TENSION_N_MM, MOMENT_N, SHEAR_N_MM = 100.0, 50.0, 2.0  # per width of the free end


def strip(triangles=0.2, seed=4):
    """Strip in the x-y plane with load cases at its free end: tension, tension with moment, force along its normal."""
    rng = np.random.default_rng(seed)
    sheets = [(1, *sheet((0, 0, 0), X, np.linspace(0, LENGTH, 9), Y, np.linspace(0, WIDTH, 5)))]
    plates = distorted(assembled(sheets, (T,), lambda p: p[:, 0] < 1e-6), rng)
    plates = with_triangles(plates, rng, triangles)
    shells = []
    for nodes in plates.shells:
        begin = int(rng.integers(len(nodes)))
        ring = nodes[begin:] + nodes[:begin]
        shells.append(ring[::-1] if rng.random() < 0.5 else ring)
    end = np.flatnonzero(plates.xyz[:, 0] > LENGTH - 1e-6)
    share = np.where(np.isin(plates.xyz[end, 1], [0, WIDTH]), 0.5, 1.0)
    share *= WIDTH / share.sum()
    cases = np.zeros((3, 6))
    cases[:2, 0], cases[1, 4], cases[2, 2] = TENSION_N_MM, MOMENT_N, SHEAR_N_MM
    loads = [{int(n): s * case for n, s in zip(end, share, strict=True)} for case in cases]
    return replace(plates, shells=shells, loads=loads)


def deck_text(plates, sol, corner="CORNER", **options):
    """Bulk data of a strip that asks for stresses; no lateral contraction, so that its held end disturbs nothing."""
    deck = plain(plates, sol, quad="MITC4", poisson=0.0, **options)
    return deck.text().replace("DISP(PLOT) = ALL", f"DISP(PLOT) = ALL\nSTRESS(PLOT,{corner}) = ALL")


def stress_along(case, x, top):
    """Stress along the strip [MPa] in a case, from 0, at the top (1) or the bottom (-1)."""
    moment = (0.0, MOMENT_N, -SHEAR_N_MM * (LENGTH - x))[case]
    return (TENSION_N_MM / T if case < 2 else 0.0) + top * 6 * moment / T**2


if __name__ == "__main__":
    for name, sol in (("static", 101), ("modes", 103)):
        solve_text(deck_text(strip(), sol, modes=2), Path(sys.argv[1]), f"strip_{name}")
