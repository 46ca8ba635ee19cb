"""The command line: parse, call, print."""

from fatigue.cli import foreign  # registers its commands
from fatigue.cli.main import cli, main

__all__ = ["cli", "foreign", "main"]
