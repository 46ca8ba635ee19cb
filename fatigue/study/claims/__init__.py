"""Sentences as tests: reproduced, contradicted, or not decidable."""
