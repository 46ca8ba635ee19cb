"""Figures and data inside the page: as JSON that no name can break out of, arrays as base64 in single precision."""

import base64
import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import plotly.graph_objects as go
from markupsafe import Markup
from numpy.typing import NDArray

_CODES = {"float32": "f4", "int32": "i4"}


@dataclass(frozen=True, slots=True)
class Shown:
    """A figure of the page, with its number, its height [px] and its content as JSON."""

    id: str
    number: int
    caption: str
    height: int
    json: Markup


@dataclass(slots=True)
class Figures:
    """Numbers the figures of a page in the order in which they are added."""

    count: int = 0
    shown: list[Shown] = field(default_factory=list)

    def add(self, id_: str, fig: go.Figure, caption: str) -> Shown:
        """Keep a figure; the template they all share is in the page once and not in each."""
        content = json.loads(fig.to_json(remove_uids=True))
        content["layout"].pop("template")
        height = int(content["layout"].pop("height"))
        self.count += 1
        shown = Shown(id_, self.count, caption, height, embedded(content))
        self.shown.append(shown)
        return shown


def embedded(value: Any) -> Markup:
    """JSON that is safe inside a script element, whatever the texts in it."""
    text = json.dumps(value, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))


def packed(values: NDArray[np.generic]) -> dict[str, str]:
    """Write an array as plotly.js reads it: type and base64 of its bytes, infinite and missing values included."""
    little = values.astype(values.dtype.newbyteorder("<"))
    return {"dtype": _CODES[values.dtype.name], "bdata": base64.b64encode(little.tobytes()).decode()}
