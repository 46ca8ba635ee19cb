"""What the modes of a finite element body cost: the shipped car body, 94 404 degrees of freedom, on one core."""

import resource
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np

from benchmarks.timing import Row
from fatigue.flexbody.elements.quad import quad_stiffness
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.modes import free_modes
from fatigue.flexbody.shell import section_of, structure
from fatigue.readers.model.read import read_model

FOLDER = Path(__file__).parents[1] / "data" / "carbody"
MODES = 60
COLUMNS = 54
T = TypeVar("T")


def finite_elements() -> list[Row]:
    """Processor time of element matrices, assembly, factors, modes and answers to loads; peak memory after each."""
    rows: list[Row] = []
    mesh = read_model(FOLDER).body

    def timed(what: str, work: Callable[[], T]) -> T:
        before = time.process_time()
        done = work()
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10
        rows.append((f"car body, 94 404 dof: {what}", f"{time.process_time() - before:.1f} s, peak {peak:.0f} MB"))
        return done

    every = np.arange(len(mesh.element))
    timed("stiffness of 15 492 elements", lambda: quad_stiffness(mesh.xyz[mesh.corners], section_of(mesh, every)))
    body = timed("K and M, elements included", lambda: structure(mesh))
    free = timed("factors", lambda: free_body(body))
    timed(f"{MODES} modes, and the question whether one is missed", lambda: free_modes(free, count=MODES))
    loads = np.zeros((len(body.node), COLUMNS))
    loads[np.linspace(0, len(body.node) - 1, COLUMNS).astype(int), np.arange(COLUMNS)] = 1.0
    timed(f"{COLUMNS} answers to loads", lambda: free.elastic(loads))
    return rows
