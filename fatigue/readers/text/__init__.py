"""Text tables of any program: encoding, lines, separator, layout, numbers, flags, rows."""
