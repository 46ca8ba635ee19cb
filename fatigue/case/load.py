"""Read a case file: the whole of it is checked, and all its mistakes are reported at once."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from fatigue.case.problems import curve_problems, mission_problems, model_problems, read_text, syntax_problem
from fatigue.case.tables import Body, Case, Counting, Curve, CustomCurve, Event, Mission, Spectrum
from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.files.misplaced import misplaced
from fatigue.files.naming import missing_file
from fatigue.life.curves import catalogue

CASE_FILE = "this is a case (case.toml)"
DISTANCE_TOLERANCE = 1e-3  # relative, between length_km and speed times duration

MODELS: dict[tuple[str, ...], type[BaseModel]] = {
    (): Case,
    ("body",): Body,
    ("curve",): Curve,
    ("curves",): CustomCurve,
    ("counting",): Counting,
    ("spectrum",): Spectrum,
    ("mission",): Mission,
    ("mission", "event"): Event,
}


def load_case(path: Path | str) -> Case:
    """Read and check a case file; the files it names are not opened.

    Raises
    ------
    CaseError
        with every mistake of the file, not only the first
    """
    path = given_path(path, "case")
    text = read_text(path)
    problems: list[Problem] = []
    try:
        raw = tomllib.loads(text)
        problems += curve_problems(raw, catalogue())
        problems += mission_problems(raw)
        case = Case.model_validate(raw, context=(path, text))
    except tomllib.TOMLDecodeError as error:
        other = misplaced(path, path.name)
        if other is not None and other.what != CASE_FILE:
            raise CaseError(other) from None
        problems.append(syntax_problem(text, error))
    except ValidationError as error:
        problems[:0] = (found for details in error.errors() for found in model_problems(details, MODELS, raw))
    refuse(CaseError, (replace(problem, where=f"{path.name}: {problem.where}") for problem in problems))
    return case


def given_case(case: Case | Path | str) -> Case:
    """Return the case, read from its file where that is given.

    Raises
    ------
    CaseError
        as `load_case`
    """
    return case if isinstance(case, Case) else load_case(case)


def check_files(case: Case) -> None:
    """Refuse a case that names files which do not exist, all of them at once."""
    refuse(
        DataError,
        (
            missing_file(file, f"{case.path.name}: {key}", base=case.path.parent)
            for key, file in case.input_files().items()
            if not file.is_file()
        ),
    )


def event_length_km(event: Event, duration_s: float) -> float | None:
    """Distance of one pass [km]: ``length_km``, else speed times duration; None for an event counted by number."""
    if event.length_km is not None:
        return event.length_km
    return None if event.speed_km_h is None else event.speed_km_h * duration_s / 3600


def check_distance(event: Event, duration_s: float, where: str) -> None:
    """Refuse a length that contradicts speed times duration by more than 1e-3, where both are given."""
    if event.length_km is None or event.speed_km_h is None:
        return
    travelled = event.speed_km_h * duration_s / 3600
    if not math.isclose(event.length_km, travelled, rel_tol=DISTANCE_TOLERANCE):
        raise CaseError(
            Problem(
                "contradiction",
                where,
                f"length_km = {event.length_km:g} of event '{event.name}' is not speed_km_h = {event.speed_km_h:g} "
                f"times the duration of {duration_s:g} s, {travelled:g} km",
                "Correct one of them or leave one out",
            )
        )


def case_schema() -> dict[str, Any]:
    """JSON Schema of ``case.toml``, for editors that complete and check it."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Case.model_json_schema()}
