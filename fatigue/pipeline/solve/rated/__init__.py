"""The curves of welds and points: known, rated by factors and quality, doubtful."""
