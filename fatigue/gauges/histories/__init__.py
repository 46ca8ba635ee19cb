"""What virtual gauges read in the events of a case: histories, cycles, and how sure the place of each is."""
