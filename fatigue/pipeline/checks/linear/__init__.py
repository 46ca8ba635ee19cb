"""Linear stresses counted over the mission: as they are, in the worst direction or plane, and as a path."""
