"""What stress is a sum over, read anew: the modes that are used and, behind them, the unit loads."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.inputs.case import RecountInputs, column, texts
from fatigue.verify.recount.inputs.tables import read_rows_where

ROUND_OFF_HZ = 1e-3  # of a rigid mode


@dataclass(frozen=True, slots=True, eq=False)
class RecountCoordinates:
    """The modes that are used, by ascending id, and the unit loads as the case lists them.

    Attributes
    ----------
    mode : (m,) ids
    unit_loads : (u,) names
    force_factor : (m + u,) turns the forces in the files into those on the element per unit of the coordinate
    highest_normal_hz : highest frequency of a normal mode above round-off, infinite without one
    """

    mode: NDArray[np.int64]
    unit_loads: tuple[str, ...]
    force_factor: NDArray[np.float64]
    highest_normal_hz: float

    def __len__(self) -> int:
        """Count the coordinates."""
        return len(self.force_factor)

    @property
    def labels(self) -> list[str]:
        """(m + u,) what each is in words."""
        return [*(f"mode {mode}" for mode in self.mode.tolist()), *(f"unit load {name}" for name in self.unit_loads)]


def read_coordinates(inputs: RecountInputs) -> RecountCoordinates:
    """Modes that are not ignored, and unit loads."""
    body = inputs.case["body"]
    frame = inputs.frame("modes").sort_values("mode")
    frame = frame[~frame["mode"].isin(body.get("ignore_modes", []))]
    sign = {"on_element": 1.0, "on_node": -1.0}[body["force_convention"]]
    hertz = frame["frequency_hz"].to_numpy(dtype=float)
    normal = np.array([kind in ("", "normal") for kind in texts(frame, "kind")]) & (hertz > ROUND_OFF_HZ)
    unit_loads = tuple(load["name"] for load in body.get("unit_load", []))
    return RecountCoordinates(
        mode=frame["mode"].to_numpy(dtype=np.int64),
        unit_loads=unit_loads,
        force_factor=sign * np.append(column(frame, "scale", 1.0), np.ones(len(unit_loads))),
        highest_normal_hz=float(hertz[normal].max(initial=0.0)) or np.inf,
    )


def forces_where(
    inputs: RecountInputs, coordinates: RecountCoordinates, table: str, key: str, values: Sequence[Any]
) -> pd.DataFrame:
    """Rows of all tables of nodal or element forces whose ``key`` is among some values.

    ``at`` is the place of each row's mode or unit load among the coordinates; other modes are left out.
    """
    return pd.concat(_forces(inputs, coordinates, table, key, values), ignore_index=True)


def _forces(
    inputs: RecountInputs, coordinates: RecountCoordinates, table: str, key: str, values: Sequence[Any]
) -> Iterator[pd.DataFrame]:
    of_modes = read_rows_where(inputs.path(table), key, values)
    place = {mode: at for at, mode in enumerate(coordinates.mode.tolist())}
    yield _placed(of_modes, "mode", place)
    loads: dict[str, dict[str, int]] = {}
    for at, load in enumerate(inputs.case["body"].get("unit_load", []), start=len(coordinates.mode)):
        loads.setdefault(load[table], {})[load["name"]] = at
    for file, place_of in loads.items():
        yield _placed(read_rows_where(inputs.folder / file, key, values), "unit_load", place_of)


def _placed(frame: pd.DataFrame, by: str, place: dict[Any, int]) -> pd.DataFrame:
    named = frame[by].str.strip() if by == "unit_load" else frame[by]
    at = named.map(place)
    return frame[at.notna()].drop(columns=by).assign(at=at[at.notna()].astype(np.int64))
