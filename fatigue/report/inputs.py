"""The input files of a finished result, found again and checked by their hashes, for what a report draws from them."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, Event
from fatigue.case.given_loads import given_loads
from fatigue.errors import DataError, FatigueError, Problem
from fatigue.files.hashes import sha256
from fatigue.life.records.history import ModalHistory
from fatigue.life.records.unit_load import LoadSource
from fatigue.readers.neutral.body.mesh import Mesh, read_mesh
from fatigue.readers.neutral.event.event_record import EventFiles, read_event
from fatigue.readers.neutral.event.load_units import column_names
from fatigue.readers.neutral.long_history import is_long
from fatigue.readers.neutral.register.weld_register import REGISTER
from fatigue.results import case_of, is_assessed_case


@dataclass(frozen=True, slots=True, eq=False)
class FoundInputs:
    """The inputs of a result: the case as it was assessed, the folder of its files and their hashes.

    ``root`` is None where the case file was not found any more; ``lost`` says so then, and what to do. ``outdated``
    are warnings about the welds, which are shown as they were assessed.
    """

    case: Case
    root: Path | None
    lost: Problem
    hashes: Mapping[str, str]
    modes: tuple[int, ...]
    outdated: tuple[Problem, ...] = ()

    def history(self, event: Event, scratch: Path | None = None) -> ModalHistory:
        """Read the kept record of an event as it was assessed, stress factor not applied.

        Unit loads are rows behind the modes. A long one goes to the file ``scratch``, if one is given.

        Raises
        ------
        DataError : the file is not there any more or is not the one that was assessed
        """
        path, sources = self._sources(event)
        files = EventFiles(
            event=event.name,
            path=path,
            modes=np.array(self.modes, dtype=np.int64),
            ignore_modes=self.case.body.ignore_modes,
            start_s=event.start_s,
            residue=self.case.residue(event),
            loads=tuple(self._found(source) for source in sources),
            strict=False,
        )
        return read_event(files, scratch if path and is_long(path) else None).history

    def constants(self, event: Event) -> NDArray[np.float64]:
        """Constants of an event beside its samples, (c,): 0 of all modes, and what is given of constant unit loads.

        Raises
        ------
        DataError : the file is not there any more or is not the one that was assessed
        """
        _, sources = self._sources(event)
        return np.concatenate([np.zeros(len(self.modes)), [source.constant for source in sources]])

    def _sources(self, event: Event) -> tuple[Path | None, tuple[LoadSource, ...]]:
        """The record of an event, and where it has each unit load from."""
        path = self._unchanged(event.history) if event.history else None
        return path, given_loads(self.case, event, column_names(path)) if self.case.body.unit_load else ()

    def _found(self, source: LoadSource) -> LoadSource:
        """The source of a unit load, its file found and unchanged."""
        return source if source.path is None else replace(source, path=self._unchanged(source.path.as_posix()))

    def mesh(self) -> Mesh | None:
        """Read the mesh for pictures; None where the case names none.

        Raises
        ------
        DataError : a file is not there any more or is not the one that was assessed
        """
        body = self.case.body
        if body.nodes is None or body.elements is None:
            return None
        mesh, _ = read_mesh(self._unchanged(body.nodes), self._unchanged(body.elements), strict=False)
        return mesh

    def _unchanged(self, name: str) -> Path:
        if self.root is None:
            raise DataError(self.lost)
        path = self.root / name
        if not path.is_file():
            raise DataError(Problem("missing_file", name, "is not there any more", "Put it back"))
        if sha256(path) != self.hashes.get(Path(name).as_posix()):
            raise DataError(Problem("changed_input", name, "has changed since the assessment", "Assess the case again"))
        return path


def find_inputs(record: Mapping[str, Any], folder: Path, case_path: Path | None) -> FoundInputs:
    """Inputs of the result with this provenance record, as far as they are found.

    The case file is where ``case_path`` says, by default where the record says. It counts as found when its case is the
    one that was assessed.

    Raises
    ------
    DataError : the case text in the record is no case, so the record is damaged
    """
    text: str = record["case_text"]
    try:
        case = Case.model_validate(tomllib.loads(text))
    except (ValueError, FatigueError) as error:
        raise DataError(
            Problem("damaged_result", "provenance.json", f"holds no valid case ({error})", "Run the assessment again")
        ) from None
    path = case_path or case_of(record, folder)
    root = path.parent if is_assessed_case(record, path) else None
    hashes = {entry["file"]: entry["sha256"] for entry in record["inputs"]}
    lost, modes = _lost(record, moved=not _is_text(path)), tuple(record["modes"]["used"])
    return FoundInputs(case, root, lost, hashes, modes, () if root is None else tuple(_outdated(case, root, hashes)))


def _outdated(case: Case, root: Path, hashes: Mapping[str, str]) -> Iterator[Problem]:
    """Warning that the weld register was edited, taken away or written since the assessment."""
    name = case.body.weld_register or str(Path(case.body.welds).parent / REGISTER)
    path, known = root / name, hashes.get(Path(name).as_posix())
    if not path.is_file():
        what = "" if known is None else "is not there any more"
    elif known is None and case.body.weld_register is None:
        what = "was not there when the result was computed"
    else:
        what = "" if sha256(path) in hashes.values() else "has changed since the assessment"
    if what:
        what += ", and the welds are shown as they were assessed"
        yield Problem("changed_input", path.name, what, "Assess the case again")


def _is_text(path: Path) -> bool:
    """Whether there is a file that a case can be; a folder and a binary file are none."""
    try:
        path.read_bytes().decode("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        return False
    return True


def _lost(record: Mapping[str, Any], *, moved: bool) -> Problem:
    """Problem of a case file that is gone or another: what cannot be shown without it, and the remedy."""
    what = "the case file is not where it was" if moved else "the case file has changed since the assessment"
    way, lacks = record["case_path"], "so mesh, stress histories and spectra are not shown"
    remedy = "Name it as it was assessed with `fatigue report DIR --case CASE`" + ("" if moved else ", or assess again")
    return Problem("missing_case", record["case_file"], f"{what} ({way} from the result folder), {lacks}", remedy)
