"""From nodal forces along a weld line to Dong's structural stress.

``line`` holds one line or a stack of lines, ``line_geometry`` its edges and local axes; ``line_load`` solves for the
line load and treats weld ends, ``banded`` is its solver, ``structural_stress`` the plate section. ``line_check``,
``line_units`` and ``edge_type`` refuse or warn. ``element_forces`` sums the forces of the assessed side. From a shell
mesh (``mesh``), ``detection`` finds weld edges, ``cuts`` makes lines of them, ``join`` makes one line of several.
"""
