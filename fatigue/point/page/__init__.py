"""The page of a point: what the report shows of worst points, for any point of a result.

``story`` reads first; ``gathered`` is all that is known of the point, ``counted`` its numbers and cycles counted again,
``shared_out`` whose its damage is, ``beside`` what else was checked there. ``checked`` compares it with the result,
``notes`` says what is to be known first. ``page`` and ``picture`` show it with its ``tables``, ``summary`` prints it.
"""
