"""The verification table: closed forms and published values, computed with the installed program on this machine."""

from fatigue.verify.check import VerificationTable
from fatigue.verify.known.counting import counting_checks
from fatigue.verify.known.curves import curve_checks
from fatigue.verify.known.lines import line_checks
from fatigue.verify.known.mission import mission_checks
from fatigue.verify.known.spectra import spectrum_checks


def verification_table() -> VerificationTable:
    """Every case with a known answer, computed, from nodal forces to kilometres; nothing is read, nothing written."""
    return VerificationTable(
        (*line_checks(), *curve_checks(), *counting_checks(), *spectrum_checks(), *mission_checks())
    )
