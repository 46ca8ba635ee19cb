"""Text tables of any program: encoding, layout, numbers, rows."""
