"""Units that a file states for modal coordinates, compared with the unit system and the normalisation declared.

They are never converted: a coordinate of modes of unit generalised mass is no length, whatever its label says.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from fatigue.errors import Problem
from fatigue.readers.units.systems import Normalisation

LENGTHS = {"mm": "mm", "cm": "cm", "m": "m", "km": "km", "in": "in", "inch": "in", "ft": "ft", "um": "um", "µm": "um"}
_MASSES = {"kg": "kg", "t": "t", "Mg": "t", "tonne": "t", "ton": "t", "g": "g", "lb": "lb", "lbm": "lb", "slug": "slug"}
_NONE = (
    "",
    "-",
    "--",
    "1",
    "none",
    "n/a",
    "unitless",
    "dimensionless",
    "no unit",
    "no units",
    "nounit",
    "no_units",
    "ohne",
    "modal",
)
SYSTEM_UNITS = {"mm-t-s": ("mm", "t"), "m-kg-s": ("m", "kg"), "in-lbf-s": ("in", "lbf s^2/in")}
"""Units of length and of mass of each unit system."""


@dataclass(frozen=True, slots=True)
class CoordinateUnit:
    """A unit of a modal coordinate: a length, perhaps times the root of a mass; None where it has no such part."""

    length: str | None
    mass: str | None


def states_no_unit(unit: str) -> bool:
    """Whether a label of a unit says nothing, as ``-``."""
    return unit.strip().lower() in _NONE


def parse_unit(text: str) -> CoordinateUnit | None:
    """Read ``m``, ``mm*sqrt(t)``, ``kg^0.5 m``; None if it is no unit of a modal coordinate."""
    plain = re.sub(r"(?:sqrt|√|root|wurzel)\s*\(?\s*([A-Za-zµ]+)\s*\)?", r"\1^0.5", text.strip(), flags=re.IGNORECASE)
    plain = plain.replace("½", "^0.5").replace("**", "^")
    plain = re.sub(r"\^\s*\(?\s*(?:1\s*/\s*2|0?[.,]5)\s*\)?", "^0.5 ", plain)
    powers: dict[str, Fraction] = {}
    for word in re.split(r"[\s*·×⋅]+|(?<!\d)\.(?!\d)", plain):
        if not word:
            continue
        name, _, power = word.partition("^")
        known = LENGTHS.get(name) or _MASSES.get(name) or LENGTHS.get(name.lower()) or _MASSES.get(name.lower())
        if known is None or known in powers or power not in ("", "1", "0.5"):
            return None
        powers[known] = Fraction(power or "1")
    lengths = [unit for unit in powers if unit in LENGTHS.values()]
    masses = [unit for unit in powers if unit in _MASSES.values()]
    if not powers or len(lengths) > 1 or len(masses) > 1:
        return None
    if any(powers[u] != 1 for u in lengths) or any(powers[u] != Fraction(1, 2) for u in masses):
        return None
    return CoordinateUnit(lengths[0] if lengths else None, masses[0] if masses else None)


def compared(
    source: str, names: Sequence[str], units: Sequence[str], system: str, normalisation: Normalisation
) -> tuple[list[Problem], list[Problem]]:
    """Compare the units of columns with the options; empty ones state nothing.

    Returns
    -------
    contradictions, one for each unit, and warnings
    """
    problems, warnings = [], []
    for unit in dict.fromkeys(u for u in units if u):
        having = [name for name, u in zip(names, units, strict=True) if u == unit]
        more = f" and {len(having) - 1} more columns" if len(having) > 1 else ""
        where = f"{source}, column {having[0]!r}{more}"
        problem = _contradiction(where, unit, system, normalisation)
        if problem is not None:
            problems.append(problem)
        elif (parse_unit(unit) or CoordinateUnit(None, None)).mass is None and normalisation == "mass":
            what = f"the file states {unit}, a length; --normalisation mass takes it as {_expected(system, 'mass')}"
            warnings.append(Problem("coordinate_unit", where, what, "State --normalisation length if it is one"))
    return problems, warnings


def _contradiction(where: str, unit: str, system: str, normalisation: Normalisation) -> Problem | None:
    """Refusal of a unit that is not that of the options; None if it is."""
    options = (
        f"--coordinate-units {system} and --normalisation {normalisation} make it {_expected(system, normalisation)}"
    )
    stated = parse_unit(unit)
    if stated is None:
        remedy = "State the unit in the header as a length, with the root of a mass or without, or none at all; the "
        remedy += "options --coordinate-units and --normalisation say how it is understood"
        return Problem("coordinate_unit", where, f"the unit {unit!r} is none of a modal coordinate", remedy)
    fitting = [name for name, units in SYSTEM_UNITS.items() if _fits(stated, units)]
    if system not in fitting:
        known = " or ".join(f"--coordinate-units {name}" for name in fitting)
        remedy = (
            f"State {known}" if fitting else f"Export the coordinates in {_expected(system, normalisation)}, or in "
        )
        remedy += "" if fitting else "a system that --coordinate-units knows"
        return Problem("coordinate_unit", where, f"the file states {unit}; {options}", remedy)
    if stated.mass is not None and normalisation == "length":
        return Problem(
            "coordinate_unit", where, f"the file states {unit}; {options}", "State --normalisation mass, or correct it"
        )
    return None


def _fits(stated: CoordinateUnit, units: tuple[str, str]) -> bool:
    return stated.length in (None, units[0]) and stated.mass in (None, units[1])


def _expected(system: str, normalisation: Normalisation) -> str:
    length, mass = SYSTEM_UNITS[system]
    return length if normalisation == "length" else f"{length}*sqrt({mass})"
