"""The commands, one file for each group of them; each parses, calls and prints.

A file here registers its commands with ``main.cli`` when it is imported, and knows no other file here.
"""

from fatigue.cli.commands import (
    assess,
    backsolve,
    basis,
    beginnings,
    convert,
    fleet,
    reduce,
    results,
    ride,
    shift,
    spectra,
    study,
    verify,
    welds,
    whatif,
)

__all__ = [
    "assess",
    "backsolve",
    "basis",
    "beginnings",
    "convert",
    "fleet",
    "reduce",
    "results",
    "ride",
    "shift",
    "spectra",
    "study",
    "verify",
    "welds",
    "whatif",
]
