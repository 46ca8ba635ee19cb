"""What commands print besides their own text: JSON on stdout, warnings on stderr."""

import json
import logging
import sys
from typing import Any

import click

from fatigue.cli.streams import shows_every_letter
from fatigue.errors import Problem

log = logging.getLogger(__name__)


def print_json(record: Any) -> None:
    """Print a record as JSON; infinite and missing numbers become null, letters the terminal lacks their escapes."""
    from fatigue.results import json_ready

    ascii_only = not shows_every_letter(sys.stdout)
    click.echo(json.dumps(json_ready(record), indent=2, ensure_ascii=ascii_only, allow_nan=False))


def print_warnings(problems: tuple[Problem, ...], others_are: str = "see provenance.json") -> None:
    """Log the first warning of each kind, and how many more there are and where."""
    kinds: dict[str, list[Problem]] = {}
    for problem in problems:
        kinds.setdefault(problem.code, []).append(problem)
    for same in kinds.values():
        others = sum(problem.count for problem in same) - 1
        more = f" (and {others} more of this kind, {others_are})" if others else ""
        log.warning("%s%s", same[0], more)
