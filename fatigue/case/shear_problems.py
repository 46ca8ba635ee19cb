"""What is wrong with shear at the toe beside other tables of a case."""

from collections.abc import Iterator, Mapping
from typing import Any

from fatigue.case.problems import clash
from fatigue.errors import Problem

COUNTED = ("range", "length", "mlp")  # methods of the path counter


def shear_problems(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Refusal of a path of samples that decides beside a normal stress whose reversals lie beyond the samples."""
    multiaxial, counting = (_table(raw.get(name)) for name in ("multiaxial", "counting"))
    method = multiaxial.get("method")
    if method in COUNTED and counting.get("reversals") == "vertex":
        what = f"method = {method!r} counts paths from sample to sample, and reversals = 'vertex' reads normal stress "
        what += "beyond them: the two sums could not be compared"
        yield clash("multiaxial.method", what, "Give reversals = 'samples' and upsample = 'auto', or method = 'report'")


def _table(value: object) -> Mapping[str, Any]:
    return value if isinstance(value, dict) else {}
