"""From a case to finished blocks of damage and the rows of its tables."""
