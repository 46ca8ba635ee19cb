"""Commands about files of other programs, one file for each; none knows another."""

from fatigue.cli.commands.foreign import channels, request

__all__ = ["channels", "request"]
