"""Foreign files in, a folder of neutral files out."""
