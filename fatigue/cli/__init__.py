"""The command line: parse, call, print."""

from fatigue.cli import beginnings, foreign  # register their commands
from fatigue.cli.main import cli, main

__all__ = ["beginnings", "cli", "foreign", "main"]
