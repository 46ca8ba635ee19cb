"""Columns of what is said of the modal basis of a body, written into a folder of their own."""

from fatigue.results.dictionary.basis_points import BASIS_POINTS
from fatigue.results.dictionary.column import Column

MODAL_MASS = (
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("kind", "text", "-", "normal, interface or rigid"),
    Column("direction", "text", "-", "x, y, z, rx, ry or rz"),
    Column("participation", "float", "-", "participation factor L: t along x, y, z; t mm about them"),
    Column("effective_mass", "float", "-", "L^2 / modal mass: t along x, y, z; t mm2 about them"),
    Column("share", "float", "-", "the same over the mass or inertia of the body; empty without it"),
    Column("summed_share", "float", "-", "summed over the modes up to this frequency"),
)

BASIS: dict[str, tuple[Column, ...]] = {"modal_mass": MODAL_MASS} | BASIS_POINTS
