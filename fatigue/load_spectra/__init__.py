"""What loads a point sees: its cycles recounted and listed by range, mean, reversals and level.

``points`` chooses, ``recounted`` counts, ``classes`` are what cycles are sorted into, ``gathered`` is what is kept of
an event and of the mission, ``signals`` is the same of the coordinates, ``measured`` reads a spectrum to compare with,
``rows`` and ``summary`` are tables and words.
"""
