"""What just meets the target: the load, curve, mileage, share or thickness, each proved by going forward.

``story`` first. ``question`` is what is asked; ``closed``, ``root`` and ``strength`` are the arithmetic. ``forward``
goes through what a result has stored, ``counted`` counts points again where that is not enough; ``by_strength`` and
``by_mission`` answer with both. ``rows``, ``summary`` and ``page`` are what comes out.
"""
