"""Numbers in the fields of NASTRAN cards."""

import re

_REAL = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[ED]?[+-]?\d+)?\Z", re.ASCII)
_EXPONENT = re.compile(r"(?<=[\d.])[ED]?([+-]\d+)\Z|(?<=[\d.])[ED](\d+)\Z", re.ASCII)


def integer(text: str) -> int | None:
    """Whole number of a field; None where it holds something else."""
    digits = text[1:] if text[:1] in ("+", "-") else text
    return int(text) if digits.isdigit() and digits.isascii() and len(digits) < 17 else None


def real(text: str) -> float:
    """Real number of a field, in any NASTRAN spelling such as ``2.9+7`` and ``1.D3``, which only FORTRAN understands.

    Raises
    ------
    ValueError : no number, or none of a sensible size; the message says what it is not
    """
    try:
        value = float(text)
    except ValueError:
        upper = text.upper()
        if not _REAL.match(upper):
            raise ValueError("a number") from None
        value = float(_EXPONENT.sub(lambda m: "E" + (m[1] or m[2]), upper))
    if not abs(value) < 1e100 or "_" in text or not text.isascii():
        raise ValueError("a number of sensible size")
    return value


def is_number(text: str) -> bool:
    """Whether a field holds a number in the spelling of NASTRAN."""
    return _REAL.match(text.upper()) is not None
