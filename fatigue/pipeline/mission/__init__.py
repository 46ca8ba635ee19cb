"""From a mission to what its events are: records read, cut and checked, and what each brings to every station."""
