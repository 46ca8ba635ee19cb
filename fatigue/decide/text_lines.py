"""Tables as lines of text, for a terminal."""

from collections.abc import Collection, Iterator, Sequence


def aligned(rows: Sequence[Sequence[str]], right: Collection[int]) -> Iterator[str]:
    r"""A line for each row, the heads first; columns are as wide as they have to be, those of ``right`` end in line.

    >>> print(*aligned([("weld", "life"), ("A", "12.5"), ("long name", "3")], right=[1]), sep="\n")
      weld       life
      A          12.5
      long name     3
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        each = enumerate(zip(row, widths, strict=True))
        cells = (cell.rjust(width) if i in right else cell.ljust(width) for i, (cell, width) in each)
        yield ("  " + "  ".join(cells)).rstrip()
