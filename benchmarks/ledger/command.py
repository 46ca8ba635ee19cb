"""``python -m benchmarks ledger [-o FILE]``."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.ledger.story import Size, facts, ledger
from benchmarks.ledger.written import page, table


def main(words: Sequence[str]) -> None:
    """Measure everything; write the page, or all digits where the file ends in .csv; without a file print the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks ledger", description=main.__doc__)
    parser.add_argument("-o", "--output", type=Path, help="file to write: .md the page, .csv all digits")
    parser.add_argument("--signals", type=int, help="signals of each kind, an even number [as the page has them]")
    parser.add_argument("--samples", type=int, help="samples of each signal [as the page has them]")
    given = parser.parse_args(words)
    if given.signals is not None and (given.signals < 2 or given.signals % 2):
        parser.error(f"--signals {given.signals}: give an even number, a point of ours has two faces")
    if given.samples is not None and given.samples < 512:
        parser.error(
            f"--samples {given.samples}: give 512 or more, shorter records are not counted in single precision"
        )
    if given.output is not None and given.output.suffix not in {".md", ".csv"}:
        parser.error(f"-o {given.output}: give a file that ends in .md or .csv")
    entries = list(ledger(Size(given.signals, given.samples), lambda what: print(what, file=sys.stderr, flush=True)))
    text = (table if given.output is not None and given.output.suffix == ".csv" else page)(entries, facts())
    if given.output is None:
        print(text)
    else:
        given.output.write_text(text, encoding="utf-8")
