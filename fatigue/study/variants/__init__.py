"""A study run: what varies, where histories come from, the runs, and their numbers beside each other.

``varied`` makes the variants and tries each before anything runs, ``source`` makes histories, ``runs`` lead from
settings to numbers, ``scatter`` and ``ratios`` lay numbers side by side, ``story`` is the whole.
"""
