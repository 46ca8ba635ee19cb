"""How numbers and names are written for people: four digits, grouped thousands, no infinities, nothing blank."""

import math
from collections.abc import Sequence
from typing import Any

from fatigue.shown import shortened, visible

LONGEST = 1e12  # lives beyond are written as "> 1e12"
NOT_AVAILABLE = "–"
THIN_SPACE = "\u202f"  # groups thousands and does not break


def number(value: Any) -> str:
    """Number with four significant digits: ``0.6256``, ``27 330 000``, ``1.360e10``, ``> 1e12``.

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
    x = float(f"{x:.3e}")  # rounded first, so that 9999.6 is grouped as 10 000
    size = abs(x)
    if size < 1e-3 or size >= 1e9:
        mantissa, exponent = f"{x:.3e}".split("e")
        return f"{mantissa}e{int(exponent)}".replace("-", "−")
    if size >= 1e4:
        return whole(round(x))
    digits = max(0, 3 - math.floor(math.log10(size)))
    return f"{x:.{digits}f}".replace("-", "−")


def whole(value: int) -> str:
    """Count with grouped thousands."""
    return f"{value:,}".replace(",", THIN_SPACE).replace("-", "−")


def km(value: Any) -> str:
    """Distance in words: ``2 209 000 km``, ``> 1e12 km``."""
    return f"{number(value)} km"


def years(value: Any) -> str:
    """Time in years of service; beyond a million years the number says nothing."""
    if value is not None and float(value) > 1e6:
        return "> 1e6 years"
    return f"{number(value)} years"


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
