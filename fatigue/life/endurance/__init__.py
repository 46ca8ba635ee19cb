"""Endurance between static load cases: lines in the Haigh plane, pairs of cases, corners of independent loads."""
