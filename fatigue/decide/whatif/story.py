"""The what-if as a story: a finished result, its mission, load or curve changed, and what becomes of every weld.

The case of the result and the changed one are laid beside each other, and every key that differs has to be a knob.
Knobs become numbers: passes per km, factors on stresses, laws. The damage of every point goes forward through them,
from what the result has stored. Nothing is counted again unless that is asked for, and a number that would be a guess
is not given.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.decide.of_result import shear_method
from fatigue.decide.whatif.asked import Asked, TwoCases, two_cases
from fatigue.decide.whatif.change import Change, change_of, in_words
from fatigue.decide.whatif.curves import Curves, curves_of
from fatigue.decide.whatif.difference import Differences, differences
from fatigue.decide.whatif.forward import BASES, RECOUNT, Forward, Ranges, forward
from fatigue.decide.whatif.margin import load_factors
from fatigue.decide.whatif.recounted import Which, count_again, rows_to_count
from fatigue.decide.whatif.stored import Kind, Stored, StoredRanges, open_stored, stored_ranges
from fatigue.decide.whatif.summary import WhatIf
from fatigue.decide.whatif.verdicts import weld_table
from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.life.bounds.histogram import Enclosed
from fatigue.life.mission import life_km
from fatigue.stages import stage


def whatif(
    folder: Path | str,
    settings: Sequence[str] = (),
    *,
    drop: Sequence[str] = (),
    case_file: Path | str | None = None,
    recount: Which | None = None,
    threads: int | None = None,
    no_lock: bool = False,
) -> WhatIf:
    """A finished result under another mission, curve or load, with what every number rests on.

    Parameters
    ----------
    folder : result of an assessment
    settings : keys of the case and their values, as ``mission.target_km=2e7``, and ``load=1.1`` for all stresses
    drop : names of events that are left out
    case_file : instead of both: another case
    recount : points that nothing stored says enough of: of each weld the worst, or all, are counted again
    threads : that count points, by default one per processor core
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    CaseError : a key that is no knob, an unknown event, shares that do not sum to 1, a curve that is not there
    DataError : no finished result in the folder, or an input that has to be read is gone or has changed
    """
    folder = given_path(folder, "folder")
    case_file = None if case_file is None else given_path(case_file, "case_file")
    stage("reading the result")
    stored = open_stored(folder, no_lock=no_lock)
    cases = two_cases(stored.record, folder, Asked(tuple(settings), tuple(drop), case_file))
    question = question_of(stored, cases)
    refuse(CaseError, _nothing_changed(question))
    stage("going forward with %d points", len(stored))
    ranges = _RangesOnce(stored)
    found = question.forward(stored, ranges)
    if recount is not None and (rows := rows_to_count(stored, found, recount)).size:
        count_again(stored, cases, question.differs, found, rows, threads)
    factors = load_factors(stored, question.change, question.curves, ranges, found)
    keys = stored.keys()
    names = [question.curves.curves[question.curves.of_weld[weld]].after.curve.name for weld in stored.welds]
    return WhatIf(
        title=str(stored.record["title"]),
        changes=tuple(in_words(question.change, question.differs, cases.load)),
        reasons=question.change.recount,
        target_km=question.change.after.target_km,
        target_km_before=question.change.before.target_km,
        points=_point_table(stored, question.change, found, factors, keys),
        welds=weld_table(stored, question.change, names, found, factors, keys),
        warnings=tuple(_warnings(stored, question, found)),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Question:
    """A change in numbers: the keys that differ, mission and load, and the curve of every weld."""

    differs: Differences
    change: Change
    curves: Curves

    def forward(self, stored: Stored, ranges: Ranges) -> Forward:
        """Damage of every point."""
        decided_by_shear = bool(shear_method(stored.record))
        return forward(stored, self.change, self.curves, ranges, decided_by_shear=decided_by_shear)


def question_of(stored: Stored, cases: TwoCases) -> Question:
    """What is changed from the case of a result to another one.

    Raises
    ------
    CaseError, DataError : as ``whatif``
    """
    differs = differences(stored.record, cases.base, cases.changed)
    change = change_of(stored.record, cases, differs)
    curve_of_weld = dict(zip(stored.welds, stored.of_welds["curve"], strict=True))
    return Question(differs, change, curves_of(stored.record, stored.folder, cases, differs, curve_of_weld))


class _RangesOnce:
    """Histograms of a result, of each kind read when they are first asked for."""

    def __init__(self, stored: Stored) -> None:
        self._stored = stored
        self._read: dict[Kind, StoredRanges] = {}

    def __call__(self, kind: Kind) -> StoredRanges:
        """Those of a kind.

        Raises
        ------
        DataError : the result has none
        """
        if not (self._stored.folder / "histogram.parquet").exists():
            what = "the result has no histogram of ranges, and on this curve no damage follows without"
            remedy = "Assess again with --histogram worst or all"
            raise DataError(Problem("no_histogram", str(self._stored.folder / "histogram.parquet"), what, remedy))
        if kind not in self._read:
            self._read[kind] = stored_ranges(self._stored, kind)
        return self._read[kind]


def _nothing_changed(question: Question) -> Iterator[Problem]:
    if not question.differs.keys and not question.differs.dropped and (question.change.factors == 1.0).all():
        what = "every key has the value that the result was computed with"
        yield Problem("nothing_asked", "--set", what, "Give another value")


def _point_table(stored: Stored, change: Change, found: Forward, factors: Enclosed, keys: pd.DataFrame) -> pd.DataFrame:
    """Rows of the table ``whatif``."""
    low, value, high = found.damage
    utilisation = found.utilisation(change.after.target_km)
    lives = [np.where(np.isnan(d), np.nan, life_km(np.nan_to_num(d), found.limit)) for d in (value, high, low)]
    fulfilled = pd.array(np.where(utilisation.high <= 1.0, True, False), dtype="boolean")
    fulfilled[~((utilisation.high <= 1.0) | (utilisation.low > 1.0))] = pd.NA
    return keys.assign(
        toe=stored.toe,
        basis=pd.Categorical.from_codes(found.basis, categories=list(BASES)),
        damage_per_km_before=stored.damage_per_km,
        damage_per_km=value,
        damage_per_km_low=low,
        damage_per_km_high=high,
        life_km_before=life_km(stored.damage_per_km, found.limit_before),
        life_km=lives[0],
        life_km_low=lives[1],
        life_km_high=lives[2],
        life_years=lives[0] / change.after.km_per_year,
        utilisation=utilisation.value,
        utilisation_low=utilisation.low,
        utilisation_high=utilisation.high,
        fulfilled=fulfilled,
        load_factor=factors.value,
        load_factor_low=factors.low,
        load_factor_high=factors.high,
    )


def _warnings(stored: Stored, question: Question, found: Forward) -> Iterator[Problem]:
    """What the what-if does not follow."""
    checks = stored.of_welds["worst_check_utilisation"].notna().sum()
    if checks:
        what = f"{checks} welds have checks beside the normal stress at the toe, which are not followed here"
        yield Problem("checks_not_followed", str(stored.folder), what, "Assess the changed case to have them")
    open_ = int((stored.toe & (found.basis == RECOUNT)).sum())
    if open_ and not question.change.recount:
        what = f"of {open_} toe points nothing stored says enough: their bounds reach what decides"
        yield Problem("points_not_proven", str(stored.folder), what, "Count them again with --recount all")
