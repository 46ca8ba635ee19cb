"""What is checked at a weld beside the normal stress at its toe.

Every check is a **linear** stress per unit coordinate, so that it is counted as the stress at a toe is: ``signals``
holds such stresses and counts them under all events, sequences and constants included, ``rows`` is what is kept of
each check, as arrays, and its rows in ``checks.parquet``.
"""
