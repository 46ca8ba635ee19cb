"""Columns of very many rows inside the page, deflated: what the script of the page inflates when it is asked."""

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

CODES = ("u1", "u2", "i4", "f4", "f8")


def deflated(columns: Mapping[str, NDArray[np.generic]]) -> dict[str, Any]:
    """Columns as names, types and lengths, beside the base64 of their bytes.

    First bytes of all values stand before second bytes, and so on: like beside like takes less. Whole numbers take the
    smallest type that holds them, others single precision.
    """
    heads, planes = [], []
    for name, values in columns.items():
        code = _code(values)
        heads.append([name, code, len(values)])
        stored = np.ascontiguousarray(values, dtype=f"<{code}")
        planes.append(stored.view(np.uint8).reshape(len(values), stored.itemsize).T.tobytes())
    return {"heads": heads, "deflate": base64.b64encode(zlib.compress(b"".join(planes), 6)).decode()}


def _code(values: NDArray[np.generic]) -> str:
    """Type of a column in the page; ids beyond 32 bits take double precision, which holds them."""
    if values.dtype.kind not in "iu":
        return "f4"
    low, high = int(values.min(initial=0)), int(values.max(initial=0))
    return next((c for c in CODES[:3] if np.iinfo(c).min <= low and high <= np.iinfo(c).max), "f8")
