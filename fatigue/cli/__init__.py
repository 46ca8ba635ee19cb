"""The command line: parse, call, print. Heavy imports stay inside the commands, so that ``--help`` is quick."""

from fatigue.cli import assess, beginnings, foreign, results, verify  # register their commands
from fatigue.cli.main import cli, main

__all__ = ["assess", "beginnings", "cli", "foreign", "main", "results", "verify"]
