"""Accelerations by the rules of standards: comfort indices, limits of equipment, running behaviour.

Constants that were recalled are data in TOML beside the code, with source, edition and status.
"""
