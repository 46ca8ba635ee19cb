"""The table ``[life_band]`` of ``case.toml``: what is known of the scatter of lives beside record and S-N curve."""

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from fatigue.case.problems import absent
from fatigue.case.table import NotNegative, Positive, Table
from fatigue.errors import Problem


class LifeBand(Table):
    """How the life of a point is given as a band, and how probably a whole line of weld survives."""

    miner_median: Positive | None = Field(
        default=None,
        description="the damage sum [-] at which half of all specimens have failed, above 0; left out: the allowed one",
    )
    miner_sigma_ln: NotNegative = Field(
        default=0.0, description="the standard deviation [-] of ln of the damage sum at failure, at least 0"
    )
    reference_length_mm: Positive | None = Field(
        default=None,
        description="the length of weld [mm] of one specimen of the S-N curve, above 0, never the spacing of nodes; "
        "with dependence it gives the survival of whole weld lines; it has no default",
    )
    dependence: Annotated[float, Field(ge=0, le=1)] | None = Field(
        default=None,
        description="the correlation [-] of ln of the strength of two lengths of one weld, 0 (each its own) to 1 (the "
        "weld is as strong as its batch); it has no default",
    )

    def _contradictions(self) -> Iterator[Problem]:
        length, dependence = self.reference_length_mm, self.dependence
        if length is not None and dependence is None:
            what = f"the key is missing although reference_length_mm = {length:g} is given: they need each other"
            yield absent("dependence", what, "Give the correlation of two lengths of one weld, 0 to 1, or neither key")
        if dependence is not None and length is None:
            what = f"the key is missing although dependence = {dependence:g} is given: they need each other"
            yield absent("reference_length_mm", what, "Give the weld length of the specimens [mm], or neither key")
