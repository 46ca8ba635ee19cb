"""How names and numbers are shown: ``names`` spells out what cannot be seen, ``digits`` writes down a column."""

from fatigue.shown.names import (
    FEW,
    LONGEST_NAME,
    VisibleFormatter,
    few,
    shortened,
    spelled_out,
    visible,
)

__all__ = ["FEW", "LONGEST_NAME", "VisibleFormatter", "few", "shortened", "spelled_out", "visible"]
