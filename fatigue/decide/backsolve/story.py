"""The back-solve as a story: a finished result, one quantity that is free, and what of it just meets the target.

Load and curve, mileage and shares are answered from what the result has stored. Thickness is counted again at every
trial, from inputs that may not have changed, and so is what only a bound is known of. Every answer is put back: it goes
forward through the same result, and the utilisation that comes out is told beside it.
"""

from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.backsolve.by_mission import mileages, shares
from fatigue.decide.backsolve.by_strength import Counting, from_stored, of_thickness
from fatigue.decide.backsolve.counted import CountedPoints, Plates, counted_points
from fatigue.decide.backsolve.forward import Base, base_of
from fatigue.decide.backsolve.page import PAGE, answers_page
from fatigue.decide.backsolve.question import Question, question
from fatigue.decide.backsolve.rows import AnswerRow, mileage_rows, share_rows, strength_rows
from fatigue.decide.backsolve.summary import HELD, Answers
from fatigue.decide.beside_results import refuse_results
from fatigue.decide.whatif.stored import Stored, open_stored
from fatigue.errors import Problem, given_path
from fatigue.files.recorded import Filled, refuse_foreign
from fatigue.results import upsampling_factors
from fatigue.results.dictionary.decided.backsolve import BACKSOLVE
from fatigue.results.plain_tables import fill, table_files
from fatigue.stages import stage

Rows = NDArray[np.int64]

RECORD = "backsolve.json"
FILLED = Filled("fatigue backsolve", "back-solve", RECORD, (*table_files(("backsolve",)), PAGE))
MOST_SAMPLES = 1_000_000_000  # of stress, up to which all toe points are counted at one thickness: some minutes
SHARE_OF_WORST = 0.1  # of the utilisation of a weld, from which its points are looked at where not all are


def backsolve(
    folder: Path | str,
    asked: str,
    *,
    target: str | float | None = None,
    into: Path | str | None = None,
    csv: bool = False,
    force: bool = False,
    case_file: Path | str | None = None,
    threads: int | None = None,
    no_lock: bool = False,
) -> Answers:
    """What of one quantity just meets the target, of every weld and of the whole body.

    Parameters
    ----------
    folder : result of an assessment
    asked : ``load``, ``curve``, ``km_per_year``, ``thickness`` or ``share:EVENT``
    target : distance [km], or time as ``"30 years"``; None: that of the case
    into : folder for table, page and record; None: nothing is written
    csv : write the table as CSV as well
    force : overwrite files in it that are not ours
    case_file : the case it was made from; by default where the provenance of the result says
    threads : that count points, by default one per processor core; the numbers do not depend on it
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    CaseError : no such question, an event without a share, a target that is none
    DataError : no finished result in the folder; shear decides about it; points have to be counted, and an input is
        gone or has changed; files in the way in the folder
    """
    folder = given_path(folder, "folder")
    case_file = None if case_file is None else given_path(case_file, "case_file")
    place = None if into is None else given_path(into, "into")
    if place is not None:
        refuse_results(place, [folder])
        refuse_foreign(place, FILLED, force=force, inputs=[])
    stage("reading the result")
    stored = open_stored(folder, no_lock=no_lock)
    of = question(asked, target, stored.record)
    base = base_of(stored, folder)

    counted: list[int] = []

    def counting(rows: Rows) -> AbstractContextManager[CountedPoints]:
        counted.append(len(rows))
        plates = _plates(stored, rows)
        return counted_points(folder, stored.record, rows, plates, case_file=case_file, threads=threads)

    rows, points = _answered(base, of, counting)
    if counted and not points:
        points = f"{sum(counted)} points were counted again: what is stored of them does not tell the answer."
    found = Answers(
        title=str(stored.record["title"]),
        asked=of,
        held=HELD[of.of],
        points=points,
        rows=rows,
        warnings=tuple(_doubts(stored, folder)),
    )
    if place is not None:
        stage("writing table and page")
        written = _write(place, folder, found, csv=csv)
        found = replace(found, written=tuple(str(place / name) for name in written))
    return found


def _answered(base: Base, asked: Question, counting: Counting) -> tuple[tuple[AnswerRow, ...], str]:
    """Rows of the answers, and which points were counted for them."""
    match asked.of:
        case "km_per_year":
            base, mileage = mileages(base, asked, counting)
            return mileage_rows(base, asked, mileage), ""
        case "share":
            base, of_event = shares(base, asked, counting)
            return share_rows(base, asked, of_event), ""
        case "thickness":
            looked_at, points = _affordable(base)
            return strength_rows(base, asked, of_thickness(base, asked.target_km, counting, looked_at)), points
        case kind:
            return strength_rows(base, asked, from_stored(base, kind, asked.target_km, counting)), ""


def _affordable(base: Base) -> tuple[Rows, str]:
    """Toe points that are looked at for the thickness: all of them if that is affordable."""
    stored = base.stored
    factors = upsampling_factors(stored.record)
    samples = sum(f * event["samples"] for f, event in zip(factors, stored.record["mission"]["events"], strict=True))
    toes = np.flatnonzero(stored.toe)
    if len(toes) * samples <= MOST_SAMPLES:
        return toes, f"All {len(toes)} points with a weld toe were looked at."
    worst = np.zeros(len(stored.welds))
    np.maximum.at(worst, stored.weld[toes], stored.damage_per_km[toes])
    rows = toes[stored.damage_per_km[toes] >= SHARE_OF_WORST * worst[stored.weld[toes]]]
    return rows, (
        f"{len(rows)} of {len(toes)} points with a weld toe were looked at, those with at least {SHARE_OF_WORST:g} of "
        "the damage of the worst of their weld: all would take long."
    )


def _plates(stored: Stored, rows: Rows) -> Plates:
    curves = stored.of_welds["curve"].to_numpy()[stored.weld[rows]]
    return Plates(stored.thickness[rows], stored.attachment[rows], tuple(map(str, curves)))


def _doubts(stored: Stored, folder: Path) -> Iterator[Problem]:
    beside = int(stored.of_welds["worst_check"].fillna("").ne("").sum())
    if beside:
        what = f"{beside} welds have checks beside the normal stress at the toe, of which no answer says anything"
        yield Problem("backsolve_checks", str(folder), what, "Assess the changed case for them")


def _write(place: Path, folder: Path, found: Answers, *, csv: bool) -> list[str]:
    said = {
        "title": found.title,
        "result": str(folder),
        "question": found.asked.name,
        "target_km": found.asked.target_km,
        "years": found.asked.years,
        "verdict": found.verdict,
        "held": found.held,
        "points": found.points,
        "warnings": [asdict(problem) for problem in found.warnings],
    }
    tables = {"backsolve": (BACKSOLVE, found.rows)}
    return fill(place, FILLED, tables, {PAGE: answers_page(found)}, said, csv=csv)
