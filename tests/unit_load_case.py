"""The small case with a mode given as a unit load, and the tables of a result compared."""

from pathlib import Path

import numpy as np
import pandas as pd

from tests.small_case import SmallCase

LOAD = '[[body.unit_load]]\nname = "{name}"\nunit = "kN"\nnodal_forces = "loads.{suffix}"\n'


def as_unit_load(case: SmallCase, mode: int, name: str, suffix: str = "csv") -> pd.DataFrame:
    """Take a mode out of the modes, forces and histories, make it a unit load, and return its forces."""
    of_mode = case.nodal_forces["mode"] == mode
    forces = case.nodal_forces[of_mode].drop(columns="mode").assign(unit_load=name)
    case.nodal_forces = case.nodal_forces[~of_mode]
    case.modes = case.modes[case.modes["mode"] != mode]
    case.histories = {k: table.rename(columns={f"q_{mode}": f"u_{name}"}) for k, table in case.histories.items()}
    case.extra += LOAD.format(name=name, suffix=suffix)
    return forces


def write_with_loads(case: SmallCase, folder: Path, forces: pd.DataFrame, suffix: str = "csv") -> Path:
    """Write a case and the forces of its unit loads; return the path of the case file."""
    path = case.write(folder, suffix)
    if suffix == "csv":
        forces.to_csv(folder / "loads.csv", index=False)
    else:
        forces.to_parquet(folder / "loads.parquet", index=False)
    return path


def assert_same_tables(one: Path, other: Path, rtol: float, tables=("nodes", "damage", "cycles")) -> None:
    """Every number of the tables is the same to ``rtol`` of the largest in its column, every text the same."""
    for name in tables:
        a, b = (pd.read_parquet(folder / f"{name}.parquet") for folder in (one, other))
        assert list(a.columns) == list(b.columns)
        assert len(a) == len(b)
        for column in a.columns:
            if a[column].dtype.kind != "f":
                assert (a[column].astype(str) == b[column].astype(str)).all(), (name, column)
                continue
            x, y = a[column].to_numpy(), b[column].to_numpy()
            finite = np.isfinite(x)
            np.testing.assert_array_equal(finite, np.isfinite(y), err_msg=f"{name}: {column}")
            scale = np.abs(x[finite]).max(initial=1e-300)
            np.testing.assert_allclose(y[finite] / scale, x[finite] / scale, atol=rtol, err_msg=f"{name}: {column}")
