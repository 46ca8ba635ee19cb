"""The flexible body in the neutral format: ``modes``, ``welds`` and their ``lines``, and the ``mesh`` around them."""
