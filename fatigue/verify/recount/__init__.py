"""A recount of finished results by other code than the one that made them."""

from fatigue.verify.recount.compare import ColumnCheck, Recount
from fatigue.verify.recount.folder import recount

__all__ = ["ColumnCheck", "Recount", "recount"]
