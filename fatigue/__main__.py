"""``python -m fatigue``, and the command ``fatigue``: an interrupt is told in one line from the first import on."""

import sys


def main() -> None:
    """Run the command line."""
    try:
        from fatigue.cli import main as command_line  # noqa: PLC0415
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)  # noqa: T201 (nothing is imported that could tell it)
        sys.exit(130)
    command_line()


if __name__ == "__main__":
    main()
