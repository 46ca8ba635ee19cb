"""Small free bodies of springs and point masses in space, any number of them, for what must hold of every reduction."""

import numpy as np
from hypothesis import strategies as st
from scipy import sparse

from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.structure import Structure

NODES = st.integers(6, 9)
SEEDS = st.integers(0, 2**32 - 1)


def spring_body(seed, nodes):
    """A body of point masses, each joined to all others by a spring along the line between them."""
    rng = np.random.default_rng(seed)
    xyz = rng.uniform(-1.0, 1.0, (nodes, 3)) + np.array([5.0, 0.0, -2.0])
    K = np.zeros((3 * nodes, 3 * nodes))
    for a in range(nodes):
        for b in range(a + 1, nodes):
            e = (xyz[b] - xyz[a]) / np.linalg.norm(xyz[b] - xyz[a])
            B = np.zeros(3 * nodes)
            B[3 * a : 3 * a + 3], B[3 * b : 3 * b + 3] = -e, e
            K += 10.0 ** rng.uniform(3.0, 5.0) * np.outer(B, B)
    mass = np.repeat(10.0 ** rng.uniform(-1.0, 1.0, nodes), 3)
    return Structure(
        sparse.csc_array(K),
        sparse.csc_array(np.diag(mass)),
        np.repeat(np.arange(1, nodes + 1), 3),
        np.tile(np.arange(3), nodes),
        np.repeat(xyz, 3, axis=0),
    )


def masters_of(structure, nodes):
    """Rows of the first so many nodes, all their displacements."""
    return structure.node <= nodes


def elastic_modes(structure):
    """Exact elastic frequencies [Hz] and shapes with unit mass, by a dense matrix, without the first six."""
    root = np.sqrt(structure.M.diagonal())
    w2, vectors = np.linalg.eigh(structure.K.toarray() / np.outer(root, root))
    return np.sqrt(w2[6:]) / (2 * np.pi), vectors[:, 6:] / root[:, None]


def self_balanced(structure, seed, on):
    """Random forces on some rows that add up to no force and no moment."""
    F = np.where(on, np.random.default_rng(seed).standard_normal(len(on)), 0.0)
    R = rigid_motions(structure.xyz, structure.direction, structure.xyz.mean(axis=0))[on]
    F[on] -= R @ np.linalg.lstsq(R.T @ R, R.T @ F[on], rcond=None)[0]
    return F
