"""Abaqus decks (.inp); forces and shapes come by the script and its text, see ``export``."""
