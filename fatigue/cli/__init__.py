"""The command line: parse, call, print. Heavy imports stay inside the commands, so that ``--help`` is quick."""

from fatigue.cli import assess, beginnings, convert, results, verify, welds  # register their commands
from fatigue.cli.main import cli, main

__all__ = ["assess", "beginnings", "cli", "convert", "main", "results", "verify", "welds"]
