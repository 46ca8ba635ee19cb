"""What a conversion leaves for later: which lines the welds in its tables are of, and how it was called."""

import json
import os
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.weld_register import RegisterRow

if TYPE_CHECKING:
    from fatigue.readers.convert_options import ConvertOptions

LINES, COMMAND = "welds", "command"


@dataclass(frozen=True, slots=True)
class ConvertRecord:
    """What is known of a conversion; nothing where the tables were written by hand.

    Attributes
    ----------
    lines : by weld of the tables its lines, by line the thickness the register had confirmed, NaN if none [mm]
    arguments : of the command, without target and register; empty where they are not known
    folder : the folder it wrote
    """

    lines: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    arguments: tuple[str, ...] = ()
    folder: Path | None = None

    def command(self, register: Path) -> str:
        """Say how to convert once more with an edited register and keep the edited case; empty without a conversion."""
        if self.folder is None:
            return ""
        if not self.arguments:
            return f"Convert the files of {self.folder} again with --register {register}"
        words = ["fatigue", "convert", *self.arguments, "-o", str(self.folder), "--register", str(register)]
        return f"Run `{command_line([*words, '--keep-case'])}`"


def convert_record(path: Path | None) -> ConvertRecord:
    """Read the record of a conversion; of one by an earlier version there is less.

    Raises
    ------
    DataError : the file is damaged
    """
    if path is None:
        return ConvertRecord()
    try:
        record = json.loads(path.read_text("utf-8"))
        lines = {
            str(weld): {str(line): np.nan if value is None else float(value) for line, value in of_weld.items()}
            for weld, of_weld in record.get(LINES, {}).items()
        }
        return ConvertRecord(lines, tuple(map(str, record.get(COMMAND, ()))), path.parent)
    except (OSError, ValueError, TypeError, AttributeError) as error:
        what = f"is no record of a conversion ({type(error).__name__}: {error})"
        raise DataError(Problem("damaged_record", str(path), what, "Convert again, or remove the file")) from None


def lines_of_welds(rows: Sequence[RegisterRow]) -> dict[str, dict[str, float | None]]:
    """Record the lines of every weld that is assessed, with the thickness confirmed for each."""
    welds: dict[str, dict[str, float | None]] = {}
    for row in rows:
        if row.status == "assess":
            welds.setdefault(row.weld, {})[row.line] = row.thickness if row.confirmed else None
    return welds


def arguments_of(options: "ConvertOptions") -> list[str]:
    """Arguments of the command that converts with these options, without target and register; paths are absolute."""
    default, sources = type(options)(options.forces, options.mesh, options.out), options.welds
    named = {
        "--forces": options.forces,
        "--mesh": options.mesh,
        "--convention": options.convention,
        "--subcase": options.subcase,
        "--columns": options.columns,
        "--time-column": options.time_column,
        "--resample": options.resample_s,
        "--simulation-modes": options.simulation_modes,
        "--interface-modes": ",".join(map(str, options.interface_modes)) or None,
        "--ignore-modes": ",".join(map(str, options.ignore_modes)) or None,
        "--node-lists": sources.node_lists,
        **_changed(options, default, {"units": "force_units", "title": "title", "curve": "curve", "match": "match"}),
        **_changed(options, default, {"coordinate-units": "coordinate_units", "normalisation": "normalisation"}),
        **_changed(options, default, {"speed": "speed_km_h", "target-km": "target_km"}),
    }
    words = [word for name, value in named.items() if value is not None for word in (name, _word(value))]
    repeated = {"--coordinates": options.coordinates, "--accept": options.accept}
    repeated |= {"--unit-loads": options.unit_loads, "--set": sources.sets, "--marker": sources.markers}
    words += [word for name, values in repeated.items() for value in values for word in (name, _word(value))]
    words += [w for d in options.displacements for w in ("--displacement", _word(d.file), str(d.node), d.direction)]
    words += [] if sources.detect is None else ["--detect" if sources.detect else "--no-detect"]
    return words + ["--candidates"] * sources.candidates


def _changed(options: "ConvertOptions", default: "ConvertOptions", names: Mapping[str, str]) -> dict[str, object]:
    """Options that differ from their default."""
    values = {f"--{name}": getattr(options, attribute) for name, attribute in names.items()}
    return {f"--{name}": values[f"--{name}"] for name, a in names.items() if values[f"--{name}"] != getattr(default, a)}


def _word(value: object) -> str:
    return str(value.resolve()) if isinstance(value, Path) else str(value)


def command_line(words: Sequence[str]) -> str:
    """Write a command as it is typed on this system."""
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)
