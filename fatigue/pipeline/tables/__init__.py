"""What is written: rows, the register, cycles, provenance and warnings."""
