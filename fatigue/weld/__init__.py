"""From nodal forces along a weld line to Dong's structural stress."""
