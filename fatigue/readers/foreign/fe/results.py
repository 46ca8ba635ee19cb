"""Grid point forces and mode shapes of one FE run, the same for every solver and file format."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.foreign.fe.static_case import StaticCase

SHELL_KINDS = frozenset(
    {"QUAD4", "QUADR", "QUAD8", "TRIA3", "TRIAR", "TRIA6", "QUAD144", "QUAD4LC", "QUAD4K", "TRIA3K"}
)
"""Names of shell elements in force rows; readers of other solvers than NASTRAN give theirs one of these."""

SOLID_KINDS = frozenset({"HEXA", "PENTA", "TETRA", "PYRAM"})
"""Names of solid elements in force rows, alike."""

TOTALS = "*TOTALS*"
_OTHER_ROWS = frozenset({"THERMAL", "INERTIA", "CONTACT", "DAMPING", "DMIG", "TOTAL", "TOTALS"})
"""Row names of letters alone that are no elements; APP-LOAD, F-OF-SPC, F-OF-MPC and *TOTALS* have other characters."""

_ABSURD = 1e30

REQUEST = "Request GPFORCE(PLOT)=ALL or a set that covers the weld elements, SORT1, REAL, with PARAM,POST,-1 in SOL 103"


@dataclass(frozen=True, slots=True, eq=False)
class FeResults:
    """One modal run, or the static subcases of one run, in the file's own units and frames.

    Attributes
    ----------
    source : file
    solver : version label, empty if the file has none
    analysis : "modal", or "static", where every subcase stands for a mode
    mode : (m,) mode number, or subcase number
    frequency : (m,) frequency [Hz], NaN if unknown
    modal_mass : (m,) generalised mass, NaN if unknown
    node, element, kind : (r,) grid, element and row name ("QUAD4", "APP-LOAD", ...) of every force row; rows that are
        no element's have 0, or an id that a solver left over: see ``of_element``
    force : (m, r, 6) forces and moments of the rows, in the displacement frame of the node; NaN where a mode lacks a
        row that is no element's, such as the load of another subcase
    shape_node : (n,) grids of the mode shapes, ascending, empty without eigenvectors
    shape : (m, n, 6) mode shapes, in the displacement frame of the node; zero for static modes without displacements
    warnings : met while reading
    static_modes : modes that are static subcases beside modes of vibration
    static_cases : static subcases of the run, as far as their file tells of them
    unit_loads : name of every static subcase that is a load beside the modal basis, by its number in ``mode``
    """

    source: str
    solver: str
    analysis: Literal["modal", "static"]
    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    modal_mass: NDArray[np.float64]
    node: NDArray[np.int64]
    element: NDArray[np.int64]
    kind: NDArray[np.str_]
    force: NDArray[np.floating]
    shape_node: NDArray[np.int64]
    shape: NDArray[np.floating]
    warnings: tuple[Problem, ...] = field(default=())
    static_modes: tuple[int, ...] = ()
    static_cases: tuple[StaticCase, ...] = ()
    unit_loads: Mapping[int, str] = field(default_factory=dict)

    @property
    def of_element(self) -> NDArray[np.bool_]:
        """(r,) rows that are the force of an element."""
        return (self.element > 0) & names_element(self.kind)

    @property
    def of_basis(self) -> NDArray[np.bool_]:
        """(m,) modes of the basis: all but the unit loads."""
        return np.isin(self.mode, list(self.unit_loads), invert=True)

    @property
    def is_static(self) -> NDArray[np.bool_]:
        """(m,) modes that are static subcases."""
        return np.isin(self.mode, self.static_modes) | (self.analysis == "static")

    def called(self, mode: int) -> str:
        """Name a mode or a unit load as messages do."""
        return f"unit load {self.unit_loads[mode]}" if mode in self.unit_loads else f"mode {mode}"

    @property
    def of_total(self) -> NDArray[np.bool_]:
        """(r,) rows that state the total of a grid."""
        return names_total(self.kind)


@dataclass(frozen=True, slots=True, eq=False)
class ForceBlock:
    """Force rows of one mode or subcase as a file holds them."""

    where: str
    subcase: int
    mode: int  # 0 in a static subcase
    node: NDArray[np.int64]
    element: NDArray[np.int64]
    kind: NDArray[np.str_]
    force: NDArray[np.floating]  # (r, 6)

    @property
    def of_element(self) -> NDArray[np.bool_]:
        """(r,) rows that are the force of an element; other rows may carry an id left over from one."""
        return (self.element > 0) & names_element(self.kind)


@dataclass(frozen=True, slots=True, eq=False)
class ShapeBlock:
    """Mode shape of one mode or subcase as a file holds it."""

    subcase: int
    mode: int
    node: NDArray[np.int64]
    shape: NDArray[np.floating]  # (n, 6)


@dataclass(frozen=True, slots=True)
class Eigenvalue:
    """One line of an eigenvalue summary; subcase 0: the file does not tell."""

    subcase: int
    mode: int
    frequency: float
    modal_mass: float
    eigenvalue: float


@dataclass(frozen=True, slots=True)
class UnusableBlock:
    """Forces of a solution or a form that cannot be used, and why."""

    subcase: int
    problem: Problem


def frequency_of(eigenvalue: float) -> float:
    """Frequency [Hz] of an eigenvalue omega^2; the small negative ones of rigid modes count by their size."""
    return float(np.sqrt(abs(eigenvalue)) / (2 * np.pi))


def names_element(kind: NDArray[np.str_]) -> NDArray[np.bool_]:
    """Whether row names belong to elements: letters and digits, and none of the words for other rows."""
    is_word = np.strings.isalnum(kind) | (kind == "")
    return np.asarray(is_word & ~np.isin(kind, sorted(_OTHER_ROWS)))


def names_total(kind: NDArray[np.str_]) -> NDArray[np.bool_]:
    """Whether row names belong to totals."""
    return np.asarray((np.strings.find(kind, "*") >= 0) | np.isin(kind, ["TOTAL", "TOTALS"]))


def is_sound(values: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Whether values are numbers of sensible size; NaN, infinity and 1e30 are signs of damage."""
    return np.asarray(np.abs(values) < _ABSURD)
