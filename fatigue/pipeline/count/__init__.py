"""The stations of a group of welds and the events go in; damage, life and what goes with them come out, in few arrays.

For one event at a block of stations: ``estimate`` (what its spectrum says), ``bounds`` (what its damage cannot exceed)
and ``event_block`` (what was counted); for all events: ``joined`` (cycles across them), ``mission_block`` and
``load_factor``. ``block`` puts them together for stations that share a curve. ``modal_bound`` and ``weld_bound`` are
the two tiers of bounds, ``settle`` the order in which they and counting settle stations. ``group`` does so for every
curve of a group, ``result`` keeps what comes of it, and ``worst`` finds the points that decide. ``overflow`` says where
numbers grew too large.
"""
