"""How numbers are written down a column: one unit, one notation, no more digits than the number is worth.

The rule of page, print and command line: a result has three significant digits, whatever its size; what was given (a
length, a frequency) has the same decimals in every row. A column is written out, or in powers of ten where all of it is
small, never both. Lives are in millions of km where each of a column has at least a tenth of one.
"""

import math
from collections.abc import Iterable, Sequence

DIGITS = 3  # of a result: its scatter is far above the fourth
LARGEST = 1e12  # beyond, a life is "> 1e12"
LEAST = 1e-3  # in a column that is written out, smaller numbers are "< 0.001"
MILLION = 1e6
GROUPED = 1e4  # thousands are parted from here on
NONE = "–"


def results(values: Sequence[float], group: str = "\u202f") -> list[str]:
    """Texts of the results of a column, missing ones (NaN) a dash; ``group`` parts thousands.

    >>> results([1252345678.0, 979812345.0, 0.0123456], group=" ")
    ['1 250 000 000', '980 000 000', '0.0123']
    >>> results([1.2345e-7, 3.2e-3])
    ['1.23e−7', '3.20e−3']
    """
    sizes = [abs(value) for value in values if 0.0 < abs(value) <= LARGEST]
    in_powers = bool(sizes) and max(sizes) < 10.0 * LEAST
    return [_result(float(value), group, in_powers=in_powers) for value in values]


def as_given(values: Sequence[float], group: str = "\u202f") -> list[str]:
    """Texts of given quantities of a column with the same decimals: no more than they have, or their size deserves.

    The largest has four digits or more, the smallest two or more.

    >>> as_given([350.0, 0.0, 212.5])
    ['350.0', '0.0', '212.5']
    >>> as_given([8.53421, 90.0])
    ['8.53', '90.00']
    """
    sizes = [abs(value) for value in values if 0.0 < abs(value) <= LARGEST]
    if not sizes or min(sizes) < LEAST**2:
        return results(values, group)
    deserved = max(DIGITS - _power(max(sizes)), 1 - _power(min(sizes)))
    decimals = min(max(map(_decimals, sizes)), max(deserved, 0))
    return [_written(float(value), decimals, group) or _beyond(float(value)) for value in values]


def in_millions(lives_km: Iterable[float]) -> bool:
    """Whether lives [km] of a column read best in millions of km: each that is finite has a tenth of one at least.

    >>> in_millions([2.2e6, 1.3e10, float("inf")]), in_millions([2.2e6, 900.0])
    (True, False)
    """
    finite = [life for life in lives_km if math.isfinite(life)]
    return bool(finite) and min(finite) >= 0.1 * MILLION


def lives(lives_km: Sequence[float], group: str = "\u202f") -> tuple[list[str], str]:
    """Texts of the lives [km] of a column, and the unit that they are in.

    >>> lives([2.169e6, 1.25234e9, float("inf")], group=" ")
    (['2.17', '1250', '> 1 000 000'], 'million km')
    """
    if not in_millions(lives_km):
        return results(lives_km, group), "km"
    beyond = f"> {_written(LARGEST / MILLION, 0, group)}"
    texts = results([life / MILLION for life in lives_km], group)
    return [beyond if life > LARGEST else text for life, text in zip(lives_km, texts, strict=True)], "million km"


def _result(value: float, group: str, *, in_powers: bool) -> str:
    size = abs(value)
    if not size <= LARGEST:
        return _beyond(value)
    if size == 0.0:
        return "0"
    if in_powers:
        mantissa, power = f"{value:.{DIGITS - 1}e}".split("e")
        return f"{mantissa}e{int(power)}".replace("-", "−")
    if size < LEAST * (1.0 - 0.5 * 10.0**-DIGITS):  # what rounds to it is written as it
        return f"< {LEAST:g}" if value > 0.0 else f"> −{LEAST:g}"
    rounded = float(f"{value:.{DIGITS - 1}e}")  # first, so that 9996 has no decimals and 0.9996 two
    return _written(rounded, max(0, DIGITS - 1 - _power(abs(rounded))), group)


def _written(value: float, decimals: int, group: str) -> str:
    """Number written out; empty of what is missing or beyond all measure."""
    if not abs(value) <= LARGEST:
        return ""
    text = f"{value:,.{decimals}f}".replace("-", "−")
    return text.replace(",", group if abs(value) >= GROUPED else "")


def _beyond(value: float) -> str:
    if math.isnan(value):
        return NONE
    return f"> {LARGEST:.0e}".replace("+", "") if value > 0.0 else f"< −{LARGEST:.0e}".replace("+", "")


def _power(size: float) -> int:
    """Power of ten of the first digit."""
    return math.floor(math.log10(size))


def _decimals(size: float) -> int:
    """Decimals that six significant digits of a number need."""
    _, _, behind = f"{float(f'{size:.6g}'):.12f}".partition(".")
    return len(behind.rstrip("0"))
