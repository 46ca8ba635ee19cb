"""Shear counted with the normal stress at the toes of welds.

A point runs along a path in the plane of normal stress and shear. ``settle`` says which points a proven bound, the
normal stress alone or one pair of instants settles; only the others, and each weld's worst point, are ``counted`` by
the path counter. ``group`` tells this as a story, ``found`` is what is kept of every point, and ``method`` lets a
method that the case names decide about life and verdict.
"""
