"""The page of a point: what the report shows of worst points, for any point of a result.

``story`` reads first; ``gathered`` is all that is known of the point, ``counted`` its numbers and cycles counted again,
``shared_out`` whose its damage is, ``notes`` what is to be said first. ``page`` and ``picture`` show it, ``summary``
prints it.
"""
