"""Welded joints of flat plates as shell meshes: nodes, shells and properties in mm, N, t, s, drawn from a seed."""

from dataclasses import dataclass, field, replace

import numpy as np

from tests.shell_fe import joined

X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Plates:
    """A shell model.

    Attributes
    ----------
    xyz : (n, 3) nodes [mm]
    shells : node indices of every shell: 3 or 4 corners, or 4 corners and their 4 mid-side nodes
    pid : (e,) property of every shell, from 1 on
    thickness : of the properties [mm]
    fixed : (n,) nodes held in all directions
    loads : for each load case the nodes loaded and their forces and moments, {node: (6,)} [N, N mm]
    bars : pairs of nodes joined by bars
    spiders : rigid or averaging elements, (card, reference node, nodes): RBE2, RBE3
    """

    xyz: np.ndarray
    shells: list[tuple[int, ...]]
    pid: np.ndarray
    thickness: tuple[float, ...]
    fixed: np.ndarray
    loads: list[dict[int, np.ndarray]]
    bars: list[tuple[int, int]] = field(default_factory=list)
    spiders: list[tuple[str, int, list[int]]] = field(default_factory=list)


def sheet(origin, u, us, v, vs):
    """Nodes and quads of a flat rectangular mesh with stations ``us`` along ``u`` and ``vs`` along ``v``."""
    U, V = np.meshgrid(np.asarray(us, float), np.asarray(vs, float), indexing="ij")
    xyz = np.asarray(origin, float) + U.reshape(-1, 1) * u + V.reshape(-1, 1) * v
    number = np.arange(U.size).reshape(U.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    return xyz, quads.reshape(-1, 4)


def assembled(sheets, thickness, fixed, loads=()):
    """Plates of (pid, nodes, quads); ``fixed`` maps the nodes to held ones; loads are (place, force) pairs, by case."""
    xyz, quads = joined(*[(nodes, quads) for _, nodes, quads in sheets])
    pid = np.concatenate([np.full(len(quads), p) for p, _, quads in sheets])
    cases = []
    for case in loads:
        forces = {}
        for place, force in case:
            at = np.flatnonzero(np.asarray(place(xyz)))
            for node in at:
                forces[int(node)] = forces.get(int(node), 0) + np.asarray(force, float) / len(at)
        cases.append(forces)
    return Plates(xyz, [tuple(q) for q in quads.tolist()], pid, tuple(thickness), np.asarray(fixed(xyz)), cases)


def stations(rng, length, cells, *through):
    """Uneven stations from 0 to ``length``, some of them moved to the places named."""
    s = np.linspace(0, length, cells + 1)
    s[1:-1] += rng.uniform(-0.2, 0.2, cells - 1) * length / cells
    for place in through:
        s[1 + np.argmin(np.abs(s[1:-1] - place))] = place
    return s


def _thickness(rng, count):
    return tuple(np.round(rng.choice(np.arange(4, 16), count, replace=False) + rng.uniform(0, 0.5, count), 2))


def tee(rng, arms=1):
    """Base plate held at both ends, with uprights along its middle (two: a cruciform), loaded at their free edges."""
    a, b, h = rng.uniform(120, 200), rng.uniform(60, 100), rng.uniform(40, 70)
    c = a * rng.uniform(0.4, 0.6)
    ys = stations(rng, b, 5)
    sheets = [(1, *sheet((0, 0, 0), X, stations(rng, a, 8, c), Y, ys))]
    for arm in range(arms):
        up = Z if arm == 0 else -Z
        sheets.append((2 + arm, *sheet((c, 0, 0), up, stations(rng, h, 3), Y, ys)))
    loads = [[(lambda p, s=s: p[:, 2] * s > h - 1e-6, _force(rng))] for s in (1, -1)[:arms]]
    loads += [[(lambda p: p[:, 2] == 0, _force(rng))]]
    return assembled(sheets, _thickness(rng, 1 + arms), lambda p: _ends(p, a), loads)


def cruciform(rng):
    """Two uprights on the two faces of a plate."""
    return tee(rng, arms=2)


def lap(rng):
    """Two plates that overlap, their edges joined by a row of short shells across the gap of the mid-surfaces."""
    a, b, over = rng.uniform(100, 150), rng.uniform(50, 90), rng.uniform(30, 50)
    t = _thickness(rng, 3)
    gap = (t[0] + t[1]) / 2
    ys = stations(rng, b, 5)
    lower = sheet((0, 0, 0), X, stations(rng, a, 7, a - over), Y, ys)
    upper = sheet((a - over, 0, gap), X, stations(rng, a, 7, over), Y, ys)
    first = sheet((a - over, 0, 0), Z, (0, gap), Y, ys)
    second = sheet((a, 0, 0), Z, (0, gap), Y, ys)
    end = 2 * a - over
    loads = [[(lambda p: p[:, 0] > end - 1e-6, _force(rng, size))] for size in (100.0, 300.0)]
    return assembled([(1, *lower), (2, *upper), (3, *first), (3, *second)], t, lambda p: p[:, 0] < 1e-6, loads)


def bracket(rng):
    """A bracket shorter than the plate that carries it, with a gusset: lines with open ends inside the plate."""
    a, b, h = rng.uniform(140, 200), rng.uniform(100, 140), rng.uniform(30, 50)
    c, y1, y2 = a / 2, b * 0.25, b * 0.75
    ys = stations(rng, b, 8, y1, b / 2, y2)
    xs = stations(rng, a, 9, c, c + h)
    on = ys[(ys >= y1) & (ys <= y2)]
    out = xs[(xs >= c) & (xs <= c + h)]
    zs = stations(rng, h, 3)
    sheets = [
        (1, *sheet((0, 0, 0), X, xs, Y, ys)),
        (2, *sheet((c, 0, 0), Z, zs, Y, on)),
        (3, *sheet((0, b / 2, 0), X, out, Z, zs)),
    ]
    loads = [[(lambda p: (p[:, 2] > h - 1e-6) & (abs(p[:, 0] - c) < 1e-6), _force(rng))] for _ in range(2)]
    return assembled(sheets, _thickness(rng, 3), lambda p: _ends(p, a), loads)


def box(rng):
    """A box beam of four plates, welded along its four edges, held at one end."""
    length, b, h = rng.uniform(150, 250), rng.uniform(50, 80), rng.uniform(40, 70)
    xs, ys, zs = stations(rng, length, 8), stations(rng, b, 3), stations(rng, h, 3)
    sheets = [
        (1, *sheet((0, 0, 0), X, xs, Y, ys)),
        (2, *sheet((0, 0, h), X, xs, Y, ys)),
        (3, *sheet((0, 0, 0), X, xs, Z, zs)),
        (4, *sheet((0, b, 0), X, xs, Z, zs)),
    ]
    loads = [[(lambda p: p[:, 0] > length - 1e-6, _force(rng))] for _ in range(2)]
    return assembled(sheets, _thickness(rng, 4), lambda p: p[:, 0] < 1e-6, loads)


def with_bars_and_spiders(plates, rng):
    """Bars from loaded nodes to a ground node each, and a load node over the joint held by an RBE2 or an RBE3."""
    xyz, loads = plates.xyz, [dict(case) for case in plates.loads]
    bars, spiders, fixed = [], [], list(plates.fixed)
    first = sorted(loads[0])
    xyz = np.vstack([xyz, xyz[first[0]] + rng.uniform(20, 40, 3), xyz[first].mean(axis=0) + rng.uniform(10, 30, 3)])
    ground, head = len(xyz) - 2, len(xyz) - 1
    fixed += [True, False]
    bars.append((first[0], ground))
    if rng.random() < 0.5:
        spiders.append(("RBE2", head, first[1:]))
    else:  # the means of nodes on a line would leave the rotation about it free
        around = {n for nodes in plates.shells if set(nodes) & set(first[1:]) for n in nodes}
        spiders.append(("RBE3", head, sorted(n for n in around if not plates.fixed[n])))
    loads[0] = {head: _force(rng)}
    return replace(plates, xyz=xyz, fixed=np.array(fixed), loads=loads, bars=bars, spiders=spiders)


def distorted(plates, rng, share=0.15):
    """Move nodes inside a plate, in its plane, by up to a share of their shortest edge."""
    xyz = plates.xyz.copy()
    normal = [set() for _ in xyz]
    free = np.full(len(xyz), np.inf)
    around = np.zeros(len(xyz), int)
    for p, nodes in zip(plates.pid, plates.shells, strict=True):
        for k, n in enumerate(nodes):
            edges = plates.xyz[[nodes[k - 1], nodes[(k + 1) % len(nodes)]]] - plates.xyz[n]
            free[n] = min(free[n], np.linalg.norm(edges, axis=1).min())
            normal[n].add((int(p), tuple(edges.reshape(-1))))
            around[n] += 1
    for n in range(len(xyz)):
        if around[n] == 4 and len({p for p, _ in normal[n]}) == 1:
            edges = np.array([e for _, e in normal[n]]).reshape(-1, 3)
            _, s, axes = np.linalg.svd(edges)
            if s[2] < 1e-9 * s[0]:
                xyz[n] += rng.uniform(-share, share, 2) * free[n] @ axes[:2]
    return replace(plates, xyz=xyz)


def with_triangles(plates, rng, share=0.3):
    """Cut some quads into two triangles each."""
    shells, pid = [], []
    for p, nodes in zip(plates.pid, plates.shells, strict=True):
        cut = rng.random() < share
        parts = [(*nodes[:3],), (nodes[0], *nodes[2:])] if cut else [nodes]
        shells += parts
        pid += [p] * len(parts)
    return replace(plates, shells=shells, pid=np.array(pid))


def parabolic(plates):
    """Put a node in the middle of every edge."""
    middle, xyz, shells = {}, list(plates.xyz), []
    for nodes in plates.shells:
        mids = []
        for k, n in enumerate(nodes):
            edge = frozenset((n, nodes[(k + 1) % 4]))
            if edge not in middle:
                middle[edge] = len(xyz)
                xyz.append(plates.xyz[list(edge)].mean(axis=0))
            mids.append(middle[edge])
        shells.append((*nodes, *mids))
    held = [all(plates.fixed[list(edge)]) for edge in middle]
    return replace(plates, xyz=np.array(xyz), shells=shells, fixed=np.concatenate([plates.fixed, held]))


def turned(plates, rng):
    """Turn the whole model about a random axis, loads with it."""
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    axes *= np.sign(np.linalg.det(axes))
    loads = [{n: (f.reshape(2, 3) @ axes.T).ravel() for n, f in case.items()} for case in plates.loads]
    return replace(plates, xyz=plates.xyz @ axes.T, loads=loads)


def _ends(xyz, length):
    return (xyz[:, 0] < 1e-6) | (xyz[:, 0] > length - 1e-6)


def _force(rng, size=1000.0):
    return np.concatenate([rng.normal(size=3) * size, np.zeros(3)])
