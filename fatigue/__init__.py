"""Weld fatigue life, in km, of a flexible rail-vehicle body.

The names below are all a notebook needs besides ``fatigue.assess.assess``, ``fatigue.diagnose.diagnose`` and
``fatigue.report.figures``; each is imported when it is first asked for, so that importing the package stays cheap.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOME = {
    "Result": "fatigue.point.result",
    "catalogue": "fatigue.life.curves",
    "check_case": "fatigue.check",
    "load_case": "fatigue.case",
    "open_result": "fatigue.point.result",
    "rainflow": "fatigue.life.counting.rainflow",
    "read_model": "fatigue.pipeline.solve.model",
    "read_provenance": "fatigue.results",
    "read_table": "fatigue.results",
    "recount": "fatigue.verify.recount",
    "result_summary": "fatigue.results.summary",
    "verification_table": "fatigue.verify.table",
}

__all__ = ["__version__", *_HOME]  # noqa: PLE0604 (names, all of them)


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module 'fatigue' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
