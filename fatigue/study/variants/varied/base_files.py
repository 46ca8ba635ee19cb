"""Vehicle and case of a study, as their files have them and with the changes of a variant."""

import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from fatigue.case import Case, load_case
from fatigue.case.checks import CHECK_FILES
from fatigue.case.load import parsed_case
from fatigue.case.tables import BASIS_FILES, BODY_FILES, GAUGE_FILES
from fatigue.errors import CaseError, Problem, refuse
from fatigue.study.study_file import Study
from fatigue.study.variants.runs.case_of_run import way
from fatigue.study.variants.varied.dotted import NoSuchKey, put, value_at
from fatigue.study.variants.varied.toml_text import toml_text
from fatigue.study.vehicle_file import FRAME, load_vehicle
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.settled import settled

VEHICLE, CASE, OWN = "vehicle.", "case.", "own."
FILES = (*BODY_FILES, *BASIS_FILES, *GAUGE_FILES, *CHECK_FILES, "register", "history", "vibration_table")


@dataclass(frozen=True)
class ChangedCase:
    """A case with the changes of a variant: its tables as its file would have them, and the case they make."""

    tables: Mapping[str, Any]
    case: Case


class BaseFiles:
    """The files that a study begins with; a file is read once."""

    def __init__(self, study: Study) -> None:
        self.study = study

    @cached_property
    def vehicle(self) -> Vehicle | None:
        """The vehicle as its file has it; None of a study without one.

        Raises
        ------
        CaseError : mistakes of the file
        """
        return self.changed_vehicle({})

    @cached_property
    def case(self) -> ChangedCase | None:
        """The case as its file has it; None of a study without one.

        Raises
        ------
        CaseError : mistakes of the file
        """
        return self.changed_case({})

    def changed_vehicle(self, changes: Mapping[str, Any]) -> Vehicle | None:
        """The vehicle with changes by whole keys, those of other files among them.

        Raises
        ------
        CaseError : changes that no vehicle can have
        """
        if self.study.base.vehicle is None:
            return None
        own = {key.removeprefix(VEHICLE): value for key, value in changes.items() if key.startswith(VEHICLE)}
        if isinstance(body := own.get("car.body"), str) and body != FRAME:
            own["car.body"] = str(self.study.resolve(body))
        path = self.study.resolve(self.study.base.vehicle)
        return load_vehicle(path, own, path.name)

    def changed_case(self, changes: Mapping[str, Any]) -> ChangedCase | None:
        """The case with changes by whole keys, those of other files among them.

        Raises
        ------
        CaseError : changes that no case can have
        """
        given = changes.get("case", self.study.base.case)
        if given is None:
            return None
        path = self.study.resolve(str(given))
        case = load_case(path)
        tables = tomllib.loads(case.text)
        own = {key.removeprefix(CASE): value for key, value in changes.items() if key.startswith(CASE)}
        if not own:
            return ChangedCase(tables, case)
        own = {key: self._as_in(path.parent, key, value) for key, value in own.items()}
        refuse(CaseError, _put_all(tables, own, path.name))
        return ChangedCase(tables, parsed_case(path, toml_text(tables)))

    def value(self, key: str) -> Any:
        """Value under a whole key as the files have it, defaults included; None where there is none.

        Lists are lists, whatever the files are kept as.
        """
        if key == "case":
            return self.study.base.case
        if key.startswith(VEHICLE) and self.vehicle is not None:
            return _listed(_of_vehicle(self.vehicle, key.removeprefix(VEHICLE)))
        if key.startswith(CASE) and self.case is not None:
            try:
                return value_at(self._tables_with_defaults, key.removeprefix(CASE))
            except NoSuchKey:
                return None
        return None

    def _as_in(self, folder: Path, key: str, value: Any) -> Any:
        """A value as the case would have it: the way to a file begins there, and in the study at the study."""
        is_file = key.rpartition(".")[2] in FILES and isinstance(value, str)
        return way(self.study.resolve(value), folder) if is_file else value

    @cached_property
    def _tables_with_defaults(self) -> dict[str, Any]:
        assert self.case is not None
        return self.case.case.model_dump(mode="json", by_alias=True)


def _put_all(tables: dict[str, Any], changes: Mapping[str, Any], file: str) -> Iterator[Problem]:
    """Set values under keys, in place; refusals of keys that lead nowhere."""
    for key, value in changes.items():
        try:
            put(tables, key, deepcopy(value))
        except NoSuchKey as error:
            yield Problem("unknown_key", f"{file}: {key}", error.what, error.remedy)


def _of_vehicle(vehicle: Vehicle, key: str) -> Any:
    """Value under a key of a vehicle, that of its setting where it has none of its own; None of an unknown key."""
    table, _, name = key.partition(".")
    value = getattr(getattr(vehicle, table, None), name, None)
    return getattr(settled(vehicle), name, None) if value is None else value


def _listed(value: Any) -> Any:
    return [_listed(one) for one in value] if isinstance(value, tuple) else value
