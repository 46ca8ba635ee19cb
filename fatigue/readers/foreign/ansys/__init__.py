"""ANSYS: the text that the macro writes, and archives (.cdb)."""
