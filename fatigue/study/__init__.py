"""Studies: from the parameters of a vehicle to lives in km, over variants and seeds, and sentences as tests of them.

``graph`` is the map of stability over speed and conicity, ``variants`` runs a study and lays its variants side by side,
``claims`` says of sentences whether the study reproduces or contradicts them.
"""
