"""Columns of what is said of the modal basis of a body, written into a folder of their own."""

from fatigue.results.dictionary.basis_points import BASIS_POINTS
from fatigue.results.dictionary.column import Column

_DIRECTION = Column("direction", "text", "-", "x, y, z, rx, ry or rz")
_MASS = "t along x, y, z; t mm2 about them"

MODAL_MASS = (
    Column("mode", "int", "-", "mode id"),
    Column("frequency_hz", "float", "Hz", "natural frequency of the mode"),
    Column("kind", "text", "-", "normal, interface or rigid"),
    _DIRECTION,
    Column("participation", "float", "-", "participation factor L: t along x, y, z; t mm about them"),
    Column("effective_mass", "float", "-", f"L^2 / modal mass: {_MASS}"),
    Column("share", "float", "-", "the same over the mass or inertia of the body; empty without it"),
    Column("summed_share", "float", "-", "summed over the modes up to this frequency"),
)

MASS_SUM = (
    _DIRECTION,
    Column("unit", "text", "-", "of the masses of this row: t or t mm2"),
    Column("body_mass", "float", "-", "mass of the body, or its moment of inertia about the centre of mass"),
    Column("boundary_mass", "float", "-", "what of it moves with the fixed boundary and with no mode"),
    Column("summed_mass", "float", "-", "effective masses of all modes, summed"),
    Column("band_hz", "float", "Hz", "upper end of the band"),
    Column("mass_in_band", "float", "-", "effective masses of the modes up to there, summed"),
    Column("share_in_band", "float", "-", "the same over the mass of the body"),
    Column("missing_share", "float", "-", "1 less that of all modes: what no mode of the basis carries"),
    Column("enough", "flag", "-", "mass_in_band is as much of what is not on the boundary as the rule asks for"),
    Column("carried_by", "text", "-", "modes that carry most of it, with their shares"),
    Column("reason", "text", "-", "why a number is empty"),
)

DYNAMIC_MASS = (
    Column("frequency_hz", "float", "Hz", "frequency of the motion of the base"),
    _DIRECTION,
    Column("dynamic_mass", "float", "-", f"|rigid + elastic|: {_MASS}; empty without the mass of the body"),
    Column("phase_deg", "float", "deg", "phase of the force before the acceleration of the base"),
    Column("elastic_mass", "float", "-", f"|elastic dynamic mass m_e|: {_MASS}"),
)

BASIS: dict[str, tuple[Column, ...]] = {
    "mass_sum": MASS_SUM,
    "modal_mass": MODAL_MASS,
    "dynamic_mass": DYNAMIC_MASS,
} | BASIS_POINTS
