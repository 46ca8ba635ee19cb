"""Does the program compute what it says: cases with ``known`` answers in a ``table``, and a ``recount`` of results."""
