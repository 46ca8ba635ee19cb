"""More about roots: what they are called, how they run, which frequency the converter has in the vehicle."""
