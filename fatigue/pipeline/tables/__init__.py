"""The results of a group of welds go in; the rows of the result tables come out.

``rows`` (points, events, modes), ``register`` (welds), ``cycles`` (those of the points that decide); for the whole job
``provenance`` (where its numbers come from) and ``warnings`` (what is doubtful, in few lines).
"""
