"""A recount of finished results by other code than the one that made them."""

from fatigue.verify.recount.folder import recount
from fatigue.verify.recount.stored.compare import ColumnCheck, Recount

__all__ = ["ColumnCheck", "Recount", "recount"]
