"""Figures of an analysis graph: stability maps, root loci, damping and frequency along a line, who has the energy."""
