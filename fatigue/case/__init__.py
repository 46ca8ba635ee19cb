"""A case: what is assessed, with which curve, over which mission.

``tables`` are the tables of ``case.toml`` as frozen models, ``unit_loads`` and ``sequences`` those of loads beside the
modes and of the order of events, ``load`` reads and checks a case file, ``problems`` says
what is wrong with it in the words of the file, ``plausibility`` what is allowed and hardly meant.
"""

from fatigue.case.load import case_schema, check_distance, check_files, event_length_km, given_case, load_case
from fatigue.case.plausibility import case_warnings
from fatigue.case.tables import (
    LARGEST_UPSAMPLE,
    Body,
    Case,
    Counting,
    Curve,
    CustomCurve,
    Event,
    MeanOfQ,
    Mission,
    Spectrum,
)

__all__ = [
    "LARGEST_UPSAMPLE",
    "Body",
    "Case",
    "Counting",
    "Curve",
    "CustomCurve",
    "Event",
    "MeanOfQ",
    "Mission",
    "Spectrum",
    "case_schema",
    "case_warnings",
    "check_distance",
    "check_files",
    "event_length_km",
    "given_case",
    "load_case",
]
