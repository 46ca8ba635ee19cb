"""Quality data of welds: the stress category that a utilisation gives, and the classes that are known."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class StressCategories:
    """Categories of the stress utilisation, and where their limits come from.

    Attributes
    ----------
    names : from the lowest category on
    limits : utilisation from which each but the first one holds
    source, status : of the limits; ``user`` or ``unverified``
    """

    names: tuple[str, ...]
    limits: tuple[float, ...]
    source: str
    status: str

    def of(self, utilisation: NDArray[np.float64]) -> list[str | None]:
        """Category of each utilisation (n,); None where it is NaN.

        >>> shipped_categories().of(np.array([0.7499, 0.75, 0.9, np.nan]))
        ['low', 'medium', 'high', None]
        """
        at = np.searchsorted(self.limits, utilisation, side="right")
        return [None if np.isnan(u) else self.names[k] for u, k in zip(utilisation, at.tolist(), strict=True)]

    def __str__(self) -> str:
        """Rule in one line: ``low < 0.75 <= medium < 0.9 <= high``."""
        parts = [self.names[0]]
        for limit, name in zip(self.limits, self.names[1:], strict=True):
            parts.append(f"< {limit:g} <= {name}")
        return " ".join(parts)


@cache
def _shipped() -> Mapping[str, Any]:
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))


def shipped_categories() -> StressCategories:
    """Stress categories as they are shipped."""
    data = _shipped()["stress_category"]
    source = f"{data['source']}, edition {data['edition']}"
    return StressCategories(tuple(data["names"]), tuple(data["from_utilisation"]), source, data["status"])


def known_classes(column: str) -> tuple[str, ...]:
    """Classes that are known, of ``performance_class`` or ``inspection_class``."""
    return tuple(_shipped()["classes"][column])


def is_known_class(column: str, given: str) -> bool:
    """Whether a class is one of the known, however it is spelt: ``CP C2``, ``CPC2``, ``cp-c2`` or ``C2``.

    >>> [is_known_class("performance_class", text) for text in ("CP C2", "cp-c2", "C2", "CP E")]
    [True, True, True, False]
    """
    bare = [re.sub(r"[\s_-]", "", text).upper() for text in (given, *known_classes(column))]
    return bare[0] in bare[1:] or bare[0] in [text[2:] for text in bare[1:]]
