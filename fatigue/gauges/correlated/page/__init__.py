"""The page of a correlation and its figures."""
