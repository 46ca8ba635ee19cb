"""Slow, obviously right path counting in any number of dimensions, written from the definition."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Half = tuple[float, float, float, float, float]  # t_P, t_Q, range, length, moment

TIE = 1e-9
SMALL = 1e-9


def most_distant(points: NDArray[np.float64]) -> tuple[int, int, float]:
    """First of all pairs whose squared distance is as large as the largest, but for 1e-9 of it."""
    squares = ((points[:, None] - points[None]) ** 2).sum(axis=-1)
    ties = np.triu(squares >= (1.0 - TIE) * squares.max(), k=1)
    P, Q = np.argwhere(ties)[0]
    return int(P), int(Q), float(squares.max())


def at(z: NDArray[np.float64], t: float) -> NDArray[np.float64]:
    """Point of a path between its samples."""
    k = math.floor(t)
    return z[k] if k == t else z[k] + (t - k) * (z[k + 1] - z[k])


def area(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Area of the parallelogram of two vectors, by its height over a."""
    if not a.any():
        return 0.0
    height = b - a * ((a @ b) / (a @ a))
    return math.sqrt(float(a @ a) * float(height @ height))


def count(z: NDArray[np.float64], ta: float, tb: float) -> list[Half]:
    """Half cycles of the part of a path from ta to tb, one after the other."""
    found: list[Half] = []
    waiting = [(ta, tb)]
    dropped = 0.0
    while waiting:
        ta, tb = waiting.pop()
        inner = [float(k) for k in range(math.floor(ta) + 1, math.ceil(tb))]
        t = [ta, *inner, tb]
        points = np.array([at(z, x) for x in t])
        if not (points != points[0]).any():
            continue
        P, Q, square = most_distant(points)
        if math.sqrt(square) <= dropped:
            continue
        if not found:
            dropped = SMALL * math.sqrt(square)
        todo = [(ta, t[P]), (t[Q], tb)]
        length = moment = rho = 0.0
        start = None
        for k in range(P, Q):
            a, b = points[k] - points[P], points[k + 1] - points[P]
            d = b - a
            C = float(d @ d)
            if C == 0.0:
                continue
            if start is None and a @ d >= 0.0:
                length, moment, rho = length + math.sqrt(C), moment + area(a, b), math.sqrt(b @ b)
                continue
            if start is None:
                start, rho = t[k], math.sqrt(a @ a)
                u = -2.0 * float(a @ d) / C
            else:
                u = (-float(a @ d) + math.sqrt(max(float(a @ d) ** 2 - C * (float(a @ a) - rho**2), 0.0))) / C
            if u <= 1.0 + 1e-12 or k == Q - 1:
                u = min(u, 1.0)
                c = a + u * d
                todo.append((start, t[k] + u * (t[k + 1] - t[k])))
                start = None
                length, moment, rho = length + (1.0 - u) * math.sqrt(C), moment + area(c, b), math.sqrt(b @ b)
        R = math.sqrt(float((points[Q] - points[P]) @ (points[Q] - points[P])))
        found.append((t[P], t[Q], R, length, moment / (math.pi * R * R / 4.0)))
        waiting += [(a, b) for a, b in todo if b > a]
    return found


def half_cycles(points: ArrayLike, residue: str) -> tuple[list[Half], int]:
    """Half cycles by their beginnings, then falling range; of a recurring block from where it is begun."""
    z = np.asarray(points, dtype=float)
    first = 0
    if residue == "repeat" and len(z) > 1 and (z != z[0]).any():
        first = most_distant(z)[0]
        z = np.concatenate([z[first:], z[: first + 1]])
    return sorted(count(z, 0.0, len(z) - 1.0), key=lambda half: (half[0], -half[2])), first
