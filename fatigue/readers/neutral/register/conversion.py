"""What a conversion has left for later: which lines the welds in its tables are of, and how it was called."""

import json
import os
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem

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
        """How to convert once more with an edited register and keep the edited case; empty without a conversion."""
        if self.folder is None:
            return ""
        if not self.arguments:
            return f"Convert the files of {self.folder} again with --register {register}"
        words = ["fatigue", "convert", *self.arguments, "-o", str(self.folder), "--register", str(register)]
        return f"Run `{command_line([*words, '--keep-case'])}`"


def convert_record(path: Path | None) -> ConvertRecord:
    """Record of a conversion; of one by an earlier version there is less.

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
    except (OSError, ValueError, TypeError, AttributeError, RecursionError) as error:
        what = f"is no record of a conversion ({type(error).__name__}: {error})"
        raise DataError(Problem("damaged_record", str(path), what, "Convert again, or remove the file")) from None


def command_line(words: Sequence[str]) -> str:
    """A command as it is typed on this system."""
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)
