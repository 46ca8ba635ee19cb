"""Read a case file: the whole of it is checked, and all its mistakes are reported at once."""

import math
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from fatigue.case.channels import Alarm, Channel, Equipment, EquipmentMode, Ride, channel_problems
from fatigue.case.check_problems import counts_problems, shear_problems
from fatigue.case.checks import Checks, EnduranceCheck, Interaction, Multiaxial, StressCategory
from fatigue.case.curves import Curve, CustomCurve, own_curve_problems
from fatigue.case.extremes import excess, extreme_values
from fatigue.case.identity.report import Report
from fatigue.case.life_band import LifeBand
from fatigue.case.load_problems import unit_load_problems
from fatigue.case.order.sequence_problems import sequence_problems
from fatigue.case.order.sequences import Sequence
from fatigue.case.problems import curve_problems, mission_problems, model_problems, syntax_problem
from fatigue.case.tables import Body, Case, Counting, Event, Mission, Spectrum
from fatigue.case.unit_loads import GivenLoad, MissionLoad, UnitLoad
from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.files.mishaps import refusal
from fatigue.files.misplaced import misplaced
from fatigue.files.naming import missing_case, missing_file
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
    ("mission", "sequence"): Sequence,
    ("mission", "unit_load"): MissionLoad,
    ("mission", "event", "unit_load"): GivenLoad,
    ("body", "unit_load"): UnitLoad,
    ("mission", "event", "channel"): Channel,
    ("life_band",): LifeBand,
    ("ride",): Ride,
    ("ride", "alarm"): Alarm,
    ("ride", "equipment_mode"): EquipmentMode,
    ("ride", "equipment"): Equipment,
    ("multiaxial",): Multiaxial,
    ("checks",): Checks,
    ("checks", "interaction"): Interaction,
    ("checks", "endurance"): EnduranceCheck,
    ("checks", "stress_category"): StressCategory,
    ("report",): Report,
}


def load_case(path: Path | str) -> Case:
    """Case of a case file, read and checked; the files it names are not opened.

    Raises
    ------
    CaseError
        with every mistake of the file, not only the first
    """
    path = given_path(path, "case")
    return parsed_case(path, _text(path))


def parsed_case(path: Path, text: str) -> Case:
    """Case of the text of a case file, which need not be there; the files it names are relative to it.

    Raises
    ------
    CaseError
        as ``load_case``
    """
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        other = misplaced(path, path.name)
        if other is not None and other.what != CASE_FILE:
            raise CaseError(other) from None
        problem = syntax_problem(text, error)
    except (RecursionError, ValueError):  # an integer of more digits than Python reads
        problem = excess(text)
    else:
        return case_of_tables(path, text, raw)
    raise CaseError(replace(problem, where=f"{path.name}: {problem.where}"))


def case_of_tables(path: Path, text: str, raw: dict[str, Any]) -> Case:
    """Case of the tables that a case file holds, or of others in their place; ``text`` is what is kept as its text.

    Raises
    ------
    CaseError
        as ``load_case``
    """
    problems: list[Problem] = []
    try:
        refuse(CaseError, (replace(extreme, where=f"{path.name}: {extreme.where}") for extreme in extreme_values(raw)))
        problems += curve_problems(raw, catalogue())
        problems += own_curve_problems(raw, catalogue())
        problems += mission_problems(raw)
        problems += sequence_problems(raw)
        problems += counts_problems(raw)
        problems += unit_load_problems(raw)
        problems += channel_problems(raw)
        problems += shear_problems(raw)
        case = Case.model_validate(raw, context=(path, text))
    except RecursionError:
        problems.append(excess(text))
    except ValidationError as error:  # a ``ValueError``, as is the next
        problems[:0] = (found for details in error.errors() for found in model_problems(details, MODELS, raw))
    except ValueError:
        problems.append(excess(text))
    refuse(CaseError, (replace(problem, where=f"{path.name}: {problem.where}") for problem in problems))
    return case


def given_case(case: Case | Path | str) -> Case:
    """The case itself, or the case of the file that is given.

    Raises
    ------
    CaseError
        as ``load_case``
    """
    return case if isinstance(case, Case) else load_case(case)


def check_files(case: Case) -> None:
    """Refuse a case that names files which do not exist, all of them at once."""
    refuse(
        DataError,
        (
            problem
            for key, file in case.input_files().items()
            for problem in _absent(file, f"{case.path.name}: {key}", case.path.parent)
        ),
    )


def _absent(file: Path, where: str, base: Path) -> Iterator[Problem]:
    """Refusal of a file that is not there, or whose name no file can have."""
    try:
        if not file.is_file():
            yield missing_file(file, where, base=base)
    except OSError as error:
        refused = refusal(error, file)
        yield replace(refused, where=where, what=f"{refused.where} {refused.what}")


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


def _text(path: Path) -> str:
    """Text of a case file in UTF-8, with or without byte order mark."""
    try:
        return path.read_bytes().decode("utf-8-sig")
    except (FileNotFoundError, IsADirectoryError):
        problem = missing_case(path)
    except OSError as error:
        problem = Problem("unreadable_file", str(path), f"cannot be read ({error.strerror})", "Check its permissions")
    except UnicodeDecodeError as error:
        if (other := misplaced(path, path.name, text=False)) is not None:
            raise CaseError(other) from None
        line = error.object[: error.start].count(b"\n") + 1
        problem = Problem(
            "not_utf8",
            f"{path.name}: line {line}",
            f"the byte {error.object[error.start]:#04x} is not UTF-8 text",
            "Save the file as UTF-8",
        )
    raise CaseError(problem)
