"""``python -m fatigue``, and the command ``fatigue``: an interrupt is told in one line from the first import on."""

import atexit
import gc
import sys

OBJECTS = 50_000  # made between two searches for garbage: some MB; by default 700, which costs the imports a tenth


def main() -> None:
    """Run the command line."""
    collect_rarely()
    try:
        from fatigue.cli import main as command_line  # noqa: PLC0415
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)  # noqa: T201 (nothing is imported that could tell it)
        sys.exit(130)
    command_line()


def collect_rarely() -> None:
    """Search a process of its own for cyclic garbage seldom, and not at its end, where the system takes all at once.

    The libraries are some 200 000 objects that stay until the end: looking through them there takes up to 0.4 s.
    """
    gc.set_threshold(OBJECTS)
    atexit.register(gc.freeze)  # registered first it is called last


if __name__ == "__main__":
    main()
