"""Who does the work: groups of welds in threads, processes or a cluster, and what an interrupted run leaves."""
