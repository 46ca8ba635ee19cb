"""The commands, one file for each group of them; each parses, calls and prints.

A file here registers its commands with ``main.cli`` when it is imported, and knows no other file here.
"""

from fatigue.cli.commands import (
    assess,
    basis,
    beginnings,
    convert,
    decide,
    foreign,
    gauges,
    history,
    point,
    reduce,
    results,
    ride,
    shift,
    spectra,
    study,
    verify,
    welds,
)

__all__ = [
    "assess",
    "basis",
    "beginnings",
    "convert",
    "decide",
    "foreign",
    "gauges",
    "history",
    "point",
    "reduce",
    "results",
    "ride",
    "shift",
    "spectra",
    "study",
    "verify",
    "welds",
]
