"""The tables of a result as they stand, and what must follow in them from other rows."""
