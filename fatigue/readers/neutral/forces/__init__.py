"""Modal nodal forces in the neutral format: read, checked, and handed out group of welds by group of welds."""
