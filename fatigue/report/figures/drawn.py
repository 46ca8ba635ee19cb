"""A figure as plotly.js takes it: traces and layout, plain dictionaries, which nothing checks while a page is made.

Plotly's own objects check every attribute, which takes most of the time that a page takes; here they do so only for who
asks for one, and in the tests, for every figure that any of them draws.
"""

import base64
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import plotly.graph_objects as go

Trace = dict[str, Any]

SMALLEST = ("int8", "int16", "int32")  # of whole numbers, what plotly.js reads
CODES = {"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"} | {
    "float32": "f4",
    "float64": "f8",
}


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """Traces and layout, its ``template`` included; ``plotly()`` is the same as one of plotly's own figures."""

    data: Sequence[Trace]
    layout: Mapping[str, Any]

    def plotly(self) -> "go.Figure":
        """Figure to be shown, changed or saved in a notebook, every attribute checked.

        Raises
        ------
        ValueError : plotly does not know an attribute, or a value of it
        """
        import plotly.graph_objects as go  # noqa: PLC0415 - a page needs none of it, and waits for nothing

        return go.Figure(data=list(self.data), layout=dict(self.layout))

    def content(self) -> dict[str, Any]:
        """What plotly.js reads, without the template: arrays by type and base64 of their bytes."""
        layout = {name: value for name, value in self.layout.items() if name != "template"}
        return {"data": [_plain(trace) for trace in self.data], "layout": _plain(layout)}

    def _ipython_display_(self) -> None:
        """Show it in a notebook by its name, as plotly shows its own."""
        self.plotly().show()


def _plain(value: Any) -> Any:
    """The same value of JSON types only; numbers that are not finite are null, except in arrays of numbers."""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return {name: _plain(held) for name, held in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(held) for held in value]
    if isinstance(value, np.generic):
        value = value.item()
    if hasattr(value, "to_numpy"):
        value = value.to_numpy()
    if isinstance(value, np.ndarray):
        return _typed(value) if value.size and value.dtype.kind in "iuf" else _plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _typed(values: NDArray[np.number]) -> Any:
    """Array as plotly.js reads it; whole numbers take the smallest type that holds them, if one does."""
    if values.dtype == np.int64:
        low, high = int(values.min()), int(values.max())
        fitting = next((t for t in SMALLEST if np.iinfo(t).min <= low and high <= np.iinfo(t).max), "float64")
        values = values.astype(fitting)
    found = {"dtype": CODES[values.dtype.name], "bdata": base64.b64encode(values.tobytes()).decode()}
    return found if values.ndim == 1 else found | {"shape": ", ".join(map(str, values.shape))}
