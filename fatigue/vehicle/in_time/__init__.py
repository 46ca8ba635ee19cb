"""A vehicle in time: what linear contact leaves out, one step, what is kept of the states, histories thinned."""
