"""Files as they are given: their names, their formats, their hashes."""
