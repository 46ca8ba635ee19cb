"""Commands about files of other programs, one file for each; none knows another."""

from fatigue.cli.commands.foreign import channels

__all__ = ["channels"]
