"""The command line: parse, call, print. Heavy imports stay inside the commands, so that ``--help`` is quick.

``main`` is the group of all ``commands`` and their exit codes. ``arguments``, ``numbers`` and ``options`` are what
commands take, ``early`` refuses mistakes before anything heavy is imported; ``progress`` and ``output`` are what is
seen of a command. ``known_values`` are computed for the report. Of the process, ``memory`` sets the allocators,
``streams`` are what it prints to, ``ends`` are its signals, and ``mishaps`` is what the machine refused, in words.
"""

from fatigue.cli import commands  # registers them
from fatigue.cli.main import cli, main

__all__ = ["cli", "commands", "main"]
