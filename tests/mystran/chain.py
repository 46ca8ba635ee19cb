"""The way of a user: deck, solver, convert, assess."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.readers.convert.convert import Conversion, convert
from fatigue.readers.convert.options import ConvertOptions
from tests.mystran.solver import solve_text

STEP_S, STEPS = 0.005, 400


@dataclass(frozen=True)
class Chain:
    """What one run left behind: its input and result files, the conversion, and the folder of results."""

    mesh: Path
    op2: Path
    conversion: Conversion
    result: Path

    @property
    def lights(self):
        """Rows of the audit by their name."""
        return {row.check: row for row in self.conversion.audit.rows}

    def stress(self):
        """Structural stress per unit of every mode, one row for each node of a line and mode."""
        return pd.read_parquet(self.result / "structural_stress.parquet")


def chain(deck, folder, name, modes=None, text=None, **options):
    """Solve a deck, or its edited text, convert its results with waves as modal coordinates, and assess them."""
    mesh, op2 = solve_text(text or deck.text(), folder, name)
    modes = modes or range(1, 1 + (deck.modes if deck.sol == 103 else len(deck.plates.loads)))
    waves = waves_file(folder / f"{name}.csv", modes, 1.0 if deck.sol == 101 else 1e-3)
    done = convert(
        ConvertOptions(
            forces=op2, mesh=mesh, out=folder / f"{name}_body", coordinates=(waves,), force_units=deck.units, **options
        )
    )
    assess(load_case(done.folder / "case.toml"), folder / f"{name}_result", report=False)
    return Chain(mesh, op2, done, folder / f"{name}_result")


def waves_file(path, modes, amplitude):
    """Write modal coordinates: every mode swings with a frequency of its own."""
    time = STEP_S * np.arange(STEPS)
    table = {"time_s": time}
    table |= {f"q_{m}": amplitude * np.sin(2 * np.pi * (3 + k) * time + k) for k, m in enumerate(modes)}
    pd.DataFrame(table).to_csv(path, index=False)
    return path
