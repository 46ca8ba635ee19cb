"""The tables of a result as they stand, set beside the second computation and beside one another.

``keys`` finds the row of every point and ``runs`` the rows of its cycles and classes of ranges, ``tables`` opens all
tables of a result; ``rows``, ``loop_cycles`` and ``histogram`` say what a row should hold, ``compare`` how far the
stored row is from it; ``sums`` needs no second computation: it checks every row against the rows it follows from.
"""
