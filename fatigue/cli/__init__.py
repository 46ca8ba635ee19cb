"""The command line: parse, call, print. Heavy imports stay inside the commands, so that ``--help`` is quick."""

from fatigue.cli import commands  # registers them
from fatigue.cli.main import cli, main

__all__ = ["cli", "commands", "main"]
