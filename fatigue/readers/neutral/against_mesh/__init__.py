"""The weld tables against the mesh of the case: what both say of positions, thickness, directions and edges.

Nothing in an assessment is computed from the mesh. Where the case names ``nodes`` and ``elements``, they say a second
time what the weld tables say, and a contradiction is the mark of a wrong unit, another mesh or a slip in a column.
"""

from fatigue.readers.neutral.against_mesh.compare import TableNames, mesh_warnings

__all__ = ["TableNames", "mesh_warnings"]
