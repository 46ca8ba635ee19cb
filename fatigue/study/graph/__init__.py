"""The analysis graph: roots of a vehicle over speed and conicity, and where it gains or loses stability."""
