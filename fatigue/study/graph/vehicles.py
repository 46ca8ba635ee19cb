"""The vehicles of a graph: files, each as it is or in some settings of its suspension, and a name for each."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from fatigue.errors import CaseError, Problem, refuse
from fatigue.study.vehicle_file import load_vehicle
from fatigue.vehicle.definition import Vehicle

OPTION = "--setting"


def named_vehicles(files: Sequence[Path], settings: Sequence[str] = ()) -> dict[str, Vehicle]:
    """Vehicles by name, each file once: name of the file, of its folder too where files share one, and the setting.

    Raises
    ------
    CaseError : the mistakes of all files
    """
    files = list({file.resolve(): file for file in files}.values())
    problems: list[Problem] = []
    found: dict[str, Vehicle] = {}
    for file, name in zip(files, _names(files), strict=True):
        for setting in settings or (None,):
            changed = {} if setting is None else {"suspension.setting": setting}
            called = name if setting is None else setting if len(files) == 1 else f"{name}, {setting}"
            try:
                found[called] = load_vehicle(file, changed, OPTION)
            except CaseError as error:
                problems += [problem for problem in error.problems if problem not in problems]
    refuse(CaseError, problems)
    return found


def _names(files: Sequence[Path]) -> list[str]:
    """A name for each file: as little of its path as tells it from the others.

    >>> _names([Path("a/vehicle.toml"), Path("b/vehicle.toml"), Path("soft.toml")])
    ['a/vehicle', 'b/vehicle', 'soft']
    """
    names = [file.stem for file in files]
    for parts in range(2, 9):
        shared = {name for name, count in Counter(names).items() if count > 1}
        if not shared:
            break
        names = [
            "/".join([*file.resolve().parts[-parts:-1], file.stem]) if name in shared else name
            for file, name in zip(files, names, strict=True)
        ]
    return names
