"""What a study found: its variants, its runs, and numbers of each variant under each seed.

A quantity is named for what it is, ``life_km``, ``conv_y_rms``. One of a channel has its name behind a stroke,
``alarms/bogie``; where several events have the same quantity, the event stands behind a sign, ``conv_y_rms@worn``,
``alarms/bogie@worn 350``. One of a weld has its name in ``weld``, with "" the worst of all welds is meant.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

State = Literal["done", "failed", "not run"]

LIFE = "life_km"
LOGARITHMIC = (LIFE, "damage_per_km")


@dataclass(frozen=True, slots=True)
class Variant:
    """One variant: its name ("fe=14, contact=worn"), and the value of everything the study varies, by short name.

    The first variant of a study is its base. A value with a label stands in ``settings`` by this label.
    """

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


@dataclass(frozen=True, slots=True)
class StudyRun:
    """One variant under one seed: its folder, with ``case.toml`` and ``result`` in it where the study has a case.

    ``sources`` are the folders where the histories of its events lie, by event, "" where all have one. ``reason`` says
    why a run is not done.
    """

    variant: str
    seed: int
    folder: Path
    sources: Mapping[str, Path]
    state: State
    reason: str = ""


def is_life(quantity: str) -> bool:
    """Whether scatter and ratios of a quantity are those of its logarithm, as it is with lives and damage."""
    return re.split("[@/]", quantity)[0] in LOGARITHMIC
