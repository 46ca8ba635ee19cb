"""The most distant pair of a part of a path by distances and by hulls is that of all pairs, ties included."""

import numpy as np

from fatigue.life.path.hulls import hulls_of
from fatigue.life.path.most_distant import by_hull, most_distant, search_in
from tests.life.path.test_count import random_path


def by_definition(z: np.ndarray, rows: list[int]) -> tuple[int, int, float]:
    """First pair, in the order of the rows, of those that tie with the largest distance."""
    points = z[rows]
    square = np.triu(((points[:, None] - points[None]) ** 2).sum(axis=-1))
    j, k = divmod(int(np.argmax(square >= (1.0 - 1e-9) * square.max())), len(rows))
    return rows[j], rows[k], float(square.max())


def test_two_searches_find_the_first_pair():
    """On parts of 80 paths of all kinds in the plane; where distances leave too many points, the search says so."""
    random, left = np.random.default_rng(5), 0
    for k in range(80):
        n = int(random.integers(40, 700))
        path = random_path(random, k % 7, n)
        z = np.concatenate([path, path[:1], path[n // 2 :][:1]])
        i, end = int(random.integers(1, 10)), int(random.integers(25, n + 1))
        known = by_definition(z, [n, *range(i, end), n + 1])
        if known[2] == 0.0:
            continue
        np.testing.assert_allclose(by_hull(z, hulls_of(z, n), search_in(z), i, end), known, rtol=1e-12)
        pair = most_distant(z, i, end, True, np.empty(n + 2, np.int64), np.zeros(2))
        left += pair[0] < 0
        if pair[0] >= 0:
            np.testing.assert_allclose(pair, known, rtol=1e-12)
    assert 0 < left < 40
