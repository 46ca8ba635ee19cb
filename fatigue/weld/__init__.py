"""From nodal forces along a weld line to Dong's structural stress.

``line`` holds one line or a stack of lines, ``line_geometry`` its edges and local axes. ``line_load`` has the line
matrix (Eq. 2), solves for the line load (Eq. 1) and treats weld ends (Eq. 4), ``banded`` is its solver,
``structural_stress`` the plate section and its signs (Eq. 3). ``line_check``, ``line_units``, ``edge_type`` and
``warnings`` refuse or warn. ``element_forces`` sums the forces of the assessed side. From a shell mesh (``mesh``),
``detection`` finds weld edges, ``cuts`` makes lines of them, ``join`` makes one line of several.
"""
