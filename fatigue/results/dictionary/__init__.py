"""Parts of the data dictionary: what a column is, and the tables that ``fatigue.results.columns`` takes from here."""
