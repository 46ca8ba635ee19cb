"""The second path counter: known paths, and the same half cycles as the first one on random paths."""

import json
from pathlib import Path

import numpy as np
import pytest

from fatigue.life.path.count import count_path_in_space
from fatigue.verify.recount.anew.shear.path import half_cycles

ORACLES = json.loads((Path(__file__).parents[4] / "data" / "path_oracles.json").read_text(encoding="utf-8"))
SEQUENCES = ORACLES["path_sequences"]


def table(path: object) -> np.ndarray:
    """Range, length and moment of each half cycle, in one order."""
    found = np.array([path.range, path.length, path.moment]).T  # type: ignore[attr-defined]
    return found[np.lexsort(found.round(6).T)]


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize("sequence", SEQUENCES, ids=[one["name"] for one in SEQUENCES])
def test_known_sequences(sequence, residue):
    """Every half cycle of 20 known paths: its ends, range, length and moment."""
    points = np.array(sequence["points"], dtype=float)
    found = half_cycles(points, recurs=residue == "repeat")
    known = np.array(sequence[residue]).reshape(-1, 5)
    first = sequence["repeat_start"] if residue == "repeat" else 0
    samples = len(points) if residue == "repeat" else 10**9
    starts = np.sort((found.start - first) % samples)
    np.testing.assert_allclose(starts, np.sort(known[:, 0]), atol=1e-8)
    for values, column in zip((found.range, found.length, found.moment), known.T[2:], strict=True):
        np.testing.assert_allclose(np.sort(values), np.sort(column), atol=1e-6)


def test_random_paths():
    """Two counters that share no code find the same on noise, lattices, lines and plateaus, long and short."""
    random = np.random.default_rng(4)
    kinds = (
        lambda n: random.normal(size=(n, 2)),
        lambda n: random.integers(-3, 4, (n, 2)).astype(float),
        lambda n: np.outer(random.integers(-4, 5, n), [1.0, 2.0]),
        lambda n: np.repeat(random.integers(-3, 4, (n, 2)), 2, axis=0).astype(float),
    )
    for k in range(200):
        points = kinds[k % 4](int(random.integers(2, 30) if k < 180 else random.integers(300, 500)))
        recurs = k // 4 % 2 == 1
        ours = table(half_cycles(points, recurs=recurs))
        np.testing.assert_allclose(ours, table(count_path_in_space(points, "repeat" if recurs else "half")), atol=1e-7)
