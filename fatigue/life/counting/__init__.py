r"""Rainflow counting: how cycles are found, and what is kept of them.

How cycles are found. A history is a chain of reversals. Take four in a row, a to d: the range from b to c is a closed
cycle if it is not larger than the range before it and not larger than the range after it::

                  d
         b       /          |b - c| <= |a - b|   and   |b - c| <= |c - d|
        / \     /
       /   \   /            b - c is one closed cycle, a hysteresis loop of the material.
      /     \ /             Taken out, it leaves the rise from a to d as if it had never been there,
     /       c              and the next four points are looked at.
    a

The four-point rule may take cycles out in any order, so many at a time (``single``). On a stack the first condition
always holds, and the last three points are enough: X = |c - d| closes Y = |b - c| if X >= Y (``reversals``, ASTM
E1049-85, 5.4.4). Both find the same cycles. The rest, the residue, counts as half cycles (``half``); or the history
recurs, and begun at its largest sample it closes entirely (``repeat``, ASTM E1049-85, 5.4.5).

What is kept of them. ``rainflow.rainflow`` keeps every cycle of one signal: its range, mean, count and two instants.
``count.count`` keeps their damage and what goes with it, for both faces of a block of points (``BlockCount``). It calls
one of three counters, all with the same arguments, a ``BlockStress``, a ``CountedRecord`` and a ``CycleRule``:

============ ========= ==================== =================================== ======================================
counter      precision laws                 records                             serves
============ ========= ==================== =================================== ======================================
count_single single    one slope, up to 12  512 samples or more, also on disk   large jobs: records prepared for it
count_rows   double    any                  up to 250 000 samples               small jobs: little of it is compiled
count_chunks double    any                  any, also on disk                   all else
============ ========= ==================== =================================== ======================================

``count_single`` turns to double precision where rounding may decide which of two stresses is the larger one, and to
``count_chunks`` for points in high mean tension. Its damage differs from the other two by less than 1e-6; they agree
to 1e-12.
"""
