"""Static load cases to compare, and the endurance lines they are compared with, in the neutral format."""
