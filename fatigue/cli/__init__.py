"""The command line: parse, call, print."""

from fatigue.cli import beginnings, convert, welds  # register their commands
from fatigue.cli.main import cli, main

__all__ = ["beginnings", "cli", "convert", "main", "welds"]
