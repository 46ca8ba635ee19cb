"""The fast counter: superposition, counting and damage in one pass over time, in single precision."""
