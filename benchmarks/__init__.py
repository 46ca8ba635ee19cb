"""What the program costs, as ratios to something measured in the same run: ``python -m benchmarks``."""
