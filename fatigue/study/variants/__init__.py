"""A study run: what varies, where histories come from, the runs, and their numbers beside each other.

``expansion`` makes the variants, ``checked`` tries each of them before anything runs, ``source`` makes histories,
``run`` leads from settings to numbers, ``scatter`` and ``ratios`` lay numbers side by side, ``story`` is the whole.
"""
