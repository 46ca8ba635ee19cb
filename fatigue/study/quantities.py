"""What a study found: its variants, and numbers of each under each seed."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Variant:
    """One variant: its name ("fe=9.2, contact=worn"), and the value of everything the study varies, by short name."""

    name: str
    settings: Mapping[str, float | int | str | bool]


@dataclass(frozen=True, slots=True)
class Number:
    """One number of one variant under one seed: a quantity of the whole run, or of one weld.

    ``value`` is NaN where it cannot be had, and ``reason`` says why. ``unit`` is "" for a ratio.
    """

    variant: str
    seed: int
    quantity: str
    weld: str
    value: float
    unit: str
    reason: str = ""
