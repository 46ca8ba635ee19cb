"""The neutral format: tables of a case, read with file, column, row and value of every mistake."""
