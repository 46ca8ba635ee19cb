"""Evidence on the page: what speaks for the numbers, what was not run, and what the reader has to do about warnings."""
