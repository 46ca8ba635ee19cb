"""A case: what is assessed, with which curve, over which mission.

``tables`` are the tables of ``case.toml`` as frozen models, ``curves`` and ``checks`` those of S-N curves and of what
is checked beside the normal stress at the toe, ``unit_loads`` those of loads beside the modes, ``order`` that of the
order of events, ``life_band`` that of the scatter of lives, ``identity`` that of the report. ``load`` reads and checks
a case file, ``problems`` says what is wrong with it in the words of the file, ``plausibility`` what is allowed and
hardly meant.
"""

from fatigue.case.checks import (
    Checks,
    EnduranceCheck,
    Interaction,
    Method,
    Multiaxial,
    StressCategory,
    stress_categories,
)
from fatigue.case.curves import Curve, CustomCurve
from fatigue.case.identity import PEOPLE, Report, numbers_text
from fatigue.case.life_band import LifeBand
from fatigue.case.load import case_schema, check_distance, check_files, event_length_km, given_case, load_case
from fatigue.case.plausibility import case_warnings
from fatigue.case.tables import (
    LARGEST_UPSAMPLE,
    Body,
    Case,
    Counting,
    Event,
    MeanOfQ,
    Mission,
    Spectrum,
)

__all__ = [
    "LARGEST_UPSAMPLE",
    "PEOPLE",
    "Body",
    "Case",
    "Checks",
    "Counting",
    "Curve",
    "CustomCurve",
    "EnduranceCheck",
    "Event",
    "Interaction",
    "LifeBand",
    "MeanOfQ",
    "Method",
    "Mission",
    "Multiaxial",
    "Report",
    "Spectrum",
    "StressCategory",
    "case_schema",
    "case_warnings",
    "check_distance",
    "check_files",
    "event_length_km",
    "given_case",
    "load_case",
    "numbers_text",
    "stress_categories",
]
