"""What commands print: text and JSON on stdout, warnings on stderr; what cannot be seen in a name is spelled out."""

import json
import logging
import re
import sys
from typing import Any

import click

from fatigue.cli.streams import shows_every_letter
from fatigue.errors import Problem
from fatigue.shown import visible

log = logging.getLogger(__name__)


def say(text: object, *, err: bool = False) -> None:
    """Print lines of text."""
    click.echo(visible(str(text), keep="\n\t"), err=err)


def print_json(record: Any) -> None:
    """Print a record as JSON; infinite and missing numbers become null, what cannot be seen or written an escape."""
    from fatigue.results import json_ready

    ascii_only = not shows_every_letter(sys.stdout)
    text = json.dumps(json_ready(record), indent=2, ensure_ascii=ascii_only, allow_nan=False)
    click.echo(re.sub(r"[^\x20-\x7e\n]", lambda c: c[0] if visible(c[0]) == c[0] else json.dumps(c[0])[1:-1], text))


def print_warnings(problems: tuple[Problem, ...], others_are: str = "see provenance.json") -> None:
    """Log the first warning of each kind, and how many more there are and where."""
    kinds: dict[str, list[Problem]] = {}
    for problem in problems:
        kinds.setdefault(problem.code, []).append(problem)
    for same in kinds.values():
        others = sum(problem.count for problem in same) - same[0].count  # one that stands for several says so
        more = f" (and {others} more of this kind, {others_are})" if others else ""
        log.warning("%s%s", same[0], more)
