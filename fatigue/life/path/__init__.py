"""Counting of normal and shear stress at once: half cycles of their path, one after the other.

The path of both stresses over time is a line in the plane of ``(normal, sqrt(beta) shear)``, or in more dimensions.
Rainflow pairs the reversals of one stress; a path turns without reversing, so it is paired by distance:

- The two points of the path farthest apart, P before Q, are one half cycle; its **range** is their distance.
- From P to Q the path is **real** where it is farther from P than ever before. In between are **excursions**, from
  where the distance begins to fall to where it is as large again.
- The same is done with every excursion, and with what lies before P and behind Q.

The real parts of all half cycles together are the path, once. On a straight path the half cycles are those of rainflow
counting. The length of a real part over its range, the path factor, is 1 on a straight line and pi/2 on a half circle;
its area moment about P, over that of a half circle, is 0 and 1. Noise makes many small excursions of a smooth path:
both numbers are then too low, while the range stays. The counter is of the kind of path-dependent maximum range
counting (Dong, Wei and Hong 2010), whose text it does not follow: ties, and what recurs, are defined here.

``count`` counts, by the loops of ``walk`` on the searches of ``most_distant`` and ``hulls``; ``ranges`` makes
equivalent ranges and damage of the half cycles. Where the damage is bounded without counting: ``bounds.path_bound``.
"""
