"""What the equations of motion are made of: coordinates, springs, suspension, creep, rows of outputs."""
