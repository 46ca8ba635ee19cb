"""A recount of finished results by other code than the one that made them.

``folder`` tells the story: ``inputs`` are read anew, ``choice`` picks points, ``anew`` computes them, ``stored`` sets
the tables beside them, ``kept`` puts the outcome beside the result; ``layout`` says where the points are. What stands
for the same thing as a class of the program has its name with ``Recount`` before it, and shares nothing with it.
"""

from fatigue.verify.recount.folder import recount
from fatigue.verify.recount.kept import keep, outcome
from fatigue.verify.recount.stored.compare import ColumnCheck, Recount

__all__ = ["ColumnCheck", "Recount", "keep", "outcome", "recount"]
