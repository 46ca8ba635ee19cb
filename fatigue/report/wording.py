"""How numbers and names are written for people: four digits, grouped thousands, no infinities, nothing blank.

Lives have three: their scatter is far above the fourth.
"""

import math
from collections.abc import Sequence
from typing import Any

from fatigue.digits import as_given, results
from fatigue.shown import shortened, visible

LONGEST = 1e12  # lives beyond are written as "> 1e12"
LIFE_DIGITS = 3
NOT_AVAILABLE = "–"
THIN_SPACE = "\u202f"  # groups thousands and does not break


def number(value: Any, digits: int = 4) -> str:
    """Number with four significant digits, or as many as said: ``0.6256``, ``27 330 000``, ``1.360e10``, ``> 1e12``.

    What is missing or not a number is written as a dash.
    """
    if value is None or value != value:  # noqa: PLR0124  (NaN differs from itself, pandas' NA types included)
        return NOT_AVAILABLE
    x = float(value)
    size = abs(x)
    if size > LONGEST:
        return "> 1e12" if x > 0.0 else "< −1e12"
    if size == 0.0:
        return "0"
    x = float(f"{x:.{digits - 1}e}")  # rounded first, so that 9999.6 is grouped as 10 000
    size = abs(x)
    if size < 1e-3 or size >= 1e9:
        mantissa, exponent = f"{x:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(exponent)}".replace("-", "−")
    if size >= 1e4:
        return whole(round(x))
    decimals = max(0, digits - 1 - math.floor(math.log10(size)))
    return f"{x:.{decimals}f}".replace("-", "−")


def result(value: Any) -> str:
    """Number that was computed, with three significant digits."""
    return number(value, LIFE_DIGITS)


def given(value: Any) -> str:
    """Quantity that was given, with the digits that it has, six at most: ``12 000 000``, ``24``, ``212.5``."""
    return NOT_AVAILABLE if value is None or value != value else as_given([float(value)])[0]  # noqa: PLR0124


def whole(value: int) -> str:
    """Count with grouped thousands."""
    return f"{value:,}".replace(",", THIN_SPACE).replace("-", "−")


def km(value: Any) -> str:
    """Distance in words: ``2 209 000 km``, ``> 1e12 km``."""
    return f"{number(value)} km"


def life(value: Any) -> str:
    """Life in km or years with three significant digits, written out: ``2 210 000``, ``1 250 000 000``."""
    return results([float(value)])[0] if _is_long(value) else number(value, LIFE_DIGITS)


def _is_long(value: Any) -> bool:
    """Whether a life would be written in powers of ten, though it is no more than ``LONGEST``."""
    return value is not None and 1e9 * (1.0 - 1e-3) <= value <= LONGEST


def life_km(value: Any) -> str:
    """Life in words: ``2 210 000 km``."""
    return f"{life(value)} km"


def life_in_band(value: float, low: float, high: float) -> str:
    """Life and its band in words, in millions of km where it has some: ``2.21 (1.93 – 2.53) million km``.

    A band that reaches from half to double or further leaves two digits.
    """
    digits = LIFE_DIGITS if high < 2.0 * low else LIFE_DIGITS - 1
    scale, unit = (1e6, "million km") if low >= 1e6 and high < 1e10 else (1.0, "km")
    of, begin, end = (number(x / scale, digits) for x in (value, low, high))
    return f"{of} ({begin} – {end}) {unit}"


def years(value: Any, digits: int = 4) -> str:
    """Time in years of service; beyond a million years the number says nothing."""
    if value is not None and float(value) > 1e6:
        return "> 1e6 years"
    return f"{number(value, digits)} years"


def life_years(value: Any) -> str:
    """Life in years of service."""
    return years(value, LIFE_DIGITS)


def share(value: Any) -> str:
    """Share as percentage: three digits, and no more than hundredths."""
    if value is None or value != value:  # noqa: PLR0124
        return NOT_AVAILABLE
    percent = 100.0 * float(value)
    digits = 1 if abs(percent) >= 9.95 else 2
    return f"{percent:.{digits}f} %".replace("-", "−")


def size(bytes_: int) -> str:
    """Size of a file."""
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if bytes_ >= scale:
            return f"{number(bytes_ / scale)} {unit}"
    return f"{bytes_} bytes"


def short(name: str, longest: int = 36) -> str:
    """Name, shortened in the middle if it is long, what cannot be seen in it spelled out."""
    return shortened(visible(" ".join(name.split())), longest, "…")


def in_figure(name: str, longest: int = 36) -> str:
    """Name for a figure: short, its own direction of writing kept apart, and no markup.

    Plotly takes ``<b>`` or ``<a href>`` in texts for markup and ``%{...}`` in templates for a variable.
    """
    plain = (
        short(name, longest).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace("%{", "%&#123;")
    )
    return plain if plain.isascii() else f"\u2068{plain}\u2069"


def listed(items: Sequence[str]) -> str:
    """Words joined: ``a``, ``a and b``, ``a, b and c``."""
    return " and ".join(filter(None, [", ".join(items[:-1]), *items[-1:]]))
