"""What names and headers state: unit systems, units of coordinates, channels."""
