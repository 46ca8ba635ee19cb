"""What is being done at the moment, for whoever waits: the command line shows it, ``fatigue.log`` keeps it."""

import logging

STAGES = "fatigue.stage"  # name of the logger


def stage(what: str, *values: object) -> None:
    """Say what begins now, in the words of a log record; it is over when the next stage begins."""
    logging.getLogger(STAGES).info(what, *values)
