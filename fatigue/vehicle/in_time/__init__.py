"""A vehicle in time: what linear contact leaves out, one step, limit cycles, histories thinned for the assessor."""
