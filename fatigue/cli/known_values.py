"""The known values that every report shows beside what the program computes."""

from collections.abc import Mapping, Sequence
from typing import Any

from fatigue.stages import stage


def known_values() -> Sequence[Mapping[str, Any]]:
    """Compute the known values that the report shows beside what they should be."""
    from fatigue.verify.table import verification_table

    stage("computing the known values")
    checks: Sequence[Mapping[str, Any]] = verification_table().as_record()["checks"]
    return checks
