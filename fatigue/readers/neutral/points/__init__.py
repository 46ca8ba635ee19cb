"""Stress points of a body: where they are and what they are, and the stress that each coordinate makes there."""
