"""``python -m fatigue``."""

from fatigue.cli import main

main()
