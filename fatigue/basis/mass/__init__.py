"""What of the mass of the body the modes carry: effective modal mass, its sums, and the dynamic mass."""
