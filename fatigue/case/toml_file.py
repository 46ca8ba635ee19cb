"""A TOML file of the user: its tables as they are written, then as a checked model; each mistake is one clear line."""

import tomllib
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from fatigue.case.extremes import excess, extreme_values
from fatigue.case.problems import Contradictions, Models, model_problems, syntax_problem
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.misplaced import misplaced
from fatigue.files.naming import missing_file

OfFile = TypeVar("OfFile", bound=BaseModel)


def read_toml(path: Path | str, what: str) -> dict[str, Any]:
    """Return the tables of a TOML file; ``what`` names its kind, as in "a vehicle (vehicle.toml)".

    Raises
    ------
    CaseError : it is not there, cannot be read, is something else, or is no TOML
    """
    path = given_path(path, "file")
    text = _text(path, what)
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = misplaced(path, path.name) or syntax_problem(text, error)
    except (RecursionError, ValueError):  # nested without end; an integer of more digits than Python reads
        found = excess(text)
    else:
        refuse(CaseError, (replace(extreme, where=f"{path.name}: {extreme.where}") for extreme in extreme_values(raw)))
        return raw
    raise CaseError(found if found.where == path.name else replace(found, where=f"{path.name}: {found.where}"))


def checked_file(model: type[OfFile], raw: dict[str, Any], path: Path, models: Models) -> OfFile:
    """Model of the tables ``raw`` of a file, its context the path; ``models`` has the model of every table by its keys.

    Raises
    ------
    CaseError : every mistake of the file, not only the first
    """
    try:
        return model.model_validate(raw, context=path)
    except ValidationError as error:
        problems = [problem for details in error.errors() for problem in _problems(details, models, raw)]
    raise CaseError(*(replace(problem, where=f"{path.name}: {problem.where}") for problem in problems))


def _problems(details: ErrorDetails, models: Models, raw: dict[str, Any]) -> Iterable[Problem]:
    """Refusals that one finding of the models stands for; what contradicts itself across tables has its place."""
    cause = details.get("ctx", {}).get("error")
    if not details["loc"] and isinstance(cause, Contradictions):
        return cause.problems
    return model_problems(details, models, raw)


def _text(path: Path, what: str) -> str:
    """Text of a file in UTF-8, with or without byte order mark."""
    try:
        return path.read_bytes().decode("utf-8-sig")
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        problem = missing_file(path, wanted=what)
    except OSError as error:
        problem = Problem("unreadable_file", str(path), f"cannot be read ({error.strerror})", "Check its permissions")
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        problem = misplaced(path, path.name, text=False) or Problem(
            "not_utf8",
            f"{path.name}: line {line}",
            f"the byte {error.object[error.start]:#04x} is not UTF-8 text",
            "Save the file as UTF-8",
        )
    raise CaseError(problem)
