"""Commands that decide from finished results, one file for each; none knows another."""

from fatigue.cli.commands.decide import backsolve, compare, fleet, whatif

__all__ = ["backsolve", "compare", "fleet", "whatif"]
